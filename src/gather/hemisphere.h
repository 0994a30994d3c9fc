/* hemisphere.h - what is seen from a point, in M x N cells of its hemisphere, and what follows.
 *
 * Cell (j, k): stratum j of M in theta, counted from the pole, and k of N in phi.  Local frame: z
 * is the normal.  Two stratifications [gautron06] 2.2.5, derivations in docs/methods/gathering.md:
 *
 *     COSINE    sin^2 theta = (j + u1) / M      E = pi / (M N) sum of L
 *     UNIFORM   cos theta = 1 - (j + u1) / M    E = 2 pi / (M N) sum of L cos theta
 *
 * and phi = 2 pi (k + u2) / N for both.  Strata PLANE are pixels of one plane.  Every sum runs in
 * the order of the cells: a hemisphere gives the same bits whoever filled it, and in whatever
 * order. */
#ifndef ASSAY_GATHER_HEMISPHERE_H
#define ASSAY_GATHER_HEMISPHERE_H

#include "assay/basis.h"
#include "math/frame.h"

typedef enum { ASSAY_STRATA_COSINE, ASSAY_STRATA_UNIFORM, ASSAY_STRATA_PLANE } assay_strata;

/* What stands for the directions between the plane and the horizon (docs/methods/raster.md). */
typedef enum {
    ASSAY_MISSING_PLANE,           /* nothing                                                    */
    ASSAY_MISSING_RATIO,           /* all else, raised by what a furnace lacks [larsen04]        */
    ASSAY_MISSING_BORDER,          /* the pixels of the rim, as published [class08]            */
    ASSAY_MISSING_BORDER_CORRECTED /* the same, reaching down to the horizon                     */
} assay_missing;

/* Of strata PLANE: a square plane at distance 1 above the point, in theta rows of phi pixels, cell
 * (j, k) being the k-th along x of the j-th row along y. */
typedef struct {
    int          theta, phi; /* M, N: 2 ... ASSAY_STRATA_MAX each                                */
    assay_strata strata;
    bool         jitter; /* directions at random places of the cells, else at their centres; a note
                            of who fills the cells: nothing here depends on it                   */
    double fov;          /* PLANE: the angle that its middle line subtends, rad, ASSAY_FOV_MIN ...
                            ASSAY_FOV_MAX                                                      */
    assay_missing missing; /* PLANE                                                              */
} assay_hemisphere_layout;

#define ASSAY_FOV_MIN 0.01
#define ASSAY_FOV_MAX 3.14

#define ASSAY_STRATA_MAX 4096

/* What one direction sees. */
typedef struct {
    assay_rgb  radiance;   /* W/(m2 sr), finite, >= 0                                            */
    double     distance;   /* m, > 0; INFINITY where nothing is hit                              */
    assay_vec3 direction;  /* unit, local, in the cell                                           */
    assay_vec3 hit_normal; /* unit, local: geometric normal of what is hit, towards the viewer;
                              0 where nothing is.  Used by ASSAY_GRADIENT_POINTS alone           */
} assay_cell;

/* A border of cells: theta_j = border j of M + 1, the pole first, the horizon last. */
typedef struct {
    double sin, cos, theta;
} assay_theta_border;

/* Azimuths of column k of cells: of its lower border 2 pi k / N, and of its middle. */
typedef struct {
    double border_sin, border_cos, middle_sin, middle_cos;
} assay_phi_column;

typedef struct {
    assay_hemisphere_layout  layout;
    assay_cell              *cells; /* [j * phi + k]: to be written by whoever gathers            */
    assay_theta_border      *theta; /* M + 1 */
    assay_phi_column        *phi;   /* N     */
    struct hemisphere_plane *plane; /* what pixels weigh; NULL unless PLANE */
} assay_hemisphere;

/* Cells that see nothing: directions at the centres, radiance 0, distance INFINITY.
 * Errors: ARGUMENT (strata outside 2 ... ASSAY_STRATA_MAX or of no kind, fov, missing), MEMORY. */
assay_status assay_hemisphere_create(assay_context *context, const assay_hemisphere_layout *layout,
                                     assay_hemisphere **hemisphere_out);
void         assay_hemisphere_destroy(assay_context *context, assay_hemisphere *hemisphere);

/* The local direction of a cell; u1, u2 in [0, 1), 1/2 for its centre.  z > 0. */
assay_vec3 assay_hemisphere_direction(const assay_hemisphere_layout *layout, int j, int k,
                                      double u1, double u2);

/* Solid angle of each cell of stratum j, sr; all M N of them make 2 pi.  Not of PLANE. */
double assay_hemisphere_solid_angle(const assay_hemisphere *hemisphere, int j);

/* Irradiance, W/m2. */
assay_rgb assay_hemisphere_irradiance(const assay_hemisphere *hemisphere);

/* Gradients per channel, local frame: E(n') = E + (n x n') . g, W/(m2 rad), g tangential; and the
 * translational one, W/m3 [ward-heckbert92, as in gautron06 eq. 2.7, absolute]; normal: with a
 * component along z, too.  Where all cells have one radiance, both are exactly 0 (of PLANE the
 * rotational one to rounding). */
void assay_hemisphere_rotation_gradient(const assay_hemisphere *hemisphere,
                                        assay_vec3              gradient_out[3]);
void assay_hemisphere_translation_gradient(const assay_hemisphere *hemisphere, bool normal,
                                           assay_vec3 gradient_out[3]);

/* How directions count in the harmonic mean of distances: alike, or by their cosine. */
typedef enum { ASSAY_MEAN_UNIFORM, ASSAY_MEAN_COSINE } assay_mean_weight;

/* Harmonic mean distance, m: the integral of the weight over the integral of weight / distance;
 * INFINITY where nothing is seen. */
double assay_hemisphere_harmonic_mean(const assay_hemisphere *hemisphere, assay_mean_weight weight);
/* Smallest distance, m; INFINITY where nothing is seen. */
double assay_hemisphere_nearest(const assay_hemisphere *hemisphere);

/* Coefficients of the incident radiance, W/(m2 sr), in a hemispherical basis that is orthonormal
 * under solid angle: HSH, ZERNIKE, MAKHOTKIN_SQRT, ESH.  UNIFORM strata, jittered, estimate them
 * without bias; in COSINE strata, coarse at the horizon, radiance counts as constant in a cell.
 * coefficients_out: 3 rows (R, G, B) of count.  Errors: ARGUMENT (kind), MEMORY, DOMAIN (a cell's
 * direction is not of unit length or not above the horizon). */
assay_status assay_hemisphere_project(const assay_hemisphere *hemisphere, assay_context *context,
                                      const assay_basis *basis, double *coefficients_out);

/* Their translational gradients, W/(m3 sr) in the local frame, which moves without turning.
 * POINTS: what is seen are fixed points that keep their radiance; their solid angles and directions
 * move; wrong where they hide one another, and for UNIFORM strata.  WALLS: the borders of the cells
 * move as the nearer of their neighbours does; exactly 0 where all cells have one radiance.
 * gradients_out: 3 rows of count.  Errors: as above; ARGUMENT for POINTS on a PLANE, too. */
typedef enum { ASSAY_GRADIENT_POINTS, ASSAY_GRADIENT_WALLS } assay_gradient_form;
assay_status assay_hemisphere_project_gradient(const assay_hemisphere *hemisphere,
                                               assay_context *context, const assay_basis *basis,
                                               assay_gradient_form form, assay_vec3 *gradients_out);

#endif
