/* hsh_environment.h - the method `hsh-environment`: light from infinitely far in SH, BRDFs in HSH
 * [gautron06] 3.5.3.  docs/methods/hsh-environment.md. */
#ifndef ASSAY_METHODS_HSH_ENVIRONMENT_H
#define ASSAY_METHODS_HSH_ENVIRONMENT_H

#include "assay/basis.h"
#include "methods/material_grids.h"

extern const assay_method assay_method_hsh_environment;

enum { HSH_ENVIRONMENT_CHANNELS = ASSAY_MATERIAL_CHANNELS };

typedef struct {
    assay_context *context;

    /* parameters */
    uint32_t spp;
    int      order, sh_order, side, nodes;
    bool     brdf_in_sh;

    assay_basis          *sh, *brdf; /* of the environment, and of the BRDFs           */
    assay_sparse         *to_brdf;   /* C: SH to HSH; NULL where BRDFs are in SH       */
    double               *light;     /* 3 rows of sh's count: the environment, world   */
    double               *cosine;    /* sh_order: A_l of the clamped cosine            */
    assay_material_grids *materials; /* of each material that is seen; zeros for others */
    uint32_t              material_count;
} hsh_environment;

/* Grids of all materials in use.  Errors: UNSUPPORTED (a material that changes its lobe from point
 * to point, passes light or is a perfect mirror, with its name), MEMORY, CANCELLED. */
assay_status hsh_environment_make_materials(hsh_environment *state, const assay_scene *scene);
void         hsh_environment_drop_materials(hsh_environment *state);

assay_status hsh_environment_render(void *state, const assay_frame *frame, assay_film *film,
                                    assay_ray_counts *counts);

#endif
