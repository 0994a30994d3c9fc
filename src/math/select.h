/* select.h - order statistics. */
#ifndef ASSAY_MATH_SELECT_H
#define ASSAY_MATH_SELECT_H

#include <stddef.h>

/* The value at `rank` (from 0) when the values are in order; puts them in order.  rank < count; no
 * NaN. */
double assay_select(double *values, size_t count, size_t rank);

#endif
