/* quadrature.c - Newton's iteration for the zeros of P_n.
 *
 * Invariant: what is returned is the zero and the weight of the exact polynomial, rounded: the last
 * step evaluates P_n and P_(n-1) by their recurrence in double-double, at a double that is already
 * within about 1e-14 of the zero.  In plain double the recurrence loses up to n^2 units near the
 * ends, where the weight, 2 / ((1 - x^2) P_n'(x)^2), is most sensitive to x. */
#include "math/quadrature.h"

#include <assert.h>

#include "core/numerics.h"
#include "math/double_double.h"

enum { NEWTON_STEPS = 8 };

/* Tricomi's approximation of the zero number k from the right [tricomi50]. */
static double start_value(int n, int k)
{
    const double c = n;
    const double x = assay_cos(ASSAY_PI * (4.0 * k + 3.0) / (4.0 * c + 2.0));
    return (1.0 - (c - 1.0) / (8.0 * c * c * c)) * x;
}

static double newton_step(int n, double x)
{
    double p = x, before = 1.0;
    for (int k = 2; k <= n; k++) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before            = p;
        p                 = next;
    }
    return -p * (1.0 - x * x) / (n * (before - x * p));
}

/* The zero next to x, with its weight. */
static void polish(int n, double x, double *node_out, double *weight_out)
{
    double_double p = dd_of(x), before = dd_of(1.0);
    for (int k = 2; k <= n; k++) {
        const double_double a = dd_multiply_double(dd_multiply_double(p, x), 2.0 * k - 1.0),
                            b = dd_multiply_double(before, k - 1.0);
        before                = p;
        p                     = dd_divide_double(dd_subtract(a, b), k);
    }
    const double_double s = dd_multiply(dd_two_sum(1.0, -x), dd_two_sum(1.0, x)); /* 1 - x^2 */
    const double_double slope =
        dd_divide(dd_multiply_double(dd_subtract(before, dd_multiply_double(p, x)), n), s);
    const double_double step = dd_negate(dd_divide(p, slope));

    /* Both factors of the weight at x + step: P'' from Legendre's equation. */
    const double_double bend =
        dd_divide(dd_subtract(dd_multiply_double(slope, 2.0 * x),
                              dd_multiply_double(p, (double)n * ((double)n + 1.0))),
                  s);
    const double_double slope_there = dd_add(slope, dd_multiply(bend, step));
    const double_double s_there     = dd_subtract(s, dd_multiply_double(step, 2.0 * x));
    *node_out                       = dd_round(dd_add(dd_of(x), step));
    *weight_out                     = dd_round(
                            dd_divide(dd_of(2.0), dd_multiply(s_there, dd_multiply(slope_there, slope_there))));
}

void assay_gauss_legendre(int n, double *nodes_out, double *weights_out)
{
    assert(n >= 1);
    for (int k = 0; k < (n + 1) / 2; k++) {
        double x = 2 * k + 1 == n ? 0.0 : start_value(n, k);
        if (n > 1) {
            for (int i = 0; i < NEWTON_STEPS; i++) {
                const double step = newton_step(n, x);
                x += step;
                if (fabs(step) < 0x1p-40) {
                    break;
                }
            }
        }
        double node = 0.0, weight = 2.0;
        if (n > 1) {
            polish(n, 2 * k + 1 == n ? 0.0 : x, &node, &weight);
        }
        nodes_out[n - 1 - k]   = node;
        weights_out[n - 1 - k] = weight;
        nodes_out[k]           = 2 * k + 1 == n ? 0.0 : -node;
        weights_out[k]         = weight;
    }
}

void assay_gauss_legendre_on(double a, double b, int n, double *nodes_out, double *weights_out)
{
    assay_gauss_legendre(n, nodes_out, weights_out);
    const double half = 0.5 * (b - a);
    for (int k = 0; k < n; k++) {
        const double x = nodes_out[k];
        nodes_out[k]   = x < 0.0 ? a + half * (1.0 + x) : b - half * (1.0 - x);
        weights_out[k] *= half;
    }
}
