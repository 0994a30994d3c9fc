/* sample_counts.c - Invariant: counts are whole numbers; a channel of floats by that name is none.
 */
#include "oracle/metrics/sample_counts.h"

#include <string.h>

const uint32_t *assay_sample_counts(const assay_image *image, const char *channel)
{
    assay_channel counts;
    const char   *name =
        strncmp(channel, "Irradiance", 10) == 0 ? "SampleCount.Irradiance" : "SampleCount";
    return assay_image_find_channel(image, name, &counts) && counts.type == ASSAY_CHANNEL_UINT
               ? counts.data.u32
               : NULL;
}
