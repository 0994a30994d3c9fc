/* sh_rotation.c - spherical harmonics turned by any rotation.
 *
 * Invariant: D = Z(alpha) d(beta) Z(gamma) with each entry of d correct to the last bit or so: d is
 * a Jacobi polynomial times powers of the half angle's sine and cosine (Wigner's formula, as in
 * [edmonds57] 4.1), summed by its three-term recurrence [dlmf] 18.9 in double-double.  The
 * recurrence of [ivanic96, ivanic98] was measured beside it: in double it drifts to 4e-14 at l = 32
 * and depends on the matrix being orthogonal to begin with (docs/methods/basis-rotation.md).
 *
 * Real harmonics without (-1)^m; e(m, m') is d without its sign, m >= |m'|.  A turn about y mixes
 * cosines with cosines and sines with sines alone:
 *     cosines  e(m, m') + (-1)^m' e(m, -m'),   sines  e(m, m') - (-1)^m' e(m, -m'),
 *     sqrt(2) e(m, 0) where m' = 0 < m,        transposed: times (-1)^(m - m'). */
#include "basis/sh_rotation.h"

#include <string.h>

#include "basis/basis_data.h"
#include "math/double_double.h"

enum { ORDER = ASSAY_BASIS_MAX_ORDER, DEGREES = 2 * ORDER };

typedef struct {
    double_double root_factorial[DEGREES]; /* sqrt(k!)                        */
    double_double cos_power[DEGREES];      /* powers of cos and sin of beta/2 */
    double_double sin_power[DEGREES];
    double_double cos_beta;
    double        cos_alpha[ORDER], sin_alpha[ORDER], cos_gamma[ORDER], sin_gamma[ORDER];
} turn;

static turn turn_of(const assay_euler_zyz *split)
{
    turn                t;
    const double_double c = split->cos_half_beta, s = split->sin_half_beta;
    double_double       factorial = dd_of(1.0);
    t.root_factorial[0] = t.cos_power[0] = t.sin_power[0] = dd_of(1.0);
    for (int k = 1; k < DEGREES; k++) {
        factorial           = dd_multiply_double(factorial, k);
        t.root_factorial[k] = dd_sqrt(factorial);
        t.cos_power[k]      = dd_multiply(t.cos_power[k - 1], c);
        t.sin_power[k]      = dd_multiply(t.sin_power[k - 1], s);
    }
    t.cos_beta = dd_subtract(dd_multiply(c, c), dd_multiply(s, s));
    assay_angle_multiples(split->cos_alpha, split->sin_alpha, ORDER, t.cos_alpha, t.sin_alpha);
    assay_angle_multiples(split->cos_gamma, split->sin_gamma, ORDER, t.cos_gamma, t.sin_gamma);
    return t;
}

/* e^l(m, k) for l = m ... order - 1 in e_out[l]; m >= |k|. */
static void small_d(const turn *t, int order, int m, int k, double_double *e_out)
{
    const double_double *g     = t->root_factorial;
    const double_double  power = dd_multiply(t->sin_power[m - k], t->cos_power[m + k]);
    const double_double  below = dd_of(1.0);
    double_double        p = below, before = dd_of(0.0);
    for (int l = m; l < order; l++) {
        if (l == m + 1) {
            before = p;
            p      = dd_subtract(dd_multiply_double(t->cos_beta, m + 1), dd_of(k));
        } else if (l > m) {
            const double        a = (2.0 * l - 1.0) * l * (l - 1.0), b = (2.0 * l - 1.0) * m * k;
            const double        c   = l * ((l - 1.0) * (l - 1.0) - (double)k * k);
            const double_double sum = dd_subtract(
                dd_multiply(dd_subtract(dd_multiply_double(t->cos_beta, a), dd_of(b)), p),
                dd_multiply_double(before, c));
            const double down = (l - 1.0) * ((double)l * l - (double)m * m);
            before            = p;
            p                 = dd_divide_double(sum, down);
        }
        const double_double norm =
            dd_divide(dd_multiply(g[l + m], g[l - m]), dd_multiply(g[l + k], g[l - k]));
        e_out[l] = dd_multiply(dd_multiply(norm, power), p);
    }
}

typedef struct {
    const assay_basis *basis;
    size_t             count;
    double            *matrix;
} target;

static size_t place(const target *to, int l, int m) { return (size_t)basis_index(to->basis, l, m); }

/* Writes Z(alpha) diag(cosines, sines) Z(gamma) for one pair of m, k >= 0. */
static void write_pair(const target *to, const turn *t, int l, int m, int k, double cosines,
                       double sines)
{
    double *const row0 = to->matrix + place(to, l, m) * to->count;
    double *const row1 = to->matrix + place(to, l, -m) * to->count;
    const size_t  col0 = place(to, l, k), col1 = place(to, l, -k);
    const double  ca = t->cos_alpha[m], sa = t->sin_alpha[m];
    const double  cg = t->cos_gamma[k], sg = t->sin_gamma[k];
    if (m > 0) {
        row1[col0] = sa * cosines * cg + ca * sines * sg;
    }
    if (k > 0) {
        row0[col1] = -(ca * cosines * sg) - sa * sines * cg;
    }
    if (m > 0 && k > 0) {
        row1[col1] = ca * sines * cg - sa * cosines * sg;
    }
    row0[col0] = ca * cosines * cg - sa * sines * sg;
}

static void write_band_entries(const target *to, const turn *t, int order, int m, int k,
                               double sign)
{
    double_double plus[ORDER], minus[ORDER];
    small_d(t, order, m, k, plus);
    small_d(t, order, m, -k, minus);
    const double        flip = (k & 1) ? -1.0 : 1.0, transposed = ((m - k) & 1) ? -1.0 : 1.0;
    const double_double root2 = dd_sqrt(dd_of(2.0));
    for (int l = m; l < order; l++) {
        const double_double other   = dd_multiply_double(minus[l], flip);
        double              cosines = 0.0, sines = 0.0;
        if (k > 0) {
            cosines = sign * dd_round(dd_add(plus[l], other));
            sines   = sign * dd_round(dd_subtract(plus[l], other));
        } else {
            cosines = sign * dd_round(m > 0 ? dd_multiply(plus[l], root2) : plus[l]);
        }
        write_pair(to, t, l, m, k, cosines, sines);
        if (m != k) {
            write_pair(to, t, l, k, m, transposed * cosines, transposed * sines);
        }
    }
}

void assay_sh_rotation_of_split(const assay_basis *basis, const assay_euler_zyz *split,
                                double *matrix_out)
{
    const int    order  = assay_basis_order(basis);
    const bool   thesis = assay_basis_convention_of(basis) == ASSAY_CONVENTION_THESIS;
    const size_t count  = assay_basis_count(basis);
    const target to     = {basis, count, matrix_out};
    const turn   t      = turn_of(split);
    memset(matrix_out, 0, count * count * sizeof *matrix_out);
    for (int m = 0; m < order; m++) {
        for (int k = 0; k <= m; k++) {
            write_band_entries(&to, &t, order, m, k, thesis && ((m - k) & 1) ? -1.0 : 1.0);
        }
    }
}

static bool is_spherical(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_SH || kind == ASSAY_BASIS_LSOSH;
}

assay_status assay_sh_rotation(const assay_basis *sh, const double rotation[9], double *matrix_out)
{
    if (!is_spherical(assay_basis_kind_of(sh))) {
        return ASSAY_ERR_ARGUMENT;
    }
    assay_euler_zyz split;
    if (!assay_euler_zyz_split(rotation, &split)) {
        return ASSAY_ERR_DOMAIN;
    }
    assay_sh_rotation_of_split(sh, &split, matrix_out);
    return ASSAY_OK;
}

assay_status assay_sh_rotate(const assay_basis *sh, const double *matrix, int channels,
                             const double *coefficients, double *rotated_out)
{
    if (!is_spherical(assay_basis_kind_of(sh)) || channels < 1) {
        return ASSAY_ERR_ARGUMENT;
    }
    const size_t order = (size_t)assay_basis_order(sh), count = assay_basis_count(sh);
    for (size_t channel = 0; channel < (size_t)channels; channel++) {
        const double *in  = coefficients + channel * count;
        double       *out = rotated_out + channel * count;
        for (size_t l = 0; l < order; l++) {
            for (size_t i = l * l; i < (l + 1) * (l + 1); i++) {
                const double *row = matrix + i * count;
                double        sum = 0.0;
                for (size_t j = l * l; j < (l + 1) * (l + 1); j++) {
                    sum += row[j] * in[j];
                }
                out[i] = sum;
            }
        }
    }
    return ASSAY_OK;
}
