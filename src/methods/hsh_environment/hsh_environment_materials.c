/* hsh_environment_materials.c - the grids of all materials that are seen. */
#include "core/alloc.h"
#include "core/context.h"
#include "methods/hsh_environment/hsh_environment.h"

static assay_status make_material(const hsh_environment *s, const assay_scene *scene,
                                  const assay_material *m, assay_material_grids *grids)
{
    const assay_material_grid_settings settings = {
        .basis = s->brdf, .side = s->side, .nodes = s->nodes};
    const char *problem = assay_material_grids_problem(m);
    if (problem) {
        return assay_fail(s->context, ASSAY_ERR_UNSUPPORTED,
                          "%s: material '%s' %s; hsh-environment needs one lobe a material "
                          "(--force-diffuse takes every surface as diffuse)",
                          scene->path, m->name ? m->name : "", problem);
    }
    return m->model == ASSAY_MATERIAL_UNLIT
               ? ASSAY_OK
               : assay_material_grids_create(s->context, &settings, m, grids);
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
        const uint32_t        index = scene->shapes[i].material;
        assay_material_grids *grids = &state->materials[index];
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
        assay_material_grids_release(&state->materials[i]);
    }
    assay_release(state->context, state->materials);
}
