/* bundle.h - a folder of named arrays and a manifest, that any language can read.
 *
 *     DIR/manifest.json       {"format": "assay-bundle", "version": 1, "tool": ..., "arrays":
 * [...]} DIR/gbuffer/position.exr
 *
 * Each array is listed with name, file, unit, shape, dtype and the SHA-256 of its file.  The folder
 * is made beside its name and renamed at the end: it is there whole or not at all. */
#ifndef ASSAY_IO_BUNDLE_H
#define ASSAY_IO_BUNDLE_H

#include "assay/array.h"
#include "assay/image.h"

typedef struct assay_bundle assay_bundle;

/* Errors: WRITE (the folder cannot be made, or something of that name is there already: nothing is
 * ever replaced), MEMORY. */
assay_status assay_bundle_create(assay_context *context, const char *path,
                                 assay_bundle **bundle_out);

/* A text at the top of the manifest ("method", "path"). */
assay_status assay_bundle_describe(assay_bundle *bundle, const char *key, const char *value);

/* Adds an array as NAME.exr or NAME.npy; the name may hold '/': "gbuffer/position". */
assay_status assay_bundle_add_image(assay_bundle *bundle, const char *name, const char *unit,
                                    const assay_image *image);
assay_status assay_bundle_add_table(assay_bundle *bundle, const char *name, const char *unit,
                                    const assay_array *table);

/* Writes the manifest and gives the folder its name.  Errors: WRITE, MEMORY. */
assay_status assay_bundle_finish(assay_bundle *bundle);

/* Removes what was not finished.  NULL is legal. */
void assay_bundle_destroy(assay_bundle *bundle);

#endif
