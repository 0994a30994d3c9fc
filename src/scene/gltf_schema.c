/* gltf_schema.c - Invariant: behind the check, every member that assay reads has the type, length,
 * range and target that the table says, so nothing that reads it later need look again.
 *
 * tinygltf drops a member of the wrong type without a word (a node's mesh given as "3" is no mesh),
 * and a picture without that mesh would pass for the truth. */
#include "scene/gltf_schema.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"

/* A place in the document, as a chain on the stack up to the root. */
typedef struct place {
    const struct place *parent;
    const char         *name;  /* or NULL */
    uint32_t            index; /* where name is NULL */
} place;

static size_t write_place(const place *at, char *text, size_t size)
{
    size_t used = 0;
    if (at->parent) {
        used = write_place(at->parent, text, size);
    }
    if (used + 1 >= size) {
        return used;
    }
    const char *slash = used ? "/" : "";
    const int   more  = at->name ? snprintf(text + used, size - used, "%s%s", slash, at->name)
                                 : snprintf(text + used, size - used, "%s%u", slash, at->index);
    used += more > 0 ? (size_t)more : 0;
    return used < size ? used : size - 1;
}

static assay_status fail_at(const assay_gltf_schema *schema, const place *at, assay_status status,
                            const char *wrong)
{
    char text[256] = "";
    write_place(at, text, sizeof text);
    return assay_fail(schema->context, status, "%s: %s: %s", schema->file, text[0] ? text : "root",
                      wrong);
}

static assay_status wrong_type(const assay_gltf_schema *schema, const place *at,
                               const char *expected, const assay_json *found)
{
    static const char *const names[] = {"null",     "true or false", "a number",
                                        "a string", "an array",      "an object"};
    char                     text[128];
    snprintf(text, sizeof text, "must be %s, is %s", expected, names[found->type]);
    return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
}

/* ---- single values ---- */

static assay_status check_number(const assay_gltf_schema *schema, const place *at,
                                 const assay_gltf_rule *rule, const assay_json *value)
{
    char text[128];
    if (value->type != ASSAY_JSON_NUMBER) {
        return wrong_type(schema, at, "a number", value);
    }
    const double x = value->number;
    if (rule->minimum == 0.0 && rule->maximum == 0.0) {
        return ASSAY_OK;
    }
    if (x <= rule->maximum && (rule->above ? x > rule->minimum : x >= rule->minimum)) {
        return ASSAY_OK;
    }
    if (rule->maximum == HUGE_VAL) {
        snprintf(text, sizeof text, "is %g, must be %s %g", x,
                 rule->above ? ">" : ">=", rule->minimum);
    } else {
        snprintf(text, sizeof text, "is %.9g, must be in %c%g, %g]", x, rule->above ? '(' : '[',
                 rule->minimum, rule->maximum);
    }
    return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
}

static assay_status check_count(const assay_gltf_schema *schema, const place *at,
                                const assay_gltf_rule *rule, const assay_json *value)
{
    const double maximum = rule->maximum > 0.0 ? rule->maximum : 1e14;
    char         text[128];
    if (value->type != ASSAY_JSON_NUMBER) {
        return wrong_type(schema, at, "a whole number", value);
    }
    if (value->number == floor(value->number) && value->number >= rule->minimum &&
        value->number <= maximum) {
        return ASSAY_OK;
    }
    snprintf(text, sizeof text, "is %.17g, must be a whole number from %.0f to %.0f", value->number,
             rule->minimum, maximum);
    return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
}

static const char *const array_names[ASSAY_GLTF_ARRAY_COUNT] = {
    "accessors", "animations", "buffers", "bufferViews", "cameras", "images", "lights",
    "materials", "meshes",     "nodes",   "samplers",    "scenes",  "skins",  "textures"};

static assay_status check_index(const assay_gltf_schema *schema, const place *at,
                                assay_gltf_array array, const assay_json *value)
{
    const uint32_t length = schema->lengths[array];
    char           text[128];
    if (value->type != ASSAY_JSON_NUMBER) {
        return wrong_type(schema, at, "an index", value);
    }
    if (value->number == floor(value->number) && value->number >= 0.0 && value->number < length) {
        return ASSAY_OK;
    }
    snprintf(text, sizeof text, "is %.9g, but there are %u %s", value->number, length,
             array_names[array]);
    return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
}

/* Whether `word` is one of those in `words`, which '|' separates. */
static bool is_one_of(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *w = words; w; w = strchr(w, '|') ? strchr(w, '|') + 1 : NULL) {
        if (strncmp(w, word, length) == 0 && (w[length] == '|' || w[length] == 0)) {
            return length > 0;
        }
    }
    return false;
}

static assay_status check_choice(const assay_gltf_schema *schema, const place *at,
                                 const assay_gltf_rule *rule, const assay_json *value)
{
    char text[256], word[32] = "";
    if (rule->kind == ASSAY_GLTF_CODE) {
        if (value->type != ASSAY_JSON_NUMBER) {
            return wrong_type(schema, at, "a number", value);
        }
        snprintf(word, sizeof word, "%.15g", value->number);
    } else if (value->type != ASSAY_JSON_TEXT) {
        return wrong_type(schema, at, "a string", value);
    }
    const char *given = rule->kind == ASSAY_GLTF_CODE ? word : value->text;
    if (is_one_of(rule->what, given)) {
        return ASSAY_OK;
    }
    snprintf(text, sizeof text, "is %.40s, must be one of %s", given, rule->what);
    return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
}

/* ---- composed values ---- */

static assay_status check_members(assay_gltf_schema *schema, const place *at,
                                  const assay_gltf_type *type, const assay_json *object);

static assay_status check_index_map(const assay_gltf_schema *schema, const place *at,
                                    assay_gltf_array array, const assay_json *map)
{
    if (map->type != ASSAY_JSON_OBJECT) {
        return wrong_type(schema, at, "an object", map);
    }
    for (const assay_json *m = map->child; m; m = m->next) {
        const place        here   = {at, m->key, 0};
        const assay_status status = check_index(schema, &here, array, m);
        if (status != ASSAY_OK) {
            return status;
        }
        for (const assay_json *other = m->next; other && map->count <= 64; other = other->next) {
            if (strcmp(other->key, m->key) == 0) {
                return fail_at(schema, &here, ASSAY_ERR_FORMAT, "is given twice");
            }
        }
    }
    if (map->count > 64) {
        return fail_at(schema, at, ASSAY_ERR_LIMIT, "has more than 64 members");
    }
    return ASSAY_OK;
}

static assay_status check_element(assay_gltf_schema *schema, const place *at,
                                  const assay_gltf_rule *rule, const assay_gltf_type *type,
                                  const assay_json *element)
{
    switch (rule->kind) {
    case ASSAY_GLTF_NUMBERS: return check_number(schema, at, rule, element);
    case ASSAY_GLTF_INDICES: return check_index(schema, at, rule->array, element);
    case ASSAY_GLTF_INDEX_MAPS: return check_index_map(schema, at, rule->array, element);
    case ASSAY_GLTF_OBJECTS: return check_members(schema, at, type, element);
    default: break;
    }
    return element->type == ASSAY_JSON_TEXT ? ASSAY_OK
                                            : wrong_type(schema, at, "a string", element);
}

static assay_status check_array(assay_gltf_schema *schema, const place *at,
                                const assay_gltf_rule *rule, const assay_json *array)
{
    const assay_gltf_type *type =
        rule->kind == ASSAY_GLTF_OBJECTS ? assay_gltf_find_type(rule->what) : NULL;
    if (array->type != ASSAY_JSON_ARRAY) {
        return wrong_type(schema, at, "an array", array);
    }
    if (rule->count && array->count != (uint32_t)rule->count) {
        char text[64];
        snprintf(text, sizeof text, "must have %d elements, has %u", rule->count, array->count);
        return fail_at(schema, at, ASSAY_ERR_FORMAT, text);
    }
    uint32_t index = 0;
    for (const assay_json *e = array->child; e; e = e->next, index++) {
        const place        here   = {at, NULL, index};
        const assay_status status = check_element(schema, &here, rule, type, e);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

static assay_status check_value(assay_gltf_schema *schema, const place *at,
                                const assay_gltf_rule *rule, const assay_json *value)
{
    switch (rule->kind) {
    case ASSAY_GLTF_COUNT: return check_count(schema, at, rule, value);
    case ASSAY_GLTF_NUMBER: return check_number(schema, at, rule, value);
    case ASSAY_GLTF_WORD:
    case ASSAY_GLTF_CODE: return check_choice(schema, at, rule, value);
    case ASSAY_GLTF_INDEX: return check_index(schema, at, rule->array, value);
    case ASSAY_GLTF_INDEX_MAP: return check_index_map(schema, at, rule->array, value);
    case ASSAY_GLTF_OBJECT:
        return check_members(schema, at, assay_gltf_find_type(rule->what), value);
    case ASSAY_GLTF_TEXT:
        return value->type == ASSAY_JSON_TEXT ? ASSAY_OK
                                              : wrong_type(schema, at, "a string", value);
    case ASSAY_GLTF_BOOL:
        return value->type == ASSAY_JSON_BOOL ? ASSAY_OK
                                              : wrong_type(schema, at, "true or false", value);
    default: break;
    }
    return check_array(schema, at, rule, value);
}

/* Objects of extensions: checked where there is a type for them at this place, else told of. */
static assay_status check_extensions(assay_gltf_schema *schema, const place *at,
                                     const assay_gltf_type *type, const assay_json *extensions)
{
    if (extensions->type != ASSAY_JSON_OBJECT) {
        return wrong_type(schema, at, "an object", extensions);
    }
    for (const assay_json *e = extensions->child; e; e = e->next) {
        char name[128];
        snprintf(name, sizeof name, "%s.%s", type->name, e->key);
        const assay_gltf_type *known  = assay_gltf_find_type(name);
        const place            here   = {at, e->key, 0};
        assay_status           status = ASSAY_OK;
        if (known) {
            status = check_members(schema, &here, known, e);
        } else if (!assay_gltf_extension_supported(e->key) && schema->on_extension) {
            schema->on_extension(schema->user, e->key);
        }
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

static const assay_gltf_rule *find_rule(const assay_gltf_type *type, const char *member)
{
    for (int i = 0; i < type->rule_count; i++) {
        if (strcmp(type->rules[i].member, member) == 0) {
            return &type->rules[i];
        }
    }
    return NULL;
}

static assay_status check_required(const assay_gltf_schema *schema, const place *at,
                                   const assay_gltf_type *type, uint32_t seen)
{
    for (int i = 0; i < type->rule_count; i++) {
        if (type->rules[i].required && !(seen >> i & 1)) {
            const place here = {at, type->rules[i].member, 0};
            return fail_at(schema, &here, ASSAY_ERR_FORMAT, "is missing");
        }
    }
    return ASSAY_OK;
}

static assay_status check_members(assay_gltf_schema *schema, const place *at,
                                  const assay_gltf_type *type, const assay_json *object)
{
    uint32_t seen            = 0;
    bool     seen_extensions = false;
    if (object->type != ASSAY_JSON_OBJECT) {
        return wrong_type(schema, at, "an object", object);
    }
    for (const assay_json *m = object->child; m; m = m->next) {
        const place            here       = {at, m->key, 0};
        const assay_gltf_rule *rule       = find_rule(type, m->key);
        const bool             extensions = strcmp(m->key, "extensions") == 0;
        const uint32_t         bit        = rule ? UINT32_C(1) << (rule - type->rules) : 0;
        assay_status           status     = ASSAY_OK;
        if ((seen & bit) || (extensions && seen_extensions)) {
            return fail_at(schema, &here, ASSAY_ERR_FORMAT, "is given twice");
        }
        seen |= bit;
        seen_extensions |= extensions;
        if (rule) {
            status = check_value(schema, &here, rule, m);
        } else if (extensions) {
            status = check_extensions(schema, &here, type, m);
        } else if (type->strict) {
            status = fail_at(schema, &here, ASSAY_ERR_FORMAT, "is not known here");
        }
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return check_required(schema, at, type, seen);
}

/* ---- the document ---- */

/* "2.x" is read; anything else is not. */
static assay_status check_version(const assay_gltf_schema *schema, const assay_json *root)
{
    static const place root_place = {NULL, "asset", 0}, here = {&root_place, "version", 0};
    const assay_json  *asset   = assay_json_member(root, "asset");
    const assay_json  *version = assay_json_member(asset, "version");
    const assay_json  *least   = assay_json_member(asset, "minVersion");
    char               text[96];
    if (!version || version->type != ASSAY_JSON_TEXT) {
        return fail_at(schema, &here, ASSAY_ERR_FORMAT, "is missing");
    }
    const char *wanted = least && least->type == ASSAY_JSON_TEXT && strcmp(least->text, "2.0") != 0
                             ? least->text
                             : version->text;
    const bool  newer  = wanted != version->text;
    if (strncmp(wanted, "2.", 2) == 0 && !newer) {
        return ASSAY_OK;
    }
    snprintf(text, sizeof text, "glTF %.20s is not supported, only 2.0 is", wanted);
    return fail_at(schema, &here, ASSAY_ERR_UNSUPPORTED, text);
}

static assay_status check_required_extensions(const assay_gltf_schema *schema,
                                              const assay_json        *root)
{
    static const place here     = {NULL, "extensionsRequired", 0};
    const assay_json  *required = assay_json_member(root, "extensionsRequired");
    char               text[128];
    for (const assay_json *e = required ? required->child : NULL; e; e = e->next) {
        if (e->type == ASSAY_JSON_TEXT && !assay_gltf_extension_supported(e->text)) {
            snprintf(text, sizeof text, "%.64s is not supported", e->text);
            return fail_at(schema, &here, ASSAY_ERR_UNSUPPORTED, text);
        }
    }
    return ASSAY_OK;
}

/* A camera has the projection that its type names. */
static assay_status check_cameras(const assay_gltf_schema *schema, const assay_json *root)
{
    static const place cameras = {NULL, "cameras", 0};
    const assay_json  *array   = assay_json_member(root, "cameras");
    uint32_t           index   = 0;
    for (const assay_json *c = array ? array->child : NULL; c; c = c->next, index++) {
        const char *type = assay_json_text(c, "type", "");
        if (!assay_json_member(c, type)) {
            const place camera = {&cameras, NULL, index}, here = {&camera, type, 0};
            return fail_at(schema, &here, ASSAY_ERR_FORMAT, "is missing");
        }
    }
    return ASSAY_OK;
}

assay_status assay_gltf_check_document(assay_gltf_schema *schema, const assay_json *root)
{
    const place at = {NULL, "", 0};
    for (int i = 0; i < ASSAY_GLTF_ARRAY_COUNT; i++) {
        const assay_json *array = assay_json_member(root, array_names[i]);
        schema->lengths[i]      = array && array->type == ASSAY_JSON_ARRAY ? array->count : 0;
    }
    const assay_json *extension =
        assay_json_member(assay_json_member(root, "extensions"), "KHR_lights_punctual");
    const assay_json *lights           = assay_json_member(extension, "lights");
    schema->lengths[ASSAY_GLTF_LIGHTS] = lights ? lights->count : 0;
    assay_status status                = check_version(schema, root);
    if (status == ASSAY_OK) {
        status = check_required_extensions(schema, root);
    }
    if (status == ASSAY_OK) {
        status = check_members(schema, &at, assay_gltf_find_type("root"), root);
    }
    if (status == ASSAY_OK) {
        status = check_cameras(schema, root);
    }
    const assay_json *used = assay_json_member(root, "extensionsUsed");
    for (const assay_json *e = used && status == ASSAY_OK ? used->child : NULL; e; e = e->next) {
        if (!assay_gltf_extension_supported(e->text) && schema->on_extension) {
            schema->on_extension(schema->user, e->text);
        }
    }
    return status;
}

assay_status assay_gltf_check_object(assay_gltf_schema *schema, const assay_json *object,
                                     const char *type, const char *place_name)
{
    const place at = {NULL, place_name, 0};
    return check_members(schema, &at, assay_gltf_find_type(type), object);
}
