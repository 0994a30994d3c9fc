/* report_entry.h - one image of a report, written: its pictures, then what is known of it. */
#ifndef ASSAY_ORACLE_REPORT_ENTRY_H
#define ASSAY_ORACLE_REPORT_ENTRY_H

#include "oracle/report/report_picture.h"
#include "oracle/report/report_source.h"

/* Errors: MEMORY, and those of reading records. */
assay_status assay_report_put_reference(assay_report_writer       *writer,
                                        const assay_report_source *reference);

/* verdict: JSON, or NULL.  Both images are of one size. */
assay_status assay_report_put_candidate(assay_report_writer       *writer,
                                        const assay_report_source *reference,
                                        const assay_report_source *candidate, const char *verdict);

#endif
