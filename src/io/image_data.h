/* image_data.h - the inside of an image, and its file formats; private to io. */
#ifndef ASSAY_IO_IMAGE_DATA_H
#define ASSAY_IO_IMAGE_DATA_H

#include "assay/image.h"

typedef struct {
    char *name, *value;
} assay_attribute;

/* channels and attributes are sorted by name (strcmp), names unique. */
struct assay_image {
    assay_context   *context;
    int              width, height;
    assay_channel   *channels;
    size_t           channel_count, channel_capacity;
    assay_attribute *attributes;
    size_t           attribute_count, attribute_capacity;
};

/* Largest image file that is read, and longest text attribute that is kept, bytes. */
#define ASSAY_IMAGE_MAX_FILE ((uint64_t)1 << 32)
#define ASSAY_IMAGE_MAX_ATTRIBUTE (1u << 24)

/* Whether a name belongs to the header fields that OpenEXR keeps for itself ("compression"). */
bool assay_image_attribute_reserved(const char *name);

/* The two formats of image_decode.h, by themselves. */
assay_status assay_image_decode_exr(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, const char *const *wanted,
                                    assay_image **image_out);
assay_status assay_image_decode_hdr(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, assay_image **image_out);

#endif
