/* record_bundle.h - irradiance records as arrays of a bundle (docs/bundle.md), row by row in the
 * order in which they were made. */
#ifndef ASSAY_RECORD_RECORD_BUNDLE_H
#define ASSAY_RECORD_RECORD_BUNDLE_H

#include "io/bundle.h"
#include "io/bundle_read.h"
#include "record/record_store.h"

/* Adds PREFIX/position, PREFIX/normal, ...  Errors: WRITE, MEMORY. */
assay_status assay_record_bundle_add(assay_context *context, assay_bundle *bundle,
                                     const char *prefix, const assay_record_store *store);

/* Whether the bundle has records of this prefix. */
bool assay_record_bundle_is_there(const assay_bundle_reader *reader, const char *prefix);

/* Adds the records of a bundle to a store.  rows: how many they must be; SIZE_MAX: any number.
 * Errors: those of assay_bundle_read_table; FORMAT (a record that cannot be). */
assay_status assay_record_bundle_read(assay_context *context, assay_bundle_reader *reader,
                                      const char *prefix, size_t rows, assay_record_store *store);

#endif
