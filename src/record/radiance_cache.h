/* radiance_cache.h - incident indirect radiance from records that are made where they are missing.
 *
 * Radiance caching [krivanek05, as in gautron06 2.2.6]: an irradiance cache (irradiance_cache.h:
 * where records are made, how far they reach, what they weigh) whose records keep the hemisphere
 * that they come from as coefficients in HSH, with translational gradients.  Asked at a point, each
 * record that contributes is moved there by its gradients, turned into the point's frame, and
 * averaged by weight. */
#ifndef ASSAY_RECORD_RADIANCE_CACHE_H
#define ASSAY_RECORD_RADIANCE_CACHE_H

#include "record/irradiance_cache.h"
#include "record/radiance_rows.h"

typedef enum {
    ASSAY_COEFFICIENT_GRADIENT_NONE,
    ASSAY_COEFFICIENT_GRADIENT_POINTS, /* ASSAY_GRADIENT_POINTS */
    ASSAY_COEFFICIENT_GRADIENT_WALLS   /* ASSAY_GRADIENT_WALLS  */
} assay_coefficient_gradient;

typedef struct {
    assay_irradiance_cache_settings records; /* layout.strata is taken as UNIFORM               */
    int                             order;   /* of HSH, 1 ... ASSAY_BASIS_MAX_ORDER             */
    assay_coefficient_gradient      gradient;
    assay_hsh_rotation_way          rotation;
    int rotation_steps; /* TABLE, DIGON: intervals up to the largest tilt at which a record counts
                         */
    int    sh_order; /* CONVERSION: of the SH between                                           */
    double widest_a; /* turns serve records that count at this a, if it is more than theirs   */
} assay_radiance_cache_settings;

typedef struct assay_radiance_cache assay_radiance_cache;

/* Beside the cache of irradiance of the same scene, which answers for its rays' ends, and must
 * outlive it.  Errors: ARGUMENT, MEMORY, CANCELLED. */
assay_status assay_radiance_cache_create(assay_context *context, assay_irradiance_cache *beside,
                                         const assay_radiance_cache_settings *settings,
                                         assay_radiance_cache               **cache_out);
void         assay_radiance_cache_destroy(assay_radiance_cache *cache);

/* HSH, convention THESIS. */
const assay_basis *assay_radiance_cache_basis(const assay_radiance_cache *cache);

/* The records: assay_irradiance_cache_fill fills them, counts their rays and the look-ups that none
 * of them served. */
assay_irradiance_cache *assay_radiance_cache_records(assay_radiance_cache *cache);

/* Coefficients of a record, W/(m2 sr), 3 rows of count, in frame3_from_z of its normal; and their
 * gradients there, W/(m3 sr), or NULL without.  Borrowed until the next filling. */
const double *assay_radiance_cache_coefficients(const assay_radiance_cache *cache, uint32_t number);
const assay_vec3 *assay_radiance_cache_gradients(const assay_radiance_cache *cache,
                                                 uint32_t                    number);

bool assay_radiance_cache_has_gradients(const assay_radiance_cache *cache);

/* Rows of saved records, which are to be added to the store of the records next, in this order:
 * coefficients, and where the cache has gradients 3 numbers a coefficient.  Errors: MEMORY. */
assay_status assay_radiance_cache_take_rows(assay_radiance_cache *cache, size_t rows,
                                            const double *coefficients, const double *gradients);

/* What the records say, for those who find them by themselves.  Borrowed until the next filling. */
assay_radiance_rows assay_radiance_cache_rows(const assay_radiance_cache *cache);

/* What one record says of the radiance at a point, 3 rows of count, in the frame `here`, whose z is
 * the normal there.  Errors: DOMAIN (no frame). */
assay_status assay_radiance_cache_say(assay_radiance_cache *cache, uint32_t number,
                                      assay_vec3 position, const assay_frame3 *here, int worker,
                                      double *coefficients_out);

/* Coefficients of a function, 3 rows of count, from one frame into another of the same z, in place.
 * Errors: DOMAIN (no frame). */
assay_status assay_radiance_cache_turn(assay_radiance_cache *cache, const assay_frame3 *from,
                                       const assay_frame3 *to, int worker, double *coefficients);

/* Coefficients of what arrives at a point, 3 rows of count, in the frame given (orthonormal, z the
 * normal), from the records numbered below `limit`.  *found_out false, and nothing else written:
 * none reaches the point.  Allocates nothing but room for longer lists of records.  Errors:
 * MEMORY, DOMAIN (no frame). */
assay_status assay_radiance_cache_look_up(assay_radiance_cache *cache, assay_vec3 position,
                                          const assay_frame3 *frame, uint32_t limit, int worker,
                                          double *coefficients_out, bool *found_out);

#endif
