/* splat_gloss.h - what radiance records say of a glossy pixel: dot products of coefficients of
 * radiance and of the BRDF that the pixel shows ([gautron06] 4.2, eq. 2.11). */
#ifndef ASSAY_METHODS_SPLAT_GLOSS_H
#define ASSAY_METHODS_SPLAT_GLOSS_H

#include "methods/glossy_materials.h"
#include "record/radiance_cache.h"
#include "record/splat.h"

typedef struct splat_gloss splat_gloss;

/* The cache is borrowed.  Errors: MEMORY. */
assay_status splat_gloss_create(assay_context *context, size_t pixels, assay_radiance_cache *cache,
                                splat_gloss **gloss_out);
void         splat_gloss_destroy(splat_gloss *gloss);

/* Before the pixels of a sweep are set. */
void splat_gloss_begin(splat_gloss *gloss);
/* What a pixel shows; grids outlive the sweep. */
void splat_gloss_set(splat_gloss *gloss, size_t pixel, const assay_material_grids *grids,
                     const assay_vertex *vertex);

/* What was set: the frame of the BRDF (assay_material_frame), wo in it, and the base colour. */
void splat_gloss_get(const splat_gloss *gloss, size_t pixel, assay_frame3 *frame_out,
                     assay_vec3 *wo_out, assay_rgb *base_color_out);

/* And the grids of its material. */
const assay_material_grids *splat_gloss_grids(const splat_gloss *gloss, size_t pixel);

/* Of a splat source, whose user is the gloss. */
assay_status splat_gloss_say(void *user, const assay_splat_place *place, uint32_t record,
                             assay_rgb *said_out);

#endif
