/* compare_channels.h - what compare.c and heat_map.c share; private to io. */
#ifndef ASSAY_IO_COMPARE_CHANNELS_H
#define ASSAY_IO_COMPARE_CHANNELS_H

#include "assay/image.h"

/* The context that an image was made with; borrowed. */
assay_context *assay_image_context(const assay_image *image);

size_t assay_image_pixels(const assay_image *image);
double assay_channel_value(const assay_channel *channel, size_t pixel);

/* Mean of a over the pixels where both are finite; NaN where there are none. */
double assay_channel_mean(const assay_channel *a, const assay_channel *b, size_t pixels);

/* ARGUMENT where width or height differ. */
assay_status assay_images_check_sizes(const assay_image *a, const assay_image *b);

#endif
