/* radiance_params.c - from parameters to the settings of a radiance cache. */
#include "methods/radiance_params.h"

#include <string.h>

#include "core/context.h"

assay_status assay_radiance_params_read(assay_context *context, const char *method,
                                        const assay_params    *params,
                                        assay_radiance_params *radiance_out)
{
    const assay_radiance_params r = {
        .method = method,
        .cache =
            {
                .order = assay_params_int(params, "order"),
                .gradient =
                    (assay_coefficient_gradient)assay_params_choice(params, "coefficient_gradient"),
                .rotation       = (assay_hsh_rotation_way)assay_params_choice(params, "rotation"),
                .rotation_steps = assay_params_int(params, "rotation_steps"),
                .sh_order       = assay_params_int(params, "sh_order"),
            },
        .grid     = {.side           = assay_params_int(params, "grid"),
                     .nodes          = assay_params_int(params, "nodes"),
                     .beyond_lambert = true},
        .accuracy = assay_params_real(params, "glossy_accuracy"),
    };
    if (r.cache.gradient == ASSAY_COEFFICIENT_GRADIENT_POINTS &&
        strcmp(assay_params_text(params, "gather"), "raster") == 0) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "parameter 'coefficient_gradient' is points, which gather=raster does "
                          "not have");
    }
    const assay_status status =
        assay_material_grids_check_work(context, r.grid.side, r.grid.nodes, r.cache.order);
    if (status == ASSAY_OK) {
        *radiance_out = r;
    }
    return status;
}

assay_status assay_radiance_params_materials(assay_context *context, const assay_scene *scene,
                                             const assay_radiance_params *radiance,
                                             glossy_materials            *materials_out)
{
    assay_material_grid_settings grid  = radiance->grid;
    assay_basis                 *basis = NULL;
    assay_status status = assay_basis_create(context, ASSAY_BASIS_HSH, radiance->cache.order,
                                             ASSAY_CONVENTION_THESIS, &basis);
    grid.basis          = basis;
    status              = status ? status
                                 : glossy_materials_make(context, radiance->method, scene, &grid,
                                                         radiance->accuracy, materials_out);
    assay_basis_destroy(basis);
    return status;
}
