/* pictures.h - images of R, G and B for tests of measures. */
#ifndef ASSAY_TESTS_PICTURES_H
#define ASSAY_TESTS_PICTURES_H

#include "assay/image.h"

/* All pixels the same. */
assay_image *picture_constant(assay_context *context, int width, int height, double r, double g,
                              double b);

/* Blocks, ramps and noise of [0, scale]: something of every frequency; another for every seed. */
assay_image *picture_random(assay_context *context, int width, int height, double scale,
                            unsigned seed);

/* Blocks of 3 x 3 pixels of black, white and the six colours between: what leaves the gamut when it
 * is filtered, and differs by more than a render does. */
assay_image *picture_primaries(assay_context *context, int width, int height, unsigned seed);

/* Borrowed values of "R", "G", "B" or another FLOAT channel, which must be there. */
float *picture_channel(const assay_image *image, const char *name);

#endif
