/* channel_mean.h - the brightness that relative differences refer to; private to oracle. */
#ifndef ASSAY_ORACLE_CHANNEL_MEAN_H
#define ASSAY_ORACLE_CHANNEL_MEAN_H

#include "assay/image.h"

/* Mean of a over the pixels where both are finite; NaN where there are none. */
double assay_channel_mean(const assay_channel *a, const assay_channel *b, size_t pixels);

#endif
