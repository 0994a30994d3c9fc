/* basis_evaluate.c - all functions at one direction, or at many.
 *
 * Invariant: vectors of any width do the same operations to each direction, so neither the machine
 * nor a direction's neighbours show in the bits. */
#include <math.h>

#include "basis/basis_data.h"

assay_status basis_check_direction(const assay_basis *basis, assay_vec3 d)
{
    const double excess = d.x * d.x + d.y * d.y + (d.z * d.z - 1.0);
    if (!(fabs(excess) <= ASSAY_BASIS_UNIT_TOLERANCE)) {
        return ASSAY_ERR_DOMAIN;
    }
    return assay_basis_kind_is_hemispherical(basis->kind) && d.z < 0.0 ? ASSAY_ERR_DOMAIN
                                                                       : ASSAY_OK;
}

assay_status assay_basis_evaluate(const assay_basis *basis, assay_vec3 direction,
                                  double *values_out)
{
    const assay_status status = basis_check_direction(basis, direction);
    if (status == ASSAY_OK) {
        basis_evaluate_pair(basis, 1, &direction, values_out);
    }
    return status;
}

assay_status assay_basis_evaluate_many(const assay_basis *basis, size_t direction_count,
                                       const assay_vec3 *directions, double *values_out)
{
    for (size_t i = 0; i < direction_count; i++) {
        const assay_status status = basis_check_direction(basis, directions[i]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    size_t done = 0;
    while (done < direction_count) {
        const size_t left   = direction_count - done;
        const bool   wide   = basis->wide && left > BASIS_PAIR;
        const size_t width  = wide ? BASIS_WIDE : BASIS_PAIR;
        const size_t count  = left < width ? left : width;
        double      *values = values_out + done * basis->count;
        (wide ? basis_evaluate_wide : basis_evaluate_pair)(basis, count, directions + done, values);
        done += count;
    }
    return ASSAY_OK;
}
