/* normal_images.h - images of known light with normal noise of a known variance, for tests of
 * verdicts; each fails the test where it cannot do what it says. */
#ifndef ASSAY_TESTS_NORMAL_IMAGES_H
#define ASSAY_TESTS_NORMAL_IMAGES_H

#include "assay/verify.h"

enum { NORMAL_IMAGES_SIDE = 64 };

/* A standard normal deviate of a pixel. */
double normal_images_deviate(uint64_t seed, uint64_t pixel);
/* Light of a pixel, its row and column counted through. */
double normal_images_light(int i);

/* R alone, of `samples` samples whose deviation is `sigma`; the variance is exact.  samples 0: no
 * count, and 100 of them. */
assay_image *normal_images_make(assay_context *context, uint64_t seed, double sigma, int samples);

float *normal_images_add(assay_image *image, const char *name);
float *normal_images_values(const assay_image *image, const char *name);

/* With the usual options for NULL. */
assay_verdict     *normal_images_verify(assay_context *context, const assay_image *candidate,
                                        const assay_image          *reference,
                                        const assay_verify_options *options);
assay_verdict_kind normal_images_kind(assay_context *context, assay_image *candidate,
                                      assay_image *reference, const assay_verify_options *options);
/* The first finding of a test. */
assay_finding normal_images_find(const assay_verdict *verdict, const char *test);

#endif
