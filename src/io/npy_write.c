/* npy_write.c - NumPy's .npy format 1.0: '<f8', C order, two dimensions, the header padded so that
 * the values begin at a multiple of 64 bytes. */
#include <stdio.h>
#include <string.h>

#include "io/array_data.h"
#include "io/atomic_file.h"

enum { HEADER_BYTES = 128, PREFIX_BYTES = 10 };

static void write_header(assay_atomic_file *file, const assay_array *array)
{
    uint8_t header[HEADER_BYTES];
    memset(header, ' ', sizeof header);
    memcpy(header, "\223NUMPY\001\000", 8);
    header[8]        = HEADER_BYTES - PREFIX_BYTES;
    header[9]        = 0;
    const int length = snprintf((char *)header + PREFIX_BYTES, sizeof header - PREFIX_BYTES,
                                "{'descr': '<f8', 'fortran_order': False, 'shape': (%zu, %zu), }",
                                array->rows, array->columns);
    header[PREFIX_BYTES + length] = ' ';
    header[HEADER_BYTES - 1]      = '\n';
    assay_atomic_file_write(file, header, sizeof header);
}

static void write_value(assay_atomic_file *file, double value)
{
    uint64_t bits;
    uint8_t  bytes[8];
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++) {
        bytes[i] = (uint8_t)(bits >> (8 * i));
    }
    assay_atomic_file_write(file, bytes, sizeof bytes);
}

assay_status assay_array_write_npy(const assay_array *array, const char *path)
{
    assay_atomic_file *file   = NULL;
    const assay_status status = assay_atomic_file_open(array->context, path, &file);
    if (status != ASSAY_OK) {
        return status;
    }
    write_header(file, array);
    for (size_t i = 0; i < array->rows * array->columns && !assay_atomic_file_failed(file); i++) {
        write_value(file, array->values[i]);
    }
    return assay_atomic_file_commit(file);
}
