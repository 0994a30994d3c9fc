/* fuzz_gltf.c - the scene loader on arbitrary bytes (libFuzzer).
 *
 * Loads from memory, so that no other file is opened; evaluates at two times; reports.  What comes
 * out is looked through, so that an index out of range or a number that is not finite counts as a
 * finding.  The context holds at most 256 MiB, and the last byte chooses the options. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_build.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

enum { HEADER = 16 };
static const size_t MOST = (size_t)256 << 20;

/* Every block starts with its own size. */
static void *allocate(void *user, size_t bytes)
{
    size_t *held = user;
    if (bytes > MOST || *held + bytes > MOST) {
        return NULL;
    }
    char *block = malloc(HEADER + bytes);
    if (!block) {
        return NULL;
    }
    memcpy(block, &bytes, sizeof bytes);
    *held += bytes;
    return block + HEADER;
}

static void release(void *user, void *memory)
{
    size_t *held  = user, bytes;
    char   *block = (char *)memory - HEADER;
    memcpy(&bytes, block, sizeof bytes);
    *held -= bytes;
    free(block);
}

static void require(bool sound)
{
    if (!sound) {
        abort();
    }
}

/* The invariants that the rest of the library relies on. */
static void look_through(const assay_scene *scene)
{
    for (size_t i = 0; i < (size_t)scene->triangle_count * 3; i++) {
        require(scene->triangle_shape[i / 3] < scene->shape_count);
        const assay_shape *shape = &scene->shapes[scene->triangle_shape[i / 3]];
        require(scene->indices[i] >= shape->first_vertex);
        require(scene->indices[i] - shape->first_vertex < shape->vertex_count);
        require(shape->material < scene->material_count);
    }
    for (size_t i = 0; i < (size_t)scene->vertex_count * 3; i++) {
        require(isfinite(scene->positions[i]));
    }
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const assay_texture_ref *ref = &scene->materials[i].base_color_texture;
        require(ref->texture == ASSAY_NONE || ref->texture < scene->texture_count);
        require(ref->texture == ASSAY_NONE ||
                scene->images[scene->textures[ref->texture].image].texels != NULL);
    }
    for (uint32_t i = 0; i < scene->world_camera_count; i++) {
        const assay_camera *c = &scene->world_cameras[i];
        require(vec3_finite(c->position) && fabs(vec3_dot(c->up, c->forward)) < 1e-6);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    size_t                      held            = 0;
    const uint8_t               last            = count ? bytes[count - 1] : 0;
    const assay_context_options context_options = {.threads   = 1,
                                                   .allocator = {allocate, release, &held}};
    assay_scene_options         options         = assay_scene_options_default();
    assay_context              *context         = NULL;
    assay_scene                *scene           = NULL;
    char                       *report          = NULL;
    options.force_diffuse                       = last & 1;
    options.solid_transmission                  = last & 2;
    require(assay_context_create(&context_options, &context) == ASSAY_OK);
    const size_t idle = held;
    if (assay_scene_load_memory(context, bytes, count, "fuzz", NULL, &options, &scene) ==
        ASSAY_OK) {
        look_through(scene);
        if (assay_scene_report_json(scene, &report) == ASSAY_OK) {
            assay_text_destroy(context, report);
        }
        if (assay_scene_set_time(scene, 0.7) == ASSAY_OK) {
            look_through(scene);
        }
        assay_scene_destroy(scene);
    } else {
        require(assay_context_error(context)[0] != 0);
    }
    require(held == idle);
    assay_context_destroy(context);
    return 0;
}
