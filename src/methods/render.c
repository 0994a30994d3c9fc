/* render.c - one render from scene to image: world, method, film, metadata. */
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

static assay_status render_work(const assay_method *method, void *state, const assay_frame *frame,
                                void *user, assay_ray_counts *counts)
{
    return method->render(state, frame, user, counts);
}

static assay_status make_image(const assay_method *method, const assay_params *params,
                               const assay_frame *frame, assay_film *film, assay_image **image_out,
                               assay_ray_counts *counts)
{
    assay_image *image  = NULL;
    assay_status status = assay_run_method(method, params, frame, render_work, film, counts);
    if (status == ASSAY_OK) {
        status = assay_film_develop(film, &image);
    }
    if (status == ASSAY_OK) {
        status = assay_metadata_add(image, method, params, frame);
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

static assay_status render_frame(const assay_method *method, const assay_params *params,
                                 assay_frame *frame, const char *dump, assay_image **image_out,
                                 assay_render_stats *stats)
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
        status = make_image(method, params, frame, film, image_out, &counts);
    }
    if (status == ASSAY_OK) {
        stats->seconds_render = assay_process_seconds() - start;
        assay_run_fill_stats(film, frame, &counts, stats);
    }
    assay_bundle_destroy(frame->dump);
    assay_film_destroy(film);
    return status;
}

assay_status assay_render(assay_scene *scene, const char *method_name, const assay_params *params,
                          const assay_render_options *options, assay_image **image_out,
                          assay_render_stats *stats_out)
{
    assay_context             *context  = scene->context;
    const assay_render_options defaults = assay_render_options_default();
    const assay_method        *method   = NULL;
    assay_world               *world    = NULL;
    assay_render_stats         stats    = {0};
    if (!options) {
        options = &defaults;
    }
    assay_camera camera = {0};
    assay_frame  frame  = {.context = context,
                           .camera  = &camera,
                           .width   = options->width,
                           .height  = options->height,
                           .seed    = options->seed};
    assay_status status = assay_run_find(context, method_name, &method);
    if (status == ASSAY_OK) {
        status = check_options(context, options, &frame.layers);
    }
    if (status == ASSAY_OK) {
        const double aspect = (double)options->width / (double)options->height;
        status              = find_camera(scene, options->camera, aspect, &camera);
    }
    if (status == ASSAY_OK) {
        status = assay_run_build(scene, &world, &stats);
    }
    if (status == ASSAY_OK) {
        frame.world = world;
        status      = render_frame(method, params, &frame, options->dump, image_out, &stats);
    }
    assay_world_destroy(world);
    if (status == ASSAY_OK && stats_out) {
        *stats_out = stats;
    }
    return status;
}
