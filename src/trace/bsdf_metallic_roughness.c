/* bsdf_metallic_roughness.c - the material of glTF 2.0, appendix B, with KHR_materials_ior,
 * _specular and _transmission; and as a solid's boundary, the rough dielectric of [walter07].
 *
 *     (1 - metallic) ((1 - max F) base + F specular) + metallic Fm specular
 *     base = (1 - transmission) base_color / pi + transmission base_color through
 *
 * specular is the GGX lobe D V with the separable Smith term; F, Fm are taken at the microfacet
 * (wo . h).  docs/bsdf.md has every formula and every departure.
 *
 * Invariant: the lobes drawn are diffuse, straight (index-matched solids alone) and microfacets; a
 * microfacet's normal is drawn first, then whether it reflects or passes, with probabilities that
 * depend on wo . h alone.  So value and density need only wo, wi and the half vector. */
#include "core/numerics.h"
#include "math/sampling.h"
#include "trace/bsdf_models.h"
#include "trace/fresnel.h"
#include "trace/ggx.h"

/* Solids whose index differs less from that around them do not bend light. */
#define INDEX_MATCHED 1e-4

/* The cosine whose Schlick weight is 1/21, the mean over the hemisphere. */
#define MEAN_SCHLICK_COSINE 0.456

typedef assay_bsdf_lobes lobes;

/* What one microfacet does. */
typedef struct {
    assay_rgb reflect;   /* reflectance, dielectric and metal mixed */
    double    pass;      /* what the dielectric lets into its base  */
    double    p_reflect; /* probability that it is drawn to reflect */
} facet;

/* Fresnel's exact curve runs from its own reflectance at normal incidence to 1; the factors of
 * KHR_materials_specular move these two ends, as they do with Schlick's curve. */
static double between(double f0, double f90, double exact, double exact_normal)
{
    const double f =
        f90 * exact + (f0 - f90 * exact_normal) * ((1.0 - exact) / (1.0 - exact_normal));
    return f > 0.0 ? f : 0.0;
}

/* The dielectric's reflectance.  Under total internal reflection it is 1 whatever the factors. */
static assay_rgb dielectric_fresnel(const lobes *l, double c)
{
    if (l->matched) {
        return rgb_grey(0.0);
    }
    if (!l->refracts) {
        const double w = assay_schlick(c);
        return rgb_mix(l->f0, rgb_grey(l->f90), w);
    }
    if (assay_refracted_cosine(c, l->eta) == 0.0) {
        return rgb_grey(1.0);
    }
    const double exact  = assay_fresnel_dielectric(c, l->eta);
    const double normal = assay_normal_reflectance(l->eta);
    return rgb(between(l->f0.r, l->f90, exact, normal), between(l->f0.g, l->f90, exact, normal),
               between(l->f0.b, l->f90, exact, normal));
}

/* The microfacet seen under the cosine c = wo . h. */
static facet facet_at(const lobes *l, double c)
{
    const assay_rgb dielectric = dielectric_fresnel(l, c);
    const double    pass       = 1.0 - rgb_max(dielectric);
    facet           f          = {dielectric, pass > 0.0 ? pass : 0.0, 1.0};
    if (l->metallic > 0.0) {
        const assay_rgb metal = rgb_mix(l->base_color, rgb_grey(1.0), assay_schlick(c));
        f.reflect             = rgb_mix(dielectric, metal, l->metallic);
    }
    if (l->transmits && !l->matched) {
        const double reflected = rgb_luminance(f.reflect);
        const double passed    = rgb_luminance(l->through) * f.pass;
        f.p_reflect            = reflected / (reflected + passed);
    }
    return f;
}

/* Shares of the lobes.  Any will do that are > 0 wherever the lobe is; rough microfacets count with
 * at least their mean reflectance, or with total reflection where that can happen. */
static void set_probabilities(lobes *l, bool back, double cos_o)
{
    double c = cos_o;
    if (!l->smooth) {
        const double least = back && l->refracts ? 0.0 : MEAN_SCHLICK_COSINE;
        c                  = c < least ? c : least;
    }
    const facet  f        = facet_at(l, c);
    const double through  = rgb_luminance(l->through);
    const double diffuse  = rgb_luminance(l->diffuse);
    const double straight = l->matched ? through : 0.0;
    const double facets   = rgb_luminance(f.reflect) + (l->matched ? 0.0 : through * f.pass);
    const double sum      = diffuse + straight + facets;
    const double scale    = sum > 0.0 ? 1.0 / sum : 0.0;
    l->p_diffuse          = diffuse * scale;
    l->p_straight         = straight * scale;
    l->p_facet            = facets * scale;
}

static double at_most_one(double x) { return x < 1.0 ? x : 1.0; }

bool assay_metallic_roughness_view(const assay_bsdf *bsdf, bool back, assay_vec3 wo,
                                   assay_bsdf_lobes *lobes_out)
{
    lobes       *l          = lobes_out;
    const double dielectric = 1.0 - bsdf->metallic;
    const double f0         = assay_normal_reflectance(bsdf->ior);
    const double factor     = bsdf->specular_factor;
    l->alpha                = bsdf->roughness * bsdf->roughness;
    l->metallic             = bsdf->metallic;
    l->base_color           = bsdf->base_color;
    l->f0                   = rgb(at_most_one(f0 * bsdf->specular_color.r) * factor,
                                  at_most_one(f0 * bsdf->specular_color.g) * factor,
                                  at_most_one(f0 * bsdf->specular_color.b) * factor);
    l->f90                  = factor;
    l->diffuse              = rgb_scale(bsdf->base_color, dielectric * (1.0 - bsdf->transmission));
    l->through              = rgb_scale(bsdf->base_color, dielectric * bsdf->transmission);
    l->refracts             = bsdf->solid && bsdf->ior > 0.0;
    l->matched              = l->refracts && fabs(bsdf->ior - 1.0) < INDEX_MATCHED;
    l->smooth               = l->alpha < ASSAY_ALPHA_MIN;
    l->transmits            = !rgb_is_black(l->through);
    l->eta     = !l->refracts || l->matched ? 1.0 : (back ? 1.0 / bsdf->ior : bsdf->ior);
    l->masking = l->smooth ? 0.0 : assay_ggx_masking(l->alpha, wo.z);
    const bool facets =
        l->metallic > 0.0 || (!l->matched && (l->f90 > 0.0 || l->transmits || l->refracts));
    set_probabilities(l, back, wo.z);
    return rgb_is_black(l->diffuse) && (l->smooth || !facets);
}

static assay_bsdf_value reflection(const lobes *l, assay_vec3 wo, assay_vec3 wi)
{
    const assay_vec3 sum    = vec3_add(wo, wi);
    const double     length = vec3_length(sum);
    const facet      f      = facet_at(l, 0.5 * length); /* wo . h = wi . h = |wo + wi| / 2 */
    assay_bsdf_value result;
    result.value = rgb_scale(l->diffuse, f.pass * (wi.z * ASSAY_INV_PI));
    result.pdf   = l->p_diffuse * (wi.z * ASSAY_INV_PI);
    if (!l->smooth) {
        const double d  = assay_ggx_density(l->alpha, vec3_scale(sum, 1.0 / length));
        const double go = l->masking;
        const double gi = assay_ggx_masking(l->alpha, wi.z);
        result.value    = rgb_add(result.value, rgb_scale(f.reflect, d * wi.z / (go * gi)));
        result.pdf += l->p_facet * f.p_reflect * (d / (2.0 * go));
    }
    return result;
}

/* Through an infinitely thin wall: the reflected lobe, mirrored to the other side. */
static assay_bsdf_value thin_transmission(const lobes *l, assay_vec3 wo, assay_vec3 wi)
{
    const assay_vec3 sum    = vec3(wo.x + wi.x, wo.y + wi.y, wo.z - wi.z);
    const double     length = vec3_length(sum);
    const facet      f      = facet_at(l, 0.5 * length);
    const double     d      = assay_ggx_density(l->alpha, vec3_scale(sum, 1.0 / length));
    const double     go     = l->masking;
    const double     gi     = assay_ggx_masking(l->alpha, -wi.z);
    return (assay_bsdf_value){rgb_scale(l->through, f.pass * (d * -wi.z / (go * gi))),
                              l->p_facet * (1.0 - f.p_reflect) * (d / (2.0 * go))};
}

/* Into or out of a solid, [walter07] eq. 21 divided by the squared index in front: radiance grows
 * with the square of the index, so that eta^-2 stands in the value, not in the density. */
static assay_bsdf_value refraction(const lobes *l, assay_vec3 wo, assay_vec3 wi)
{
    const assay_bsdf_value nothing = {{0.0, 0.0, 0.0}, 0.0};
    const assay_vec3       sum     = vec3_mad(wo, l->eta, wi);
    const double           length2 = vec3_dot(sum, sum);
    if (!(length2 > 0.0) || sum.z == 0.0) {
        return nothing;
    }
    const assay_vec3 h  = vec3_scale(sum, copysign(1.0, sum.z) / sqrt(length2));
    const double     oh = vec3_dot(wo, h);
    const double     ih = -vec3_dot(wi, h);
    if (!(oh > 0.0) || !(ih > 0.0)) {
        return nothing;
    }
    const facet  f  = facet_at(l, oh);
    const double d  = assay_ggx_density(l->alpha, h);
    const double go = l->masking;
    const double gi = assay_ggx_masking(l->alpha, -wi.z);
    const double j  = oh * ih * d / (go * length2);
    return (assay_bsdf_value){
        rgb_scale(l->through, f.pass * (4.0 * j * -wi.z / gi)),
        l->p_facet * (1.0 - f.p_reflect) * (2.0 * j * (l->eta * l->eta)),
    };
}

static assay_bsdf_value evaluate(const lobes *l, assay_vec3 wo, assay_vec3 wi)
{
    if (wi.z > 0.0) {
        return reflection(l, wo, wi);
    }
    if (l->smooth || l->matched || !l->transmits) {
        return (assay_bsdf_value){{0.0, 0.0, 0.0}, 0.0};
    }
    return l->refracts ? refraction(l, wo, wi) : thin_transmission(l, wo, wi);
}

assay_bsdf_value assay_metallic_roughness_evaluate(const assay_bsdf_view *view, assay_vec3 wi)
{
    return evaluate(&view->lobes, view->wo, wi);
}

/* Reflects at or passes a microfacet; u chooses. */
static bool choose_at_facet(const lobes *l, assay_vec3 wo, assay_vec3 h, double u,
                            assay_bsdf_choice *choice)
{
    const double c       = vec3_dot(wo, h);
    const facet  f       = facet_at(l, c);
    const bool   passes  = l->transmits && u >= f.p_reflect;
    const double squared = l->eta * l->eta;
    if (!passes) {
        choice->wi = assay_reflect(wo, h, c);
    } else if (l->refracts) {
        choice->wi = assay_refract(wo, h, c, assay_refracted_cosine(c, l->eta), l->eta);
    } else {
        const assay_vec3 mirrored = assay_reflect(wo, h, c);
        choice->wi                = vec3(mirrored.x, mirrored.y, -mirrored.z);
    }
    choice->specular = l->smooth;
    if (l->smooth) {
        choice->f.value = passes ? rgb_scale(l->through, f.pass / squared) : f.reflect;
        choice->f.pdf   = l->p_facet * (passes ? 1.0 - f.p_reflect : f.p_reflect);
    }
    return passes == (choice->wi.z < 0.0);
}

/* Draws a lobe and from it a direction; f is set where the lobe is specular. */
static bool choose(const lobes *l, assay_vec3 wo, double u_lobe, double u1, double u2,
                   assay_bsdf_choice *choice)
{
    choice->specular = false;
    if (u_lobe < l->p_diffuse) {
        choice->wi = assay_sample_cosine_hemisphere(u1, u2);
        return true;
    }
    if (u_lobe < l->p_diffuse + l->p_straight) {
        *choice = (assay_bsdf_choice){vec3_negate(wo), true, {l->through, l->p_straight}};
        return true;
    }
    if (l->p_facet == 0.0) {
        return false;
    }
    const double     u = (u_lobe - l->p_diffuse - l->p_straight) / l->p_facet;
    const assay_vec3 h =
        l->smooth ? vec3(0.0, 0.0, 1.0) : assay_ggx_sample_visible(l->alpha, wo, u1, u2);
    return choose_at_facet(l, wo, h, u, choice);
}

bool assay_metallic_roughness_choose(const assay_bsdf_view *view, double u_lobe, double u1,
                                     double u2, assay_bsdf_choice *choice_out)
{
    if (!choose(&view->lobes, view->wo, u_lobe, u1, u2, choice_out) ||
        !(fabs(choice_out->wi.z) >= ASSAY_HORIZON)) {
        return false;
    }
    if (!choice_out->specular) {
        choice_out->f = evaluate(&view->lobes, view->wo, choice_out->wi);
    }
    return true;
}
