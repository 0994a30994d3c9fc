/* verify_inputs.c - what replays lean on.
 *
 * A stage is judged on the candidate's own inputs, so a reflectance in the wrong colour space, or
 * normals of eight bits, would pass through all of them unseen.  Invariant: with a reference, a
 * verdict passes only where every array that a judged stage read was judged itself or is the
 * reference's. */
#include "oracle/bundle/verify_inputs.h"

#include <math.h>
#include <string.h>

#include "oracle/stage/stage.h"

bool verify_is_judged(const assay_verdict *verdict, const char *array)
{
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        if (strcmp(assay_verdict_at(verdict, i).array, array) == 0) {
            return true;
        }
    }
    return false;
}

static bool has_findings(const assay_verdict *verdict, const char *stage)
{
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        if (strcmp(assay_verdict_at(verdict, i).stage, stage) == 0) {
            return true;
        }
    }
    return false;
}

/* The description of an array that a judged stage read; NULL where none did. */
static const assay_stage_array *reader_of(const assay_verdict       *verdict,
                                          const assay_bundle_reader *candidate, const char *array)
{
    char name[ASSAY_BUNDLE_NAME];
    for (int i = 0; assay_stages[i]; i++) {
        const assay_stage_array *input = assay_stages[i]->info.inputs;
        if (!has_findings(verdict, assay_stages[i]->info.name)) {
            continue;
        }
        for (; input->name; input++) {
            if (stage_find_input(candidate, input->name, name) && strcmp(name, array) == 0) {
                return input;
            }
        }
    }
    return NULL;
}

/* Records, and what is known of pixels before they are splatted on, are made before all that stages
 * make of them.  Where no stage reads them either, they are looked at all the same. */
static bool is_made_first(const char *array)
{
    static const char *const names[] = {"records",
                                        "radiance_records",
                                        "query/position",
                                        "query/normal",
                                        "radiance_query/pixel",
                                        "radiance_query/position",
                                        "radiance_query/frame",
                                        "splat/position",
                                        "splat/frame",
                                        "splat/geometric_normal",
                                        "splat/albedo",
                                        "splat/footprint",
                                        "splat/batch_end",
                                        "splat/fate",
                                        "splat_glossy/position",
                                        "splat_glossy/frame",
                                        "splat_glossy/geometric_normal",
                                        "splat_glossy/albedo",
                                        "splat_glossy/footprint",
                                        "splat_glossy/brdf",
                                        "splat_glossy/lobe", /* and lobe_grid */
                                        "splat_glossy/batch_end",
                                        "splat_glossy/fate"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strncmp(array, names[i], strlen(names[i])) == 0) {
            return true;
        }
    }
    return false;
}

typedef struct {
    size_t worst, values;
    double candidate, reference, bound, in_bounds;
} comparison;

/* A number that is rounded once, from what the reference's file holds. */
static void compare(const assay_array *mine, const assay_array *theirs, const rounding *once,
                    comparison *c)
{
    const double *x = assay_array_values(theirs), *r = assay_array_values(mine);
    c->values = assay_array_rows(mine) * assay_array_columns(mine);
    for (size_t i = 0; i < c->values; i++) {
        const double bound = given_error(once, r[i]) * (1.0 + 0x1p-20);
        const bool   same  = x[i] == r[i] || (isnan(x[i]) && isnan(r[i]));
        const double away  = same                               ? 0.0
                             : isfinite(x[i]) && isfinite(r[i]) ? fabs(x[i] - r[i])
                                                                : INFINITY;
        const double share = isfinite(away) && away <= 1e300 * bound ? away / bound : 1e300;
        if (i == 0 || (away > 0.0 && share > c->in_bounds)) {
            *c = (comparison){i, c->values, x[i], r[i], bound, away > 0.0 ? share : 0.0};
        }
    }
}

static assay_status add_finding(assay_verdict *verdict, const char *array, const comparison *c,
                                size_t columns, bool is_read)
{
    assay_finding f = assay_finding_default();
    f.stage         = "inputs";
    f.array         = array;
    f.test          = "given";
    f.kind          = c->in_bounds <= 1.0 ? ASSAY_VERDICT_PASS : ASSAY_VERDICT_CANNOT_TELL;
    f.values        = c->values;
    if (c->values > 0) {
        f.place     = assay_place_row(c->worst / columns, (int)(c->worst % columns));
        f.candidate = c->candidate;
        f.reference = c->reference;
        f.bound     = c->bound;
        f.in_bounds = c->in_bounds;
    }
    f.meaning = f.kind == ASSAY_VERDICT_PASS ? NULL
                : is_read ? "The stages after it were judged with it, but it is not the "
                            "reference's, and no stage says whether it is right."
                          : "It is not the reference's, and no stage says whether it is right.";
    return assay_verdict_add(verdict, &f);
}

static assay_status judge(const assay_bundle_reader *candidate,
                          const assay_bundle_reader *reference, const assay_bundle_entry *entry,
                          const assay_stage_array *input, rounding once, assay_verdict *verdict)
{
    const char  *channels = input ? input->channels : NULL;
    assay_array *mine = NULL, *theirs = NULL;
    comparison   c      = {.in_bounds = 0.0};
    assay_status status = assay_bundle_read_array(reference, entry->name, channels, &mine);
    status = status ? status : assay_bundle_read_array(candidate, entry->name, channels, &theirs);
    if (status == ASSAY_OK) {
        once.given      = fmax(once.given, stage_roundoff_of(entry));
        once.given_tiny = fmax(once.given_tiny, stage_tiny_of(entry));
        if (assay_array_rows(mine) == assay_array_rows(theirs)) {
            compare(mine, theirs, &once, &c);
        } else {
            c.in_bounds = 1e300;
        }
        status = add_finding(verdict, entry->name, &c, assay_array_columns(mine), input);
    }
    assay_array_destroy(mine);
    assay_array_destroy(theirs);
    return status;
}

assay_status verify_inputs(const assay_bundle_reader *candidate,
                           const assay_bundle_reader *reference, assay_precision precision,
                           assay_verdict *verdict)
{
    const bool     claims = assay_verdict_count(verdict) > 0; /* else all was handed on */
    const rounding once   = stage_rounding_of(precision);
    assay_status   status = ASSAY_OK;
    for (int i = 0; i < assay_bundle_count(candidate) && status == ASSAY_OK; i++) {
        assay_bundle_entry entry;
        status                         = assay_bundle_entry_at(candidate, i, &entry);
        const assay_stage_array *input = status ? NULL : reader_of(verdict, candidate, entry.name);
        if (status == ASSAY_OK && (input || (claims && is_made_first(entry.name))) &&
            !verify_is_judged(verdict, entry.name) && assay_bundle_has(reference, entry.name)) {
            status = judge(candidate, reference, &entry, input, once, verdict);
        }
    }
    return status;
}
