/* tile_filter_avx2.c - four pixels at a time, where the machine has vectors for that. */
#include "oracle/metrics/tile_filter.h"

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

#include "oracle/metrics/tile_filter_rows.h"

void assay_filter_row_wide(const assay_kernel *kernel, const double *in, ptrdiff_t step,
                           size_t width, double *out)
{
    filter_row(kernel, in, step, width, out);
}

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

bool assay_filter_has_wide(void) { return __builtin_cpu_supports("avx2"); }

#else

void assay_filter_row_wide(const assay_kernel *kernel, const double *in, ptrdiff_t step,
                           size_t width, double *out)
{
    assay_filter_row_pair(kernel, in, step, width, out);
}

bool assay_filter_has_wide(void) { return false; }

#endif
