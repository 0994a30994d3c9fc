/* verify_bundle.c - a candidate's stages, each on the candidate's own inputs.
 *
 * Invariant: a number passes only where it is within its bound of what our stage makes of the same
 * inputs; where no bound is known, or all bounds are as large as what they bound, nothing is said
 * to pass. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "oracle/bundle_match.h"
#include "oracle/stage.h"
#include "oracle/stage_meaning.h"
#include "oracle/verify_inputs.h"
#include "oracle/verify_unseen.h"

typedef struct {
    assay_context       *context;
    assay_bundle_reader *candidate, *reference;
    const assay_scene   *scene;
    assay_precision      precision;
    assay_verdict       *verdict;
} verification;

/* ---- one array ---- */

typedef struct {
    const stage_output *out;
    const double       *values; /* the candidate's */
    rounding            stored; /* `given`: how their type rounds, where it is coarser; else 0 */
    size_t              count, unknown, vacuous, beyond, worst;
    double              worst_in_bounds;
} comparison;

static double bound_at(const comparison *c, size_t i)
{
    const double b = c->out->bounds[i];
    return b + given_error(&c->stored, fabs(c->out->values[i]) + b);
}

static double in_bounds_at(const comparison *c, size_t i)
{
    static const double most = 1e300; /* a number that every output can print */
    const double        mine = c->out->values[i], theirs = c->values[i];
    const double        bound = bound_at(c, i);
    if (mine == theirs) {
        return 0.0;
    }
    if (isinf(mine) || isinf(theirs)) {
        return isinf(bound) ? 0.0 : most;
    }
    return bound > 0.0 ? fmin(most, fabs(theirs - mine) / bound) : most;
}

static void compare(comparison *c)
{
    c->count           = c->out->rows * c->out->columns;
    c->worst_in_bounds = -1.0;
    for (size_t i = 0; i < c->count; i++) {
        if (isnan(c->out->bounds[i])) {
            c->unknown++;
            continue;
        }
        const double x = in_bounds_at(c, i);
        c->vacuous += bound_at(c, i) >= fabs(c->out->values[i]) && c->out->values[i] != 0.0;
        c->beyond += x > 1.0;
        if (x > c->worst_in_bounds) {
            c->worst_in_bounds = x;
            c->worst           = i;
        }
    }
}

static double ulps_of(assay_precision precision, double mine, double theirs)
{
    static const int digits[] = {11, 24, 53}, least[] = {-14, -126, -1022};
    int              exponent = 0;
    if (!isfinite(mine) || !isfinite(theirs)) {
        return NAN;
    }
    frexp(mine, &exponent);
    exponent = exponent - 1 < least[precision] || mine == 0.0 ? least[precision] : exponent - 1;
    return fabs(theirs - mine) / ldexp(1.0, exponent - digits[precision] + 1);
}

/* Numbers that are 0 say nothing of how wide bounds are. */
static bool is_blind(const comparison *c)
{
    size_t sized = 0;
    for (size_t i = 0; i < c->count; i++) {
        sized += c->out->values[i] != 0.0 && !isnan(c->out->bounds[i]);
    }
    return c->count == 0 || 2 * c->unknown > c->count || (sized > 0 && c->vacuous == sized);
}

static assay_verdict_kind judge(const comparison *c)
{
    return c->beyond > 0 ? ASSAY_VERDICT_FAIL
           : is_blind(c) ? ASSAY_VERDICT_CANNOT_TELL
                         : ASSAY_VERDICT_PASS;
}

static void describe(const comparison *c, assay_verdict_kind kind, char *words, size_t size)
{
    words[0] = '\0';
    if (kind == ASSAY_VERDICT_CANNOT_TELL) {
        snprintf(words, size, "%s",
                 c->count == 0               ? "The array is empty."
                 : 2 * c->unknown > c->count ? "Most of its values have no bound."
                                             : "All bounds are as large as what they bound: "
                                               "this precision decides nothing here.");
    } else if (kind == ASSAY_VERDICT_FAIL) {
        stage_meaning(c->out->columns, c->count, c->values, c->out->values, words, size);
    } else if (c->unknown + c->vacuous > 0) {
        snprintf(words, size,
                 "Of %zu values %zu have no bound and %zu one that is as large as themselves.",
                 c->count, c->unknown, c->vacuous);
    }
}

static assay_place place_of(const verification *v, const comparison *c)
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

static assay_status add_finding(const verification *v, const char *stage, const comparison *c)
{
    char          words[256], channel[16];
    assay_finding f = assay_finding_default();
    f.stage         = stage;
    f.array         = c->out->name;
    f.test          = "rounding";
    f.kind          = judge(c);
    f.values        = c->count - c->unknown;
    describe(c, f.kind, words, sizeof words);
    f.meaning = words[0] ? words : NULL;
    if (c->worst_in_bounds >= 0.0) {
        f.place     = place_of(v, c);
        f.channel   = channel_of(c->out, c->worst % c->out->columns, channel, sizeof channel);
        f.candidate = c->values[c->worst];
        f.reference = c->out->values[c->worst];
        f.bound     = bound_at(c, c->worst);
        f.in_bounds = c->worst_in_bounds;
        f.ulps      = ulps_of(v->precision, f.reference, f.candidate);
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
        const double stored = stage_roundoff_of(&entry);
        comparison   c      = {.out = out, .values = assay_array_values(table)};
        if (stored > stage_rounding_of(v->precision).given) {
            c.stored = (rounding){.given = stored, .given_tiny = stage_tiny_of(&entry)};
        }
        compare(&c);
        /* Where nothing is known the array stays among those that were not judged. */
        if (c.count == 0 || c.unknown < c.count) {
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

static assay_status judge_stage(const verification *v, const oracle_stage *stage)
{
    stage_run    run;
    assay_status status =
        stage_run_start(&run, v->context, stage, v->candidate, v->scene, &v->precision, 0, NULL);
    for (int i = 0; i < run.out_count && status == ASSAY_OK; i++) {
        if (assay_bundle_has(v->candidate, run.out[i].name)) {
            status = judge_array(v, &run, &run.out[i]);
        }
    }
    stage_run_release(&run);
    return status;
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
