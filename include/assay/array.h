/* array.h - tables of double in NumPy's .npy format. */
#ifndef ASSAY_ARRAY_H
#define ASSAY_ARRAY_H

#include "assay/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct assay_array assay_array;

/* A table of rows * columns doubles, row by row, zeros.
 * Errors: ARGUMENT (columns 0, or more than 2^31 values), MEMORY. */
ASSAY_API assay_status  assay_array_create(assay_context *context, size_t rows, size_t columns,
                                           assay_array **array_out);
ASSAY_API void          assay_array_destroy(assay_array *array);
ASSAY_API size_t        assay_array_rows(const assay_array *array);
ASSAY_API size_t        assay_array_columns(const assay_array *array);
ASSAY_API double       *assay_array_data(assay_array *array);
ASSAY_API const double *assay_array_values(const assay_array *array);

/* Reads a .npy file of versions 1 to 3, C order, '<f8', '<f4' or '<f2', one or two dimensions
 * (one dimension is one row a value).  Errors: NOT_FOUND, FORMAT, UNSUPPORTED (other types, Fortran
 * order, other byte order, more dimensions), LIMIT, MEMORY. */
ASSAY_API assay_status assay_array_read_npy(assay_context *context, const char *path,
                                            assay_array **array_out);

/* Writes '<f8', version 1.0, two dimensions; beside, then renamed.  Errors: WRITE, MEMORY. */
ASSAY_API assay_status assay_array_write_npy(const assay_array *array, const char *path);

#ifdef __cplusplus
}
#endif
#endif
