/* dump.h - the layers of an image as arrays of a bundle. */
#ifndef ASSAY_METHODS_DUMP_H
#define ASSAY_METHODS_DUMP_H

#include "methods/method.h"

/* Adds every layer of the image as an array of its own under a stable name ("gbuffer/position",
 * "irradiance/indirect", with "_variance" behind it for variances), and all metadata.
 * Errors: WRITE, MEMORY. */
assay_status assay_dump_image(assay_context *context, const assay_image *image,
                              assay_bundle *bundle);

#endif
