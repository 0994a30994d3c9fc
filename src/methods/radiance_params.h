/* radiance_params.h - the parameters of methods with radiance records. */
#ifndef ASSAY_METHODS_RADIANCE_PARAMS_H
#define ASSAY_METHODS_RADIANCE_PARAMS_H

#include "methods/glossy_materials.h"
#include "record/radiance_cache.h"

#define ASSAY_RADIANCE_MOST_ORDER 20

/* Rows of a parameter table, read by assay_radiance_params_read. */
/* clang-format off */
#define ASSAY_RADIANCE_PARAMS                                                                     \
    {"order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_RADIANCE_MOST_ORDER, NULL,                      \
     "Order n of radiance and BRDFs in hemispherical harmonics: n^2 coefficients.",               \
     "[gautron06] 4.7"},                                                                          \
    {"coefficient_gradient", ASSAY_PARAM_CHOICE, "", "walls", 0, 0, "none|points|walls",          \
     "Translational gradients of the coefficients: none, of points that keep their radiance, or " \
     "of walls that move before one another.",                                                    \
     "[krivanek05], [krivanek05b]"},                                                              \
    {"rotation", ASSAY_PARAM_CHOICE, "", "table", 0, 0,                                           \
     "exact|table|conversion|digon|analytical",                                                   \
     "How coefficients pass into the frame of another normal.", "[gautron06] 3.4"},               \
    {"rotation_steps", ASSAY_PARAM_INT, "", "16", 1, 1024, NULL,                                  \
     "Matrices between which rotation=table and digon interpolate, up to the largest tilt at "    \
     "which a record counts.",                                                                    \
     "[gautron06] 3.4.2"},                                                                        \
    {"sh_order", ASSAY_PARAM_INT, "", "15", 1, ASSAY_BASIS_MAX_ORDER, NULL,                       \
     "Order of the spherical harmonics of rotation=conversion.", "[gautron06] 3.4.1"},            \
    {"glossy_accuracy", ASSAY_PARAM_REAL, "", "0.97", 0, 1, NULL,                                 \
     "A glossy material is cached where the order holds this share of its lobe's energy at 45 "   \
     "degrees, else it gets paths.",                                                              \
     "[gautron06] eq. 3.32"},                                                                     \
    {"grid", ASSAY_PARAM_INT, "texels", "32", 2, 512, NULL,                                       \
     "Side of the paraboloid grid of outgoing directions.", "[gautron06] eq. 3.35, 3.36"},        \
    {"nodes", ASSAY_PARAM_INT, "", "48", 8, 512, NULL,                                            \
     "Gauss nodes in the polar angle (twice as many in azimuth) for a BRDF's coefficients.",      \
     "[gautron06] eq. 3.34"}
/* clang-format on */

typedef struct {
    const char                   *method; /* in whose name messages speak; borrowed */
    assay_radiance_cache_settings cache;  /* but its records, which assay_cache_params_read reads */
    assay_material_grid_settings  grid;   /* without its basis */
    double                        accuracy;
} assay_radiance_params;

/* What the rows above say; params have those of ASSAY_CACHE_PARAMS, too.  Errors: ARGUMENT (a grid
 * that takes hours; gradients that gathering does not have). */
assay_status assay_radiance_params_read(assay_context *context, const char *method,
                                        const assay_params    *params,
                                        assay_radiance_params *radiance_out);

/* The lobes of the scene's materials in the basis of such a cache, which comes only where it is
 * needed: its rotations may take seconds.  Errors: MEMORY, CANCELLED. */
assay_status assay_radiance_params_materials(assay_context *context, const assay_scene *scene,
                                             const assay_radiance_params *radiance,
                                             glossy_materials            *materials_out);

#endif
