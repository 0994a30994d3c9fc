/* bundle_read.h - what bundle.h wrote, judged before it is believed. */
#ifndef ASSAY_IO_BUNDLE_READ_H
#define ASSAY_IO_BUNDLE_READ_H

#include <stdbool.h>

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

/* ---- bundles that others wrote ---- */

/* Longest name of an array, and its NUL. */
#define ASSAY_BUNDLE_NAME 96

/* What the manifest says of an array; texts are borrowed. */
typedef struct {
    const char *name, *file, *unit, *dtype;
    const char *digest; /* SHA-256 of its file; NULL: none is listed */
    bool        image;  /* .exr, else .npy                           */
    size_t      dimensions, shape[3];
} assay_bundle_entry;

int assay_bundle_count(const assay_bundle_reader *reader);
/* Errors: FORMAT (no name or one that is no file's in the folder; no file, unit, dtype or shape).
 */
assay_status assay_bundle_entry_at(const assay_bundle_reader *reader, int index,
                                   assay_bundle_entry *entry_out);
/* Whether the manifest lists an array of this name, whatever else it says of it. */
bool assay_bundle_has(const assay_bundle_reader *reader, const char *name);
/* Errors: as above; FORMAT (not listed). */
assay_status assay_bundle_entry_of(const assay_bundle_reader *reader, const char *name,
                                   assay_bundle_entry *entry_out);

/* All that stands at the top of the manifest: its key; *value_out is NULL where it is no text. */
int         assay_bundle_text_count(const assay_bundle_reader *reader);
const char *assay_bundle_text_at(const assay_bundle_reader *reader, int index,
                                 const char **value_out);

/* An array of any kind: a table as it is; of an image a row a pixel, row by row from the top left,
 * with the channels named ("R G B"; NULL: all, by name) as columns.  Errors: FORMAT (the file is
 * not what the manifest lists: digest, shape, dtype, channels), NOT_FOUND, UNSUPPORTED, LIMIT,
 * MEMORY. */
assay_status assay_bundle_read_array(const assay_bundle_reader *reader, const char *name,
                                     const char *channels, assay_array **table_out);

#endif
