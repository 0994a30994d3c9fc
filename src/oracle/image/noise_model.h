/* noise_model.h - how far apart two noisy means may be that are the same light.
 *
 * A path tracer's samples are skewed: a pixel that missed its rare bright ones has too small a mean
 * and too small a variance at once, and the plain t is too large too often.  So there are several
 * views of the variance of a difference: both own variances; the reference's, on the understanding
 * that the candidate's is in proportion to it, as it is near there and in the whole image; the
 * candidate's, likewise; and of pixels, what is usual near there (docs/verdicts.md, "Variance"). */
#ifndef ASSAY_ORACLE_NOISE_MODEL_H
#define ASSAY_ORACLE_NOISE_MODEL_H

#include "oracle/image/noise.h"
#include "oracle/image/tile_sums.h"

/* Near a tile of the smallest size. */
typedef struct {
    double up, down;             /* candidate's variance over the reference's, and the other way */
    double candidate, reference; /* variances of a pixel                                         */
    double candidate_event, reference_event; /* variance over mean: a sample's usual light over
                                                the samples of a pixel                           */
} assay_local_noise;

typedef struct {
    assay_context     *context;
    assay_local_noise *tiles;
    int                side, columns;
    bool               alone; /* differences stand for the candidate's variance, which is unknown */
} assay_noise_model;

typedef enum {
    ASSAY_NOISE_MODEL_BOTH,   /* candidate and reference have variances                         */
    ASSAY_NOISE_MODEL_ALONE,  /* the candidate's is not known and taken from the differences    */
    ASSAY_NOISE_MODEL_FIXED,  /* the candidate is taken as it is: its noise counts as an error  */
    ASSAY_NOISE_MODEL_COUNTED /* as BOTH, and a sample of the candidate is no less noisy than one
                                 of the reference                                              */
} assay_noise_model_kind;

/* From the sums of the smallest tiles, in which it then fills in what it says of each.
 * Errors: MEMORY. */
assay_status assay_noise_model_fit(assay_context *context, assay_tile_level *tiles,
                                   assay_noise_model_kind kind, assay_noise_model *model_out);
/* Fills in, of tiles of all sizes and of the whole, what light lets expect near there; once larger
 * tiles are gathered. */
void assay_noise_model_light(assay_tile_sums *sums);
void assay_noise_model_release(assay_noise_model *model);

/* Of the tile that the pixel is in. */
const assay_local_noise *assay_noise_near(const assay_noise_model *model, int x, int y);

/* Of the sum of differences over a tile of any size, or the whole.  design: see run_spread.h; 1 for
 * independent pixels. */
assay_noise assay_noise_of_region(const assay_noise_model *model, const assay_noisy_sums *sums,
                                  double design);
/* Of a pixel. */
assay_noise assay_noise_of_pixel(const assay_noise_model *model, const assay_noisy_pair *pair,
                                 size_t pixel);

/* Size of the difference after what rounding may have done; at least 0. */
static inline double assay_noisy_size(const assay_noisy_sums *sums)
{
    return fmax(0.0, fabs(sums->difference) - sums->rounding);
}

#endif
