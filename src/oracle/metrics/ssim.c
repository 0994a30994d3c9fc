/* ssim.c - structural similarity [wang04] of what a display shows.
 *
 * Invariant: the windows that lie inside the image are summed tile by tile and the tiles in index
 * order, so the mean is the same bits whatever the threads; equal pictures give 1 exactly, since
 * then numerator and denominator of every window are the same number. */
#include <math.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"
#include "io/image_access.h"
#include "io/srgb_encode.h"
#include "math/running_sum.h"
#include "oracle/metrics/picture.h"
#include "oracle/metrics/tile_filter.h"

enum { RADIUS = 5, TILE = 128, REACH = TILE + 2 * RADIUS };

/* Luma of a and b, their squares, and their product. */
enum { A, B, AA, BB, AB, MOMENTS };

/* [wang04] eqs. 7 and 10: (K L)^2 with a dynamic range L of 1. */
static const double C1 = 0.01 * 0.01, C2 = 0.03 * 0.03, DEVIATION = 1.5;

typedef struct {
    double luma[MOMENTS][REACH * REACH];
    double along[MOMENTS][REACH * TILE];
    double down[MOMENTS][TILE];
} ssim_scratch;

typedef struct {
    const assay_picture_pair *pair;
    assay_kernel              window;
    double                    factor;
    int                       width, height; /* of the windows inside the image */
    ssim_scratch             *scratch;       /* one a worker                    */
    double                   *sums;          /* one a tile                      */
} ssim_run;

static double luma(const float *const from[3], size_t i, double factor)
{
    const double light =
        0.2126 * (double)from[0][i] + 0.7152 * (double)from[1][i] + 0.0722 * (double)from[2][i];
    return assay_srgb_encode(factor * light);
}

static assay_kernel gaussian_window(void)
{
    assay_kernel kernel = {.radius = RADIUS};
    double       sum    = 0.0;
    for (int k = RADIUS; k >= 0; k--) {
        kernel.weights[k] = assay_exp(-k * k / (2.0 * DEVIATION * DEVIATION));
        sum += k ? 2.0 * kernel.weights[k] : kernel.weights[k];
    }
    for (int k = 0; k <= RADIUS; k++) {
        kernel.weights[k] /= sum;
    }
    return kernel;
}

/* The moments' integrands over `columns` x `rows` pixels from (x, y). */
static void fill(const ssim_run *run, size_t x, size_t y, size_t columns, size_t rows,
                 ssim_scratch *s)
{
    for (size_t row = 0; row < rows; row++) {
        const size_t from = (y + row) * (size_t)run->pair->width + x, to = row * REACH;
        for (size_t i = 0; i < columns; i++) {
            const double a      = luma(run->pair->a, from + i, run->factor);
            const double b      = luma(run->pair->b, from + i, run->factor);
            s->luma[A][to + i]  = a;
            s->luma[B][to + i]  = b;
            s->luma[AA][to + i] = a * a;
            s->luma[BB][to + i] = b * b;
            s->luma[AB][to + i] = a * b;
        }
    }
}

/* [wang04] eq. 13. */
static double similarity(double *const m[MOMENTS], size_t x)
{
    const double a = m[A][x], b = m[B][x];
    const double variance_a = m[AA][x] - a * a, variance_b = m[BB][x] - b * b;
    const double covariance = m[AB][x] - a * b;
    return ((2.0 * a * b + C1) * (2.0 * covariance + C2)) /
           ((a * a + b * b + C1) * (variance_a + variance_b + C2));
}

static assay_status do_tile(void *user, uint64_t index, int worker)
{
    ssim_run     *run    = user;
    ssim_scratch *s      = &run->scratch[worker];
    const size_t  across = ((size_t)run->width + TILE - 1) / TILE;
    const size_t  x = (size_t)index % across * TILE, y = (size_t)index / across * TILE;
    const size_t  width  = (size_t)run->width - x < TILE ? (size_t)run->width - x : TILE;
    const size_t  height = (size_t)run->height - y < TILE ? (size_t)run->height - y : TILE;
    const size_t  rows   = height + 2 * (size_t)RADIUS;
    double *const down[] = {s->down[A], s->down[B], s->down[AA], s->down[BB], s->down[AB]};
    running_sum   sum    = {0};
    fill(run, x, y, width + 2 * (size_t)RADIUS, rows, s);
    for (int m = 0; m < MOMENTS; m++) {
        assay_filter_along(&run->window, s->luma[m] + RADIUS, REACH, width, rows, s->along[m],
                           TILE);
    }
    for (size_t row = 0; row < height; row++) {
        for (int m = 0; m < MOMENTS; m++) {
            assay_filter_down(&run->window, s->along[m] + (row + RADIUS) * TILE, TILE, width,
                              down[m]);
        }
        for (size_t i = 0; i < width; i++) {
            running_sum_add(&sum, similarity(down, i));
        }
    }
    run->sums[index] = sum.sum + sum.lost;
    return ASSAY_OK;
}

static assay_status mean_similarity(ssim_run *run, double *ssim_out)
{
    assay_context *context = run->pair->context;
    const size_t   tiles =
        (((size_t)run->width + TILE - 1) / TILE) * (((size_t)run->height + TILE - 1) / TILE);
    run->scratch =
        assay_allocate(context, (size_t)assay_context_threads(context), sizeof *run->scratch);
    run->sums           = assay_allocate(context, tiles, sizeof *run->sums);
    assay_status status = run->scratch && run->sums ? ASSAY_OK : assay_fail_memory(context, "SSIM");
    if (status == ASSAY_OK) {
        status = assay_parallel_for(context, "ssim", tiles, do_tile, run);
    }
    if (status == ASSAY_OK) {
        running_sum sum = {0};
        for (size_t i = 0; i < tiles; i++) {
            running_sum_add(&sum, run->sums[i]);
        }
        *ssim_out = running_sum_mean(&sum, (uint64_t)run->width * (uint64_t)run->height);
    }
    assay_release(context, run->scratch);
    assay_release(context, run->sums);
    return status;
}

assay_status assay_image_ssim(const assay_image *a, const assay_image *b,
                              const assay_metrics_options *options, double *ssim_out)
{
    assay_picture_pair pair;
    assay_status       status = assay_metrics_check(assay_image_context(a), options);
    if (status == ASSAY_OK) {
        status = assay_picture_pair_open(a, b, options->layer, &pair);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    ssim_run run = {.pair   = &pair,
                    .window = gaussian_window(),
                    .factor = assay_exp2(options->exposure),
                    .width  = pair.width - 2 * RADIUS,
                    .height = pair.height - 2 * RADIUS};
    if (run.width < 1 || run.height < 1) {
        *ssim_out = NAN;
        return ASSAY_OK;
    }
    return mean_similarity(&run, ssim_out);
}
