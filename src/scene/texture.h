/* texture.h - image files into texels, and texels into values.
 *
 * The lookup itself, assay_texture_sample, is declared in scene/scene_data.h. */
#ifndef ASSAY_SCENE_TEXTURE_H
#define ASSAY_SCENE_TEXTURE_H

#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"
#include "scene/material.h"

/* Largest side and pixel count of a texture; refused from its header, before anything is decoded.
 */
#define ASSAY_TEXTURE_MAX_SIDE 16384
#define ASSAY_TEXTURE_MAX_PIXELS (1u << 27)

/* Decodes a PNG or a JPEG file held in memory (told apart by content) to RGBA, 8 bits a component,
 * or 16 where a PNG has 16.  Samples are taken as they are: gamma, chromaticity and ICC information
 * is ignored, as glTF asks; alpha is not premultiplied; grey becomes R = G = B; no alpha is
 * alpha 1. name is for messages ("images/3 (bricks.png)") and is copied into the image. Errors:
 * FORMAT (malformed or cut short: never half an image), UNSUPPORTED (neither PNG nor JPEG, CMYK or
 * arithmetic-coded or 12-bit JPEG), LIMIT, MEMORY; *image_out is then untouched. */
assay_status assay_texture_image_decode(assay_context *context, const uint8_t *bytes, size_t count,
                                        const char *name, assay_texture_image *image_out);

/* Puts the texels in tiles of 4 x 4 (a tile of 8 bits is one cache line; the image is padded), so
 * that the four texels of a filter are mostly one memory access.  Changes no value that is looked
 * up. Errors: MEMORY; the image is then as it was. */
assay_status assay_texture_image_tile(assay_context *context, assay_texture_image *image);

/* Where texel (x, y) starts, in components. */
static inline size_t assay_texel_offset(const assay_texture_image *image, uint32_t x, uint32_t y)
{
    if (!image->tiled) {
        return ((size_t)y * image->width + x) * 4;
    }
    const size_t tile = (size_t)(y >> 2) * ((image->width + 3) >> 2) + (x >> 2);
    return (tile << 4 | (y & 3u) << 2 | (x & 3u)) * 4;
}

/* Releases texels and name, and leaves zeros.  Legal on an image of zeros. */
void assay_texture_image_release(assay_context *context, assay_texture_image *image);

/* Fills ref->uv_matrix from offset, rotation (rad) and scale as KHR_texture_transform says:
 * uv' = T R S uv.  Call it once after loading, also for references without the extension (offset 0,
 * rotation 0, scale 1: the identity, exactly). */
void assay_texture_ref_prepare(assay_texture_ref *ref);

/* sRGB decoding of a component (IEC 61966-2-1), to [0, 1]: of 8 bits from a table, of 16 computed.
 */
extern const double assay_srgb_decoded[256];

static inline double assay_srgb_decode8(uint8_t value) { return assay_srgb_decoded[value]; }
double               assay_srgb_decode16(uint16_t value);

#endif
