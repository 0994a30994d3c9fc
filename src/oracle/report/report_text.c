/* report_text.c - Invariant: no byte that came from a file leaves a string of JSON or becomes
 * markup: <, > and & are escaped in both, quotes and control characters in JSON, and what is not
 * UTF-8 was made so before (assay_text_clean). */
#include "oracle/report/report_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void assay_report_put_raw(assay_report_text *text, const char *raw)
{
    assay_atomic_file_write(text->file, raw, strlen(raw));
}

static void put_string(assay_report_text *text, const char *value)
{
    char escape[8];
    assay_report_put_raw(text, "\"");
    for (const char *at = value; *at;) {
        const size_t plain = strcspn(at, "\"\\<>&\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c"
                                         "\x0d\x0e\x0f\x10\x11\x12\x13\x14\x15\x16\x17\x18\x19\x1a"
                                         "\x1b\x1c\x1d\x1e\x1f\x7f");
        assay_atomic_file_write(text->file, at, plain);
        at += plain;
        if (*at) {
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned char)*at);
            assay_report_put_raw(text, escape);
            at++;
        }
    }
    assay_report_put_raw(text, "\"");
}

static void begin(assay_report_text *text, const char *key)
{
    if (text->comma) {
        assay_report_put_raw(text, ",");
    }
    if (key) {
        put_string(text, key);
        assay_report_put_raw(text, ":");
    }
    text->comma = true;
}

void assay_report_open(assay_report_text *text, const char *key, char bracket)
{
    begin(text, key);
    assay_atomic_file_write(text->file, &bracket, 1);
    text->comma = false;
}

void assay_report_close(assay_report_text *text, char bracket)
{
    assay_atomic_file_write(text->file, &bracket, 1);
    text->comma = true;
}

void assay_report_put_text(assay_report_text *text, const char *key, const char *value)
{
    begin(text, key);
    put_string(text, value);
}

void assay_report_put_number(assay_report_text *text, const char *key, double value)
{
    char number[32];
    begin(text, key);
    snprintf(number, sizeof number, "%.9g", value);
    assay_report_put_raw(text, isfinite(value) ? number : "null");
}

void assay_report_put_bool(assay_report_text *text, const char *key, bool value)
{
    begin(text, key);
    assay_report_put_raw(text, value ? "true" : "false");
}

void assay_report_put_json(assay_report_text *text, const char *key, const char *json)
{
    begin(text, key);
    for (const char *at = json; *at;) {
        const size_t plain = strcspn(at, "<>&");
        assay_atomic_file_write(text->file, at, plain);
        at += plain;
        if (*at) {
            assay_report_put_raw(text, *at == '<' ? "\\u003c" : *at == '>' ? "\\u003e" : "\\u0026");
            at++;
        }
    }
}

void assay_report_put_html(assay_report_text *text, const char *value)
{
    for (const char *at = value; *at;) {
        const size_t plain = strcspn(at, "<>&\"");
        assay_atomic_file_write(text->file, at, plain);
        at += plain;
        if (*at) {
            assay_report_put_raw(text, *at == '<'   ? "&lt;"
                                       : *at == '>' ? "&gt;"
                                       : *at == '&' ? "&amp;"
                                                    : "&quot;");
            at++;
        }
    }
}

void assay_report_put_base64(assay_report_text *text, const uint8_t *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char              block[4096];
    size_t            filled = 0;
    for (size_t i = 0; i < count; i += 3) {
        const size_t   left = count - i;
        const uint32_t word = (uint32_t)bytes[i] << 16 |
                              (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (left > 2 ? bytes[i + 2] : 0);
        block[filled++] = digits[word >> 18];
        block[filled++] = digits[word >> 12 & 63];
        block[filled++] = left > 1 ? digits[word >> 6 & 63] : '=';
        block[filled++] = left > 2 ? digits[word & 63] : '=';
        if (filled == sizeof block) {
            assay_atomic_file_write(text->file, block, filled);
            filled = 0;
        }
    }
    assay_atomic_file_write(text->file, block, filled);
}
