/* test_certified_values.c - values and gradients of the library against refdata/basis.
 *
 * Errors are in units of the last place of a scale: the largest value that a function of the band
 * can take, sqrt((2l + 1) / 4 pi) for SH, sqrt((2l + 1) / 2 pi) for HSH; for the others the largest
 * number of the row.  Gradients: relative to the largest component of the band at the direction.
 * The worst figures are printed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/basis.h"
#include "assay/context.h"
#include "support/basis_fixture.h"
#include "support/reference_table.h"

#define PI 3.14159265358979323846

static double last_place(double scale)
{
    int exponent;
    frexp(scale, &exponent);
    return ldexp(1.0, exponent - DBL_MANT_DIG);
}

typedef struct {
    double units;
    int    l, m;
    size_t row;
} worst;

static void note(worst *w, double units, int l, int m, size_t row)
{
    if (!(units <= w->units)) {
        *w = (worst){units, l, m, row};
    }
}

static void report(const char *what, const worst *w)
{
    printf("#| %-28s worst %.2f units of the last place, at l %d m %d, row %zu\n", what, w->units,
           w->l, w->m, w->row);
}

static assay_vec3 direction_of(const double *keys)
{
    return (assay_vec3){keys[0], keys[1], keys[2]};
}

/* The library's values at every row; bands l <= 16 into low, all into high. */
static void judge_harmonics(assay_context *context, assay_basis_kind kind, const char *name,
                            worst *low, worst *high)
{
    reference_table *table = reference_table_read(name);
    assay_basis     *basis = basis_make(context, kind, 33);
    double           values[33 * 33];
    assert_int_equal(table->columns - table->keys, assay_basis_count(basis));
    for (size_t row = 0; row < table->rows; row++) {
        const double *expected = reference_table_values(table, row);
        assert_int_equal(
            assay_basis_evaluate(basis, direction_of(reference_table_keys(table, row)), values),
            ASSAY_OK);
        for (size_t i = 0; i < assay_basis_count(basis); i++) {
            int l, m;
            assay_basis_function(basis, i, &l, &m);
            const double area  = kind == ASSAY_BASIS_SH ? 4 * PI : 2 * PI;
            const double unit  = last_place(sqrt((2 * l + 1) / area));
            const double units = fabs(values[i] - expected[i]) / unit;
            note(l <= 16 ? low : high, units, l, m, row);
        }
    }
    assay_basis_destroy(basis);
    reference_table_free(table);
}

static void sh_is_right(void **state)
{
    worst low = {0}, high = {0};
    judge_harmonics(*state, ASSAY_BASIS_SH, "sh_values", &low, &high);
    report("SH, l <= 16", &low);
    report("SH, 16 < l <= 32", &high);
    assert_true(low.units <= 4.0);
    assert_true(high.units <= 4.0);
}

static void hsh_is_right(void **state)
{
    worst low = {0}, high = {0};
    judge_harmonics(*state, ASSAY_BASIS_HSH, "hsh_values", &low, &high);
    report("HSH, l <= 16", &low);
    report("HSH, 16 < l <= 32", &high);
    assert_true(low.units <= 4.0);
    assert_true(high.units <= 4.0);
}

/* Scale: the row's largest number. */
static void judge_rows(assay_context *context, assay_basis_kind kind, const char *name, worst *w)
{
    reference_table *table = reference_table_read(name);
    assay_basis     *basis = basis_make(context, kind, 17);
    double           values[17 * 17];
    assert_int_equal(table->columns - table->keys, assay_basis_count(basis));
    for (size_t row = 0; row < table->rows; row++) {
        const double *expected = reference_table_values(table, row);
        double        scale    = 0.0;
        for (size_t i = 0; i < assay_basis_count(basis); i++) {
            scale = fmax(scale, fabs(expected[i]));
        }
        assert_int_equal(
            assay_basis_evaluate(basis, direction_of(reference_table_keys(table, row)), values),
            ASSAY_OK);
        for (size_t i = 0; i < assay_basis_count(basis); i++) {
            int l, m;
            assay_basis_function(basis, i, &l, &m);
            const double miss = fabs(values[i] - expected[i]);
            note(w, miss > 0.0 ? miss / last_place(scale) : 0.0, l, m, row);
        }
    }
    assay_basis_destroy(basis);
    reference_table_free(table);
}

static void zernike_is_right(void **state)
{
    worst w = {0};
    judge_rows(*state, ASSAY_BASIS_ZERNIKE, "zernike_values", &w);
    report("Zernike, degree <= 16", &w);
    assert_true(w.units <= 4.0);
}

static void makhotkin_is_right(void **state)
{
    worst w = {0}, root = {0};
    judge_rows(*state, ASSAY_BASIS_MAKHOTKIN, "makhotkin_values", &w);
    judge_rows(*state, ASSAY_BASIS_MAKHOTKIN_SQRT, "makhotkin_sqrt_values", &root);
    report("Makhotkin, l <= 16", &w);
    report("Makhotkin sqrt, l <= 16", &root);
    assert_true(w.units <= 4.0);
    assert_true(root.units <= 4.0);
}

/* Rows come in threes, one for each component; scale: the longest gradient of the band. */
static void judge_gradients(assay_context *context, assay_basis_kind kind, const char *name,
                            worst *w)
{
    reference_table *table = reference_table_read(name);
    assay_basis     *basis = basis_make(context, kind, 17);
    double           values[17 * 17];
    assay_vec3       gradients[17 * 17];
    for (size_t row = 0; row < table->rows; row += 3) {
        assert_int_equal(assay_basis_gradient(basis, direction_of(reference_table_keys(table, row)),
                                              values, gradients),
                         ASSAY_OK);
        const double *expected[3] = {reference_table_values(table, row),
                                     reference_table_values(table, row + 1),
                                     reference_table_values(table, row + 2)};
        for (int l = 1; l < 17; l++) {
            double scale = 0.0;
            for (int i = l * l; i < (l + 1) * (l + 1); i++) {
                for (int k = 0; k < 3; k++) {
                    scale = fmax(scale, fabs(expected[k][i]));
                }
            }
            for (int i = l * l; i < (l + 1) * (l + 1); i++) {
                const double miss = fmax(fabs(gradients[i].x - expected[0][i]),
                                         fmax(fabs(gradients[i].y - expected[1][i]),
                                              fabs(gradients[i].z - expected[2][i])));
                note(w, miss / scale, l, i - l * l - l, row);
            }
        }
    }
    assay_basis_destroy(basis);
    reference_table_free(table);
}

static void gradients_are_right(void **state)
{
    worst sh = {0}, hsh = {0};
    judge_gradients(*state, ASSAY_BASIS_SH, "sh_gradients", &sh);
    judge_gradients(*state, ASSAY_BASIS_HSH, "hsh_gradients", &hsh);
    printf("#| %-28s worst %.2g of the band, at l %d m %d, row %zu\n", "SH gradients, l <= 16",
           sh.units, sh.l, sh.m, sh.row);
    printf("#| %-28s worst %.2g of the band, at l %d m %d, row %zu\n", "HSH gradients, l <= 16",
           hsh.units, hsh.l, hsh.m, hsh.row);
    assert_true(sh.units <= 1e-13);
    assert_true(hsh.units <= 1e-13);
}

static void clamped_cosine_is_right(void **state)
{
    reference_table *table = reference_table_read("clamped_cosine");
    double           a[33];
    worst            w = {0};
    assert_int_equal(assay_clamped_cosine(33, a), ASSAY_OK);
    for (size_t l = 0; l < table->rows; l++) {
        const double expected = reference_table_values(table, l)[0];
        const double miss     = fabs(a[l] - expected);
        note(&w, miss > 0.0 ? miss / last_place(expected) : 0.0, (int)l, 0, l);
    }
    report("A_l, l <= 32", &w);
    assert_true(w.units <= 2.0);
    reference_table_free(table);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sh_is_right),         cmocka_unit_test(hsh_is_right),
        cmocka_unit_test(zernike_is_right),    cmocka_unit_test(makhotkin_is_right),
        cmocka_unit_test(gradients_are_right), cmocka_unit_test(clamped_cosine_is_right),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
