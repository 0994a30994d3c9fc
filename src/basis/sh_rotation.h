/* sh_rotation.h - SH rotation matrices from half angles. */
#ifndef ASSAY_BASIS_SH_ROTATION_H
#define ASSAY_BASIS_SH_ROTATION_H

#include "assay/basis.h"
#include "basis/euler_zyz.h"

/* D of Rz(alpha) Ry(beta) Rz(gamma) for the functions of a basis of kind SH, LSOSH or HSH (there it
 * is eq. 3.30's matrix): count * count, rows outputs. */
void assay_sh_rotation_of_split(const assay_basis *basis, const assay_euler_zyz *split,
                                double *matrix_out);

#endif
