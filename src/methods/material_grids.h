/* material_grids.h - materials' BRDFs as coefficients, for the methods that meet light in a basis.
 */
#ifndef ASSAY_METHODS_MATERIAL_GRIDS_H
#define ASSAY_METHODS_MATERIAL_GRIDS_H

#include "assay/basis.h"
#include "methods/method.h"
#include "trace/vertex.h"

enum { ASSAY_MATERIAL_CHANNELS = 3 };

/* How grids are made. */
typedef struct {
    const assay_basis *basis; /* of the hemisphere, or SH continued by 0; outlives the grids */
    int                side; /* of the paraboloid grid of outgoing directions                     */
    int  nodes;              /* Gauss nodes in the polar angle; twice as many in azimuth          */
    bool beyond_lambert; /* f less the Lambertian of assay_bsdf_view_lambert, in place of f    */
} assay_material_grid_settings;

/* A material's BRDF times cosine, as coefficients over wi for a grid of wo.  Every model here is
 * affine in the base colour: f = black + base_color * slope, slope being grey.  Zeros: no grids. */
typedef struct {
    assay_brdf_grid *black[ASSAY_MATERIAL_CHANNELS]; /* base colour 0; channels may share one */
    assay_brdf_grid *slope;                          /* base colour 1 less base colour 0      */
} assay_material_grids;

/* Whether a grid can be waited for: ARGUMENT, in terms of the parameters 'grid', 'nodes' and
 * 'order', where it takes hours. */
assay_status assay_material_grids_check_work(assay_context *context, int side, int nodes,
                                             int order);

/* NULL, or why the material has no grid (its lobe changes from point to point, it passes light or
 * is a perfect mirror), in words that follow its name: "transmits light". */
const char *assay_material_grids_problem(const assay_material *material);

/* Whether both materials, without such a problem, have the very same grids: they differ in base
 * colour at most. */
bool assay_material_grids_same(const assay_material *a, const assay_material *b);

/* Of a material without such a problem.  Errors: MEMORY, CANCELLED. */
assay_status assay_material_grids_create(assay_context                      *context,
                                         const assay_material_grid_settings *settings,
                                         const assay_material               *material,
                                         assay_material_grids               *grids_out);
void         assay_material_grids_release(assay_material_grids *grids);

/* The share of the lobe's energy that each order of the basis captures ([gautron06] eq. 3.32), for
 * the material's own base colour, grey, seen from wo: accuracy_out[order - 1] for 1 ... the order
 * of the basis, which is of the hemisphere.  1 where there is no lobe at all; 0 where
 * ASSAY_LOBE_NODES nodes do not resolve it. settings->side and nodes are not used.  Errors: MEMORY.
 */
#define ASSAY_LOBE_NODES 256
assay_status assay_material_grids_accuracy(assay_context                      *context,
                                           const assay_material_grid_settings *settings,
                                           const assay_material *material, assay_vec3 wo,
                                           double *accuracy_out);

/* The local frame on the viewer's side: right-handed, z towards the viewer. */
assay_frame3 assay_material_frame(const assay_vertex *vertex);

/* What the vertex reflects towards its wo of light in that frame (3 rows of the basis's count),
 * scratch: count.  0 where the material has no grids or wo is on the horizon.  Errors: DOMAIN. */
assay_status assay_material_grids_reflect(const assay_material_grids *grids, size_t count,
                                          const assay_vertex *vertex, const double *light,
                                          double *scratch, assay_rgb *radiance_out);

/* The coefficients of f cos themselves, 3 rows of count, in the frame of assay_material_frame, for
 * this base colour and wo in that frame; scratch: count.  0 where wo is on the horizon.  Errors:
 * DOMAIN. */
assay_status assay_material_grids_brdf(const assay_material_grids *grids, size_t count,
                                       assay_rgb base_color, assay_vec3 wo, double *scratch,
                                       double *coefficients_out);

#endif
