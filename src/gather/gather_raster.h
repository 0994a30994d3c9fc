/* gather_raster.h - fills a hemisphere on a plane by rasterisation; what assay_gather does for
 * strata PLANE. */
#ifndef ASSAY_GATHER_GATHER_RASTER_H
#define ASSAY_GATHER_GATHER_RASTER_H

#include "gather/gather.h"

assay_status gather_raster(const assay_gatherer *gatherer, const assay_gather_site *site,
                           uint64_t item, assay_hemisphere *hemisphere);

#endif
