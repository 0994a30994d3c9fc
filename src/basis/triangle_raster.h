/* triangle_raster.h - opaque triangles with a depth buffer. */
#ifndef ASSAY_BASIS_TRIANGLE_RASTER_H
#define ASSAY_BASIS_TRIANGLE_RASTER_H

#include "assay/context.h"
#include "assay/types.h"

typedef struct {
    assay_context *context;
    int            side;  /* square, pixels                               */
    float         *depth; /* side * side: greater is nearer               */
    float         *color; /* side * side rows of three, linear            */
} assay_triangle_raster;

/* White, and nothing in front of it.  Errors: MEMORY; the raster then holds nothing. */
assay_status assay_triangle_raster_create(assay_context *context, int side,
                                          assay_triangle_raster *raster_out);
void         assay_triangle_raster_destroy(assay_triangle_raster *raster);

/* Corners: x right, y down, pixels; z towards the eye.  Pixels whose centre lies inside, and in
 * front of what is there, get the colour. */
void assay_triangle_raster_add(assay_triangle_raster *raster, assay_vec3 a, assay_vec3 b,
                               assay_vec3 c, assay_rgb color);

#endif
