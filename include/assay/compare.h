/* compare.h - how far two images are from each other, channel by channel.
 *
 * Image a is the reference, b the candidate.  Definitions and what each number is good for:
 * docs/metrics.md.  Measures of a picture as a whole (SSIM, FLIP): metrics.h. */
#ifndef ASSAY_COMPARE_H
#define ASSAY_COMPARE_H

#include "assay/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the squares of relative_mse are divided by at least, in squared units of the channel. */
#define ASSAY_RELATIVE_MSE_FLOOR 1e-2

/* Difference of one channel, candidate b against reference a, over pixels where both are finite. */
typedef struct {
    const char *channel;    /* borrowed from image a                                             */
    uint64_t    pixels;     /* compared                                                          */
    uint64_t    differing;  /* whose bits differ (NaN against NaN of any kind does not)          */
    uint64_t    not_finite; /* NaN or infinite in exactly one, or of other sign                  */
    double      mean_a, mean_b;
    double      max_abs;  /* largest |b - a|                                                   */
    int    max_x, max_y;  /* where                                                             */
    double mse;           /* mean (b - a)^2                                                    */
    double rmse;          /* its root                                                          */
    double relative_mse;  /* mean ((b - a)^2 / (a^2 + ASSAY_RELATIVE_MSE_FLOOR))               */
    double relative_rmse; /* sqrt(mean ((b - a)^2 / (a^2 + 1e-2 mean_a^2)))                    */
    double mean_error;    /* mean (b - a): bias                                                */
    double z_rms;         /* rms of (b - a) / sqrt(var_a + var_b) where both images carry the
                             channel's variance and it is > 0: 1 for two unbiased renders (not
                             where one has one sample a pixel, whose variance files say is 0);
                             NaN where they do not carry it                                    */
} assay_channel_difference;

typedef struct assay_comparison assay_comparison;

/* Compares the channels that both images have.  Errors: ARGUMENT (sizes differ, no common channel),
 * MEMORY, CANCELLED. */
ASSAY_API assay_status             assay_image_compare(const assay_image *a, const assay_image *b,
                                                       assay_comparison **comparison_out);
ASSAY_API void                     assay_comparison_destroy(assay_comparison *comparison);
ASSAY_API int                      assay_comparison_count(const assay_comparison *comparison);
ASSAY_API assay_channel_difference assay_comparison_at(const assay_comparison *comparison,
                                                       int                     index);
/* True where sizes, channel sets, and every bit of every pixel are the same. */
ASSAY_API bool assay_comparison_identical(const assay_comparison *comparison);

/* DOMAIN where a value of a FLOAT channel is NaN or infinite; the message says which and where. */
ASSAY_API assay_status assay_image_check_finite(const assay_image *image);

/* The difference of a colour layer as one: "" is R, G and B, "Indirect" is Indirect.R, .G and .B.
 * Means over the three channels of mean_a, mean_error, mse and relative_mse; the roots of the means
 * of rmse^2 and relative_rmse^2. */
typedef struct {
    double mean_a, mean_error, mse, rmse, relative_mse, relative_rmse;
} assay_color_difference;

/* False, and *difference_out untouched, where the comparison lacks one of the three. */
ASSAY_API bool assay_comparison_color(const assay_comparison *comparison, const char *layer,
                                      assay_color_difference *difference_out);

/* A map of |b - a| / (|a| + 1e-2 |mean_a|), the mean over R, G, B (or over all common float
 * channels where there are none), as the FLOAT channel "RelativeError"; infinite where a pixel is
 * finite in one image alone.  Errors: ARGUMENT (as compare), MEMORY. */
ASSAY_API assay_status assay_image_relative_error(const assay_image *a, const assay_image *b,
                                                  assay_image **map_out);

/* The same as a picture (R, G, B, linear) on a perceptually ordered scale from 0 to `full_scale`.
 * Errors: ARGUMENT (as compare; full_scale not > 0), MEMORY. */
ASSAY_API assay_status assay_image_heat_map(const assay_image *a, const assay_image *b,
                                            double full_scale, assay_image **map_out);

#ifdef __cplusplus
}
#endif
#endif
