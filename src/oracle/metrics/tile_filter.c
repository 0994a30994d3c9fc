/* tile_filter.c - rows and columns of blocks.
 *
 * Invariant: a pixel's sum runs over the taps from the centre outwards, each pair added before it
 * is weighted, whatever the width of the block or of the machine's vectors. */
#include "oracle/metrics/tile_filter_rows.h"

void assay_filter_row_pair(const assay_kernel *kernel, const double *in, ptrdiff_t step,
                           size_t width, double *out)
{
    filter_row(kernel, in, step, width, out);
}

static void one_row(const assay_kernel *kernel, const double *in, ptrdiff_t step, size_t width,
                    double *out)
{
    (assay_filter_has_wide() ? assay_filter_row_wide : assay_filter_row_pair)(kernel, in, step,
                                                                              width, out);
}

void assay_filter_along(const assay_kernel *kernel, const double *in, size_t in_stride,
                        size_t width, size_t rows, double *out, size_t out_stride)
{
    for (size_t y = 0; y < rows; y++) {
        one_row(kernel, in + y * in_stride, 1, width, out + y * out_stride);
    }
}

void assay_filter_down(const assay_kernel *kernel, const double *in, size_t in_stride, size_t width,
                       double *out)
{
    one_row(kernel, in, (ptrdiff_t)in_stride, width, out);
}
