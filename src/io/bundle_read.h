/* bundle_read.h - what bundle.h wrote, judged before it is believed. */
#ifndef ASSAY_IO_BUNDLE_READ_H
#define ASSAY_IO_BUNDLE_READ_H

#include "assay/array.h"

typedef struct assay_bundle_reader assay_bundle_reader;

/* Errors: NOT_FOUND, FORMAT (no manifest of a bundle, or of another version), LIMIT, MEMORY. */
assay_status assay_bundle_open(assay_context *context, const char *path,
                               assay_bundle_reader **reader_out);
void         assay_bundle_close(assay_bundle_reader *reader);

/* Its folder, for messages. */
const char *assay_bundle_path(const assay_bundle_reader *reader);

/* A text at the top of the manifest; borrowed; NULL where there is none. */
const char *assay_bundle_text(const assay_bundle_reader *reader, const char *key);

/* Whether the manifest lists an array of this name. */
bool assay_bundle_lists(const assay_bundle_reader *reader, const char *name);

/* A table of the manifest.  columns: that it must have; rows: likewise, SIZE_MAX for any.
 * Errors: FORMAT (not listed, not of that shape, or its file is not the one that was listed),
 * NOT_FOUND, LIMIT, MEMORY. */
assay_status assay_bundle_read_table(assay_bundle_reader *reader, const char *name, size_t rows,
                                     size_t columns, assay_array **table_out);

#endif
