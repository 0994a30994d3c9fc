/* report_maps.h - where and how a candidate differs from the reference: planes for pictures, and
 * histograms of all values.
 *
 * Definitions are those of `assay diff` (docs/conventions.md). */
#ifndef ASSAY_ORACLE_REPORT_MAPS_H
#define ASSAY_ORACLE_REPORT_MAPS_H

#include "assay/image.h"

enum { ASSAY_REPORT_BINS = 64 };

/* bin i counts what lies in [low + i step, low + (i + 1) step). */
typedef struct {
    double   low, step;
    int      bins;
    uint64_t count[ASSAY_REPORT_BINS];
    uint64_t below, above, not_finite;
    uint64_t equal; /* counted nowhere else: no difference at all */
} assay_report_histogram;

/* Which image says how noisy it is. */
typedef enum {
    ASSAY_NOISE_NONE      = 0,
    ASSAY_NOISE_REFERENCE = 1,
    ASSAY_NOISE_CANDIDATE = 2,
    ASSAY_NOISE_BOTH      = 3
} assay_report_noise;

typedef struct {
    float *difference; /* candidate - reference, mean of R, G, B                             */
    float *relative;   /* |difference| / (|reference| + 0.01 its mean), mean of R, G, B      */
    float *z;          /* difference in standard errors of it, of the channel where that is
                          largest; NULL where neither image has a variance, of two samples or more */
    assay_report_noise     noise;
    assay_report_histogram relative_histogram; /* log10 of the relative error, each channel   */
    assay_report_histogram z_histogram;        /* each channel                                */
} assay_report_maps;

/* Images with float channels R, G and B, of one size.  Errors: MEMORY. */
assay_status assay_report_maps_create(assay_context *context, const assay_image *reference,
                                      const assay_image *candidate, assay_report_maps *maps_out);
void         assay_report_maps_release(assay_context *context, assay_report_maps *maps);

/* log2 of the luminance of every pixel; what is not > 0 is below. */
void assay_report_luminance(const assay_image *image, assay_report_histogram *histogram_out);

/* Whole stops that take three times the mean of R, G and B to about 1: a page begins with them. */
double assay_report_exposure(const assay_image *image);

#endif
