/* bundle_compare.c - Invariant: a number passes only where it is within its bound; where of most
 * numbers nothing is known, or most bounds are as large as what they bound, nothing is said to
 * pass.
 *
 * How wide bounds are is told by order statistics of bound / |number|, since a single number that
 * happens to cancel has a ratio that says nothing of the others. */
#include "oracle/bundle/bundle_compare.h"

#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "math/select.h"
#include "oracle/stage/stage_meaning.h"

double bundle_compare_bound(const bundle_comparison *c, size_t i)
{
    const double b = c->out->bounds[i];
    return isinf(b) ? b : b + given_error(&c->stored, fabs(c->out->values[i]) + b);
}

static double in_bounds_at(const bundle_comparison *c, size_t i)
{
    static const double most = 1e300; /* a number that every output can print */
    const double        mine = c->out->values[i], theirs = c->values[i];
    const double        bound = bundle_compare_bound(c, i);
    if (mine == theirs) {
        return 0.0;
    }
    if (isinf(mine) || isinf(theirs)) {
        return isinf(bound) ? 0.0 : most;
    }
    return bound > 0.0 ? fmin(most, fabs(theirs - mine) / bound) : most;
}

/* Numbers that are 0 or infinite say nothing of how wide bounds are. */
static bool has_width(const bundle_comparison *c, size_t i)
{
    return !isnan(c->out->bounds[i]) && c->out->values[i] != 0.0 && isfinite(c->out->values[i]);
}

static assay_status measure_widths(assay_context *context, bundle_comparison *c)
{
    size_t  sized  = 0;
    double *widths = assay_allocate(context, c->count + 1, sizeof *widths);
    if (!widths) {
        return assay_fail_memory(context, "the widths of bounds");
    }
    for (size_t i = 0; i < c->count; i++) {
        if (has_width(c, i)) {
            widths[sized++] = bundle_compare_bound(c, i) / fabs(c->out->values[i]);
        }
    }
    c->width    = sized > 0 ? assay_select(widths, sized, sized / 2) : NAN;
    c->width_90 = sized > 0 ? assay_select(widths, sized, sized - 1 - sized / 10) : NAN;
    assay_release(context, widths);
    return ASSAY_OK;
}

assay_status bundle_compare(assay_context *context, bundle_comparison *c)
{
    c->count           = c->out->rows * c->out->columns;
    c->worst_in_bounds = -1.0;
    for (size_t i = 0; i < c->count; i++) {
        if (isnan(c->out->bounds[i])) {
            c->unknown++;
            continue;
        }
        const double x = in_bounds_at(c, i);
        c->vacuous += has_width(c, i) && bundle_compare_bound(c, i) >= fabs(c->out->values[i]);
        c->beyond += x > 1.0;
        if (x > c->worst_in_bounds) {
            c->worst_in_bounds = x;
            c->worst           = i;
        }
    }
    return measure_widths(context, c);
}

static bool is_mostly_unknown(const bundle_comparison *c) { return 2 * c->unknown > c->count; }

static bool is_blind(const bundle_comparison *c)
{
    size_t sized = 0;
    for (size_t i = 0; i < c->count; i++) {
        sized += has_width(c, i);
    }
    return c->count == 0 || is_mostly_unknown(c) || 2 * c->vacuous > sized;
}

assay_verdict_kind bundle_compare_kind(const bundle_comparison *c)
{
    return c->beyond > 0 ? ASSAY_VERDICT_FAIL
           : is_blind(c) ? ASSAY_VERDICT_CANNOT_TELL
                         : ASSAY_VERDICT_PASS;
}

double bundle_compare_ulps(assay_precision precision, double mine, double theirs)
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

static void describe_failure(const bundle_comparison *c, char *words, size_t size)
{
    const int used = snprintf(words, size, "%zu %s beyond %s.", c->beyond,
                              c->beyond == 1 ? "number is" : "numbers are",
                              c->beyond == 1 ? "its bound" : "their bounds");
    stage_meaning(c->out->columns, c->count, c->values, c->out->values, words + used,
                  size - (size_t)used);
}

void bundle_compare_describe(const bundle_comparison *c, char *words, size_t size)
{
    words[0] = '\0';
    switch (bundle_compare_kind(c)) {
    case ASSAY_VERDICT_FAIL: describe_failure(c, words, size); break;
    case ASSAY_VERDICT_CANNOT_TELL:
        snprintf(words, size, "%s",
                 c->count == 0 ? "The array is empty."
                 : is_mostly_unknown(c)
                     ? "Most of its values have no bound."
                     : "Most bounds are as large as what they bound: with so "
                       "few digits, computed or stored, nothing is decided here.");
        break;
    case ASSAY_VERDICT_PASS: break;
    }
}
