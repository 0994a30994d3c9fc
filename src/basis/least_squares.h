/* least_squares.h - the best fit by SH on the hemisphere [sloan03]. */
#ifndef ASSAY_BASIS_LEAST_SQUARES_H
#define ASSAY_BASIS_LEAST_SQUARES_H

#include "assay/basis.h"

/* Condition number up to which coefficients are given: they then keep 6 digits at least. */
#define ASSAY_LEAST_SQUARES_CONDITION 1e10

typedef struct assay_least_squares assay_least_squares;

/* basis: LSOSH.  solve: refuse an order whose coefficients would have no digits left.
 * Errors: DOMAIN, MEMORY. */
assay_status assay_least_squares_create(assay_context *context, const assay_basis *basis,
                                        bool solve, assay_least_squares **fit_out);
void         assay_least_squares_destroy(assay_least_squares *fit);

/* Functions that are orthonormal over the hemisphere and span what SH of the same order span:
 * number l*l + l + m has azimuthal number m, and those of l < n span the SH of l < n. */
void assay_least_squares_evaluate(const assay_least_squares *fit, assay_vec3 direction,
                                  double *values_out);

/* From coefficients in those functions to coefficients in SH, in place. */
void assay_least_squares_solve(const assay_least_squares *fit, double *coefficients);

/* The largest condition number (1-norm) among the azimuthal numbers. */
double assay_least_squares_condition(const assay_least_squares *fit);

#endif
