/* clamped_cosine.c - the convolution that makes irradiance of radiance.
 *
 * A_l = 2 pi (-1)^(l/2 - 1) binomial(l, l/2) / (2^l (l + 2) (l - 1)) for even l >= 2
 * [ramamoorthi01]: whole numbers below 2^53, and pi as two doubles. */
#include "assay/basis.h"
#include "math/double_double.h"

assay_status assay_clamped_cosine(int order, double *a_out)
{
    if (order < 1 || order > ASSAY_BASIS_MAX_ORDER) {
        return ASSAY_ERR_ARGUMENT;
    }
    const double_double pi       = DOUBLE_DOUBLE_PI;
    double              binomial = 1.0;
    for (int l = 0; l < order; l++) {
        if (l % 2 != 0) {
            a_out[l] = l == 1 ? dd_divide_double(dd_multiply_double(pi, 2.0), 3.0).hi : 0.0;
            continue;
        }
        if (l > 0) {
            binomial = binomial * (4.0 * (l - 1)) / l; /* binomial(l, l/2), whole */
        }
        const double        below = ldexp((l + 2.0) * (l - 1.0), l - 1);
        const double_double value = dd_divide_double(dd_multiply_double(pi, binomial), below);
        a_out[l]                  = l % 4 == 0 ? -value.hi : value.hi;
    }
    return ASSAY_OK;
}

assay_status assay_basis_convolve_cosine(const assay_basis *sh, int channels, double *coefficients)
{
    if (assay_basis_kind_of(sh) != ASSAY_BASIS_SH || channels < 1) {
        return ASSAY_ERR_ARGUMENT;
    }
    const size_t       count = assay_basis_count(sh);
    double             a[ASSAY_BASIS_MAX_ORDER];
    const assay_status status = assay_clamped_cosine(assay_basis_order(sh), a);
    for (size_t i = 0; status == ASSAY_OK && i < (size_t)channels * count; i++) {
        int l, m;
        assay_basis_function(sh, i % count, &l, &m);
        coefficients[i] *= a[l];
    }
    return status;
}

double assay_basis_dot(const assay_basis *basis, const double *a, const double *b)
{
    const size_t count = assay_basis_count(basis);
    double       sum   = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}
