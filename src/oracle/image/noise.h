/* noise.h - what is known of the noise of a difference, and how sure a difference is in it.
 *
 * Several views of the same variance, each right under an assumption of its own: a difference is as
 * sure as the view that doubts it most.  So a p is right where any one of them is. */
#ifndef ASSAY_ORACLE_NOISE_H
#define ASSAY_ORACLE_NOISE_H

#include "oracle/image/critical_values.h"

enum { ASSAY_NOISE_VIEWS = 8 };

typedef struct {
    double variance, degrees; /* degrees of freedom of the variance */
} assay_noise_view;

typedef struct {
    int              count; /* 0: no noise at all */
    assay_noise_view views[ASSAY_NOISE_VIEWS];
    /* Of both images where they are few enough to be a limit; 0: they are not. */
    double candidate_samples, reference_samples;
} assay_noise;

/* Adds a view, unless its variance is 0. */
void assay_noise_add(assay_noise *noise, double variance, double degrees);

/* The largest of the variances; 0 without noise. */
double assay_noise_variance(const assay_noise *noise);

/* log of the probability of a difference of this size or more, either way, if there is none.  0 for
 * size <= 0; -infinity where there is no noise, unless so few samples cannot show as much. */
double assay_noise_log_p(const assay_noise *noise, double size);

/* Likewise one way: of a difference of `size` or more, which may be negative. */
double assay_noise_log_p_one_sided(const assay_noise *noise, double size);

/* The smallest difference whose two-sided log p is at most that of the critical values; the second
 * may be NULL, or are added to the first: what is seen with a certain power.  Infinite where no
 * difference has. */
double assay_noise_bound(const assay_noise *noise, assay_critical_values *critical,
                         assay_critical_values *power);

#endif
