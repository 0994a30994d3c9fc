/* tile_sums.h - sums of a noisy pair over tiles of several sizes, and over the whole image. */
#ifndef ASSAY_ORACLE_TILE_SUMS_H
#define ASSAY_ORACLE_TILE_SUMS_H

#include "assay/context.h"
#include "assay/verdict.h"
#include "oracle/image/noisy_pair.h"

enum { ASSAY_TILE_LEVELS = 3, ASSAY_TILE_STEP = 4 };

/* A level is a grid of square tiles from the top left; those at the right and the bottom may be
 * smaller.  Each level's tiles are four times as wide as those before. */
typedef struct {
    int               side; /* pixels */
    int               columns, rows;
    size_t            count;
    assay_noisy_sums *sums; /* row by row */
} assay_tile_level;

typedef struct {
    assay_context   *context;
    int              width, height;
    int              level_count; /* at least 1; more only where they have at least 4 tiles */
    assay_tile_level levels[ASSAY_TILE_LEVELS];
    assay_noisy_sums whole;
} assay_tile_sums;

/* The smallest tiles, in parallel; the sums do not depend on threads.  Errors: MEMORY, CANCELLED.
 */
assay_status assay_tile_sums_make(assay_context *context, const assay_noisy_pair *pair, int side,
                                  assay_tile_sums *sums_out);
/* The larger tiles and the whole, as sums of the smallest.  Errors: MEMORY. */
assay_status assay_tile_sums_gather(assay_tile_sums *sums);
void         assay_tile_sums_release(assay_tile_sums *sums);

/* Where a tile of a level is. */
assay_place assay_tile_place(const assay_tile_sums *sums, int level, size_t tile);

#endif
