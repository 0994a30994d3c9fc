/* method_list.c - methods and their parameters, for users and for JSON. */
#include <cjson/cJSON.h>

#include "assay/render.h"
#include "core/context.h"
#include "core/json.h"
#include "methods/run.h"

assay_status assay_method_params(assay_context *context, const char *method,
                                 assay_params **params_out)
{
    const assay_method *found  = NULL;
    const assay_status  status = assay_run_find(context, method, &found);
    return status != ASSAY_OK ? status : assay_params_create(context, found->params, params_out);
}

static const char *const TYPE_NAMES[] = {"int", "real", "bool", "choice", "path"};

static bool add_range(cJSON *json, const assay_param_desc *desc)
{
    switch (desc->type) {
    case ASSAY_PARAM_CHOICE: return cJSON_AddStringToObject(json, "choices", desc->choices);
    case ASSAY_PARAM_BOOL:
    case ASSAY_PARAM_PATH: return true;
    case ASSAY_PARAM_INT:
        if (desc->maximum == ASSAY_PARAM_INF) {
            return cJSON_AddNumberToObject(json, "minimum", desc->minimum) &&
                   cJSON_AddStringToObject(json, "maximum", "inf");
        }
        break;
    case ASSAY_PARAM_REAL: break;
    }
    return cJSON_AddNumberToObject(json, "minimum", desc->minimum) &&
           cJSON_AddNumberToObject(json, "maximum", desc->maximum);
}

static bool add_param(cJSON *list, const assay_param_desc *desc)
{
    cJSON *json = assay_json_append_object(list);
    return json && cJSON_AddStringToObject(json, "name", desc->name) &&
           cJSON_AddStringToObject(json, "type", TYPE_NAMES[desc->type]) &&
           cJSON_AddStringToObject(json, "unit", desc->unit) &&
           cJSON_AddStringToObject(json, "default", desc->default_value) && add_range(json, desc) &&
           cJSON_AddStringToObject(json, "summary", desc->summary) &&
           cJSON_AddStringToObject(json, "source", desc->source);
}

static bool add_method(cJSON *list, const assay_method_info *method)
{
    cJSON *json   = assay_json_append_object(list);
    cJSON *params = NULL;
    bool   ok     = json && cJSON_AddStringToObject(json, "name", method->name) &&
              cJSON_AddStringToObject(json, "summary", method->summary) &&
              (params = cJSON_AddArrayToObject(json, "params")) != NULL;
    for (const assay_param_desc *p = method->params; ok && p->name; p++) {
        ok = add_param(params, p);
    }
    return ok;
}

assay_status assay_methods_json(assay_context *context, const char *method, char **text_out)
{
    const assay_method *only = NULL;
    if (method) {
        const assay_status status = assay_run_find(context, method, &only);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    cJSON *root = cJSON_CreateObject();
    cJSON *list = root ? cJSON_AddArrayToObject(root, "methods") : NULL;
    bool   ok   = list != NULL;
    for (int i = 0; ok && i < assay_method_count(); i++) {
        const assay_method_info info = assay_method_at(i);
        if (!only || info.params == only->params) {
            ok = add_method(list, &info);
        }
    }
    return assay_json_finish(context, root, ok, text_out);
}
