/* float_sort.h - sorts what a picture has many of; private to oracle. */
#ifndef ASSAY_ORACLE_FLOAT_SORT_H
#define ASSAY_ORACLE_FLOAT_SORT_H

#include <stddef.h>

#include "assay/context.h"

/* Ascending; no value may be negative or NaN.  Errors: MEMORY. */
assay_status assay_float_sort(assay_context *context, float *values, size_t count);

#endif
