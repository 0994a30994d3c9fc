/* tile_filter.h - one-dimensional convolutions of blocks of doubles; private to oracle. */
#ifndef ASSAY_ORACLE_TILE_FILTER_H
#define ASSAY_ORACLE_TILE_FILTER_H

#include <stdbool.h>
#include <stddef.h>

enum { ASSAY_KERNEL_MAX_RADIUS = 140 };

/* 2 radius + 1 taps; weights[k] is that of both taps k away from the centre, with the other sign
 * for the one before it where the kernel is odd (weights[0] is 0 then). */
typedef struct {
    int    radius;
    bool   odd;
    double weights[ASSAY_KERNEL_MAX_RADIUS + 1];
} assay_kernel;

/* out[x] = sum over k of weight_k in[x + k], x in [0, width), for each of `rows` rows.  `in` points
 * at x = 0 of the first row and is read from -radius to width + radius. */
void assay_filter_along(const assay_kernel *kernel, const double *in, size_t in_stride,
                        size_t width, size_t rows, double *out, size_t out_stride);

/* One row of the convolution down the columns: `in` points at the row itself and is read from
 * radius rows above to radius rows below. */
void assay_filter_down(const assay_kernel *kernel, const double *in, size_t in_stride, size_t width,
                       double *out);

/* One row whose taps are `step` elements apart, by vectors of two and of four doubles; the second
 * only where assay_filter_has_wide.  The same bits. */
void assay_filter_row_pair(const assay_kernel *kernel, const double *in, ptrdiff_t step,
                           size_t width, double *out);
void assay_filter_row_wide(const assay_kernel *kernel, const double *in, ptrdiff_t step,
                           size_t width, double *out);
bool assay_filter_has_wide(void);

#endif
