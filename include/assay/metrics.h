/* metrics.h - how different two pictures look, in the measures of the field: SSIM and FLIP.
 *
 * Image a is the reference, b the candidate; a picture is one colour layer of an image: linear
 * light, Rec. 709 primaries, D65.  Equations, and what each measure is good and bad for:
 * docs/metrics.md.  Errors of numbers (MSE and its kin): compare.h.
 *
 * All calls: the same bits for any number of threads.  Errors: ARGUMENT (sizes differ, a channel of
 * the layer is missing or holds whole numbers, an option is out of its range), DOMAIN (a value of
 * the layer is NaN or infinite; the message says in which image and where), MEMORY, CANCELLED. */
#ifndef ASSAY_METRICS_H
#define ASSAY_METRICS_H

#include "assay/image.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    ASSAY_TONE_ACES     = 0,
    ASSAY_TONE_HABLE    = 1,
    ASSAY_TONE_REINHARD = 2
} assay_tone_mapper;

typedef enum {
    ASSAY_FLIP_LDR = 0, /* of the picture that a display shows at one exposure, clamped to [0, 1] */
    ASSAY_FLIP_HDR = 1  /* the largest over a range of exposures, tone-mapped                     */
} assay_flip_kind;

/* Pixels per degree of visual angle: 0.7 m away from a monitor 0.7 m and 3840 pixels wide. */
#define ASSAY_PIXELS_PER_DEGREE 67.020643276582255
#define ASSAY_PIXELS_PER_DEGREE_MIN 1.0
#define ASSAY_PIXELS_PER_DEGREE_MAX 1000.0
#define ASSAY_FLIP_MAX_EXPOSURES 1000

typedef struct {
    const char *layer;                   /* "": R, G, B; "Indirect": Indirect.R, .G, .B           */
    double      exposure;                /* stops, in [-100, 100]: the display picture of SSIM and
                                            of LDR-FLIP is value * 2^exposure                     */
    double            pixels_per_degree; /* of FLIP                                               */
    assay_tone_mapper tone_mapper;       /* this and the next three: of HDR-FLIP                  */
    double            start_exposure;    /* stops, in [-100, 100]; NaN: from the reference        */
    double            stop_exposure;     /* likewise; >= start_exposure                           */
    int               exposures;         /* how many, ends included; 0: from the two above        */
} assay_metrics_options;

/* "", 0, ASSAY_PIXELS_PER_DEGREE, ACES, NaN, NaN, 0. */
ASSAY_API assay_metrics_options assay_metrics_defaults(void);

/* "aces", "hable", "reinhard"; NULL for anything else. */
ASSAY_API const char *assay_tone_mapper_name(assay_tone_mapper mapper);

/* Mean structural similarity of the display pictures' luma, 1 for equal pictures; NaN where a side
 * is shorter than the window of 11 pixels. */
ASSAY_API assay_status assay_image_ssim(const assay_image *a, const assay_image *b,
                                        const assay_metrics_options *options, double *ssim_out);

/* FLIP errors are in [0, 1], 0 for equal pictures.  The median and the quartiles are weighted: the
 * pixels up to that error hold so much of the sum of all errors; 0 where there are none. */
typedef struct {
    double mean, weighted_median, first_quartile, third_quartile, minimum, maximum;
    int    max_x, max_y;                  /* where the largest is first met, row by row           */
    double start_exposure, stop_exposure; /* stops; of LDR-FLIP both are the exposure             */
    int    exposures;
} assay_flip_summary;

/* map_out may be NULL; the map has the channel "FLIP" and, of HDR-FLIP, "Exposure": the stops at
 * which the largest error was found (of equals the first).  Both outputs are written together. */
ASSAY_API assay_status assay_image_flip(const assay_image *a, const assay_image *b,
                                        assay_flip_kind kind, const assay_metrics_options *options,
                                        assay_flip_summary *summary_out, assay_image **map_out);

/* A channel of a map as a picture (R, G, B, linear) on the colour map "magma", from `low` (black)
 * to `high` (pale yellow); a PNG of it has the published codes.  For FLIP: 0 to 1.
 * Errors: ARGUMENT (no such float channel; not low < high), MEMORY. */
ASSAY_API assay_status assay_image_magma(const assay_image *map, const char *channel, double low,
                                         double high, assay_image **picture_out);

#ifdef __cplusplus
}
#endif
#endif
