/* array_data.h - the inside of a table; private to io but for its name. */
#ifndef ASSAY_IO_ARRAY_DATA_H
#define ASSAY_IO_ARRAY_DATA_H

#include <stdint.h>

#include "assay/array.h"

struct assay_array {
    assay_context *context;
    size_t         rows, columns;
    double        *values;     /* rows * columns, row by row                      */
    char          *name;       /* the file it was read from, or NULL: for messages */
    size_t         file_bytes; /* of a value in that file: 8, 4, 2; 0 where it was made    */
};

/* What to call a table in a message: its file, or what it is. */
const char *assay_array_name(const assay_array *array, const char *otherwise);

#define ASSAY_ARRAY_MAX_VALUES ((uint64_t)1 << 31)

#endif
