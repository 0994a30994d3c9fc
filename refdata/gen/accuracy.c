/* accuracy.c - coefficients of a lobe in four bases.
 *
 * Invariant: all sums are balls; what a quadrature leaves out is added once, in accuracy_finish. */
#include "accuracy.h"

#include <stdlib.h>

#define KINDS 4
static const basis_kind kinds[KINDS] = {BASIS_SH, BASIS_HSH, BASIS_ZERNIKE, BASIS_MAKHOTKIN_SQRT};
static const int        column_of[KINDS] = {0, 1, 3, 4};

struct accuracy {
    basis  *bases[KINDS];
    acb_ptr values, zeros;
    arb_ptr sums[KINDS];
    arb_t   energy;
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
    free(a);
}

void accuracy_add(accuracy *a, acb_srcptr cosines, const acb_t z, const acb_t root_z,
                  const acb_t weight_f, slong precision)
{
    for (int k = 0; k < KINDS; k++) {
        basis_values(a->values, a->bases[k], cosines, a->zeros, z, root_z, precision);
        for (slong i = 0; i < basis_count(kinds[k], ACCURACY_ORDER); i++) {
            arb_addmul(a->sums[k] + i, acb_realref(a->values + i), acb_realref(weight_f),
                       precision);
        }
    }
}

void accuracy_add_energy(accuracy *a, const arb_t weight_f_squared, slong precision)
{
    arb_add(a->energy, a->energy, weight_f_squared, precision);
}

void accuracy_bound(mag_t out, const accuracy *a, acb_srcptr cosines, const acb_t z,
                    const acb_t root_z, slong precision)
{
    mag_t size;
    mag_init(size);
    mag_zero(out);
    for (int k = 0; k < KINDS; k++) {
        basis_values(a->values, a->bases[k], cosines, a->zeros, z, root_z, precision);
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

void accuracy_finish(arb_ptr out, accuracy *a, const arb_t error, slong precision)
{
    arb_t captured, energy;
    arb_init(captured);
    arb_init(energy);
    arb_set(energy, a->energy);
    arb_add_error(energy, error);
    for (int k = 0; k < KINDS; k++) {
        arb_zero(captured);
        for (slong l = 0; l < ACCURACY_ORDER; l++) {
            add_band(captured, a, k, l, 0, error, precision);
            arb_div(out + ACCURACY_COLUMNS * l + column_of[k], captured, energy, precision);
        }
    }
    arb_zero(captured);
    for (slong l = 0; l < ACCURACY_ORDER; l++) {
        add_band(captured, a, 0, l, 1, error, precision);
        arb_div(out + ACCURACY_COLUMNS * l + 2, captured, energy, precision);
        arb_mul_2exp_si(out + ACCURACY_COLUMNS * l + 2, out + ACCURACY_COLUMNS * l + 2, 1);
        arb_set(out + ACCURACY_COLUMNS * l + 5, energy);
    }
    arb_clear(captured);
    arb_clear(energy);
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
