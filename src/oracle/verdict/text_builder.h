/* text_builder.h - a text that grows, complete or not at all.
 *
 *     assay_text_builder text = assay_text_start(context);
 *     assay_text_add(&text, "%d values", count);
 *     return assay_text_finish(&text, "a report", text_out);      releases it on error */
#ifndef ASSAY_ORACLE_TEXT_BUILDER_H
#define ASSAY_ORACLE_TEXT_BUILDER_H

#include <stddef.h>

#include "assay/context.h"

typedef struct {
    assay_context *context;
    char          *text; /* ends with a NUL where it is not NULL */
    size_t         length, capacity;
    bool           failed; /* out of memory: later additions do nothing */
} assay_text_builder;

assay_text_builder assay_text_start(assay_context *context);

void assay_text_add(assay_text_builder *builder, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void assay_text_add_char(assay_text_builder *builder, char c);

/* The text, to be released with assay_text_destroy; what names it in the message.
 * Errors: MEMORY. */
assay_status assay_text_finish(assay_text_builder *builder, const char *what, char **text_out);

#endif
