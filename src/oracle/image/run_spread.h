/* run_spread.h - what several runs of one candidate say about its noise.
 *
 * Runs differ in their random numbers alone.  Their spread gives each pixel's variance, and the
 * spread of their sums over tiles tells whether pixels are independent: a cache's noise is not. */
#ifndef ASSAY_ORACLE_RUN_SPREAD_H
#define ASSAY_ORACLE_RUN_SPREAD_H

#include "oracle/image/tile_sums.h"

/* Mean of the runs, and the variance of that mean. count >= 2. */
void assay_run_spread_pixels(const float *const *runs, int count, size_t pixels, float *mean_out,
                             float *variance_out);

typedef struct {
    /* Variance of sums over tiles of each level, and over the whole, over what independent pixels
     * would have (Kish's design effect [kish65]); at least 1. */
    double design[ASSAY_TILE_LEVELS + 1];
    /* Of the sum over the whole image, where pixels are not independent: at least that of the runs'
     * own sums, with count - 1 degrees of freedom.  0 where they are. */
    double whole_variance, whole_degrees;
} assay_run_spread;

/* pair is that of the mean of the runs, sums is its sums.  Errors: MEMORY, CANCELLED. */
assay_status assay_run_spread_make(assay_context *context, const float *const *runs, int count,
                                   const assay_noisy_pair *pair, const assay_tile_sums *sums,
                                   assay_run_spread *spread_out);

#endif
