/* student.c - P(|T| >= t) is the regularised incomplete beta function I_x(a, 1/2) with a half the
 * degrees and x = degrees / (degrees + t^2) [dlmf, 8.17].
 *
 * Invariant: y = 1 - x is never computed from x, and nothing is subtracted from 1 but what is well
 * below it: so the tail keeps its digits however many degrees there are, up to the normal
 * distribution, which is the limit. */
#include "oracle/image/student.h"

#include <float.h>

#include "core/numerics.h"

enum { MOST_TERMS = 5000 };

/* log of Gamma(a + 1/2) / Gamma(a): the series of Stirling for both [dlmf, 5.11.8], subtracted term
 * by term so that nothing cancels, from a = 16 on; below by Gamma(a + 1) = a Gamma(a). */
static double log_gamma_half_step(double a)
{
    double below = 1.0;
    while (a < 16.0) {
        below *= a / (a + 0.5);
        a += 1.0;
    }
    const double r = 1.0 / a, z = r * r;
    double       sum = -5461.0 / 425984.0;
    sum              = sum * z + 691.0 / 180224.0;
    sum              = sum * z - 31.0 / 18432.0;
    sum              = sum * z + 17.0 / 14336.0;
    sum              = sum * z - 1.0 / 640.0;
    sum              = sum * z + 1.0 / 192.0;
    sum              = sum * z - 1.0 / 8.0;
    return 0.5 * assay_log(a) + assay_log(below) + sum * r;
}

/* x = degrees / (degrees + t^2), y = 1 - x, a = degrees / 2; log_x and log_y without cancellation,
 * also where t^2 overflows. */
typedef struct {
    double a, x, y, log_x, log_y;
} beta_place;

static beta_place place_of(double t, double degrees)
{
    const double r = t / sqrt(degrees), q = r * r; /* t^2 / degrees */
    if (q <= 1e200) {
        return (beta_place){degrees / 2.0, 1.0 / (1.0 + q), q / (1.0 + q), -assay_log1p(q),
                            r < 1e-150 ? 2.0 * assay_log(r) : assay_log(q) - assay_log1p(q)};
    }
    return (beta_place){degrees / 2.0, 0.0, 1.0, -2.0 * (assay_log(t) - 0.5 * assay_log(degrees)),
                        0.0};
}

/* log of x^a y^b / B(a, b) with b = 1/2, B = Gamma(a) sqrt(pi) / Gamma(a + 1/2). */
static double log_power_terms(const beta_place *p)
{
    const double log_sqrt_pi = 0.57236494292470008707;
    return p->a * p->log_x + 0.5 * p->log_y + log_gamma_half_step(p->a) - log_sqrt_pi;
}

/* I_y(1/2, a) y-side: y^b x^a / (b B) (1 + sum of the products of (a + b + n) y / (b + 1 + n)), all
 * terms positive [dlmf, 8.17.8]. */
static double series_near_zero(const beta_place *p)
{
    double term = 1.0, sum = 1.0;
    for (int n = 0; n < MOST_TERMS && term > sum * (DBL_EPSILON / 8.0); n++) {
        term *= (p->a + 0.5 + n) * p->y / (1.5 + n);
        sum += term;
    }
    return 2.0 * assay_exp(log_power_terms(p)) * sum;
}

/* The continued fraction of [didonato92, eq. 9] for I_x(a, b) over x^a y^b / B, by the recurrence
 * of [lentz76]; with a y in place of a (1 - x) it loses nothing as x goes to 1. */
static double fraction(const beta_place *p)
{
    const double a = p->a, b = 0.5;
    const double slope = a * p->y - b * p->x + 1.0;
    double       value = a / (a + 1.0) * slope, c = value, d = 0.0;
    for (int m = 1; m < MOST_TERMS; m++) {
        const double over = a + 2.0 * m - 1.0;
        const double top =
            (a + m - 1.0) / over * ((a + b + m - 1.0) / over) * (m * (b - m)) * (p->x * p->x);
        const double bottom =
            m + m * (b - m) / over * p->x + (a + m) / (over + 2.0) * (slope + m * (1.0 + p->y));
        d                   = 1.0 / (bottom + top * d);
        c                   = bottom + top / c;
        const double change = c * d;
        value *= change;
        if (fabs(change - 1.0) < 2.0 * DBL_EPSILON) {
            break;
        }
    }
    return 1.0 / value;
}

double assay_student_log_p(double t, double degrees)
{
    t = fabs(t);
    if (isnan(t) || isnan(degrees) || t == 0.0 || isinf(t)) {
        return isnan(t) || isnan(degrees) ? NAN : t == 0.0 ? 0.0 : -INFINITY;
    }
    const beta_place p = place_of(t, fmin(degrees, ASSAY_NORMAL));
    /* Where the series converges fast, and what it leaves of 1 is at least a twentieth. */
    if (p.a * p.y < 1.5 * p.x + p.y && p.y < 0.6) {
        return assay_log1p(-series_near_zero(&p));
    }
    return log_power_terms(&p) + assay_log(fraction(&p));
}

/* The place between low and high where a line between both logarithms is at log_p, or the middle
 * where that is no place between. */
static double between(double low, double high, double at_low, double at_high, double log_p)
{
    const double share = (at_low - log_p) / (at_low - at_high);
    const double x     = low + (high - low) * share;
    return x > low && x < high ? x : low + (high - low) / 2.0;
}

double assay_student_quantile(double log_p, double degrees)
{
    double low = 0.0, high = 1.0, at_low = 0.0, at_high = assay_student_log_p(1.0, degrees);
    while (at_high > log_p) {
        low    = high;
        at_low = at_high;
        high *= 2.0;
        at_high = assay_student_log_p(high, degrees);
        if (isinf(high)) {
            return INFINITY;
        }
    }
    /* Secants, and every third time a bisection, so that it ends. */
    for (int step = 0; high - low > 4.0 * DBL_EPSILON * high; step++) {
        const double x  = step % 3 == 2 || isinf(at_high)
                              ? low + (high - low) / 2.0
                              : between(low, high, at_low, at_high, log_p);
        const double at = assay_student_log_p(x, degrees);
        if (fabs(at - log_p) <= DBL_EPSILON * fabs(log_p)) {
            return x;
        }
        if (at > log_p) {
            low    = x;
            at_low = at;
        } else {
            high    = x;
            at_high = at;
        }
    }
    return high;
}
