/* basis.h - functions on the sphere and the hemisphere, and coefficients of them.
 *
 * Frame: right-handed, the pole is +z; a direction is a unit vector (theta from +z, phi from +x
 * towards +y).  Hemispherical bases live on z >= 0.  Formulas, sources and what the papers print
 * wrong: docs/methods/basis.md; signs, order, index and other people's conventions:
 * docs/conventions.md.  Everything is double arithmetic in a fixed order: the same bits on every
 * machine.  Nothing here prints; nothing keeps a state.  A NULL where a context, basis, map or
 * array is asked for is a programmer's error, as in all of assay: it is not looked for, but for
 * what is said to be allowed and for destroy functions. */
#ifndef ASSAY_BASIS_H
#define ASSAY_BASIS_H

#include <stdint.h>

#include "assay/array.h"
#include "assay/image.h"
#include "assay/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Largest order: bands l = 0 ... 32, as far as refdata/basis certifies them. */
#define ASSAY_BASIS_MAX_ORDER 33

/* A direction may be this far from unit length (| |d|^2 - 1 |); what is evaluated is d / |d|. */
#define ASSAY_BASIS_UNIT_TOLERANCE 0x1p-20

/* ---- which basis ---- */

typedef enum {
    ASSAY_BASIS_SH,      /* real spherical harmonics [gautron06] eq. 3.7; n^2 functions of l < n  */
    ASSAY_BASIS_HSH,     /* hemispherical harmonics, eq. 3.18; n^2                                */
    ASSAY_BASIS_ZERNIKE, /* hemispherical Zernike [koenderink96]: radial degree l < n, |m| <= l,
                            l - |m| even; n (n + 1) / 2                                           */
    ASSAY_BASIS_MAKHOTKIN, /* [makhotkin96], orthonormal under cos(theta) dw; n^2                 */
    ASSAY_BASIS_MAKHOTKIN_SQRT, /* the same times sqrt(cos theta): orthonormal under dw           */
    ASSAY_BASIS_ESH,  /* even reflection: sqrt(2) Y_l^m with l + m even, orthonormal on the
                         hemisphere [sloan03]; n (n + 1) / 2                                      */
    ASSAY_BASIS_LSOSH /* the functions of SH; coefficients by least squares over the hemisphere
                         [sloan03]; n^2                                                           */
} assay_basis_kind;
#define ASSAY_BASIS_KIND_COUNT 7

/* Signs and order of SH and HSH.  The others have signs of their own and take THESIS alone. */
typedef enum {
    ASSAY_CONVENTION_THESIS, /* (-1)^m as [gautron06] prints it; index l*l + l + m              */
    ASSAY_CONVENTION_PLAIN,  /* without (-1)^m: Y_1 = sqrt(3 / 4 pi) (y, z, x); the same index   */
    ASSAY_CONVENTION_KONTKANEN, /* [kontkanen] table 1: without (-1)^m, in the order 1; x, y, z;
                                   xz, yz, xy, 3z^2 - 1, x^2 - y^2; SH to order 3 alone           */
} assay_convention;
#define ASSAY_CONVENTION_COUNT 3

/* "sh", "hsh", "zernike", "makhotkin", "makhotkin-sqrt", "esh", "lsosh"; "thesis", "plain",
 * "kontkanen".  Borrowed; NULL outside the enumeration. */
ASSAY_API const char *assay_basis_kind_name(assay_basis_kind kind);
ASSAY_API const char *assay_convention_name(assay_convention convention);
/* The other way.  Errors: ARGUMENT, the output untouched. */
ASSAY_API assay_status assay_basis_kind_find(const char *name, assay_basis_kind *kind_out);
ASSAY_API assay_status assay_convention_find(const char *name, assay_convention *convention_out);

/* False for SH alone: whether the basis (LSOSH: its projection) is of the hemisphere. */
ASSAY_API bool assay_basis_kind_is_hemispherical(assay_basis_kind kind);

/* A basis of some order, with the constants of its recurrences.  Immutable: any number of threads
 * may use one. */
typedef struct assay_basis assay_basis;

/* order in 1 ... ASSAY_BASIS_MAX_ORDER.  Errors: ARGUMENT (order, or a convention that the kind
 * does not have), MEMORY. */
ASSAY_API assay_status assay_basis_create(assay_context *context, assay_basis_kind kind, int order,
                                          assay_convention convention, assay_basis **basis_out);
ASSAY_API void         assay_basis_destroy(assay_basis *basis);
ASSAY_API assay_basis_kind assay_basis_kind_of(const assay_basis *basis);
ASSAY_API assay_convention assay_basis_convention_of(const assay_basis *basis);
ASSAY_API int              assay_basis_order(const assay_basis *basis);
/* Number of functions. */
ASSAY_API size_t assay_basis_count(const assay_basis *basis);
/* Band and azimuthal number of function i < count (Zernike: radial degree and azimuthal), ascending
 * in l, then in m, but for the order KONTKANEN.  So i is l*l + l + m, for ZERNIKE and ESH l*(l +
 * 1)/2 + (l + m)/2. */
ASSAY_API void assay_basis_function(const assay_basis *basis, size_t i, int *l_out, int *m_out);

/* ---- Legendre polynomials ---- */

/* P_l^m(x) of 0 <= m <= l < order: values_out[l (l + 1) / 2 + m], with (-1)^m, by [gautron06]
 * eq. 3.4 to 3.6; shifted: of 2 x - 1 [gautron06] 3.3.1.  order (order + 1) / 2 numbers, not
 * normalised: up to 63!! = 1e42.  Errors: ARGUMENT (order outside 1 ... ASSAY_BASIS_MAX_ORDER),
 * DOMAIN (x outside
 * [-1, 1]; shifted: [0, 1]). */
ASSAY_API assay_status assay_legendre(int order, double x, double *values_out);
ASSAY_API assay_status assay_legendre_shifted(int order, double x, double *values_out);

/* ---- values ---- */

/* values_out: count, all functions at a direction.
 * Errors: DOMAIN (not finite, not of unit length, below the horizon of a hemispherical basis). */
ASSAY_API assay_status assay_basis_evaluate(const assay_basis *basis, assay_vec3 direction,
                                            double *values_out);

/* The same for many directions, row by row: values_out[i * count + function], with the bits of
 * assay_basis_evaluate.  On error nothing is written. */
ASSAY_API assay_status assay_basis_evaluate_many(const assay_basis *basis, size_t direction_count,
                                                 const assay_vec3 *directions, double *values_out);

/* Values and surface gradients, per radian: the derivative along a unit tangent t is
 * gradients_out[i] . t, and every gradient is tangential.
 * Errors: as above; DOMAIN on the horizon (z = 0) where the basis has infinite slopes there (HSH,
 * Makhotkin). */
ASSAY_API assay_status assay_basis_gradient(const assay_basis *basis, assay_vec3 direction,
                                            double *values_out, assay_vec3 *gradients_out);

/* ---- projection ---- */

/* A function of direction with `channels` numbers. */
typedef void (*assay_direction_function)(void *user, assay_vec3 direction, double *values_out);

/* Coefficients c_i = integral of f times function i, by Gauss quadrature in theta (theta_nodes,
 * mapped so that the ends of the hemisphere do not spoil it) times the trapezium rule in phi
 * (phi_nodes): exact, up to rounding, for what the nodes resolve.  Hemispherical bases integrate
 * over z >= 0; Makhotkin's with its weight cos(theta); LSOSH solves for the best fit.
 * f is called from the calling thread, once a node, in a fixed order.
 * coefficients_out: channels rows of count.  Errors: ARGUMENT (nodes < 1 or > 65536, channels < 1),
 * DOMAIN (f gave a number that is not finite, or LSOSH beyond order 14: singular), MEMORY. */
ASSAY_API assay_status assay_basis_project(const assay_basis *basis, assay_context *context,
                                           assay_direction_function f, void *user, int channels,
                                           int theta_nodes, int phi_nodes,
                                           double *coefficients_out);

/* The same by Monte Carlo, uniform over the sphere or hemisphere, from `samples` >= 2 directions of
 * the seed; variances_out: of the coefficients (the estimate's own, sample variance / samples). */
ASSAY_API assay_status assay_basis_project_random(const assay_basis *basis, assay_context *context,
                                                  assay_direction_function f, void *user,
                                                  int channels, uint64_t samples, uint64_t seed,
                                                  double *coefficients_out, double *variances_out);

/* The same from samples that somebody else took: values: rows of `channels`; pdf: density of each
 * direction, 1/sr, > 0.  In a hemispherical basis a sample below the horizon counts as 0. */
ASSAY_API assay_status assay_basis_project_samples(const assay_basis *basis, assay_context *context,
                                                   size_t            sample_count,
                                                   const assay_vec3 *directions, const double *pdf,
                                                   const double *values, int channels,
                                                   double *coefficients_out, double *variances_out);

/* SH coefficients of a latitude-longitude map (docs/conventions.md: texels are patches of constant
 * radiance; world frame, so the pole of the harmonics is world +z), channels R, G, B; every patch
 * is integrated exactly.  rotation: rad, about +y.  coefficients_out: 3 rows of count. Errors:
 * ARGUMENT (kind other than SH, channels missing), DOMAIN (texels not finite), MEMORY. */
ASSAY_API assay_status assay_basis_project_environment(const assay_basis *basis,
                                                       const assay_image *map, double rotation,
                                                       double *coefficients_out);

/* The same map in a hemispherical basis: the integrals over the hemisphere z >= 0 of a frame, its
 * texels cut at the horizon.  frame: rotation from the hemisphere's frame to the world's, row by
 * row (columns: where its x, y and z axes lie in the world); NULL: the world's own.  Along the
 * edges of texels by Gauss, with nodes that leave less than rounding; what rounding leaves is below
 * 1e-13 of the largest radiance (docs/methods/basis-accuracy.md).  Errors: ARGUMENT (kind SH,
 * channels missing), DOMAIN (texels not finite, frame not a rotation, LSOSH beyond order 14),
 * MEMORY, CANCELLED. */
ASSAY_API assay_status assay_basis_project_environment_hemisphere(
    const assay_basis *basis, assay_context *context, const assay_image *map, double rotation,
    const double *frame, double *coefficients_out);

/* A_l of the clamped cosine, l < order: irradiance = sum of A_l c_l^m Y_l^m(n) [kontkanen] table 1;
 * pi, 2 pi / 3, pi / 4, 0, -pi / 24, ...  Errors: ARGUMENT (order). */
ASSAY_API assay_status assay_clamped_cosine(int order, double *a_out);

/* The diffuse convolution: coefficients of radiance, channels rows of count, become those of
 * irradiance, in place.  Errors: ARGUMENT (kind other than SH, channels < 1). */
ASSAY_API assay_status assay_basis_convolve_cosine(const assay_basis *sh, int channels,
                                                   double *coefficients);

/* Sum of a_i b_i: of an orthonormal basis (all but LSOSH; Makhotkin's under its weight) the
 * integral of the product of both functions, as far as the basis holds them [gautron06] eq. 3.14.
 */
ASSAY_API double assay_basis_dot(const assay_basis *basis, const double *a, const double *b);

/* ---- rotation ---- */

/* R = Rz(alpha) Ry(beta) Rz(gamma), active and right-handed, row by row; beta > 0 moves the pole
 * towards +x.  rad. */
ASSAY_API void assay_rotation_from_euler_zyz(double alpha, double beta, double gamma,
                                             double rotation_out[9]);

/* The smallest rotation that takes +z to `pole` (for -z: the half turn about y); its columns are a
 * frame about that direction.  Errors: DOMAIN (not of unit length). */
ASSAY_API assay_status assay_rotation_to_pole(assay_vec3 pole, double rotation_out[9]);

/* D with c' = D c: coefficients of f(R^-1 w) from those of f; count * count, block-diagonal
 * (docs/methods/basis-rotation.md).  For SH (any convention) and LSOSH.  R may be off by rounding:
 * what is meant is the rotation nearest to it.  Errors: ARGUMENT (kind), DOMAIN (R is not a
 * rotation to 2^-20). */
ASSAY_API assay_status assay_sh_rotation(const assay_basis *sh, const double rotation[9],
                                         double *matrix_out);

/* c' = D c without the matrix being dense: blocks alone. rows: `channels` vectors of count. */
ASSAY_API assay_status assay_sh_rotate(const assay_basis *sh, const double *matrix, int channels,
                                       const double *coefficients, double *rotated_out);

/* Rotation about +z in closed form, any basis and convention: in place.  rad; good for angles of
 * many turns, too.  Errors: ARGUMENT (channels < 1), DOMAIN (angle not finite). */
ASSAY_API assay_status assay_basis_rotate_z(const assay_basis *basis, double angle, int channels,
                                            double *coefficients);

/* How a function in HSH is turned about +y by beta [gautron06] 3.4.  What is turned below the
 * horizon is lost; what comes up from below is 0. */
typedef enum {
    ASSAY_HSH_EXACT, /* M_R(beta), eq. 3.31, integrated at this very angle                    */
    ASSAY_HSH_TABLE, /* M_R interpolated linearly in a table of angles                        */
    ASSAY_HSH_CONVERSION, /* to SH (of an order of choice), turned, and back, 3.4.1 */
    ASSAY_HSH_DIGON,     /* digon deletion M(beta), eq. 3.27, then the analytical rotation        */
    ASSAY_HSH_ANALYTICAL /* eq. 3.30 as published: an approximation, not a rotation               */
} assay_hsh_rotation_way;
#define ASSAY_HSH_ROTATION_WAY_COUNT 5

typedef struct {
    assay_hsh_rotation_way way;
    int sh_order; /* CONVERSION: order of the SH between, >= 1; 0: that of the HSH              */
    int table_steps; /* TABLE: intervals over [0, pi / 2], >= 1; 0: 16 */
} assay_hsh_rotation_options;

/* Matrix with c' = M c; count * count.  options NULL: ASSAY_HSH_EXACT.  |beta| <= pi (DIGON,
 * ANALYTICAL: pi / 2, as eq. 3.30 is undefined beyond; TABLE: pi / 2).  Errors: ARGUMENT (kind
 * other than HSH, options), DOMAIN (beta), MEMORY. */
ASSAY_API assay_status assay_hsh_rotation_y(const assay_basis *hsh, assay_context *context,
                                            const assay_hsh_rotation_options *options, double beta,
                                            double *matrix_out);

/* Any rotation: about z in closed form before and after the turn about y.  Errors: as above. */
ASSAY_API assay_status assay_hsh_rotation(const assay_basis *hsh, assay_context *context,
                                          const assay_hsh_rotation_options *options,
                                          const double rotation[9], double *matrix_out);

/* M(beta), eq. 3.27: sets to zero what a turn about +y by beta moves below the horizon. */
ASSAY_API assay_status assay_hsh_digon(const assay_basis *hsh, assay_context *context, double beta,
                                       double *matrix_out);

/* ---- conversion ---- */

/* A matrix in rows of its non-zero entries: those of row r are number row_start[r] ...
 * row_start[r + 1] - 1.  Borrowed from the matrix. */
typedef struct assay_sparse assay_sparse;
typedef struct {
    size_t        rows, columns, entries;
    const size_t *row_start; /* rows + 1 */
    const size_t *column;
    const double *value;
} assay_sparse_view;

/* Coefficients in `to` from coefficients in `from`, to = C from: SH to HSH is the projection of
 * eq. 3.20 (C), HSH to SH that of the function continued by 0 (C transposed); orders and
 * conventions may differ.  Errors: ARGUMENT (not one SH and one HSH), MEMORY. */
ASSAY_API assay_status      assay_basis_conversion(assay_context *context, const assay_basis *from,
                                                   const assay_basis *to, assay_sparse **matrix_out);
ASSAY_API void              assay_sparse_destroy(assay_sparse *matrix);
ASSAY_API assay_sparse_view assay_sparse_entries(const assay_sparse *matrix);
/* out (rows) = matrix in (columns); in and out must not overlap. */
ASSAY_API void assay_sparse_multiply(const assay_sparse *matrix, const double *in, double *out);

/* ---- BRDFs ---- */

typedef enum { ASSAY_LOBE_PHONG, ASSAY_LOBE_WARD } assay_lobe_kind;

/* A BRDF lobe for one outgoing direction [gautron06] 3.5.1: Phong max(0, cos alpha)^exponent about
 * the mirror direction (the bare lobe, maximum 1); Ward's anisotropic BRDF [ward92] eq. 5 with
 * k_d = 0, k_s = 1, times cos(theta_i): without the cosine its square has no integral. */
typedef struct {
    assay_lobe_kind kind;
    double          exponent;         /* Phong, >= 0           */
    double          alpha_x, alpha_y; /* Ward, > 0             */
    double          theta_out;        /* rad, [0, pi / 2)      */
    double          phi_out;          /* rad                   */
} assay_lobe;

/* Value for light from wi (unit; 0 below the horizon).  Errors: DOMAIN. */
ASSAY_API assay_status assay_lobe_value(const assay_lobe *lobe, assay_vec3 wi, double *value_out);

/* Coefficients of a lobe, for SH, too, integrated over the hemisphere, below which it is 0; with
 * nodes that follow the lobe, however narrow, doubled until no coefficient moves by more than 1e-14
 * of the largest (1e-11 at the last).  Errors: DOMAIN (the lobe; it does not settle; LSOSH beyond
 * order 14), MEMORY, CANCELLED. */
ASSAY_API assay_status assay_basis_project_lobe(const assay_basis *basis, assay_context *context,
                                                const assay_lobe *lobe, double *coefficients_out);

/* Share of the lobe's energy that the basis captures (eq. 3.32, made well defined: docs/methods/
 * basis-accuracy.md), for orders 1 ... basis order: accuracy_out[order - 1], with the number of
 * functions that this order of the basis has in count_out (may be NULL).  LSOSH: at any order.
 * Errors: DOMAIN (the lobe, or it is too narrow for the quadrature), MEMORY, CANCELLED. */
ASSAY_API assay_status assay_basis_accuracy(const assay_basis *basis, assay_context *context,
                                            const assay_lobe *lobe, double *accuracy_out,
                                            size_t *count_out);

/* Coefficients of a BRDF for a grid of outgoing directions [gautron06] 3.5.2: side * side
 * directions by the paraboloid map, eq. 3.35, 3.36; texels outside the hemisphere hold what the
 * nearest direction on the horizon has. */
typedef struct assay_brdf_grid assay_brdf_grid;
/* What a BRDF times cos(theta_i) is for wo, wi, both z >= 0; finite also where wo.z = 0. */
typedef double (*assay_brdf_function)(void *user, assay_vec3 wo, assay_vec3 wi);
ASSAY_API assay_status assay_brdf_grid_create(const assay_basis *basis, assay_context *context,
                                              assay_brdf_function f, void *user, int side,
                                              int theta_nodes, int phi_nodes,
                                              assay_brdf_grid **grid_out);
/* The same, to the bit, on the context's threads: f is called from several at once. */
ASSAY_API assay_status assay_brdf_grid_create_parallel(const assay_basis  *basis,
                                                       assay_context      *context,
                                                       assay_brdf_function f, void *user, int side,
                                                       int theta_nodes, int phi_nodes,
                                                       assay_brdf_grid **grid_out);
ASSAY_API void         assay_brdf_grid_destroy(assay_brdf_grid *grid);
ASSAY_API int          assay_brdf_grid_side(const assay_brdf_grid *grid);
/* Coefficients of texel (column, row), count of the basis; borrowed. */
ASSAY_API const double *assay_brdf_grid_texel(const assay_brdf_grid *grid, int column, int row);
/* Bilinear lookup for wo, z >= 0.  Errors: DOMAIN. */
ASSAY_API assay_status assay_brdf_grid_lookup(const assay_brdf_grid *grid, assay_vec3 wo,
                                              double *coefficients_out);

#ifdef __cplusplus
}
#endif
#endif
