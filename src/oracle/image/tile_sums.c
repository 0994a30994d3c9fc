/* tile_sums.c - a row of tiles is one item of a parallel loop; larger tiles are sums of smaller
 * ones.
 *
 * Invariant: every pixel is in exactly one tile of each level, and sums run in the order of pixels,
 * then of tiles. */
#include "oracle/image/tile_sums.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"

typedef struct {
    const assay_noisy_pair *pair;
    assay_tile_level       *level;
} tile_job;

static assay_status sum_row(void *user, uint64_t index, int worker)
{
    const tile_job         *job   = user;
    const assay_noisy_pair *pair  = job->pair;
    const int               side  = job->level->side;
    const int               first = (int)index * side;
    const int               last  = pair->height - first < side ? pair->height : first + side;
    assay_noisy_sums       *sums  = job->level->sums + index * (uint64_t)job->level->columns;
    for (int y = first; y < last; y++) {
        for (int x = 0; x < pair->width; x++) {
            const size_t           pixel = (size_t)y * (size_t)pair->width + (size_t)x;
            const assay_noisy_sums one   = assay_noisy_pixel(pair, pixel);
            assay_noisy_add(&sums[x / side], &one);
        }
    }
    (void)worker;
    return ASSAY_OK;
}

static assay_tile_level level_of(int width, int height, int side)
{
    assay_tile_level level = {
        .side = side, .columns = (width - 1) / side + 1, .rows = (height - 1) / side + 1};
    level.count = (size_t)level.columns * (size_t)level.rows;
    return level;
}

static void gather(const assay_tile_level *from, assay_tile_level *to)
{
    for (int y = 0; y < from->rows; y++) {
        for (int x = 0; x < from->columns; x++) {
            assay_noisy_add(&to->sums[(size_t)(y / ASSAY_TILE_STEP) * (size_t)to->columns +
                                      (size_t)(x / ASSAY_TILE_STEP)],
                            &from->sums[(size_t)y * (size_t)from->columns + (size_t)x]);
        }
    }
}

static assay_status allocate(assay_tile_sums *sums, assay_tile_level level)
{
    level.sums = assay_allocate(sums->context, level.count, sizeof *level.sums);
    if (!level.sums) {
        return assay_fail_memory(sums->context, "the sums of tiles");
    }
    sums->levels[sums->level_count++] = level;
    return ASSAY_OK;
}

assay_status assay_tile_sums_make(assay_context *context, const assay_noisy_pair *pair, int side,
                                  assay_tile_sums *sums_out)
{
    assay_tile_sums sums   = {.context = context, .width = pair->width, .height = pair->height};
    assay_status    status = allocate(&sums, level_of(pair->width, pair->height, side));
    tile_job        job    = {pair, &sums.levels[0]};
    if (status == ASSAY_OK) {
        status = assay_parallel_for(context, NULL, (uint64_t)sums.levels[0].rows, sum_row, &job);
    }
    if (status != ASSAY_OK) {
        assay_tile_sums_release(&sums);
        return status;
    }
    *sums_out = sums;
    return ASSAY_OK;
}

assay_status assay_tile_sums_gather(assay_tile_sums *sums)
{
    while (sums->level_count < ASSAY_TILE_LEVELS) {
        const assay_tile_level *from = &sums->levels[sums->level_count - 1];
        const assay_tile_level  next =
            level_of(sums->width, sums->height, from->side * ASSAY_TILE_STEP);
        if (next.count < ASSAY_TILE_STEP) {
            break;
        }
        const assay_status status = allocate(sums, next);
        if (status != ASSAY_OK) {
            return status;
        }
        gather(from, &sums->levels[sums->level_count - 1]);
    }
    for (size_t i = 0; i < sums->levels[0].count; i++) {
        assay_noisy_add(&sums->whole, &sums->levels[0].sums[i]);
    }
    return ASSAY_OK;
}

void assay_tile_sums_release(assay_tile_sums *sums)
{
    for (int i = 0; i < sums->level_count; i++) {
        assay_release(sums->context, sums->levels[i].sums);
        sums->levels[i].sums = NULL;
    }
    sums->level_count = 0;
}

assay_place assay_tile_place(const assay_tile_sums *sums, int level, size_t tile)
{
    const assay_tile_level *l = &sums->levels[level];
    const int               x = (int)(tile % (size_t)l->columns) * l->side;
    const int               y = (int)(tile / (size_t)l->columns) * l->side;
    return assay_place_tile(x, y, sums->width - x < l->side ? sums->width - x : l->side,
                            sums->height - y < l->side ? sums->height - y : l->side);
}
