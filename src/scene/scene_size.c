/* scene_size.c - adding up arrays. */
#include "scene/scene_size.h"

static uint64_t primitive_bytes(const assay_primitive *p)
{
    const uint64_t vertex = (p->positions ? 12 : 0) + (p->normals ? 12 : 0) +
                            (p->tangents ? 16 : 0) + (p->uv[0] ? 8 : 0) + (p->uv[1] ? 8 : 0) +
                            (p->colors ? 16 : 0) + (p->joints ? 24ull * p->joint_sets : 0);
    uint64_t bytes = p->vertex_count * vertex + p->triangle_count * 12ull;
    for (uint32_t i = 0; i < p->target_count; i++) {
        const assay_morph_target *t = &p->targets[i];
        bytes += p->vertex_count * 12ull *
                 ((t->positions != NULL) + (t->normals != NULL) + (t->tangents != NULL));
    }
    return bytes;
}

uint64_t assay_scene_geometry_bytes(const assay_scene *scene)
{
    uint64_t bytes =
        scene->vertex_count * (12ull + sizeof *scene->vertices) + scene->triangle_count * 16ull;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const assay_shape *s = &scene->shapes[i];
        bytes += s->vertex_count * ((s->normals ? 12ull : 0) + (s->tangents ? 16ull : 0));
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            bytes += primitive_bytes(&scene->meshes[i].primitives[k]);
        }
    }
    return bytes;
}

uint64_t assay_scene_texture_bytes(const assay_scene *scene)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const assay_texture_image *image = &scene->images[i];
        bytes += (uint64_t)image->width * image->height * image->bits / 2;
    }
    return bytes;
}
