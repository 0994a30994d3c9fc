/* gltf_json_member.c - looking into a tree that was checked: what is there has the right type. */
#include <string.h>

#include "scene/gltf_json.h"
#include "scene/material.h"

const assay_json *assay_json_member(const assay_json *object, const char *key)
{
    for (const assay_json *m = object ? object->child : NULL; m; m = m->next) {
        if (m->key && strcmp(m->key, key) == 0) {
            return m;
        }
    }
    return NULL;
}

double assay_json_number(const assay_json *object, const char *key, double otherwise)
{
    const assay_json *member = assay_json_member(object, key);
    return member ? member->number : otherwise;
}

bool assay_json_bool(const assay_json *object, const char *key, bool otherwise)
{
    const assay_json *member = assay_json_member(object, key);
    return member ? member->boolean : otherwise;
}

const char *assay_json_text(const assay_json *object, const char *key, const char *otherwise)
{
    const assay_json *member = assay_json_member(object, key);
    return member ? member->text : otherwise;
}

uint32_t assay_json_index(const assay_json *object, const char *key)
{
    const assay_json *member = assay_json_member(object, key);
    return member ? (uint32_t)member->number : ASSAY_NONE;
}

bool assay_json_numbers(const assay_json *object, const char *key, int count, double *values_out)
{
    const assay_json *member = assay_json_member(object, key);
    if (!member) {
        return false;
    }
    const assay_json *element = member->child;
    for (int i = 0; i < count && element; i++, element = element->next) {
        values_out[i] = element->number;
    }
    return true;
}
