/* irradiance_cache.h - indirect irradiance from records that are made where they are missing.
 *
 * The cache of [gautron06] algorithm 1: asked at a point, it interpolates; where too little is
 * known there, a hemisphere is gathered and kept.  A cache may stand on another one that answers at
 * what its gathering rays hit, a level a bounce, as in [ward88].
 *
 * Points are looked at in waves against a store that stands still; what is missing is then made one
 * by one, in the order of the points, each looked at again, with threads at work inside each
 * hemisphere.  So the records are those of the serial algorithm, for any number of threads. */
#ifndef ASSAY_RECORD_IRRADIANCE_CACHE_H
#define ASSAY_RECORD_IRRADIANCE_CACHE_H

#include "gather/gather.h"
#include "gather/shadow_map.h"
#include "record/record_store.h"

/* What is known of the light where a gathering ray ends. */
typedef enum {
    ASSAY_SECONDARY_DIRECT, /* its direct light: one indirect bounce in all [gautron06]      */
    ASSAY_SECONDARY_PATH,   /* a path goes on from there: all bounces, unbiased              */
    ASSAY_SECONDARY_CACHE   /* direct light, and a cache of its own for the rest [ward88]    */
} assay_secondary;

/* How direct light is shadowed where a gathering ray ends. */
typedef enum { ASSAY_SHADOW_RAY, ASSAY_SHADOW_MAP } assay_shadow;

#define ASSAY_CACHE_MAX_LEVELS 8

typedef struct {
    assay_hemisphere_layout layout;
    assay_record_rules      rules;
    assay_mean_weight       mean;
    double                  r_min, r_max;               /* m; 0 and INFINITY: no limit          */
    double                  r_min_pixels, r_max_pixels; /* in footprints of the point; the same */
    bool                    gradient_limit;             /* R <= E / |gradient| [krivanek05]     */
    bool                    neighbour_clamp;            /* [krivanek06]                         */
    bool                    normal_gradient;            /* along the normal, too                */
    uint32_t                max_records;                /* a level                              */
    assay_secondary         secondary;
    assay_shadow            shadow;      /* MAP with DIRECT alone                */
    assay_shadow_settings   shadow_maps; /* of MAP                               */
    int                 levels; /* of CACHE: 1 ... ASSAY_CACHE_MAX_LEVELS; paths go on below   */
    assay_path_settings path;   /* bounces: of the image, so that 2 is one indirect bounce    */
} assay_irradiance_cache_settings;

/* Where the cache is asked. */
typedef struct {
    assay_gather_site site;
    double            footprint; /* m: size of a pixel there; 0 where it is not known             */
    bool              wanted;    /* false: nothing is asked here                                  */
} assay_cache_point;

typedef struct assay_irradiance_cache assay_irradiance_cache;

/* The world must outlive the cache.  Errors: ARGUMENT, MEMORY. */
assay_status assay_irradiance_cache_create(const assay_world                     *world,
                                           const assay_irradiance_cache_settings *settings,
                                           uint64_t seed, assay_irradiance_cache **cache_out);
void         assay_irradiance_cache_destroy(assay_irradiance_cache *cache);

/* Something that is kept beside each record of a cache: called with the hemisphere that the record
 * comes from, from the thread that fills, before the record gets its number.  An error ends the
 * filling without that record. */
typedef struct {
    assay_status (*keep)(void *user, uint32_t number, const assay_hemisphere *hemisphere);
    void *user;
} assay_record_companion;

/* A cache of the same light as `beside`, which must outlive it: with records of its own from other
 * random numbers, a companion, and the levels below of `beside` for its own.  Errors: ARGUMENT,
 * MEMORY. */
assay_status assay_irradiance_cache_create_beside(assay_irradiance_cache                *beside,
                                                  const assay_irradiance_cache_settings *settings,
                                                  const assay_record_companion          *companion,
                                                  assay_irradiance_cache               **cache_out);

/* Makes records until every wanted point knows enough (eq. 2.9), or max_records are there.
 * limits_out, if not NULL: how many records there were when each point had been served; a look-up
 * limited to them is what a single pass would have seen.  phase: for the progress, with `before`
 * points done of `total`; NULL: none.  Errors: MEMORY, DOMAIN (light that is no finite number),
 * CANCELLED. */
assay_status assay_irradiance_cache_fill(assay_irradiance_cache *cache, const char *phase,
                                         uint64_t before, uint64_t total, size_t count,
                                         const assay_cache_point *points, uint32_t *limits_out);

/* Makes a record at a point, whatever is known there: for those who know by other means what is
 * missing.  Errors: as of filling. */
assay_status assay_irradiance_cache_make(assay_irradiance_cache  *cache,
                                         const assay_cache_point *point);

/* What a look-up sums over: the records numbered below `limit` that contribute at a point.  The
 * list is the worker's, until its next look-up.  Errors: MEMORY. */
assay_status assay_irradiance_cache_find(assay_irradiance_cache *cache, assay_vec3 position,
                                         assay_vec3 normal, uint32_t limit, int worker,
                                         const assay_contributions **found_out);

/* Indirect irradiance at a point, W/m2, from the records numbered below `limit` (UINT32_MAX: all).
 * Where none of them reaches the point the nearest by weight speaks for it, and the look-up counts
 * as unserved; 0 without any record.  Errors: MEMORY. */
assay_status assay_irradiance_cache_look_up(assay_irradiance_cache *cache, assay_vec3 position,
                                            assay_vec3 normal, uint32_t limit, int worker,
                                            assay_rgb *irradiance_out);

/* The first level's records; the next level, or NULL. */
assay_record_store     *assay_irradiance_cache_store(assay_irradiance_cache *cache);
assay_irradiance_cache *assay_irradiance_cache_next(const assay_irradiance_cache *cache);
/* Look-ups that no record reached, of this level. */
uint64_t assay_irradiance_cache_unserved(const assay_irradiance_cache *cache);
/* Rays and unserved look-ups are counted from 0 again, of all levels but those that belong to
 * another cache. */
void assay_irradiance_cache_restart_counts(assay_irradiance_cache *cache);
/* Adds the rays traced so far and the records there are, of all levels but
 * those that belong to another cache. */
void assay_irradiance_cache_count(const assay_irradiance_cache *cache, assay_ray_counts *counts);

#endif
