/* verdict_json.c - a verdict for programs: docs/verdict.schema.json.
 *
 * Invariant: a member is there or null, never a number that was not measured; what JSON has no
 * number for (infinities) stands in the hexadecimal text beside it. */
#include <math.h>
#include <stdio.h>

#include "core/context.h"
#include "core/json.h"
#include "oracle/verdict/verdict_data.h"

static bool add_number(cJSON *object, const char *name, double value)
{
    return (isfinite(value) ? cJSON_AddNumberToObject(object, name, value)
                            : cJSON_AddNullToObject(object, name)) != NULL;
}

/* The number as decimal and, as `NAME_hex`, in its bits. */
static bool add_exact(cJSON *object, const char *name, double value)
{
    char hex[40], hex_name[32];
    snprintf(hex, sizeof hex, "%a", value);
    snprintf(hex_name, sizeof hex_name, "%s_hex", name);
    return add_number(object, name, value) &&
           (isnan(value) ? cJSON_AddNullToObject(object, hex_name)
                         : cJSON_AddStringToObject(object, hex_name, hex)) != NULL;
}

static bool add_text(cJSON *object, const char *name, const char *text)
{
    return (text ? cJSON_AddStringToObject(object, name, text)
                 : cJSON_AddNullToObject(object, name)) != NULL;
}

static bool add_place(cJSON *object, const assay_place *place)
{
    if (place->kind == ASSAY_PLACE_NONE) {
        return cJSON_AddNullToObject(object, "place") != NULL;
    }
    cJSON *json = cJSON_AddObjectToObject(object, "place");
    if (place->kind == ASSAY_PLACE_ROW) {
        return json && add_number(json, "row", (double)place->row) &&
               add_number(json, "column", place->column);
    }
    return json && add_number(json, "x", place->x) && add_number(json, "y", place->y) &&
           add_number(json, "width", place->width) && add_number(json, "height", place->height);
}

static bool add_finding(cJSON *list, const assay_finding *f)
{
    cJSON *json = assay_json_append_object(list);
    return json && add_text(json, "stage", f->stage) && add_text(json, "array", f->array) &&
           add_text(json, "channel", f->channel) && add_text(json, "test", f->test) &&
           add_text(json, "verdict", assay_verdict_kind_text(f->kind)) &&
           add_number(json, "values", (double)f->values) &&
           add_number(json, "unjudged", (double)f->unjudged) &&
           add_number(json, "vacuous", (double)f->vacuous) && add_place(json, &f->place) &&
           add_exact(json, "candidate", f->candidate) &&
           add_exact(json, "reference", f->reference) && add_number(json, "effect", f->effect) &&
           add_number(json, "bound", f->bound) && add_number(json, "in_bounds", f->in_bounds) &&
           add_number(json, "ulps", f->ulps) && add_number(json, "p", f->p) &&
           add_number(json, "log_p", f->log_p) && add_number(json, "visible", f->visible) &&
           add_number(json, "width", f->width) && add_number(json, "width_90", f->width_90) &&
           add_text(json, "meaning", f->meaning);
}

static bool add_settings(cJSON *root, const assay_verdict *verdict)
{
    cJSON *json = cJSON_AddObjectToObject(root, "settings");
    bool   ok   = json != NULL;
    for (size_t i = 0; ok && i < verdict->setting_count; i++) {
        ok = add_text(json, verdict->settings[i].key, verdict->settings[i].value);
    }
    return ok;
}

static bool add_first(cJSON *root, int first)
{
    return (first < 0 ? cJSON_AddNullToObject(root, "first")
                      : cJSON_AddNumberToObject(root, "first", first)) != NULL;
}

static bool add_head(cJSON *root, const assay_verdict *verdict, const char *summary)
{
    const assay_verdict_kind kind = assay_verdict_whole(verdict);
    return add_text(root, "format", "assay-verdict") && add_number(root, "version", 1) &&
           add_text(root, "tool", assay_version()) &&
           add_text(root, "candidate", verdict->candidate) &&
           add_text(root, "reference", verdict->reference) &&
           add_text(root, "verdict", assay_verdict_kind_text(kind)) &&
           add_number(root, "exit_code", (double)kind) &&
           add_first(root, assay_verdict_first(verdict)) && add_text(root, "summary", summary);
}

assay_status assay_verdict_json(const assay_verdict *verdict, char **text_out)
{
    char              *summary = NULL;
    const assay_status status  = assay_verdict_paragraph(verdict, &summary);
    if (status != ASSAY_OK) {
        return status;
    }
    cJSON *root = cJSON_CreateObject();
    bool   ok   = root && add_head(root, verdict, summary) && add_settings(root, verdict);
    cJSON *list = ok ? cJSON_AddArrayToObject(root, "findings") : NULL;
    ok          = list != NULL;
    for (size_t i = 0; ok && i < verdict->count; i++) {
        ok = add_finding(list, &verdict->findings[i]);
    }
    assay_text_destroy(verdict->context, summary);
    return assay_json_finish(verdict->context, root, ok, text_out);
}
