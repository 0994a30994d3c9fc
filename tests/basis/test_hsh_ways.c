/* test_hsh_ways.c - what the thesis's other ways of rotating are worth. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "math/quadrature.h"
#include "support/basis_fixture.h"
#include "support/hsh_matrix.h"
#include "support/near.h"

static const double PI = ASSAY_PI;

static const assay_hsh_rotation_options EXACT      = {.way = ASSAY_HSH_EXACT};
static const assay_hsh_rotation_options ANALYTICAL = {.way = ASSAY_HSH_ANALYTICAL};

enum { RINGS = 96, SECTORS = 192 };

static assay_context *context_of(void **state) { return *state; }

/* ---- lobes: cos^k about the pole, turned by beta ---- */

typedef struct {
    double shape;        /* of M times the lobe from the turned lobe, over the hemisphere */
    double coefficients; /* of M times the lobe's from the turned lobe's                  */
} lobe_distance;

/* Relative L2 distances for the lobe cos^k. */
static lobe_distance lobe_error(const assay_basis *hsh, const double *matrix, int k, double beta)
{
    const size_t n  = assay_basis_count(hsh);
    double      *in = calloc(4 * n, sizeof *in), *out = in + n, *best = out + n, *v = best + n;
    assert_non_null(in);
    hsh_power(hsh, k, in);
    for (size_t i = 0; i < n * n; i++) {
        out[i / n] += matrix[i] * in[i % n];
    }
    double node[RINGS], weight[RINGS], error = 0.0, energy = 0.0, length = 0.0, apart = 0.0;
    assay_gauss_legendre_on(0.0, 1.0, RINGS, node, weight);
    for (int q = 0; q < RINGS; q++) {
        for (int p = 0; p < SECTORS; p++) {
            const double z = node[q], s = sqrt(1.0 - z * z), phi = 2.0 * PI * (p + 0.5) / SECTORS;
            const assay_vec3 w  = {s * cos(phi), s * sin(phi), z};
            const double     up = w.x * sin(beta) + w.z * cos(beta);
            const double     f = up > 0.0 ? pow(up, k) : 0.0, dw = weight[q] * 2.0 * PI / SECTORS;
            double           g = 0.0;
            assert_int_equal(assay_basis_evaluate(hsh, w, v), ASSAY_OK);
            for (size_t i = 0; i < n; i++) {
                g += v[i] * out[i];
                best[i] += dw * f * v[i];
            }
            error += dw * (g - f) * (g - f);
            energy += dw * f * f;
        }
    }
    for (size_t i = 0; i < n; i++) {
        length += best[i] * best[i];
        apart += (out[i] - best[i]) * (out[i] - best[i]);
    }
    free(in);
    return (lobe_distance){sqrt(error / energy), sqrt(apart / length)};
}

/* At order 21 the lobes z^5 and z^20 are in the span, and so are their analytical images. */
static void test_analytical_error(void **state)
{
    static const struct {
        double degrees, percent5, percent20;
    } bound[]              = {{10, 1.9, 1.0}, {30, 7.7, 4.8}, {45, 15, 11}, {60, 24, 23}};
    assay_context *context = context_of(state);
    assay_basis   *hsh     = hsh_basis(context, 21, ASSAY_CONVENTION_THESIS);
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        const double beta = bound[i].degrees * PI / 180.0;
        double      *a    = hsh_turned(hsh, context, ANALYTICAL, beta);
        const double e5   = lobe_error(hsh, a, 5, beta).shape;
        const double e20  = lobe_error(hsh, a, 20, beta).shape;
        printf("# eq. 3.30 at %2g degrees: cos^5 off by %.2f %%, cos^20 by %.2f %%\n",
               bound[i].degrees, 100.0 * e5, 100.0 * e20);
        const double digits5  = bound[i].percent5 < 10 ? .05 : .5;
        const double digits20 = bound[i].percent20 < 10 ? .05 : .5;
        assert_true(100.0 * e5 <= bound[i].percent5 + digits5);
        assert_true(100.0 * e20 <= bound[i].percent20 + digits20);
        free(a);
    }
    assay_basis_destroy(hsh);
}

/* The pole's delta function goes to the right place, on the right side. */
static void test_analytical_pole(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh     = hsh_basis(context, 8, ASSAY_CONVENTION_THESIS);
    double         pole[64], there[64];
    assert_int_equal(assay_basis_evaluate(hsh, (assay_vec3){0, 0, 1}, pole), ASSAY_OK);
    for (int k = -9; k <= 9; k++) {
        const double     beta = k * PI / 18.0;
        double          *a    = hsh_turned(hsh, context, ANALYTICAL, beta);
        const assay_vec3 d    = {sin(beta), 0.0, k == 9 || k == -9 ? 0.0 : cos(beta)};
        assert_int_equal(assay_basis_evaluate(hsh, d, there), ASSAY_OK);
        for (int i = 0; i < 64; i++) {
            double sum = 0.0;
            for (int j = 0; j < 64; j++) {
                sum += a[i * 64 + j] * pole[j];
            }
            /* Near the horizon sqrt(z) makes 1e-8 of the rounding of cos(pi / 2). */
            assert_near(sum, there[i], k == 9 || k == -9 ? 1e-6 : 2e-14);
        }
        free(a);
    }
    /* Twice 30 degrees is not 60. */
    double *a    = hsh_turned(hsh, context, ANALYTICAL, PI / 6.0),
           *b    = hsh_turned(hsh, context, ANALYTICAL, PI / 3.0);
    double worst = 0.0;
    for (int i = 0; i < 4096; i++) {
        double sum = 0.0;
        for (int k = 0; k < 64; k++) {
            sum += a[i / 64 * 64 + k] * a[k * 64 + i % 64];
        }
        worst = fmax(worst, fabs(sum - b[i]));
    }
    assert_true(worst > 0.1);
    /* Its angle: band 1 turns by beta_SH, 42.94 degrees for 30 and 90 for 60. */
    const size_t z = 2, x = 3;
    assert_near(fabs(a[x * 64 + z]), sin(42.9414 * PI / 180.0), 1e-5);
    assert_near(fabs(b[x * 64 + z]), 1.0, 1e-14);
    free(a);
    free(b);
    assay_basis_destroy(hsh);
}

/* ---- by conversion, from a table ---- */

static void test_conversion_way(void **state)
{
    static const struct {
        int    sh_order;
        double low, high; /* percent */
    } known[] = {{0, 18.85, 18.95}, {8, 18.85, 18.95}, {12, 1.1, 1.25}, {20, 1.1, 1.35}};
    assay_context *context = context_of(state);
    assay_basis   *hsh     = hsh_basis(context, 8, ASSAY_CONVENTION_THESIS);
    const double   beta    = PI / 6.0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double      *a = hsh_turned(hsh, context,
                                    (assay_hsh_rotation_options){.way      = ASSAY_HSH_CONVERSION,
                                                                 .sh_order = known[i].sh_order},
                                    beta);
        const double e = 100.0 * lobe_error(hsh, a, 20, beta).coefficients;
        printf("# HSH 8 by SH %d, cos^20 by 30 degrees: off by %.2f %%\n", known[i].sh_order, e);
        assert_true(e >= known[i].low && e <= known[i].high);
        free(a);
    }
    double      *a = hsh_turned(hsh, context, EXACT, beta);
    const double e = 100.0 * lobe_error(hsh, a, 20, beta).coefficients;
    printf("# the same by M_R: %.2f %%\n", e);
    assert_true(e >= 1.2 && e <= 1.3);
    double *d =
        hsh_turned(hsh, context, (assay_hsh_rotation_options){.way = ASSAY_HSH_DIGON}, beta);
    const double f = 100.0 * lobe_error(hsh, d, 20, beta).coefficients;
    printf("# the same by digon deletion and eq. 3.30: %.2f %%\n", f);
    assert_true(f >= 1.0 && f <= 8.0);
    free(a);
    free(d);
    assay_basis_destroy(hsh);
}

/* To SH of a high order and back tends to M_R. */
static void test_conversion_converges(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh     = hsh_basis(context, 3, ASSAY_CONVENTION_PLAIN);
    double        *exact = hsh_turned(hsh, context, EXACT, -0.5), before = 1.0;
    for (int order = 4; order <= 32; order *= 2) {
        double *a = hsh_turned(
            hsh, context,
            (assay_hsh_rotation_options){.way = ASSAY_HSH_CONVERSION, .sh_order = order}, -0.5);
        const double now = hsh_distance(9, a, exact);
        assert_true(now < before);
        before = now;
        free(a);
    }
    assert_true(before < 0.1);
    free(exact);
    assay_basis_destroy(hsh);
}

static void test_table(void **state)
{
    assay_context *context  = context_of(state);
    assay_basis   *hsh      = hsh_basis(context, 4, ASSAY_CONVENTION_THESIS);
    double         worst[2] = {0.0, 0.0};
    for (int k = 0; k <= 16; k++) {
        const double beta = k * (PI / 32.0);
        double      *a =
            hsh_turned(hsh, context, (assay_hsh_rotation_options){.way = ASSAY_HSH_TABLE}, -beta);
        double *b = hsh_turned(hsh, context, EXACT, -beta);
        assert_true(hsh_distance(16, a, b) <= 1e-14);
        free(a);
        free(b);
    }
    for (int pass = 0; pass < 2; pass++) {
        const int steps = pass ? 32 : 16;
        for (int k = 0; k < steps; k++) {
            const double beta = (k + 0.5) * (0.5 * PI / steps);
            double      *a    = hsh_turned(hsh, context,
                                           (assay_hsh_rotation_options){.way         = ASSAY_HSH_TABLE,
                                                                        .table_steps = pass ? steps : 0},
                                           beta);
            double      *b    = hsh_turned(hsh, context, EXACT, beta);
            worst[pass]       = fmax(worst[pass], hsh_distance(16, a, b));
            free(a);
            free(b);
        }
    }
    printf("# a table of 16 steps is off by %.2g at order 4, of 32 by %.2g\n", worst[0], worst[1]);
    assert_true(worst[0] < 0.05 && worst[0] > 1e-3);
    assert_true(worst[1] < 0.6 * worst[0]); /* first order near 0 (roots), second elsewhere */
    assay_basis_destroy(hsh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_analytical_error),
        cmocka_unit_test(test_analytical_pole),
        cmocka_unit_test(test_conversion_way),
        cmocka_unit_test(test_conversion_converges),
        cmocka_unit_test(test_table),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
