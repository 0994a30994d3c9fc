/* params.c - values for a parameter table, each kept as a number and as its canonical text.
 *
 * Numbers are read in the C locale by strtod alone and printed with 17 significant digits, so that
 * a value taken from an image's metadata gives the very same render. */
#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/params.h"
#include "core/alloc.h"
#include "core/context.h"

enum { VALUE_TEXT = 40 };

typedef struct {
    double number; /* the value; the index of the word for a choice */
    char   text[VALUE_TEXT];
    char  *path; /* of ASSAY_PARAM_PATH: owned, NULL where there is none */
} param_value;

struct assay_params {
    assay_context          *context;
    const assay_param_desc *table;
    param_value            *values;
};

static int table_length(const assay_param_desc *table)
{
    int count = 0;
    while (table[count].name) {
        count++;
    }
    return count;
}

static int find(const assay_param_desc *table, const char *name)
{
    for (int i = 0; table[i].name; i++) {
        if (strcmp(table[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

/* Index of a word among "a|b|c", or -1. */
static int find_choice(const char *choices, const char *word)
{
    const size_t length = strlen(word);
    int          index  = 0;
    for (const char *at = choices; length > 0; index++) {
        const char  *end  = strchr(at, '|');
        const size_t size = end ? (size_t)(end - at) : strlen(at);
        if (size == length && memcmp(at, word, size) == 0) {
            return index;
        }
        if (!end) {
            break;
        }
        at = end + 1;
    }
    return -1;
}

static void describe_range(const assay_param_desc *desc, char *text, size_t size)
{
    switch (desc->type) {
    case ASSAY_PARAM_BOOL: snprintf(text, size, "on or off"); break;
    case ASSAY_PARAM_CHOICE: snprintf(text, size, "one of %s", desc->choices); break;
    case ASSAY_PARAM_PATH: snprintf(text, size, "a path"); break;
    case ASSAY_PARAM_INT:
        if (desc->maximum == ASSAY_PARAM_INF) {
            snprintf(text, size, "a whole number from %.0f, or inf", desc->minimum);
        } else {
            snprintf(text, size, "a whole number from %.0f to %.0f", desc->minimum, desc->maximum);
        }
        break;
    case ASSAY_PARAM_REAL:
        snprintf(text, size, "a number from %g to %g", desc->minimum, desc->maximum);
        break;
    }
}

/* Only what strtod takes whole, and no white space, hexadecimal or "nan". */
static bool read_number(const char *text, double *number_out)
{
    if (!*text || strspn(text, "+-.0123456789eE") != strlen(text)) {
        return false;
    }
    char *end    = NULL;
    errno        = 0;
    double value = strtod(text, &end);
    if (*end || !isfinite(value)) {
        return false;
    }
    *number_out = value == 0.0 ? 0.0 : value; /* no negative zero */
    return true;
}

/* The shortest text that reads back as the same double. */
static void print_number(double number, char *text, size_t size)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, size, "%.*g", digits, number);
        if (strtod(text, NULL) == number) {
            return;
        }
    }
}

static bool parse(const assay_param_desc *desc, const char *text, param_value *value_out)
{
    param_value value = {0};
    switch (desc->type) {
    case ASSAY_PARAM_BOOL:
        value.number = strcmp(text, "on") == 0;
        if (value.number == 0.0 && strcmp(text, "off") != 0) {
            return false;
        }
        snprintf(value.text, VALUE_TEXT, "%s", text);
        break;
    case ASSAY_PARAM_CHOICE: {
        const int index = find_choice(desc->choices, text);
        if (index < 0 || strlen(text) >= VALUE_TEXT) {
            return false;
        }
        value.number = index;
        snprintf(value.text, VALUE_TEXT, "%s", text);
        break;
    }
    case ASSAY_PARAM_PATH: break;
    case ASSAY_PARAM_INT:
        if (desc->maximum == ASSAY_PARAM_INF && strcmp(text, "inf") == 0) {
            value.number = ASSAY_PARAM_INF;
            snprintf(value.text, VALUE_TEXT, "inf");
            break;
        }
        if (!read_number(text, &value.number) || value.number != floor(value.number) ||
            value.number < desc->minimum || value.number > desc->maximum ||
            value.number >= ASSAY_PARAM_INF) {
            return false;
        }
        snprintf(value.text, VALUE_TEXT, "%.0f", value.number);
        break;
    case ASSAY_PARAM_REAL:
        if (!read_number(text, &value.number) || value.number < desc->minimum ||
            value.number > desc->maximum) {
            return false;
        }
        print_number(value.number, value.text, VALUE_TEXT);
        break;
    }
    *value_out = value;
    return true;
}

assay_status assay_params_create(assay_context *context, const assay_param_desc *table,
                                 assay_params **params_out)
{
    const int     count  = table_length(table);
    assay_params *params = assay_allocate(context, 1, sizeof *params);
    param_value  *values = assay_allocate(context, (size_t)count, sizeof *values);
    if (!params || !values) {
        assay_release(context, params);
        assay_release(context, values);
        return assay_fail_memory(context, "parameters");
    }
    for (int i = 0; i < count; i++) {
        const bool ok = parse(&table[i], table[i].default_value, &values[i]);
        assert(ok && "a default must be legal");
        (void)ok;
    }
    *params     = (assay_params){context, table, values};
    *params_out = params;
    return ASSAY_OK;
}

void assay_params_destroy(assay_params *params)
{
    if (params) {
        for (int i = 0; params->table[i].name; i++) {
            assay_release(params->context, params->values[i].path);
        }
        assay_release(params->context, params->values);
        assay_release(params->context, params);
    }
}

static assay_status set_path(assay_params *params, int index, const char *value)
{
    char *path = *value ? assay_copy_text(params->context, value) : NULL;
    if (*value && !path) {
        return assay_fail_memory(params->context, "parameters");
    }
    assay_release(params->context, params->values[index].path);
    params->values[index].path = path;
    return ASSAY_OK;
}

static assay_status fail_unknown(const assay_params *params, const char *name)
{
    char   known[512] = "";
    size_t used       = 0;
    for (int i = 0; params->table[i].name; i++) {
        const int n = snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                               params->table[i].name);
        if (n < 0 || (size_t)n >= sizeof known - used) {
            break;
        }
        used += (size_t)n;
    }
    return assay_fail(params->context, ASSAY_ERR_ARGUMENT,
                      "unknown parameter '%.64s'; there are: %s", name, known);
}

assay_status assay_params_set(assay_params *params, const char *name, const char *value)
{
    const int index = find(params->table, name);
    if (index < 0) {
        return fail_unknown(params, name);
    }
    const assay_param_desc *desc = &params->table[index];
    if (desc->type == ASSAY_PARAM_PATH) {
        return set_path(params, index, value);
    }
    if (!parse(desc, value, &params->values[index])) {
        char range[160];
        describe_range(desc, range, sizeof range);
        return assay_fail(params->context, ASSAY_ERR_ARGUMENT,
                          "parameter '%s' takes %s, not '%.64s'", name, range, value);
    }
    return ASSAY_OK;
}

const char *assay_params_text(const assay_params *params, const char *name)
{
    const int index = find(params->table, name);
    if (index < 0) {
        return NULL;
    }
    return params->values[index].path ? params->values[index].path : params->values[index].text;
}

static double number_of(const assay_params *params, const char *name, assay_param_type type)
{
    const int index = find(params->table, name);
    assert(index >= 0 && params->table[index].type == type);
    (void)type;
    return params->values[index].number;
}

double assay_params_real(const assay_params *params, const char *name)
{
    return number_of(params, name, ASSAY_PARAM_REAL);
}

int assay_params_int(const assay_params *params, const char *name)
{
    return (int)number_of(params, name, ASSAY_PARAM_INT);
}

bool assay_params_bool(const assay_params *params, const char *name)
{
    return number_of(params, name, ASSAY_PARAM_BOOL) != 0.0;
}

int assay_params_choice(const assay_params *params, const char *name)
{
    return (int)number_of(params, name, ASSAY_PARAM_CHOICE);
}

const assay_param_desc *assay_params_table(const assay_params *params) { return params->table; }
