/* statistics.c - binned tests of directional samplers.
 *
 * Expected counts must be better than the noise of the observed ones by far: the quadrature's error
 * a cell, 1e-7 of the whole, is 0.01 counts in 1e5 draws. */
#include "statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/numerics.h"
#include "core/random.h"

enum { NODES = 4, DEPTH = 9 };

/* ---- distributions ---- */

/* Lower series, for x < a + 1. */
static double gamma_p_series(double a, double x)
{
    double term = 1.0 / a, sum = term;
    for (int n = 1; term > sum * 1e-17; n++) {
        term *= x / (a + n);
        sum += term;
    }
    return sum;
}

/* Continued fraction of the upper function by Lentz's method, for x >= a + 1. */
static double gamma_q_fraction(double a, double x)
{
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int i = 1; i < 100000; i++) {
        const double an = -i * (i - a);
        b += 2.0;
        d                  = 1.0 / (an * d + b);
        c                  = b + an / c;
        const double delta = d * c;
        h *= delta;
        if (fabs(delta - 1.0) < 1e-16) {
            break;
        }
    }
    return h;
}

double statistics_gamma_q(double a, double x)
{
    if (x <= 0.0) {
        return 1.0;
    }
    int          sign;
    const double front = exp(a * log(x) - x - lgamma_r(a, &sign));
    return x < a + 1.0 ? 1.0 - front * gamma_p_series(a, x) : front * gamma_q_fraction(a, x);
}

double statistics_chi_square_tail(double x, int k) { return statistics_gamma_q(0.5 * k, 0.5 * x); }

double statistics_sidak(double level, int count) { return -expm1(log1p(-level) / count); }

/* ---- grids ---- */

statistics_grid statistics_grid_between(double z_min, double z_max, int rows, int columns)
{
    statistics_grid grid = {.rows = rows, .columns = columns};
    for (int i = 0; i <= rows; i++) {
        grid.z[i] = z_min + (z_max - z_min) * i / rows;
    }
    for (int i = 0; i <= columns; i++) {
        grid.phi[i] = ASSAY_PI * (2.0 * i / columns - 1.0);
    }
    return grid;
}

/* Keeps the edges ascending; edges that nearly coincide or lie outside are left out. */
static int insert_edge(double *edges, int cells, double x)
{
    int at = 0;
    while (at <= cells && edges[at] < x) {
        at++;
    }
    if (at == 0 || at > cells || cells + 2 > STATISTICS_EDGES || x - edges[at - 1] < 1e-9 ||
        edges[at] - x < 1e-9) {
        return cells;
    }
    memmove(edges + at + 1, edges + at, sizeof *edges * (size_t)(cells + 1 - at));
    edges[at] = x;
    return cells + 1;
}

void statistics_grid_cut(statistics_grid *grid, double z)
{
    grid->rows = insert_edge(grid->z, grid->rows, z);
}

void statistics_grid_focus(statistics_grid *grid, assay_vec3 direction, double width)
{
    static const double steps[] = {-30.0, -12.0, -5.0, -2.0, -0.7, 0.0, 0.7, 2.0, 5.0, 12.0, 30.0};
    const double        sine    = sqrt(direction.x * direction.x + direction.y * direction.y);
    const double        theta   = atan2(sine, direction.z);
    const double        phi     = sine > 1e-9 ? atan2(direction.y, direction.x) : 0.0;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const double at = theta + steps[i] * width;
        if (at > 0.0 && at < ASSAY_PI) {
            grid->rows = insert_edge(grid->z, grid->rows, cos(at));
        }
        const double turn = steps[i] * width / fmax(sine, width);
        if (fabs(turn) < ASSAY_PI) {
            grid->columns =
                insert_edge(grid->phi, grid->columns, remainder(phi + turn, ASSAY_TWO_PI));
        }
    }
}

/* ---- quadrature ---- */

typedef struct {
    statistics_density density;
    const void        *context;
    double             tolerance;
} integrand;

typedef struct {
    double z0, z1, phi0, phi1;
} cell;

static double rule(const integrand *f, cell c)
{
    static const double nodes[NODES]   = {0.06943184420297371, 0.33000947820757187,
                                          0.66999052179242813, 0.93056815579702629};
    static const double weights[NODES] = {0.17392742256872693, 0.32607257743127307,
                                          0.32607257743127307, 0.17392742256872693};
    double              sum            = 0.0;
    for (int i = 0; i < NODES; i++) {
        const double z   = c.z0 + (c.z1 - c.z0) * nodes[i];
        const double r   = sqrt((1.0 - z) * (1.0 + z));
        double       row = 0.0;
        for (int j = 0; j < NODES; j++) {
            const double phi = c.phi0 + (c.phi1 - c.phi0) * nodes[j];
            row += weights[j] * f->density(f->context, (assay_vec3){r * cos(phi), r * sin(phi), z});
        }
        sum += weights[i] * row;
    }
    return sum * (c.z1 - c.z0) * (c.phi1 - c.phi0);
}

static double integrate_cell(const integrand *f, cell c, double whole, int depth)
{
    const double z = 0.5 * (c.z0 + c.z1), phi = 0.5 * (c.phi0 + c.phi1);
    const cell   quarters[4] = {{c.z0, z, c.phi0, phi},
                                {c.z0, z, phi, c.phi1},
                                {z, c.z1, c.phi0, phi},
                                {z, c.z1, phi, c.phi1}};
    double       parts[4], sum = 0.0;
    for (int i = 0; i < 4; i++) {
        parts[i] = rule(f, quarters[i]);
        sum += parts[i];
    }
    if (depth == DEPTH || fabs(sum - whole) <= fmax(f->tolerance, 1e-9 * fabs(sum))) {
        return sum;
    }
    sum = 0.0;
    for (int i = 0; i < 4; i++) {
        sum += integrate_cell(f, quarters[i], parts[i], depth + 1);
    }
    return sum;
}

double statistics_integrate(const statistics_grid *grid, statistics_density density,
                            const void *context, double tolerance, double *cells_out)
{
    const integrand f   = {density, context, tolerance};
    double          sum = 0.0;
    for (int i = 0; i < grid->rows; i++) {
        for (int j = 0; j < grid->columns; j++) {
            const cell   c = {grid->z[i], grid->z[i + 1], grid->phi[j], grid->phi[j + 1]};
            const double x = integrate_cell(&f, c, rule(&f, c), 1);
            if (cells_out) {
                cells_out[i * grid->columns + j] = x;
            }
            sum += x;
        }
    }
    return sum;
}

/* ---- chi-square ---- */

/* The cell that holds x, by bisection; clamped at the ends. */
static int cell_of(const double *edges, int cells, double x)
{
    int low = 0, high = cells;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (edges[middle] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Draws, and counts by cell; the last bin is of draws that gave nothing.  False where a direction
 * came that the density does not know. */
static bool count_draws(const statistics_grid *grid, const integrand *f, statistics_sampler sampler,
                        int count, uint64_t seed, double *observed)
{
    bool possible = true;
    for (int k = 0; k < count; k++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 0, (uint32_t)k);
        double       u[3];
        for (int i = 0; i < 3; i++) {
            u[i] = assay_random_next(&random);
        }
        assay_vec3 w;
        if (!sampler(f->context, u, &w)) {
            observed[grid->rows * grid->columns] += 1.0;
            continue;
        }
        const double p = f->density(f->context, w);
        possible =
            possible && isfinite(p) && p > 0.0 && w.z >= grid->z[0] && w.z <= grid->z[grid->rows];
        const int row    = cell_of(grid->z, grid->rows, w.z);
        const int column = cell_of(grid->phi, grid->columns, atan2(w.y, w.x));
        observed[row * grid->columns + column] += 1.0;
    }
    return possible;
}

/* Pearson's statistic over bins; neighbours with small expectations share one.  What is then left
 * over, too little for a bin, has a Poisson test of its own, whose probability is returned:
 * P(X >= n) = P(n, mean). */
static double compare(const double *expected, const double *observed, int bins,
                      statistics_verdict *verdict)
{
    double e = 0.0, o = 0.0, sum = 0.0;
    int    used = 0;
    for (int i = 0; i < bins; i++) {
        if (expected[i] >= 5.0) {
            sum += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
            used++;
            continue;
        }
        e += expected[i];
        o += observed[i];
        if (e >= 5.0) {
            sum += (o - e) * (o - e) / e;
            used++;
            e = o = 0.0;
        }
    }
    verdict->chi_square = sum;
    verdict->degrees    = used - 1;
    verdict->p_shape    = used > 1 ? statistics_chi_square_tail(sum, used - 1) : 1.0;
    return o > 0.0 ? 1.0 - statistics_gamma_q(o, fmax(e, 1e-6)) : 1.0;
}

/* Two-sided, normal; where the variance is too small for that, the bin of the chi-square test has
 * to do. */
static double mass_tail(double mass, double drawn, int count)
{
    const double variance = mass * (1.0 - mass) / count;
    return variance * count * (double)count > 25.0 ? erfc(fabs(drawn - mass) / sqrt(2.0 * variance))
                                                   : 1.0;
}

statistics_verdict statistics_test_sampler(const statistics_grid *grid, statistics_density density,
                                           statistics_sampler sampler, const void *context,
                                           int count, uint64_t seed)
{
    const integrand    f        = {density, context, 1e-7};
    const int          cells    = grid->rows * grid->columns;
    double            *expected = calloc(2 * ((size_t)cells + 1), sizeof *expected);
    statistics_verdict verdict  = {0};
    if (!expected) {
        return verdict;
    }
    double *observed = expected + cells + 1;
    verdict.mass     = statistics_integrate(grid, density, context, f.tolerance, expected);
    bool possible    = count_draws(grid, &f, sampler, count, seed, observed);
    verdict.drawn    = 1.0 - observed[cells] / count;
    expected[cells]  = fmax(1.0 - verdict.mass, 0.0);
    for (int i = 0; i <= cells; i++) {
        possible    = possible && expected[i] >= 0.0;
        expected[i] = expected[i] * count;
    }
    possible          = possible && verdict.mass <= 1.0 + 1e-4;
    const double rest = compare(expected, observed, cells + 1, &verdict);
    const double mass = mass_tail(verdict.mass, verdict.drawn, count);
    verdict.p         = possible ? fmin(1.0, 3.0 * fmin(verdict.p_shape, fmin(rest, mass))) : 0.0;
    free(expected);
    return verdict;
}

/* ---- means ---- */

void statistics_mean_add(statistics_mean *mean, double x)
{
    mean->count++;
    const double delta = x - mean->mean;
    mean->mean += delta / (double)mean->count;
    mean->m2 += delta * (x - mean->mean);
}

double statistics_mean_error(const statistics_mean *mean)
{
    const double n = (double)mean->count;
    return n > 1.0 ? sqrt(mean->m2 / (n - 1.0) / n) : INFINITY;
}
