/* verify_channel.h - one channel of a candidate's runs and of a reference, made ready for tests. */
#ifndef ASSAY_ORACLE_VERIFY_CHANNEL_H
#define ASSAY_ORACLE_VERIFY_CHANNEL_H

#include "assay/verify.h"
#include "oracle/image/neighbours.h"
#include "oracle/image/noise_model.h"
#include "oracle/image/pixel_test.h"
#include "oracle/image/tile_sums.h"

enum { ASSAY_CHANNEL_NAME = 256 };

/* What can be said of the noise of the candidate. */
typedef enum {
    ASSAY_NOISE_OWN,  /* it has a variance                                 */
    ASSAY_NOISE_RUNS, /* from the differences of runs                      */
    ASSAY_NOISE_ALONE /* nothing: from differences to the reference        */
} assay_noise_source;

typedef struct {
    const char        *stage;
    char               name[ASSAY_CHANNEL_NAME];
    const char        *problem; /* why it cannot be tested: a sentence; NULL */
    const char        *problem_test;
    assay_place        problem_place;
    double             problem_value; /* NaN where it is none of the candidate's */
    assay_noise_source source;
    assay_noisy_pair   pair; /* valid until released                     */
    float             *run_mean, *run_variance;
    assay_tile_sums    sums;
    assay_noise_model  model;
    double             design[ASSAY_TILE_LEVELS + 1]; /* of tiles, and of the whole */
    double whole_degrees; /* of the whole's variance, where it comes from runs alone; 0 */
    double whole_run_variance;
    assay_pixel_result pixels;
    assay_neighbours   neighbours; /* of a single candidate; else 0 */
} assay_verify_channel;

/* Fills channel but for name and stage, from channels of these names and their variances and
 * counts.  What forbids a test is a problem, no error.  Errors: MEMORY, CANCELLED. */
assay_status assay_verify_channel_prepare(assay_context            *context,
                                          const assay_image *const *candidates, int count,
                                          const assay_image          *reference,
                                          const assay_verify_options *options,
                                          assay_verify_channel       *channel);

void assay_verify_channel_release(assay_context *context, assay_verify_channel *channel);

/* Variance of the sum of differences over a tile of a level, or the whole (tile NULL). */
assay_noise assay_verify_channel_noise(const assay_verify_channel *channel, int level,
                                       const assay_noisy_sums *sums);

#endif
