/* radiance_cache_method.c - indirect light from irradiance records and, where surfaces are glossy
 * within reach, from radiance records; what is too sharp comes from paths.
 *
 * Invariant: the light of a point is lambert / pi E, from the irradiance cache, and the light that
 * f - lambert / pi scatters, from one of the other two.  Which one is its material's affair, so
 * both parts always add up to f, whatever the Lambertian is. */
#include "methods/radiance_cache/radiance_cache_method.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "methods/cache_pair.h"
#include "methods/cache_params.h"
#include "methods/cache_queries.h"
#include "methods/cache_session.h"

static const assay_param_desc PARAMS[] = {ASSAY_CACHE_PARAMS,
                                          ASSAY_CACHE_PASSES_PARAM,
                                          ASSAY_RADIANCE_PARAMS,
                                          ASSAY_CACHE_SESSION_PARAMS,
                                          {0}};

/* What had been made when a point of the wave was served: their sum names the pair, as neither ever
 * falls. */
typedef struct {
    uint32_t irradiance, radiance;
} made_so_far;

/* A worker's own. */
typedef struct {
    double *light;   /* 3 rows of coefficients */
    double *scratch; /* one                    */
} desk;

typedef struct {
    assay_context              *context;
    const assay_world          *world;
    assay_cache_pair            pair;
    assay_cached_image_settings image;
    assay_cache_session         session;
    desk                       *desks;
    /* of a wave */
    uint32_t    *limits;
    made_so_far *made;
    size_t       limit_capacity, made_capacity, made_count;
} cache_state;

static void release_desks(cache_state *s)
{
    for (int i = 0; s->desks && i < assay_context_threads(s->context); i++) {
        assay_release(s->context, s->desks[i].light);
        assay_release(s->context, s->desks[i].scratch);
    }
    assay_release(s->context, s->desks);
}

static void destroy(void *state)
{
    cache_state *s = state;
    if (s) {
        release_desks(s);
        assay_cache_pair_release(&s->pair);
        assay_cache_session_release(&s->session);
        assay_release(s->context, s->limits);
        assay_release(s->context, s->made);
        assay_release(s->context, s);
    }
}

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    cache_state *state = assay_allocate(context, 1, sizeof *state);
    if (!state) {
        return assay_fail_memory(context, "the radiance cache");
    }
    state->context      = context;
    assay_status status = assay_cache_pair_read(context, assay_method_radiance_cache.name, params,
                                                &state->pair, &state->image);
    status = status ? status : assay_cache_session_create(context, params, &state->session);
    if (status != ASSAY_OK) {
        destroy(state);
        return status;
    }
    *state_out = state;
    return ASSAY_OK;
}

/* ---- once a frame ---- */

static assay_status make_desks(cache_state *s)
{
    const size_t threads = (size_t)assay_context_threads(s->context);
    const size_t count   = assay_basis_count(assay_radiance_cache_basis(s->pair.radiance));
    s->desks             = assay_allocate(s->context, threads, sizeof *s->desks);
    bool have            = s->desks != NULL;
    for (size_t i = 0; have && i < threads; i++) {
        s->desks[i].light   = assay_allocate(s->context, 3 * count, sizeof(double));
        s->desks[i].scratch = assay_allocate(s->context, count, sizeof(double));
        have                = s->desks[i].light && s->desks[i].scratch;
    }
    return have ? ASSAY_OK : assay_fail_memory(s->context, "the radiance cache");
}

static assay_cache_set caches_of(const cache_state *s)
{
    return (assay_cache_set){&s->pair.params.cache.records, &s->pair.params.cache,
                             s->pair.irradiance, s->pair.radiance};
}

static assay_status prepare(void *state, const assay_frame *frame)
{
    cache_state *s      = state;
    s->world            = frame->world;
    assay_status status = assay_cache_pair_prepare(&s->pair, frame);
    if (status == ASSAY_OK && s->pair.radiance && !s->desks) {
        status = make_desks(s);
    }
    const assay_cache_set caches = caches_of(s);
    return status ? status : assay_cache_session_begin(&s->session, frame, &caches);
}

/* ---- filling ---- */

static const assay_material_grids *grids_at(const cache_state *s, const assay_cached_point *point)
{
    return s->pair.radiance && point->hit ? glossy_materials_at(&s->pair.materials, &point->vertex)
                                          : NULL;
}

static assay_status make_room(cache_state *s, size_t count)
{
    void        *limits = s->limits, *made = s->made;
    assay_status status =
        assay_grow(s->context, &limits, &s->limit_capacity, count, sizeof *s->limits);
    status =
        status ? status : assay_grow(s->context, &made, &s->made_capacity, count, sizeof *s->made);
    s->limits = limits;
    s->made   = made;
    return status ? assay_fail_memory(s->context, "visible points") : ASSAY_OK;
}

static assay_status fill(void *user, const char *phase, uint64_t before, uint64_t total,
                         size_t count, const assay_cached_point *points, uint32_t *limits_out)
{
    cache_state       *s      = user;
    assay_cache_point *asked  = NULL;
    assay_status       status = make_room(s, count);
    status = status ? status : assay_cache_session_ask(&s->session, count, points);
    asked  = s->session.points;
    status = status ? status
                    : assay_irradiance_cache_fill(s->pair.irradiance, phase, before, total, count,
                                                  asked, limits_out);
    if (status != ASSAY_OK || !s->pair.radiance) {
        return status;
    }
    for (size_t i = 0; i < count; i++) {
        asked[i].wanted = grids_at(s, &points[i]) != NULL;
    }
    status = assay_irradiance_cache_fill(assay_radiance_cache_records(s->pair.radiance), phase,
                                         before, total, count, asked, s->limits);
    for (size_t i = 0; i < count && status == ASSAY_OK; i++) {
        s->made[i] = (made_so_far){limits_out[i], s->limits[i]};
        limits_out[i] += s->limits[i];
    }
    s->made_count = count;
    return status;
}

/* From the number that the driver keeps back to both; UINT32_MAX: all. */
static made_so_far made_within(const cache_state *s, uint32_t limit)
{
    if (limit == UINT32_MAX || !s->pair.radiance) {
        return (made_so_far){limit, limit};
    }
    size_t low = 0, high = s->made_count;
    while (low + 1 < high) {
        const size_t middle = low + (high - low) / 2;
        if (s->made[middle].irradiance + s->made[middle].radiance <= limit) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return s->made[low];
}

/* ---- light for the image ---- */

static assay_status irradiance_within(const cache_state *s, const assay_cached_point *point,
                                      uint32_t limit, int worker, assay_rgb *irradiance_out)
{
    const assay_gather_site site = assay_gather_site_of(&point->vertex);
    return assay_irradiance_cache_look_up(s->pair.irradiance, site.position, site.frame.z, limit,
                                          worker, irradiance_out);
}

static assay_status irradiance(void *user, const assay_cached_point *point, uint32_t limit,
                               int worker, assay_rgb *irradiance_out)
{
    const cache_state *s = user;
    return irradiance_within(s, point, made_within(s, limit).irradiance, worker, irradiance_out);
}

/* What the lobe reflects; *found_out false where no record reaches the point. */
static assay_status gloss(const cache_state *s, const assay_material_grids *grids,
                          const assay_cached_point *point, uint32_t limit, int worker,
                          assay_rgb *gloss_out, bool *found_out)
{
    const desk        *d     = &s->desks[worker];
    const assay_frame3 frame = assay_material_frame(&point->vertex);
    const size_t       count = assay_basis_count(assay_radiance_cache_basis(s->pair.radiance));
    const assay_status status =
        assay_radiance_cache_look_up(s->pair.radiance, point->vertex.surface.position, &frame,
                                     limit, worker, d->light, found_out);
    return status || !*found_out ? status
                                 : assay_material_grids_reflect(grids, count, &point->vertex,
                                                                d->light, d->scratch, gloss_out);
}

/* What the caches say of the light towards the viewer; *found_out false, and the Lambertian's share
 * alone, where the rest of it is none of theirs. */
static assay_status cached_radiance(const cache_state *s, const assay_cached_point *point,
                                    uint32_t limit, int worker, assay_rgb *radiance_out,
                                    bool *found_out)
{
    const made_so_far           made    = made_within(s, limit);
    const assay_material_grids *grids   = grids_at(s, point);
    const assay_rgb             lambert = assay_cached_point_lambert(point);
    const bool                  clamp   = s->pair.params.cache.records.rules.clamp_negative;
    assay_rgb                   e = rgb_grey(0.0), rest = rgb_grey(0.0);
    assay_status                status = ASSAY_OK;
    bool                        found  = false;
    if (!rgb_is_black(lambert)) {
        status = irradiance_within(s, point, made.irradiance, worker, &e);
    }
    if (grids && status == ASSAY_OK) {
        status = gloss(s, grids, point, made.radiance, worker, &rest, &found);
    }
    if (status == ASSAY_OK) {
        *radiance_out = assay_cached_point_sum(lambert, e, found ? &rest : NULL, clamp);
        *found_out    = found;
    }
    return status;
}

static assay_status radiance(void *user, const assay_cached_point *point, uint32_t limit,
                             assay_random *random, assay_ray_counts *counts, int worker,
                             assay_rgb *radiance_out)
{
    const cache_state *s      = user;
    assay_rgb          sum    = rgb_grey(0.0);
    bool               found  = false;
    const assay_status status = cached_radiance(s, point, limit, worker, &sum, &found);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!found) {
        sum = rgb_add(sum, assay_cached_point_rest(s->world, &s->pair.params.cache.records.path,
                                                   point, random, counts));
    }
    *radiance_out = sum;
    return ASSAY_OK;
}

/* On surfaces within reach what the radiance records do, elsewhere the irradiance records. */
static assay_status picture(void *user, const assay_cached_point *point, uint32_t limit, int worker,
                            assay_rgb color, assay_rgb *picture_out)
{
    const cache_state       *s     = user;
    const assay_cache_debug *debug = &s->session.debug;
    const made_so_far        made  = made_within(s, limit);
    if (!grids_at(s, point)) {
        return assay_cache_debug_paint(debug, s->pair.irradiance, point, made.irradiance, worker,
                                       color, picture_out);
    }
    if (debug->kind != ASSAY_CACHE_DEBUG_ERROR) {
        return assay_cache_debug_paint(debug, assay_radiance_cache_records(s->pair.radiance), point,
                                       made.radiance, worker, color, picture_out);
    }
    assay_rgb          light  = rgb_grey(0.0);
    bool               found  = false;
    const assay_status status = cached_radiance(s, point, limit, worker, &light, &found);
    if (status == ASSAY_OK) {
        *picture_out = assay_cache_debug_error(&debug->radiance, point->pixel, light.g);
    }
    return status;
}

static void report(const cache_state *s)
{
    assay_irradiance_cache *radiance =
        s->pair.radiance ? assay_radiance_cache_records(s->pair.radiance) : NULL;
    const uint64_t nearest = assay_irradiance_cache_unserved(s->pair.irradiance);
    const uint64_t paths   = radiance ? assay_irradiance_cache_unserved(radiance) : 0;
    assay_inform(s->context, ASSAY_LOG_INFO,
                 "radiance-cache: %u irradiance and %u radiance records",
                 assay_record_store_count(assay_irradiance_cache_store(s->pair.irradiance)),
                 radiance ? assay_record_store_count(assay_irradiance_cache_store(radiance)) : 0);
    if (nearest > 0 || paths > 0) {
        assay_inform(s->context, ASSAY_LOG_WARNING,
                     "radiance-cache: look-ups that no record reaches (max_records, or records "
                     "that shrank): %llu of irradiance, answered by the nearest record, and %llu "
                     "of radiance, answered by paths",
                     (unsigned long long)nearest, (unsigned long long)paths);
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
    return status || !frame->dump ? status
                                  : assay_cache_queries_add(frame, &caches, &s->pair.materials);
}

const assay_method assay_method_radiance_cache = {
    .name    = "radiance-cache",
    .summary = "Radiance caching: as irradiance-cache, and indirect light on glossy surfaces from "
               "records in hemispherical harmonics.",
    .params  = PARAMS,
    .keeps_light = true,
    .create      = create,
    .prepare     = prepare,
    .render      = render,
    .destroy     = destroy,
};
