/* flip_tone.h - tone mappers and exposures of HDR-FLIP; private to oracle. */
#ifndef ASSAY_ORACLE_FLIP_TONE_H
#define ASSAY_ORACLE_FLIP_TONE_H

#include "assay/types.h"
#include "oracle/metrics/picture.h"

/* A curve (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5) of each channel, or, `by_luminance`, of which
 * only the denominator counts, at x = luminance, and divides all three. */
typedef struct {
    double k[6];
    bool   by_luminance;
} assay_tone_curve;

assay_tone_curve assay_tone_curve_of(assay_tone_mapper mapper);

/* Linear light of a display in [0, 1]; negative values count as 0. */
assay_rgb assay_tone_map(const assay_tone_curve *curve, assay_rgb exposed);

/* The x > 0 of which the curve makes t, 0 < t < 1. */
double assay_tone_inverse(const assay_tone_curve *curve, double t);

typedef struct {
    double start, stop; /* stops */
    int    count;
} assay_exposure_range;

/* What the options leave open is found from the reference ([andersson21] section 3).  Errors:
 * ARGUMENT (start after stop), MEMORY. */
assay_status assay_exposure_range_find(const assay_picture_pair    *pair,
                                       const assay_metrics_options *options,
                                       assay_exposure_range        *range_out);

/* Exposure i of the range, in stops. */
double assay_exposure_at(const assay_exposure_range *range, int i);

#endif
