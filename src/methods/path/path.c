/* path.c - parameters of the method `path`. */
#include "methods/path/path.h"

#include "core/alloc.h"
#include "core/context.h"

static const assay_param_desc PARAMS[] = {
    {"spp", ASSAY_PARAM_INT, "samples", "64", 1, 1e9, NULL,
     "Camera paths a pixel (and samples of irradiance, and of a probe).", ""},
    {"bounces", ASSAY_PARAM_INT, "", "inf", 0, ASSAY_PARAM_INF, NULL,
     "Largest number of scatterings between light and eye: 0 emission only, 1 direct light, 2 one "
     "indirect bounce.",
     "[gautron06] 2.1"},
    {"estimator", ASSAY_PARAM_CHOICE, "", "mis", 0, 0, "nee|bsdf|mis",
     "How light is found: light sampling, BSDF sampling, or both weighted by the power heuristic.",
     "[veach95]"},
    {"roulette_depth", ASSAY_PARAM_INT, "bounces", "5", 1, 1e6, NULL,
     "Russian roulette may end a path only after this bounce.", "[arvo90]"},
    {"target_error", ASSAY_PARAM_REAL, "", "0", 0, 1, NULL,
     "Go on past spp until the mean relative standard error of the image is below this; 0 is off. "
     "Decides on no fewer than 64 samples a pixel and 4096 in all.",
     ""},
    {"max_spp", ASSAY_PARAM_INT, "samples", "65536", 1, 1e9, NULL,
     "Where target_error gives up, with a warning; not below spp.", ""},
    {"gradients", ASSAY_PARAM_BOOL, "", "on", 0, 0, NULL,
     "Probes: gradients of irradiance by finite differences with common random numbers; their "
     "paths "
     "find lights by light sampling, whatever the estimator.",
     ""},
    {"gradient_step", ASSAY_PARAM_REAL, "m", "0", 0, 1e9, NULL,
     "Probes: half the distance of the difference; 0 is a thousandth of the scene's diagonal. "
     "Times "
     "spp it should be the diagonal at least.",
     ""},
    {"gradient_angle", ASSAY_PARAM_REAL, "rad", "0.001", 1e-6, 0.5, NULL,
     "Probes: half the angle of the rotational difference. Times spp it should be 1 at least.", ""},
    {0},
};

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    assay_path_state *state = assay_allocate(context, 1, sizeof *state);
    if (!state) {
        return assay_fail_memory(context, "the path tracer");
    }
    *state = (assay_path_state){
        .context        = context,
        .settings       = {.bounces        = assay_params_int(params, "bounces"),
                           .roulette_depth = assay_params_int(params, "roulette_depth"),
                           .estimator      = (assay_estimator)assay_params_choice(params, "estimator")},
        .spp            = (uint32_t)assay_params_int(params, "spp"),
        .max_spp        = (uint32_t)assay_params_int(params, "max_spp"),
        .target_error   = assay_params_real(params, "target_error"),
        .gradients      = assay_params_bool(params, "gradients"),
        .gradient_step  = assay_params_real(params, "gradient_step"),
        .gradient_angle = assay_params_real(params, "gradient_angle"),
    };
    *state_out = state;
    return ASSAY_OK;
}

static assay_status prepare(void *state, const assay_frame *frame)
{
    const assay_path_state *path = state;
    if (path->target_error > 0.0 && frame->camera && !(frame->layers & ASSAY_LAYERS_COLOR)) {
        return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                          "parameter 'target_error' is the error of the colour: the layers must "
                          "have color among them");
    }
    if (path->target_error > 0.0 && !frame->camera) {
        return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                          "parameter 'target_error' is the error of an image: probes take spp "
                          "samples");
    }
    if (path->target_error > 0.0 && frame->camera && path->spp > path->max_spp) {
        return assay_fail(
            frame->context, ASSAY_ERR_ARGUMENT,
            "parameter 'spp' is %u, but 'max_spp' lets target_error take no more than "
            "%u samples a pixel",
            path->spp, path->max_spp);
    }
    return ASSAY_OK;
}

static int probe_columns(const void *state)
{
    return ((const assay_path_state *)state)->gradients ? ASSAY_PROBE_COLUMNS
                                                        : ASSAY_PROBE_COLUMNS_PLAIN;
}

static void destroy(void *state)
{
    if (state) {
        assay_release(((assay_path_state *)state)->context, state);
    }
}

const assay_method assay_method_path = {
    .name    = "path",
    .summary = "Unidirectional path tracing with multiple importance sampling: the ground truth.",
    .params  = PARAMS,
    .create  = create,
    .prepare = prepare,
    .render  = assay_path_render,
    .probe   = assay_path_probe,
    .probe_columns = probe_columns,
    .destroy       = destroy,
};
