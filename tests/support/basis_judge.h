/* basis_judge.h - values of basis functions by another way and in twice the digits.
 *
 * The direction is divided by its length, the polynomials come from the textbook's recurrences (no
 * scaling, no parts), the norms from factorials, everything in pairs of doubles: some 30 digits,
 * less a few for the recurrence. */
#ifndef ASSAY_TESTS_BASIS_JUDGE_H
#define ASSAY_TESTS_BASIS_JUDGE_H

#include "assay/basis.h"

/* A value is hi + lo. */
typedef struct {
    double hi, lo;
} judged;

/* All functions of a basis at d / |d|; count of the basis. */
void basis_judge(const assay_basis *basis, assay_vec3 d, judged *values_out);

/* |value - truth|. */
double basis_judge_error(double value, judged truth);

#endif
