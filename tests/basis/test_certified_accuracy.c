/* test_certified_accuracy.c - accuracies of the library [gautron06] eq. 3.32 against refdata/basis.
 *
 * The lobes are those of the tables; every share of energy must be within 1e-13 of the certified
 * one.  The worst figures are printed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "assay/basis.h"
#include "assay/context.h"
#include "support/basis_fixture.h"
#include "support/reference_table.h"

#define TOLERANCE 1e-13

/* Columns of the tables. */
static const struct {
    assay_basis_kind kind;
    int              column;
} bases[] = {{ASSAY_BASIS_SH, 0},
             {ASSAY_BASIS_HSH, 1},
             {ASSAY_BASIS_ESH, 2},
             {ASSAY_BASIS_ZERNIKE, 3},
             {ASSAY_BASIS_MAKHOTKIN_SQRT, 4},
             {ASSAY_BASIS_LSOSH, 6},
             {ASSAY_BASIS_MAKHOTKIN, 7}};

static void judge(assay_context *context, const char *name, assay_lobe lobe)
{
    reference_table *table = reference_table_read(name);
    for (size_t k = 0; k < sizeof bases / sizeof bases[0]; k++) {
        const assay_basis_kind kind  = bases[k].kind;
        assay_basis           *basis = NULL;
        double                 accuracy[10], worst = 0.0;
        assert_int_equal(assay_basis_create(context, kind, 10, ASSAY_CONVENTION_THESIS, &basis),
                         ASSAY_OK);
        for (size_t row = 0; row < table->rows; row++) {
            const double *key   = reference_table_keys(table, row);
            const int     order = (int)key[1];
            if (order == 1) {
                lobe.theta_out = key[0];
                assert_int_equal(assay_basis_accuracy(basis, context, &lobe, accuracy, NULL),
                                 ASSAY_OK);
            }
            worst = fmax(worst, fabs(accuracy[order - 1] -
                                     reference_table_values(table, row)[bases[k].column]));
        }
        printf("#| %-15s %-15s worst difference %.2g\n", name, assay_basis_kind_name(kind), worst);
        assert_true(worst <= TOLERANCE);
        assay_basis_destroy(basis);
    }
    reference_table_free(table);
}

static void phong_is_right(void **state)
{
    judge(*state, "accuracy_phong", (assay_lobe){.kind = ASSAY_LOBE_PHONG, .exponent = 5.0});
}

static void ward_is_right(void **state)
{
    judge(*state, "accuracy_ward",
          (assay_lobe){.kind = ASSAY_LOBE_WARD, .alpha_x = 0.2, .alpha_y = 0.5});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phong_is_right),
        cmocka_unit_test(ward_is_right),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
