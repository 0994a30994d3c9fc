/* lobe_bound.h - coefficients of the BRDFs that glossy pixels show, looked up in grids, and how far
 * lookups and products of less precision may be from ours. */
#ifndef ASSAY_ORACLE_LOBE_BOUND_H
#define ASSAY_ORACLE_LOBE_BOUND_H

#include "methods/material_grids.h"
#include "oracle/stage/radiance_bound.h"

/* Lobes of `side` * `side` texels one after the other; the texels are borrowed. */
typedef struct {
    assay_context    *context;
    int               side;
    size_t            count, lobe_count; /* coefficients of a texel; lobes */
    const double     *texels;
    assay_brdf_grid **grids;
} lobe_grids;

/* Zeros may be closed.  Errors: ARGUMENT, MEMORY. */
assay_status lobe_grids_open(assay_context *context, int side, size_t count, size_t lobe_count,
                             const double *texels, lobe_grids *grids_out);
void         lobe_grids_close(lobe_grids *grids);

/* What a pixel shows: numbers of its lobes, of base colour 1 less 0 and of base colour 0 by
 * channel. */
typedef struct {
    size_t     slope, black[ASSAY_MATERIAL_CHANNELS];
    assay_vec3 wo; /* unit, in the frame of the BRDF */
    assay_rgb  base_color;
} lobe_pixel;

/* 3 rows of coefficients, in the frame of the BRDF.  scratch: one row.  Errors: DOMAIN. */
assay_status lobe_look_up(const lobe_grids *grids, const lobe_pixel *pixel, double *scratch,
                          double *brdf_out);

/* Of these: 3 rows of pairs; sizes are those of the sum's terms, no smaller than the sum's. */
void lobe_bound(const lobe_grids *grids, const turn_bound *bound, const rounding *r,
                const lobe_pixel *pixel, double *sizes_out, double *errors_out);

/* Of the sum over products of two rows whose pairs have these sizes and errors, in any frame about
 * one z. */
double lobe_product_bound(const turn_bound *bound, const rounding *r, size_t count,
                          const double *sizes, const double *errors, const double *other_sizes,
                          const double *other_errors);

#endif
