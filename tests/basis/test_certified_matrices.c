/* test_certified_matrices.c - matrices and rules of the library against refdata/basis.
 *
 * Every entry must be within 1e-13 of the certified one; the worst figures are printed.  That the
 * comparison sees a transposed matrix or a turn the wrong way is checked here, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/basis.h"
#include "assay/context.h"
#include "math/quadrature.h"
#include "support/basis_fixture.h"
#include "support/reference_table.h"

#define TOLERANCE 1e-13

static void report(const char *what, double worst)
{
    printf("#| %-28s worst difference %.2g\n", what, worst);
}

/* Entry of a sparse matrix, 0 where it holds none. */
static double sparse_entry(assay_sparse_view v, size_t row, size_t column)
{
    for (size_t i = v.row_start[row]; i < v.row_start[row + 1]; i++) {
        if (v.column[i] == column) {
            return v.value[i];
        }
    }
    return 0.0;
}

/* Worst difference of C (or of C transposed, to_sh) from a table; swapped: with the bands of rows
 * and columns taken for one another. */
static double judge_conversion(assay_context *context, const char *name, int hsh_order,
                               int sh_order, bool to_sh, bool swapped)
{
    reference_table *table = reference_table_read(name);
    assay_basis     *hsh   = basis_make(context, ASSAY_BASIS_HSH, hsh_order);
    assay_basis     *sh    = basis_make(context, ASSAY_BASIS_SH, sh_order);
    assay_sparse    *c     = NULL;
    double           worst = 0.0;
    assert_int_equal(assay_basis_conversion(context, to_sh ? hsh : sh, to_sh ? sh : hsh, &c),
                     ASSAY_OK);
    const assay_sparse_view view = assay_sparse_entries(c);
    for (size_t i = 0; i < table->rows; i++) {
        const double *key = reference_table_keys(table, i);
        const int     m = (int)key[0], l = (int)key[1 + swapped], k = (int)key[2 - swapped];
        const size_t  row = (size_t)(l * l + l + m), column = (size_t)(k * k + k + m);
        const double  entry =
            to_sh ? sparse_entry(view, column, row) : sparse_entry(view, row, column);
        worst = fmax(worst, fabs(entry - reference_table_values(table, i)[0]));
    }
    assay_sparse_destroy(c);
    assay_basis_destroy(hsh);
    assay_basis_destroy(sh);
    reference_table_free(table);
    return worst;
}

static void conversion_is_right(void **state)
{
    const double there = judge_conversion(*state, "conversion", 10, 16, false, false);
    const double back  = judge_conversion(*state, "conversion", 10, 16, true, false);
    const double large = judge_conversion(*state, "conversion_bands", 33, 33, false, false);
    report("C, order 10 from order 16", there);
    report("C transposed", back);
    report("C, order 33", large);
    assert_true(judge_conversion(*state, "conversion_bands", 33, 33, false, true) > 0.1);
    assert_true(there <= TOLERANCE && back <= TOLERANCE && large <= TOLERANCE);
}

/* What the library gives for an angle. */
typedef assay_status (*matrix_of)(const assay_basis *, assay_context *, double, double *);

static assay_status exact_rotation(const assay_basis *hsh, assay_context *context, double beta,
                                   double *matrix)
{
    const assay_hsh_rotation_options options = {.way = ASSAY_HSH_EXACT};
    return assay_hsh_rotation_y(hsh, context, &options, beta, matrix);
}

static assay_status wrong_rotation(const assay_basis *hsh, assay_context *context, double beta,
                                   double *matrix)
{
    return exact_rotation(hsh, context, -beta, matrix);
}

static double judge_angles(assay_context *context, const char *name, int order, matrix_of make)
{
    reference_table *table  = reference_table_read(name);
    assay_basis     *hsh    = basis_make(context, ASSAY_BASIS_HSH, order);
    const size_t     n      = (size_t)(order * order);
    double          *matrix = malloc(n * n * sizeof *matrix), worst = 0.0;
    assert_non_null(matrix);
    for (size_t i = 0; i < table->rows; i++) {
        const double *key      = reference_table_keys(table, i);
        const double *expected = reference_table_values(table, i);
        if (key[1] == 0.0) {
            assert_int_equal(make(hsh, context, key[0], matrix), ASSAY_OK);
        }
        for (size_t j = 0; j < n; j++) {
            worst = fmax(worst, fabs(matrix[(size_t)key[1] * n + j] - expected[j]));
        }
    }
    free(matrix);
    assay_basis_destroy(hsh);
    reference_table_free(table);
    return worst;
}

static void digon_is_right(void **state)
{
    const double small = judge_angles(*state, "digon_order6", 6, assay_hsh_digon);
    const double large = judge_angles(*state, "digon_order10", 10, assay_hsh_digon);
    report("digon M, order 6", small);
    report("digon M, order 10", large);
    assert_true(small <= TOLERANCE && large <= TOLERANCE);
}

static void hsh_rotation_is_right(void **state)
{
    const double small = judge_angles(*state, "hsh_rotation_order6", 6, exact_rotation);
    const double large = judge_angles(*state, "hsh_rotation_order10", 10, exact_rotation);
    report("M_R, order 6", small);
    report("M_R, order 10", large);
    assert_true(small <= TOLERANCE && large <= TOLERANCE);
    assert_true(judge_angles(*state, "hsh_rotation_order10", 10, wrong_rotation) > 0.1);
}

/* transposed: how far D transposed is. */
static double judge_band(assay_context *context, int l, bool transposed)
{
    char name[32];
    snprintf(name, sizeof name, "sh_rotation_%02d", l);
    reference_table *table = reference_table_read(name);
    assay_basis     *sh    = basis_make(context, ASSAY_BASIS_SH, l + 1);
    const size_t     n = assay_basis_count(sh), first = (size_t)(l * l);
    double          *matrix = malloc(n * n * sizeof *matrix), worst = 0.0;
    assert_non_null(matrix);
    for (size_t i = 0; i < table->rows; i++) {
        const double *key      = reference_table_keys(table, i);
        const double *expected = reference_table_values(table, i);
        const size_t  row      = first + (size_t)((int)key[3] + l);
        if (row == first) {
            double rotation[9];
            assay_rotation_from_euler_zyz(key[0], key[1], key[2], rotation);
            assert_int_equal(assay_sh_rotation(sh, rotation, matrix), ASSAY_OK);
        }
        for (size_t j = 0; j < 2 * (size_t)l + 1; j++) {
            const size_t column = first + j;
            const double entry  = transposed ? matrix[column * n + row] : matrix[row * n + column];
            worst               = fmax(worst, fabs(entry - expected[j]));
        }
    }
    free(matrix);
    assay_basis_destroy(sh);
    reference_table_free(table);
    return worst;
}

static void sh_rotation_is_right(void **state)
{
    static const int bands[] = {1, 2, 5, 10, 16, 32};
    for (int i = 0; i < 6; i++) {
        char         what[32];
        const double worst = judge_band(*state, bands[i], false);
        snprintf(what, sizeof what, "D, l = %d", bands[i]);
        report(what, worst);
        assert_true(worst <= TOLERANCE);
    }
    assert_true(judge_band(*state, 5, true) > 0.1);
}

static void gauss_legendre_is_right(void **state)
{
    reference_table *table = reference_table_read("gauss_legendre");
    double           nodes[64], weights[64], worst_node = 0.0, worst_weight = 0.0;
    for (size_t i = 0; i < table->rows; i++) {
        const double *key      = reference_table_keys(table, i);
        const double *expected = reference_table_values(table, i);
        const int     k        = (int)key[1];
        if (k == 0) {
            assay_gauss_legendre((int)key[0], nodes, weights);
        }
        worst_node   = fmax(worst_node, fabs(nodes[k] - expected[0]));
        worst_weight = fmax(worst_weight, fabs(weights[k] / expected[2] - 1.0));
    }
    report("Gauss-Legendre nodes", worst_node);
    report("Gauss-Legendre weights, rel.", worst_weight);
    assert_true(worst_node <= 0x1p-53 && worst_weight <= 0x1p-51);
    reference_table_free(table);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conversion_is_right),     cmocka_unit_test(digon_is_right),
        cmocka_unit_test(hsh_rotation_is_right),   cmocka_unit_test(sh_rotation_is_right),
        cmocka_unit_test(gauss_legendre_is_right),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
