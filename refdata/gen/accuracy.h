/* accuracy.h - share of a lobe's energy that a basis captures [gautron06] eq. 3.32, by order.
 *
 * The lobe f lives on the hemisphere and is even in y, so that sines have the coefficient 0.
 * Order n takes the functions with l < n (ERRATA T11): SH over the sphere with f = 0 below (T12),
 * ESH as sqrt(2) Y_lm with l + m even, orthonormal on the hemisphere (T10), Makhotkin times
 * sqrt(cos(theta)) (T18); LSOSH as the energy of the best fit by SH on the hemisphere; all over the
 * integral of f^2.  Makhotkin's plain functions have their weight cos(theta) in the coefficients
 * and in the energy that they are compared with. */
#ifndef ACCURACY_H
#define ACCURACY_H

#include "bases.h"
#include "ref.h"

#define ACCURACY_ORDER 10
/* sh, hsh, esh, zernike, makhotkin_sqrt, energy, lsosh, makhotkin, energy_cosine */
#define ACCURACY_COLUMNS 9
#define ACCURACY_VALUES                                                                            \
    "sh hsh esh zernike makhotkin_sqrt energy (integral of the lobe squared) lsosh (best fit by "  \
    "SH on the hemisphere) makhotkin (under its weight cos theta) energy_cosine (integral of the " \
    "lobe squared times cos theta)"
#define ACCURACY_COUNT (ACCURACY_ORDER * ACCURACY_COLUMNS)

typedef struct accuracy accuracy;

accuracy *accuracy_create(slong precision);
void      accuracy_destroy(accuracy *a);
/* Adds weight f B to all coefficients B at (C_m, z), C_m: ACCURACY_ORDER cosines. */
void accuracy_add(accuracy *a, acb_srcptr cosines, const acb_t z, const acb_t root_z,
                  const acb_t weight_f, slong precision);
void accuracy_add_energy(accuracy *a, const arb_t weight_f_squared, const arb_t z, slong precision);
/* Upper bound of |B| over all B (Makhotkin's plain ones times z) at a point. */
void accuracy_bound(mag_t out, const accuracy *a, acb_srcptr cosines, const acb_t z,
                    const acb_t root_z, slong precision);
/* out[ACCURACY_COLUMNS (n - 1) + column]; every sum is widened by error. */
void accuracy_finish(arb_ptr out, accuracy *a, const arb_t error, slong precision);

/* Writes the rows of one lobe. */
void accuracy_write(ref_table *table, double theta, ref_enclosure enclose, void *user);

#endif
