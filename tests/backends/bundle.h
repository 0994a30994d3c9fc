/* bundle.h - stage bundles, in and out: a folder with manifest.json and a file an array. */
#ifndef BACKEND_BUNDLE_H
#define BACKEND_BUNDLE_H

#include <stdbool.h>

#include "table.h"

typedef struct bundle bundle;

/* ---- in ---- */
bundle *bundle_open(const char *folder);

/* A text of the manifest: "assay:seed"; a parameter of its method: "a".  NULL where there is none.
 */
const char *bundle_text(const bundle *b, const char *key);
float       bundle_number(const bundle *b, const char *parameter);
bool        bundle_is(const bundle *b, const char *parameter, const char *value);

bool bundle_has(const bundle *b, const char *name);
/* channels: of an image ("R G B"). */
table bundle_read(const bundle *b, const char *name, const char *channels);
/* Height, width. */
void bundle_image_size(const bundle *b, const char *name, size_t size_out[2]);

/* ---- out ---- */

/* A new folder, and the texts of another bundle's manifest (NULL: none). */
bundle *bundle_create(const char *folder, const bundle *like);
/* A text of the manifest. */
void bundle_describe(bundle *b, const char *key, const char *value);
/* Ends the table. */
void bundle_write(bundle *b, const char *name, const char *unit, table *t);
/* Reads an array there and writes it here as it is, in single precision. */
table bundle_pass_on(const bundle *from, bundle *to, const char *name, const char *channels);

/* Writes the manifest of a bundle that was created; ends either kind. */
void bundle_close(bundle *b);

#endif
