/* flip.c - FLIP of two images: tiles in parallel, exposures one after the other, and the numbers
 * that sum a map up.
 *
 * Invariant: a tile belongs to one worker and depends on nothing that another writes; the summary
 * is taken from the whole map in pixel order. */
#include <math.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "io/image_access.h"
#include "math/running_sum.h"
#include "oracle/metrics/flip_tile.h"
#include "oracle/metrics/float_sort.h"

typedef struct {
    assay_flip_job       job;
    assay_exposure_range range;
    float               *errors, *stops; /* of the image; stops may be NULL                     */
    double              *scratch;        /* of all workers                                      */
    float               *tiles;          /* the errors of one tile, of all workers              */
    size_t               scratch_size;
} flip_run;

enum { TILE_PIXELS = ASSAY_TILE_WIDTH * ASSAY_TILE_HEIGHT };

/* Keeps the larger error, and the exposure that it came from. */
static void keep_largest(flip_run *run, const assay_tile *tile, const float *errors, double stops)
{
    const size_t width = (size_t)run->job.pair->width;
    for (int y = 0; y < tile->height; y++) {
        const size_t row = (size_t)(tile->y + y) * width + (size_t)tile->x;
        for (int x = 0; x < tile->width; x++) {
            const float error = errors[y * ASSAY_TILE_WIDTH + x];
            if (error > run->errors[row + (size_t)x]) {
                run->errors[row + (size_t)x] = error;
                if (run->stops) {
                    run->stops[row + (size_t)x] = (float)stops;
                }
            }
        }
    }
}

static assay_status do_tile(void *user, uint64_t index, int worker)
{
    flip_run        *run   = user;
    const assay_tile tile  = assay_tile_at(run->job.pair->width, run->job.pair->height, (int)index);
    float           *tiles = run->tiles + (size_t)worker * TILE_PIXELS;
    for (int i = 0; i < run->range.count; i++) {
        const double exposure = assay_exposure_at(&run->range, i);
        assay_flip_tile(&run->job, &tile, exposure,
                        run->scratch + (size_t)worker * run->scratch_size, tiles);
        keep_largest(run, &tile, tiles, exposure);
    }
    return ASSAY_OK;
}

static assay_status fill(flip_run *run)
{
    assay_context *context = run->job.pair->context;
    const size_t   workers = (size_t)assay_context_threads(context);
    const size_t   pixels  = (size_t)run->job.pair->width * (size_t)run->job.pair->height;
    assay_status   status  = ASSAY_OK;
    run->scratch_size      = assay_flip_scratch(&run->job.kernels);
    run->scratch = assay_allocate(context, workers, run->scratch_size * sizeof *run->scratch);
    run->tiles   = assay_allocate(context, workers, TILE_PIXELS * sizeof *run->tiles);
    if (!run->scratch || !run->tiles) {
        status = assay_fail_memory(context, "FLIP");
    }
    for (size_t i = 0; run->stops && i < pixels; i++) {
        run->stops[i] = (float)run->range.start;
    }
    if (status == ASSAY_OK) {
        const int tiles = assay_tile_count(run->job.pair->width, run->job.pair->height);
        status          = assay_parallel_for(context, "flip", (uint64_t)tiles, do_tile, run);
    }
    assay_release(context, run->scratch);
    assay_release(context, run->tiles);
    return status;
}

/* The first of the sorted errors at which their sum exceeds the fraction of the total. */
static double weighted_quantile(const float *sorted, size_t count, double total, double fraction)
{
    running_sum sum = {0};
    for (size_t i = 0; i < count; i++) {
        running_sum_add(&sum, (double)sorted[i]);
        if (sum.sum + sum.lost > fraction * total) {
            return (double)sorted[i];
        }
    }
    return 0.0;
}

static assay_status summarise(const flip_run *run, assay_flip_summary *out)
{
    const size_t   width   = (size_t)run->job.pair->width;
    const size_t   pixels  = width * (size_t)run->job.pair->height;
    assay_context *context = run->job.pair->context;
    running_sum    sum     = {0};
    size_t         largest = 0;
    for (size_t i = 0; i < pixels; i++) {
        running_sum_add(&sum, (double)run->errors[i]);
        largest = run->errors[i] > run->errors[largest] ? i : largest;
    }
    float *sorted = assay_allocate(context, pixels, sizeof *sorted);
    if (!sorted) {
        return assay_fail_memory(context, "the quartiles of FLIP");
    }
    memcpy(sorted, run->errors, pixels * sizeof *sorted);
    const assay_status status = assay_float_sort(context, sorted, pixels);
    if (status == ASSAY_OK) {
        const double total = sum.sum + sum.lost;
        *out =
            (assay_flip_summary){.mean            = running_sum_mean(&sum, pixels),
                                 .weighted_median = weighted_quantile(sorted, pixels, total, 0.5),
                                 .first_quartile  = weighted_quantile(sorted, pixels, total, 0.25),
                                 .third_quartile  = weighted_quantile(sorted, pixels, total, 0.75),
                                 .minimum         = (double)sorted[0],
                                 .maximum         = (double)sorted[pixels - 1],
                                 .max_x           = (int)(largest % width),
                                 .max_y           = (int)(largest / width),
                                 .start_exposure  = run->range.start,
                                 .stop_exposure   = run->range.stop,
                                 .exposures       = run->range.count};
    }
    assay_release(context, sorted);
    return status;
}

static assay_status add_map(assay_context *context, const assay_picture_pair *pair, bool stops,
                            flip_run *run, assay_image **map)
{
    assay_channel channel;
    assay_status  status = assay_image_create(context, pair->width, pair->height, map);
    if (status == ASSAY_OK && stops) {
        status     = assay_image_add_channel(*map, "Exposure", ASSAY_CHANNEL_FLOAT, &channel);
        run->stops = status == ASSAY_OK ? channel.data.f32 : NULL;
    }
    if (status == ASSAY_OK) {
        status      = assay_image_add_channel(*map, "FLIP", ASSAY_CHANNEL_FLOAT, &channel);
        run->errors = status == ASSAY_OK ? channel.data.f32 : NULL;
    }
    return status;
}

static assay_status find_range(const assay_picture_pair *pair, assay_flip_kind kind,
                               const assay_metrics_options *options, assay_exposure_range *range)
{
    if (kind == ASSAY_FLIP_HDR) {
        return assay_exposure_range_find(pair, options, range);
    }
    *range = (assay_exposure_range){options->exposure, options->exposure, 1};
    return ASSAY_OK;
}

assay_status assay_image_flip(const assay_image *a, const assay_image *b, assay_flip_kind kind,
                              const assay_metrics_options *options, assay_flip_summary *summary_out,
                              assay_image **map_out)
{
    assay_picture_pair pair;
    flip_run           run     = {.job = {.pair = &pair, .tone_mapped = kind == ASSAY_FLIP_HDR}};
    assay_image       *map     = NULL;
    assay_flip_summary summary = {0};
    assay_status       status  = assay_metrics_check(assay_image_context(a), options);
    if (status == ASSAY_OK) {
        status = assay_picture_pair_open(a, b, options->layer, &pair);
    }
    if (status == ASSAY_OK) {
        status = find_range(&pair, kind, options, &run.range);
    }
    if (status == ASSAY_OK) {
        run.job.curve  = assay_tone_curve_of(options->tone_mapper);
        run.job.colors = assay_flip_colors_make();
        assay_flip_kernels_make(options->pixels_per_degree, &run.job.kernels);
        status = add_map(pair.context, &pair, map_out && kind == ASSAY_FLIP_HDR, &run, &map);
    }
    if (status == ASSAY_OK) {
        status = fill(&run);
    }
    if (status == ASSAY_OK) {
        status = summarise(&run, &summary);
    }
    if (status != ASSAY_OK || !map_out) {
        assay_image_destroy(map);
    } else {
        *map_out = map;
    }
    if (status == ASSAY_OK) {
        *summary_out = summary;
    }
    return status;
}
