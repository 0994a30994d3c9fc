/* basis_kernel_pair.c - two directions: what every x86-64 and aarch64 has vectors for. */
#include "basis/basis_data.h"

enum { LANES = BASIS_PAIR };
#include "basis/basis_kernel.h"

void basis_evaluate_pair(const assay_basis *basis, size_t count, const assay_vec3 *directions,
                         double *values)
{
    evaluate_some(basis, count, directions, values);
}
