/* json.h - the little that cJSON lacks: complete or not at all, through the context's memory. */
#ifndef ASSAY_CORE_JSON_H
#define ASSAY_CORE_JSON_H

#include <cjson/cJSON.h>
#include <stdbool.h>

#include "assay/context.h"

/* A new object at the end of an array; NULL when out of memory. */
cJSON *assay_json_append_object(cJSON *array);

/* Prints and deletes the tree.  complete: whether every addition to it worked.  *text_out is to be
 * released with assay_text_destroy.  Errors: MEMORY. */
assay_status assay_json_finish(assay_context *context, cJSON *root, bool complete, char **text_out);

#endif
