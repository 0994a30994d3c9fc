/* scene_moment.c - the evaluated scene is hashed, not the poses: poses that differ may well give
 * the same floats, and floats are all that rays see.  Materials are not animated. */
#include "scene/scene_moment.h"

#include <stdio.h>

#include "core/hash.h"
#include "scene/scene_data.h"

static void add_vector(assay_hash *hash, assay_vec3 v)
{
    const double numbers[3] = {v.x, v.y, v.z};
    assay_hash_add(hash, numbers, sizeof numbers);
}

/* Number by number: what lies between the members is nobody's. */
static void add_light(assay_hash *hash, const assay_punctual_light *light)
{
    const double numbers[] = {light->kind,        light->intensity.r, light->intensity.g,
                              light->intensity.b, light->range,       light->cos_inner,
                              light->cos_outer};
    add_vector(hash, light->position);
    add_vector(hash, light->direction);
    assay_hash_add(hash, numbers, sizeof numbers);
}

void assay_scene_moment(const assay_scene *scene, char text_out[65])
{
    assay_hash hash;
    if (scene->is_static) {
        snprintf(text_out, 65, "static");
        return;
    }
    assay_hash_start(&hash);
    assay_hash_add(&hash, scene->positions, (size_t)scene->vertex_count * 3 * sizeof(float));
    assay_hash_add(&hash, scene->indices, (size_t)scene->triangle_count * 3 * sizeof(uint32_t));
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const assay_shape *shape = &scene->shapes[i];
        const size_t       count = shape->vertex_count;
        if (shape->normals) {
            assay_hash_add(&hash, shape->normals, count * 3 * sizeof(float));
        }
        if (shape->tangents) {
            assay_hash_add(&hash, shape->tangents, count * 4 * sizeof(float));
        }
    }
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        add_light(&hash, &scene->punctual[i]);
    }
    assay_hash_finish(&hash, text_out);
}
