/* schema.h - JSON Schema, as much of it as docs/verdict.schema.json uses: type, enum, required,
 * properties, additionalProperties, items, anyOf, minimum.  A keyword that it does not know, and
 * that is no remark, is an error. */
#ifndef ASSAY_TESTS_SCHEMA_H
#define ASSAY_TESTS_SCHEMA_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* False, and why (with the place), where json does not follow the schema. */
bool schema_accepts(const cJSON *schema, const cJSON *json, char *why, size_t size);

#endif
