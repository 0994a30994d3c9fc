/* verdict_data.h - the inside of a verdict; private to the files verdict*.c. */
#ifndef ASSAY_ORACLE_VERDICT_DATA_H
#define ASSAY_ORACLE_VERDICT_DATA_H

#include "assay/verdict.h"
#include "oracle/verdict/text_builder.h"

typedef struct {
    char *key, *value;
} assay_verdict_setting;

struct assay_verdict {
    assay_context         *context;
    char                  *candidate, *reference;
    assay_finding         *findings; /* own their texts */
    size_t                 count, capacity;
    assay_verdict_setting *settings;
    size_t                 setting_count, setting_capacity;
};

/* Gives a finding another meaning.  Errors: MEMORY. */
assay_status assay_verdict_mean(assay_verdict *verdict, size_t index, const char *meaning);

/* Takes away all findings from this one on. */
void assay_verdict_truncate(assay_verdict *verdict, int count);

/* "R, test welch" or "records/irradiance.X, test rounding". */
void assay_finding_add_name(assay_text_builder *text, const assay_finding *finding);
/* " at pixel (3, 4)", " at row 7, column 2", " in the tile of 16 x 16 pixels at (0, 32)", or "". */
void assay_finding_add_place(assay_text_builder *text, const assay_finding *finding);
/* All that is known of a finding, in one or more sentences without a line break. */
void assay_finding_add_sentences(assay_text_builder *text, const assay_finding *finding);

#endif
