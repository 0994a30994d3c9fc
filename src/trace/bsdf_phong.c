/* bsdf_phong.c - the modified Phong model, [lafortune94].
 *
 *     f = base_color / pi + specular_color (n + 2) / (2 pi) cos^n a
 *
 * a is the angle between wi and the mirror direction of wo; the lobe is zero where a >= 90 degrees.
 * Invariant: the albedo is at most base_color + specular_color, with equality at normal incidence;
 * elsewhere the horizon cuts the lobe (docs/bsdf.md). */
#include "core/numerics.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "trace/bsdf_models.h"

static assay_vec3 mirror(assay_vec3 wo) { return vec3(-wo.x, -wo.y, wo.z); }

assay_bsdf_value assay_phong_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi)
{
    const double     n       = bsdf->exponent;
    const double     diffuse = assay_diffuse_probability(bsdf);
    const double     c       = vec3_dot(mirror(wo), wi);
    const double     lobe    = c > 0.0 ? 0.5 * ASSAY_INV_PI * assay_pow(c < 1.0 ? c : 1.0, n) : 0.0;
    const assay_rgb  f       = rgb_add(rgb_scale(bsdf->base_color, ASSAY_INV_PI),
                                       rgb_scale(bsdf->specular_color, (n + 2.0) * lobe));
    assay_bsdf_value result;
    result.value = rgb_scale(f, wi.z);
    result.pdf   = diffuse * (wi.z * ASSAY_INV_PI) + (1.0 - diffuse) * ((n + 1.0) * lobe);
    return result;
}

assay_vec3 assay_phong_choose(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                              double u2)
{
    if (u_lobe < assay_diffuse_probability(bsdf)) {
        return assay_sample_cosine_hemisphere(u1, u2);
    }
    /* cos a = (1 - u1)^(1 / (n + 1)); expm1 keeps the sine of narrow lobes. */
    const double       logarithm = assay_log1p(-u1) / (bsdf->exponent + 1.0);
    const double       sine      = sqrt(-assay_expm1(2.0 * logarithm));
    const assay_vec3   local     = assay_direction_about_z(assay_exp(logarithm), sine, u2);
    const assay_frame3 frame     = frame3_from_z(mirror(wo));
    return frame3_to_world(&frame, local);
}
