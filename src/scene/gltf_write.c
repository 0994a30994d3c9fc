/* gltf_write.c - the checked document once more as text, for tinygltf.
 *
 * Invariant: the text is well-formed, and every number in it reads back as the same double; whole
 * numbers come without fraction or exponent, since tinygltf takes "2.0" for no index. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

typedef struct {
    assay_context *context;
    char          *text;
    size_t         used, capacity;
} writer;

static assay_status put(writer *w, const char *bytes, size_t count)
{
    const assay_status status =
        assay_grow(w->context, (void **)&w->text, &w->capacity, w->used + count + 1, 1);
    if (status == ASSAY_OK) {
        memcpy(w->text + w->used, bytes, count);
        w->used += count;
    }
    return status;
}

static assay_status put_string(writer *w, const char *text)
{
    assay_status status = put(w, "\"", 1);
    for (const char *p = text; *p && status == ASSAY_OK; p++) {
        const unsigned char c = (unsigned char)*p;
        char                escaped[8];
        if (c < 0x20) {
            snprintf(escaped, sizeof escaped, "\\u%04x", c);
            status = put(w, escaped, 6);
        } else {
            if (c == '"' || c == '\\') {
                status = put(w, "\\", 1);
            }
            status = status == ASSAY_OK ? put(w, p, 1) : status;
        }
    }
    return status == ASSAY_OK ? put(w, "\"", 1) : status;
}

static assay_status put_number(writer *w, double number)
{
    char       text[40];
    const bool whole  = number == floor(number) && fabs(number) < 0x1p53;
    const int  length = whole ? snprintf(text, sizeof text, "%lld", (long long)number)
                              : snprintf(text, sizeof text, "%.17g", number);
    return put(w, text, (size_t)length);
}

static bool is_left_out(const assay_json *member, unsigned depth)
{
    static const char *const anywhere[] = {"extras", "extensions", "min", "max"};
    static const char *const at_root[]  = {"buffers", "images", "materials"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(member->key, anywhere[i]) == 0) {
            return true;
        }
    }
    for (int i = 0; i < 3 && depth == 0; i++) {
        if (strcmp(member->key, at_root[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* As deep as ASSAY_GLTF_MAX_JSON_DEPTH at most. */
static assay_status put_value(writer *w, const assay_json *value, unsigned depth);

static assay_status put_children(writer *w, const assay_json *value, unsigned depth)
{
    const bool   object = value->type == ASSAY_JSON_OBJECT;
    bool         first  = true;
    assay_status status = put(w, object ? "{" : "[", 1);
    for (const assay_json *c = value->child; c && status == ASSAY_OK; c = c->next) {
        if (object && is_left_out(c, depth)) {
            continue;
        }
        status = first ? ASSAY_OK : put(w, ",", 1);
        first  = false;
        if (object && status == ASSAY_OK) {
            status = put_string(w, c->key);
            status = status == ASSAY_OK ? put(w, ":", 1) : status;
        }
        status = status == ASSAY_OK ? put_value(w, c, depth + 1) : status;
    }
    return status == ASSAY_OK ? put(w, object ? "}" : "]", 1) : status;
}

static assay_status put_value(writer *w, const assay_json *value, unsigned depth)
{
    switch (value->type) {
    case ASSAY_JSON_BOOL: return put(w, value->boolean ? "true" : "false", value->boolean ? 4 : 5);
    case ASSAY_JSON_NUMBER: return put_number(w, value->number);
    case ASSAY_JSON_TEXT: return put_string(w, value->text);
    case ASSAY_JSON_ARRAY:
    case ASSAY_JSON_OBJECT: return put_children(w, value, depth);
    case ASSAY_JSON_NULL: break;
    }
    return put(w, "null", 4);
}

assay_status assay_gltf_write_text(assay_context *context, const char *file, const assay_json *root,
                                   char **text_out, size_t *count_out)
{
    writer       w      = {.context = context};
    assay_status status = put_value(&w, root, 0);
    if (status == ASSAY_OK && w.used > INT32_MAX) {
        status = assay_fail(context, ASSAY_ERR_LIMIT,
                            "%s: more than 2147483647 bytes of JSON besides data URIs", file);
    }
    if (status != ASSAY_OK) {
        assay_release(context, w.text);
        return status;
    }
    *text_out  = w.text;
    *count_out = w.used;
    return ASSAY_OK;
}
