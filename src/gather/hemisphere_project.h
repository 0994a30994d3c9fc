/* hemisphere_project.h - what the two forms of coefficient gradients share. */
#ifndef ASSAY_GATHER_HEMISPHERE_PROJECT_H
#define ASSAY_GATHER_HEMISPHERE_PROJECT_H

#include "gather/hemisphere.h"

/* Sums of 3 rows of count vectors, zeroed by the caller; what is there is added to. */
assay_status hemisphere_add_points(const assay_hemisphere *hemisphere, assay_context *context,
                                   const assay_basis *basis, assay_vec3 *sums);
assay_status hemisphere_add_walls(const assay_hemisphere *hemisphere, assay_context *context,
                                  const assay_basis *basis, assay_vec3 *sums);

#endif
