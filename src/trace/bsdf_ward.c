/* bsdf_ward.c - Ward's anisotropic model, as published and with bounded albedo.
 *
 * With h = wi + wo (not normalised) and e = exp(-((h.x / ax)^2 + (h.y / ay)^2) / h.z^2):
 *
 *     published [ward92] eq. 5a   f = ks e / (4 pi ax ay sqrt(wi.z wo.z))
 *     bounded   [geisler10]       f = ks e (h . h) / (pi ax ay h.z^4)
 *
 * each plus base_color / pi.  The published lobe gains energy without bound towards grazing
 * incidence; the other has an albedo below ks (docs/bsdf.md).
 * Invariant: the density is that of half vectors whose slopes are normal variates, turned into one
 * of directions by the Jacobian of reflection, 1 / (4 wo . h^), [walter05]. */
#include "core/numerics.h"
#include "math/sampling.h"
#include "trace/bsdf_models.h"

/* Narrower lobes are taken as this wide. */
static double width(double alpha) { return alpha > ASSAY_ALPHA_MIN ? alpha : ASSAY_ALPHA_MIN; }

assay_bsdf_value assay_ward_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi)
{
    const double     ax      = width(bsdf->alpha_x);
    const double     ay      = width(bsdf->alpha_y);
    const double     diffuse = assay_diffuse_probability(bsdf);
    const assay_vec3 h       = vec3_add(wi, wo);
    const double     sx      = h.x / (h.z * ax);
    const double     sy      = h.y / (h.z * ay);
    const double     e       = assay_exp(-(sx * sx + sy * sy)) / (ASSAY_PI * ax * ay);
    const double     h2      = vec3_dot(h, h);
    const double     z2      = h.z * h.z;
    const double     lobe = bsdf->model == ASSAY_BSDF_WARD_PUBLISHED ? 0.25 * e / sqrt(wi.z * wo.z)
                                                                     : e * h2 / (z2 * z2);
    const assay_rgb  f =
        rgb_add(rgb_scale(bsdf->base_color, ASSAY_INV_PI), rgb_scale(bsdf->specular_color, lobe));
    assay_bsdf_value result;
    result.value = rgb_scale(f, wi.z);
    /* Density of slopes e; of h^: e / cos^3; of wi: that / (4 wo . h^), where 2 wo . h^ = |h|. */
    result.pdf = diffuse * (wi.z * ASSAY_INV_PI) + (1.0 - diffuse) * (e * h2 / (2.0 * z2 * h.z));
    return result;
}

assay_vec3 assay_ward_choose(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                             double u2)
{
    if (u_lobe < assay_diffuse_probability(bsdf)) {
        return assay_sample_cosine_hemisphere(u1, u2);
    }
    const double       radius  = sqrt(-assay_log1p(-u1));
    const assay_sincos azimuth = assay_sincos_turns(u2);
    const assay_vec3   slope   = vec3(width(bsdf->alpha_x) * radius * azimuth.cos,
                                      width(bsdf->alpha_y) * radius * azimuth.sin, 1.0);
    const assay_vec3   h       = vec3_normalize(slope);
    return vec3_mad(vec3_negate(wo), 2.0 * vec3_dot(wo, h), h);
}
