/* metadata.h - how an image was made, as text attributes of the image. */
#ifndef ASSAY_METHODS_METADATA_H
#define ASSAY_METHODS_METADATA_H

#include "methods/method.h"

/* Adds the attributes that docs/conventions.md lists.  Errors: MEMORY. */
assay_status assay_metadata_add(assay_image *image, const assay_method *method,
                                const assay_params *params, const assay_frame *frame);

#endif
