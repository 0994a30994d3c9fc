/* report_stale.h - whether a verdict was given on the pixels that a report shows. */
#ifndef ASSAY_ORACLE_REPORT_STALE_H
#define ASSAY_ORACLE_REPORT_STALE_H

#include "oracle/report/report_source.h"
#include "oracle/report/report_text.h"

/* Compares the values that the findings of a verdict (JSON, known to be one) name with those of the
 * images, or of the bundles' arrays, and puts "otherPixels": a list of sentences, one for each of
 * candidate and reference that has other values; nothing where all are the same.  Channels that the
 * report does not show are read again.  Errors: MEMORY, and those of reading. */
assay_status assay_report_stale_put(assay_context *context, assay_report_text *text,
                                    const assay_report_source *reference,
                                    const assay_report_source *candidate, const char *verdict);

#endif
