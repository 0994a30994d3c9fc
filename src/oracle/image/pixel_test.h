/* pixel_test.h - Welch's test of every pixel of a channel. */
#ifndef ASSAY_ORACLE_PIXEL_TEST_H
#define ASSAY_ORACLE_PIXEL_TEST_H

#include "assay/context.h"
#include "oracle/image/multiple_tests.h"
#include "oracle/image/noise_model.h"

/* Pixels that one sample outweighs: reported, never judged. */
typedef struct {
    uint64_t count;
    double   excess; /* sum of their differences                      */
    size_t   worst;  /* the one with the largest difference           */
    double   worst_difference;
} assay_fireflies;

typedef struct {
    size_t          worst; /* pixel whose difference is most standard deviations */
    double          worst_t;
    size_t          typical; /* pixel whose noise is the median                  */
    assay_fireflies candidate, reference;
} assay_pixel_result;

/* Adds the p of all pixels to tests, as items first_item + pixel.  Errors: MEMORY, CANCELLED. */
assay_status assay_pixel_test(assay_context *context, const assay_noisy_pair *pair,
                              const assay_noise_model *model, uint64_t first_item,
                              assay_multiple_tests *tests, assay_pixel_result *result_out);

#endif
