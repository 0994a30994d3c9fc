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

/* Describes what the caches' light depends on (the scene: files, options, what its time makes of
 * it; bounces and secondary, order and gradients of coefficients), adds them, and finishes the
 * bundle.  Errors: WRITE, MEMORY. */
assay_status assay_cache_file_finish(const assay_frame *frame, const assay_cache_set *caches,
                                     assay_bundle *bundle);

/* Fills empty caches with saved records; on error they may only be destroyed.  Errors: ARGUMENT
 * (made for other light), NOT_FOUND, FORMAT, LIMIT, MEMORY. */
assay_status assay_cache_file_read(const assay_frame *frame, const assay_cache_set *caches,
                                   const char *path);

#endif
