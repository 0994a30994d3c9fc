/* cache_pair.h - what methods with radiance records work on: an irradiance cache, a radiance cache
 * beside it where a material is within reach, and the lobes of such materials. */
#ifndef ASSAY_METHODS_CACHE_PAIR_H
#define ASSAY_METHODS_CACHE_PAIR_H

#include "methods/cached_image.h"
#include "methods/radiance_params.h"

typedef struct {
    assay_context          *context;
    assay_radiance_params   params;
    glossy_materials        materials;
    assay_irradiance_cache *irradiance; /* NULL before the first frame       */
    assay_radiance_cache   *radiance;   /* NULL: no material is within reach */
} assay_cache_pair;

/* Reads the rows of ASSAY_RADIANCE_PARAMS and ASSAY_CACHE_PARAMS; there are no caches yet, and
 * until there are params.cache may still be changed.  method: as in assay_radiance_params_read.
 * Zeros are a pair that may be released.  Errors: ARGUMENT. */
assay_status assay_cache_pair_read(assay_context *context, const char *method,
                                   const assay_params *params, assay_cache_pair *pair_out,
                                   assay_cached_image_settings *image_out);
void         assay_cache_pair_release(assay_cache_pair *pair);

/* For a frame: lobes, once; new caches, empty, unless those of the frame before go on.  Errors:
 * ARGUMENT, MEMORY, CANCELLED. */
assay_status assay_cache_pair_prepare(assay_cache_pair *pair, const assay_frame *frame);

#endif
