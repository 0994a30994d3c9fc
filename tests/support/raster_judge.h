/* raster_judge.h - a rasterised view against rays through the same pixels. */
#ifndef ASSAY_TESTS_RASTER_JUDGE_H
#define ASSAY_TESTS_RASTER_JUDGE_H

#include "gather/raster.h"

/* Pixels by what came of them. */
typedef struct {
    int same;  /* the same triangle, t, u, v to rounding, or nothing in both              */
    int tie;   /* another triangle, or nothing, as at an edge or between coincident faces */
    int wrong; /* all others                                                              */
    int hits;  /* of the rays                                                             */
} raster_verdict;

raster_verdict raster_judge(const assay_world *world, const assay_raster_view *view,
                            const assay_raster_sample *samples);

/* A view from a point on a triangle, chosen by `number` of a seed, over its front or its back, in a
 * frame turned at random about the normal; the eye stands off the surface as gathering rays do. */
assay_raster_view raster_judge_view(const assay_world *world, uint64_t seed, uint64_t number,
                                    double half, int side);

#endif
