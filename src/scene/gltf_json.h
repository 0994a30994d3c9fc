/* gltf_json.h - JSON text into a tree that can be walked.
 *
 * Strict: RFC 8259 by the letter in valid UTF-8, depth and size limited, so that whatever reads the
 * tree, or the text again, has nothing left to fear from its form. */
#ifndef ASSAY_SCENE_GLTF_JSON_H
#define ASSAY_SCENE_GLTF_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

typedef enum {
    ASSAY_JSON_NULL,
    ASSAY_JSON_BOOL,
    ASSAY_JSON_NUMBER,
    ASSAY_JSON_TEXT,
    ASSAY_JSON_ARRAY,
    ASSAY_JSON_OBJECT
} assay_json_type;

typedef struct assay_json assay_json;
struct assay_json {
    assay_json_type   type;
    bool              boolean;
    uint32_t          count;  /* elements or members                         */
    double            number; /* finite                                      */
    const char       *text;   /* UTF-8, without NUL inside                   */
    const char       *key;    /* of a member of an object; NULL in an array  */
    const assay_json *child;  /* first element or member, or NULL            */
    const assay_json *next;   /* the one after this in its parent, or NULL   */
};

/* Owns the tree; nodes[0] is the root, an object. */
typedef struct {
    assay_json *nodes;
    char       *strings;
} assay_json_document;

/* Reads count bytes; `file` is for messages, which give line and column.  The C locale must be in
 * force on the thread.  Errors: FORMAT, LIMIT (depth, values), MEMORY. */
assay_status assay_json_read(assay_context *context, const char *file, const char *text,
                             size_t count, assay_json_document *document_out);
void         assay_json_release(assay_context *context, assay_json_document *document);

/* ---- of a tree that was checked against the schema; object may be NULL ---- */

/* The member of that name, or NULL. */
const assay_json *assay_json_member(const assay_json *object, const char *key);
double            assay_json_number(const assay_json *object, const char *key, double otherwise);
bool              assay_json_bool(const assay_json *object, const char *key, bool otherwise);
const char       *assay_json_text(const assay_json *object, const char *key, const char *otherwise);
/* A whole number, ASSAY_NONE without one. */
uint32_t assay_json_index(const assay_json *object, const char *key);
/* Fills values_out from an array of `count` numbers; untouched and false without one. */
bool assay_json_numbers(const assay_json *object, const char *key, int count, double *values_out);

#endif
