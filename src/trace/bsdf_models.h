/* bsdf_models.h - what each model of bsdf.h gives to the dispatch in bsdf.c.
 *
 * The dispatch has mirrored the frame so that wo.z > 0 always; `back` says that it did.  Models
 * that only reflect are asked for wi.z > 0 alone.  |wo.z| and |wi.z| are at least ASSAY_HORIZON. */
#ifndef ASSAY_TRACE_BSDF_MODELS_H
#define ASSAY_TRACE_BSDF_MODELS_H

#include "trace/bsdf.h"

/* Directions whose cosine to the surface is smaller scatter nothing: it keeps every quotient of
 * cosines finite, and what is lost of an albedo is of the order of its square. */
#define ASSAY_HORIZON 1e-12

/* What a model chooses: a direction, and how much it scatters there: f |wi.z| and its density or,
 * from a specular lobe, what the lobe scatters and its probability. */
typedef struct {
    assay_vec3       wi;
    bool             specular;
    assay_bsdf_value f;
} assay_bsdf_choice;

/* Makes the lobes; true where all of them are specular. */
bool             assay_metallic_roughness_view(const assay_bsdf *bsdf, bool back, assay_vec3 wo,
                                               assay_bsdf_lobes *lobes_out);
assay_bsdf_value assay_metallic_roughness_evaluate(const assay_bsdf_view *view, assay_vec3 wi);
bool assay_metallic_roughness_choose(const assay_bsdf_view *view, double u_lobe, double u1,
                                     double u2, assay_bsdf_choice *choice_out);

assay_bsdf_value assay_phong_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi);
assay_vec3       assay_phong_choose(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                                    double u2);

assay_bsdf_value assay_ward_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi);
assay_vec3       assay_ward_choose(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                                   double u2);

/* Probability of the diffuse lobe of Phong and Ward: its share of the luminance. Not both black. */
static inline double assay_diffuse_probability(const assay_bsdf *bsdf)
{
    const double diffuse = rgb_luminance(bsdf->base_color);
    return diffuse / (diffuse + rgb_luminance(bsdf->specular_color));
}

#endif
