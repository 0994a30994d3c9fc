/* flip_tile.c - the two pipelines of FLIP, colour and features, over a block of pixels.
 *
 * Invariant: a pixel's error is computed from the pixels around it alone, by the same operations in
 * the same order wherever the block's borders lie: blocks exist for the cache, and so that memory
 * is that of a worker and not of seven planes of doubles.  Beyond the image's border its outermost
 * pixels go on ([andersson20] section 4). */
#include "oracle/metrics/flip_tile.h"

#include "core/numerics.h"

/* What is left of an image after the filters along its rows. */
enum { LUMINANCE, RED_GREEN, BLUE_0, BLUE_1, SMOOTH, EDGE, POINT, ALONG };
/* ... and after those down its columns, of one row. */
enum { Y, C, Z_0, Z_1, EDGE_X, EDGE_Y, POINT_X, POINT_Y, DOWN };

/* The halo: how far the kernels reach on every side. */
typedef struct {
    size_t radius, columns, rows; /* columns and rows of a tile with its halo */
} halo;

typedef struct {
    double *opponent[3];     /* rows * columns each: luminance, red-green, blue-yellow */
    double *along[2][ALONG]; /* rows * ASSAY_TILE_WIDTH each, of a and b              */
    double *down[2][DOWN];   /* ASSAY_TILE_WIDTH each                                 */
} planes;

int assay_tile_count(int width, int height)
{
    return (width + ASSAY_TILE_WIDTH - 1) / ASSAY_TILE_WIDTH *
           ((height + ASSAY_TILE_HEIGHT - 1) / ASSAY_TILE_HEIGHT);
}

assay_tile assay_tile_at(int width, int height, int index)
{
    const int across = (width + ASSAY_TILE_WIDTH - 1) / ASSAY_TILE_WIDTH;
    const int x      = index % across * ASSAY_TILE_WIDTH;
    const int y      = index / across * ASSAY_TILE_HEIGHT;
    return (assay_tile){x, y, width - x < ASSAY_TILE_WIDTH ? width - x : ASSAY_TILE_WIDTH,
                        height - y < ASSAY_TILE_HEIGHT ? height - y : ASSAY_TILE_HEIGHT};
}

static halo halo_of(const assay_flip_kernels *kernels)
{
    const size_t radius = (size_t)kernels->radius;
    return (halo){radius, ASSAY_TILE_WIDTH + 2 * radius, ASSAY_TILE_HEIGHT + 2 * radius};
}

size_t assay_flip_scratch(const assay_flip_kernels *kernels)
{
    const halo h = halo_of(kernels);
    return 3 * h.rows * h.columns + (size_t)2 * ALONG * h.rows * ASSAY_TILE_WIDTH +
           (size_t)2 * DOWN * ASSAY_TILE_WIDTH;
}

static planes carve(const halo *h, double *scratch)
{
    planes p;
    for (int i = 0; i < 3; i++) {
        p.opponent[i] = scratch;
        scratch += h->rows * h->columns;
    }
    for (int i = 0; i < 2 * ALONG; i++) {
        p.along[i / ALONG][i % ALONG] = scratch;
        scratch += h->rows * ASSAY_TILE_WIDTH;
    }
    for (int i = 0; i < 2 * DOWN; i++) {
        p.down[i / DOWN][i % DOWN] = scratch;
        scratch += ASSAY_TILE_WIDTH;
    }
    return p;
}

static int clamp_index(int i, int count) { return i < 0 ? 0 : i < count ? i : count - 1; }

static double clamp_unit(double x) { return !(x > 0.0) ? 0.0 : x < 1.0 ? x : 1.0; }

/* Light of the display at this exposure, as opponent colours, of the tile and its halo. */
static void expose(const assay_flip_job *job, const assay_tile *tile, const float *const from[3],
                   double factor, const halo *h, planes *p)
{
    const int reach = (int)h->radius;
    for (int y = -reach; y < tile->height + reach; y++) {
        const size_t row =
            (size_t)clamp_index(tile->y + y, job->pair->height) * (size_t)job->pair->width;
        const size_t to = (size_t)(y + reach) * h->columns;
        for (int x = -reach; x < tile->width + reach; x++) {
            const size_t    i  = row + (size_t)clamp_index(tile->x + x, job->pair->width);
            const size_t    at = to + (size_t)(x + reach);
            const assay_rgb c  = {factor * from[0][i], factor * from[1][i], factor * from[2][i]};
            const assay_rgb shown =
                job->tone_mapped ? assay_tone_map(&job->curve, c)
                                 : (assay_rgb){clamp_unit(c.r), clamp_unit(c.g), clamp_unit(c.b)};
            const assay_opponent o = assay_flip_opponent(&job->colors, shown);
            p->opponent[0][at]     = o.y;
            p->opponent[1][at]     = o.c;
            p->opponent[2][at]     = o.z;
        }
    }
}

static void filter_along(const assay_flip_kernels *k, const assay_tile *tile, const halo *h,
                         const planes *p, double *const out[ALONG])
{
    const assay_kernel *const kernels[ALONG] = {
        &k->luminance, &k->red_green, &k->blue[0], &k->blue[1], &k->smooth, &k->edge, &k->point};
    static const int SOURCE[ALONG] = {0, 1, 2, 2, 0, 0, 0};
    for (int i = 0; i < ALONG; i++) {
        assay_filter_along(kernels[i], p->opponent[SOURCE[i]] + h->radius, h->columns,
                           (size_t)tile->width, (size_t)tile->height + 2 * h->radius, out[i],
                           ASSAY_TILE_WIDTH);
    }
}

static void filter_down(const assay_flip_kernels *k, const assay_tile *tile, size_t row,
                        double *const in[ALONG], double *const out[DOWN])
{
    const assay_kernel *const kernels[DOWN] = {&k->luminance, &k->red_green, &k->blue[0],
                                               &k->blue[1],   &k->smooth,    &k->edge,
                                               &k->smooth,    &k->point};
    static const int          SOURCE[DOWN]  = {LUMINANCE, RED_GREEN, BLUE_0, BLUE_1,
                                               EDGE,      SMOOTH,    POINT,  SMOOTH};
    for (int i = 0; i < DOWN; i++) {
        assay_filter_down(kernels[i], in[SOURCE[i]] + row * ASSAY_TILE_WIDTH, ASSAY_TILE_WIDTH,
                          (size_t)tile->width, out[i]);
    }
}

static assay_opponent filtered(const assay_flip_kernels *k, double *const down[DOWN], int x)
{
    return (assay_opponent){down[Y][x], down[C][x],
                            k->blue_share[0] * down[Z_0][x] + k->blue_share[1] * down[Z_1][x]};
}

static double length(double x, double y) { return sqrt(x * x + y * y); }

/* Delta E_f of [andersson20] section 4.2.2, with q_f = 1/2. */
static double feature_difference(double *const a[DOWN], double *const b[DOWN], int x)
{
    const double edge =
        fabs(length(a[EDGE_X][x], a[EDGE_Y][x]) - length(b[EDGE_X][x], b[EDGE_Y][x]));
    const double point =
        fabs(length(a[POINT_X][x], a[POINT_Y][x]) - length(b[POINT_X][x], b[POINT_Y][x]));
    return sqrt((edge > point ? edge : point) / sqrt(2.0));
}

void assay_flip_tile(const assay_flip_job *job, const assay_tile *tile, double exposure,
                     double *scratch, float *errors_out)
{
    const halo   h      = halo_of(&job->kernels);
    const double factor = assay_exp2(exposure);
    planes       p      = carve(&h, scratch);
    expose(job, tile, job->pair->a, factor, &h, &p);
    filter_along(&job->kernels, tile, &h, &p, p.along[0]);
    expose(job, tile, job->pair->b, factor, &h, &p);
    filter_along(&job->kernels, tile, &h, &p, p.along[1]);
    for (int y = 0; y < tile->height; y++) {
        for (int i = 0; i < 2; i++) {
            filter_down(&job->kernels, tile, (size_t)y + h.radius, p.along[i], p.down[i]);
        }
        for (int x = 0; x < tile->width; x++) {
            const double distance =
                assay_flip_color_distance(&job->colors, filtered(&job->kernels, p.down[0], x),
                                          filtered(&job->kernels, p.down[1], x));
            const double feature = feature_difference(p.down[0], p.down[1], x);
            errors_out[y * ASSAY_TILE_WIDTH + x] =
                (float)assay_flip_error(&job->colors, distance, feature);
        }
    }
}
