/* radiance_bundle.h - radiance records as arrays of a bundle (docs/bundle.md): those of
 * record_bundle.h, and a row of coefficients and of gradients a record. */
#ifndef ASSAY_RECORD_RADIANCE_BUNDLE_H
#define ASSAY_RECORD_RADIANCE_BUNDLE_H

#include "io/bundle.h"
#include "io/bundle_read.h"
#include "record/radiance_cache.h"

/* Adds PREFIX/position, ..., PREFIX/coefficients and, where the cache has them,
 * PREFIX/coefficient_gradient.  Errors: WRITE, MEMORY. */
assay_status assay_radiance_bundle_add(assay_context *context, assay_bundle *bundle,
                                       const char *prefix, assay_radiance_cache *cache);

/* Adds the records of a bundle to an empty cache of the same order, which has gradients if and only
 * if they have; on error it may only be destroyed.  Errors: those of assay_bundle_read_table;
 * FORMAT (a record that cannot be). */
assay_status assay_radiance_bundle_read(assay_context *context, assay_bundle_reader *reader,
                                        const char *prefix, assay_radiance_cache *cache);

#endif
