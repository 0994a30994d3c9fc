/* bases.c - explicit sums.
 *
 * Invariant: nothing is rounded but by ball operations, so that each result encloses the values at
 * all points of its arguments.
 *
 *     P_k^(a,b)(X) = sum_s C(k + a, k - s) C(k + b, s) (c - 1)^s c^(k - s),   c = (X + 1) / 2
 *     d^m P_l / dX^m = (l + m)! / (2^m l!) P_{l-m}^(m,m)                          [dlmf] 18 */
#include "bases.h"

#include <flint/fmpz.h>
#include <flint/fmpz_vec.h>
#include <stdlib.h>

#include "ref.h"

typedef struct {
    slong a, b, k;
    fmpz *coefficients; /* k + 1 */
} jacobi;

struct basis {
    basis_kind kind;
    slong      order;
    arb_ptr    norms;       /* of (l, m), order * l + m */
    jacobi    *polynomials; /* the same                 */
};

slong basis_band_step(basis_kind kind) { return kind == BASIS_ZERNIKE ? 2 : 1; }

slong basis_count(basis_kind kind, slong order)
{
    return kind == BASIS_ZERNIKE ? order * (order + 1) / 2 : order * order;
}

slong basis_index(basis_kind kind, slong l, slong m)
{
    return kind == BASIS_ZERNIKE ? l * (l + 1) / 2 + (l + m) / 2 : l * l + l + m;
}

static void jacobi_set(jacobi *p, slong a, slong b, slong k)
{
    fmpz_t other;
    fmpz_init(other);
    *p = (jacobi){a, b, k, _fmpz_vec_init(k + 1)};
    for (slong s = 0; s <= k; s++) {
        fmpz_bin_uiui(p->coefficients + s, (ulong)(k + a), (ulong)(k - s));
        fmpz_bin_uiui(other, (ulong)(k + b), (ulong)s);
        fmpz_mul(p->coefficients + s, p->coefficients + s, other);
    }
    fmpz_clear(other);
}

/* From powers of c and of c - 1. */
static void jacobi_value(acb_t out, const jacobi *p, acb_srcptr c, acb_srcptr d, slong precision)
{
    acb_t term;
    acb_init(term);
    acb_zero(out);
    for (slong s = 0; s <= p->k; s++) {
        acb_mul(term, d + s, c + p->k - s, precision);
        acb_addmul_fmpz(out, term, p->coefficients + s, precision);
    }
    acb_clear(term);
}

/* N^2 = q / pi with a rational q. */
static void norm_squared(fmpq_t q, basis_kind kind, slong l, slong m)
{
    fmpz_t n, d, f;
    fmpz_init(n);
    fmpz_init(d);
    fmpz_init(f);
    if (kind == BASIS_ZERNIKE) {
        fmpz_set_si(n, l + 1);
        fmpz_set_si(d, 1);
    } else if (kind == BASIS_SH || kind == BASIS_HSH) {
        /* (2l + 1) (l - m)! (l + m)! / l!^2, by 2 for SH and 1 for HSH, 4^m of SH */
        fmpz_fac_ui(n, (ulong)(l - m));
        fmpz_fac_ui(f, (ulong)(l + m));
        fmpz_mul(n, n, f);
        fmpz_mul_si(n, n, 2 * l + 1);
        fmpz_fac_ui(f, (ulong)l);
        fmpz_mul(d, f, f);
        if (kind == BASIS_SH) {
            fmpz_mul_2exp(d, d, (ulong)(2 * m + 1));
        }
    } else {
        /* (2l + 2) (l - m)! (l + m + 1)! / (l! (l + 1)!) */
        fmpz_fac_ui(n, (ulong)(l - m));
        fmpz_fac_ui(f, (ulong)(l + m + 1));
        fmpz_mul(n, n, f);
        fmpz_mul_si(n, n, 2 * l + 2);
        fmpz_fac_ui(d, (ulong)l);
        fmpz_fac_ui(f, (ulong)(l + 1));
        fmpz_mul(d, d, f);
    }
    if (m == 0) {
        fmpz_mul_2exp(d, d, 1);
    }
    fmpq_set_fmpz_frac(q, n, d);
    fmpz_clear(n);
    fmpz_clear(d);
    fmpz_clear(f);
}

basis *basis_create(basis_kind kind, slong order, slong precision)
{
    basis *b       = ref_allocate(1, sizeof *b);
    b->kind        = kind;
    b->order       = order;
    b->norms       = _arb_vec_init(order * order);
    b->polynomials = ref_allocate((size_t)(order * order), sizeof *b->polynomials);

    fmpq_t q;
    arb_t  pi;
    fmpq_init(q);
    arb_init(pi);
    arb_const_pi(pi, precision);
    for (slong m = 0; m < order; m++) {
        for (slong l = m; l < order; l += basis_band_step(kind)) {
            jacobi *p    = b->polynomials + order * l + m;
            arb_ptr norm = b->norms + order * l + m;
            if (kind == BASIS_ZERNIKE) {
                jacobi_set(p, 0, m, (l - m) / 2);
            } else if (kind == BASIS_SH || kind == BASIS_HSH) {
                jacobi_set(p, m, m, l - m);
            } else {
                jacobi_set(p, m, m + 1, l - m);
            }
            norm_squared(q, kind, l, m);
            arb_set_fmpq(norm, q, precision);
            arb_div(norm, norm, pi, precision);
            arb_sqrt(norm, norm, precision);
            if (m % 2 && (kind == BASIS_SH || kind == BASIS_HSH)) {
                arb_neg(norm, norm);
            }
        }
    }
    fmpq_clear(q);
    arb_clear(pi);
    return b;
}

void basis_destroy(basis *b)
{
    for (slong i = 0; i < b->order * b->order; i++) {
        if (b->polynomials[i].coefficients) {
            _fmpz_vec_clear(b->polynomials[i].coefficients, b->polynomials[i].k + 1);
        }
    }
    _arb_vec_clear(b->norms, b->order * b->order);
    free(b->polynomials);
    free(b);
}

void basis_azimuth(acb_ptr cosines, acb_ptr sines, slong order, const acb_t x, const acb_t y,
                   slong precision)
{
    acb_t t;
    acb_init(t);
    acb_one(cosines);
    acb_zero(sines);
    for (slong m = 1; m < order; m++) {
        acb_mul(cosines + m, cosines + m - 1, x, precision);
        acb_mul(t, sines + m - 1, y, precision);
        acb_sub(cosines + m, cosines + m, t, precision);
        acb_mul(sines + m, sines + m - 1, x, precision);
        acb_mul(t, cosines + m - 1, y, precision);
        acb_add(sines + m, sines + m, t, precision);
    }
    acb_clear(t);
}

/* Powers 0 ... order of c and c - 1, the polynomial's argument in the form of the sum. */
static void argument_powers(acb_ptr c, acb_ptr d, const basis *b, const acb_t z, slong precision)
{
    acb_t argument;
    acb_init(argument);
    if (b->kind == BASIS_SH) {
        acb_add_si(argument, z, 1, precision);
        acb_mul_2exp_si(argument, argument, -1);
    } else if (b->kind == BASIS_ZERNIKE) {
        acb_sub_si(argument, z, 1, precision);
        acb_neg(argument, argument);
    } else {
        acb_set(argument, z);
    }
    _acb_vec_set_powers(c, argument, b->order + 1, precision);
    acb_sub_si(argument, argument, 1, precision);
    _acb_vec_set_powers(d, argument, b->order + 1, precision);
    acb_clear(argument);
}

/* f for every m: powers of sqrt(z / (1 + z)) (HSH, Makhotkin), of 1 / sqrt(1 + z) (Zernike). */
static void azimuthal_factors(acb_ptr f, const basis *b, const acb_t z, const acb_t root_z,
                              slong precision)
{
    acb_t base;
    acb_init(base);
    if (b->kind == BASIS_SH) {
        acb_one(base);
    } else {
        acb_add_si(base, z, 1, precision);
        acb_rsqrt_analytic(base, base, 1, precision);
        if (b->kind != BASIS_ZERNIKE) {
            acb_mul(base, base, root_z, precision);
        }
    }
    _acb_vec_set_powers(f, base, b->order, precision);
    if (b->kind == BASIS_MAKHOTKIN_SQRT) {
        _acb_vec_scalar_mul(f, f, b->order, root_z, precision);
    }
    acb_clear(base);
}

void basis_values(acb_ptr out, const basis *b, acb_srcptr cosines, acb_srcptr sines, const acb_t z,
                  const acb_t root_z, slong precision)
{
    acb_ptr c = _acb_vec_init(b->order + 1), d = _acb_vec_init(b->order + 1);
    acb_ptr f = _acb_vec_init(b->order);
    acb_t   t;
    acb_init(t);
    argument_powers(c, d, b, z, precision);
    azimuthal_factors(f, b, z, root_z, precision);
    for (slong m = 0; m < b->order; m++) {
        for (slong l = m; l < b->order; l += basis_band_step(b->kind)) {
            jacobi_value(t, b->polynomials + b->order * l + m, c, d, precision);
            acb_mul_arb(t, t, b->norms + b->order * l + m, precision);
            acb_mul(t, t, f + m, precision);
            acb_mul(out + basis_index(b->kind, l, m), t, cosines + m, precision);
            if (m) {
                acb_mul(out + basis_index(b->kind, l, -m), t, sines + m, precision);
            }
        }
    }
    acb_clear(t);
    _acb_vec_clear(c, b->order + 1);
    _acb_vec_clear(d, b->order + 1);
    _acb_vec_clear(f, b->order);
}

/* d/dX P_k^(a,b) = (k + a + b + 1) / 2 P_{k-1}^(a+1,b+1); X = z for SH, 2z - 1 for HSH. */
void basis_polynomial(acb_t value, acb_t derivative, const basis *b, slong l, slong m,
                      const acb_t z, slong precision)
{
    const jacobi *p = b->polynomials + b->order * l + m;
    acb_ptr       c = _acb_vec_init(b->order + 1), d = _acb_vec_init(b->order + 1);
    argument_powers(c, d, b, z, precision);
    jacobi_value(value, p, c, d, precision);
    acb_zero(derivative);
    if (p->k) {
        jacobi lower;
        jacobi_set(&lower, p->a + 1, p->b + 1, p->k - 1);
        jacobi_value(derivative, &lower, c, d, precision);
        acb_mul_si(derivative, derivative, p->k + p->a + p->b + 1, precision);
        if (b->kind == BASIS_SH) {
            acb_mul_2exp_si(derivative, derivative, -1);
        }
        _fmpz_vec_clear(lower.coefficients, lower.k + 1);
    }
    acb_mul_arb(value, value, b->norms + b->order * l + m, precision);
    acb_mul_arb(derivative, derivative, b->norms + b->order * l + m, precision);
    _acb_vec_clear(c, b->order + 1);
    _acb_vec_clear(d, b->order + 1);
}
