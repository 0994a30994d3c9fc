/* gltf_json.c - Invariant: a text that passes is well-formed, in valid UTF-8, and no deeper than
 * ASSAY_GLTF_MAX_JSON_DEPTH; the reader itself never recurses.
 *
 * Its own reader, and not cJSON's, because a scene is where hostile text comes in: cJSON takes
 * numbers such as 01 and 1.e, bytes that are no UTF-8, NUL inside of strings, cannot tell a failed
 * allocation from a wrong text, and writes to a global.  The text is gone through twice with the
 * same code: once to check and count, once to fill blocks of exactly the right size. */
#include "scene/gltf_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_limits.h"

typedef enum { EXPECT_VALUE, EXPECT_VALUE_OR_END, EXPECT_KEY, EXPECT_KEY_OR_END, AFTER } expected;

typedef struct {
    const char *start, *p, *end;
    const char *wrong; /* what is wrong at p, or NULL */
    bool        too_large;
    assay_json *nodes;   /* NULL in the first pass */
    char       *strings; /* likewise               */
    uint32_t    node_count;
    size_t      string_bytes;
    const char *key;                             /* of the value to come */
    assay_json *open[ASSAY_GLTF_MAX_JSON_DEPTH]; /* unused in the first pass */
    assay_json *last[ASSAY_GLTF_MAX_JSON_DEPTH];
    char        closing[ASSAY_GLTF_MAX_JSON_DEPTH];
    unsigned    depth;
    expected    state;
} json_reader;

static bool refuse(json_reader *r, const char *wrong)
{
    r->wrong = wrong;
    return false;
}

static void skip_space(json_reader *r)
{
    while (r->p < r->end && (*r->p == ' ' || *r->p == '\t' || *r->p == '\n' || *r->p == '\r')) {
        r->p++;
    }
}

/* ---- strings ---- */

static void emit(json_reader *r, unsigned byte)
{
    if (r->strings) {
        r->strings[r->string_bytes] = (char)byte;
    }
    r->string_bytes++;
}

static void emit_code_point(json_reader *r, uint32_t code)
{
    if (code < 0x80) {
        emit(r, code);
    } else if (code < 0x800) {
        emit(r, 0xC0 | code >> 6);
        emit(r, 0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
        emit(r, 0xE0 | code >> 12);
        emit(r, 0x80 | (code >> 6 & 0x3F));
        emit(r, 0x80 | (code & 0x3F));
    } else {
        emit(r, 0xF0 | code >> 18);
        emit(r, 0x80 | (code >> 12 & 0x3F));
        emit(r, 0x80 | (code >> 6 & 0x3F));
        emit(r, 0x80 | (code & 0x3F));
    }
}

/* Four hexadecimal digits at p; UINT32_MAX where they are not. */
static uint32_t read_hex4(json_reader *r)
{
    uint32_t code = 0;
    if (r->end - r->p < 4) {
        return UINT32_MAX;
    }
    for (int i = 0; i < 4; i++) {
        const char c = *r->p++;
        uint32_t   digit;
        if (c >= '0' && c <= '9') {
            digit = (uint32_t)(c - '0');
        } else if ((c | 0x20) >= 'a' && (c | 0x20) <= 'f') {
            digit = (uint32_t)((c | 0x20) - 'a') + 10;
        } else {
            return UINT32_MAX;
        }
        code = code << 4 | digit;
    }
    return code;
}

/* After a backslash. */
static bool read_escape(json_reader *r)
{
    static const char letters[] = "\"\\/bfnrt", values[] = "\"\\/\b\f\n\r\t";
    if (r->p == r->end) {
        return refuse(r, "the text ends inside of a string");
    }
    const char  c     = *r->p++;
    const char *found = c ? strchr(letters, c) : NULL;
    if (found) {
        emit(r, (unsigned char)values[found - letters]);
        return true;
    }
    uint32_t code = c == 'u' ? read_hex4(r) : UINT32_MAX;
    if (code >= 0xD800 && code <= 0xDBFF) {
        const bool     pair = r->end - r->p >= 2 && r->p[0] == '\\' && r->p[1] == 'u';
        const uint32_t low  = pair ? (r->p += 2, read_hex4(r)) : UINT32_MAX;
        code = low >= 0xDC00 && low <= 0xDFFF ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00)
                                              : UINT32_MAX;
    } else if (code >= 0xDC00 && code <= 0xDFFF) {
        code = UINT32_MAX;
    }
    if (code == UINT32_MAX || code == 0) {
        return refuse(r, "a malformed escape in a string");
    }
    emit_code_point(r, code);
    return true;
}

/* A character of two to four bytes, by the table of well-formed UTF-8 (Unicode, table 3-7). */
static bool read_multibyte(json_reader *r)
{
    const unsigned char *b     = (const unsigned char *)r->p;
    const ptrdiff_t      left  = r->end - r->p;
    int                  count = 0;
    unsigned             low = 0x80, high = 0xBF; /* of the second byte */
    if (b[0] >= 0xC2 && b[0] <= 0xDF) {
        count = 2;
    } else if (b[0] >= 0xE0 && b[0] <= 0xEF) {
        count = 3;
        low   = b[0] == 0xE0 ? 0xA0 : low;
        high  = b[0] == 0xED ? 0x9F : high;
    } else if (b[0] >= 0xF0 && b[0] <= 0xF4) {
        count = 4;
        low   = b[0] == 0xF0 ? 0x90 : low;
        high  = b[0] == 0xF4 ? 0x8F : high;
    }
    if (count == 0 || left < count || b[1] < low || b[1] > high ||
        (count > 2 && (b[2] & 0xC0) != 0x80) || (count > 3 && (b[3] & 0xC0) != 0x80)) {
        return refuse(r, "bytes that are not UTF-8");
    }
    for (int i = 0; i < count; i++) {
        emit(r, b[i]);
    }
    r->p += count;
    return true;
}

/* At the opening quote. */
static bool read_string(json_reader *r, const char **text_out)
{
    *text_out = r->strings ? r->strings + r->string_bytes : NULL;
    r->p++;
    while (r->p < r->end) {
        const unsigned char c = (unsigned char)*r->p;
        if (c == '"') {
            r->p++;
            emit(r, 0);
            return true;
        }
        if (c < 0x20) {
            return refuse(r, "a control character in a string");
        }
        if (c >= 0x80) {
            if (!read_multibyte(r)) {
                return false;
            }
            continue;
        }
        r->p++;
        if (c != '\\') {
            emit(r, c);
        } else if (!read_escape(r)) {
            return false;
        }
    }
    return refuse(r, "the text ends inside of a string");
}

/* ---- values ---- */

static bool skip_digits(json_reader *r)
{
    const char *first = r->p;
    while (r->p < r->end && *r->p >= '0' && *r->p <= '9') {
        r->p++;
    }
    return r->p > first;
}

static bool read_number(json_reader *r, double *number_out)
{
    const char *first = r->p;
    bool        sound = true;
    if (*r->p == '-') {
        r->p++;
    }
    const char *digits = r->p;
    sound              = skip_digits(r) && !(digits[0] == '0' && r->p - digits > 1);
    if (sound && r->p < r->end && *r->p == '.') {
        r->p++;
        sound = skip_digits(r);
    }
    if (sound && r->p < r->end && (*r->p | 0x20) == 'e') {
        r->p++;
        if (r->p < r->end && (*r->p == '+' || *r->p == '-')) {
            r->p++;
        }
        sound = skip_digits(r);
    }
    if (!sound) {
        return refuse(r, "a malformed number");
    }
    /* The root is an object, so at least its brace follows in memory and stops strtod. */
    *number_out = r->nodes ? strtod(first, NULL) : 0.0;
    return isfinite(*number_out) ? true : refuse(r, "a number beyond the range of double");
}

/* A new value as the next of the innermost open array or object; a scratch in the first pass. */
static assay_json *add_value(json_reader *r, assay_json *scratch, assay_json_type type)
{
    assay_json *node = r->nodes ? &r->nodes[r->node_count] : scratch;
    r->node_count++;
    node->type = type;
    if (r->nodes) {
        node->key = r->key;
        if (r->depth) {
            assay_json *parent = r->open[r->depth - 1], *before = r->last[r->depth - 1];
            if (before) {
                before->next = node;
            } else {
                parent->child = node;
            }
            parent->count++;
            r->last[r->depth - 1] = node;
        }
    }
    r->key   = NULL;
    r->state = AFTER;
    return node;
}

static bool open_value(json_reader *r, assay_json_type type)
{
    assay_json scratch;
    if (r->depth == ASSAY_GLTF_MAX_JSON_DEPTH) {
        r->too_large = true;
        return refuse(r, "objects and arrays lie deeper in each other than 128 levels");
    }
    assay_json *node     = add_value(r, &scratch, type);
    r->open[r->depth]    = r->nodes ? node : NULL;
    r->last[r->depth]    = NULL;
    r->closing[r->depth] = type == ASSAY_JSON_OBJECT ? '}' : ']';
    r->depth++;
    r->state = type == ASSAY_JSON_OBJECT ? EXPECT_KEY_OR_END : EXPECT_VALUE_OR_END;
    r->p++;
    return true;
}

static bool read_word(json_reader *r)
{
    static const char *const words[] = {"null", "false", "true"};
    assay_json               scratch;
    for (int i = 0; i < 3; i++) {
        const size_t length = strlen(words[i]);
        if ((size_t)(r->end - r->p) >= length && memcmp(r->p, words[i], length) == 0) {
            add_value(r, &scratch, i ? ASSAY_JSON_BOOL : ASSAY_JSON_NULL)->boolean = i == 2;
            r->p += length;
            return true;
        }
    }
    return refuse(r, "something that is no JSON value");
}

static bool read_value(json_reader *r)
{
    assay_json scratch;
    if (r->node_count == ASSAY_GLTF_MAX_JSON_VALUES) {
        r->too_large = true;
        return refuse(r, "more than 8388608 values");
    }
    switch (*r->p) {
    case '{': return open_value(r, ASSAY_JSON_OBJECT);
    case '[': return open_value(r, ASSAY_JSON_ARRAY);
    case '"': return read_string(r, &add_value(r, &scratch, ASSAY_JSON_TEXT)->text);
    default: break;
    }
    if (*r->p == '-' || (*r->p >= '0' && *r->p <= '9')) {
        return read_number(r, &add_value(r, &scratch, ASSAY_JSON_NUMBER)->number);
    }
    return read_word(r);
}

static bool read_key(json_reader *r)
{
    if (*r->p != '"') {
        return refuse(r, "something else than a member's name in quotes");
    }
    if (!read_string(r, &r->key)) {
        return false;
    }
    skip_space(r);
    if (r->p == r->end || *r->p != ':') {
        return refuse(r, "no colon after a member's name");
    }
    r->p++;
    r->state = EXPECT_VALUE;
    return true;
}

/* After a value: a comma, or the end of what is open. */
static bool read_separator(json_reader *r)
{
    const char closing = r->closing[r->depth - 1];
    if (*r->p == closing) {
        r->depth--;
    } else if (*r->p == ',') {
        r->state = closing == '}' ? EXPECT_KEY : EXPECT_VALUE;
    } else {
        return refuse(r, "neither a comma nor the end of an array or object");
    }
    r->p++;
    return true;
}

/* One pass over the whole text. */
static bool read_all(json_reader *r)
{
    r->p            = r->start;
    r->node_count   = 0;
    r->string_bytes = 0;
    r->depth        = 0;
    r->state        = EXPECT_VALUE;
    for (;;) {
        skip_space(r);
        if (r->state == AFTER && r->depth == 0) {
            return r->p == r->end ? true : refuse(r, "more text after the end");
        }
        if (r->p == r->end) {
            return refuse(r, "the text is cut short");
        }
        const bool may_end = r->state == EXPECT_VALUE_OR_END || r->state == EXPECT_KEY_OR_END;
        bool       sound;
        if (r->state == AFTER || (may_end && *r->p == r->closing[r->depth - 1])) {
            r->state = AFTER;
            sound    = read_separator(r);
        } else if (r->state == EXPECT_KEY || r->state == EXPECT_KEY_OR_END) {
            sound = read_key(r);
        } else {
            sound = read_value(r);
        }
        if (!sound) {
            return false;
        }
    }
}

static assay_status fail_at(assay_context *context, const char *file, const json_reader *r)
{
    unsigned long line = 1, column = 1;
    for (const char *p = r->start; p < r->p; p++) {
        column = *p == '\n' ? 1 : column + 1;
        line += *p == '\n';
    }
    return assay_fail(context, r->too_large ? ASSAY_ERR_LIMIT : ASSAY_ERR_FORMAT,
                      "%s: line %lu, column %lu of the JSON text: %s", file, line, column,
                      r->wrong);
}

assay_status assay_json_read(assay_context *context, const char *file, const char *text,
                             size_t count, assay_json_document *document_out)
{
    json_reader r = {.start = text, .end = text + count};
    if (count >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
        r.start += 3;
    }
    r.p = r.start;
    skip_space(&r);
    if (r.p == r.end || *r.p != '{') {
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: is not a glTF file: no JSON object and no GLB header at its start",
                          file);
    }
    if (!read_all(&r)) {
        return fail_at(context, file, &r);
    }
    assay_json_document document = {
        .nodes   = assay_allocate(context, r.node_count, sizeof *document.nodes),
        .strings = assay_allocate(context, r.string_bytes, 1),
    };
    if (!document.nodes || !document.strings) {
        assay_json_release(context, &document);
        return assay_fail_memory(context, "the scene's JSON text");
    }
    r.nodes   = document.nodes;
    r.strings = document.strings;
    if (!read_all(&r)) {
        assay_json_release(context, &document);
        return fail_at(context, file, &r);
    }
    *document_out = document;
    return ASSAY_OK;
}

void assay_json_release(assay_context *context, assay_json_document *document)
{
    assay_release(context, document->nodes);
    assay_release(context, document->strings);
    *document = (assay_json_document){0};
}
