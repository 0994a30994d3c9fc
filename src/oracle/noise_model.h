/* noise_model.h - how far apart two noisy means may be that are the same light.
 *
 * A path tracer's samples are skewed: a pixel that missed its rare bright ones has too small a mean
 * and too small a variance at once, and the plain t is too large too often.  So the variance of a
 * difference is the largest of what three say: both own variances; the reference's, on the
 * understanding that the candidate's is in proportion to it; and the candidate's, likewise
 * (docs/verdicts.md, "Variance"). */
#ifndef ASSAY_ORACLE_NOISE_MODEL_H
#define ASSAY_ORACLE_NOISE_MODEL_H

#include "oracle/noisy_pair.h"

typedef struct {
    double ratio_up;   /* candidate's variance over the reference's, as the image has it       */
    double ratio_down; /* reference's over the candidate's; 0 where one has none               */
    bool   alone;      /* the candidate's variance is not known: squares of differences for it */
    double design;     /* variance of sums over that of independent pixels, at least 1         */
} assay_noise_model;

/* From the sums of tiles of one size; scratch holds count doubles. */
assay_noise_model assay_noise_model_fit(const assay_noisy_sums *tiles, size_t count, bool alone,
                                        double *scratch);

/* Variance of the sum of differences, and its degrees of freedom (Welch and Satterthwaite). */
typedef struct {
    double variance, degrees;
} assay_noise;

assay_noise assay_noise_of(const assay_noise_model *model, const assay_noisy_sums *sums);

/* t of the difference after what rounding may have done; +-infinity where there is no noise. */
double assay_noise_t(const assay_noisy_sums *sums, assay_noise noise);

#endif
