/* cache_params.c - from parameters to the settings of caches. */
#include "methods/cache_params.h"

#include <string.h>

#include "core/context.h"

/* 0 stands for no limit. */
static double limit(const assay_params *params, const char *name)
{
    const double value = assay_params_real(params, name);
    return value > 0.0 ? value : INFINITY;
}

static assay_status check_limits(assay_context *context, const assay_params *params,
                                 const char *least, const char *most)
{
    if (assay_params_real(params, least) > limit(params, most)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "parameter '%s' is %s, above '%s', %s",
                          least, assay_params_text(params, least), most,
                          assay_params_text(params, most));
    }
    return ASSAY_OK;
}

static assay_record_rules rules_of(const assay_params *params)
{
    return (assay_record_rules){
        .a              = assay_params_real(params, "a"),
        .weight         = (assay_weight_kind)assay_params_choice(params, "weight"),
        .gradients      = (assay_gradients)assay_params_choice(params, "gradients"),
        .in_front       = assay_params_bool(params, "in_front"),
        .clamp_negative = assay_params_bool(params, "clamp_negative"),
    };
}

static assay_hemisphere_layout layout_of(const assay_params *params)
{
    if (assay_params_choice(params, "gather") == 1) {
        return (assay_hemisphere_layout){.theta  = assay_params_int(params, "raster_size"),
                                         .phi    = assay_params_int(params, "raster_size"),
                                         .strata = ASSAY_STRATA_PLANE,
                                         .fov    = assay_params_real(params, "raster_fov"),
                                         .missing =
                                             (assay_missing)assay_params_choice(params, "missing")};
    }
    return (assay_hemisphere_layout){.theta  = assay_params_int(params, "theta_strata"),
                                     .phi    = assay_params_int(params, "phi_strata"),
                                     .strata = (assay_strata)assay_params_choice(params, "strata"),
                                     .jitter = assay_params_bool(params, "jitter")};
}

static assay_status check_shadow(assay_context *context, const assay_params *params)
{
    if (assay_params_choice(params, "shadow") == ASSAY_SHADOW_MAP &&
        assay_params_choice(params, "secondary") != ASSAY_SECONDARY_DIRECT) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "parameter 'shadow' is map, which goes with secondary=direct alone, not "
                          "with %s",
                          assay_params_text(params, "secondary"));
    }
    return ASSAY_OK;
}

static int passes_of(const assay_params *params)
{
    const assay_param_desc *row = assay_params_table(params);
    while (row->name && strcmp(row->name, "passes") != 0) {
        row++;
    }
    return row->name ? assay_params_int(params, "passes") : 2;
}

assay_status assay_cache_params_read(assay_context *context, const assay_params *params,
                                     assay_irradiance_cache_settings *cache_out,
                                     assay_cached_image_settings     *image_out)
{
    assay_status status = check_limits(context, params, "r_min", "r_max");
    status = status ? status : check_limits(context, params, "r_min_pixels", "r_max_pixels");
    status = status ? status : check_shadow(context, params);
    if (status != ASSAY_OK) {
        return status;
    }
    const assay_secondary     secondary = (assay_secondary)assay_params_choice(params, "secondary");
    const int                 bounces   = assay_params_int(params, "bounces");
    const assay_path_settings path      = {
             .bounces        = secondary == ASSAY_SECONDARY_DIRECT && bounces > 2 ? 2 : bounces,
             .roulette_depth = assay_params_int(params, "roulette_depth"),
             .estimator      = (assay_estimator)assay_params_choice(params, "estimator"),
    };
    *cache_out = (assay_irradiance_cache_settings){
        .layout          = layout_of(params),
        .rules           = rules_of(params),
        .mean            = (assay_mean_weight)assay_params_choice(params, "mean"),
        .r_min           = assay_params_real(params, "r_min"),
        .r_max           = limit(params, "r_max"),
        .r_min_pixels    = assay_params_real(params, "r_min_pixels"),
        .r_max_pixels    = limit(params, "r_max_pixels"),
        .gradient_limit  = assay_params_bool(params, "gradient_limit"),
        .neighbour_clamp = assay_params_bool(params, "neighbour_clamp"),
        .normal_gradient = assay_params_bool(params, "normal_gradient"),
        .max_records     = (uint32_t)assay_params_int(params, "max_records"),
        .secondary       = secondary,
        .shadow          = (assay_shadow)assay_params_choice(params, "shadow"),
        .shadow_maps     = {.side = assay_params_int(params, "shadow_size"),
                            .taps = assay_params_int(params, "shadow_taps")},
        .levels          = assay_params_int(params, "levels"),
        .path            = path,
    };
    *image_out = (assay_cached_image_settings){
        .path   = path,
        .spp    = (uint32_t)assay_params_int(params, "spp"),
        .order  = (assay_pixel_order)assay_params_choice(params, "traversal"),
        .passes = passes_of(params),
    };
    return ASSAY_OK;
}
