/* stage_run.c - from a bundle to a stage's arrays.
 *
 * Invariant: what a stage sees is finite, or is what its table allows; rows are judged by the
 * stage, which knows what they are. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/array_data.h"
#include "oracle/stage/stage.h"

enum { KEY_SIZE = 160 };

/* ---- the manifest ---- */

const char *stage_manifest_text(const assay_bundle_reader *bundle, const char *name)
{
    char        key[KEY_SIZE];
    const char *method = assay_bundle_text(bundle, "assay:method");
    const char *text   = assay_bundle_text(bundle, name);
    if (!text) {
        snprintf(key, sizeof key, "assay:%s", name);
        text = assay_bundle_text(bundle, key);
    }
    if (!text && method) {
        snprintf(key, sizeof key, "assay:%s.%s", method, name);
        text = assay_bundle_text(bundle, key);
    }
    return text;
}

static assay_status take_manifest(stage_run *run, assay_params *params)
{
    for (const assay_param_desc *p = run->stage->info.params; p->name; p++) {
        const char        *text   = stage_manifest_text(run->bundle, p->name);
        const assay_status status = text ? assay_params_set(params, p->name, text) : ASSAY_OK;
        if (status != ASSAY_OK) {
            char words[512];
            snprintf(words, sizeof words, "%s", assay_context_error(run->context));
            return assay_fail(run->context, ASSAY_ERR_FORMAT, "%s: bundle: manifest.json: %s",
                              assay_bundle_path(run->bundle), words);
        }
    }
    return ASSAY_OK;
}

static assay_status take_overrides(stage_run *run, assay_params *params, int count,
                                   const char *const *overrides)
{
    for (int i = 0; i < count; i++) {
        char        name[KEY_SIZE];
        const char *equals = strchr(overrides[i], '=');
        if (!equals || equals - overrides[i] >= KEY_SIZE) {
            return assay_fail(run->context, ASSAY_ERR_ARGUMENT,
                              "'%.80s' is not of the form key=value", overrides[i]);
        }
        snprintf(name, sizeof name, "%.*s", (int)(equals - overrides[i]), overrides[i]);
        const assay_status status = assay_params_set(params, name, equals + 1);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

/* ---- inputs ---- */

static size_t words_in(const char *text)
{
    size_t words = 1;
    for (; *text; text++) {
        words += *text == ' ';
    }
    return words;
}

/* The number that stands for '#' in a name; -1 where the name is another one. */
static long number_of(const char *pattern, const char *mark, const char *name)
{
    const size_t before = (size_t)(mark - pattern);
    char        *end    = NULL;
    if (strncmp(name, pattern, before) != 0 || name[before] < '0' || name[before] > '9') {
        return -1;
    }
    const long number = strtol(name + before, &end, 10);
    return strcmp(end, mark + 1) == 0 ? number : -1;
}

bool stage_find_name(const assay_bundle_reader *bundle, const char *pattern,
                     char name[ASSAY_BUNDLE_NAME])
{
    const char *mark = strchr(pattern, '#');
    long        last = -1;
    for (int i = 0; mark && i < assay_bundle_count(bundle); i++) {
        assay_bundle_entry entry = {.name = NULL};
        if (assay_bundle_entry_at(bundle, i, &entry) == ASSAY_OK &&
            number_of(pattern, mark, entry.name) > last) {
            last = number_of(pattern, mark, entry.name);
            snprintf(name, ASSAY_BUNDLE_NAME, "%s", entry.name);
        }
    }
    if (!mark) {
        snprintf(name, ASSAY_BUNDLE_NAME, "%s", pattern);
    }
    return mark ? last >= 0 : assay_bundle_has(bundle, name);
}

/* Whether the largest number of a '#' is that of the last batch, where the bundle says how many
 * there are: sums of an earlier one are not what a result comes from. */
static bool is_last_batch(const assay_bundle_reader *bundle, const char *pattern, const char *name)
{
    static const char  batch[] = "/batch.#";
    const char        *at      = strstr(pattern, batch);
    char               ends[ASSAY_BUNDLE_NAME];
    assay_bundle_entry entry = {.name = NULL};
    if (!at) {
        return true;
    }
    snprintf(ends, sizeof ends, "%.*s/batch_end", (int)(at - pattern), pattern);
    return !assay_bundle_has(bundle, ends) ||
           assay_bundle_entry_of(bundle, ends, &entry) != ASSAY_OK || entry.shape[0] == 0 ||
           number_of(pattern, strchr(pattern, '#'), name) == (long)entry.shape[0] - 1;
}

bool stage_find_input(const assay_bundle_reader *bundle, const char *pattern,
                      char name[ASSAY_BUNDLE_NAME])
{
    return stage_find_name(bundle, pattern, name) && is_last_batch(bundle, pattern, name);
}

bool stage_can_run(const oracle_stage *stage, const assay_bundle_reader *bundle)
{
    for (const assay_stage_array *input = stage->info.inputs; input->name; input++) {
        char name[ASSAY_BUNDLE_NAME];
        if (!input->optional && !stage_find_input(bundle, input->name, name)) {
            return false;
        }
    }
    return true;
}

double stage_roundoff_of(const assay_bundle_entry *entry)
{
    return strcmp(entry->dtype, "float16") == 0   ? 0x1p-11
           : strcmp(entry->dtype, "float32") == 0 ? 0x1p-24
           : strcmp(entry->dtype, "uint32") == 0  ? 0.0
                                                  : 0x1p-53;
}

double stage_tiny_of(const assay_bundle_entry *entry)
{
    return strcmp(entry->dtype, "float16") == 0   ? 0x1p-25
           : strcmp(entry->dtype, "float32") == 0 ? 0x1p-149
           : strcmp(entry->dtype, "uint32") == 0  ? 0.0
                                                  : 0x1p-1074;
}

assay_status stage_fail_value(const stage_run *run, int input, size_t row, size_t column,
                              const char *why)
{
    const stage_table *t = &run->in[input];
    return assay_fail(run->context, ASSAY_ERR_DOMAIN, "%s: bundle: '%s', row %zu, column %zu: %s",
                      assay_bundle_path(run->bundle), t->name, row, column, why);
}

assay_status stage_fail_rows(const stage_run *run, int input, size_t wanted, const char *why)
{
    const stage_table *t = &run->in[input];
    return assay_fail(run->context, ASSAY_ERR_FORMAT, "%s: bundle: '%s' has %zu rows, not %zu: %s",
                      assay_bundle_path(run->bundle), t->name, t->rows, wanted, why);
}

assay_status stage_fail_columns(const stage_run *run, int input, size_t wanted)
{
    const stage_table *t = &run->in[input];
    return assay_fail(run->context, ASSAY_ERR_FORMAT, "%s: bundle: '%s' has %zu columns, not %zu",
                      assay_bundle_path(run->bundle), t->name, t->columns, wanted);
}

static assay_status check_values(const stage_run *run, int input)
{
    const assay_stage_array *desc = &run->stage->info.inputs[input];
    const stage_table       *t    = &run->in[input];
    for (size_t i = 0; i < t->rows * t->columns; i++) {
        const double x = t->values[i];
        if ((isnan(x) && !desc->may_be_nan) || (isinf(x) && !(desc->may_be_infinite && x > 0.0))) {
            return stage_fail_value(run, input, i / t->columns, i % t->columns,
                                    isnan(x) ? "a NaN" : "an infinite number");
        }
    }
    return ASSAY_OK;
}

static assay_status read_input(stage_run *run, int input)
{
    const assay_stage_array *desc  = &run->stage->info.inputs[input];
    stage_table             *t     = &run->in[input];
    assay_bundle_entry       entry = {.name = NULL};
    if (!stage_find_input(run->bundle, desc->name, t->name)) {
        return desc->optional
                   ? ASSAY_OK
                   : assay_fail(run->context, ASSAY_ERR_FORMAT,
                                "%s: bundle: stage '%s' needs an array '%s', which the manifest "
                                "does not list",
                                assay_bundle_path(run->bundle), run->stage->info.name, desc->name);
    }
    assay_status status = assay_bundle_entry_of(run->bundle, t->name, &entry);
    if (status == ASSAY_OK && desc->unit && strcmp(entry.unit, desc->unit) != 0) {
        return assay_fail(run->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: '%s' is in '%.40s', not in '%s'",
                          assay_bundle_path(run->bundle), t->name, entry.unit, desc->unit);
    }
    status =
        status ? status
               : assay_bundle_read_array(run->bundle, t->name, desc->channels, &run->tables[input]);
    if (status != ASSAY_OK) {
        return status;
    }
    t->values   = assay_array_values(run->tables[input]);
    t->rows     = assay_array_rows(run->tables[input]);
    t->columns  = assay_array_columns(run->tables[input]);
    t->roundoff = stage_roundoff_of(&entry);
    t->tiny     = stage_tiny_of(&entry);
    t->unit     = entry.unit;
    if (desc->channels && t->columns != words_in(desc->channels)) {
        return stage_fail_columns(run, input, words_in(desc->channels));
    }
    return check_values(run, input);
}

/* ---- outputs ---- */

/* An output without a unit has that of the first input that may have any. */
static const char *unit_of(const stage_run *run, const assay_stage_array *output)
{
    const assay_stage_array *inputs = run->stage->info.inputs;
    for (int i = 0; !output->unit && inputs[i].name; i++) {
        if (!inputs[i].unit && run->in[i].unit) {
            return run->in[i].unit;
        }
    }
    return output->unit ? output->unit : "";
}

assay_status stage_output_make(stage_run *run, int index, int number, size_t rows, size_t columns,
                               stage_output **output_out)
{
    const assay_stage_array *desc = &run->stage->info.outputs[index];
    const char              *mark = strchr(desc->name, '#');
    if (run->out_count == STAGE_MOST_OUTPUTS || rows > ASSAY_ARRAY_MAX_VALUES / columns) {
        return assay_fail(run->context, ASSAY_ERR_LIMIT, "stage '%s' would write too much",
                          run->stage->info.name);
    }
    stage_output *out = &run->out[run->out_count];
    *out              = (stage_output){
                     .unit = unit_of(run, desc), .channels = desc->channels, .rows = rows, .columns = columns};
    if (mark) {
        snprintf(out->name, sizeof out->name, "%.*s%d%s", (int)(mark - desc->name), desc->name,
                 number, mark + 1);
    } else {
        snprintf(out->name, sizeof out->name, "%s", desc->name);
    }
    out->values = assay_allocate(run->context, rows * columns, sizeof *out->values);
    out->bounds =
        run->bounded ? assay_allocate(run->context, rows * columns, sizeof *out->bounds) : NULL;
    run->out_count++;
    if (!out->values || (run->bounded && !out->bounds)) {
        return assay_fail_memory(run->context, "the arrays of a stage");
    }
    *output_out = out;
    return ASSAY_OK;
}

void stage_output_unknown(const stage_output *output)
{
    for (size_t i = 0; i < output->rows * output->columns; i++) {
        output->bounds[i] = NAN;
    }
}

/* ---- running ---- */

rounding stage_rounding_of(assay_precision precision)
{
    static const double roundoffs[] = {0x1p-11, 0x1p-24, 0x1p-53};
    static const double tinies[]    = {0x1p-25, 0x1p-126, 0x1p-1022};
    return (rounding){.u          = roundoffs[precision] + 0x1p-53,
                      .tiny       = tinies[precision],
                      .given      = roundoffs[precision],
                      .given_tiny = tinies[precision]};
}

/* Inputs are rounded once: to the candidate's precision, or when they were stored. */
static rounding rounding_of(const stage_run *run, assay_precision precision)
{
    rounding r = stage_rounding_of(precision);
    for (int i = 0; i < STAGE_MOST_ARRAYS; i++) {
        r.given      = fmax(r.given, run->in[i].roundoff);
        r.given_tiny = fmax(r.given_tiny, run->in[i].tiny);
    }
    return r;
}

static assay_status start(stage_run *run, const assay_precision *precision, int override_count,
                          const char *const *overrides)
{
    const stage_table none = {.values = NULL};
    assay_status status = assay_params_create(run->context, run->stage->info.params, &run->params);
    status              = status ? status : take_manifest(run, run->params);
    status = status ? status : take_overrides(run, run->params, override_count, overrides);
    for (int i = 0; i < STAGE_MOST_ARRAYS; i++) {
        run->in[i] = none;
    }
    for (int i = 0; run->stage->info.inputs[i].name && status == ASSAY_OK; i++) {
        status = read_input(run, i);
    }
    if (status == ASSAY_OK && run->stage->info.needs_scene && !run->scene) {
        status = assay_fail(run->context, ASSAY_ERR_ARGUMENT, "stage '%s' needs a scene",
                            run->stage->info.name);
    }
    if (status == ASSAY_OK) {
        run->bounded = precision != NULL;
        if (precision) {
            run->rounding = rounding_of(run, *precision);
        }
        status = run->stage->run(run);
    }
    return status;
}

assay_status stage_run_start(stage_run *run, assay_context *context, const oracle_stage *stage,
                             assay_bundle_reader *bundle, const assay_scene *scene,
                             const assay_precision *precision, int override_count,
                             const char *const *overrides)
{
    *run     = (stage_run){.context = context, .stage = stage, .bundle = bundle, .scene = scene};
    run->out = assay_allocate(context, STAGE_MOST_OUTPUTS, sizeof *run->out);
    return run->out ? start(run, precision, override_count, overrides)
                    : assay_fail_memory(context, "a stage");
}

void stage_run_release(stage_run *run)
{
    for (int i = 0; i < run->out_count; i++) {
        assay_release(run->context, run->out[i].values);
        assay_release(run->context, run->out[i].bounds);
    }
    for (int i = 0; i < STAGE_MOST_ARRAYS; i++) {
        assay_array_destroy(run->tables[i]);
    }
    assay_params_destroy(run->params);
    assay_release(run->context, run->out);
}
