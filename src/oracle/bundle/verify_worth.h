/* verify_worth.h - what a verdict on a bundle could have seen. */
#ifndef ASSAY_ORACLE_VERIFY_WORTH_H
#define ASSAY_ORACLE_VERIFY_WORTH_H

#include "assay/verdict.h"

/* Setting "power" of a verdict that does not fail: how many numbers were judged, and how wide the
 * bounds are where they are widest.  Errors: MEMORY. */
assay_status verify_tell_worth(assay_verdict *verdict);

#endif
