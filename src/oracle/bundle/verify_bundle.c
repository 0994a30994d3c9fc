/* verify_bundle.c - Invariant: each stage runs on the candidate's own inputs, so that nothing of
 * earlier stages' differences is in what is said of it. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "oracle/bundle/bundle_compare.h"
#include "oracle/bundle/bundle_match.h"
#include "oracle/bundle/verify_blame.h"
#include "oracle/bundle/verify_inputs.h"
#include "oracle/bundle/verify_unseen.h"
#include "oracle/bundle/verify_worth.h"
#include "oracle/stage/stage.h"

typedef struct {
    assay_context       *context;
    assay_bundle_reader *candidate, *reference;
    const assay_scene   *scene;
    assay_precision      precision;
    assay_verdict       *verdict;
} verification;

/* ---- one array ---- */

static assay_place place_of(const verification *v, const bundle_comparison *c)
{
    assay_bundle_entry entry = {.name = NULL};
    const size_t       row = c->worst / c->out->columns, column = c->worst % c->out->columns;
    if (assay_bundle_entry_of(v->candidate, c->out->name, &entry) == ASSAY_OK && entry.image) {
        return assay_place_pixel((int)(row % entry.shape[1]), (int)(row / entry.shape[1]));
    }
    return assay_place_row(row, (int)column);
}

static const char *channel_of(const stage_output *out, size_t column, char *name, size_t size)
{
    const char *rest = out->channels;
    if (!rest || out->columns == 1) {
        return NULL;
    }
    for (; column > 0; column--) {
        rest += strcspn(rest, " ");
        rest += *rest == ' ';
    }
    snprintf(name, size, "%.*s", (int)strcspn(rest, " "), rest);
    return name;
}

static assay_status add_finding(const verification *v, const char *stage,
                                const bundle_comparison *c)
{
    char          words[256], channel[16];
    assay_finding f = assay_finding_default();
    f.stage         = stage;
    f.array         = c->out->name;
    f.test          = "rounding";
    f.kind          = bundle_compare_kind(c);
    f.values        = c->count - c->unknown;
    f.unjudged      = c->unknown;
    f.vacuous       = c->vacuous;
    f.width         = c->width;
    f.width_90      = c->width_90;
    bundle_compare_describe(c, words, sizeof words);
    f.meaning = words[0] ? words : NULL;
    if (c->worst_in_bounds >= 0.0) {
        f.place     = place_of(v, c);
        f.channel   = channel_of(c->out, c->worst % c->out->columns, channel, sizeof channel);
        f.candidate = c->values[c->worst];
        f.reference = c->out->values[c->worst];
        f.bound     = bundle_compare_bound(c, c->worst);
        f.in_bounds = c->worst_in_bounds;
        f.ulps      = bundle_compare_ulps(v->precision, f.reference, f.candidate);
    }
    return assay_verdict_add(v->verdict, &f);
}

static assay_status check_finite(const verification *v, const stage_output *out,
                                 const assay_array *table)
{
    const double *values = assay_array_values(table);
    for (size_t i = 0; i < out->rows * out->columns; i++) {
        if (isnan(values[i])) {
            return assay_fail(
                v->context, ASSAY_ERR_DOMAIN, "%s: bundle: '%s', row %zu, column %zu: a NaN",
                assay_bundle_path(v->candidate), out->name, i / out->columns, i % out->columns);
        }
    }
    return ASSAY_OK;
}

static assay_status judge_array(const verification *v, const stage_run *run,
                                const stage_output *out)
{
    assay_array       *table  = NULL;
    assay_bundle_entry entry  = {.name = NULL};
    assay_status       status = assay_bundle_entry_of(v->candidate, out->name, &entry);
    if (status == ASSAY_OK && strcmp(entry.unit, out->unit) != 0) {
        return assay_fail(v->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: '%s' is in '%.40s', not in '%s'",
                          assay_bundle_path(v->candidate), out->name, entry.unit, out->unit);
    }
    status =
        status ? status : assay_bundle_read_array(v->candidate, out->name, out->channels, &table);
    if (status == ASSAY_OK &&
        (assay_array_rows(table) != out->rows || assay_array_columns(table) != out->columns)) {
        status =
            assay_fail(v->context, ASSAY_ERR_FORMAT,
                       "%s: bundle: '%s' is of %zu x %zu numbers, but its stage '%s' makes "
                       "%zu x %zu of its inputs",
                       assay_bundle_path(v->candidate), out->name, assay_array_rows(table),
                       assay_array_columns(table), run->stage->info.name, out->rows, out->columns);
    }
    status = status ? status : check_finite(v, out, table);
    if (status == ASSAY_OK) {
        const double      stored = stage_roundoff_of(&entry);
        bundle_comparison c      = {.out = out, .values = assay_array_values(table)};
        if (stored > stage_rounding_of(v->precision).given) {
            c.stored = (rounding){.given = stored, .given_tiny = stage_tiny_of(&entry)};
        }
        status = bundle_compare(v->context, &c);
        /* Where nothing is known the array stays among those that were not judged. */
        if (status == ASSAY_OK && (c.count == 0 || c.unknown < c.count)) {
            status = add_finding(v, run->stage->info.name, &c);
        }
    }
    assay_array_destroy(table);
    return status;
}

/* ---- the stages ---- */

static bool has_output(const oracle_stage *stage, const assay_bundle_reader *bundle)
{
    char name[ASSAY_BUNDLE_NAME];
    for (const assay_stage_array *out = stage->info.outputs; out->name; out++) {
        if (stage_find_name(bundle, out->name, name)) {
            return true;
        }
    }
    return false;
}

/* A stage that ran is named where no number of it has a bound: it has no finding. */
static assay_status tell_blind(const verification *v, const char *stage)
{
    const char *others = assay_verdict_get(v->verdict, "blind");
    char        names[512];
    snprintf(names, sizeof names, "%s%s%s", others ? others : "", others ? ", " : "", stage);
    return assay_verdict_set(v->verdict, "blind", names);
}

static assay_status judge_stage(const verification *v, const oracle_stage *stage)
{
    stage_run    run;
    const int    before = assay_verdict_count(v->verdict);
    assay_status status =
        stage_run_start(&run, v->context, stage, v->candidate, v->scene, &v->precision, 0, NULL);
    for (int i = 0; i < run.out_count && status == ASSAY_OK; i++) {
        if (assay_bundle_has(v->candidate, run.out[i].name)) {
            status = judge_array(v, &run, &run.out[i]);
        }
    }
    stage_run_release(&run);
    return status || assay_verdict_count(v->verdict) > before ? status
                                                              : tell_blind(v, stage->info.name);
}

static assay_status judge_stages(const verification *v)
{
    assay_status status =
        assay_verdict_set(v->verdict, "precision", assay_precision_name(v->precision));
    for (int i = 0; assay_stages[i] && status == ASSAY_OK; i++) {
        const oracle_stage *stage = assay_stages[i];
        if ((!stage->info.needs_scene || v->scene) && stage_can_run(stage, v->candidate) &&
            has_output(stage, v->candidate)) {
            status = judge_stage(v, stage);
        }
    }
    if (status == ASSAY_OK && v->reference) {
        status = verify_inputs(v->candidate, v->reference, v->precision, v->verdict);
    }
    status = status ? status : verify_blame(v->candidate, v->reference, v->verdict);
    status = status ? status : verify_tell_worth(v->verdict);
    return status ? status : verify_tell_unseen(v->candidate, v->reference, v->verdict);
}

assay_status assay_verify_bundle(assay_context *context, const char *candidate,
                                 const char *reference, const assay_scene *scene,
                                 assay_precision precision, assay_verdict *verdict)
{
    verification v = {
        .context = context, .scene = scene, .precision = precision, .verdict = verdict};
    assay_status status = assay_bundle_open(context, candidate, &v.candidate);
    if (status == ASSAY_OK && reference) {
        status = assay_bundle_open(context, reference, &v.reference);
        status = status ? status : bundle_match_making(context, v.candidate, v.reference);
    }
    status = status ? status : bundle_match_arrays(context, v.candidate, v.reference);
    status = status ? status : judge_stages(&v);
    assay_bundle_close(v.candidate);
    assay_bundle_close(v.reference);
    return status;
}
