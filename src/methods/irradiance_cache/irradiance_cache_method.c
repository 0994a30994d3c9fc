/* irradiance_cache_method.c - indirect diffuse light from irradiance records; what a surface
 * scatters beyond a Lambertian comes from paths (docs/methods/irradiance-cache.md). */
#include "methods/irradiance_cache/irradiance_cache_method.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "methods/cache_debug.h"
#include "methods/cache_file.h"
#include "methods/cache_params.h"

static const assay_param_desc PARAMS[] = {
    ASSAY_CACHE_PARAMS,
    {"cache_in", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,
     "Folder of a saved cache to begin with, of the same scene and the same light.", ""},
    {"cache_out", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,
     "Folder to make for the cache when the image is done.", ""},
    {"debug", ASSAY_PARAM_CHOICE, "", "off", 0, 0, "off|records|weights|error",
     "A picture instead of the colour: records and their zones, weights, or the error of the "
     "indirect irradiance.",
     "[gautron06] fig. 2.3"},
    {"reference", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,
     "Image with the layer IrradianceIndirect that debug=error compares with.", ""},
    {0},
};

typedef struct {
    assay_context                  *context;
    const assay_world              *world;
    assay_irradiance_cache_settings settings;
    assay_cached_image_settings     image;
    char                           *cache_in, *cache_out, *reference; /* or NULL */
    assay_cache_debug_kind          debug_kind;
    assay_cache_debug               debug;
    assay_irradiance_cache         *cache;
    assay_cache_point              *points; /* of a wave */
    size_t                          capacity;
} cache_state;

static void destroy(void *state)
{
    cache_state *s = state;
    if (s) {
        assay_irradiance_cache_destroy(s->cache);
        assay_release(s->context, s->cache_in);
        assay_release(s->context, s->cache_out);
        assay_release(s->context, s->reference);
        assay_cache_debug_close(&s->debug);
        assay_release(s->context, s->points);
        assay_release(s->context, s);
    }
}

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

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    cache_state *state = assay_allocate(context, 1, sizeof *state);
    if (!state) {
        return assay_fail_memory(context, "the irradiance cache");
    }
    state->context      = context;
    assay_status status = assay_cache_params_read(context, params, &state->settings, &state->image);
    status = status ? status : copy_path(context, params, "cache_in", &state->cache_in);
    status = status ? status : copy_path(context, params, "cache_out", &state->cache_out);
    status = status ? status : copy_path(context, params, "reference", &state->reference);
    state->debug_kind = (assay_cache_debug_kind)assay_params_choice(params, "debug");
    if (status != ASSAY_OK) {
        destroy(state);
        return status;
    }
    *state_out = state;
    return ASSAY_OK;
}

static assay_status prepare(void *state, const assay_frame *frame)
{
    cache_state *s      = state;
    s->world            = frame->world;
    assay_status status = assay_cache_debug_open(frame, s->debug_kind, s->reference, &s->debug);
    status =
        status ? status
               : assay_irradiance_cache_create(frame->world, &s->settings, frame->seed, &s->cache);
    return status || !s->cache_in
               ? status
               : assay_cache_file_read(frame, &s->settings, s->cache_in, s->cache);
}

/* ---- light for the image ---- */

static assay_status fill(void *user, const char *phase, uint64_t before, uint64_t total,
                         size_t count, const assay_cached_point *points, uint32_t *limits_out)
{
    cache_state *s     = user;
    void        *grown = s->points;
    if (assay_grow(s->context, &grown, &s->capacity, count, sizeof *s->points) != ASSAY_OK) {
        return assay_fail_memory(s->context, "visible points");
    }
    s->points = grown;
    for (size_t i = 0; i < count; i++) {
        s->points[i] = (assay_cache_point){0};
        if (points[i].hit) {
            s->points[i] = (assay_cache_point){
                .site      = assay_gather_site_of(&points[i].vertex),
                .footprint = points[i].footprint,
                .wanted =
                    points[i].centre || !rgb_is_black(assay_cached_point_lambert(&points[i]))};
        }
    }
    return assay_irradiance_cache_fill(s->cache, phase, before, total, count, s->points,
                                       limits_out);
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
    assay_rgb          sum     = rgb_grey(0.0);
    if (!rgb_is_black(lambert)) {
        const assay_status status = irradiance(user, point, limit, worker, &sum);
        if (status != ASSAY_OK) {
            return status;
        }
        sum = rgb_scale(rgb_mul(sum, lambert), ASSAY_INV_PI);
    }
    if (point->vertex.bsdf.model != ASSAY_BSDF_LAMBERT) {
        sum = rgb_add(sum, assay_path_indirect(s->world, &s->settings.path, &point->vertex, lambert,
                                               random, counts));
    }
    *radiance_out = sum;
    return ASSAY_OK;
}

static assay_status picture(void *user, const assay_cached_point *point, uint32_t limit, int worker,
                            assay_rgb color, assay_rgb *picture_out)
{
    const cache_state *s = user;
    return assay_cache_debug_paint(&s->debug, s->cache, point, limit, worker, color, picture_out);
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

static assay_status render_image(cache_state *s, const assay_frame *frame, assay_film *film,
                                 assay_ray_counts *counts)
{
    const assay_cached_light light = {
        .user       = s,
        .fill       = fill,
        .radiance   = radiance,
        .irradiance = irradiance,
        .picture    = s->debug_kind == ASSAY_CACHE_DEBUG_OFF ? NULL : picture,
    };
    assay_status status = assay_cached_image_render(frame, &s->image, &light, film, counts);
    assay_irradiance_cache_count(s->cache, counts);
    if (status == ASSAY_OK) {
        report(s);
    }
    if (status == ASSAY_OK && frame->dump) {
        status = assay_cache_file_add(s->context, frame->dump, s->cache);
    }
    return status;
}

static assay_status render(void *state, const assay_frame *frame, assay_film *film,
                           assay_ray_counts *counts)
{
    cache_state  *s      = state;
    assay_bundle *saved  = NULL;
    assay_status  status = ASSAY_OK;
    if (s->cache_out) {
        status = assay_cache_file_create(frame, &s->settings, s->cache_out, &saved);
    }
    status = status ? status : render_image(s, frame, film, counts);
    if (saved && status == ASSAY_OK) {
        status = assay_cache_file_add(s->context, saved, s->cache);
        status = status ? status : assay_bundle_finish(saved);
    }
    assay_bundle_destroy(saved);
    return status;
}

const assay_method assay_method_irradiance_cache = {
    .name    = "irradiance-cache",
    .summary = "Irradiance caching: indirect diffuse light interpolated from records by octree and "
               "gradients.",
    .params  = PARAMS,
    .create  = create,
    .prepare = prepare,
    .render  = render,
    .destroy = destroy,
};
