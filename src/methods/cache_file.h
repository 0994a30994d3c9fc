/* cache_file.h - irradiance caches as bundles, for another view of the same scene. */
#ifndef ASSAY_METHODS_CACHE_FILE_H
#define ASSAY_METHODS_CACHE_FILE_H

#include "io/bundle.h"
#include "methods/method.h"
#include "record/irradiance_cache.h"

/* Adds the records of all levels to a bundle: records/..., records.1/... of the next level. */
assay_status assay_cache_file_add(assay_context *context, assay_bundle *bundle,
                                  assay_irradiance_cache *cache);

/* Begins a bundle that holds a cache, with what its light depends on: the scene (files, options,
 * time), bounces and secondary.  Made before the work, so that a bad path is known at once; to be
 * completed by assay_cache_file_add and assay_bundle_finish. */
assay_status assay_cache_file_create(const assay_frame                     *frame,
                                     const assay_irradiance_cache_settings *settings,
                                     const char *path, assay_bundle **bundle_out);

/* Fills an empty cache with saved records.  Errors: ARGUMENT (made for other light), NOT_FOUND,
 * FORMAT, LIMIT, MEMORY. */
assay_status assay_cache_file_read(const assay_frame                     *frame,
                                   const assay_irradiance_cache_settings *settings,
                                   const char *path, assay_irradiance_cache *cache);

#endif
