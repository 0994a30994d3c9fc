/* verify_metadata.h - whether two images can be of the same light at all, by what they say. */
#ifndef ASSAY_ORACLE_VERIFY_METADATA_H
#define ASSAY_ORACLE_VERIFY_METADATA_H

#include "assay/image.h"

/* Errors: ARGUMENT, with a message that names the attribute and both values, where scene, camera or
 * bounces differ or where one of the images says that its colours are not linear.  An attribute
 * that one of them lacks says nothing. */
assay_status assay_verify_metadata(assay_context *context, const assay_image *candidate,
                                   const assay_image *reference);

/* Whether both say that they used the same random numbers: the same seed, method and version. */
bool assay_verify_shared_seed(const assay_image *candidate, const assay_image *reference);

#endif
