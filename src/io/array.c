/* array.c - tables of double. */
#include "assay/array.h"

#include <stdint.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/array_data.h"

assay_status assay_array_create(assay_context *context, size_t rows, size_t columns,
                                assay_array **array_out)
{
    if (columns == 0 || rows > ASSAY_ARRAY_MAX_VALUES / columns) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a table of %zu x %zu values: it needs a column, and at most %llu values",
                          rows, columns, (unsigned long long)ASSAY_ARRAY_MAX_VALUES);
    }
    assay_array *array = assay_allocate(context, 1, sizeof *array);
    if (!array) {
        return assay_fail_memory(context, "a table");
    }
    array->context = context;
    array->rows    = rows;
    array->columns = columns;
    array->values  = assay_allocate(context, rows * columns, sizeof *array->values);
    if (!array->values) {
        assay_array_destroy(array);
        return assay_fail_memory(context, "a table");
    }
    *array_out = array;
    return ASSAY_OK;
}

void assay_array_destroy(assay_array *array)
{
    if (array) {
        assay_release(array->context, array->values);
        assay_release(array->context, array->name);
        assay_release(array->context, array);
    }
}

size_t assay_array_rows(const assay_array *array) { return array->rows; }

size_t assay_array_columns(const assay_array *array) { return array->columns; }

double *assay_array_data(assay_array *array) { return array->values; }

const double *assay_array_values(const assay_array *array) { return array->values; }

const char *assay_array_name(const assay_array *array, const char *otherwise)
{
    return array->name ? array->name : otherwise;
}
