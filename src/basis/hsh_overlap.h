/* hsh_overlap.h - integrals of products of two HSH over a part of the hemisphere. */
#ifndef ASSAY_BASIS_HSH_OVERLAP_H
#define ASSAY_BASIS_HSH_OVERLAP_H

#include "assay/basis.h"

/* G_ij = integral of H_i(w) H_j(Ry(-turn) w) over the directions w whose angle to the horizon's
 * half at +x, measured about the y axis, lies in [0, width]: w = (cos psi cos d, sin psi,
 * cos psi sin d), 0 <= d <= width.  turn >= 0, width >= 0, turn + width <= pi.
 * matrix_out: count * count.  Errors: MEMORY. */
assay_status assay_hsh_overlap(const assay_basis *hsh, assay_context *context, double turn,
                               double width, double *matrix_out);

/* +1 or -1: what function i is multiplied by where x becomes -x. */
double assay_hsh_mirror_sign(const assay_basis *hsh, size_t i);

#endif
