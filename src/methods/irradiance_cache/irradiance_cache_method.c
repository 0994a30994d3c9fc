/* irradiance_cache_method.c - indirect diffuse light from irradiance records; what a surface
 * scatters beyond a Lambertian comes from paths (docs/methods/irradiance-cache.md). */
#include "methods/irradiance_cache/irradiance_cache_method.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "methods/cache_params.h"
#include "methods/cache_queries.h"
#include "methods/cache_session.h"

static const assay_param_desc PARAMS[] = {
    ASSAY_CACHE_PARAMS, ASSAY_CACHE_PASSES_PARAM, ASSAY_CACHE_SESSION_PARAMS, {0}};

typedef struct {
    assay_context                  *context;
    const assay_world              *world;
    assay_irradiance_cache_settings settings;
    assay_cached_image_settings     image;
    assay_cache_session             session;
    assay_irradiance_cache         *cache;
} cache_state;

static void destroy(void *state)
{
    cache_state *s = state;
    if (s) {
        assay_irradiance_cache_destroy(s->cache);
        assay_cache_session_release(&s->session);
        assay_release(s->context, s);
    }
}

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    cache_state *state = assay_allocate(context, 1, sizeof *state);
    if (!state) {
        return assay_fail_memory(context, "the irradiance cache");
    }
    state->context      = context;
    assay_status status = assay_cache_params_read(context, params, &state->settings, &state->image);
    status = status ? status : assay_cache_session_create(context, params, &state->session);
    if (status != ASSAY_OK) {
        destroy(state);
        return status;
    }
    *state_out = state;
    return ASSAY_OK;
}

static assay_cache_set caches_of(const cache_state *s)
{
    return (assay_cache_set){.settings = &s->settings, .irradiance = s->cache};
}

static assay_status prepare(void *state, const assay_frame *frame)
{
    cache_state *s      = state;
    assay_status status = ASSAY_OK;
    if (frame->frames_before == 0) {
        assay_irradiance_cache_destroy(s->cache);
        s->cache = NULL;
        status = assay_irradiance_cache_create(frame->world, &s->settings, frame->seed, &s->cache);
    }
    s->world                     = frame->world;
    const assay_cache_set caches = caches_of(s);
    return status ? status : assay_cache_session_begin(&s->session, frame, &caches);
}

/* ---- light for the image ---- */

static assay_status fill(void *user, const char *phase, uint64_t before, uint64_t total,
                         size_t count, const assay_cached_point *points, uint32_t *limits_out)
{
    cache_state       *s      = user;
    const assay_status status = assay_cache_session_ask(&s->session, count, points);
    return status ? status
                  : assay_irradiance_cache_fill(s->cache, phase, before, total, count,
                                                s->session.points, limits_out);
}

static assay_status irradiance(void *user, const assay_cached_point *point, uint32_t limit,
                               int worker, assay_rgb *irradiance_out)
{
    const cache_state      *s    = user;
    const assay_gather_site site = assay_gather_site_of(&point->vertex);
    return assay_irradiance_cache_look_up(s->cache, site.position, site.frame.z, limit, worker,
                                          irradiance_out);
}

static assay_status radiance(void *user, const assay_cached_point *point, uint32_t limit,
                             assay_random *random, assay_ray_counts *counts, int worker,
                             assay_rgb *radiance_out)
{
    const cache_state *s       = user;
    const assay_rgb    lambert = assay_cached_point_lambert(point);
    assay_rgb          e       = rgb_grey(0.0);
    const assay_status status =
        rgb_is_black(lambert) ? ASSAY_OK : irradiance(user, point, limit, worker, &e);
    if (status == ASSAY_OK) {
        *radiance_out =
            rgb_add(assay_cached_point_sum(lambert, e, NULL, false),
                    assay_cached_point_rest(s->world, &s->settings.path, point, random, counts));
    }
    return status;
}

static assay_status picture(void *user, const assay_cached_point *point, uint32_t limit, int worker,
                            assay_rgb color, assay_rgb *picture_out)
{
    const cache_state *s = user;
    return assay_cache_debug_paint(&s->session.debug, s->cache, point, limit, worker, color,
                                   picture_out);
}

static void report(const cache_state *s)
{
    const uint64_t unserved = assay_irradiance_cache_unserved(s->cache);
    if (unserved > 0) {
        assay_inform(s->context, ASSAY_LOG_WARNING,
                     "irradiance-cache: %llu look-ups that no record reaches were answered by the "
                     "nearest record (max_records, or records that shrank)",
                     (unsigned long long)unserved);
    }
}

static assay_status render(void *state, const assay_frame *frame, assay_film *film,
                           assay_ray_counts *counts)
{
    cache_state             *s      = state;
    const assay_cache_set    caches = caches_of(s);
    const assay_cached_light light  = {
         .user       = s,
         .fill       = fill,
         .radiance   = radiance,
         .irradiance = irradiance,
         .picture    = s->session.debug_kind == ASSAY_CACHE_DEBUG_OFF ? NULL : picture,
    };
    const assay_status status =
        assay_cache_session_render(&s->session, frame, &caches, &s->image, &light, film, counts);
    if (status == ASSAY_OK) {
        report(s);
    }
    return status || !frame->dump ? status : assay_cache_queries_add(frame, &caches, NULL);
}

const assay_method assay_method_irradiance_cache = {
    .name    = "irradiance-cache",
    .summary = "Irradiance caching: indirect diffuse light interpolated from records by octree and "
               "gradients.",
    .params  = PARAMS,
    .keeps_light = true,
    .create      = create,
    .prepare     = prepare,
    .render      = render,
    .destroy     = destroy,
};
