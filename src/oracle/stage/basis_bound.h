/* basis_bound.h - how far the functions of a basis may be off that are computed with less
 * precision.
 */
#ifndef ASSAY_ORACLE_BASIS_BOUND_H
#define ASSAY_ORACLE_BASIS_BOUND_H

#include "assay/basis.h"
#include "oracle/stage/tracked.h"

/* False for kinds that are not analysed: Makhotkin under its weight, and least squares. */
bool basis_bound_known(assay_basis_kind kind);

/* values: as assay_basis_evaluate gives them at the direction; all functions with their bounds. */
void basis_bound(const rounding *r, const assay_basis *basis, assay_vec3 direction,
                 const double *values, tracked *functions_out);

/* The parameters of stages that take a basis. */
/* clang-format off */
#define STAGE_BASIS_KINDS "sh|hsh|zernike|makhotkin|makhotkin-sqrt|esh|lsosh"
#define STAGE_CONVENTIONS "thesis|plain|kontkanen"
/* clang-format on */

#endif
