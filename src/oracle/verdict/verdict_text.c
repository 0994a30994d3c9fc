/* verdict_text.c - a verdict in words.
 *
 * Invariant: a number is printed as a decimal that reads back to the same bits, and where bits
 * matter as a hexadecimal one beside it; what is NaN in a finding is not spoken of. */
#include <math.h>
#include <string.h>

#include "core/numerics.h"
#include "oracle/verdict/verdict_data.h"

void assay_finding_add_name(assay_text_builder *text, const assay_finding *finding)
{
    const bool channel = finding->channel && *finding->channel;
    assay_text_add(text, "%s%s%s, test %s", finding->array, channel ? "." : "",
                   channel ? finding->channel : "", finding->test);
}

void assay_finding_add_place(assay_text_builder *text, const assay_finding *finding)
{
    const assay_place *place = &finding->place;
    switch (place->kind) {
    case ASSAY_PLACE_ROW:
        assay_text_add(text, " at row %llu, column %d", (unsigned long long)place->row,
                       place->column);
        break;
    case ASSAY_PLACE_PIXEL: assay_text_add(text, " at pixel (%d, %d)", place->x, place->y); break;
    case ASSAY_PLACE_TILE:
        assay_text_add(text, " in the tile of %d x %d pixels at (%d, %d)", place->width,
                       place->height, place->x, place->y);
        break;
    case ASSAY_PLACE_NONE: break;
    }
}

static void add_values(assay_text_builder *text, const assay_finding *f)
{
    if (!isnan(f->candidate) && !isnan(f->reference)) {
        /* What a stage should have made is not the reference's, where its inputs are not. */
        const char *right = strcmp(f->test, "rounding") == 0 ? "replayed" : "reference";
        assay_text_add(text, ": candidate %.17g (%a), %s %.17g (%a)", f->candidate, f->candidate,
                       right, f->reference, f->reference);
    }
}

/* p below what a double holds is told by its power of ten. */
static void add_probability(assay_text_builder *text, const assay_finding *f)
{
    if (!isnan(f->log_p) && f->log_p < -600.0) {
        assay_text_add(text, "; p = 10^%.0f", f->log_p / assay_log(10.0));
    } else if (!isnan(f->p)) {
        assay_text_add(text, "; p = %.3g", f->p);
    }
}

static void add_excess(assay_text_builder *text, const assay_finding *f)
{
    if (f->in_bounds > 1.0 && f->bound == 0.0) {
        assay_text_add(text, "; nothing but the latter passes");
        return;
    }
    if (!isnan(f->in_bounds)) {
        assay_text_add(text, "; %.4g times what passes", f->in_bounds);
    }
    if (!isnan(f->bound)) {
        assay_text_add(text, " (%.4g)", f->bound);
    }
}

/* What passes unseen matters where something passes. */
static void add_width(assay_text_builder *text, const assay_finding *f)
{
    if (!isnan(f->width) && f->kind != ASSAY_VERDICT_FAIL) {
        assay_text_add(text, "; bounds of %.2g of a typical value (one in ten: %.2g)", f->width,
                       f->width_90);
        if (f->vacuous > 0) {
            assay_text_add(text, ", of %llu values as large as they",
                           (unsigned long long)f->vacuous);
        }
    }
}

void assay_finding_add_sentences(assay_text_builder *text, const assay_finding *f)
{
    assay_finding_add_name(text, f);
    assay_finding_add_place(text, f);
    add_values(text, f);
    if (!isnan(f->effect)) {
        assay_text_add(text, "; effect %+.4g", f->effect);
    }
    add_excess(text, f);
    if (!isnan(f->ulps) && f->reference != 0.0) {
        assay_text_add(text, "; %.4g ulps", f->ulps);
    }
    add_probability(text, f);
    if (!isnan(f->visible)) {
        assay_text_add(text, "; smallest bias that would have been seen %.4g", f->visible);
    }
    add_width(text, f);
    const unsigned long long judged = f->values, unjudged = f->unjudged;
    if (unjudged > 0) {
        assay_text_add(text, "; %llu of %llu values were judged", judged, judged + unjudged);
    } else if (f->values > 0) {
        assay_text_add(text, "; %llu values", (unsigned long long)f->values);
    }
    assay_text_add_char(text, '.');
    if (f->meaning && *f->meaning) {
        assay_text_add(text, " %s", f->meaning);
    }
}

static size_t count_kind(const assay_verdict *verdict, assay_verdict_kind kind)
{
    size_t count = 0;
    for (size_t i = 0; i < verdict->count; i++) {
        count += verdict->findings[i].kind == kind;
    }
    return count;
}

static void add_head(assay_text_builder *text, const assay_verdict *verdict)
{
    const size_t failed = count_kind(verdict, ASSAY_VERDICT_FAIL);
    const size_t unsure = count_kind(verdict, ASSAY_VERDICT_CANNOT_TELL);
    const char  *shown  = assay_verdict_get(verdict, "shown");
    switch (assay_verdict_whole(verdict)) {
    case ASSAY_VERDICT_PASS:
        assay_text_add(text, "PASS: %s against %s: %s in %zu tests.", verdict->candidate,
                       verdict->reference, shown ? shown : "no difference", verdict->count);
        break;
    case ASSAY_VERDICT_FAIL:
        assay_text_add(text, "FAIL: %s differs from %s in %zu of %zu tests", verdict->candidate,
                       verdict->reference, failed, verdict->count);
        if (unsure > 0) {
            assay_text_add(text, "; %zu more cannot tell", unsure);
        }
        assay_text_add_char(text, '.');
        break;
    case ASSAY_VERDICT_CANNOT_TELL:
        assay_text_add(text, "CANNOT TELL whether %s agrees with %s: ", verdict->candidate,
                       verdict->reference);
        if (verdict->count == 0) {
            assay_text_add(text, "nothing in it could be tested.");
        } else {
            assay_text_add(text, "%zu of %zu tests cannot.", unsure, verdict->count);
        }
        break;
    }
}

/* What a pass is worth. */
static void add_worth(assay_text_builder *text, const assay_verdict *verdict)
{
    static const char *const SETTINGS[] = {"power", "variances"};
    for (size_t i = 0; i < sizeof SETTINGS / sizeof SETTINGS[0]; i++) {
        const char *worth = assay_verdict_get(verdict, SETTINGS[i]);
        if (worth && *worth) {
            assay_text_add(text, " %s", worth);
        }
    }
}

assay_status assay_verdict_paragraph(const assay_verdict *verdict, char **text_out)
{
    assay_text_builder text  = assay_text_start(verdict->context);
    const int          first = assay_verdict_first(verdict);
    add_head(&text, verdict);
    if (first >= 0) {
        const assay_finding *f = &verdict->findings[first];
        assay_text_add(&text,
                       f->kind == ASSAY_VERDICT_FAIL ? " First stage that fails: %s. "
                                                     : " First stage in doubt: %s. ",
                       f->stage);
        assay_finding_add_sentences(&text, f);
    }
    add_worth(&text, verdict);
    return assay_text_finish(&text, "a verdict's paragraph", text_out);
}
