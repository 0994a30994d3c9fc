/* tile_filter_rows.h - the loops of tile_filter.h, for whatever vectors the including file allows.
 *
 * Taps outside, pixels inside: the inner loops go over neighbouring pixels, which the compiler
 * turns into vectors without changing a sum's order; they take two pairs of taps at a time to load
 * and store the sums half as often. */
#include "oracle/metrics/tile_filter.h"

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

/* A last pair without a partner is joined by one that weighs nothing: the pixel itself. */
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
