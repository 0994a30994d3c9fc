/* texture_codec.h - what the decoders of one file format each share; private to the texture*.c
 * files.
 */
#ifndef ASSAY_SCENE_TEXTURE_CODEC_H
#define ASSAY_SCENE_TEXTURE_CODEC_H

#include <stdbool.h>

#include "scene/texture.h"

/* Each fills width, height, bits and texels; *image_out untouched on error. */
assay_status assay_texture_decode_png(assay_context *context, const uint8_t *bytes, size_t count,
                                      const char *name, assay_texture_image *image_out);
assay_status assay_texture_decode_jpeg(assay_context *context, const uint8_t *bytes, size_t count,
                                       const char *name, assay_texture_image *image_out);

/* FORMAT for an empty size, LIMIT over ASSAY_TEXTURE_MAX_SIDE or ASSAY_TEXTURE_MAX_PIXELS. */
assay_status assay_texture_check_size(assay_context *context, const char *name, uint64_t width,
                                      uint64_t height);

#endif
