/* Nanoseconds for all values of a direction, against the textbook: angles by acos and atan2, each
 * function by itself, its Legendre polynomial by the standard recurrence, its normalisation by
 * factorials, its cosine from libm.  And for turning coefficients by a rotation matrix, against a
 * product that does not know of its blocks.  Both are timed in turn, and the ratio is the least
 * disturbed of several rounds of each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/assay.h"
#include "bench/bench.h"

enum { DIRECTIONS = 1024, ROUNDS = 15, ORDERS = 4 };

static const double pi = 3.14159265358979323846;

static double factorial(int n)
{
    double product = 1.0;
    for (int i = 2; i <= n; i++) {
        product *= i;
    }
    return product;
}

/* [gautron06] eq. 3.4 to 3.6 */
static double legendre(int l, int m, double x)
{
    double       mm   = 1.0;
    const double root = sqrt((1.0 - x) * (1.0 + x));
    for (int i = 1; i <= m; i++) {
        mm *= -(2.0 * i - 1.0) * root;
    }
    if (l == m) {
        return mm;
    }
    double last = mm, here = x * (2.0 * m + 1.0) * mm;
    for (int i = m + 2; i <= l; i++) {
        const double next = (x * (2.0 * i - 1.0) * here - (i + m - 1.0) * last) / (i - m);
        last              = here;
        here              = next;
    }
    return here;
}

/* eq. 3.7 and 3.18: area is that of the domain, 4 pi or 2 pi */
static double textbook(int l, int m, double x, double phi, double area)
{
    const int    a = abs(m);
    const double k = sqrt((2.0 * l + 1.0) * factorial(l - a) / (area * factorial(l + a)));
    if (m == 0) {
        return k * legendre(l, 0, x);
    }
    return sqrt(2.0) * k * legendre(l, a, x) * (m > 0 ? cos(a * phi) : sin(a * phi));
}

static void textbook_all(bool hemisphere, int order, assay_vec3 d, double *values)
{
    const double theta = acos(d.z);
    const double phi   = atan2(d.y, d.x);
    const double x     = hemisphere ? 2.0 * cos(theta) - 1.0 : cos(theta);
    for (int l = 0; l < order; l++) {
        for (int m = -l; m <= l; m++) {
            values[l * l + l + m] = textbook(l, m, x, phi, hemisphere ? 2.0 * pi : 4.0 * pi);
        }
    }
}

typedef enum { WAY_TEXTBOOK, WAY_SINGLE, WAY_BATCH, WAY_COUNT } way;

static void run(way w, const assay_basis *basis, const assay_vec3 *directions, double *values)
{
    const size_t count = assay_basis_count(basis);
    const bool   hemi  = assay_basis_kind_of(basis) == ASSAY_BASIS_HSH;
    if (w == WAY_BATCH) {
        assay_basis_evaluate_many(basis, DIRECTIONS, directions, values);
        return;
    }
    for (size_t i = 0; i < DIRECTIONS; i++) {
        if (w == WAY_SINGLE) {
            assay_basis_evaluate(basis, directions[i], values + i * count);
        } else {
            textbook_all(hemi, assay_basis_order(basis), directions[i], values + i * count);
        }
    }
}

static void measure(const assay_basis *basis, const assay_vec3 *directions, double *values)
{
    double best[WAY_COUNT] = {INFINITY, INFINITY, INFINITY};
    for (int round = 0; round < ROUNDS; round++) {
        for (int w = 0; w < WAY_COUNT; w++) {
            const double start = bench_seconds(CLOCK_MONOTONIC);
            run((way)w, basis, directions, values);
            best[w] = fmin(best[w], (bench_seconds(CLOCK_MONOTONIC) - start) / DIRECTIONS * 1e9);
        }
    }
    printf("%-4s order %2d  textbook %9.1f ns  single %8.1f ns (%5.1fx)  batch %8.1f ns (%5.1fx)\n",
           assay_basis_kind_name(assay_basis_kind_of(basis)), assay_basis_order(basis),
           best[WAY_TEXTBOOK], best[WAY_SINGLE], best[WAY_TEXTBOOK] / best[WAY_SINGLE],
           best[WAY_BATCH], best[WAY_TEXTBOOK] / best[WAY_BATCH]);
}

/* ---- turning coefficients ---- */

static void textbook_rotate(size_t count, const double *matrix, const double *in, double *out)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = 0.0;
        for (size_t j = 0; j < count; j++) {
            out[i] += matrix[i * count + j] * in[j];
        }
    }
}

static void measure_rotation(const assay_basis *sh)
{
    enum { TURNS = 512 };
    const size_t count  = assay_basis_count(sh);
    double      *matrix = calloc(count * count, sizeof *matrix);
    double      *two    = calloc(2 * count, sizeof *two);
    double       rotation[9], best[2] = {INFINITY, INFINITY};
    assay_rotation_from_euler_zyz(0.3, 0.8, -1.1, rotation);
    if (!matrix || !two || assay_sh_rotation(sh, rotation, matrix) != ASSAY_OK) {
        exit(EXIT_FAILURE);
    }
    two[0] = 1.0;
    for (int round = 0; round < ROUNDS; round++) {
        for (int ours = 0; ours < 2; ours++) {
            const double start = bench_seconds(CLOCK_MONOTONIC);
            for (int i = 0; i < TURNS; i++) {
                double *in = two + (size_t)(i & 1) * count, *out = two + (size_t)(~i & 1) * count;
                if (!ours) {
                    textbook_rotate(count, matrix, in, out);
                } else if (assay_sh_rotate(sh, matrix, 1, in, out) != ASSAY_OK) {
                    exit(EXIT_FAILURE);
                }
            }
            best[ours] = fmin(best[ours], (bench_seconds(CLOCK_MONOTONIC) - start) / TURNS);
        }
    }
    printf("turning SH n = %2d   textbook %8.1f ns   ours %8.1f ns   ratio %5.1f\n",
           assay_basis_order(sh), 1e9 * best[0], 1e9 * best[1], best[0] / best[1]);
    free(two);
    free(matrix);
}

int main(void)
{
    static const int              orders[ORDERS] = {3, 5, 10, 16};
    static const assay_basis_kind kinds[2]       = {ASSAY_BASIS_SH, ASSAY_BASIS_HSH};
    assay_vec3                   *directions     = calloc(DIRECTIONS, sizeof *directions);
    double                       *values         = calloc((size_t)DIRECTIONS * 256, sizeof *values);
    assay_context                *context        = NULL;
    if (!directions || !values || assay_context_create(NULL, &context) != ASSAY_OK) {
        return EXIT_FAILURE;
    }
    for (int i = 0; i < DIRECTIONS; i++) {
        const double z   = (i + 0.5) / DIRECTIONS;
        const double phi = 2.0 * pi * fmod(i * 0.6180339887498949, 1.0);
        const double r   = sqrt((1.0 - z) * (1.0 + z));
        directions[i]    = (assay_vec3){r * cos(phi), r * sin(phi), z};
    }
    for (int kind = 0; kind < 2; kind++) {
        for (int i = 0; i < ORDERS; i++) {
            assay_basis *basis = NULL;
            if (assay_basis_create(context, kinds[kind], orders[i], ASSAY_CONVENTION_THESIS,
                                   &basis) != ASSAY_OK) {
                return EXIT_FAILURE;
            }
            measure(basis, directions, values);
            if (kinds[kind] == ASSAY_BASIS_SH) {
                measure_rotation(basis);
            }
            assay_basis_destroy(basis);
        }
    }
    assay_context_destroy(context);
    free(values);
    free(directions);
    return EXIT_SUCCESS;
}
