/* distribution.c - prefix sums and a binary search.
 *
 * Invariant: prefix[0] = 0, prefix[i + 1] >= prefix[i], prefix[count] = total, and the probability
 * of an index is (prefix[i + 1] - prefix[i]) / total: what the search really gives it, not the
 * quotient of the weights.  An estimator that divides by it stays unbiased whatever the sums were
 * rounded to, and an index whose weight vanished in them has probability 0.  The sums are
 * compensated
 * ([neumaier74]), so each prefix is within two units of its last place. */
#include "math/distribution.h"

#include <math.h>

#include "core/alloc.h"
#include "core/context.h"

static const size_t MAX_COUNT = (size_t)1 << 31;

struct assay_distribution1 {
    assay_context *context;
    size_t         count;
    double        *prefix; /* count + 1 */
};

struct assay_distribution2 {
    assay_context *context;
    size_t         rows, columns;
    double        *row_prefix; /* rows + 1                                */
    double        *prefix;     /* columns + 1 a row, of that row's weights */
};

/* count + 1 prefix sums of count weights. */
static assay_status sum_weights(assay_context *context, const double *weights, size_t count,
                                double *prefix)
{
    double sum = 0.0, lost = 0.0, reached = 0.0;
    prefix[0] = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double w = weights[i];
        if (!(w >= 0.0) || isinf(w)) {
            return assay_fail(context, ASSAY_ERR_DOMAIN,
                              "weight %zu of a distribution is %g; it must be finite and >= 0", i,
                              w);
        }
        const double next = sum + w;
        lost += sum >= w ? (sum - next) + w : (w - next) + sum;
        sum = next;
        /* Compensation may waver by a unit; the search needs order. */
        reached       = fmax(reached, sum + lost);
        prefix[i + 1] = reached;
    }
    if (!isfinite(sum)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN, "the weights of a distribution are too large");
    }
    return ASSAY_OK;
}

/* The index whose interval holds u * total; the caller has seen to total > 0. */
static size_t search(const double *prefix, size_t count, double u)
{
    const double x   = u * prefix[count];
    size_t       low = 0, high = count; /* prefix[low] <= x < prefix[high] */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (prefix[middle] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    /* u * total can round up to the total of subnormal weights. */
    while (prefix[low] == prefix[low + 1]) {
        low--;
    }
    return low;
}

/* Where u lies in the interval of its index, [0, 1). */
static double remap(const double *prefix, size_t count, size_t index, double u)
{
    const double x = u * prefix[count];
    const double t = (x - prefix[index]) / (prefix[index + 1] - prefix[index]);
    return t < 0.0 ? 0.0 : t < 1.0 ? t : 0x1.fffffffffffffp-1;
}

static double probability(const double *prefix, size_t count, size_t index)
{
    const double total = prefix[count];
    return total > 0.0 ? (prefix[index + 1] - prefix[index]) / total : 0.0;
}

assay_status assay_distribution1_create(assay_context *context, const double *weights, size_t count,
                                        assay_distribution1 **distribution_out)
{
    if (count == 0 || count > MAX_COUNT) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "a distribution cannot have %zu weights",
                          count);
    }
    assay_distribution1 *d = assay_allocate(context, 1, sizeof *d);
    if (!d) {
        return assay_fail_memory(context, "a distribution");
    }
    d->context                = context;
    d->count                  = count;
    d->prefix                 = assay_allocate(context, count + 1, sizeof *d->prefix);
    const assay_status status = d->prefix ? sum_weights(context, weights, count, d->prefix)
                                          : assay_fail_memory(context, "a distribution");
    if (status != ASSAY_OK) {
        assay_distribution1_destroy(d);
        return status;
    }
    *distribution_out = d;
    return ASSAY_OK;
}

void assay_distribution1_destroy(assay_distribution1 *d)
{
    if (d) {
        assay_release(d->context, d->prefix);
        assay_release(d->context, d);
    }
}

size_t assay_distribution1_count(const assay_distribution1 *d) { return d->count; }

double assay_distribution1_total(const assay_distribution1 *d) { return d->prefix[d->count]; }

size_t assay_distribution1_sample(const assay_distribution1 *d, double u, double *probability_out,
                                  double *remapped_out)
{
    size_t       index    = 0;
    double       p        = 0.0;
    double       remapped = u;
    const double total    = d->prefix[d->count];
    if (total > 0.0) {
        index    = search(d->prefix, d->count, u);
        p        = probability(d->prefix, d->count, index);
        remapped = remap(d->prefix, d->count, index, u);
    }
    if (probability_out) {
        *probability_out = p;
    }
    if (remapped_out) {
        *remapped_out = remapped;
    }
    return index;
}

double assay_distribution1_probability(const assay_distribution1 *d, size_t index)
{
    return probability(d->prefix, d->count, index);
}

static assay_status sum_rows(assay_distribution2 *d, const double *weights)
{
    assay_context *context = d->context;
    double        *totals  = assay_allocate(context, d->rows, sizeof *totals);
    if (!totals) {
        return assay_fail_memory(context, "a distribution");
    }
    assay_status status = ASSAY_OK;
    for (size_t row = 0; row < d->rows && status == ASSAY_OK; row++) {
        double *prefix = d->prefix + row * (d->columns + 1);
        status         = sum_weights(context, weights + row * d->columns, d->columns, prefix);
        totals[row]    = prefix[d->columns];
    }
    if (status == ASSAY_OK) {
        status = sum_weights(context, totals, d->rows, d->row_prefix);
    }
    assay_release(context, totals);
    return status;
}

assay_status assay_distribution2_create(assay_context *context, const double *weights, size_t rows,
                                        size_t columns, assay_distribution2 **distribution_out)
{
    if (rows == 0 || columns == 0 || rows > MAX_COUNT / columns) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a distribution cannot have %zu x %zu weights", rows, columns);
    }
    assay_distribution2 *d = assay_allocate(context, 1, sizeof *d);
    if (!d) {
        return assay_fail_memory(context, "a distribution");
    }
    d->context                = context;
    d->rows                   = rows;
    d->columns                = columns;
    d->row_prefix             = assay_allocate(context, rows + 1, sizeof *d->row_prefix);
    d->prefix                 = assay_allocate(context, rows * (columns + 1), sizeof *d->prefix);
    const assay_status status = d->row_prefix && d->prefix
                                    ? sum_rows(d, weights)
                                    : assay_fail_memory(context, "a distribution");
    if (status != ASSAY_OK) {
        assay_distribution2_destroy(d);
        return status;
    }
    *distribution_out = d;
    return ASSAY_OK;
}

void assay_distribution2_destroy(assay_distribution2 *d)
{
    if (d) {
        assay_release(d->context, d->row_prefix);
        assay_release(d->context, d->prefix);
        assay_release(d->context, d);
    }
}

double assay_distribution2_total(const assay_distribution2 *d) { return d->row_prefix[d->rows]; }

assay_distribution2_cell assay_distribution2_sample(const assay_distribution2 *d, double u_row,
                                                    double u_column)
{
    if (!(assay_distribution2_total(d) > 0.0)) {
        return (assay_distribution2_cell){.in_row = u_row, .in_column = u_column};
    }
    assay_distribution2_cell cell   = {.row = search(d->row_prefix, d->rows, u_row)};
    const double            *prefix = d->prefix + cell.row * (d->columns + 1);
    cell.column                     = search(prefix, d->columns, u_column);
    cell.in_row                     = remap(d->row_prefix, d->rows, cell.row, u_row);
    cell.in_column                  = remap(prefix, d->columns, cell.column, u_column);
    cell.probability                = assay_distribution2_probability(d, cell.row, cell.column);
    return cell;
}

double assay_distribution2_probability(const assay_distribution2 *d, size_t row, size_t column)
{
    const double *prefix = d->prefix + row * (d->columns + 1);
    return probability(d->row_prefix, d->rows, row) * probability(prefix, d->columns, column);
}
