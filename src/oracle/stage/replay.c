/* replay.c - a stage from bundle to bundle. */
#include "assay/replay.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "io/bundle.h"
#include "oracle/stage/stage.h"

/* What is written for every bundle, and what this stage says itself. */
static bool is_own_key(const char *key)
{
    static const char *const own[] = {"format", "version", "tool",   "arrays",
                                      "stage",  "bounds",  "content"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        if (strcmp(own[i], key) == 0) {
            return true;
        }
    }
    return false;
}

/* The parameters that were in force stand before what the manifest said. */
static assay_status describe(const stage_run *run, const assay_precision *bounds,
                             assay_bundle *bundle)
{
    const assay_param_desc *const table = run->stage->info.params;
    assay_status status = assay_bundle_describe(bundle, "stage", run->stage->info.name);
    if (status == ASSAY_OK && bounds) {
        status = assay_bundle_describe(bundle, "bounds", assay_precision_name(*bounds));
    }
    for (const assay_param_desc *p = table; p->name && status == ASSAY_OK; p++) {
        status = assay_bundle_describe(bundle, p->name, assay_params_text(run->params, p->name));
    }
    for (int i = 0; i < assay_bundle_text_count(run->bundle) && status == ASSAY_OK; i++) {
        const char *value = NULL;
        const char *key   = assay_bundle_text_at(run->bundle, i, &value);
        if (value && !is_own_key(key) && !assay_params_text(run->params, key)) {
            status = assay_bundle_describe(bundle, key, value);
        }
    }
    return status;
}

static assay_status add_table(assay_context *context, assay_bundle *bundle, const char *name,
                              const stage_output *out, const double *values)
{
    assay_array *table  = NULL;
    assay_status status = assay_array_create(context, out->rows, out->columns, &table);
    if (status == ASSAY_OK) {
        memcpy(assay_array_data(table), values, out->rows * out->columns * sizeof *values);
        status = assay_bundle_add_table(bundle, name, out->unit, table);
    }
    assay_array_destroy(table);
    return status;
}

static assay_status write_inputs(const stage_run *run, assay_bundle *bundle)
{
    assay_status status = ASSAY_OK;
    for (int i = 0; run->stage->info.inputs[i].name && status == ASSAY_OK; i++) {
        if (run->tables[i]) {
            status =
                assay_bundle_add_table(bundle, run->in[i].name, run->in[i].unit, run->tables[i]);
        }
    }
    return status;
}

static assay_status write_outputs(const stage_run *run, assay_bundle *bundle)
{
    assay_status status = ASSAY_OK;
    for (int i = 0; i < run->out_count && status == ASSAY_OK; i++) {
        const stage_output *out = &run->out[i];
        char                name[ASSAY_BUNDLE_NAME + 8];
        status = add_table(run->context, bundle, out->name, out, out->values);
        if (status == ASSAY_OK && out->bounds) {
            snprintf(name, sizeof name, "%s_bound", out->name);
            status = add_table(run->context, bundle, name, out, out->bounds);
        }
    }
    return status;
}

assay_status assay_replay(assay_context *context, const assay_replay_options *options)
{
    const oracle_stage *stage = assay_stage_find(options->stage);
    if (!stage) {
        return stage_fail_unknown(context, options->stage);
    }
    assay_bundle_reader *in     = NULL;
    assay_bundle        *out    = NULL;
    stage_run            run    = {.context = context};
    assay_status         status = assay_bundle_open(context, options->in, &in);
    status = status ? status : assay_bundle_create(context, options->out, &out);
    status = status ? status
                    : stage_run_start(&run, context, stage, in, options->scene, options->bounds,
                                      options->param_count, options->params);
    status = status ? status : describe(&run, options->bounds, out);
    status = status || !options->inputs ? status : write_inputs(&run, out);
    status = status ? status : write_outputs(&run, out);
    status = status ? status : assay_bundle_finish(out);
    stage_run_release(&run);
    assay_bundle_destroy(out);
    assay_bundle_close(in);
    return status;
}
