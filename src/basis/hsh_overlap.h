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

/* The same many times without an allocation: memory of one thread at a time.  hsh must outlive it.
 * Errors: MEMORY; of the turn none but those of a basis. */
typedef struct assay_hsh_turn_scratch assay_hsh_turn_scratch;
assay_status assay_hsh_turn_scratch_create(assay_context *context, const assay_basis *hsh,
                                           assay_hsh_turn_scratch **scratch_out);
void         assay_hsh_turn_scratch_destroy(assay_hsh_turn_scratch *scratch);
/* M_R(beta), eq. 3.31, 0 < beta <= pi: what assay_hsh_rotation_y gives for ASSAY_HSH_EXACT. */
assay_status assay_hsh_turn_exactly(assay_hsh_turn_scratch *scratch, double beta,
                                    double *matrix_out);

/* From G over half of the region to M_R over all of it: G + S G' S (hsh_rotation.c), in place. */
void assay_hsh_add_mirrored(const assay_basis *hsh, double *matrix);

/* +1 or -1: what function i is multiplied by where x becomes -x. */
double assay_hsh_mirror_sign(const assay_basis *hsh, size_t i);

#endif
