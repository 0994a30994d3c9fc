/* report_folder.h - which images a report is about. */
#ifndef ASSAY_ORACLE_REPORT_FOLDER_H
#define ASSAY_ORACLE_REPORT_FOLDER_H

#include "assay/report.h"
#include "oracle/report/report_source.h"

typedef struct {
    char  *reference;
    char **candidates; /* without the reference */
    size_t count;
} assay_report_list;

/* Folders become the images and bundles that they hold, in the order of their names; the reference
 * is chosen where none is given.  Errors: ARGUMENT (nothing to compare, too many, no reference to
 * be found), NOT_FOUND, MEMORY, and those of reading an image. */
assay_status assay_report_list_make(assay_context *context, const assay_report_options *options,
                                    assay_report_list *list_out);

/* What a page calls a candidate: its name; where several have that, with its ending, or that it is
 * a bundle, and a number where even so it is not alone. */
void assay_report_list_label(const assay_report_list *list, size_t index,
                             char label_out[ASSAY_REPORT_LABEL_SIZE]);

void assay_report_list_release(assay_context *context, assay_report_list *list);

#endif
