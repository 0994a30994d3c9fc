/* sample_counts.h - how many samples an image's pixels have. */
#ifndef ASSAY_ORACLE_SAMPLE_COUNTS_H
#define ASSAY_ORACLE_SAMPLE_COUNTS_H

#include "assay/image.h"

/* Of the pixels of a channel: layers of irradiance have samples of their own.  NULL where the image
 * does not say. */
const uint32_t *assay_sample_counts(const assay_image *image, const char *channel);

#endif
