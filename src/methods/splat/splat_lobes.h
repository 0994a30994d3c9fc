/* splat_lobes.h - the BRDFs that glossy pixels show, as tables of a dump (docs/bundle.md). */
#ifndef ASSAY_METHODS_SPLAT_LOBES_H
#define ASSAY_METHODS_SPLAT_LOBES_H

#include "methods/splat/splat_image.h"

/* Adds NAME/lobe_grid, all lobes, and NAME/lobe, which of them each pixel shows.  Errors: WRITE,
 * MEMORY. */
assay_status splat_lobes_add(const splat_image *image, const splat_layer *layer, const char *name);

#endif
