/* image.h - images of named channels, and the files that hold them.
 *
 * Row 0 is the top row; a channel is height * width values, row by row.  OpenEXR layer names:
 * "R", "Albedo.R", "Variance.Direct.G", "SampleCount". */
#ifndef ASSAY_IMAGE_H
#define ASSAY_IMAGE_H

#include <stdint.h>

#include "assay/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct assay_image assay_image;

typedef enum { ASSAY_CHANNEL_FLOAT = 0, ASSAY_CHANNEL_UINT = 1 } assay_channel_type;

/* A channel of an image; data is borrowed from it, width * height values of the type. */
typedef struct {
    const char        *name;
    assay_channel_type type;
    union {
        float    *f32;
        uint32_t *u32;
    } data;
} assay_channel;

/* Largest width and height, and largest width * height, of any image made or read. */
#define ASSAY_IMAGE_MAX_SIDE 65536
#define ASSAY_IMAGE_MAX_PIXELS (1u << 28)
/* Largest width * height of an image that is rendered. */
#define ASSAY_RENDER_MAX_PIXELS (1u << 26)

/* An image without channels.  Errors: ARGUMENT (a side 0 or too large, too many pixels), MEMORY. */
ASSAY_API assay_status assay_image_create(assay_context *context, int width, int height,
                                          assay_image **image_out);
ASSAY_API void         assay_image_destroy(assay_image *image);

ASSAY_API int assay_image_width(const assay_image *image);
ASSAY_API int assay_image_height(const assay_image *image);

/* Adds a channel of zeros.  Errors: ARGUMENT (empty, over 255 bytes, or already there), MEMORY. */
ASSAY_API assay_status assay_image_add_channel(assay_image *image, const char *name,
                                               assay_channel_type type, assay_channel *channel_out);

/* Channels in the order of their names (strcmp). */
ASSAY_API int           assay_image_channel_count(const assay_image *image);
ASSAY_API assay_channel assay_image_channel_at(const assay_image *image, int index);
/* False, and *channel_out untouched, where there is none of that name. channel_out may be NULL. */
ASSAY_API bool assay_image_find_channel(const assay_image *image, const char *name,
                                        assay_channel *channel_out);

/* Text attributes ("assay:method" = "path"), kept in the EXR header.
 * set replaces; get returns a borrowed string or NULL. */
ASSAY_API assay_status assay_image_set_attribute(assay_image *image, const char *name,
                                                 const char *value);
ASSAY_API const char  *assay_image_get_attribute(const assay_image *image, const char *name);
ASSAY_API int          assay_image_attribute_count(const assay_image *image);
ASSAY_API void assay_image_attribute_at(const assay_image *image, int index, const char **name_out,
                                        const char **value_out);

/* SHA-256 (64 hexadecimal digits and a NUL) of size, channel names, types and pixels; attributes do
 * not count.  The same pixels give the same digest on every machine. */
ASSAY_API void assay_image_digest(const assay_image *image, char digest_out[65]);

/* Reads an OpenEXR file (scan lines or tiles at full resolution, first part; HALF becomes FLOAT) or
 * a Radiance .hdr file (channels R, G, B), told apart by their content.
 * Errors: NOT_FOUND, FORMAT, UNSUPPORTED (deep data, subsampled channels), LIMIT, MEMORY. */
ASSAY_API assay_status assay_image_read(assay_context *context, const char *path,
                                        assay_image **image_out);

/* Writes an OpenEXR file, scan lines, ZIP, with all channels and attributes.  Written beside and
 * then renamed: on any error the file of that name is as it was.  Errors: WRITE, MEMORY. */
ASSAY_API assay_status assay_image_write_exr(const assay_image *image, const char *path);

/* Writes an 8-bit sRGB PNG of three channels: exposure in stops (value * 2^exposure), clamped to
 * [0, 1], sRGB curve.  layer is "" for R, G, B; "Albedo" for Albedo.R, Albedo.G, Albedo.B (or .X .Y
 * .Z); a single channel of that very name is drawn in grey.  Errors: ARGUMENT (no such layer),
 * WRITE, MEMORY. */
ASSAY_API assay_status assay_image_write_png(const assay_image *image, const char *layer,
                                             double exposure, const char *path);

#ifdef __cplusplus
}
#endif
#endif
