/* cache_pair.c - materials are the same for all frames, caches may not be.
 *
 * Invariant: the radiance cache leans on the irradiance cache, so it comes after it and goes before
 * it; there is one only where a material asks for it. */
#include "methods/cache_pair.h"

#include "methods/cache_params.h"

static void drop_caches(assay_cache_pair *pair)
{
    assay_radiance_cache_destroy(pair->radiance);
    assay_irradiance_cache_destroy(pair->irradiance);
    pair->radiance   = NULL;
    pair->irradiance = NULL;
}

assay_status assay_cache_pair_read(assay_context *context, const char *method,
                                   const assay_params *params, assay_cache_pair *pair_out,
                                   assay_cached_image_settings *image_out)
{
    assay_cache_pair pair   = {.context = context};
    assay_status     status = assay_radiance_params_read(context, method, params, &pair.params);
    status                  = status
                                  ? status
                                  : assay_cache_params_read(context, params, &pair.params.cache.records, image_out);
    if (status == ASSAY_OK) {
        *pair_out = pair;
    }
    return status;
}

void assay_cache_pair_release(assay_cache_pair *pair)
{
    drop_caches(pair);
    glossy_materials_release(&pair->materials);
}

static assay_status make_caches(assay_cache_pair *pair, const assay_frame *frame)
{
    const assay_radiance_cache_settings *settings = &pair->params.cache;
    const assay_status status = assay_irradiance_cache_create(frame->world, &settings->records,
                                                              frame->seed, &pair->irradiance);
    return status || !pair->materials.any
               ? status
               : assay_radiance_cache_create(pair->context, pair->irradiance, settings,
                                             &pair->radiance);
}

assay_status assay_cache_pair_prepare(assay_cache_pair *pair, const assay_frame *frame)
{
    const assay_status status =
        pair->materials.grids ? ASSAY_OK
                              : assay_radiance_params_materials(pair->context, frame->world->scene,
                                                                &pair->params, &pair->materials);
    if (status != ASSAY_OK || frame->frames_before > 0) {
        return status;
    }
    drop_caches(pair);
    return make_caches(pair, frame);
}
