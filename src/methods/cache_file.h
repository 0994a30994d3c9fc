/* cache_file.h - caches as bundles, for another view of the same scene. */
#ifndef ASSAY_METHODS_CACHE_FILE_H
#define ASSAY_METHODS_CACHE_FILE_H

#include "io/bundle.h"
#include "methods/method.h"
#include "record/radiance_cache.h"

/* The caches that a method has; borrows all. */
typedef struct {
    const assay_irradiance_cache_settings *settings;
    const assay_radiance_cache_settings   *glossy; /* NULL: a method without radiance records    */
    assay_irradiance_cache                *irradiance;
    assay_radiance_cache                  *radiance; /* NULL: none                               */
} assay_cache_set;

/* Adds the records of all levels to a bundle: records/..., records.1/... of the next level, and
 * radiance_records/... */
assay_status assay_cache_file_add(assay_context *context, assay_bundle *bundle,
                                  const assay_cache_set *caches);

/* Begins a bundle that holds caches, with what their light depends on: the scene (files, options,
 * time), bounces and secondary, order and gradients of coefficients.  Made before the work, so that
 * a bad path is known at once; to be completed by assay_cache_file_add and assay_bundle_finish. */
assay_status assay_cache_file_create(const assay_frame *frame, const assay_cache_set *caches,
                                     const char *path, assay_bundle **bundle_out);

/* Fills empty caches with saved records; on error they may only be destroyed.  Errors: ARGUMENT
 * (made for other light), NOT_FOUND, FORMAT, LIMIT, MEMORY. */
assay_status assay_cache_file_read(const assay_frame *frame, const assay_cache_set *caches,
                                   const char *path);

#endif
