/* array_hash.h - SHA-256 of what an array says, whatever file holds it.
 *
 * Hashed are, in this order: the name and a NUL; the type, "<f4", "<u4" or "<f8", and a NUL; each
 * size of the shape (rows, columns and, of an image, channels) as 8 bytes; of an image the name of
 * each channel and a NUL; then the values by row, column, channel, in the bytes of the type.  All
 * little-endian.  Every NaN counts as the same one, for processors differ in the sign of those that
 * they make. */
#ifndef ASSAY_TESTS_ARRAY_HASH_H
#define ASSAY_TESTS_ARRAY_HASH_H

#include "assay/array.h"
#include "assay/image.h"

/* The type as it is hashed.  The channels of an image must be of one type. */
const char *array_hash_image_type(const assay_image *image);

/* digest_out: 64 hexadecimal digits and a NUL. */
void array_hash_image(const char *name, const assay_image *image, char digest_out[65]);
void array_hash_table(const char *name, const assay_array *table, char digest_out[65]);

#endif
