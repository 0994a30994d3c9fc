/* verify_blame.c - Invariant: an error is said to be made in a stage only where every array that it
 * was judged with has a finding that passes.
 *
 * A stage is judged on what the candidate dumped.  Where that is not what the stage was given - an
 * array dumped in another frame, or before it was changed - the stage fails and is right.  Nothing
 * in the bundle tells such a stage from a wrong one, but that its outputs may be the reference's:
 * a wrong stage hardly makes what is right of inputs that are not. */
#include "oracle/bundle/verify_blame.h"

#include <math.h>
#include <string.h>

#include "oracle/stage/stage.h"
#include "oracle/verdict/verdict_data.h"

/* The part of the squared difference to the replay that may be left to the reference's outputs. */
static const double EXPLAINED = 1e-6;

enum { MOST_NAMED = 3 };

typedef struct {
    const assay_bundle_reader *candidate, *reference;
    assay_verdict             *verdict;
} blaming;

/* The finding of an array that says the least good of it; NULL without one. */
static const assay_finding *worst_of(const assay_verdict *verdict, const char *array)
{
    static const int rank[] = {
        [ASSAY_VERDICT_PASS] = 0, [ASSAY_VERDICT_CANNOT_TELL] = 1, [ASSAY_VERDICT_FAIL] = 2};
    const assay_finding *worst = NULL;
    for (size_t i = 0; i < verdict->count; i++) {
        const assay_finding *f = &verdict->findings[i];
        if (strcmp(f->array, array) == 0 && (!worst || rank[f->kind] > rank[worst->kind])) {
            worst = f;
        }
    }
    return worst;
}

static void name_wrong(assay_text_builder *text, const assay_finding *f)
{
    assay_text_add(text, "%s (", f->array);
    if (strcmp(f->test, "given") == 0) {
        assay_text_add(text, "not the reference's");
        assay_finding_add_place(text, f);
    } else {
        assay_text_add(text, f->kind == ASSAY_VERDICT_FAIL ? "fails itself" : "in doubt itself");
    }
    assay_text_add_char(text, ')');
}

typedef struct {
    int                  count, wrong, unknown;
    const assay_finding *loose; /* passes, and would have with much else in places; NULL */
} inputs;

/* Names the stage's inputs that are not right, and counts them. */
static inputs look_at_inputs(const blaming *b, const oracle_stage *stage, assay_text_builder *names)
{
    inputs found = {.loose = NULL};
    for (const assay_stage_array *input = stage->info.inputs; input->name; input++) {
        char name[ASSAY_BUNDLE_NAME];
        if (!stage_find_input(b->candidate, input->name, name)) {
            continue;
        }
        const assay_finding *worst = worst_of(b->verdict, name);
        found.count++;
        found.unknown += !worst;
        found.loose = worst && worst->vacuous > 0 ? worst : found.loose;
        if (worst && worst->kind != ASSAY_VERDICT_PASS) {
            if (found.wrong < MOST_NAMED) {
                assay_text_add(names, "%s", found.wrong ? ", " : "");
                name_wrong(names, worst);
            }
            found.wrong++;
        }
    }
    if (found.wrong > MOST_NAMED) {
        assay_text_add(names, " and %d more", found.wrong - MOST_NAMED);
    }
    return found;
}

/* Whether what the stage made is the reference's, at the worst place and as a whole. */
static bool is_like(const assay_array *mine, const assay_array *theirs, const assay_finding *f)
{
    const size_t  count = assay_array_rows(mine) * assay_array_columns(mine);
    const double *r = assay_array_values(mine), *x = assay_array_values(theirs);
    const double  wrong = f->candidate - f->reference;
    for (size_t i = 0; i < count; i++) {
        const double left = x[i] - r[i];
        if (x[i] != r[i] && !(left * left <= EXPLAINED * fmax(wrong * wrong, r[i] * r[i]))) {
            return false;
        }
    }
    return assay_array_rows(theirs) * assay_array_columns(theirs) == count;
}

static assay_status made_the_reference(const blaming *b, const assay_finding *f, bool *like_out)
{
    assay_array *mine = NULL, *theirs = NULL;
    *like_out = false;
    if (!b->reference || !assay_bundle_has(b->reference, f->array)) {
        return ASSAY_OK;
    }
    assay_status status = assay_bundle_read_array(b->reference, f->array, NULL, &mine);
    status = status ? status : assay_bundle_read_array(b->candidate, f->array, NULL, &theirs);
    if (status == ASSAY_OK && assay_array_rows(mine) == assay_array_rows(theirs)) {
        *like_out = is_like(mine, theirs, f);
    }
    assay_array_destroy(mine);
    assay_array_destroy(theirs);
    return status;
}

static void conclude(assay_text_builder *text, const inputs *found, const char *names, bool like)
{
    if (found->wrong > 0 && like) {
        assay_text_add(text,
                       " It was judged with %s, but made what the reference has: it seems to be "
                       "right, and to have been given something else.",
                       names);
    } else if (found->wrong > 0) {
        assay_text_add(text,
                       " It was judged with %s: the error is made in this stage only if it was "
                       "given these.",
                       names);
    } else if (found->unknown > 0) {
        assay_text_add(text, " The error is made in this stage if it was given the bundle's "
                             "inputs, which nothing shows.");
    } else if (found->count == 0) {
        assay_text_add(text, " It has no inputs but scene and camera: the error is made in this "
                             "stage.");
    } else if (found->loose) {
        assay_text_add(text,
                       " Its inputs pass: the error is made in this stage, or in %s where bounds "
                       "are as large as what they bound (%llu numbers).",
                       found->loose->array, (unsigned long long)found->loose->vacuous);
    } else {
        assay_text_add(text, " Its inputs pass: the error is made in this stage.");
    }
}

static assay_status blame(const blaming *b, size_t index)
{
    const assay_finding *f      = &b->verdict->findings[index];
    const oracle_stage  *stage  = assay_stage_find(f->stage);
    assay_text_builder   names  = assay_text_start(b->verdict->context);
    assay_text_builder   text   = assay_text_start(b->verdict->context);
    char                *listed = NULL, *meaning = NULL;
    bool                 like  = false;
    const inputs         found = look_at_inputs(b, stage, &names);
    assay_text_add(&names, "%s", "");
    assay_status status = assay_text_finish(&names, "names of arrays", &listed);
    status              = status || !found.wrong ? status : made_the_reference(b, f, &like);
    assay_text_add(&text, "%s", f->meaning);
    if (status == ASSAY_OK) {
        conclude(&text, &found, listed, like);
    }
    const assay_status written = assay_text_finish(&text, "a finding", &meaning);
    status                     = status ? status : written;
    status                     = status ? status : assay_verdict_mean(b->verdict, index, meaning);
    assay_text_destroy(b->verdict->context, listed);
    assay_text_destroy(b->verdict->context, meaning);
    return status;
}

assay_status verify_blame(const assay_bundle_reader *candidate,
                          const assay_bundle_reader *reference, assay_verdict *verdict)
{
    const blaming b      = {candidate, reference, verdict};
    assay_status  status = ASSAY_OK;
    for (size_t i = 0; i < verdict->count && status == ASSAY_OK; i++) {
        const assay_finding *f = &verdict->findings[i];
        if (f->kind == ASSAY_VERDICT_FAIL && strcmp(f->test, "rounding") == 0) {
            status = blame(&b, i);
        }
    }
    return status;
}
