/* scene_release.c - a scene, whole or as far as it was loaded, given back.
 *
 * Invariant: arrays come zeroed and their counts are set after them, so what is half-made releases
 * like what is whole. */
#include "core/alloc.h"
#include "scene/environment.h"
#include "scene/texture.h"

static void release_primitive(assay_context *context, assay_primitive *p)
{
    for (uint32_t i = 0; i < p->target_count; i++) {
        assay_release(context, p->targets[i].positions);
        assay_release(context, p->targets[i].normals);
        assay_release(context, p->targets[i].tangents);
    }
    assay_release(context, p->targets);
    assay_release(context, p->indices);
    assay_release(context, p->positions);
    assay_release(context, p->normals);
    assay_release(context, p->tangents);
    assay_release(context, p->uv[0]);
    assay_release(context, p->uv[1]);
    assay_release(context, p->colors);
    assay_release(context, p->joints);
    assay_release(context, p->weights);
}

static void release_meshes(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        assay_mesh *mesh = &scene->meshes[i];
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            release_primitive(scene->context, &mesh->primitives[k]);
        }
        assay_release(scene->context, mesh->primitives);
        assay_release(scene->context, mesh->weights);
        assay_release(scene->context, mesh->name);
    }
    assay_release(scene->context, scene->meshes);
}

static void release_nodes(assay_scene *scene)
{
    assay_context *context = scene->context;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        assay_release(context, scene->nodes[i].name);
        assay_release(context, scene->nodes[i].weights);
    }
    for (uint32_t i = 0; i < scene->skin_count; i++) {
        assay_release(context, scene->skins[i].joints);
        assay_release(context, scene->skins[i].inverse_bind);
    }
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        assay_release(context, scene->cameras[i].name);
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        assay_release(context, scene->lights[i].name);
    }
    assay_release(context, scene->nodes);
    assay_release(context, scene->skins);
    assay_release(context, scene->cameras);
    assay_release(context, scene->lights);
    assay_release(context, scene->node_order);
}

static void release_animations(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        assay_animation *animation = &scene->animations[i];
        for (uint32_t k = 0; k < animation->track_count; k++) {
            assay_release(scene->context, animation->tracks[k].times);
            assay_release(scene->context, animation->tracks[k].values);
        }
        assay_release(scene->context, animation->tracks);
        assay_release(scene->context, animation->name);
    }
    assay_release(scene->context, scene->animations);
}

static void release_looks(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->image_count; i++) {
        assay_texture_image_release(scene->context, &scene->images[i]);
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        assay_release(scene->context, scene->materials[i].name);
    }
    assay_release(scene->context, scene->images);
    assay_release(scene->context, scene->textures);
    assay_release(scene->context, scene->materials);
    assay_environment_destroy(scene->environment);
}

static void release_evaluation(assay_scene *scene)
{
    assay_context *context = scene->context;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        assay_release(context, scene->shapes[i].normals);
        assay_release(context, scene->shapes[i].tangents);
    }
    assay_release(context, scene->shapes);
    assay_release(context, scene->positions);
    assay_release(context, scene->vertices);
    assay_release(context, scene->indices);
    assay_release(context, scene->triangle_shape);
    assay_release(context, scene->punctual);
    assay_release(context, scene->world_cameras);
    assay_release(context, scene->poses);
    assay_release(context, scene->node_worlds);
    assay_release(context, scene->morph_weights);
    assay_release(context, scene->joint_matrices);
}

static void release_texts(assay_context *context, char **texts, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        assay_release(context, texts[i]);
    }
    assay_release(context, texts);
}

void assay_scene_destroy(assay_scene *scene)
{
    if (!scene) {
        return;
    }
    assay_context *context = scene->context;
    release_meshes(scene);
    release_nodes(scene);
    release_animations(scene);
    release_looks(scene);
    release_evaluation(scene);
    release_texts(context, scene->warnings, scene->warning_count);
    release_texts(context, scene->extensions, scene->extension_count);
    assay_release(context, scene->path);
    assay_release(context, (char *)scene->options.environment_path);
    assay_release(context, scene);
}
