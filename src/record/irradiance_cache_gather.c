/* irradiance_cache_gather.c - the light that the hemisphere of a record brings.
 *
 * Invariant: where a cache stands on another one, that one knows enough wherever a block of cells
 * looks before any of them asks it; so it stands still while workers look it up, and its records
 * are made in the order of the cells. */
#include "record/irradiance_cache_data.h"

#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"

enum { WAVE = IRRADIANCE_CACHE_WAVE, CHUNK = IRRADIANCE_CACHE_CHUNK };

/* A level's hemispheres are numbered in streams of their own. */
static const int LEVEL_SHIFT = 56;

/* Where a path goes on: everything that leaves the vertex, direct light among it. */
static assay_rgb light_by_path(void *user, int cell, assay_vertex *vertex, assay_random *random,
                               int worker)
{
    const assay_irradiance_cache *cache = user;
    assay_path_settings           path  = cache->settings.path;
    (void)cell;
    path.bounces = cache->settings.secondary == ASSAY_SECONDARY_DIRECT ? 1
                   : path.bounces == ASSAY_BOUNCES_INF                 ? path.bounces
                                                                       : path.bounces - 1;
    const assay_path_light light =
        assay_path_scatter(cache->world, &path, vertex, random, &cache->worker_counts[worker]);
    return rgb_add(light.direct, light.indirect);
}

static assay_rgb light_by_map(void *user, int cell, assay_vertex *vertex, assay_random *random,
                              int worker)
{
    const assay_irradiance_cache *cache = user;
    (void)cell;
    return assay_shadow_maps_light(cache->shadows, vertex, random, &cache->worker_counts[worker]);
}

/* Where the next level answers, what it will be asked is told to it before. */
typedef struct {
    assay_irradiance_cache *cache;
    size_t                  count;
} seen_points;

static assay_status note_points(void *user, uint64_t chunk, int worker)
{
    const seen_points      *seen  = user;
    assay_irradiance_cache *cache = seen->cache;
    (void)worker;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < seen->count; i++) {
        cache->seen[i] = (assay_cache_point){.wanted = false};
        if (cache->hits[i].hit) {
            assay_vertex *vertex = &cache->hits[i].vertex;
            assay_vertex_dress(cache->world, vertex);
            const assay_bsdf_view view = assay_bsdf_seen_from(&vertex->bsdf, vertex->wo_local);
            cache->seen[i]             = (assay_cache_point){
                            .site   = assay_gather_site_of(vertex),
                            .wanted = !rgb_is_black(assay_bsdf_view_lambert(&view)),
            };
        }
    }
    return ASSAY_OK;
}

static assay_rgb light_by_cache(void *user, int cell, assay_vertex *vertex, assay_random *random,
                                int worker)
{
    assay_irradiance_cache *cache  = user;
    assay_ray_counts       *counts = &cache->worker_counts[worker];
    assay_path_settings     path   = cache->next->settings.path;
    (void)cell;
    const assay_bsdf_view view    = assay_bsdf_seen_from(&vertex->bsdf, vertex->wo_local);
    const assay_rgb       lambert = assay_bsdf_view_lambert(&view);
    assay_rgb             cached  = rgb_grey(0.0);
    if (!rgb_is_black(lambert)) {
        const assay_gather_site site = assay_gather_site_of(vertex);
        if (assay_irradiance_cache_look_up(cache->next, site.position, site.frame.z, UINT32_MAX,
                                           worker, &cached) != ASSAY_OK) {
            cache->workers[worker].refused = true;
            return rgb_grey(NAN);
        }
        cached = rgb_scale(rgb_mul(cached, lambert), ASSAY_INV_PI);
    }
    if (vertex->bsdf.model != ASSAY_BSDF_LAMBERT) {
        cached = rgb_add(cached,
                         assay_path_indirect(cache->world, &path, vertex, lambert, random, counts));
    }
    path.bounces = 1;
    return rgb_add(cached, assay_path_scatter(cache->world, &path, vertex, random, counts).direct);
}

/* Asks the next level to know enough wherever a block of cells looks, and then for the light. */
static assay_status gather_block(assay_irradiance_cache *cache, const assay_gatherer *gatherer,
                                 const assay_gather_site *site, uint64_t item, int first, int count)
{
    seen_points  seen = {cache, (size_t)count};
    assay_status status =
        assay_gather_rays(gatherer, site, item, first, count, cache->hemisphere, cache->hits);
    status = status ? status
                    : assay_parallel_for(cache->context, NULL, (seen.count + CHUNK - 1) / CHUNK,
                                         note_points, &seen);
    status = status ? status
                    : assay_irradiance_cache_fill(cache->next, NULL, 0, 0, seen.count, cache->seen,
                                                  NULL);
    return status ? status
                  : assay_gather_light(gatherer, first, count, cache->hits, cache->hemisphere);
}

assay_status irradiance_cache_gather(assay_irradiance_cache *cache, const assay_gather_site *site)
{
    const assay_gatherer gatherer = {.world         = cache->world,
                                     .seed          = cache->seed,
                                     .radiance      = cache->next      ? light_by_cache
                                                      : cache->shadows ? light_by_map
                                                                       : light_by_path,
                                     .user          = cache,
                                     .worker_counts = cache->worker_counts};
    const uint64_t       item =
        (uint64_t)cache->level << LEVEL_SHIFT | assay_record_store_count(cache->store);
    if (!cache->next) {
        return assay_gather(&gatherer, site, item, cache->hemisphere);
    }
    const int    cells  = cache->settings.layout.theta * cache->settings.layout.phi;
    assay_status status = ASSAY_OK;
    for (int first = 0; first < cells && status == ASSAY_OK; first += WAVE) {
        const int count = cells - first < WAVE ? cells - first : WAVE;
        status          = gather_block(cache, &gatherer, site, item, first, count);
    }
    for (int i = 0; status != ASSAY_OK && i < assay_context_threads(cache->context); i++) {
        if (cache->workers[i].refused) {
            return assay_fail_memory(cache->context, "a look into the irradiance cache");
        }
    }
    return status;
}
