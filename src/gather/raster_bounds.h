/* raster_bounds.h - which pixels a triangle or a box may reach; never too few. */
#ifndef ASSAY_GATHER_RASTER_BOUNDS_H
#define ASSAY_GATHER_RASTER_BOUNDS_H

#include "gather/raster_triangle.h"
#include "trace/bvh_visit.h"

typedef struct {
    int first, last;
} pixel_range;

/* A band of rows of a view: what is outside of it is not looked at. */
typedef struct {
    const assay_raster_view *view;
    pixel_range              rows;
    double                   low_y, high_y; /* its borders on the plane                       */
    double                   slack;         /* m, above the rounding of a place in the scene  */
} raster_band;

raster_band raster_band_of(const assay_scene *scene, const assay_raster_view *view,
                           pixel_range rows);

/* Whether all corners are beyond the same side of the band, or behind the eye. */
bool raster_band_misses(const raster_band *band, const raster_triangle *t);

/* Pixels of the band whose centres may lie on the triangle; false: it crosses the eye's plane or is
 * so near to it that its projection says nothing. */
bool raster_band_bound(const raster_band *band, const raster_triangle *t, pixel_range *columns_out,
                       pixel_range *rows_out);

/* A triangle that crosses the eye's plane. */
typedef struct {
    double x, y, c; /* the edge function at (X, Y) is x X + y Y + c */
} edge_plane;

typedef struct {
    edge_plane edge[3];
    double     sign; /* of the edge functions where it is before the eye; 0: not known */
} raster_crossing;

raster_crossing raster_crossing_of(const raster_triangle *t);
/* Columns of the row whose centres are at y that may be on it. */
pixel_range raster_crossing_span(const raster_crossing *c, const assay_raster_view *view, double y);

/* A box as the band sees it. */
typedef struct {
    double      depth; /* the least that is in it, m, less slack; INFINITY: nothing of it is seen */
    bool        bounded;
    pixel_range columns, rows; /* where bounded */
} raster_box;

void raster_band_boxes(const raster_band *band, const assay_bvh_planes planes,
                       raster_box boxes_out[ASSAY_BVH_BOXES]);

#endif
