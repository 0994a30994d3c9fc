/* double_double.h - numbers as an unevaluated sum of two doubles, some 104 bits, for constants and
 * recurrences that are wanted correctly rounded.
 *
 * |lo| is at most half a unit of the last place of hi.  Slow where fma is a function call; not for
 * inner loops.  Relative errors of some 2^-102 an operation [joldes17]. */
#ifndef ASSAY_MATH_DOUBLE_DOUBLE_H
#define ASSAY_MATH_DOUBLE_DOUBLE_H

#include <math.h>

typedef struct {
    double hi, lo;
} double_double;

#define DOUBLE_DOUBLE_PI ((double_double){0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53})

/* a + b, exactly, for |a| >= |b| or a = 0. */
static inline double_double dd_fast_sum(double a, double b)
{
    const double sum = a + b;
    return (double_double){sum, b - (sum - a)};
}

/* a + b and a b, exactly. */
static inline double_double dd_two_sum(double a, double b)
{
    const double sum = a + b, part = sum - a;
    return (double_double){sum, (a - (sum - part)) + (b - part)};
}

static inline double_double dd_two_product(double a, double b)
{
    const double product = a * b;
    return (double_double){product, fma(a, b, -product)};
}

static inline double_double dd_of(double a) { return (double_double){a, 0.0}; }
static inline double_double dd_negate(double_double a) { return (double_double){-a.hi, -a.lo}; }
/* Rounded to nearest. */
static inline double dd_round(double_double a) { return a.hi + a.lo; }

static inline double_double dd_add(double_double a, double_double b)
{
    const double_double high = dd_two_sum(a.hi, b.hi), low = dd_two_sum(a.lo, b.lo);
    const double_double sum = dd_fast_sum(high.hi, high.lo + low.hi);
    return dd_fast_sum(sum.hi, sum.lo + low.lo);
}

static inline double_double dd_subtract(double_double a, double_double b)
{
    return dd_add(a, dd_negate(b));
}

static inline double_double dd_multiply(double_double a, double_double b)
{
    const double product = a.hi * b.hi;
    const double error   = fma(a.hi, b.hi, -product) + (a.hi * b.lo + a.lo * b.hi);
    return dd_fast_sum(product, error);
}

static inline double_double dd_multiply_double(double_double a, double b)
{
    const double product = a.hi * b;
    return dd_fast_sum(product, fma(a.hi, b, -product) + a.lo * b);
}

static inline double_double dd_divide(double_double a, double_double b)
{
    const double quotient = a.hi / b.hi;
    const double rest     = (fma(-quotient, b.hi, a.hi) + a.lo) - quotient * b.lo;
    return dd_fast_sum(quotient, rest / b.hi);
}

static inline double_double dd_divide_double(double_double a, double b)
{
    const double quotient = a.hi / b;
    return dd_fast_sum(quotient, (fma(-quotient, b, a.hi) + a.lo) / b);
}

/* a >= 0 */
static inline double_double dd_sqrt(double_double a)
{
    if (!(a.hi > 0.0)) {
        return dd_of(0.0);
    }
    const double root = sqrt(a.hi);
    const double rest = fma(-root, root, a.hi) + a.lo;
    return dd_fast_sum(root, rest / (2.0 * root));
}

#endif
