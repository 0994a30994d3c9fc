/* euler_zyz.h - a rotation taken apart into Rz(alpha) Ry(beta) Rz(gamma). */
#ifndef ASSAY_BASIS_EULER_ZYZ_H
#define ASSAY_BASIS_EULER_ZYZ_H

#include <stdbool.h>

#include "math/double_double.h"

/* Sines and cosines of alpha, of gamma and of half of beta; beta in [0, pi], so both halves are
 * >= 0.  Where beta is 0 or pi only alpha + gamma or alpha - gamma means anything; the other is
 * then some number. */
typedef struct {
    double_double cos_alpha, sin_alpha;
    double_double cos_half_beta, sin_half_beta;
    double_double cos_gamma, sin_gamma;
} assay_euler_zyz;

/* Of the rotation nearest to the matrix (row by row; in the sum of squares).  False, nothing
 * written: the matrix is not a rotation to 2^-20, an improper one included. */
bool assay_euler_zyz_split(const double rotation[9], assay_euler_zyz *split_out);

/* cos(m angle), sin(m angle) for m < count. */
void assay_angle_multiples(double_double cosine, double_double sine, int count, double *cosines_out,
                           double *sines_out);

#endif
