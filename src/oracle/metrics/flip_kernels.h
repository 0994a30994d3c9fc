/* flip_kernels.h - the filters of FLIP for a viewing distance; private to oracle. */
#ifndef ASSAY_ORACLE_FLIP_KERNELS_H
#define ASSAY_ORACLE_FLIP_KERNELS_H

#include "oracle/metrics/tile_filter.h"

/* All kernels are to be applied along both axes, the derivatives along one and `smooth` along the
 * other.  The blue-yellow filter is blue_share[0] times the result of blue[0] plus blue_share[1]
 * times that of blue[1]. */
typedef struct {
    assay_kernel luminance, red_green, blue[2];
    double       blue_share[2];
    assay_kernel smooth, edge, point; /* Gaussian, its first and second derivative */
    int          radius;              /* of the largest                            */
} assay_flip_kernels;

/* Pixels per degree in the range of metrics.h. */
void assay_flip_kernels_make(double pixels_per_degree, assay_flip_kernels *kernels_out);

#endif
