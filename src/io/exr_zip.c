/* exr_zip.c - inflating is most of reading, so it is left to libdeflate, which does nothing else,
 * in place of the library's zlib.
 *
 * Bytes of a chunk are sorted (those at even places, then those at odd ones), made differences plus
 * 128 to the one before, and deflated. */
#include "io/exr_zip.h"

static void add_up(uint8_t *bytes, size_t size)
{
    uint8_t sum = 128;
    for (size_t i = 0; i < size; i++) {
        sum      = (uint8_t)(sum + bytes[i] + 128);
        bytes[i] = sum;
    }
}

static void merge(const uint8_t *restrict sorted, uint8_t *restrict out, size_t size)
{
    const uint8_t *odd   = sorted + (size + 1) / 2;
    const size_t   pairs = size / 2;
    for (size_t i = 0; i < pairs; i++) {
        out[2 * i]     = sorted[i];
        out[2 * i + 1] = odd[i];
    }
    if (size % 2) {
        out[size - 1] = sorted[pairs];
    }
}

bool assay_exr_unzip(struct libdeflate_decompressor *inflater, const uint8_t *packed,
                     size_t packed_size, uint8_t *scratch, uint8_t *out, size_t size)
{
    if (libdeflate_zlib_decompress(inflater, packed, packed_size, scratch, size, NULL) !=
        LIBDEFLATE_SUCCESS) {
        return false;
    }
    add_up(scratch, size);
    merge(scratch, out, size);
    return true;
}
