/* image_decode.h - images from bytes, whole or in part. */
#ifndef ASSAY_IO_IMAGE_DECODE_H
#define ASSAY_IO_IMAGE_DECODE_H

#include "assay/image.h"

/* An image from a file's bytes; name is for messages.  wanted lists the names of the channels to
 * take of an OpenEXR file, and ends with NULL: those that are not there are missing in the image,
 * too; others take no memory.  NULL: all.  Errors as assay_image_read. */
assay_status assay_image_decode(assay_context *context, const uint8_t *bytes, size_t count,
                                const char *name, const char *const *wanted,
                                assay_image **image_out);

/* The same for a file: assay_image_read with `wanted` as above. */
assay_status assay_image_read_channels(assay_context *context, const char *path,
                                       const char *const *wanted, assay_image **image_out);

#endif
