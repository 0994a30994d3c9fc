/* render.c - from a scene to images: world, method, film, metadata.
 *
 * Invariant: a method's state and the world that it was prepared with live together; where the
 * world goes, the method is told before it is asked anything. */
#include "assay/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/process.h"
#include "methods/dump.h"
#include "methods/metadata.h"
#include "methods/run.h"
#include "scene/scene_moment.h"

assay_render_options assay_render_options_default(void)
{
    return (assay_render_options){.width = 512, .height = 512};
}

static assay_status fail_camera(const assay_scene *scene, const char *name)
{
    char   known[512] = "";
    size_t used       = 0;
    for (uint32_t i = 0; i < scene->world_camera_count && used < sizeof known; i++) {
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%u '%s'", i ? ", " : "", i,
                                 scene->world_cameras[i].name);
    }
    return assay_fail(scene->context, ASSAY_ERR_ARGUMENT, "%s: no camera '%.64s'; there are: %s%s",
                      scene->path, name, known, used < sizeof known ? "" : "...");
}

/* By name first, so that a camera called "1" can be had; then by number. */
static assay_status find_camera(const assay_scene *scene, const char *name, double aspect,
                                assay_camera *camera_out)
{
    uint32_t index = 0;
    if (name) {
        while (index < scene->world_camera_count &&
               strcmp(scene->world_cameras[index].name, name) != 0) {
            index++;
        }
        if (index == scene->world_camera_count) {
            char               *end       = NULL;
            const unsigned long number    = strtoul(name, &end, 10);
            const bool          is_number = *name >= '0' && *name <= '9' && *end == '\0';
            index = is_number && number < scene->world_camera_count ? (uint32_t)number : index;
        }
    }
    if (index >= scene->world_camera_count) {
        return fail_camera(scene, name);
    }
    *camera_out = scene->world_cameras[index];
    /* The camera of a scene without one shows it all in tall images, too. */
    if (scene->camera_is_made && aspect < 1.0) {
        camera_out->tan_half_yfov /= aspect;
        camera_out->yfov = 2.0 * assay_atan(camera_out->tan_half_yfov);
    }
    return ASSAY_OK;
}

/* A dump holds three channels of the image once more while it writes them, and then the file that
 * they became, which is hardly larger. */
enum { DUMP_PIXEL_BYTES = 2 * 3 * (int)sizeof(float) };

static assay_status check_options(assay_context *context, const assay_render_options *options,
                                  assay_layer_set *layers_out)
{
    if (options->width < 1 || options->height < 1 || options->width > ASSAY_IMAGE_MAX_SIDE ||
        options->height > ASSAY_IMAGE_MAX_SIDE) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "an image must be 1 to %d pixels a side, not %d x %d",
                          ASSAY_IMAGE_MAX_SIDE, options->width, options->height);
    }
    const assay_status status = assay_layers_parse(context, options->layers, layers_out);
    return status != ASSAY_OK ? status
                              : assay_film_ask(context, options->width, options->height,
                                               *layers_out, options->dump ? DUMP_PIXEL_BYTES : 0);
}

/* ---- running ---- */

struct assay_sequence {
    assay_scene        *scene;
    const assay_method *method;
    const assay_params *params;
    void               *state; /* NULL before the first frame                  */
    /* of the last frame */
    assay_world *world;
    char         moment[65];
    uint64_t     seed;
    /* of those that had the same world and seed */
    uint64_t frames;
    double   since; /* s */
};

static assay_status fill_film(assay_sequence *sequence, const assay_frame *frame, assay_film *film,
                              assay_ray_counts *counts)
{
    const assay_method *method = sequence->method;
    assay_status        status = sequence->state
                                     ? ASSAY_OK
                                     : method->create(frame->context, sequence->params, &sequence->state);
    status                     = status ? status : method->prepare(sequence->state, frame);
    return status ? status : method->render(sequence->state, frame, film, counts);
}

static assay_status make_image(assay_sequence *sequence, const assay_frame *frame, assay_film *film,
                               assay_image **image_out, assay_ray_counts *counts)
{
    assay_image *image  = NULL;
    assay_status status = fill_film(sequence, frame, film, counts);
    if (status == ASSAY_OK) {
        status = assay_film_develop(film, &image);
    }
    if (status == ASSAY_OK) {
        status = assay_metadata_add(image, sequence->method, sequence->params, frame);
    }
    if (status == ASSAY_OK && frame->dump) {
        status = assay_dump_image(frame->context, image, frame->dump);
    }
    if (status == ASSAY_OK && frame->dump) {
        status = assay_bundle_finish(frame->dump);
    }
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    *image_out = image;
    return ASSAY_OK;
}

static assay_status render_frame(assay_sequence *sequence, assay_frame *frame, const char *dump,
                                 assay_image **image_out, assay_render_stats *stats)
{
    assay_film      *film   = NULL;
    assay_ray_counts counts = {0};
    const double     start  = assay_process_seconds();
    assay_status     status =
        assay_film_create(frame->context, frame->width, frame->height, frame->layers, &film);
    if (status == ASSAY_OK && dump) {
        status = assay_bundle_create(frame->context, dump, &frame->dump);
    }
    if (status == ASSAY_OK) {
        status = make_image(sequence, frame, film, image_out, &counts);
    }
    if (status == ASSAY_OK) {
        stats->seconds_render = assay_process_seconds() - start;
        assay_run_fill_stats(film, frame, &counts, stats);
    }
    assay_bundle_destroy(frame->dump);
    assay_film_destroy(film);
    return status;
}

/* ---- sequences ---- */

assay_status assay_sequence_create(assay_scene *scene, const char *method,
                                   const assay_params *params, assay_sequence **sequence_out)
{
    const assay_method *found  = NULL;
    const assay_status  status = assay_run_find(scene->context, method, &found);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_sequence *sequence = assay_allocate(scene->context, 1, sizeof *sequence);
    if (!sequence) {
        return assay_fail_memory(scene->context, "a sequence of frames");
    }
    *sequence     = (assay_sequence){.scene = scene, .method = found, .params = params};
    *sequence_out = sequence;
    return ASSAY_OK;
}

void assay_sequence_destroy(assay_sequence *sequence)
{
    if (sequence) {
        sequence->method->destroy(sequence->state);
        assay_world_destroy(sequence->world);
        assay_release(sequence->scene->context, sequence);
    }
}

/* The world of the scene's current time: the one there is where that looks the same. */
static assay_status find_world(assay_sequence *sequence, assay_frame *frame,
                               assay_render_stats *stats)
{
    char moment[65] = "";
    if (sequence->world || !frame->last) {
        assay_scene_moment(sequence->scene, moment);
    }
    const bool still = sequence->world && strcmp(moment, sequence->moment) == 0;
    if (!still) {
        assay_world_destroy(sequence->world);
        sequence->world           = NULL;
        const assay_status status = assay_run_build(sequence->scene, &sequence->world, stats);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    if (!still || frame->seed != sequence->seed) {
        sequence->frames = 0;
        sequence->since  = sequence->scene->time;
    }
    memcpy(sequence->moment, moment, sizeof moment);
    sequence->seed       = frame->seed;
    frame->world         = sequence->world;
    frame->frames_before = sequence->frames++;
    frame->since         = sequence->since;
    return ASSAY_OK;
}

assay_status assay_sequence_render(assay_sequence *sequence, const assay_render_options *options,
                                   bool last, assay_image **image_out,
                                   assay_render_stats *stats_out)
{
    assay_context             *context  = sequence->scene->context;
    const assay_render_options defaults = assay_render_options_default();
    assay_render_stats         stats    = {0};
    assay_camera               camera   = {0};
    if (!options) {
        options = &defaults;
    }
    assay_frame  frame  = {.context = context,
                           .camera  = &camera,
                           .width   = options->width,
                           .height  = options->height,
                           .seed    = options->seed,
                           .last    = last};
    assay_status status = check_options(context, options, &frame.layers);
    if (status == ASSAY_OK) {
        const double aspect = (double)options->width / (double)options->height;
        status              = find_camera(sequence->scene, options->camera, aspect, &camera);
    }
    status = status ? status : find_world(sequence, &frame, &stats);
    status = status ? status : render_frame(sequence, &frame, options->dump, image_out, &stats);
    if (status == ASSAY_OK && stats_out) {
        *stats_out = stats;
    }
    return status;
}

assay_status assay_render(assay_scene *scene, const char *method, const assay_params *params,
                          const assay_render_options *options, assay_image **image_out,
                          assay_render_stats *stats_out)
{
    assay_sequence *sequence = NULL;
    assay_status    status   = assay_sequence_create(scene, method, params, &sequence);
    if (!sequence) {
        return status;
    }
    status = assay_sequence_render(sequence, options, true, image_out, stats_out);
    assay_sequence_destroy(sequence);
    return status;
}
