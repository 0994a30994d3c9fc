/* array_hash.c - Invariant: bytes are laid out one by one, so that the machine's own order and the
 * files' compression do not count. */
#include "array_hash.h"

#include <math.h>
#include <string.h>

#include "core/hash.h"

static void add_bytes(assay_hash *hash, uint64_t value, int count)
{
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(value >> (8 * i));
    }
    assay_hash_add(hash, bytes, (size_t)count);
}

static void add_sample(assay_hash *hash, const assay_channel *channel, size_t pixel)
{
    uint32_t bits = channel->data.u32[pixel];
    if (channel->type == ASSAY_CHANNEL_FLOAT && isnan(channel->data.f32[pixel])) {
        bits = 0x7fc00000u;
    }
    add_bytes(hash, bits, 4);
}

static void add_double(assay_hash *hash, double value)
{
    uint64_t bits = 0x7ff8000000000000u;
    if (!isnan(value)) {
        memcpy(&bits, &value, sizeof bits);
    }
    add_bytes(hash, bits, 8);
}

const char *array_hash_image_type(const assay_image *image)
{
    const bool whole = assay_image_channel_count(image) > 0 &&
                       assay_image_channel_at(image, 0).type == ASSAY_CHANNEL_UINT;
    return whole ? "<u4" : "<f4";
}

void array_hash_image(const char *name, const assay_image *image, char digest_out[65])
{
    const int    channels = assay_image_channel_count(image);
    const size_t rows     = (size_t)assay_image_height(image);
    const size_t columns  = (size_t)assay_image_width(image);
    assay_hash   hash;
    assay_hash_start(&hash);
    assay_hash_add_text(&hash, name);
    assay_hash_add_text(&hash, array_hash_image_type(image));
    add_bytes(&hash, rows, 8);
    add_bytes(&hash, columns, 8);
    add_bytes(&hash, (uint64_t)channels, 8);
    for (int c = 0; c < channels; c++) {
        assay_hash_add_text(&hash, assay_image_channel_at(image, c).name);
    }
    for (size_t pixel = 0; pixel < rows * columns; pixel++) {
        for (int c = 0; c < channels; c++) {
            const assay_channel channel = assay_image_channel_at(image, c);
            add_sample(&hash, &channel, pixel);
        }
    }
    assay_hash_finish(&hash, digest_out);
}

void array_hash_table(const char *name, const assay_array *table, char digest_out[65])
{
    const size_t  rows = assay_array_rows(table), columns = assay_array_columns(table);
    const double *values = assay_array_values(table);
    assay_hash    hash;
    assay_hash_start(&hash);
    assay_hash_add_text(&hash, name);
    assay_hash_add_text(&hash, "<f8");
    add_bytes(&hash, rows, 8);
    add_bytes(&hash, columns, 8);
    for (size_t i = 0; i < rows * columns; i++) {
        add_double(&hash, values[i]);
    }
    assay_hash_finish(&hash, digest_out);
}
