/* texture_decode.c - which decoder an image file needs; what holds for all of them.
 *
 * The format is read from the content, since glTF's mimeType and file names are often wrong. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/texture_codec.h"

assay_status assay_texture_check_size(assay_context *context, const char *name, uint64_t width,
                                      uint64_t height)
{
    if (width == 0 || height == 0) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: the image has no pixels", name);
    }
    if (width > ASSAY_TEXTURE_MAX_SIDE || height > ASSAY_TEXTURE_MAX_SIDE ||
        width * height > ASSAY_TEXTURE_MAX_PIXELS) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: %llu x %llu pixels; at most %d a side and %u in all are read; "
                          "make the image smaller",
                          name, (unsigned long long)width, (unsigned long long)height,
                          ASSAY_TEXTURE_MAX_SIDE, ASSAY_TEXTURE_MAX_PIXELS);
    }
    return ASSAY_OK;
}

static bool starts_with(const uint8_t *bytes, size_t count, const char *magic, size_t length)
{
    return count >= length && memcmp(bytes, magic, length) == 0;
}

/* Names what else is often met, so that the message tells more than "not an image". */
static const char *format_name(const uint8_t *bytes, size_t count)
{
    if (starts_with(bytes, count, "\253KTX", 4)) {
        return "KTX";
    }
    if (starts_with(bytes, count, "DDS ", 4)) {
        return "DDS";
    }
    if (starts_with(bytes, count, "GIF8", 4)) {
        return "GIF";
    }
    if (starts_with(bytes, count, "BM", 2)) {
        return "BMP";
    }
    if (starts_with(bytes, count, "RIFF", 4) && count >= 12 && memcmp(bytes + 8, "WEBP", 4) == 0) {
        return "WebP";
    }
    return NULL;
}

assay_status assay_texture_image_decode(assay_context *context, const uint8_t *bytes, size_t count,
                                        const char *name, assay_texture_image *image_out)
{
    assay_texture_image image = {0};
    assay_status        status;
    if (count == 0) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: the image file is empty", name);
    }
    if (starts_with(bytes, count, "\211PNG\r\n\032\n", 8)) {
        status = assay_texture_decode_png(context, bytes, count, name, &image);
    } else if (starts_with(bytes, count, "\377\330\377", 3)) {
        status = assay_texture_decode_jpeg(context, bytes, count, name, &image);
    } else {
        const char *other = format_name(bytes, count);
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: %s%s; convert the image to PNG or JPEG", name,
                          other ? "the image is in the format " : "neither a PNG nor a JPEG image",
                          other ? other : "");
    }
    if (status != ASSAY_OK) {
        return status;
    }
    image.name = assay_copy_text(context, name);
    if (!image.name) {
        assay_release(context, image.texels);
        return assay_fail_memory(context, name);
    }
    *image_out = image;
    return ASSAY_OK;
}

assay_status assay_texture_image_tile(assay_context *context, assay_texture_image *image)
{
    const size_t        texel = image->bits / 2;
    const size_t        tiles = (size_t)((image->width + 3) >> 2) * ((image->height + 3) >> 2);
    assay_texture_image tiled = *image;
    tiled.tiled               = true;
    tiled.texels              = assay_allocate(context, tiles * 16, texel);
    if (!tiled.texels) {
        return assay_fail_memory(context, image->name);
    }
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            memcpy((char *)tiled.texels + assay_texel_offset(&tiled, x, y) * (texel / 4),
                   (const char *)image->texels + assay_texel_offset(image, x, y) * (texel / 4),
                   texel);
        }
    }
    assay_release(context, image->texels);
    *image = tiled;
    return ASSAY_OK;
}

void assay_texture_image_release(assay_context *context, assay_texture_image *image)
{
    assay_release(context, image->texels);
    assay_release(context, image->name);
    *image = (assay_texture_image){0};
}
