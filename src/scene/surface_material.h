/* surface_material.h - what surface.c and surface_material.c share. */
#ifndef ASSAY_SCENE_SURFACE_MATERIAL_H
#define ASSAY_SCENE_SURFACE_MATERIAL_H

#include "scene/material.h"

static inline double assay_clamp_unit(double x) { return !(x > 0.0) ? 0.0 : x < 1.0 ? x : 1.0; }

/* Part of the surface that is there, [0, 1], from its alpha. */
static inline double assay_material_coverage(const assay_material *material, double alpha)
{
    if (material->alpha_mode == ASSAY_ALPHA_OPAQUE || material->model == ASSAY_MATERIAL_LAMBERT) {
        return 1.0;
    }
    if (material->alpha_mode == ASSAY_ALPHA_MASK) {
        return alpha >= material->alpha_cutoff ? 1.0 : 0.0;
    }
    return assay_clamp_unit(alpha);
}

#endif
