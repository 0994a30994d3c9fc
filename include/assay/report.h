/* report.h - a page to look at: one HTML file with pictures, maps of difference, histograms,
 * stages, records and parameters.
 *
 * It needs nothing beside it and asks the network for nothing (docs/report.md). */
#ifndef ASSAY_REPORT_H
#define ASSAY_REPORT_H

#include "assay/context.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ASSAY_REPORT_MAX_CANDIDATES 64

typedef struct {
    /* An image or a bundle; NULL: of the candidates, the one by the method path with the most
     * samples, which is then no candidate. */
    const char *reference;
    /* Images, bundles, or folders that hold them.  In a folder NAME.json beside NAME.exr is taken
     * where `assay render --stats` wrote it, and NAME.verdict.json where `assay verify` did. */
    const char *const *candidates;
    size_t             candidate_count;
    /* Files that `assay verify --json` wrote, each of the candidate that it names; or, where there
     * is one candidate, of that. */
    const char *const *verdicts;
    size_t             verdict_count;
    const char        *title; /* NULL: the name of the scene */
} assay_report_options;

/* Everything NULL and 0. */
ASSAY_API assay_report_options assay_report_options_default(void);

/* Writes the page; beside and then renamed: on any error the file of that name is as it was.
 * Errors: ARGUMENT (nothing to compare, too many, sizes differ, no channels R, G and B, a verdict
 * of none of the candidates), NOT_FOUND, FORMAT, UNSUPPORTED, LIMIT, MEMORY, WRITE. */
ASSAY_API assay_status assay_report_write(assay_context              *context,
                                          const assay_report_options *options, const char *path);

#ifdef __cplusplus
}
#endif
#endif
