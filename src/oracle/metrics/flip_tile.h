/* flip_tile.h - LDR-FLIP of one block of pixels at one exposure; private to oracle. */
#ifndef ASSAY_ORACLE_FLIP_TILE_H
#define ASSAY_ORACLE_FLIP_TILE_H

#include "oracle/metrics/flip_color.h"
#include "oracle/metrics/flip_kernels.h"
#include "oracle/metrics/flip_tone.h"

enum { ASSAY_TILE_WIDTH = 128, ASSAY_TILE_HEIGHT = 128 };

/* What all tiles share. */
typedef struct {
    const assay_picture_pair *pair;
    assay_flip_colors         colors;
    assay_flip_kernels        kernels;
    bool                      tone_mapped; /* else clamped */
    assay_tone_curve          curve;
} assay_flip_job;

typedef struct {
    int x, y, width, height;
} assay_tile;

int        assay_tile_count(int width, int height);
assay_tile assay_tile_at(int width, int height, int index);

/* Doubles of scratch memory that a worker needs. */
size_t assay_flip_scratch(const assay_flip_kernels *kernels);

/* Errors in [0, 1] of the tile at this exposure (stops); row y begins at errors_out + y *
 * ASSAY_TILE_WIDTH. */
void assay_flip_tile(const assay_flip_job *job, const assay_tile *tile, double exposure,
                     double *scratch, float *errors_out);

#endif
