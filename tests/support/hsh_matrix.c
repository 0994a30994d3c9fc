/* hsh_matrix.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/numerics.h"
#include "hsh_matrix.h"
#include "math/quadrature.h"

assay_basis *hsh_basis(assay_context *context, int order, assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_HSH, order, convention, &basis),
                     ASSAY_OK);
    return basis;
}

double *hsh_matrix(const assay_basis *hsh)
{
    double *matrix = calloc(assay_basis_count(hsh) * assay_basis_count(hsh), sizeof *matrix);
    assert_non_null(matrix);
    return matrix;
}

double *hsh_turned(const assay_basis *hsh, assay_context *context,
                   assay_hsh_rotation_options options, double beta)
{
    double *matrix = hsh_matrix(hsh);
    assert_int_equal(assay_hsh_rotation_y(hsh, context, &options, beta, matrix), ASSAY_OK);
    return matrix;
}

double *hsh_digon(const assay_basis *hsh, assay_context *context, double beta)
{
    double *matrix = hsh_matrix(hsh);
    assert_int_equal(assay_hsh_digon(hsh, context, beta, matrix), ASSAY_OK);
    return matrix;
}

double hsh_distance(size_t count, const double *a, const double *b)
{
    double worst = 0.0;
    for (size_t i = 0; i < count * count; i++) {
        worst = fmax(worst, fabs(a[i] - b[i]));
    }
    return worst;
}

/* Coefficients of z^k. */
void hsh_power(const assay_basis *hsh, int k, double *coefficients_out)
{
    double node[64], weight[64], values[1089];
    memset(coefficients_out, 0, assay_basis_count(hsh) * sizeof *coefficients_out);
    assay_gauss_legendre_on(0.0, 1.0, 64, node, weight);
    for (int q = 0; q < 64; q++) {
        const double z = node[q];
        assert_int_equal(assay_basis_evaluate(hsh, (assay_vec3){sqrt(1.0 - z * z), 0.0, z}, values),
                         ASSAY_OK);
        for (int l = 0; l < assay_basis_order(hsh); l++) {
            const int i = l * l + l;
            coefficients_out[i] += ASSAY_TWO_PI * weight[q] * pow(z, k) * values[i];
        }
    }
}
