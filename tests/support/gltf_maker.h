/* gltf_maker.h - small glTF files in memory, made member by member, for tests of the loader. */
#ifndef ASSAY_TESTS_GLTF_MAKER_H
#define ASSAY_TESTS_GLTF_MAKER_H

#include <stddef.h>
#include <stdint.h>

#include "assay/scene.h"
#include "scene/scene_data.h"

typedef struct gltf_maker gltf_maker;

gltf_maker *gltf_maker_create(void);
void        gltf_maker_destroy(gltf_maker *maker);

/* Puts an object, given by its inside ("\"mesh\":0"), at the end of an array of the root ("nodes").
 * Returns its index. */
int gltf_add(gltf_maker *maker, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A member of the root: "\"scene\":0". */
void gltf_root(gltf_maker *maker, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Bytes at the end of the one buffer, aligned to 4, with a view of them; stride 0: none. */
int gltf_view(gltf_maker *maker, const void *bytes, size_t count, int stride);

/* A view and an accessor of floats; type "VEC3" and so on, count in elements. */
int gltf_floats(gltf_maker *maker, const char *type, int count, const float *values);
/* The same for unsigned 16-bit indices. */
int gltf_shorts(gltf_maker *maker, int count, const uint16_t *values);

/* A mesh of one primitive with this inside, and a node that shows it.  Returns the node. */
int gltf_shown_mesh(gltf_maker *maker, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* The triangle (0 0 0) (1 0 0) (0 1 0), its mesh shown by a node.  Returns the mesh. */
int gltf_shown_triangle(gltf_maker *maker);

/* The file: asset and scene 0 with all nodes that are no children are put in where the test gave
 * none.  Release with free. */
char    *gltf_text(gltf_maker *maker);
uint8_t *gltf_glb(gltf_maker *maker, size_t *count_out);

/* Loads it from memory under the name "test.gltf" and destroys the maker. */
assay_status gltf_load_status(gltf_maker *maker, assay_context *context,
                              const assay_scene_options *options, assay_scene **scene_out);
/* The same; fails the test on an error. */
assay_scene *gltf_load(gltf_maker *maker, assay_context *context);

/* A whole text, loaded from memory. */
assay_status gltf_load_text(assay_context *context, const char *json, assay_scene **scene_out);

/* A context with one thread; fails the test where there is none to be had. */
assay_context *gltf_context(void);

#endif
