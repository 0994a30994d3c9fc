/* basis_bound.c - rounding of three-term recurrences, to first order exactly propagated.
 *
 * A function is scale p_k(t) times Re or Im of b^m (basis_data.h).  The polynomials obey
 * p_(k+1) = x_k p_k - g_k p_(k-1); an error d made at degree j reaches degree k as G_kj d, where G
 * obeys the same recurrence from G_jj = 1, G_(j-1)j = 0.  So
 *
 *     |error of p_k| <= sum over j <= k of |G_kj| d_j,
 *     d_(k+1) = 3 u |x_k p_k| + 3 u |g_k p_(k-1)| + 2 u |p_(k+1)| + e_t |dx/dt p_k|,
 *
 * which covers the recurrence as it is here and, as terms scale alike, [gautron06] eq. 3.6 with its
 * three products and its quotient.  Bounding |p| by tracked numbers step by step would lose the
 * signs of G, and grow as 2.4^k where the truth grows as k^2.
 *
 * Powers and norms: b^m by m products, or sin^m times the cosine of m phi, is off by
 * m |b|^(m-1) (e_b + 8 u |b|), e_b being what the direction's rounding leaves of b, computed as it
 * stands or as the root of 1 - t^2; norms are products of up to 2 m + 3 rounded factors under a
 * root, and as many in (2 m - 1)!!: (4 m + 6) u. */
#include "oracle/stage/basis_bound.h"

#include "basis/basis_data.h"

enum { ORDER = ASSAY_BASIS_MAX_ORDER };

bool basis_bound_known(assay_basis_kind kind)
{
    return kind != ASSAY_BASIS_MAKHOTKIN && kind != ASSAY_BASIS_LSOSH;
}

/* t, |b| and what they may be off. */
typedef struct {
    tracked t;
    double  size, error; /* of b                     */
    double  weight;      /* of all: relative error  */
} place;

static place place_of(const rounding *r, const assay_basis *basis, assay_vec3 d)
{
    const double side = d.x * d.x + d.y * d.y;
    const double far  = sqrt(side);
    const double loss = 2.0 * (r->u + r->given);
    place        p    = {.t = tracked_given(r, d.z), .size = far, .error = r->given * far};
    if (!basis_is_spherical(basis->kind)) {
        const double z = d.z > 0.0 ? d.z : 0.0;
        const double root =
            basis->kind == ASSAY_BASIS_ZERNIKE ? sqrt(1.0 / (1.0 + z)) : 2.0 * sqrt(z / (1.0 + z));
        p.t     = (tracked){2.0 * z - 1.0, 2.0 * r->given * z + r->u};
        p.size  = far * root;
        p.error = (3.0 * r->given + 4.0 * r->u) * p.size;
    }
    p.error += p.size > 0.0 ? fmin(loss / p.size, sqrt(loss)) : sqrt(loss);
    p.weight = basis->kind == ASSAY_BASIS_MAKHOTKIN_SQRT ? 0.5 * r->given + 2.0 * r->u : 0.0;
    return p;
}

/* p_k and their errors, k < steps. */
static void walk(const rounding *r, const basis_step *step, int steps, tracked t, tracked *p)
{
    double x[ORDER], g[ORDER], d[ORDER];
    p[0] = tracked_exact(1.0);
    d[0] = 0.0;
    for (int k = 0; k + 1 < steps; k++) {
        const double slope  = step[k].exponent < 0 ? 0.5 : step[k].exponent + 1.0;
        const double shift  = step[k].b_hi + step[k].b_lo;
        const double before = k > 0 ? p[k - 1].v : 0.0;
        x[k]                = slope * (t.v - shift);
        g[k]                = step[k].g_hi + step[k].g_lo;
        p[k + 1]            = tracked_exact(x[k] * p[k].v - g[k] * before);
        d[k + 1]            = r->u * (3.0 * fabs(x[k] * p[k].v) + slope * fabs(shift * p[k].v) +
                           3.0 * fabs(g[k] * before) + 2.0 * fabs(p[k + 1].v)) +
                   t.e * slope * fabs(p[k].v);
    }
    for (int j = 1; j < steps; j++) {
        double reach = 1.0, last = 0.0;
        for (int k = j; k < steps; k++) {
            p[k].e += fabs(reach) * d[j];
            if (k + 1 < steps) {
                const double next = x[k] * reach - g[k] * last;
                last              = reach;
                reach             = next;
            }
        }
    }
}

static double power(double x, int m)
{
    double product = 1.0;
    for (int i = 0; i < m; i++) {
        product *= x;
    }
    return product;
}

void basis_bound(const rounding *r, const assay_basis *basis, assay_vec3 direction,
                 const double *values, tracked *functions_out)
{
    const place       at   = place_of(r, basis, direction);
    const basis_step *step = basis->step;
    for (int m = 0; m < basis->order; m++) {
        tracked      p[ORDER];
        const double most = at.size + at.error + 8.0 * r->u * at.size;
        /* (|b| + e)^m - |b|^m <= m e (|b| + e)^(m - 1), twice for what is of second order. */
        const double turn  = m > 0 ? 2.0 * m * power(most, m - 1) * (most - at.size) : 0.0;
        const double size  = power(at.size, m);
        const double norms = (4.0 * m + 6.0) * r->u + at.weight;
        const double light =
            basis->kind == ASSAY_BASIS_MAKHOTKIN_SQRT ? sqrt(fmax(direction.z, 0.0)) : 1.0;
        walk(r, step, basis->steps[m], at.t, p);
        for (int k = 0; k < basis->steps[m]; k++) {
            const double scale   = fabs(step[k].scale) * light;
            const double error   = scale * (p[k].e * (size + turn) + fabs(p[k].v) * turn);
            const int    index[] = {step[k].plus, step[k].minus};
            for (int i = 0; i < 2; i++) {
                if (index[i] >= 0) {
                    const double v = values[index[i]];
                    functions_out[index[i]] =
                        tracked_rounded(r, v, error + norms * (fabs(v) + error));
                }
            }
        }
        step += basis->steps[m];
    }
}
