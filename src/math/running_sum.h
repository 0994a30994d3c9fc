/* running_sum.h - sums that keep what rounding loses ([neumaier74]): exact to a few units whatever
 * the number of terms, as long as they are added in one order. */
#ifndef ASSAY_MATH_RUNNING_SUM_H
#define ASSAY_MATH_RUNNING_SUM_H

#include <math.h>
#include <stdint.h>

/* {0} is an empty sum. */
typedef struct {
    double sum, lost;
} running_sum;

static inline void running_sum_add(running_sum *s, double x)
{
    const double next = s->sum + x;
    s->lost += fabs(s->sum) >= fabs(x) ? (s->sum - next) + x : (x - next) + s->sum;
    s->sum = next;
}

/* NaN over nothing; what is not finite stays so. */
static inline double running_sum_mean(const running_sum *s, uint64_t count)
{
    const double total = isfinite(s->sum) ? s->sum + s->lost : s->sum;
    return count ? total / (double)count : NAN;
}

#endif
