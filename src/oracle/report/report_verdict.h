/* report_verdict.h - what `assay verify --json` said of a candidate. */
#ifndef ASSAY_ORACLE_REPORT_VERDICT_H
#define ASSAY_ORACLE_REPORT_VERDICT_H

#include "assay/report.h"

typedef struct {
    char *json;      /* the file's text, known to be a verdict */
    char *candidate; /* whose it is                            */
    bool  used;
} assay_report_verdict;

/* Reads the files of the options; *verdicts_out has verdict_count of them.
 * Errors: NOT_FOUND, FORMAT (no verdict), LIMIT, MEMORY. */
assay_status assay_report_verdicts_read(assay_context *context, const assay_report_options *options,
                                        assay_report_verdict **verdicts_out);
void         assay_report_verdicts_release(assay_context *context, assay_report_verdict *verdicts,
                                           size_t count);

/* The verdict of this candidate (a path): that of the options, or of NAME.verdict.json beside it,
 * which goes to *own_out and is to be released with assay_text_destroy.  NULL where there is none.
 * alone: any verdict of the options is of this one.  Errors: as above. */
assay_status assay_report_verdict_find(assay_context *context, const char *path, bool alone,
                                       assay_report_verdict *verdicts, size_t count,
                                       const char **json_out, char **own_out);

#endif
