/* projection.h - checks that every way to project makes. */
#ifndef ASSAY_BASIS_PROJECTION_H
#define ASSAY_BASIS_PROJECTION_H

#include "assay/basis.h"

#define ASSAY_PROJECTION_MAX_CHANNELS 65536

/* ARGUMENT, with a message, unless 1 <= channels <= ASSAY_PROJECTION_MAX_CHANNELS. */
assay_status assay_projection_check_channels(assay_context *context, int channels);

/* DOMAIN, with a message, unless all values of f at a direction are finite. */
assay_status assay_projection_check(assay_context *context, const double *values, size_t channels,
                                    assay_vec3 direction);

/* A map's channels R, G, B.  Errors: ARGUMENT (one is missing), DOMAIN (a texel is not finite). */
assay_status assay_projection_check_map(assay_context *context, const assay_image *map,
                                        assay_channel channels_out[3]);

#endif
