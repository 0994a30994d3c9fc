/* scene_builder.h - small scenes for tests, written as glTF and loaded like anyone's. */
#ifndef ASSAY_TESTS_SCENE_BUILDER_H
#define ASSAY_TESTS_SCENE_BUILDER_H

#include "assay/scene.h"
#include "math/vec.h"

typedef struct scene_builder scene_builder;

scene_builder *scene_builder_create(void);

/* A material from the inside of a glTF material object, such as "\"doubleSided\":true".
 * Returns its index. */
int scene_builder_material(scene_builder *builder, const char *json);

/* A Lambertian of this reflectance and emission (W/(m2 sr)), exactly: no coat. */
int scene_builder_diffuse(scene_builder *builder, double reflectance, double emission,
                          bool double_sided);

/* Vertices a, b, c, d counter-clockwise as seen from the front. */
void scene_builder_quad(scene_builder *builder, int material, assay_vec3 a, assay_vec3 b,
                        assay_vec3 c, assay_vec3 d);

/* The inside or the outside of the box [low, high]. */
void scene_builder_box(scene_builder *builder, int material, assay_vec3 low, assay_vec3 high,
                       bool inside);

/* An icosahedron subdivided `levels` times, vertices on the sphere; fronts outward. */
void scene_builder_sphere(scene_builder *builder, int material, assay_vec3 centre, double radius,
                          int levels);

/* A node with more JSON in it, such as a light: "\"extensions\":{...}". */
void scene_builder_node(scene_builder *builder, const char *json);

/* Top-level members of the file, such as "\"extensions\":{...}". */
void scene_builder_top(scene_builder *builder, const char *json);

/* A perspective camera at eye that looks at target, up +Y. */
void scene_builder_camera(scene_builder *builder, assay_vec3 eye, assay_vec3 target, double yfov);

/* Writes the file, loads it, removes it; destroys the builder.  Fails the test on any error. */
assay_scene *scene_builder_load(scene_builder *builder, assay_context *context,
                                const assay_scene_options *options);

#endif
