/* json.c - building JSON without half results. */
#include "core/json.h"

#include "core/alloc.h"
#include "core/context.h"

cJSON *assay_json_append_object(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    if (object && !cJSON_AddItemToArray(array, object)) {
        cJSON_Delete(object);
        return NULL;
    }
    return object;
}

assay_status assay_json_finish(assay_context *context, cJSON *root, bool complete, char **text_out)
{
    char *printed = complete ? cJSON_Print(root) : NULL;
    char *text    = printed ? assay_copy_text(context, printed) : NULL;
    cJSON_free(printed);
    cJSON_Delete(root);
    if (!text) {
        return assay_fail_memory(context, "a JSON text");
    }
    *text_out = text;
    return ASSAY_OK;
}
