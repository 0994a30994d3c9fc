/* radiance_cache.c - coefficients beside records, and asking for them.
 *
 * Invariant: record k of the store has row k of coefficients and gradients.  A row is written
 * before its record is added, so that a record without a row never is. */
#include "record/radiance_cache.h"

#include <assert.h>

#include "core/alloc.h"
#include "core/context.h"
#include "record/radiance_turn.h"

enum { CHANNELS = 3 };

struct assay_radiance_cache {
    assay_context                *context;
    assay_radiance_cache_settings settings;
    int                           workers;
    assay_basis                  *hsh;
    size_t                        count; /* coefficients of a record: CHANNELS rows          */
    assay_irradiance_cache       *records;
    assay_radiance_turn          *turn;
    double                       *coefficients;      /* rows of count                             */
    assay_vec3                   *gradients;         /* the same, local; NULL without             */
    size_t  coefficient_capacity, gradient_capacity; /* rows                                   */
    double *scratch; /* a worker: two rows                             */
};

void assay_radiance_cache_destroy(assay_radiance_cache *cache)
{
    if (cache) {
        assay_radiance_turn_destroy(cache->turn);
        assay_irradiance_cache_destroy(cache->records);
        assay_basis_destroy(cache->hsh);
        assay_release(cache->context, cache->coefficients);
        assay_release(cache->context, cache->gradients);
        assay_release(cache->context, cache->scratch);
        assay_release(cache->context, cache);
    }
}

bool assay_radiance_cache_has_gradients(const assay_radiance_cache *cache)
{
    return cache->settings.gradient != ASSAY_COEFFICIENT_GRADIENT_NONE;
}

/* ---- records ---- */

static assay_status make_room(assay_radiance_cache *cache, size_t rows)
{
    void        *grown  = cache->coefficients;
    assay_status status = assay_grow(cache->context, &grown, &cache->coefficient_capacity, rows,
                                     cache->count * sizeof(double));
    cache->coefficients = grown;
    if (status != ASSAY_OK || !assay_radiance_cache_has_gradients(cache)) {
        return status;
    }
    grown            = cache->gradients;
    status           = assay_grow(cache->context, &grown, &cache->gradient_capacity, rows,
                                  cache->count * sizeof(assay_vec3));
    cache->gradients = grown;
    return status;
}

static assay_status keep(void *user, uint32_t number, const assay_hemisphere *hemisphere)
{
    assay_radiance_cache *cache  = user;
    assay_status          status = make_room(cache, (size_t)number + 1);
    if (status == ASSAY_OK) {
        status = assay_hemisphere_project(hemisphere, cache->context, cache->hsh,
                                          cache->coefficients + number * cache->count);
    }
    return status != ASSAY_OK || !assay_radiance_cache_has_gradients(cache)
               ? status
               : assay_hemisphere_project_gradient(hemisphere, cache->context, cache->hsh,
                                                   cache->settings.gradient ==
                                                           ASSAY_COEFFICIENT_GRADIENT_WALLS
                                                       ? ASSAY_GRADIENT_WALLS
                                                       : ASSAY_GRADIENT_POINTS,
                                                   cache->gradients + number * cache->count);
}

assay_status assay_radiance_cache_take_rows(assay_radiance_cache *cache, size_t rows,
                                            const double *coefficients, const double *gradients)
{
    const size_t first = assay_record_store_count(assay_irradiance_cache_store(cache->records));
    const assay_status status = rows ? make_room(cache, first + rows) : ASSAY_OK;
    if (status != ASSAY_OK) {
        return assay_fail_memory(cache->context, "the radiance cache");
    }
    for (size_t i = 0; i < rows * cache->count; i++) {
        cache->coefficients[first * cache->count + i] = coefficients[i];
        if (assay_radiance_cache_has_gradients(cache)) {
            cache->gradients[first * cache->count + i] =
                vec3(gradients[3 * i], gradients[3 * i + 1], gradients[3 * i + 2]);
        }
    }
    return ASSAY_OK;
}

static assay_status create_parts(assay_radiance_cache *cache, assay_irradiance_cache *beside)
{
    assay_radiance_cache_settings *s         = &cache->settings;
    const assay_record_companion   companion = {.keep = keep, .user = cache};
    assay_status status = assay_basis_create(cache->context, ASSAY_BASIS_HSH, s->order,
                                             ASSAY_CONVENTION_THESIS, &cache->hsh);
    if (status != ASSAY_OK) {
        return status;
    }
    cache->count = CHANNELS * assay_basis_count(cache->hsh);
    cache->scratch =
        assay_allocate(cache->context, (size_t)cache->workers, 2 * cache->count * sizeof(double));
    if (!cache->scratch) {
        return assay_fail_memory(cache->context, "the radiance cache");
    }
    assay_record_rules widest                  = s->records.rules;
    widest.a                                   = s->widest_a > widest.a ? s->widest_a : widest.a;
    const assay_radiance_turn_settings turning = {
        .way      = s->rotation,
        .steps    = s->rotation_steps,
        .sh_order = s->sh_order,
        .tilt_max = assay_record_tilt_max(&widest),
    };
    status = assay_irradiance_cache_create_beside(beside, &s->records, &companion, &cache->records);
    return status ? status
                  : assay_radiance_turn_create(cache->context, cache->hsh, &turning, cache->workers,
                                               &cache->turn);
}

assay_status assay_radiance_cache_create(assay_context *context, assay_irradiance_cache *beside,
                                         const assay_radiance_cache_settings *settings,
                                         assay_radiance_cache               **cache_out)
{
    assay_radiance_cache *cache = assay_allocate(context, 1, sizeof *cache);
    if (!cache) {
        return assay_fail_memory(context, "the radiance cache");
    }
    cache->context  = context;
    cache->settings = *settings;
    cache->workers  = assay_context_threads(context);
    if (settings->records.layout.strata != ASSAY_STRATA_PLANE) {
        cache->settings.records.layout.strata = ASSAY_STRATA_UNIFORM;
    }
    const assay_status status = create_parts(cache, beside);
    if (status != ASSAY_OK) {
        assay_radiance_cache_destroy(cache);
        return status;
    }
    *cache_out = cache;
    return ASSAY_OK;
}

const assay_basis *assay_radiance_cache_basis(const assay_radiance_cache *cache)
{
    return cache->hsh;
}

assay_irradiance_cache *assay_radiance_cache_records(assay_radiance_cache *cache)
{
    return cache->records;
}

const double *assay_radiance_cache_coefficients(const assay_radiance_cache *cache, uint32_t number)
{
    assert(number < assay_record_store_count(assay_irradiance_cache_store(cache->records)));
    return cache->coefficients + number * cache->count;
}

const assay_vec3 *assay_radiance_cache_gradients(const assay_radiance_cache *cache, uint32_t number)
{
    assert(number < assay_record_store_count(assay_irradiance_cache_store(cache->records)));
    return assay_radiance_cache_has_gradients(cache) ? cache->gradients + number * cache->count
                                                     : NULL;
}

/* ---- asking ---- */

static assay_radiance_rows rows_of(const assay_radiance_cache *cache)
{
    return (assay_radiance_rows){
        .count        = cache->count,
        .coefficients = cache->coefficients,
        .gradients    = assay_radiance_cache_has_gradients(cache) ? cache->gradients : NULL,
        .turn         = cache->turn};
}

assay_radiance_rows assay_radiance_cache_rows(const assay_radiance_cache *cache)
{
    return rows_of(cache);
}

assay_status assay_radiance_cache_say(assay_radiance_cache *cache, uint32_t number,
                                      assay_vec3 position, const assay_frame3 *here, int worker,
                                      double *coefficients_out)
{
    const assay_radiance_rows rows = rows_of(cache);
    const assay_record       *record =
        assay_record_store_at(assay_irradiance_cache_store(cache->records), number);
    return assay_radiance_rows_say(&rows, record, number, position, here, worker, coefficients_out);
}

assay_status assay_radiance_cache_turn(assay_radiance_cache *cache, const assay_frame3 *from,
                                       const assay_frame3 *to, int worker, double *coefficients)
{
    const assay_radiance_rows rows = rows_of(cache);
    return assay_radiance_rows_turn(&rows, from, to, worker, coefficients);
}

assay_status assay_radiance_cache_look_up(assay_radiance_cache *cache, assay_vec3 position,
                                          const assay_frame3 *frame, uint32_t limit, int worker,
                                          double *coefficients_out, bool *found_out)
{
    const assay_radiance_rows  rows  = rows_of(cache);
    const assay_contributions *found = NULL;
    assay_status               status =
        assay_irradiance_cache_find(cache->records, position, frame->z, limit, worker, &found);
    if (status != ASSAY_OK || found->count == 0) {
        *found_out = status ? *found_out : false;
        return status;
    }
    status = assay_radiance_rows_mean(
        &rows, assay_record_store_at(assay_irradiance_cache_store(cache->records), 0), found,
        position, frame, worker, cache->scratch + (size_t)worker * 2 * cache->count,
        coefficients_out);
    if (status == ASSAY_OK) {
        *found_out = true;
    }
    return status;
}
