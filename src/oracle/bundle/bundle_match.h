/* bundle_match.h - whether a candidate's bundle may be compared with a reference's at all. */
#ifndef ASSAY_ORACLE_BUNDLE_MATCH_H
#define ASSAY_ORACLE_BUNDLE_MATCH_H

#include "io/bundle_read.h"

/* Scene, parameters, camera and all else that the reference's manifest says of how it was made.
 * Errors: ARGUMENT, the message names what differs. */
assay_status bundle_match_making(assay_context *context, const assay_bundle_reader *candidate,
                                 const assay_bundle_reader *reference);

/* The bundle's entry of the same name, or of batch 0 of the same kind; false without. */
bool bundle_find_like(const assay_bundle_reader *reference, const char *name,
                      assay_bundle_entry *entry_out);

/* Arrays: each is one of the reference's, in its unit, with as many columns, of a type that is
 * known, in a file that is what the manifest lists, without a NaN where the reference has none.
 * reference NULL: of a known type, in such a file; what a stage reads it judges itself.
 * Errors: FORMAT, DOMAIN, and those of bundles. */
assay_status bundle_match_arrays(assay_context *context, const assay_bundle_reader *candidate,
                                 const assay_bundle_reader *reference);

#endif
