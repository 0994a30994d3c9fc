/* precision.c - names of precisions. */
#include "assay/precision.h"

#include <string.h>

static const char *const NAMES[] = {"half", "float", "double"};

assay_status assay_precision_find(const char *name, assay_precision *precision_out)
{
    for (int i = 0; i <= ASSAY_PRECISION_DOUBLE; i++) {
        if (strcmp(NAMES[i], name) == 0) {
            *precision_out = (assay_precision)i;
            return ASSAY_OK;
        }
    }
    return ASSAY_ERR_ARGUMENT;
}

const char *assay_precision_name(assay_precision precision) { return NAMES[precision]; }
