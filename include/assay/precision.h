/* precision.h - what a candidate computes with. */
#ifndef ASSAY_PRECISION_H
#define ASSAY_PRECISION_H

#include "assay/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* IEEE 754 binary16, binary32, binary64: unit roundoff 2^-11, 2^-24, 2^-53. */
typedef enum {
    ASSAY_PRECISION_HALF,
    ASSAY_PRECISION_FLOAT,
    ASSAY_PRECISION_DOUBLE
} assay_precision;

/* "half", "float", "double".  Errors: ARGUMENT, the output untouched. */
ASSAY_API assay_status assay_precision_find(const char *name, assay_precision *precision_out);
/* The other way; borrowed. */
ASSAY_API const char *assay_precision_name(assay_precision precision);

#ifdef __cplusplus
}
#endif
#endif
