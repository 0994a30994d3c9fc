/* select.c - by sorting: what is asked for here is small. */
#include "math/select.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double assay_select(double *values, size_t count, size_t rank)
{
    qsort(values, count, sizeof *values, compare);
    return values[rank];
}
