/* basis_constants.c - what the recurrences and the normalisation need, rounded once.
 *
 * Jacobi polynomials divided by their value at the end of [-1, 1] where they are largest obey
 *
 *     q_{k+1} = A_k (t - b_k) q_k - C_k q_{k-1},    with s = alpha + beta,
 *     A_k = (2k + s + 1) (2k + s + 2) / (2 (k + s + 1) (k + alpha + 1)),
 *     C_k = k (k + beta) (2k + s + 2) / ((k + s + 1) (2k + s) (k + alpha + 1)),
 *
 * where alpha belongs to that end ([dlmf] 18.9.2 divided by 18.6.1; at the other end t changes its
 * sign, and so does every other polynomial: theirs is kept positive for large t).  What is stepped
 * is p_k = s_k q_k with s_0 = 1, s_{k+1} = s_k 2^e / A_k and s_k in (1/2, 1], which leaves a power
 * of two before t, and g_k = C_k 2^(e_k + e_{k-1}) / (A_k A_{k-1}).
 *
 * The norm, from [dlmf] 18.3.1: the integral of (1 - t)^alpha (1 + t)^beta q_k^2 over t is
 *     2^(s+1) alpha!^2 k! (k + beta)! / ((2k + s + 1) (k + alpha)! (k + s)!). */
#include <math.h>

#include "basis/basis_data.h"
#include "math/double_double.h"

typedef struct {
    int alpha, beta; /* at the end where the polynomial is largest, and at the other */
    int end;         /* which that is: 1, -1                                         */
} jacobi;

static jacobi parameters(assay_basis_kind kind, int m)
{
    switch (kind) {
    case ASSAY_BASIS_ZERNIKE: return (jacobi){m, 0, 1};
    case ASSAY_BASIS_MAKHOTKIN:
    case ASSAY_BASIS_MAKHOTKIN_SQRT: return (jacobi){m + 1, m, -1};
    default: return (jacobi){m, m, 1};
    }
}

static double_double linear_factor(jacobi j, int k)
{
    const double        s   = j.alpha + j.beta;
    const double_double top = {(2.0 * k + s + 1.0) * (2.0 * k + s + 2.0), 0.0};
    return dd_divide_double(top, 2.0 * (k + s + 1.0) * (k + j.alpha + 1.0));
}

static double_double memory_factor(jacobi j, int k)
{
    const double        s   = j.alpha + j.beta;
    const double_double top = {k * (double)(k + j.beta) * (2.0 * k + s + 2.0), 0.0};
    return k == 0 ? top
                  : dd_divide_double(top, (k + s + 1.0) * (2.0 * k + s) * (k + j.alpha + 1.0));
}

static double_double shift(jacobi j, int k)
{
    const double        s   = j.alpha + j.beta;
    const double        far = j.end * (j.beta - j.alpha);
    const double_double top = {k == 0 ? far : far * s, 0.0};
    return dd_divide_double(top, (k == 0 ? 1.0 : 2.0 * k + s) * (2.0 * k + s + 2.0));
}

/* 2^(s+1) over the norm of q_k. */
static double_double inverse_norm(jacobi j, int k)
{
    double_double value = {2 * k + j.alpha + j.beta + 1, 0.0};
    for (int i = 1; i <= j.alpha; i++) {
        value = dd_multiply_double(value, (double)(k + i) * (k + j.beta + i));
        value = dd_divide_double(value, (double)i * i);
    }
    return value;
}

/* The factor that makes scale q_k b^m orthonormal.  The integral over the azimuth is pi or 2 pi;
 * what is left is 2^-halvings times the norm: b^m squared and the measure in terms of t. */
static double_double normalisation(assay_basis_kind kind, int m, jacobi j, int k)
{
    int halvings = 0;
    switch (kind) {
    case ASSAY_BASIS_ESH:
    case ASSAY_BASIS_HSH: halvings = 1; break;
    case ASSAY_BASIS_ZERNIKE: halvings = m + 1; break;
    case ASSAY_BASIS_MAKHOTKIN:
    case ASSAY_BASIS_MAKHOTKIN_SQRT: halvings = 2; break;
    default: break;
    }
    const double_double square = dd_divide(inverse_norm(j, k), DOUBLE_DOUBLE_PI);
    const int           power  = halvings - (j.alpha + j.beta + 1) - (m == 0 ? 1 : 0);
    return dd_sqrt(dd_multiply_double(square, ldexp(1.0, power)));
}

static bool is_negative(const assay_basis *basis, int m, int k)
{
    if (basis->kind == ASSAY_BASIS_ZERNIKE) {
        return k % 2 != 0; /* radial polynomials are positive on the horizon, t = -1 */
    }
    return basis_is_symmetric(basis->kind) && basis->convention == ASSAY_CONVENTION_THESIS &&
           m % 2 != 0;
}

static void split(double_double value, double *hi_out, double *lo_out)
{
    const double hi = (value.hi + 0x1.8p26) - 0x1.8p26;
    *hi_out         = hi;
    *lo_out         = (value.hi - hi) + value.lo;
}

static void fill(const assay_basis *basis, int m, basis_step *step)
{
    const jacobi  j        = parameters(basis->kind, m);
    double_double size     = {1.0, 0.0}; /* s_k               */
    double_double previous = {1.0, 0.0}; /* 2^e / A of k - 1  */
    for (int k = 0; k < basis->steps[m]; k++, step++) {
        const double_double a      = linear_factor(j, k);
        const double        next   = size.hi / a.hi;
        step->exponent             = next > 1.0 ? -1 : next <= 0.5 ? 1 : 0;
        const double_double growth = dd_divide((double_double){ldexp(1.0, step->exponent), 0.0}, a);
        const double_double g     = dd_multiply(dd_multiply(memory_factor(j, k), growth), previous);
        const double_double scale = dd_divide(normalisation(basis->kind, m, j, k), size);
        split(g, &step->g_hi, &step->g_lo);
        split(shift(j, k), &step->b_hi, &step->b_lo);
        step->scale = is_negative(basis, m, k) ? -scale.hi : scale.hi;
        size        = dd_multiply(size, growth);
        previous    = growth;
    }
}

void basis_constants(assay_basis *basis)
{
    basis_step *step = basis->step;
    for (int m = 0; m < basis->order; m++) {
        fill(basis, m, step);
        step += basis->steps[m];
    }
}
