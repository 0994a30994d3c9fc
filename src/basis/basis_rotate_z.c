/* basis_rotate_z.c - turning about the pole: pairs (m, -m) turn by m angle.
 *
 * The sign convention does not matter: it is the same for both of a pair. */
#include <math.h>

#include "basis/basis_data.h"
#include "core/numerics.h"

/* cos and sin of m angle; the rounding of the product is put back to first order. */
static assay_sincos multiple(double angle, int m)
{
    const double       product = m * angle;
    const double       rest    = fma(m, angle, -product);
    const assay_sincos turn    = assay_sincos_radians(product);
    return (assay_sincos){turn.sin + rest * turn.cos, turn.cos - rest * turn.sin};
}

assay_status assay_basis_rotate_z(const assay_basis *basis, double angle, int channels,
                                  double *coefficients)
{
    if (channels < 1) {
        return ASSAY_ERR_ARGUMENT;
    }
    if (!isfinite(angle * basis->order)) {
        return ASSAY_ERR_DOMAIN;
    }
    assay_sincos turn[ASSAY_BASIS_MAX_ORDER];
    for (int m = 1; m < basis->order; m++) {
        turn[m] = multiple(angle, m);
    }
    for (int channel = 0; channel < channels; channel++) {
        double *row = coefficients + (size_t)channel * basis->count;
        for (size_t i = 0; i < basis->count; i++) {
            const int m = basis->m[i];
            if (m <= 0) {
                continue;
            }
            const size_t j     = basis_index(basis, basis->l[i], -m);
            const double plus  = row[i];
            const double minus = row[j];
            row[i]             = plus * turn[m].cos - minus * turn[m].sin;
            row[j]             = plus * turn[m].sin + minus * turn[m].cos;
        }
    }
    return ASSAY_OK;
}
