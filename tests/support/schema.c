/* schema.c - a schema is walked with the value beside it. */
#include "support/schema.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
    char  *why;
    size_t size;
    char   path[256];
} judge;

static bool check(judge *j, const cJSON *schema, const cJSON *json);

static bool refuse(judge *j, const char *what)
{
    snprintf(j->why, j->size, "%s: %s", j->path, what);
    return false;
}

static bool is_type(const char *type, const cJSON *json)
{
    const double n = cJSON_IsNumber(json) ? json->valuedouble : 0.5;
    return (strcmp(type, "object") == 0 && cJSON_IsObject(json)) ||
           (strcmp(type, "array") == 0 && cJSON_IsArray(json)) ||
           (strcmp(type, "string") == 0 && cJSON_IsString(json)) ||
           (strcmp(type, "number") == 0 && cJSON_IsNumber(json)) ||
           (strcmp(type, "integer") == 0 && n == floor(n)) ||
           (strcmp(type, "null") == 0 && cJSON_IsNull(json));
}

static bool check_type(judge *j, const cJSON *types, const cJSON *json)
{
    if (cJSON_IsString(types)) {
        return is_type(types->valuestring, json) || refuse(j, "another type");
    }
    const cJSON *type;
    cJSON_ArrayForEach(type, types)
    {
        if (is_type(type->valuestring, json)) {
            return true;
        }
    }
    return refuse(j, "another type");
}

static bool check_enum(judge *j, const cJSON *values, const cJSON *json)
{
    const cJSON *value;
    cJSON_ArrayForEach(value, values)
    {
        if (cJSON_Compare(value, json, true)) {
            return true;
        }
    }
    return refuse(j, "not among the values");
}

static bool check_any(judge *j, const cJSON *schemas, const cJSON *json)
{
    const cJSON *schema;
    cJSON_ArrayForEach(schema, schemas)
    {
        if (check(j, schema, json)) {
            return true;
        }
    }
    return refuse(j, "none of the alternatives");
}

static bool check_below(judge *j, const char *name, const cJSON *schema, const cJSON *json)
{
    const size_t length = strlen(j->path);
    snprintf(j->path + length, sizeof j->path - length, "/%s", name);
    const bool ok   = check(j, schema, json);
    j->path[length] = '\0';
    return ok;
}

static bool check_required(judge *j, const cJSON *names, const cJSON *json)
{
    const cJSON *name;
    cJSON_ArrayForEach(name, names)
    {
        if (!cJSON_GetObjectItemCaseSensitive(json, name->valuestring)) {
            return refuse(j, name->valuestring);
        }
    }
    return true;
}

static bool check_members(judge *j, const cJSON *schema, const cJSON *json)
{
    const cJSON *properties = cJSON_GetObjectItemCaseSensitive(schema, "properties");
    const cJSON *others     = cJSON_GetObjectItemCaseSensitive(schema, "additionalProperties");
    const cJSON *member;
    cJSON_ArrayForEach(member, json)
    {
        const cJSON *own = cJSON_GetObjectItemCaseSensitive(properties, member->string);
        own              = own ? own : others;
        if (cJSON_IsFalse(own)) {
            return refuse(j, member->string);
        }
        if (cJSON_IsObject(own) && !check_below(j, member->string, own, member)) {
            return false;
        }
    }
    return true;
}

static bool check_items(judge *j, const cJSON *schema, const cJSON *json)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, json)
    {
        if (!check_below(j, "item", schema, item)) {
            return false;
        }
    }
    return true;
}

static bool check_keyword(judge *j, const cJSON *keyword, const cJSON *schema, const cJSON *json)
{
    const char *name = keyword->string;
    if (strcmp(name, "type") == 0) {
        return check_type(j, keyword, json);
    }
    if (strcmp(name, "enum") == 0) {
        return check_enum(j, keyword, json);
    }
    if (strcmp(name, "anyOf") == 0) {
        return check_any(j, keyword, json);
    }
    if (strcmp(name, "minimum") == 0) {
        return !cJSON_IsNumber(json) || json->valuedouble >= keyword->valuedouble ||
               refuse(j, "too small");
    }
    if (strcmp(name, "required") == 0) {
        return !cJSON_IsObject(json) || check_required(j, keyword, json);
    }
    if (strcmp(name, "properties") == 0 || strcmp(name, "additionalProperties") == 0) {
        return !cJSON_IsObject(json) || check_members(j, schema, json);
    }
    if (strcmp(name, "items") == 0) {
        return !cJSON_IsArray(json) || check_items(j, keyword, json);
    }
    return strcmp(name, "description") == 0 || strcmp(name, "title") == 0 ||
           strcmp(name, "$schema") == 0 || refuse(j, "the schema has a keyword that is not known");
}

static bool check(judge *j, const cJSON *schema, const cJSON *json)
{
    const cJSON *keyword;
    cJSON_ArrayForEach(keyword, schema)
    {
        if (!check_keyword(j, keyword, schema, json)) {
            return false;
        }
    }
    return true;
}

bool schema_accepts(const cJSON *schema, const cJSON *json, char *why, size_t size)
{
    judge j = {why, size, ""};
    return check(&j, schema, json);
}
