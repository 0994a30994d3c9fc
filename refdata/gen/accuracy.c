/* accuracy.c - coefficients of a lobe in five bases.
 *
 * Invariant: all sums are balls; what a quadrature leaves out is added once, in accuracy_finish.
 *
 * LSOSH.  On the hemisphere SH of one m have a Gram matrix G, and the energy of the best fit is
 * b' G^-1 b, b the integrals of f times them: the same as those of SH, f being 0 below.  With
 * G = L D L' and L y = b it is the sum of y_l^2 / D_l, band by band. */
#include "accuracy.h"

#include <arb_hypgeom.h>
#include <stdlib.h>

#define KINDS 5
static const basis_kind kinds[KINDS] = {BASIS_SH, BASIS_HSH, BASIS_ZERNIKE, BASIS_MAKHOTKIN_SQRT,
                                        BASIS_MAKHOTKIN};
static const int        column_of[KINDS] = {0, 1, 3, 4, 7};

struct accuracy {
    basis  *bases[KINDS];
    acb_ptr values, zeros;
    arb_ptr sums[KINDS];
    arb_t   energy, energy_cosine;
};

accuracy *accuracy_create(slong precision)
{
    accuracy *a = ref_allocate(1, sizeof *a);
    for (int k = 0; k < KINDS; k++) {
        a->bases[k] = basis_create(kinds[k], ACCURACY_ORDER, precision);
        a->sums[k]  = _arb_vec_init(ACCURACY_ORDER * ACCURACY_ORDER);
    }
    a->values = _acb_vec_init(ACCURACY_ORDER * ACCURACY_ORDER);
    a->zeros  = _acb_vec_init(ACCURACY_ORDER);
    arb_init(a->energy);
    arb_init(a->energy_cosine);
    return a;
}

void accuracy_destroy(accuracy *a)
{
    for (int k = 0; k < KINDS; k++) {
        basis_destroy(a->bases[k]);
        _arb_vec_clear(a->sums[k], ACCURACY_ORDER * ACCURACY_ORDER);
    }
    _acb_vec_clear(a->values, ACCURACY_ORDER * ACCURACY_ORDER);
    _acb_vec_clear(a->zeros, ACCURACY_ORDER);
    arb_clear(a->energy);
    arb_clear(a->energy_cosine);
    free(a);
}

/* What functions of kind k are integrated against, or bounded. */
static void values_of(const accuracy *a, int k, acb_srcptr cosines, const acb_t z,
                      const acb_t root_z, slong precision)
{
    basis_values(a->values, a->bases[k], cosines, a->zeros, z, root_z, precision);
    if (kinds[k] == BASIS_MAKHOTKIN) {
        _acb_vec_scalar_mul(a->values, a->values, basis_count(kinds[k], ACCURACY_ORDER), z,
                            precision);
    }
}

void accuracy_add(accuracy *a, acb_srcptr cosines, const acb_t z, const acb_t root_z,
                  const acb_t weight_f, slong precision)
{
    for (int k = 0; k < KINDS; k++) {
        values_of(a, k, cosines, z, root_z, precision);
        for (slong i = 0; i < basis_count(kinds[k], ACCURACY_ORDER); i++) {
            arb_addmul(a->sums[k] + i, acb_realref(a->values + i), acb_realref(weight_f),
                       precision);
        }
    }
}

void accuracy_add_energy(accuracy *a, const arb_t weight_f_squared, const arb_t z, slong precision)
{
    arb_add(a->energy, a->energy, weight_f_squared, precision);
    arb_addmul(a->energy_cosine, weight_f_squared, z, precision);
}

void accuracy_bound(mag_t out, const accuracy *a, acb_srcptr cosines, const acb_t z,
                    const acb_t root_z, slong precision)
{
    mag_t size;
    mag_init(size);
    mag_zero(out);
    for (int k = 0; k < KINDS; k++) {
        values_of(a, k, cosines, z, root_z, precision);
        for (slong i = 0; i < basis_count(kinds[k], ACCURACY_ORDER); i++) {
            acb_get_mag(size, a->values + i);
            mag_max(out, out, size);
        }
    }
    mag_clear(size);
}

/* Adds the squares of band l of basis k; even_only: those with l + m even. */
static void add_band(arb_t sum, const accuracy *a, int k, slong l, int even_only, const arb_t error,
                     slong precision)
{
    arb_t c;
    arb_init(c);
    for (slong m = 0; m <= l; m++) {
        if ((kinds[k] == BASIS_ZERNIKE || even_only) && (l - m) % 2) {
            continue;
        }
        arb_set(c, a->sums[k] + basis_index(kinds[k], l, m));
        arb_add_error(c, error);
        arb_addmul(sum, c, c, precision);
    }
    arb_clear(c);
}

/* Gram matrix of SH with azimuthal number m on the hemisphere, l = m ... ACCURACY_ORDER - 1:
 * products are polynomials of degree 2 ACCURACY_ORDER - 2 at most in z, for which the rule is
 * exact. */
static void gram(arb_ptr g, const basis *sh, slong m, slong precision)
{
    const slong n = ACCURACY_ORDER - m, nodes = ACCURACY_ORDER;
    arb_ptr     p = _arb_vec_init(n);
    acb_t       z, value, derivative;
    arb_t       weight, t;
    acb_init(z);
    acb_init(value);
    acb_init(derivative);
    arb_init(weight);
    arb_init(t);
    _arb_vec_zero(g, n * n);
    for (slong i = 0; i < nodes; i++) {
        arb_hypgeom_legendre_p_ui_root(acb_realref(z), weight, (ulong)nodes, (ulong)i, precision);
        acb_add_si(z, z, 1, precision);
        acb_mul_2exp_si(z, z, -1);
        /* weight / 2, times pi, or 2 pi for m = 0, times (1 - z^2)^m */
        arb_const_pi(t, precision);
        arb_mul(weight, weight, t, precision);
        arb_mul_2exp_si(weight, weight, m ? -1 : 0);
        arb_sqr(t, acb_realref(z), precision);
        arb_sub_si(t, t, 1, precision);
        arb_neg(t, t);
        arb_pow_ui(t, t, (ulong)m, precision);
        arb_mul(weight, weight, t, precision);
        for (slong l = m; l < ACCURACY_ORDER; l++) {
            basis_polynomial(value, derivative, sh, l, m, z, precision);
            arb_set(p + l - m, acb_realref(value));
        }
        for (slong r = 0; r < n; r++) {
            arb_mul(t, p + r, weight, precision);
            for (slong c = 0; c < n; c++) {
                arb_addmul(g + r * n + c, t, p + c, precision);
            }
        }
    }
    _arb_vec_clear(p, n);
    acb_clear(z);
    acb_clear(value);
    acb_clear(derivative);
    arb_clear(weight);
    arb_clear(t);
}

/* bands[l] += y_l^2 / D_l of azimuthal number m. */
static void add_best_fit(arb_ptr bands, const accuracy *a, slong m, const arb_t error,
                         slong precision)
{
    const slong n = ACCURACY_ORDER - m;
    arb_ptr     g = _arb_vec_init(n * n), y = _arb_vec_init(n);
    arb_t       factor, t;
    arb_init(factor);
    arb_init(t);
    gram(g, a->bases[0], m, precision);
    for (slong l = 0; l < n; l++) {
        arb_set(y + l, a->sums[0] + basis_index(BASIS_SH, l + m, m));
        arb_add_error(y + l, error);
    }
    for (slong l = 0; l < n; l++) {
        arb_sqr(t, y + l, precision);
        arb_div(t, t, g + l * n + l, precision);
        arb_add(bands + l + m, bands + l + m, t, precision);
        for (slong r = l + 1; r < n; r++) {
            arb_div(factor, g + r * n + l, g + l * n + l, precision);
            arb_submul(y + r, factor, y + l, precision);
            for (slong c = l + 1; c < n; c++) {
                arb_submul(g + r * n + c, factor, g + l * n + c, precision);
            }
        }
    }
    _arb_vec_clear(g, n * n);
    _arb_vec_clear(y, n);
    arb_clear(factor);
    arb_clear(t);
}

static void finish_best_fit(arb_ptr out, const accuracy *a, const arb_t error, const arb_t energy,
                            slong precision)
{
    arb_ptr bands = _arb_vec_init(ACCURACY_ORDER);
    arb_t   captured;
    arb_init(captured);
    for (slong m = 0; m < ACCURACY_ORDER; m++) {
        add_best_fit(bands, a, m, error, precision);
    }
    for (slong l = 0; l < ACCURACY_ORDER; l++) {
        arb_add(captured, captured, bands + l, precision);
        arb_div(out + ACCURACY_COLUMNS * l + 6, captured, energy, precision);
    }
    _arb_vec_clear(bands, ACCURACY_ORDER);
    arb_clear(captured);
}

void accuracy_finish(arb_ptr out, accuracy *a, const arb_t error, slong precision)
{
    arb_t captured, energy, energy_cosine;
    arb_init(captured);
    arb_init(energy);
    arb_init(energy_cosine);
    arb_set(energy, a->energy);
    arb_add_error(energy, error);
    arb_set(energy_cosine, a->energy_cosine);
    arb_add_error(energy_cosine, error);
    for (int k = 0; k < KINDS; k++) {
        arb_zero(captured);
        for (slong l = 0; l < ACCURACY_ORDER; l++) {
            add_band(captured, a, k, l, 0, error, precision);
            arb_div(out + ACCURACY_COLUMNS * l + column_of[k], captured,
                    kinds[k] == BASIS_MAKHOTKIN ? energy_cosine : energy, precision);
        }
    }
    arb_zero(captured);
    for (slong l = 0; l < ACCURACY_ORDER; l++) {
        add_band(captured, a, 0, l, 1, error, precision);
        arb_div(out + ACCURACY_COLUMNS * l + 2, captured, energy, precision);
        arb_mul_2exp_si(out + ACCURACY_COLUMNS * l + 2, out + ACCURACY_COLUMNS * l + 2, 1);
        arb_set(out + ACCURACY_COLUMNS * l + 5, energy);
        arb_set(out + ACCURACY_COLUMNS * l + 8, energy_cosine);
    }
    finish_best_fit(out, a, error, energy, precision);
    arb_clear(captured);
    arb_clear(energy);
    arb_clear(energy_cosine);
}

void accuracy_write(ref_table *table, double theta, ref_enclosure enclose, void *user)
{
    ref_number numbers[ACCURACY_COUNT];
    ref_round_all(enclose, user, ACCURACY_COUNT, 0, numbers);
    for (slong n = 1; n <= ACCURACY_ORDER; n++) {
        ref_key(table, theta);
        ref_key(table, (double)n);
        for (slong k = 0; k < ACCURACY_COLUMNS; k++) {
            ref_value(table, numbers + ACCURACY_COLUMNS * (n - 1) + k);
        }
        ref_end_row(table);
    }
}
