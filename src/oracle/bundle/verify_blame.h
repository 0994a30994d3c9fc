/* verify_blame.h - whether a stage that fails is to blame, or what it was judged with. */
#ifndef ASSAY_ORACLE_VERIFY_BLAME_H
#define ASSAY_ORACLE_VERIFY_BLAME_H

#include "assay/verdict.h"
#include "io/bundle_read.h"

/* Adds to what findings of stages that fail mean: which of the stage's inputs are not right, as the
 * verdict has it.  reference NULL: nothing was said of inputs.  Errors: those of bundles, MEMORY.
 */
assay_status verify_blame(const assay_bundle_reader *candidate,
                          const assay_bundle_reader *reference, assay_verdict *verdict);

#endif
