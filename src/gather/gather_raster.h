/* gather_raster.h - what the pixels of a hemisphere on a plane see; for gather.c. */
#ifndef ASSAY_GATHER_GATHER_RASTER_H
#define ASSAY_GATHER_GATHER_RASTER_H

#include "gather/gather.h"

/* Rasterises all of the hemisphere's plane.  Errors: MEMORY. */
assay_status gather_raster_draw(const assay_world *world, const assay_gather_site *site,
                                assay_hemisphere *hemisphere);

/* What a cell sees since then; false: nothing. */
bool gather_raster_find(const assay_world *world, const assay_hemisphere *hemisphere, int cell,
                        assay_hit *hit_out);

#endif
