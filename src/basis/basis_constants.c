/* basis_constants.c - what the recurrences and the normalisation need, correctly rounded.
 *
 * With s = alpha + beta, a polynomial divided by its value at t = 1 obeys
 *
 *     q_{k+1} - q_k = c_k (q_k - q_{k-1}) - a_k (1 - t) q_k,
 *     a_k = (2k + s + 1) (2k + s + 2) / (2 (k + s + 1) (k + alpha + 1)),
 *     c_k = k (k + beta) (2k + s + 2) / ((k + s + 1) (2k + s) (k + alpha + 1)),
 *
 * [dlmf] 18.9.2 divided by 18.6.1.  Numerators and denominators are whole numbers below 2^53, so
 * one division rounds once.  The other end of t is the same with alpha and beta exchanged.
 *
 * The norm, from [dlmf] 18.3.1: the integral of (1 - t)^alpha (1 + t)^beta q_k^2 over t is
 *     2^{s+1} alpha!^2 k! (k + beta)! / ((2k + s + 1) (k + alpha)! (k + s)!). */
#include <math.h>

#include "basis/basis_data.h"
#include "math/double_double.h"

typedef struct {
    int alpha, beta; /* at the end where the polynomial is 1, and at the other */
} jacobi;

static jacobi parameters(assay_basis_kind kind, int m)
{
    switch (kind) {
    case ASSAY_BASIS_ZERNIKE: return (jacobi){m, 0};
    case ASSAY_BASIS_MAKHOTKIN:
    case ASSAY_BASIS_MAKHOTKIN_SQRT: return (jacobi){m, m + 1};
    default: return (jacobi){m, m};
    }
}

static double linear_factor(jacobi j, int k)
{
    const double s = j.alpha + j.beta;
    return (2.0 * k + s + 1.0) * (2.0 * k + s + 2.0) / (2.0 * (k + s + 1.0) * (k + j.alpha + 1.0));
}

static double memory_factor(jacobi j, int k)
{
    const double s = j.alpha + j.beta;
    return k == 0 ? 0.0
                  : k * (double)(k + j.beta) * (2.0 * k + s + 2.0) /
                        ((k + s + 1.0) * (2.0 * k + s) * (k + j.alpha + 1.0));
}

/* 2^{s+1} over the norm of q_k. */
static double_double inverse_norm(jacobi j, int k)
{
    double_double value = {2 * k + j.alpha + j.beta + 1, 0.0};
    for (int i = 1; i <= j.alpha; i++) {
        value = dd_multiply_double(value, (double)(k + i) * (k + j.beta + i));
        value = dd_divide_double(value, (double)i * i);
    }
    return value;
}

/* The factor that makes a function orthonormal.  The integral over the azimuth is pi or 2 pi; what
 * is left is 2^-shift times the norm: b^m squared and the measure in terms of t. */
static double normalisation(assay_basis_kind kind, int m, jacobi j, int k)
{
    const int s     = j.alpha + j.beta;
    int       shift = 0;
    switch (kind) {
    case ASSAY_BASIS_ESH:
    case ASSAY_BASIS_HSH: shift = 1; break;
    case ASSAY_BASIS_ZERNIKE: shift = m + 1; break;
    case ASSAY_BASIS_MAKHOTKIN:
    case ASSAY_BASIS_MAKHOTKIN_SQRT: shift = 2; break;
    default: break;
    }
    double_double square = dd_divide(inverse_norm(j, k), DOUBLE_DOUBLE_PI);
    square               = dd_multiply_double(square, ldexp(1.0, shift - s - 1 - (m == 0)));
    return dd_sqrt(square).hi;
}

static double sign(const assay_basis *basis, int m, int k, int zone)
{
    const bool condon_shortley = basis->symmetric && basis->convention == ASSAY_CONVENTION_THESIS;
    bool       negative        = condon_shortley && m % 2 != 0;
    if (!basis->symmetric && zone == 1 && k % 2 != 0) {
        negative = !negative; /* the end t = -1 */
    }
    if (basis->kind == ASSAY_BASIS_ZERNIKE && k % 2 != 0) {
        negative = !negative; /* radial polynomials are 1 on the horizon, t = -1 */
    }
    return negative ? -1.0 : 1.0;
}

void basis_constants(assay_basis *basis)
{
    for (int zone = 0; zone < BASIS_ZONES; zone++) {
        basis_step *step = basis->zone[zone];
        for (int m = 0; m < basis->order; m++) {
            jacobi j = parameters(basis->kind, m);
            if (!basis->symmetric && zone == 1) {
                j = (jacobi){j.beta, j.alpha};
            }
            for (int k = 0; k < basis->steps[m]; k++, step++) {
                step->a     = linear_factor(j, k);
                step->c     = memory_factor(j, k);
                step->scale = sign(basis, m, k, zone) * normalisation(basis->kind, m, j, k);
            }
        }
    }
}
