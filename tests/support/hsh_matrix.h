/* hsh_matrix.h - matrices that act on HSH coefficients, for tests. */
#ifndef ASSAY_TESTS_HSH_MATRIX_H
#define ASSAY_TESTS_HSH_MATRIX_H

#include "assay/basis.h"

/* A basis of kind HSH; fails the test on any error. */
assay_basis *hsh_basis(assay_context *context, int order, assay_convention convention);

/* count * count zeros; release with free, as what the next two return. */
double *hsh_matrix(const assay_basis *hsh);
double *hsh_turned(const assay_basis *hsh, assay_context *context,
                   assay_hsh_rotation_options options, double beta);
double *hsh_digon(const assay_basis *hsh, assay_context *context, double beta);

/* Largest difference of two matrices of count * count. */
double hsh_distance(size_t count, const double *a, const double *b);

/* Coefficients of z^k, k < 64. */
void hsh_power(const assay_basis *hsh, int k, double *coefficients_out);

#endif
