/* irradiance_cache.c - filling and asking.
 *
 * Invariant: the store changes between waves alone, from the calling thread; workers write nothing
 * but their own scratch and counters. */
#include "record/irradiance_cache_data.h"

#include "core/alloc.h"
#include "core/numerics.h"
#include "core/parallel.h"

enum { WAVE = IRRADIANCE_CACHE_WAVE, CHUNK = IRRADIANCE_CACHE_CHUNK };

static const int BESIDE = 64; /* added to the level of a cache beside another one */

static bool allocate(assay_irradiance_cache *cache)
{
    const size_t threads = (size_t)assay_context_threads(cache->context);
    cache->worker_counts = assay_allocate(cache->context, threads, sizeof *cache->worker_counts);
    cache->workers       = assay_allocate(cache->context, threads, sizeof *cache->workers);
    cache->covered       = assay_allocate(cache->context, WAVE, sizeof *cache->covered);
    for (size_t i = 0; cache->workers && i < threads; i++) {
        cache->workers[i].found.context = cache->context;
    }
    if (cache->settings.secondary == ASSAY_SECONDARY_CACHE) {
        const size_t cells =
            (size_t)cache->settings.layout.theta * (size_t)cache->settings.layout.phi;
        const size_t block = cells < WAVE ? cells : WAVE;
        cache->hits        = assay_allocate(cache->context, block, sizeof *cache->hits);
        cache->seen        = assay_allocate(cache->context, block, sizeof *cache->seen);
    }
    const bool has_seen =
        cache->settings.secondary != ASSAY_SECONDARY_CACHE || (cache->hits && cache->seen);
    return cache->worker_counts && cache->workers && cache->covered && has_seen;
}

static void destroy(assay_irradiance_cache *cache)
{
    const int threads = cache->workers ? assay_context_threads(cache->context) : 0;
    for (int i = 0; i < threads; i++) {
        assay_contributions_release(&cache->workers[i].found);
    }
    assay_record_store_destroy(cache->store);
    assay_hemisphere_destroy(cache->context, cache->hemisphere);
    assay_release(cache->context, cache->worker_counts);
    assay_release(cache->context, cache->workers);
    assay_release(cache->context, cache->covered);
    assay_release(cache->context, cache->hits);
    assay_release(cache->context, cache->seen);
    assay_release(cache->context, cache);
}

void assay_irradiance_cache_destroy(assay_irradiance_cache *cache)
{
    while (cache) {
        assay_irradiance_cache *next = cache->borrows_next ? NULL : cache->next;
        if (!cache->borrows_next) {
            assay_shadow_maps_destroy(cache->shadows);
        }
        destroy(cache);
        cache = next;
    }
}

/* One level, without its next; NULL, and a status, where that fails. */
static assay_irradiance_cache *create_level(const assay_world                     *world,
                                            const assay_irradiance_cache_settings *settings,
                                            uint64_t seed, int level, assay_status *status_out)
{
    const assay_scene      *scene = world->scene;
    assay_irradiance_cache *cache = assay_allocate(scene->context, 1, sizeof *cache);
    if (!cache) {
        *status_out = assay_fail_memory(scene->context, "the irradiance cache");
        return NULL;
    }
    cache->world    = world;
    cache->context  = scene->context;
    cache->settings = *settings;
    cache->seed     = seed;
    cache->level    = level;
    cache->diagonal = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    assay_status status =
        allocate(cache) ? ASSAY_OK : assay_fail_memory(cache->context, "the irradiance cache");
    status = status
                 ? status
                 : assay_record_store_create(cache->context, &settings->rules, scene->bounds_min,
                                             scene->bounds_max, ASSAY_INDEX_OCTREE, &cache->store);
    status = status
                 ? status
                 : assay_hemisphere_create(cache->context, &settings->layout, &cache->hemisphere);
    if (status != ASSAY_OK) {
        destroy(cache);
        *status_out = status;
        return NULL;
    }
    return cache;
}

/* A level's light is seen through those above, each of which averages over many of its records and
 * dims it: half the rays will do, and records 1.4 times as far apart, as in [ward88].  (Not past
 * a = 1, beyond which several records are asked for.) */
static void relax(assay_irradiance_cache_settings *settings)
{
    assay_hemisphere_layout *layout = &settings->layout;
    assay_record_rules      *rules  = &settings->rules;
    if (rules->a < 1.0) {
        rules->a = fmin(1.0, rules->a * 1.41421356237309504880);
    }
    static const int least = 4;
    const int        theta = (int)(layout->theta * 0.70710678118654752440);
    const int        phi   = (int)(layout->phi * 0.70710678118654752440);
    layout->theta = theta < least ? (layout->theta < least ? layout->theta : least) : theta;
    layout->phi   = phi < least ? (layout->phi < least ? layout->phi : least) : phi;
}

/* A level sees one bounce less than the one above, and ends where direct light is all that is left
 * to ask. */
assay_status assay_irradiance_cache_create(const assay_world                     *world,
                                           const assay_irradiance_cache_settings *settings,
                                           uint64_t seed, assay_irradiance_cache **cache_out)
{
    assay_irradiance_cache_settings at    = *settings;
    assay_irradiance_cache         *first = NULL;
    assay_irradiance_cache        **place = &first;
    const int levels = settings->secondary == ASSAY_SECONDARY_CACHE ? settings->levels : 1;
    for (int level = 0; level < levels && (level == 0 || at.path.bounces >= 2); level++) {
        assay_status status = ASSAY_OK;
        *place              = create_level(world, &at, seed, level, &status);
        if (!*place) {
            assay_irradiance_cache_destroy(first);
            return status;
        }
        place = &(*place)->next;
        at.path.bounces -= at.path.bounces != ASSAY_BOUNCES_INF;
        relax(&at);
    }
    if (settings->shadow == ASSAY_SHADOW_MAP) {
        const assay_status status =
            assay_shadow_maps_create(world, &settings->shadow_maps, &first->shadows);
        if (status != ASSAY_OK) {
            assay_irradiance_cache_destroy(first);
            return status;
        }
    }
    *cache_out = first;
    return ASSAY_OK;
}

assay_status assay_irradiance_cache_create_beside(assay_irradiance_cache                *beside,
                                                  const assay_irradiance_cache_settings *settings,
                                                  const assay_record_companion          *companion,
                                                  assay_irradiance_cache               **cache_out)
{
    assay_status            status = ASSAY_OK;
    assay_irradiance_cache *cache =
        create_level(beside->world, settings, beside->seed, beside->level + BESIDE, &status);
    if (!cache) {
        return status;
    }
    cache->companion    = *companion;
    cache->next         = beside->next;
    cache->shadows      = beside->shadows;
    cache->borrows_next = true;
    *cache_out          = cache;
    return ASSAY_OK;
}

/* ---- asking ---- */

/* Eq. 2.9.  Up to a = 1 one record is enough, as its weight is at least 1 / a. */
static assay_status ask_enough(assay_irradiance_cache *cache, const assay_gather_site *site,
                               int worker, bool *enough_out)
{
    const assay_record_rules *rules = &cache->settings.rules;
    irradiance_cache_worker  *own   = &cache->workers[worker];
    if (rules->weight == ASSAY_WEIGHT_TABELLION || rules->a <= 1.0) {
        *enough_out = assay_record_store_reaches(cache->store, site->position, site->frame.z,
                                                 &own->last_reaching);
        return ASSAY_OK;
    }
    const assay_status status = assay_record_store_find(cache->store, site->position, site->frame.z,
                                                        UINT32_MAX, &own->found);
    *enough_out               = own->found.count > 0 && own->found.weight >= rules->a;
    return status;
}

/* HEURISTIC: where no record reaches, the one that would with the smallest a. */
static const assay_record *nearest(const assay_irradiance_cache *cache, assay_vec3 position,
                                   assay_vec3 normal, uint32_t limit)
{
    const assay_record_rules any         = {.a = 1e300, .weight = ASSAY_WEIGHT_WARD};
    const uint32_t           all         = assay_record_store_count(cache->store);
    const assay_record      *best        = NULL;
    double                   best_weight = 0.0;
    for (uint32_t i = 0; i < all && i < limit; i++) {
        const assay_record *record = assay_record_store_at(cache->store, i);
        const double        weight = assay_record_weight(record, &any, position, normal);
        if (!best || weight > best_weight) {
            best        = record;
            best_weight = weight;
        }
    }
    return best;
}

assay_status assay_irradiance_cache_find(assay_irradiance_cache *cache, assay_vec3 position,
                                         assay_vec3 normal, uint32_t limit, int worker,
                                         const assay_contributions **found_out)
{
    irradiance_cache_worker *own = &cache->workers[worker];
    const assay_status       status =
        assay_record_store_find(cache->store, position, normal, limit, &own->found);
    if (status == ASSAY_OK) {
        own->unserved += own->found.count == 0;
        *found_out = &own->found;
    }
    return status;
}

assay_status assay_irradiance_cache_look_up(assay_irradiance_cache *cache, assay_vec3 position,
                                            assay_vec3 normal, uint32_t limit, int worker,
                                            assay_rgb *irradiance_out)
{
    const assay_contributions *found = NULL;
    const assay_status         status =
        assay_irradiance_cache_find(cache, position, normal, limit, worker, &found);
    if (status != ASSAY_OK) {
        return status;
    }
    if (found->count > 0) {
        *irradiance_out = assay_record_store_interpolate(cache->store, found, position, normal);
        return ASSAY_OK;
    }
    const assay_record *record = nearest(cache, position, normal, limit);
    *irradiance_out            = record ? record->irradiance : rgb_grey(0.0);
    return ASSAY_OK;
}

assay_status assay_irradiance_cache_make(assay_irradiance_cache  *cache,
                                         const assay_cache_point *point)
{
    const assay_status status = irradiance_cache_add_record(cache, point);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(cache->context, "the irradiance cache")
                                      : status;
}

/* ---- filling ---- */

typedef struct {
    assay_irradiance_cache  *cache;
    const assay_cache_point *points;
    size_t                   count;
} fill_wave;

static assay_status look_at_points(void *user, uint64_t chunk, int worker)
{
    const fill_wave        *wave  = user;
    assay_irradiance_cache *cache = wave->cache;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < wave->count; i++) {
        const assay_cache_point *point = &wave->points[i];
        cache->covered[i]              = true;
        if (point->wanted &&
            ask_enough(cache, &point->site, worker, &cache->covered[i]) != ASSAY_OK) {
            return ASSAY_ERR_MEMORY;
        }
    }
    return ASSAY_OK;
}

static assay_status serve(assay_irradiance_cache *cache, const assay_cache_point *point)
{
    bool               enough = false;
    const assay_status status = ask_enough(cache, &point->site, 0, &enough);
    if (status != ASSAY_OK || enough ||
        assay_record_store_count(cache->store) >= cache->settings.max_records) {
        return status;
    }
    return irradiance_cache_add_record(cache, point);
}

assay_status assay_irradiance_cache_fill(assay_irradiance_cache *cache, const char *phase,
                                         uint64_t before, uint64_t total, size_t count,
                                         const assay_cache_point *points, uint32_t *limits_out)
{
    assay_status status = ASSAY_OK;
    for (size_t first = 0; first < count && status == ASSAY_OK; first += WAVE) {
        fill_wave wave = {cache, points + first, count - first < WAVE ? count - first : WAVE};
        status         = assay_parallel_for(cache->context, NULL, (wave.count + CHUNK - 1) / CHUNK,
                                            look_at_points, &wave);
        for (size_t i = 0; i < wave.count && status == ASSAY_OK; i++) {
            if (!cache->covered[i]) {
                status = serve(cache, &wave.points[i]);
                if (status == ASSAY_OK && phase) {
                    status = assay_progress(cache->context, phase, before + first + i, total);
                }
            }
            if (limits_out) {
                limits_out[first + i] = assay_record_store_count(cache->store);
            }
        }
    }
    if (status == ASSAY_ERR_MEMORY) {
        return assay_fail_memory(cache->context, "the irradiance cache");
    }
    return status;
}

/* ---- what became of it ---- */

assay_record_store *assay_irradiance_cache_store(assay_irradiance_cache *cache)
{
    return cache->store;
}

assay_irradiance_cache *assay_irradiance_cache_next(const assay_irradiance_cache *cache)
{
    return cache->next;
}

uint64_t assay_irradiance_cache_unserved(const assay_irradiance_cache *cache)
{
    uint64_t sum = 0;
    for (int i = 0; i < assay_context_threads(cache->context); i++) {
        sum += cache->workers[i].unserved;
    }
    return sum;
}

void assay_irradiance_cache_count(const assay_irradiance_cache *cache, assay_ray_counts *counts)
{
    for (; cache; cache = cache->borrows_next ? NULL : cache->next) {
        counts->records += assay_record_store_count(cache->store);
        for (int i = 0; i < assay_context_threads(cache->context); i++) {
            assay_ray_counts_add(counts, &cache->worker_counts[i]);
        }
    }
}

void assay_irradiance_cache_restart_counts(assay_irradiance_cache *cache)
{
    for (; cache; cache = cache->borrows_next ? NULL : cache->next) {
        for (int i = 0; i < assay_context_threads(cache->context); i++) {
            cache->worker_counts[i]    = (assay_ray_counts){0};
            cache->workers[i].unserved = 0;
        }
    }
}
