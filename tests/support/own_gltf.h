/* own_gltf.h - a small reader of the glTF that scenes/gen writes; a second method beside src/scene.
 *
 * It knows one primitive a mesh, one .bin file, float vectors and 16-bit indices, and no more. */
#ifndef ASSAY_TESTS_OWN_GLTF_H
#define ASSAY_TESTS_OWN_GLTF_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "math/vec.h"

/* Triangles; normals may be NULL. */
typedef struct {
    char      name[64];
    float    *positions, *normals; /* 3 a vertex   */
    uint32_t *indices;             /* 3 a triangle */
    size_t    vertex_count, triangle_count;
} own_mesh;

typedef struct {
    cJSON    *json;
    uint8_t  *bin;
    size_t    bin_size;
    own_mesh *meshes;
    int       mesh_count;
} own_gltf;

/* What is wrong with a document, or NULL: views inside the buffer, accessors inside their views,
 * indices inside the vertices, bounds as stated, references inside their arrays, finite numbers. */
const char *own_gltf_defect(const cJSON *json, const uint8_t *bin, size_t bin_size);

/* Reads scenes/NAME/NAME.gltf below `root`; a defect fails the test. */
own_gltf own_gltf_read(const char *root, const char *name);
void     own_gltf_release(own_gltf *scene);

const own_mesh *own_gltf_mesh(const own_gltf *scene, const char *name);

/* Every instance in world space, positions rounded once to float; vertices are not shared.  Skinned
 * meshes in their bind pose (unrotated joints, the first without an inverse), morph targets at 0.
 * Release with own_mesh_release. */
own_mesh own_gltf_flatten(const own_gltf *scene);

/* Meshes of the given names put into one (their own frames). */
own_mesh own_gltf_join(const own_gltf *scene, const char *const *names, int count);
void     own_mesh_release(own_mesh *mesh);

static inline assay_vec3 own_mesh_corner(const own_mesh *mesh, size_t triangle, int corner)
{
    const float *p = mesh->positions + 3 * (size_t)mesh->indices[3 * triangle + (size_t)corner];
    return vec3((double)p[0], (double)p[1], (double)p[2]);
}

#endif
