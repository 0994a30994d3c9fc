/* array_data.h - the inside of a table; private to io. */
#ifndef ASSAY_IO_ARRAY_DATA_H
#define ASSAY_IO_ARRAY_DATA_H

#include <stdint.h>

#include "assay/array.h"

struct assay_array {
    assay_context *context;
    size_t         rows, columns;
    double        *values; /* rows * columns, row by row */
};

#define ASSAY_ARRAY_MAX_VALUES ((uint64_t)1 << 31)

#endif
