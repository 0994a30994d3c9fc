/* lobe.c - the BRDF lobes of [gautron06] 3.5.1.
 *
 * Frame: x and y along Ward's axes.  wo = (theta_out, phi_out); Phong's mirror direction is
 * (theta_out, phi_out + pi). */
#include "basis/lobe.h"

#include "core/numerics.h"

assay_vec3 assay_lobe_outgoing(const assay_lobe *lobe)
{
    const assay_sincos theta = assay_sincos_radians(lobe->theta_out);
    const assay_sincos phi   = assay_sincos_radians(lobe->phi_out);
    return (assay_vec3){theta.sin * phi.cos, theta.sin * phi.sin, theta.cos};
}

const char *assay_lobe_problem(const assay_lobe *lobe)
{
    if (!(lobe->theta_out >= 0.0 && lobe->theta_out < 0.5 * ASSAY_PI) || !isfinite(lobe->phi_out)) {
        return "a lobe's outgoing direction must have a polar angle in [0, pi/2) and a finite "
               "azimuth";
    }
    if (lobe->kind == ASSAY_LOBE_PHONG) {
        return lobe->exponent >= 0.0 && isfinite(lobe->exponent)
                   ? NULL
                   : "a Phong lobe's exponent must be finite and >= 0";
    }
    if (lobe->kind == ASSAY_LOBE_WARD) {
        return lobe->alpha_x > 0.0 && lobe->alpha_y > 0.0 && isfinite(lobe->alpha_x) &&
                       isfinite(lobe->alpha_y)
                   ? NULL
                   : "a Ward lobe's two widths must be finite and > 0";
    }
    return "a lobe is Phong's or Ward's";
}

static double phong(const assay_lobe *lobe, assay_vec3 wo, assay_vec3 wi)
{
    const double cosine = wo.z * wi.z - wo.x * wi.x - wo.y * wi.y;
    if (!(cosine > 0.0)) {
        return 0.0;
    }
    return assay_pow(fmin(cosine, 1.0), lobe->exponent);
}

/* [ward92] eq. 5 with k_d = 0, k_s = 1, times cos(theta_i); tan(delta) of the half vector with its
 * azimuth is (hx, hy) / hz, whatever its length. */
static double ward(const assay_lobe *lobe, assay_vec3 wo, assay_vec3 wi)
{
    const double hz    = wo.z + wi.z;
    const double hx    = (wo.x + wi.x) / (hz * lobe->alpha_x);
    const double hy    = (wo.y + wi.y) / (hz * lobe->alpha_y);
    const double scale = 4.0 * ASSAY_PI * lobe->alpha_x * lobe->alpha_y;
    return sqrt(wi.z / wo.z) * assay_exp(-(hx * hx + hy * hy)) / scale;
}

double assay_lobe_at(const assay_lobe *lobe, assay_vec3 wo, assay_vec3 wi)
{
    if (!(wi.z >= 0.0)) {
        return 0.0;
    }
    return lobe->kind == ASSAY_LOBE_PHONG ? phong(lobe, wo, wi) : ward(lobe, wo, wi);
}

assay_status assay_lobe_value(const assay_lobe *lobe, assay_vec3 wi, double *value_out)
{
    const double square = wi.x * wi.x + wi.y * wi.y + wi.z * wi.z;
    if (assay_lobe_problem(lobe) || !(fabs(square - 1.0) <= ASSAY_BASIS_UNIT_TOLERANCE)) {
        return ASSAY_ERR_DOMAIN;
    }
    const double     length = sqrt(square);
    const assay_vec3 unit   = {wi.x / length, wi.y / length, wi.z / length};
    const double     value  = assay_lobe_at(lobe, assay_lobe_outgoing(lobe), unit);
    if (!isfinite(value)) {
        return ASSAY_ERR_DOMAIN;
    }
    *value_out = value;
    return ASSAY_OK;
}
