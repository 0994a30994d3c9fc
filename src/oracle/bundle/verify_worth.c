/* verify_worth.c - what a pass of a bundle is worth, and what it shall be worth at least.
 *
 * Invariant: a demand turns a pass into a doubt, never a doubt or a failure into anything else. */
#include "oracle/bundle/verify_worth.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "assay/replay.h"
#include "core/context.h"
#include "oracle/verdict/verdict_data.h"

static bool is_of_stage(const assay_finding *f) { return strcmp(f->test, "rounding") == 0; }

static uint64_t size_of(const assay_finding *f) { return f->values + f->unjudged; }

/* By the share of it that was judged, a <= b. */
static bool is_judged_less(const assay_finding *a, const assay_finding *b)
{
    return (double)a->values * (double)size_of(b) < (double)b->values * (double)size_of(a);
}

typedef struct {
    uint64_t             values, unjudged;
    const assay_finding *fewest, *widest;
} worth;

static worth worth_of(const assay_verdict *verdict)
{
    worth w = {.fewest = NULL};
    for (size_t i = 0; i < verdict->count; i++) {
        const assay_finding *f = &verdict->findings[i];
        if (!is_of_stage(f)) {
            continue;
        }
        w.values += f->values;
        w.unjudged += f->unjudged;
        if (f->unjudged > 0 && (!w.fewest || is_judged_less(f, w.fewest))) {
            w.fewest = f;
        }
        if (!isnan(f->width) && (!w.widest || f->width > w.widest->width)) {
            w.widest = f;
        }
    }
    return w;
}

static void add_worth(assay_text_builder *text, const worth *w)
{
    const unsigned long long judged = w->values, unjudged = w->unjudged;
    if (w->fewest) {
        const unsigned long long some = w->fewest->values, all = size_of(w->fewest);
        assay_text_add(text,
                       "Of the arrays that were judged %llu of %llu numbers have a bound, fewest "
                       "in %s: %llu of %llu.",
                       judged, judged + unjudged, w->fewest->array, some, all);
    } else {
        assay_text_add(text, "Of the arrays that were judged all %llu numbers have a bound.",
                       judged);
    }
    if (w->widest && isinf(w->widest->width)) {
        assay_text_add(text, " A typical number of %s may be anything unseen.", w->widest->array);
    } else if (w->widest) {
        assay_text_add(text,
                       " Bounds are widest in %s: a typical number may be off by %.2g of itself "
                       "unseen, one in ten by %.2g or more.",
                       w->widest->array, w->widest->width, w->widest->width_90);
    }
}

assay_status verify_tell_worth(assay_verdict *verdict)
{
    const worth w    = worth_of(verdict);
    char       *text = NULL;
    if (w.values + w.unjudged == 0 || assay_verdict_whole(verdict) == ASSAY_VERDICT_FAIL) {
        return ASSAY_OK;
    }
    assay_text_builder builder = assay_text_start(verdict->context);
    add_worth(&builder, &w);
    assay_status status = assay_text_finish(&builder, "what a verdict is worth", &text);
    status              = status ? status : assay_verdict_set(verdict, "power", text);
    assay_text_destroy(verdict->context, text);
    return status;
}

/* ---- demands ---- */

static assay_status doubt(assay_verdict *verdict, size_t index, const char *meaning)
{
    const assay_status status = assay_verdict_mean(verdict, index, meaning);
    if (status == ASSAY_OK) {
        verdict->findings[index].kind = ASSAY_VERDICT_CANNOT_TELL;
    }
    return status;
}

static assay_status insist(assay_verdict *verdict, size_t index, double detect, double judged)
{
    const assay_finding *f = &verdict->findings[index];
    char                 words[160];
    if ((double)f->values < judged * (double)size_of(f)) {
        snprintf(words, sizeof words,
                 "Of fewer of its numbers than were asked for, %g of all, "
                 "anything is known.",
                 judged);
        return doubt(verdict, index, words);
    }
    if (f->width > detect) {
        snprintf(words, sizeof words,
                 "A typical number may be off by %.2g of itself unseen, more than was asked for: "
                 "the candidate's precision allows no more.",
                 f->width);
        return doubt(verdict, index, words);
    }
    return ASSAY_OK;
}

static assay_status set_number(assay_verdict *verdict, const char *key, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    return isnan(value) ? ASSAY_OK : assay_verdict_set(verdict, key, text);
}

/* Stages that ran and have no finding, since none of their numbers has a bound. */
static assay_status insist_on_stages(assay_verdict *verdict)
{
    assay_status status = ASSAY_OK;
    const char  *at     = assay_verdict_get(verdict, "blind");
    while (at && *at && status == ASSAY_OK) {
        const int     length = (int)strcspn(at, ",");
        char          stage[64];
        assay_finding f = assay_finding_default();
        snprintf(stage, sizeof stage, "%.*s", length < 63 ? length : 63, at);
        f.stage = f.array = stage;
        f.test            = "judged";
        f.kind            = ASSAY_VERDICT_CANNOT_TELL;
        f.meaning         = "The stage ran, but none of its numbers has a bound in this precision "
                            "and with these parameters.";
        status            = assay_verdict_add(verdict, &f);
        at += length;
        at += strspn(at, ", ");
    }
    return status;
}

assay_status assay_verify_insist(assay_verdict *verdict, double detect, double judged)
{
    if (detect <= 0.0 || judged < 0.0 || judged > 1.0) {
        return assay_fail(verdict->context, ASSAY_ERR_ARGUMENT,
                          "what shall be seen is above 0, the part that is judged from 0 to 1");
    }
    assay_status status = set_number(verdict, "detect", detect);
    status              = status ? status : set_number(verdict, "judged", judged);
    for (size_t i = 0; i < verdict->count && status == ASSAY_OK; i++) {
        const assay_finding *f = &verdict->findings[i];
        if (f->kind == ASSAY_VERDICT_PASS && is_of_stage(f)) {
            status = insist(verdict, i, detect, judged);
        }
    }
    return status || isnan(judged) ? status : insist_on_stages(verdict);
}
