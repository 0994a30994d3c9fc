/* diff_report.h - what `assay diff` has found, and how it is said. */
#ifndef ASSAY_CLI_DIFF_REPORT_H
#define ASSAY_CLI_DIFF_REPORT_H

#include "assay/assay.h"

/* The parts that were not asked for, or that the images do not have, are left out. */
typedef struct {
    const assay_image      *a, *b;
    const assay_comparison *comparison;
    assay_metrics_options   options;
    bool                    has_picture, has_flip[2]; /* by assay_flip_kind */
    assay_color_difference  color;
    double                  ssim;
    assay_flip_summary      flip[2];
} diff_report;

void diff_print_table(const diff_report *report);

/* False where memory ran out; nothing is printed then. */
bool diff_print_json(const diff_report *report);

#endif
