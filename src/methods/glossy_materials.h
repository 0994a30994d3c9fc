/* glossy_materials.h - which materials a radiance cache can serve, and their lobes as coefficients.
 */
#ifndef ASSAY_METHODS_GLOSSY_MATERIALS_H
#define ASSAY_METHODS_GLOSSY_MATERIALS_H

#include "methods/material_grids.h"

/* Lobes of all materials in use, less their Lambertians. */
typedef struct {
    assay_context        *context;
    assay_material_grids *grids; /* a material; zeros: not within reach; some share one */
    uint32_t              count;
    bool                  any; /* within reach */
} glossy_materials;

/* A material is within reach where the basis captures `accuracy` of its lobe's energy as seen at 45
 * degrees, in the planes of both axes.  Tells what became of each glossy one, in the name of the
 * method.  Errors: MEMORY, CANCELLED. */
assay_status glossy_materials_make(assay_context *context, const char *method,
                                   const assay_scene                  *scene,
                                   const assay_material_grid_settings *settings, double accuracy,
                                   glossy_materials *materials_out);
void         glossy_materials_release(glossy_materials *materials);

/* NULL where the vertex has nothing beyond a Lambertian, or is out of reach. */
static inline const assay_material_grids *glossy_materials_at(const glossy_materials *materials,
                                                              const assay_vertex     *vertex)
{
    const assay_material_grids *grids = &materials->grids[vertex->surface.material];
    return grids->slope ? grids : NULL;
}

#endif
