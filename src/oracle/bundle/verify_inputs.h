/* verify_inputs.h - whether what a candidate's stages began with is the reference's. */
#ifndef ASSAY_ORACLE_VERIFY_INPUTS_H
#define ASSAY_ORACLE_VERIFY_INPUTS_H

#include "assay/precision.h"
#include "assay/verdict.h"
#include "io/bundle_read.h"

/* Whether a stage judged the array. */
bool verify_is_judged(const assay_verdict *verdict, const char *array);

/* Adds a finding for each array that a stage of the verdict read, or that is made before all stages
 * (records, what is splatted on), and that none judged: it passes where
 * it is the reference's, rounded once to the candidate's precision, and cannot be told otherwise.
 * Errors: those of bundles, MEMORY. */
assay_status verify_inputs(const assay_bundle_reader *candidate,
                           const assay_bundle_reader *reference, assay_precision precision,
                           assay_verdict *verdict);

#endif
