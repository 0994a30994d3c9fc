/* raster.h - which triangle is seen through each pixel of a plane, by rasterisation.
 *
 * The same question as a ray through each pixel's centre, asked triangle by triangle.  Coverage and
 * depth are rules, not an order of work (docs/methods/raster.md): any order of triangles, and any
 * number of threads, gives the same bits. */
#ifndef ASSAY_GATHER_RASTER_H
#define ASSAY_GATHER_RASTER_H

#include "math/frame.h"
#include "trace/bvh.h"
#include "trace/world.h"

/* From where and onto what.  The centre of pixel (i, j) is (X, Y) with X = half (2 i + 1 - columns)
 * / columns, Y likewise with j: rows run along y.  In perspective the ray from the eye along
 * (X, Y, 1) of the frame, seen from the plane at distance 1; in parallel one along z from
 * (X, Y, 0), X and Y in m.  Depth is the local z, m. */
typedef struct {
    assay_vec3   eye;   /* m, world                                                        */
    assay_frame3 frame; /* looks along z                                                   */
    bool         parallel;
    double       half; /* > 0: half a side of the plane                                   */
    double       near; /* m: seen is what has a depth above it; >= 0 in perspective       */
    int          columns, rows; /* 1 ... ASSAY_RASTER_MAX                                 */
} assay_raster_view;

#define ASSAY_RASTER_MAX 8192

/* What a pixel sees. */
typedef struct {
    double   depth;    /* m; INFINITY: nothing      */
    uint32_t triangle; /* or ASSAY_NO_TRIANGLE      */
} assay_raster_sample;

/* Fills samples[j * columns + i].  Surfaces are seen from both sides; where a material has a mask
 * or blends, what covers less than a half is not there.
 * Errors: ARGUMENT (sizes, half, near), MEMORY. */
assay_status assay_raster_draw(const assay_world *world, const assay_raster_view *view,
                               assay_raster_sample *samples);

/* The middle of a pixel on the plane. */
typedef struct {
    double x, y;
} assay_raster_point;
assay_raster_point assay_raster_centre(const assay_raster_view *view, int column, int row);

/* The hit that a pixel's sample stands for: t along the unit direction (in parallel along z), u and
 * v correct in perspective.  The sample must be one of the view's. */
assay_hit assay_raster_hit(const assay_scene *scene, const assay_raster_view *view, int column,
                           int row, const assay_raster_sample *sample);

#endif
