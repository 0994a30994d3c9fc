/* report_text.h - the page as it is written: JSON, base64 and HTML to a file.
 *
 *     assay_report_text text = {file};
 *     assay_report_open(&text, NULL, '{');
 *     assay_report_put_text(&text, "name", name);        escaped, whatever it holds
 *     assay_report_open(&text, "mean", '[');
 *     assay_report_put_number(&text, NULL, 0.5);
 *     assay_report_close(&text, ']');
 *     assay_report_close(&text, '}');
 *
 * Errors of the file are kept for its commit. */
#ifndef ASSAY_ORACLE_REPORT_TEXT_H
#define ASSAY_ORACLE_REPORT_TEXT_H

#include "io/atomic_file.h"

typedef struct {
    assay_atomic_file *file;
    bool               comma; /* something stands before what comes next */
} assay_report_text;

/* Bytes as they are. */
void assay_report_put_raw(assay_report_text *text, const char *raw);

/* key is NULL inside of '['.  Numbers that are not finite become null. */
void assay_report_open(assay_report_text *text, const char *key, char bracket);
void assay_report_close(assay_report_text *text, char bracket);
void assay_report_put_text(assay_report_text *text, const char *key, const char *value);
void assay_report_put_number(assay_report_text *text, const char *key, double value);
void assay_report_put_bool(assay_report_text *text, const char *key, bool value);

/* A text that is JSON already; what would end a <script> is escaped. */
void assay_report_put_json(assay_report_text *text, const char *key, const char *json);

/* A text inside of an element of HTML. */
void assay_report_put_html(assay_report_text *text, const char *value);

void assay_report_put_base64(assay_report_text *text, const uint8_t *bytes, size_t count);

#endif
