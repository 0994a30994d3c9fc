/* verify_inputs.c - what replays lean on.
 *
 * A stage is judged on the candidate's own inputs, so a reflectance in the wrong colour space, or
 * normals of eight bits, would pass through all of them unseen.  Invariant: with a reference, a
 * verdict passes only where every array that a judged stage read was judged itself or is the
 * reference's. */
#include "oracle/verify_inputs.h"

#include <math.h>
#include <string.h>

#include "oracle/stage.h"

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
            if (stage_find_name(candidate, input->name, name) && strcmp(name, array) == 0) {
                return input;
            }
        }
    }
    return NULL;
}

typedef struct {
    size_t worst, values;
    double candidate, reference, bound, in_bounds;
} comparison;

/* A number that is rounded once, from what the reference's file holds. */
static void compare(const assay_array *mine, const assay_array *theirs, double roundoff,
                    comparison *c)
{
    const double *x = assay_array_values(theirs), *r = assay_array_values(mine);
    c->values = assay_array_rows(mine) * assay_array_columns(mine);
    for (size_t i = 0; i < c->values; i++) {
        const double bound = roundoff * fabs(r[i]) * (1.0 + 0x1p-20) + 0x1p-149;
        const double away  = x[i] == r[i] || (isnan(x[i]) && isnan(r[i])) ? 0.0 : fabs(x[i] - r[i]);
        const double share = isfinite(away) && isfinite(bound) ? away / bound : 1e300;
        if (i == 0 || (away > 0.0 && share > c->in_bounds)) {
            *c = (comparison){i, c->values, x[i], r[i], bound, away > 0.0 ? share : 0.0};
        }
    }
}

static assay_status add_finding(assay_verdict *verdict, const char *array, const comparison *c,
                                size_t columns)
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
    f.meaning = f.kind == ASSAY_VERDICT_PASS
                    ? NULL
                    : "The stages after it were judged with it, but it is not the reference's, and "
                      "no stage says whether it is right.";
    return assay_verdict_add(verdict, &f);
}

static assay_status judge(const assay_bundle_reader *candidate,
                          const assay_bundle_reader *reference, const assay_bundle_entry *entry,
                          const char *channels, double roundoff, assay_verdict *verdict)
{
    assay_array *mine = NULL, *theirs = NULL;
    comparison   c      = {.in_bounds = 0.0};
    assay_status status = assay_bundle_read_array(reference, entry->name, channels, &mine);
    status = status ? status : assay_bundle_read_array(candidate, entry->name, channels, &theirs);
    if (status == ASSAY_OK) {
        roundoff = fmax(roundoff, stage_roundoff_of(entry));
        if (assay_array_rows(mine) == assay_array_rows(theirs)) {
            compare(mine, theirs, roundoff, &c);
        } else {
            c.in_bounds = 1e300;
        }
        status = add_finding(verdict, entry->name, &c, assay_array_columns(mine));
    }
    assay_array_destroy(mine);
    assay_array_destroy(theirs);
    return status;
}

assay_status verify_inputs(const assay_bundle_reader *candidate,
                           const assay_bundle_reader *reference, assay_precision precision,
                           assay_verdict *verdict)
{
    static const double roundoffs[] = {0x1p-11, 0x1p-24, 0x1p-53};
    assay_status        status      = ASSAY_OK;
    for (int i = 0; i < assay_bundle_count(candidate) && status == ASSAY_OK; i++) {
        assay_bundle_entry entry;
        status                         = assay_bundle_entry_at(candidate, i, &entry);
        const assay_stage_array *input = status ? NULL : reader_of(verdict, candidate, entry.name);
        if (input && !verify_is_judged(verdict, entry.name) &&
            assay_bundle_has(reference, entry.name)) {
            status =
                judge(candidate, reference, &entry, input->channels, roundoffs[precision], verdict);
        }
    }
    return status;
}
