/* hemisphere_grid.h - a basis integrated over the cells of a hemisphere and along their borders. */
#ifndef ASSAY_GATHER_HEMISPHERE_GRID_H
#define ASSAY_GATHER_HEMISPHERE_GRID_H

#include "gather/hemisphere.h"

/* Function i is R_i(theta) t(phi), t = cos m phi or sin |m| phi.  Tables of t are rows of width =
 * 2 order - 1, at m + order - 1; u = (cos phi, sin phi), v = (-sin phi, cos phi). */
typedef struct {
    const assay_hemisphere *hemisphere; /* borrowed, as the basis is                             */
    const assay_basis      *basis;
    size_t                  count, width;
    size_t *partner;     /* of each function: that of the same l and |m|, m >= 0: its value at phi =
                            0 is R                                                               */
    size_t     *azimuth; /* of each function: its place in a row                                 */
    assay_vec3 *column;  /* row k: integrals over column k of t u and (z) of t                   */
    assay_vec3 *border;  /* row k: t v at the border before column k, z 0                        */
    double     *values;  /* count: scratch                                                       */
    double     *radial;  /* count: sum of R times weights                                        */
    assay_vec3 *moment;  /* 3 rows (R, G, B): sum of steps times rows of a table                 */
} hemisphere_grid;

/* Errors: MEMORY; close either way. */
assay_status hemisphere_grid_open(hemisphere_grid *grid, assay_context *context,
                                  const assay_hemisphere *hemisphere, const assay_basis *basis);
void         hemisphere_grid_close(hemisphere_grid *grid, assay_context *context);

/* Sums to zero. */
void hemisphere_grid_clear_radial(hemisphere_grid *grid);
void hemisphere_grid_clear_moment(hemisphere_grid *grid);

/* What R is integrated with over a stratum: d theta, the solid angle sin theta d theta, and this
 * times sin theta or cos theta. */
typedef enum { GRID_ARC, GRID_SOLID, GRID_SIDEWAYS, GRID_UPWARD } hemisphere_grid_measure;

/* Adds to radial: R(theta) times weight; the integral of R over stratum j. */
assay_status hemisphere_grid_add_ring(hemisphere_grid *grid, double theta, double weight);
assay_status hemisphere_grid_add_stratum(hemisphere_grid *grid, int j,
                                         hemisphere_grid_measure measure);
/* Adds to moment: `step` per channel times row k of a table. */
void hemisphere_grid_add_column(hemisphere_grid *grid, assay_rgb step, const assay_vec3 *table,
                                int k);

#endif
