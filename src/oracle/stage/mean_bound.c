/* mean_bound.c - the extreme of a mean over a box of weights.
 *
 * The mean sum(w x) / sum(w) is largest where every weight is at one of its ends: the high one
 * where x is above that largest mean, the low one below.  Dinkelbach's iteration [dinkelbach67]
 * finds it: from any mean t, the mean by the ends that t asks for is at least t; it stops at the
 * largest after finitely many steps, as each step but the last one raises it and there are finitely
 * many choices.
 *
 * What the rounding of sums, products and the quotient adds is relative to the mean of |x|: the
 * products' sum is off by (1 + u)^n - 1 of the sum of |w x|, the weights' by (1 + u)^(n - 1) - 1.
 */
#include "oracle/stage/mean_bound.h"

static double part_value(const mean_part *part, int channel, double sign)
{
    return sign * part->said[channel].v + part->said[channel].e;
}

static double largest(const mean_part *parts, size_t count, int channel, double sign)
{
    double most = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (parts[i].high > 0.0) {
            most = fmax(most, part_value(&parts[i], channel, sign));
        }
    }
    return most;
}

double mean_highest(const mean_part *parts, size_t count, int channel, double sign)
{
    enum { MOST_STEPS = 64 };
    const double most   = largest(parts, count, channel, sign);
    double       t      = -INFINITY;
    bool         raised = true;
    for (int step = 0; step < MOST_STEPS && raised; step++) {
        double sum = 0.0, weight = 0.0;
        for (size_t i = 0; i < count; i++) {
            const double x = part_value(&parts[i], channel, sign);
            const double w = x >= t ? parts[i].high : parts[i].low;
            /* Of differences, so that a common value is met exactly. */
            sum += w * (x - most);
            weight += w;
        }
        const double mean = weight > 0.0 ? most + sum / weight : most;
        raised            = mean > t;
        t                 = raised ? mean : t;
    }
    return raised ? most : t;
}

double mean_bound(const rounding *r, const mean_part *parts, size_t count, int channel,
                  double value)
{
    const double high = mean_highest(parts, count, channel, 1.0);
    const double low  = -mean_highest(parts, count, channel, -1.0);
    double       size = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (parts[i].high > 0.0) {
            size = fmax(size, fabs(parts[i].said[channel].v) + parts[i].said[channel].e);
        }
    }
    const double n = (double)count;
    const double grown =
        rounding_growth(r, 2.0 * n + 1.0) / (1.0 - fmin(0.5, rounding_growth(r, n)));
    return fmax(fmax(high - value, value - low), 0.0) + grown * size + r->tiny * n;
}
