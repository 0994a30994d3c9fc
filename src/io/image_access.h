/* image_access.h - what measures of images need to know of one beside image.h. */
#ifndef ASSAY_IO_IMAGE_ACCESS_H
#define ASSAY_IO_IMAGE_ACCESS_H

#include "assay/image.h"

/* The context that an image was made with; borrowed. */
assay_context *assay_image_context(const assay_image *image);

static inline size_t assay_image_pixels(const assay_image *image)
{
    return (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
}

static inline double assay_channel_value(const assay_channel *channel, size_t pixel)
{
    return channel->type == ASSAY_CHANNEL_UINT ? channel->data.u32[pixel]
                                               : channel->data.f32[pixel];
}

/* ARGUMENT where width or height differ. */
assay_status assay_images_check_sizes(const assay_image *a, const assay_image *b);

#endif
