/* run.c - the steps that every use of a method takes. */
#include "methods/run.h"

#include <math.h>
#include <stdio.h>

#include "core/context.h"
#include "core/process.h"
#include "methods/registry.h"
#include "scene/scene_size.h"

static assay_status fail_method(assay_context *context, const char *name)
{
    char   known[512] = "";
    size_t used       = 0;
    for (int i = 0; i < assay_method_count() && used < sizeof known; i++) {
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                 assay_method_at(i).name);
    }
    return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown method '%.64s'; there are: %s", name,
                      known);
}

assay_status assay_run_find(assay_context *context, const char *name,
                            const assay_method **method_out)
{
    const assay_method *method = assay_method_find(name);
    if (!method) {
        return fail_method(context, name);
    }
    *method_out = method;
    return ASSAY_OK;
}

assay_status assay_run_build(const assay_scene *scene, assay_world **world_out,
                             assay_render_stats *stats)
{
    const double       start  = assay_process_seconds();
    const assay_status status = assay_world_create(scene, world_out);
    stats->seconds_build      = assay_process_seconds() - start;
    if (status == ASSAY_ERR_DOMAIN) {
        return assay_fail(scene->context, status,
                          "%s: a light, or what is around the scene, is too bright to compute with",
                          scene->path);
    }
    return status;
}

void assay_run_fill_stats(const assay_film *film, const assay_frame *frame,
                          const assay_ray_counts *counts, assay_render_stats *stats)
{
    stats->camera_rays    = counts->camera;
    stats->scatter_rays   = counts->scatter;
    stats->shadow_rays    = counts->shadow;
    stats->records        = counts->records;
    stats->lost           = counts->lost;
    stats->peak_memory    = assay_process_peak_memory();
    stats->bvh_bytes      = assay_bvh_bytes(frame->world->bvh);
    stats->geometry_bytes = assay_scene_geometry_bytes(frame->world->scene);
    stats->texture_bytes  = assay_scene_texture_bytes(frame->world->scene);
    stats->threads        = assay_context_threads(frame->context);
    if (!film) {
        stats->relative_error = NAN;
        return;
    }
    const uint64_t pixels = (uint64_t)frame->width * (uint64_t)frame->height;
    /* Camera paths are the same for the colour and its split. */
    const assay_film_quantity paths =
        frame->layers & ASSAY_LAYERS_COLOR ? ASSAY_FILM_COLOR : ASSAY_FILM_DIRECT;
    stats->relative_error = assay_film_relative_error(film);
    stats->target         = assay_film_target(film);
    stats->spp_min        = UINT64_MAX;
    for (uint64_t i = 0; i < pixels; i++) {
        const uint64_t n = assay_film_samples(film, i, paths);
        stats->samples += n;
        stats->spp_min = n < stats->spp_min ? n : stats->spp_min;
        stats->spp_max = n > stats->spp_max ? n : stats->spp_max;
    }
}

assay_status assay_run_method(const assay_method *method, const assay_params *params,
                              const assay_frame *frame, assay_run_work work, void *user,
                              assay_ray_counts *counts)
{
    void        *state  = NULL;
    assay_status status = method->create(frame->context, params, &state);
    if (status == ASSAY_OK) {
        status = method->prepare(state, frame);
    }
    if (status == ASSAY_OK) {
        status = work(method, state, frame, user, counts);
    }
    method->destroy(state);
    return status;
}
