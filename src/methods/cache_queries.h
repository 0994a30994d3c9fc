/* cache_queries.h - what finished caches say at the pixels' centres, as tables of a dump
 * (docs/bundle.md): what stage `interpolate` and stage `interpolate-radiance` make of the records.
 */
#ifndef ASSAY_METHODS_CACHE_QUERIES_H
#define ASSAY_METHODS_CACHE_QUERIES_H

#include "methods/cache_file.h"
#include "methods/glossy_materials.h"

/* Points of which the dump has coefficients: they are long rows. */
enum { ASSAY_CACHE_QUERIES_MOST = 4096 };

/* Adds query/... to the frame's dump, a row a pixel; and radiance_query/..., a row for some of the
 * pixels with a material within reach, where there are radiance records.  materials: NULL where the
 * method has none.  Errors: WRITE, MEMORY. */
assay_status assay_cache_queries_add(const assay_frame *frame, const assay_cache_set *caches,
                                     const glossy_materials *materials);

#endif
