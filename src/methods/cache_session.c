/* cache_session.c - a bad path is known before the work: cache_out is begun first and finished
 * last. */
#include "methods/cache_session.h"

#include "core/alloc.h"
#include "core/context.h"

/* ---- creating ---- */

/* NULL where the parameter is empty. */
static assay_status copy_path(assay_context *context, const assay_params *params, const char *name,
                              char **path_out)
{
    const char *path = assay_params_text(params, name);
    if (*path) {
        *path_out = assay_copy_text(context, path);
        return *path_out ? ASSAY_OK : assay_fail_memory(context, "a path");
    }
    return ASSAY_OK;
}

assay_status assay_cache_session_create(assay_context *context, const assay_params *params,
                                        assay_cache_session *session)
{
    assay_cache_session made = {.context = context};
    made.debug_kind          = (assay_cache_debug_kind)assay_params_choice(params, "debug");
    assay_status status      = copy_path(context, params, "cache_in", &made.cache_in);
    status = status ? status : copy_path(context, params, "cache_out", &made.cache_out);
    status = status ? status : copy_path(context, params, "reference", &made.reference);
    if (status != ASSAY_OK) {
        assay_cache_session_release(&made);
        return status;
    }
    *session = made;
    return ASSAY_OK;
}

void assay_cache_session_release(assay_cache_session *session)
{
    if (session->context) {
        assay_release(session->context, session->cache_in);
        assay_release(session->context, session->cache_out);
        assay_release(session->context, session->reference);
        assay_release(session->context, session->points);
        assay_cache_debug_close(&session->debug);
        assay_bundle_destroy(session->saved);
    }
}

/* ---- a frame ---- */

static void restart_counts(const assay_cache_set *caches)
{
    assay_irradiance_cache_restart_counts(caches->irradiance);
    if (caches->radiance) {
        assay_irradiance_cache_restart_counts(assay_radiance_cache_records(caches->radiance));
    }
}

assay_status assay_cache_session_begin(assay_cache_session *session, const assay_frame *frame,
                                       const assay_cache_set *caches)
{
    assay_cache_debug_close(&session->debug);
    session->debug      = (assay_cache_debug){0};
    assay_status status = assay_cache_debug_open(frame, session->debug_kind, session->reference,
                                                 caches->glossy != NULL, &session->debug);
    if (frame->frames_before > 0) {
        restart_counts(caches);
    } else if (session->cache_in && status == ASSAY_OK) {
        status = assay_cache_file_read(frame, caches, session->cache_in);
    }
    if (session->cache_out && !session->saved && status == ASSAY_OK) {
        status = assay_bundle_create(session->context, session->cache_out, &session->saved);
    }
    return status;
}

assay_status assay_cache_session_ask(assay_cache_session *session, size_t count,
                                     const assay_cached_point *points)
{
    void *grown = session->points;
    if (assay_grow(session->context, &grown, &session->capacity, count, sizeof *session->points) !=
        ASSAY_OK) {
        return assay_fail_memory(session->context, "visible points");
    }
    session->points = grown;
    for (size_t i = 0; i < count; i++) {
        session->points[i] = (assay_cache_point){0};
        if (points[i].hit) {
            session->points[i] = (assay_cache_point){
                .site      = assay_gather_site_of(&points[i].vertex),
                .footprint = points[i].footprint,
                .wanted =
                    points[i].centre || !rgb_is_black(assay_cached_point_lambert(&points[i]))};
        }
    }
    return ASSAY_OK;
}

static assay_status render_image(const assay_cache_session *session, const assay_frame *frame,
                                 const assay_cache_set             *caches,
                                 const assay_cached_image_settings *image,
                                 const assay_cached_light *light, assay_film *film,
                                 assay_ray_counts *counts)
{
    const assay_status status = assay_cached_image_render(frame, image, light, film, counts);
    assay_irradiance_cache_count(caches->irradiance, counts);
    if (caches->radiance) {
        assay_irradiance_cache_count(assay_radiance_cache_records(caches->radiance), counts);
    }
    return status || !frame->dump ? status
                                  : assay_cache_file_add(session->context, frame->dump, caches);
}

assay_status assay_cache_session_render(assay_cache_session *session, const assay_frame *frame,
                                        const assay_cache_set             *caches,
                                        const assay_cached_image_settings *image,
                                        const assay_cached_light *light, assay_film *film,
                                        assay_ray_counts *counts)
{
    assay_status status = render_image(session, frame, caches, image, light, film, counts);
    if (session->saved && frame->last && status == ASSAY_OK) {
        status = assay_cache_file_finish(frame, caches, session->saved);
        assay_bundle_destroy(session->saved);
        session->saved = NULL;
    }
    return status;
}
