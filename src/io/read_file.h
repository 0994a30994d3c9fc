/* read_file.h - a whole regular file in memory. */
#ifndef ASSAY_IO_READ_FILE_H
#define ASSAY_IO_READ_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

/* Reads a file; release *bytes_out with assay_release.  Only regular files are read: a folder, pipe
 * or device is refused, so that nothing waits or runs on for ever.
 * Errors: NOT_FOUND (missing, not readable, not a regular file), LIMIT (more than `limit` bytes),
 * MEMORY. */
assay_status assay_read_file(assay_context *context, const char *path, uint64_t limit,
                             uint8_t **bytes_out, size_t *count_out);

#endif
