/* hemisphere_plane.h - a hemisphere of strata PLANE: its pixels as cells, and what they weigh.  For
 * hemisphere*.c and its tests; formulas in docs/methods/raster.md. */
#ifndef ASSAY_GATHER_HEMISPHERE_PLANE_H
#define ASSAY_GATHER_HEMISPHERE_PLANE_H

#include "gather/hemisphere.h"
#include "gather/raster.h"

/* What a pixel stands for, with what it takes over of the missing directions. */
typedef struct {
    double     solid; /* solid angle, sr              */
    assay_vec3 flux;  /* the integral of w dw, sr     */
} plane_cell;

/* A border between two cells as part of a great circle: u cos alpha + v sin alpha. */
typedef struct {
    size_t     a, b;     /* cells                                                          */
    assay_vec3 across;   /* unit, from a to b: the circle's own normal                     */
    assay_vec3 u, v;     /* unit, perpendicular                                            */
    double     from, to; /* alpha, rad                                                     */
    bool       meridian; /* u is on the horizon and v the pole: beyond the plane           */
} plane_arc;

/* An arc for irradiance: across times the integral of the cosine along it. */
typedef struct {
    size_t     a, b;
    assay_vec3 way;
} plane_wall;

typedef struct hemisphere_plane {
    double        half; /* of the plane at distance 1                                     */
    int           columns, rows;
    assay_missing missing;
    double       *x, *y;       /* borders of columns and rows: columns + 1, rows + 1             */
    plane_cell   *cell;        /* [row * columns + column]                                       */
    plane_wall   *wall;        /* one an arc                                                     */
    size_t        wall_count;  /* rim arcs last                                                  */
    size_t        inner_count; /* of them between pixels of the plane                            */
    double        raise_flux, raise_solid; /* RATIO: what all are multiplied by; else 1          */
    assay_raster_view    view; /* of who gathered last, and ...                                */
    assay_raster_sample *seen; /* ... what its pixels saw: columns * rows                      */
} hemisphere_plane;

/* Errors: ARGUMENT (field of view, missing), MEMORY. */
assay_status hemisphere_plane_create(assay_context *context, const assay_hemisphere_layout *layout,
                                     hemisphere_plane **plane_out);
void         hemisphere_plane_destroy(assay_context *context, hemisphere_plane *plane);

assay_vec3 hemisphere_plane_direction(const assay_hemisphere_layout *layout, int j, int k,
                                      double u1, double u2);

/* An edge of a pixel on the rim, and what is beyond it down to the horizon.  In the frame of the
 * side, which is `side` quarter turns from that of the plane, the edge is on x = half between y =
 * from and y = to. */
typedef struct {
    size_t cell;
    int    side;
    double from, to;
} plane_rim;

/* Edge s of 2 (columns + rows), counter-clockwise. */
plane_rim hemisphere_plane_rim(const hemisphere_plane *plane, int s);
/* From the frame of a side to that of the plane. */
assay_vec3 hemisphere_plane_turn(assay_vec3 v, int side);
/* Arc i of wall_count. */
plane_arc hemisphere_plane_arc(const hemisphere_plane *plane, size_t i);

/* As those of hemisphere.h. */
assay_rgb    hemisphere_plane_irradiance(const assay_hemisphere *h);
void         hemisphere_plane_rotation(const assay_hemisphere *h, assay_vec3 gradient_out[3]);
void         hemisphere_plane_translation(const assay_hemisphere *h, bool normal,
                                          assay_vec3 gradient_out[3]);
double       hemisphere_plane_mean(const assay_hemisphere *h, assay_mean_weight weight);
assay_status hemisphere_plane_project(const assay_hemisphere *h, assay_context *context,
                                      const assay_basis *basis, double *sums);
assay_status hemisphere_plane_project_gradient(const assay_hemisphere *h, assay_context *context,
                                               const assay_basis *basis, assay_vec3 *sums);

#endif
