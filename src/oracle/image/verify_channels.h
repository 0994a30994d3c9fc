/* verify_channels.h - which channels of two images are compared. */
#ifndef ASSAY_ORACLE_VERIFY_CHANNELS_H
#define ASSAY_ORACLE_VERIFY_CHANNELS_H

#include "oracle/image/verify_channel.h"

/* All names of estimated channels, with their variances and counts, up to a NULL; of a list of
 * channels ("R,G,B"; NULL: all that docs/conventions.md knows).  Release names_out with
 * assay_release.  Errors: ARGUMENT (a name that is empty or too long, or the same twice), MEMORY.
 */
assay_status assay_verify_channels_names(assay_context *context, const char *list,
                                         const char ***names_out);

/* Channels to compare, zeroed but for name and stage, in the order of the light's way; released
 * with assay_release.  With a list, those; without, those of layers of which both images have a
 * channel.  Errors: ARGUMENT (as above; nothing in common), MEMORY. */
assay_status assay_verify_channels_choose(assay_context *context, const assay_image *candidate,
                                          const assay_image *reference, const char *list,
                                          assay_verify_channel **channels_out, int *count_out);

#endif
