/* hsh_environment.c - parameters, and what is prepared once a frame: the environment in SH, the
 * conversion to HSH, the materials' grids. */
#include "methods/hsh_environment/hsh_environment.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "scene/environment.h"

static const assay_param_desc PARAMS[] = {
    {"spp", ASSAY_PARAM_INT, "samples", "16", 1, 1e9, NULL,
     "Camera rays a pixel: they smooth edges, the light itself has no noise.", ""},
    {"order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL,
     "Order n of the BRDFs' representation: n^2 coefficients.", "[gautron06] 3.5.3"},
    {"sh_order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL,
     "Order of the environment's spherical harmonics.", "[gautron06] 3.5.3"},
    {"brdf_basis", ASSAY_PARAM_CHOICE, "", "hsh", 0, 0, "hsh|sh",
     "Basis of the BRDFs: hemispherical harmonics, or spherical ones as table 3.1 compares.",
     "[gautron06] table 3.1"},
    {"grid", ASSAY_PARAM_INT, "texels", "32", 2, 512, NULL,
     "Side of the paraboloid grid of outgoing directions.", "[gautron06] eq. 3.35, 3.36"},
    {"nodes", ASSAY_PARAM_INT, "", "48", 8, 512, NULL,
     "Gauss nodes in the polar angle (twice as many in azimuth) for a BRDF's coefficients.",
     "[gautron06] eq. 3.34"},
    {0},
};

static void destroy(void *user)
{
    hsh_environment *state = user;
    if (state) {
        hsh_environment_drop_materials(state);
        assay_sparse_destroy(state->to_brdf);
        assay_basis_destroy(state->brdf);
        assay_basis_destroy(state->sh);
        assay_release(state->context, state->light);
        assay_release(state->context, state->cosine);
        assay_release(state->context, state);
    }
}

static assay_status make_bases(hsh_environment *s)
{
    const assay_basis_kind kind   = s->brdf_in_sh ? ASSAY_BASIS_SH : ASSAY_BASIS_HSH;
    assay_status           status = assay_basis_create(s->context, ASSAY_BASIS_SH, s->sh_order,
                                                       ASSAY_CONVENTION_THESIS, &s->sh);
    if (status == ASSAY_OK) {
        status = assay_basis_create(s->context, kind, s->order, ASSAY_CONVENTION_THESIS, &s->brdf);
    }
    if (status == ASSAY_OK && !s->brdf_in_sh) {
        status = assay_basis_conversion(s->context, s->sh, s->brdf, &s->to_brdf);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t count = assay_basis_count(s->sh);
    s->light  = assay_allocate(s->context, HSH_ENVIRONMENT_CHANNELS * count, sizeof *s->light);
    s->cosine = assay_allocate(s->context, (size_t)s->sh_order, sizeof *s->cosine);
    if (!s->light || !s->cosine) {
        return assay_fail_memory(s->context, "an environment's coefficients");
    }
    return assay_clamped_cosine(s->sh_order, s->cosine);
}

static assay_status create(assay_context *context, const assay_params *params, void **state_out)
{
    hsh_environment *state = assay_allocate(context, 1, sizeof *state);
    if (!state) {
        return assay_fail_memory(context, "the method hsh-environment");
    }
    *state = (hsh_environment){
        .context    = context,
        .spp        = (uint32_t)assay_params_int(params, "spp"),
        .order      = assay_params_int(params, "order"),
        .sh_order   = assay_params_int(params, "sh_order"),
        .side       = assay_params_int(params, "grid"),
        .nodes      = assay_params_int(params, "nodes"),
        .brdf_in_sh = assay_params_choice(params, "brdf_basis") == 1,
    };
    assay_status status =
        assay_material_grids_check_work(context, state->side, state->nodes, state->order);
    if (status == ASSAY_OK && state->brdf_in_sh && state->order > state->sh_order) {
        status =
            assay_fail(context, ASSAY_ERR_ARGUMENT,
                       "parameter 'order' is %d, but with brdf_basis=sh there are only 'sh_order' "
                       "= %d bands of light to meet it",
                       state->order, state->sh_order);
    }
    if (status == ASSAY_OK) {
        status = make_bases(state);
    }
    if (status != ASSAY_OK) {
        destroy(state);
        return status;
    }
    *state_out = state;
    return ASSAY_OK;
}

/* A constant radiance has one coefficient: sqrt(4 pi) times it. */
static void project_background(hsh_environment *s, assay_rgb radiance)
{
    const size_t count  = assay_basis_count(s->sh);
    const double one    = sqrt(4.0 * ASSAY_PI);
    s->light[0]         = one * radiance.r;
    s->light[count]     = one * radiance.g;
    s->light[2 * count] = one * radiance.b;
}

static assay_status project_map(hsh_environment *s, const assay_scene *scene)
{
    const size_t values = HSH_ENVIRONMENT_CHANNELS * assay_basis_count(s->sh);
    const double scale  = assay_environment_scale(scene->environment);
    assay_image *map    = NULL;
    assay_status status = assay_environment_image(scene->environment, &map);
    if (status == ASSAY_OK) {
        status = assay_basis_project_environment(s->sh, map, scene->options.environment_rotation,
                                                 s->light);
    }
    for (size_t i = 0; i < values && status == ASSAY_OK; i++) {
        s->light[i] *= scale;
    }
    assay_image_destroy(map);
    return status;
}

static assay_status dump(const hsh_environment *s, const assay_frame *frame)
{
    const size_t count  = assay_basis_count(s->sh);
    assay_array *table  = NULL;
    assay_status status = assay_array_create(s->context, HSH_ENVIRONMENT_CHANNELS, count, &table);
    if (status == ASSAY_OK) {
        for (size_t i = 0; i < HSH_ENVIRONMENT_CHANNELS * count; i++) {
            assay_array_data(table)[i] = s->light[i];
        }
        status = assay_bundle_add_table(frame->dump, "environment/sh", "W/m2", table);
    }
    assay_array_destroy(table);
    return status;
}

static void warn_of_emitters(const hsh_environment *s, const assay_scene *scene)
{
    bool emits = scene->punctual_count > 0;
    for (uint32_t i = 0; i < scene->shape_count && !emits; i++) {
        emits = assay_material_emits(&scene->materials[scene->shapes[i].material]);
    }
    if (emits) {
        assay_inform(
            s->context, ASSAY_LOG_WARNING,
            "%s: has lights of its own; hsh-environment shows those that are surfaces, but "
            "nothing is lit by them",
            scene->path);
    }
}

static assay_status prepare(void *user, const assay_frame *frame)
{
    hsh_environment   *s      = user;
    const assay_scene *scene  = frame->world->scene;
    assay_status       status = ASSAY_OK;
    if (scene->environment) {
        status = project_map(s, scene);
    } else {
        project_background(s, scene->options.background);
        if (rgb_is_black(scene->options.background)) {
            assay_inform(s->context, ASSAY_LOG_WARNING,
                         "%s: has no environment map and no background: hsh-environment shows "
                         "emission alone",
                         scene->path);
        }
    }
    warn_of_emitters(s, scene);
    if (status == ASSAY_OK && frame->dump) {
        status = dump(s, frame);
    }
    return status == ASSAY_OK ? hsh_environment_make_materials(s, scene) : status;
}

const assay_method assay_method_hsh_environment = {
    .name = "hsh-environment",
    .summary =
        "Environment in spherical harmonics on BRDFs in hemispherical ones, without shadows.",
    .params  = PARAMS,
    .create  = create,
    .prepare = prepare,
    .render  = hsh_environment_render,
    .destroy = destroy,
};
