/* tile_filter.c - taps outside, pixels inside.
 *
 * Invariant: a pixel's sum runs over the taps from the centre outwards, each pair added before it
 * is weighted, whatever the width of the block or of the machine's vectors.  The inner loops go
 * over neighbouring pixels, which the compiler turns into vectors without changing a sum's order;
 * they take two pairs at a time to load and store the sums half as often. */
#include "oracle/tile_filter.h"

/* The pairs at distances `near` and `far`, in elements, of an even kernel. */
static void add_even(double *restrict out, const double *restrict in, ptrdiff_t near, ptrdiff_t far,
                     size_t width, double near_weight, double far_weight)
{
    for (size_t x = 0; x < width; x++) {
        const double *at = in + x;
        out[x] =
            (out[x] + near_weight * (at[near] + at[-near])) + far_weight * (at[far] + at[-far]);
    }
}

static void add_odd(double *restrict out, const double *restrict in, ptrdiff_t near, ptrdiff_t far,
                    size_t width, double near_weight, double far_weight)
{
    for (size_t x = 0; x < width; x++) {
        const double *at = in + x;
        out[x] =
            (out[x] + near_weight * (at[near] - at[-near])) + far_weight * (at[far] - at[-far]);
    }
}

/* One row, whose taps are `step` elements apart.  A last pair without a partner is joined by one
 * that weighs nothing: the pixel itself. */
static void filter_row(const assay_kernel *kernel, const double *in, ptrdiff_t step, size_t width,
                       double *out)
{
    const double *w = kernel->weights;
    for (size_t x = 0; x < width; x++) {
        out[x] = w[0] * in[x];
    }
    for (int k = 1; k <= kernel->radius; k += 2) {
        const bool      last = k == kernel->radius;
        const ptrdiff_t near = k * step, far = last ? 0 : near + step;
        (kernel->odd ? add_odd : add_even)(out, in, near, far, width, w[k], last ? 0.0 : w[k + 1]);
    }
}

void assay_filter_along(const assay_kernel *kernel, const double *in, size_t in_stride,
                        size_t width, size_t rows, double *out, size_t out_stride)
{
    for (size_t y = 0; y < rows; y++) {
        filter_row(kernel, in + y * in_stride, 1, width, out + y * out_stride);
    }
}

void assay_filter_down(const assay_kernel *kernel, const double *in, size_t in_stride, size_t width,
                       double *out)
{
    filter_row(kernel, in, (ptrdiff_t)in_stride, width, out);
}
