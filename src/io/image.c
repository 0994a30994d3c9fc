/* image.c - named channels and text attributes.
 *
 * Invariant: both lists are sorted by strcmp and free of duplicates, so that files and digests do
 * not depend on the order in which things were added. */
#include "assay/image.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/hash.h"
#include "io/image_access.h"
#include "io/image_data.h"
#include "io/image_decode.h"
#include "io/read_file.h"

enum { MAX_NAME = 255 };

assay_status assay_image_create(assay_context *context, int width, int height,
                                assay_image **image_out)
{
    if (width < 1 || height < 1 || width > ASSAY_IMAGE_MAX_SIDE || height > ASSAY_IMAGE_MAX_SIDE ||
        (uint64_t)width * (uint64_t)height > ASSAY_IMAGE_MAX_PIXELS) {
        return assay_fail(
            context, ASSAY_ERR_ARGUMENT,
            "an image of %d x %d pixels: sides must be 1 to %d, and at most %u pixels "
            "in all",
            width, height, ASSAY_IMAGE_MAX_SIDE, ASSAY_IMAGE_MAX_PIXELS);
    }
    assay_image *image = assay_allocate(context, 1, sizeof *image);
    if (!image) {
        return assay_fail_memory(context, "an image");
    }
    image->context = context;
    image->width   = width;
    image->height  = height;
    *image_out     = image;
    return ASSAY_OK;
}

/* The only place where a channel's name, handed out as const, is owned. */
static void release_channel(assay_context *context, assay_channel *channel)
{
    assay_release(context, (char *)channel->name);
    assay_release(context, channel->data.f32);
}

void assay_image_destroy(assay_image *image)
{
    if (!image) {
        return;
    }
    assay_context *context = image->context;
    for (size_t i = 0; i < image->channel_count; i++) {
        release_channel(context, &image->channels[i]);
    }
    for (size_t i = 0; i < image->attribute_count; i++) {
        assay_release(context, image->attributes[i].name);
        assay_release(context, image->attributes[i].value);
    }
    assay_release(context, image->channels);
    assay_release(context, image->attributes);
    assay_release(context, image);
}

assay_context *assay_image_context(const assay_image *image) { return image->context; }

assay_status assay_images_check_sizes(const assay_image *a, const assay_image *b)
{
    if (assay_image_width(a) == assay_image_width(b) &&
        assay_image_height(a) == assay_image_height(b)) {
        return ASSAY_OK;
    }
    return assay_fail(assay_image_context(a), ASSAY_ERR_ARGUMENT,
                      "the images differ in size: %d x %d and %d x %d pixels", assay_image_width(a),
                      assay_image_height(a), assay_image_width(b), assay_image_height(b));
}

int assay_image_width(const assay_image *image) { return image->width; }

int assay_image_height(const assay_image *image) { return image->height; }

/* Index of a channel of that name, or where it would have to be inserted. */
static size_t channel_place(const assay_image *image, const char *name, bool *found_out)
{
    size_t low = 0, high = image->channel_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const int    order  = strcmp(image->channels[middle].name, name);
        if (order == 0) {
            *found_out = true;
            return middle;
        }
        if (order < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    *found_out = false;
    return low;
}

assay_status assay_image_add_channel(assay_image *image, const char *name, assay_channel_type type,
                                     assay_channel *channel_out)
{
    assay_context *context = image->context;
    bool           found   = false;
    const size_t   place   = channel_place(image, name, &found);
    const size_t   length  = strlen(name);
    if (length == 0 || length > MAX_NAME || found) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "channel '%.40s': %s", name,
                          found         ? "the image already has one of that name"
                          : length == 0 ? "the name is empty"
                                        : "the name is longer than 255 bytes");
    }
    assay_status status = assay_grow(context, (void **)&image->channels, &image->channel_capacity,
                                     image->channel_count + 1, sizeof *image->channels);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_channel channel = {.name = assay_copy_text(context, name), .type = type};
    channel.data.f32 =
        assay_allocate(context, (size_t)image->width * (size_t)image->height, sizeof(float));
    if (!channel.name || !channel.data.f32) {
        release_channel(context, &channel);
        return assay_fail_memory(context, "an image channel");
    }
    memmove(image->channels + place + 1, image->channels + place,
            (image->channel_count - place) * sizeof channel);
    image->channels[place] = channel;
    image->channel_count++;
    if (channel_out) {
        *channel_out = channel;
    }
    return ASSAY_OK;
}

int assay_image_channel_count(const assay_image *image) { return (int)image->channel_count; }

assay_channel assay_image_channel_at(const assay_image *image, int index)
{
    return image->channels[index];
}

bool assay_image_find_channel(const assay_image *image, const char *name,
                              assay_channel *channel_out)
{
    bool         found = false;
    const size_t place = channel_place(image, name, &found);
    if (found && channel_out) {
        *channel_out = image->channels[place];
    }
    return found;
}

static size_t attribute_place(const assay_image *image, const char *name, bool *found_out)
{
    size_t place = 0;
    while (place < image->attribute_count && strcmp(image->attributes[place].name, name) < 0) {
        place++;
    }
    *found_out = place < image->attribute_count && strcmp(image->attributes[place].name, name) == 0;
    return place;
}

static assay_status insert_attribute(assay_image *image, size_t place, assay_attribute attribute)
{
    const assay_status status =
        assay_grow(image->context, (void **)&image->attributes, &image->attribute_capacity,
                   image->attribute_count + 1, sizeof attribute);
    if (status == ASSAY_OK) {
        memmove(image->attributes + place + 1, image->attributes + place,
                (image->attribute_count - place) * sizeof attribute);
        image->attributes[place] = attribute;
        image->attribute_count++;
    }
    return status;
}

assay_status assay_image_set_attribute(assay_image *image, const char *name, const char *value)
{
    assay_context *context = image->context;
    const size_t   length  = strlen(name);
    if (length == 0 || length > MAX_NAME || assay_image_attribute_reserved(name)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "attribute '%.40s': %s", name,
                          length == 0         ? "the name is empty"
                          : length > MAX_NAME ? "the name is longer than 255 bytes"
                                              : "OpenEXR keeps this name for itself");
    }
    if (strlen(value) > ASSAY_IMAGE_MAX_ATTRIBUTE) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "attribute '%.40s': the text is longer than %u bytes", name,
                          ASSAY_IMAGE_MAX_ATTRIBUTE);
    }
    bool         found = false;
    const size_t place = attribute_place(image, name, &found);
    char        *copy  = assay_copy_text(context, value);
    if (!copy) {
        return assay_fail_memory(context, "an image attribute");
    }
    if (found) {
        assay_release(context, image->attributes[place].value);
        image->attributes[place].value = copy;
        return ASSAY_OK;
    }
    assay_attribute    attribute = {assay_copy_text(context, name), copy};
    const assay_status status    = attribute.name ? insert_attribute(image, place, attribute)
                                                  : assay_fail_memory(context, "an image attribute");
    if (status != ASSAY_OK) {
        assay_release(context, attribute.name);
        assay_release(context, attribute.value);
    }
    return status;
}

const char *assay_image_get_attribute(const assay_image *image, const char *name)
{
    bool         found = false;
    const size_t place = attribute_place(image, name, &found);
    return found ? image->attributes[place].value : NULL;
}

int assay_image_attribute_count(const assay_image *image) { return (int)image->attribute_count; }

void assay_image_attribute_at(const assay_image *image, int index, const char **name_out,
                              const char **value_out)
{
    *name_out  = image->attributes[index].name;
    *value_out = image->attributes[index].value;
}

/* As four bytes, lowest first, whatever the machine's order. */
static void hash_words(assay_hash *hash, const uint32_t *words, size_t count)
{
    uint8_t bytes[4096];
    while (count) {
        const size_t part = count < sizeof bytes / 4 ? count : sizeof bytes / 4;
        for (size_t i = 0; i < part; i++) {
            bytes[4 * i]     = (uint8_t)words[i];
            bytes[4 * i + 1] = (uint8_t)(words[i] >> 8);
            bytes[4 * i + 2] = (uint8_t)(words[i] >> 16);
            bytes[4 * i + 3] = (uint8_t)(words[i] >> 24);
        }
        assay_hash_add(hash, bytes, part * 4);
        words += part;
        count -= part;
    }
}

void assay_image_digest(const assay_image *image, char digest_out[65])
{
    const uint32_t head[] = {(uint32_t)image->width, (uint32_t)image->height,
                             (uint32_t)image->channel_count};
    const size_t   pixels = (size_t)image->width * (size_t)image->height;
    assay_hash     hash;
    assay_hash_start(&hash);
    assay_hash_add_text(&hash, "assay image 1");
    hash_words(&hash, head, 3);
    for (size_t i = 0; i < image->channel_count; i++) {
        const assay_channel *channel = &image->channels[i];
        const uint32_t       type    = channel->type;
        assay_hash_add_text(&hash, channel->name);
        hash_words(&hash, &type, 1);
        hash_words(&hash, channel->data.u32, pixels);
    }
    assay_hash_finish(&hash, digest_out);
}

assay_status assay_image_decode(assay_context *context, const uint8_t *bytes, size_t count,
                                const char *name, const char *const *wanted,
                                assay_image **image_out)
{
    if (count >= 4 && memcmp(bytes, "v/1\001", 4) == 0) {
        return assay_image_decode_exr(context, bytes, count, name, wanted, image_out);
    }
    if (count >= 2 && memcmp(bytes, "#?", 2) == 0) {
        return assay_image_decode_hdr(context, bytes, count, name, image_out);
    }
    return assay_fail(context, ASSAY_ERR_FORMAT,
                      "%s: neither an OpenEXR nor a Radiance (.hdr) image", name);
}

assay_status assay_image_read_channels(assay_context *context, const char *path,
                                       const char *const *wanted, assay_image **image_out)
{
    uint8_t     *bytes  = NULL;
    size_t       count  = 0;
    assay_status status = assay_read_file(context, path, ASSAY_IMAGE_MAX_FILE, &bytes, &count);
    if (status == ASSAY_OK) {
        status = assay_image_decode(context, bytes, count, path, wanted, image_out);
        assay_release(context, bytes);
    }
    return status;
}

assay_status assay_image_read(assay_context *context, const char *path, assay_image **image_out)
{
    return assay_image_read_channels(context, path, NULL, image_out);
}
