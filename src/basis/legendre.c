/* legendre.c - associated Legendre polynomials, plain and shifted, by the recurrences of
 * [gautron06] eq. 3.4 to 3.6.
 *
 * Invariant: sine is sqrt(1 - t^2) for the argument t, computed without the cancellation: from
 * (1 - t)(1 + t), or of the shifted argument t = 2 x - 1 from 4 x (1 - x). */
#include "assay/basis.h"

#include <math.h>

static size_t index_of(int l, int m) { return (size_t)l * ((size_t)l + 1) / 2 + (size_t)m; }

static void fill(int order, double t, double sine, double *p)
{
    double sectoral = 1.0; /* P_m^m */
    for (int m = 0; m < order; m++) {
        p[index_of(m, m)] = sectoral;
        if (m + 1 < order) {
            p[index_of(m + 1, m)] = t * (2.0 * m + 1.0) * sectoral;
        }
        for (int l = m + 2; l < order; l++) {
            p[index_of(l, m)] = (t * (2.0 * l - 1.0) * p[index_of(l - 1, m)] -
                                 (l + m - 1.0) * p[index_of(l - 2, m)]) /
                                (l - m);
        }
        sectoral *= -(2.0 * m + 1.0) * sine;
    }
}

static bool is_order(int order) { return order >= 1 && order <= ASSAY_BASIS_MAX_ORDER; }

assay_status assay_legendre(int order, double x, double *values_out)
{
    if (!is_order(order)) {
        return ASSAY_ERR_ARGUMENT;
    }
    if (!(x >= -1.0 && x <= 1.0)) {
        return ASSAY_ERR_DOMAIN;
    }
    fill(order, x, sqrt((1.0 - x) * (1.0 + x)), values_out);
    return ASSAY_OK;
}

assay_status assay_legendre_shifted(int order, double x, double *values_out)
{
    if (!is_order(order)) {
        return ASSAY_ERR_ARGUMENT;
    }
    if (!(x >= 0.0 && x <= 1.0)) {
        return ASSAY_ERR_DOMAIN;
    }
    fill(order, 2.0 * x - 1.0, 2.0 * sqrt(x * (1.0 - x)), values_out);
    return ASSAY_OK;
}
