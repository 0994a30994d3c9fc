/* least_squares.c - SH fitted on the hemisphere, without their Gram matrix.
 *
 * The textbook way solves G c = b with G = integral of Y Y^T over the hemisphere, whose condition
 * number grows as 34^order: nothing is left of the coefficients at order 11.  Here the SH of one m,
 *
 *     (1 - z^2)^(m/2) times polynomials of degree < order - m,
 *
 * get an orthonormal basis q first, whose recurrence is found from its own values (Stieltjes,
 * [gautschi04]), and then Y = q R with R triangular: G = R^T R, but c = R^-1 (integral of f q) has
 * only the root of G's condition number.
 *
 * Invariant: for every m, terms(m) = order - m functions q_k = (1 - z^2)^(m/2) p_k(z) azimuth_m,
 * p_(k+1) = ((z - centre_k) p_k - slope_k p_(k-1)) / slope_(k+1), orthonormal over the hemisphere;
 * q_k stands for l = m + k. */
#include "basis/least_squares.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

struct assay_least_squares {
    assay_context *context;
    int            order;
    double        *first;    /* order: p_0 of each m, with the azimuth's norm          */
    double        *centre;   /* order * order: row m, of step k                        */
    double        *slope;    /* order * order                                          */
    double        *triangle; /* order rows of order * order: R of m, [k * order + l - m] */
    double         condition;
};

static double *row_of(const assay_least_squares *fit, double *table, int m)
{
    return table + (size_t)m * (size_t)fit->order;
}

static double *triangle_of(const assay_least_squares *fit, int m)
{
    return fit->triangle + (size_t)m * (size_t)fit->order * (size_t)fit->order;
}

/* Nodes of the hemisphere's z with what is wanted of them for one m. */
typedef struct {
    int           count;
    const double *z, *weight;
    double       *mass;               /* weight (1 - z^2)^m                     */
    double       *previous, *current; /* p_(k-1), p_k                           */
    double       *harmonics;          /* count rows of order^2: SH at azimuth 0 */
} node_table;

static double power(double base, int exponent)
{
    double result = 1.0;
    for (int i = 0; i < exponent; i++) {
        result *= base;
    }
    return result;
}

static double total(const node_table *nodes, const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < nodes->count; i++) {
        sum += nodes->mass[i] * a[i] * b[i];
    }
    return sum;
}

/* Row k of R: q_k against the SH of l = m + k ... order - 1. */
static void fill_row(assay_least_squares *fit, const node_table *nodes, int m, int k)
{
    const int    n     = fit->order;
    double      *row   = triangle_of(fit, m) + (size_t)k * (size_t)n;
    const double round = m > 0 ? ASSAY_PI : ASSAY_TWO_PI;
    for (int l = m + k; l < n; l++) {
        double sum = 0.0;
        for (int i = 0; i < nodes->count; i++) {
            const double sine = sqrt((1.0 - nodes->z[i]) * (1.0 + nodes->z[i]));
            sum += nodes->weight[i] * power(sine, m) * nodes->current[i] *
                   nodes->harmonics[(size_t)i * (size_t)(n * n) + (size_t)(l * l + l + m)];
        }
        row[l - m] = round * sum;
    }
}

static void orthogonalise(assay_least_squares *fit, const node_table *nodes, int m)
{
    double      *centre = row_of(fit, fit->centre, m), *slope = row_of(fit, fit->slope, m);
    const double round = m > 0 ? ASSAY_PI : ASSAY_TWO_PI;
    double       sum   = 0.0;
    for (int i = 0; i < nodes->count; i++) {
        nodes->mass[i] =
            round * nodes->weight[i] * power((1.0 - nodes->z[i]) * (1.0 + nodes->z[i]), m);
        sum += nodes->mass[i];
    }
    fit->first[m] = 1.0 / sqrt(sum);
    for (int i = 0; i < nodes->count; i++) {
        nodes->previous[i] = 0.0;
        nodes->current[i]  = fit->first[m];
    }
    for (int k = 0; k < fit->order - m; k++) {
        fill_row(fit, nodes, m, k);
        double mean = 0.0;
        for (int i = 0; i < nodes->count; i++) {
            mean += nodes->mass[i] * nodes->z[i] * nodes->current[i] * nodes->current[i];
        }
        centre[k] = mean;
        if (k + 1 == fit->order - m) {
            break;
        }
        for (int i = 0; i < nodes->count; i++) {
            const double next =
                (nodes->z[i] - mean) * nodes->current[i] - slope[k] * nodes->previous[i];
            nodes->previous[i] = nodes->current[i];
            nodes->current[i]  = next;
        }
        slope[k + 1] = sqrt(total(nodes, nodes->current, nodes->current));
        for (int i = 0; i < nodes->count; i++) {
            nodes->current[i] /= slope[k + 1];
        }
    }
}

/* x = R^-1 x for one m; x has a stride between successive l that grows, so it comes by index. */
static void back_substitute(const assay_least_squares *fit, int m, int sign, double *c)
{
    const int     n = fit->order;
    const double *r = triangle_of(fit, m);
    for (int l = n - 1; l >= m; l--) {
        double value = c[l * l + l + sign * m];
        for (int j = l + 1; j < n; j++) {
            value -= r[(l - m) * n + j - m] * c[j * j + j + sign * m];
        }
        c[l * l + l + sign * m] = value / r[(l - m) * n + l - m];
    }
}

/* ||R|| ||R^-1|| in the 1-norm; scratch: order^2. */
static double condition_of(const assay_least_squares *fit, int m, double *scratch)
{
    const int     n    = fit->order;
    const double *r    = triangle_of(fit, m);
    double        norm = 0.0, inverse_norm = 0.0;
    for (int column = m; column < n; column++) {
        double sum = 0.0, inverse_sum = 0.0;
        for (int l = m; l < n; l++) {
            sum += fabs(r[(l - m) * n + column - m]);
            scratch[l * l + l + m] = l == column ? 1.0 : 0.0;
        }
        back_substitute(fit, m, 1, scratch);
        for (int l = m; l < n; l++) {
            inverse_sum += fabs(scratch[l * l + l + m]);
        }
        norm         = fmax(norm, sum);
        inverse_norm = fmax(inverse_norm, inverse_sum);
    }
    return norm * inverse_norm;
}

static assay_status fill(assay_least_squares *fit, const assay_basis *basis, double *work)
{
    const int    n     = fit->order;
    const int    count = n + 1;
    double      *z = work, *weight = z + count;
    node_table   nodes  = {.count     = count,
                           .z         = z,
                           .weight    = weight,
                           .mass      = weight + count,
                           .previous  = weight + 2 * count,
                           .current   = weight + 3 * count,
                           .harmonics = weight + 4 * count};
    assay_status status = ASSAY_OK;
    assay_gauss_legendre_on(0.0, 1.0, count, z, weight);
    for (int i = 0; i < count && status == ASSAY_OK; i++) {
        const assay_vec3 d = {sqrt((1.0 - z[i]) * (1.0 + z[i])), 0.0, z[i]};
        status = assay_basis_evaluate(basis, d, nodes.harmonics + (size_t)i * (size_t)(n * n));
    }
    if (status != ASSAY_OK) {
        return status;
    }
    for (int m = 0; m < n; m++) {
        orthogonalise(fit, &nodes, m);
        fit->condition = fmax(fit->condition, condition_of(fit, m, nodes.harmonics));
    }
    return ASSAY_OK;
}

assay_status assay_least_squares_create(assay_context *context, const assay_basis *basis,
                                        bool solve, assay_least_squares **fit_out)
{
    const size_t         n   = (size_t)assay_basis_order(basis);
    assay_least_squares *fit = assay_allocate(context, 1, sizeof *fit);
    if (!fit) {
        return assay_fail_memory(context, "a fit");
    }
    double *work        = assay_allocate(context, (n + 1) * (5 + n * n), sizeof *work);
    fit->context        = context;
    fit->order          = (int)n;
    fit->first          = assay_allocate(context, n, sizeof *fit->first);
    fit->centre         = assay_allocate(context, n * n, sizeof *fit->centre);
    fit->slope          = assay_allocate(context, n * n, sizeof *fit->slope);
    fit->triangle       = assay_allocate(context, n * n * n, sizeof *fit->triangle);
    assay_status status = work && fit->first && fit->centre && fit->slope && fit->triangle
                              ? fill(fit, basis, work)
                              : assay_fail_memory(context, "a fit");
    if (status == ASSAY_OK && solve && !(fit->condition <= ASSAY_LEAST_SQUARES_CONDITION)) {
        status = assay_fail(context, ASSAY_ERR_DOMAIN,
                            "least squares by SH of order %d on the hemisphere are singular to "
                            "working precision (condition number %.2g); lower the order",
                            (int)n, fit->condition);
    }
    assay_release(context, work);
    if (status != ASSAY_OK) {
        assay_least_squares_destroy(fit);
        return status;
    }
    *fit_out = fit;
    return ASSAY_OK;
}

void assay_least_squares_destroy(assay_least_squares *fit)
{
    if (fit) {
        assay_release(fit->context, fit->first);
        assay_release(fit->context, fit->centre);
        assay_release(fit->context, fit->slope);
        assay_release(fit->context, fit->triangle);
        assay_release(fit->context, fit);
    }
}

void assay_least_squares_evaluate(const assay_least_squares *fit, assay_vec3 d, double *values_out)
{
    const int n  = fit->order;
    double    re = 1.0, im = 0.0; /* (x + i y)^m = sin^m(theta) (cos, sin)(m phi) */
    for (int m = 0; m < n; m++) {
        const double *centre = row_of(fit, fit->centre, m), *slope = row_of(fit, fit->slope, m);
        double        previous = 0.0, current = fit->first[m];
        for (int l = m; l < n; l++) {
            values_out[l * l + l + m] = re * current;
            if (m > 0) {
                values_out[l * l + l - m] = im * current;
            }
            if (l + 1 < n) {
                const int    k = l - m;
                const double next =
                    ((d.z - centre[k]) * current - slope[k] * previous) / slope[k + 1];
                previous = current;
                current  = next;
            }
        }
        const double turned = re * d.x - im * d.y;
        im                  = re * d.y + im * d.x;
        re                  = turned;
    }
}

void assay_least_squares_solve(const assay_least_squares *fit, double *coefficients)
{
    for (int m = 0; m < fit->order; m++) {
        back_substitute(fit, m, 1, coefficients);
        if (m > 0) {
            back_substitute(fit, m, -1, coefficients);
        }
    }
}

double assay_least_squares_condition(const assay_least_squares *fit) { return fit->condition; }
