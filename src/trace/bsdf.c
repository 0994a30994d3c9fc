/* bsdf.c - dispatch over the models, and Lambert's law.
 *
 * Invariant: models see a frame in which wo is above the surface, both cosines at least
 * ASSAY_HORIZON; what they return is finite; and a weight is the quotient of the very value and
 * density that assay_bsdf_evaluate gives for a direction that is not from a specular lobe. */
#include "trace/bsdf.h"

#include "core/numerics.h"
#include "math/sampling.h"
#include "trace/bsdf_models.h"

/* Phong and Ward: a specular lobe that is added to the diffuse one. */
static bool adds_specular(assay_bsdf_model model)
{
    return model == ASSAY_BSDF_PHONG || model == ASSAY_BSDF_WARD ||
           model == ASSAY_BSDF_WARD_PUBLISHED;
}

assay_bsdf assay_bsdf_default(assay_bsdf_model model)
{
    return (assay_bsdf){
        .model           = model,
        .base_color      = rgb_grey(1.0),
        .metallic        = 1.0,
        .roughness       = 1.0,
        .ior             = 1.5,
        .specular_factor = 1.0,
        .specular_color  = rgb_grey(adds_specular(model) ? 0.0 : 1.0),
        .transmission    = 0.0,
        .solid           = false,
        .exponent        = 1.0,
        .alpha_x         = 1.0,
        .alpha_y         = 1.0,
    };
}

static assay_vec3 flip(assay_vec3 w) { return vec3(w.x, w.y, -w.z); }

static bool is_black(const assay_bsdf *bsdf)
{
    switch (bsdf->model) {
    case ASSAY_BSDF_BLACK: return true;
    case ASSAY_BSDF_LAMBERT: return rgb_is_black(bsdf->base_color);
    case ASSAY_BSDF_METALLIC_ROUGHNESS: return false;
    case ASSAY_BSDF_PHONG:
    case ASSAY_BSDF_WARD:
    case ASSAY_BSDF_WARD_PUBLISHED: break;
    }
    return rgb_is_black(bsdf->base_color) && rgb_is_black(bsdf->specular_color);
}

assay_bsdf_view assay_bsdf_seen_from(const assay_bsdf *bsdf, assay_vec3 wo)
{
    const bool      back = wo.z < 0.0;
    assay_bsdf_view view;
    view.bsdf     = bsdf;
    view.back     = back;
    view.wo       = back ? flip(wo) : wo;
    view.specular = is_black(bsdf);
    view.scatters = view.wo.z >= ASSAY_HORIZON && !view.specular;
    if (bsdf->model == ASSAY_BSDF_METALLIC_ROUGHNESS && view.scatters) {
        view.specular = assay_metallic_roughness_view(bsdf, back, view.wo, &view.lobes);
    } else {
        view.lobes = (assay_bsdf_lobes){0};
    }
    return view;
}

/* wi in the mirrored frame. */
static assay_bsdf_value evaluate(const assay_bsdf_view *view, assay_vec3 wi)
{
    const assay_bsdf      *bsdf    = view->bsdf;
    const assay_bsdf_value nothing = {{0.0, 0.0, 0.0}, 0.0};
    if (!view->scatters || !(fabs(wi.z) >= ASSAY_HORIZON) ||
        (wi.z < 0.0 && bsdf->model != ASSAY_BSDF_METALLIC_ROUGHNESS)) {
        return nothing;
    }
    switch (bsdf->model) {
    case ASSAY_BSDF_LAMBERT: {
        const double pdf = wi.z * ASSAY_INV_PI;
        return (assay_bsdf_value){rgb_scale(bsdf->base_color, pdf), pdf};
    }
    case ASSAY_BSDF_METALLIC_ROUGHNESS: return assay_metallic_roughness_evaluate(view, wi);
    case ASSAY_BSDF_PHONG: return assay_phong_evaluate(bsdf, view->wo, wi);
    case ASSAY_BSDF_WARD:
    case ASSAY_BSDF_WARD_PUBLISHED: return assay_ward_evaluate(bsdf, view->wo, wi);
    case ASSAY_BSDF_BLACK: break;
    }
    return nothing;
}

assay_bsdf_value assay_bsdf_view_evaluate(const assay_bsdf_view *view, assay_vec3 wi)
{
    return evaluate(view, view->back ? flip(wi) : wi);
}

/* Asks the model for a direction and what it scatters there. */
static bool choose(const assay_bsdf_view *view, double u_lobe, double u1, double u2,
                   assay_bsdf_choice *choice_out)
{
    const assay_bsdf *bsdf = view->bsdf;
    assay_vec3        wi;
    switch (bsdf->model) {
    case ASSAY_BSDF_METALLIC_ROUGHNESS:
        return assay_metallic_roughness_choose(view, u_lobe, u1, u2, choice_out);
    case ASSAY_BSDF_LAMBERT: wi = assay_sample_cosine_hemisphere(u1, u2); break;
    case ASSAY_BSDF_PHONG: wi = assay_phong_choose(bsdf, view->wo, u_lobe, u1, u2); break;
    case ASSAY_BSDF_WARD:
    case ASSAY_BSDF_WARD_PUBLISHED: wi = assay_ward_choose(bsdf, view->wo, u_lobe, u1, u2); break;
    case ASSAY_BSDF_BLACK:
    default: return false;
    }
    *choice_out = (assay_bsdf_choice){wi, false, evaluate(view, wi)};
    return true;
}

bool assay_bsdf_view_sample(const assay_bsdf_view *view, double u_lobe, double u1, double u2,
                            assay_bsdf_sample *sample_out)
{
    assay_bsdf_choice choice;
    if (!view->scatters || !choose(view, u_lobe, u1, u2, &choice) || !(choice.f.pdf > 0.0)) {
        return false;
    }
    const assay_rgb weight = rgb_scale(choice.f.value, 1.0 / choice.f.pdf);
    if (!isfinite(choice.f.pdf) || !rgb_finite(weight)) {
        return false;
    }
    *sample_out = (assay_bsdf_sample){
        .wi          = view->back ? flip(choice.wi) : choice.wi,
        .weight      = weight,
        .pdf         = choice.f.pdf,
        .specular    = choice.specular,
        .transmitted = choice.wi.z < 0.0,
    };
    return true;
}

assay_bsdf_value assay_bsdf_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi)
{
    const assay_bsdf_view view = assay_bsdf_seen_from(bsdf, wo);
    return assay_bsdf_view_evaluate(&view, wi);
}

bool assay_bsdf_sample_direction(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                                 double u2, assay_bsdf_sample *sample_out)
{
    const assay_bsdf_view view = assay_bsdf_seen_from(bsdf, wo);
    return assay_bsdf_view_sample(&view, u_lobe, u1, u2, sample_out);
}

assay_rgb assay_bsdf_view_lambert(const assay_bsdf_view *view)
{
    if (!view->scatters) {
        return rgb_grey(0.0);
    }
    if (view->bsdf->model == ASSAY_BSDF_METALLIC_ROUGHNESS) {
        const double coat = rgb_max(view->lobes.f0);
        return rgb_scale(view->lobes.diffuse, coat < 1.0 ? 1.0 - coat : 0.0);
    }
    return view->bsdf->base_color;
}

assay_rgb assay_bsdf_albedo(const assay_bsdf *bsdf)
{
    return adds_specular(bsdf->model) ? rgb_add(bsdf->base_color, bsdf->specular_color)
                                      : bsdf->base_color;
}
