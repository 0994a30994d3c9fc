/* verify_variance.h - variances that are larger than differences can be. */
#ifndef ASSAY_ORACLE_VERIFY_VARIANCE_H
#define ASSAY_ORACLE_VERIFY_VARIANCE_H

#include "oracle/image/verify_channel.h"

/* The variance of both images over the squares of their differences: about 1 where the variances
 * are right, in the median of the smallest tiles.  Infinite where more than half of them have no
 * difference at all; NaN where fewer than 4 have noise.  Errors: MEMORY. */
assay_status assay_variance_excess(assay_context *context, const assay_tile_level *tiles,
                                   double *excess_out);

/* Names the channels (of those without a problem) whose excess is above 4, in the verdict's setting
 * "variances": a sentence.  Errors: MEMORY. */
assay_status assay_verify_variances(assay_verdict *verdict, const assay_verify_channel *channels,
                                    int count);

#endif
