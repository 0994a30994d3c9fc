/* verify_unseen.h - arrays that a verdict on a bundle says nothing of. */
#ifndef ASSAY_ORACLE_VERIFY_UNSEEN_H
#define ASSAY_ORACLE_VERIFY_UNSEEN_H

#include "assay/verdict.h"
#include "io/bundle_read.h"

/* Settings of the verdict: "not judged" are the candidate's arrays without a finding, "missing"
 * those of the reference (NULL: none) that the candidate lacks.  Neither is set where it would be
 * empty.  Errors: MEMORY. */
assay_status verify_tell_unseen(const assay_bundle_reader *candidate,
                                const assay_bundle_reader *reference, assay_verdict *verdict);

#endif
