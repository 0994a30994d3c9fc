/* irradiance_bound.h - bounds of what follows from the cells of a hemisphere. */
#ifndef ASSAY_ORACLE_IRRADIANCE_BOUND_H
#define ASSAY_ORACLE_IRRADIANCE_BOUND_H

#include "gather/hemisphere.h"
#include "oracle/stage/tracked.h"

typedef struct {
    double irradiance[3];
    double rotation[9], translation[9]; /* world frame: x y z of R, of G, of B */
    double mean, nearest;
} irradiance_bounds;

/* frame: from the cells' to the world.  Of strata COSINE and UNIFORM. */
irradiance_bounds irradiance_bounds_of(const rounding *r, const assay_hemisphere *hemisphere,
                                       const assay_frame3 *frame, assay_mean_weight mean,
                                       bool normal_gradient);

#endif
