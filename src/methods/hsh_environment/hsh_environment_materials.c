/* hsh_environment_materials.c - BRDFs as coefficients.
 *
 * Invariant: a grid belongs to a material, not to a point: what a texture may change is the base
 * colour alone, in which every model is affine.  All else that varies is refused by name. */
#include "core/alloc.h"
#include "core/context.h"
#include "methods/hsh_environment/hsh_environment.h"
#include "trace/vertex.h"

/* A grid's texels on the horizon stand for directions this far above it: BRDFs end there. */
static const double LOWEST = 0x1p-10;

typedef struct {
    assay_bsdf black, white; /* base colour 0 and 1                */
    int        channel;      /* of black; -1: white less black, G  */
} lobe_source;

static double channel_of(assay_rgb c, int channel)
{
    return channel == 0 ? c.r : channel == 1 ? c.g : c.b;
}

/* Only reads its source, as threads share it. */
static double evaluate(void *user, assay_vec3 wo, assay_vec3 wi)
{
    const lobe_source *source = user;
    if (wo.z < LOWEST) {
        const double scale = sqrt((1.0 - LOWEST * LOWEST) / (wo.x * wo.x + wo.y * wo.y));
        wo                 = vec3(wo.x * scale, wo.y * scale, LOWEST);
    }
    const assay_rgb black = assay_bsdf_evaluate(&source->black, wo, wi).value;
    if (source->channel >= 0) {
        return channel_of(black, source->channel);
    }
    return assay_bsdf_evaluate(&source->white, wo, wi).value.g - black.g;
}

static assay_status refuse(const assay_scene *scene, const assay_material *material,
                           const char *what)
{
    return assay_fail(scene->context, ASSAY_ERR_UNSUPPORTED,
                      "%s: material '%s' %s; hsh-environment needs one lobe a material "
                      "(--force-diffuse takes every surface as diffuse)",
                      scene->path, material->name ? material->name : "", what);
}

static assay_status check(const assay_scene *scene, const assay_material *m)
{
    if (m->model != ASSAY_MATERIAL_PBR) {
        return ASSAY_OK;
    }
    if (m->transmission > 0.0) {
        return refuse(scene, m, "transmits light");
    }
    if (m->metallic_roughness_texture.texture != ASSAY_NONE) {
        return refuse(scene, m, "has a texture of metallic and roughness");
    }
    if (m->specular_texture.texture != ASSAY_NONE ||
        m->specular_color_texture.texture != ASSAY_NONE) {
        return refuse(scene, m, "has a texture of its specular reflection");
    }
    if (m->roughness * m->roughness < ASSAY_ALPHA_MIN) {
        return refuse(scene, m, "is a perfect mirror");
    }
    return ASSAY_OK;
}

static assay_bsdf bsdf_with(const assay_material *material, double base)
{
    const assay_surface_material at = {
        .base_color      = rgb_grey(base),
        .coverage        = 1.0,
        .metallic        = material->metallic,
        .roughness       = material->roughness,
        .transmission    = 0.0,
        .specular_factor = material->specular_factor,
        .specular_color  = material->specular_color,
    };
    return assay_vertex_bsdf(material, &at);
}

static assay_status make_grid(const hsh_environment *s, lobe_source *source, int channel,
                              assay_brdf_grid **grid_out)
{
    source->channel = channel;
    return assay_brdf_grid_create_parallel(s->brdf, s->context, evaluate, source, s->side, s->nodes,
                                           2 * s->nodes, grid_out);
}

static assay_status make_material(const hsh_environment *s, const assay_scene *scene,
                                  const assay_material *material, material_grids *grids)
{
    assay_status status = check(scene, material);
    if (status != ASSAY_OK || material->model == ASSAY_MATERIAL_UNLIT) {
        return status;
    }
    lobe_source     source = {bsdf_with(material, 0.0), bsdf_with(material, 1.0), 0};
    const assay_rgb tint   = material->specular_color;
    status                 = make_grid(s, &source, -1, &grids->slope);
    for (int c = 0; c < HSH_ENVIRONMENT_CHANNELS && status == ASSAY_OK; c++) {
        if (c > 0 && channel_of(tint, c) == channel_of(tint, c - 1)) {
            grids->black[c] = grids->black[c - 1];
        } else {
            status = make_grid(s, &source, c, &grids->black[c]);
        }
    }
    return status;
}

assay_status hsh_environment_make_materials(hsh_environment *state, const assay_scene *scene)
{
    if (state->materials) {
        return ASSAY_OK; /* materials do not change from frame to frame */
    }
    state->materials =
        assay_allocate(state->context, scene->material_count, sizeof *state->materials);
    if (!state->materials) {
        return assay_fail_memory(state->context, "BRDFs in harmonics");
    }
    state->material_count = scene->material_count;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const uint32_t  index = scene->shapes[i].material;
        material_grids *grids = &state->materials[index];
        if (!grids->slope) {
            const assay_status status =
                make_material(state, scene, &scene->materials[index], grids);
            if (status != ASSAY_OK) {
                return status;
            }
        }
    }
    return ASSAY_OK;
}

void hsh_environment_drop_materials(hsh_environment *state)
{
    for (uint32_t i = 0; i < state->material_count; i++) {
        material_grids *grids = &state->materials[i];
        assay_brdf_grid_destroy(grids->slope);
        for (int c = HSH_ENVIRONMENT_CHANNELS - 1; c >= 0; c--) {
            if (c == 0 || grids->black[c] != grids->black[c - 1]) {
                assay_brdf_grid_destroy(grids->black[c]);
            }
        }
    }
    assay_release(state->context, state->materials);
}
