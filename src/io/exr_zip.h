/* exr_zip.h - OpenEXR's compressions ZIP and ZIPS, undone. */
#ifndef ASSAY_IO_EXR_ZIP_H
#define ASSAY_IO_EXR_ZIP_H

#include <libdeflate.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* False where the bytes are not a zlib stream of exactly `size` bytes with the right check sum.
 * scratch: room for size bytes. */
bool assay_exr_unzip(struct libdeflate_decompressor *inflater, const uint8_t *packed,
                     size_t packed_size, uint8_t *scratch, uint8_t *out, size_t size);

#endif
