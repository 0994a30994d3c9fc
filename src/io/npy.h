/* npy.h - NumPy tables out of memory; assay/array.h has the rest. */
#ifndef ASSAY_IO_NPY_H
#define ASSAY_IO_NPY_H

#include <stdint.h>

#include "assay/array.h"

/* Largest .npy file that is read, bytes. */
#define ASSAY_NPY_MAX_FILE ((uint64_t)1 << 35)

/* A table from a file's bytes; name is for messages.  Errors as assay_array_read_npy. */
assay_status assay_array_decode_npy(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, assay_array **array_out);

#endif
