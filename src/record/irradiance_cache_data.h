/* irradiance_cache_data.h - inside of an irradiance cache; for irradiance_cache*.c alone. */
#ifndef ASSAY_RECORD_IRRADIANCE_CACHE_DATA_H
#define ASSAY_RECORD_IRRADIANCE_CACHE_DATA_H

#include "record/irradiance_cache.h"

/* Points that are looked at together.  Part of the result only with neighbour clamping, where
 * records shrink while a wave is served.  Of a wave, a worker takes a chunk at a time. */
enum { IRRADIANCE_CACHE_WAVE = 4096, IRRADIANCE_CACHE_CHUNK = 64 };

/* A worker's own; aligned apart by its size. */
typedef struct {
    assay_contributions found;
    uint64_t            unserved;
    uint32_t            last_reaching; /* record: a hint */
    bool                refused;       /* memory, inside a gathering */
    char                apart[64];
} irradiance_cache_worker;

struct assay_irradiance_cache {
    const assay_world              *world;
    assay_context                  *context;
    assay_irradiance_cache_settings settings;
    uint64_t                        seed;
    int                             level;
    double                          diagonal; /* m, of the scene */
    assay_record_store             *store;
    assay_hemisphere               *hemisphere;
    assay_ray_counts               *worker_counts;
    irradiance_cache_worker        *workers;
    bool                           *covered; /* a wave                              */
    assay_irradiance_cache         *next;
    bool                            borrows_next; /* it belongs to another cache     */
    assay_record_companion          companion;    /* keep NULL: none                 */
    assay_shadow_maps              *shadows;      /* NULL without; borrowed as next is */
    assay_gather_hit               *hits;         /* a wave: what cells see, and ...  */
    assay_cache_point              *seen;         /* ... ask; NULL but with secondary CACHE  */
};

/* Fills the cache's hemisphere with what the next record sees from the site.  Errors: as of
 * filling. */
assay_status irradiance_cache_gather(assay_irradiance_cache *cache, const assay_gather_site *site);

/* Gathers at a point and adds the record.  Errors: as of filling. */
assay_status irradiance_cache_add_record(assay_irradiance_cache  *cache,
                                         const assay_cache_point *point);

#endif
