/* cells.h - stage `irradiance`: from the cells of hemispheres to records. */
#ifndef BACKEND_CELLS_H
#define BACKEND_CELLS_H

#include "bundle.h"

/* Looks around at a few places of a box of its own, in the strata of the manifest, and writes what
 * is seen and the records that follow. */
void cells_gather(bundle *to);

#endif
