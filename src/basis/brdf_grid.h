/* brdf_grid.h - grids of BRDFs whose texels are already known. */
#ifndef ASSAY_BASIS_BRDF_GRID_H
#define ASSAY_BASIS_BRDF_GRID_H

#include "assay/basis.h"

/* texels: side * side rows of count, row by row; copied.  Errors: ARGUMENT (side), MEMORY. */
assay_status assay_brdf_grid_from_texels(assay_context *context, int side, size_t count,
                                         const double *texels, assay_brdf_grid **grid_out);

#endif
