/* test_hsh_rotation.c - M_R and M against another rule, what they must be, and what the thesis's
 * other ways of rotating are worth. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/quadrature.h"
#include "support/failing_context.h"
#include "support/near.h"

static const double PI = ASSAY_PI;

static const assay_hsh_rotation_options EXACT      = {.way = ASSAY_HSH_EXACT};
static const assay_hsh_rotation_options ANALYTICAL = {.way = ASSAY_HSH_ANALYTICAL};

static assay_context *context_of(void **state) { return *state; }

static int set_up(void **state)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    *state = context;
    return 0;
}

static int tear_down(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

static assay_basis *make(assay_context *context, int order, assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_HSH, order, convention, &basis),
                     ASSAY_OK);
    return basis;
}

static double *matrix_of(const assay_basis *hsh)
{
    double *matrix = calloc(assay_basis_count(hsh) * assay_basis_count(hsh), sizeof *matrix);
    assert_non_null(matrix);
    return matrix;
}

static double *turned(const assay_basis *hsh, assay_context *context,
                      assay_hsh_rotation_options options, double beta)
{
    double *matrix = matrix_of(hsh);
    assert_int_equal(assay_hsh_rotation_y(hsh, context, &options, beta, matrix), ASSAY_OK);
    return matrix;
}

static double *digon(const assay_basis *hsh, assay_context *context, double beta)
{
    double *matrix = matrix_of(hsh);
    assert_int_equal(assay_hsh_digon(hsh, context, beta, matrix), ASSAY_OK);
    return matrix;
}

static double distance(size_t count, const double *a, const double *b)
{
    double worst = 0.0;
    for (size_t i = 0; i < count * count; i++) {
        worst = fmax(worst, fabs(a[i] - b[i]));
    }
    return worst;
}

/* ---- the second method ---- */

enum { SIDE = 160 };

/* x in (0, width) and its weight by the tanh-sinh rule; *rest_out: width - x. */
static double tanh_sinh(int q, double width, double *rest_out, double *weight_out)
{
    const double h = 7.0 / SIDE, u = (q - SIDE / 2) * h, a = 0.5 * PI * sinh(u);
    const double x = 1.0 / (1.0 + exp(-2.0 * a)), r = 1.0 / (1.0 + exp(2.0 * a));
    *rest_out   = width * r;
    *weight_out = width * h * PI * cosh(u) * x * r;
    return width * x;
}

/* Integral of H_i(w) H_j(u) over what lies up to pi - turn - gap from the horizon at +x (or -x:
 * mirrored), measured about y; u is w moved on by the turn. */
static double *second_method(const assay_basis *hsh, double turn, double gap, bool mirrored)
{
    const size_t n      = assay_basis_count(hsh);
    const double width  = PI - turn - gap;
    double      *matrix = matrix_of(hsh), a[64], b[64];
    for (int q = 0; q <= SIDE; q++) {
        double       rest = 0.0, weight = 0.0;
        const double d = tanh_sinh(q, width, &rest, &weight), up = d + turn;
        const double below = gap + rest; /* pi - up, without cancellation */
        const double sine  = up < 0.5 * PI ? sin(up) : sin(below);
        for (int p = 0; p <= SIDE; p++) {
            double           unused = 0.0, psi_weight = 0.0;
            const double     psi = tanh_sinh(p, PI, &unused, &psi_weight);
            const double     c = sin(psi < 0.5 * PI ? psi : unused), y = -cos(psi);
            const double     side = mirrored ? -1.0 : 1.0;
            const assay_vec3 w    = {side * c * cos(d), y, c * sin(d)};
            const assay_vec3 u    = {side * c * cos(up), y, c * sine};
            assert_int_equal(assay_basis_evaluate(hsh, w, a), ASSAY_OK);
            assert_int_equal(assay_basis_evaluate(hsh, u, b), ASSAY_OK);
            for (size_t i = 0; i < n; i++) {
                for (size_t j = 0; j < n; j++) {
                    matrix[i * n + j] += weight * psi_weight * c * a[i] * b[j];
                }
            }
        }
    }
    return matrix;
}

/* R turns +z to +x by beta > 0, so what is at height d at +x comes from d + beta. */
static void test_second_method(void **state)
{
    assay_context      *context    = context_of(state);
    static const double angles[]   = {1e-9, 0.01, 0.3, 1.0, 0.5 * ASSAY_PI, 2.2, 3.1};
    double              worst_turn = 0.0, worst_digon = 0.0;
    for (int order = 3; order <= 5; order += 2) {
        assay_basis *hsh = make(context, order, ASSAY_CONVENTION_THESIS);
        const size_t n   = assay_basis_count(hsh);
        for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
            if (order == 5 && k % 2) {
                continue;
            }
            const double beta = angles[k];
            double      *a    = turned(hsh, context, EXACT, beta);
            double      *b    = second_method(hsh, beta, 0.0, false);
            worst_turn        = fmax(worst_turn, distance(n, a, b));
            free(a);
            free(b);
            a           = digon(hsh, context, beta);
            b           = second_method(hsh, 0.0, beta, true);
            worst_digon = fmax(worst_digon, distance(n, a, b));
            free(a);
            free(b);
        }
        assay_basis_destroy(hsh);
    }
    printf("# M_R off by %.2g, M by %.2g (orders 3 and 5, another rule)\n", worst_turn,
           worst_digon);
    assert_true(worst_turn <= 3e-14);
    assert_true(worst_digon <= 3e-14);
}

/* ---- what they must be ---- */

/* Largest singular value, by the power method. */
static double norm_of(size_t n, const double *a)
{
    double *x = malloc(2 * n * sizeof *x), *y = x + n, norm = 0.0;
    assert_non_null(x);
    for (size_t i = 0; i < n; i++) {
        x[i] = 1.0 / (1.0 + (double)i);
    }
    for (int step = 0; step < 60; step++) {
        norm = 0.0;
        for (size_t i = 0; i < n; i++) {
            y[i] = 0.0;
            for (size_t j = 0; j < n; j++) {
                y[i] += a[i * n + j] * x[j];
            }
            norm += y[i] * y[i];
        }
        double length = 0.0;
        for (size_t i = 0; i < n; i++) {
            x[i] = 0.0;
            for (size_t j = 0; j < n; j++) {
                x[i] += a[j * n + i] * y[j];
            }
            length += x[i] * x[i];
        }
        for (size_t i = 0; i < n; i++) {
            x[i] /= sqrt(length);
        }
        norm = sqrt(sqrt(length)); /* |a' a x| of a unit x */
    }
    free(x);
    return norm;
}

static void check_identities(assay_context *context, const assay_basis *hsh, double beta)
{
    const size_t n = assay_basis_count(hsh);
    double      *r = turned(hsh, context, EXACT, beta), *back = turned(hsh, context, EXACT, -beta);
    double      *m = digon(hsh, context, beta), *other = digon(hsh, context, -beta);
    assert_near(r[0], 1.0 - beta / PI, 1e-14);
    assert_near(m[0], 1.0 - beta / PI, 1e-14);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            assert_near(back[i * n + j], r[j * n + i], 0.0);
            assert_near(m[i * n + j], m[j * n + i], 2e-16);
        }
    }
    assert_true(norm_of(n, r) <= 1.0 + 1e-14);
    assert_true(norm_of(n, m) <= 1.0 + 1e-14);
    if (beta > 0.01 && beta < 3.0) {
        assert_true(distance(n, r, back) > 1e-3 || n == 1);
        assert_true(distance(n, m, other) > 1e-5 || n == 1);
    }
    free(r);
    free(back);
    free(m);
    free(other);
}

static void test_identities(void **state)
{
    assay_context      *context  = context_of(state);
    static const double angles[] = {
        0.0, 1e-14, 1e-5, ASSAY_PI / 18.0, ASSAY_PI / 6.0, ASSAY_PI / 3.0, 1.9, 3.0};
    for (int order = 1; order <= 10; order += 3) {
        assay_basis *hsh = make(context, order, ASSAY_CONVENTION_THESIS);
        const size_t n   = assay_basis_count(hsh);
        for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
            check_identities(context, hsh, angles[k]);
        }
        double *r = turned(hsh, context, EXACT, 0.0), *gone = turned(hsh, context, EXACT, PI);
        double *m = digon(hsh, context, 0.0), *empty = digon(hsh, context, PI);
        for (size_t i = 0; i < n * n; i++) {
            assert_true(r[i] == (i % (n + 1) == 0) && m[i] == (i % (n + 1) == 0));
            assert_true(gone[i] == 0.0 && empty[i] == 0.0);
        }
        free(r);
        free(gone);
        free(m);
        free(empty);
        assay_basis_destroy(hsh);
    }
}

/* Orders as far as the basis goes: the rows of the smaller order are those of the larger. */
static void test_orders(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *small   = make(context, 6, ASSAY_CONVENTION_PLAIN);
    assay_basis   *large   = make(context, 14, ASSAY_CONVENTION_PLAIN);
    assay_basis   *thesis  = make(context, 6, ASSAY_CONVENTION_THESIS);
    double        *a = turned(small, context, EXACT, 0.4), *b = turned(large, context, EXACT, 0.4);
    double        *c = turned(thesis, context, EXACT, 0.4), worst = 0.0;
    for (size_t i = 0; i < 36; i++) {
        for (size_t j = 0; j < 36; j++) {
            int l = 0, m = 0, k = 0;
            assay_basis_function(small, i, &l, &m);
            assay_basis_function(small, j, &l, &k);
            worst = fmax(worst, fabs(a[i * 36 + j] - b[i * 196 + j]));
            assert_near(c[i * 36 + j], ((m - k) & 1 ? -1.0 : 1.0) * a[i * 36 + j], 1e-15);
        }
    }
    printf("# M_R of order 6 in that of order 14: off by %.2g\n", worst);
    assert_true(worst <= 1e-14);
    free(a);
    free(b);
    free(c);
    assay_basis_destroy(small);
    assay_basis_destroy(large);
    assay_basis_destroy(thesis);
}

/* ---- lobes: cos^k about the pole, turned by beta ---- */

enum { RINGS = 96, SECTORS = 192 };

/* Coefficients of z^k. */
static void lobe_coefficients(const assay_basis *hsh, int k, double *coefficients_out)
{
    double node[64], weight[64], values[1089];
    memset(coefficients_out, 0, assay_basis_count(hsh) * sizeof *coefficients_out);
    assay_gauss_legendre_on(0.0, 1.0, 64, node, weight);
    for (int q = 0; q < 64; q++) {
        const double z = node[q];
        assert_int_equal(assay_basis_evaluate(hsh, (assay_vec3){sqrt(1.0 - z * z), 0.0, z}, values),
                         ASSAY_OK);
        for (int l = 0; l < assay_basis_order(hsh); l++) {
            const int i = l * l + l;
            coefficients_out[i] += 2.0 * PI * weight[q] * pow(z, k) * values[i];
        }
    }
}

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
    lobe_coefficients(hsh, k, in);
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
    assay_basis   *hsh     = make(context, 21, ASSAY_CONVENTION_THESIS);
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        const double beta = bound[i].degrees * PI / 180.0;
        double      *a    = turned(hsh, context, ANALYTICAL, beta);
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
    assay_basis   *hsh     = make(context, 8, ASSAY_CONVENTION_THESIS);
    double         pole[64], there[64];
    assert_int_equal(assay_basis_evaluate(hsh, (assay_vec3){0, 0, 1}, pole), ASSAY_OK);
    for (int k = -9; k <= 9; k++) {
        const double     beta = k * PI / 18.0;
        double          *a    = turned(hsh, context, ANALYTICAL, beta);
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
    double *a    = turned(hsh, context, ANALYTICAL, PI / 6.0),
           *b    = turned(hsh, context, ANALYTICAL, PI / 3.0);
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
    assay_basis   *hsh     = make(context, 8, ASSAY_CONVENTION_THESIS);
    const double   beta    = PI / 6.0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double      *a = turned(hsh, context,
                                (assay_hsh_rotation_options){.way      = ASSAY_HSH_CONVERSION,
                                                             .sh_order = known[i].sh_order},
                                beta);
        const double e = 100.0 * lobe_error(hsh, a, 20, beta).coefficients;
        printf("# HSH 8 by SH %d, cos^20 by 30 degrees: off by %.2f %%\n", known[i].sh_order, e);
        assert_true(e >= known[i].low && e <= known[i].high);
        free(a);
    }
    double      *a = turned(hsh, context, EXACT, beta);
    const double e = 100.0 * lobe_error(hsh, a, 20, beta).coefficients;
    printf("# the same by M_R: %.2f %%\n", e);
    assert_true(e >= 1.2 && e <= 1.3);
    double *d = turned(hsh, context, (assay_hsh_rotation_options){.way = ASSAY_HSH_DIGON}, beta);
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
    assay_basis   *hsh     = make(context, 3, ASSAY_CONVENTION_PLAIN);
    double        *exact = turned(hsh, context, EXACT, -0.5), before = 1.0;
    for (int order = 4; order <= 32; order *= 2) {
        double *a = turned(
            hsh, context,
            (assay_hsh_rotation_options){.way = ASSAY_HSH_CONVERSION, .sh_order = order}, -0.5);
        const double now = distance(9, a, exact);
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
    assay_basis   *hsh      = make(context, 4, ASSAY_CONVENTION_THESIS);
    double         worst[2] = {0.0, 0.0};
    for (int k = 0; k <= 16; k++) {
        const double beta = k * (PI / 32.0);
        double      *a =
            turned(hsh, context, (assay_hsh_rotation_options){.way = ASSAY_HSH_TABLE}, -beta);
        double *b = turned(hsh, context, EXACT, -beta);
        assert_true(distance(16, a, b) <= 1e-14);
        free(a);
        free(b);
    }
    for (int pass = 0; pass < 2; pass++) {
        const int steps = pass ? 32 : 16;
        for (int k = 0; k < steps; k++) {
            const double beta = (k + 0.5) * (0.5 * PI / steps);
            double      *a    = turned(hsh, context,
                                       (assay_hsh_rotation_options){.way         = ASSAY_HSH_TABLE,
                                                                    .table_steps = pass ? steps : 0},
                                       beta);
            double      *b    = turned(hsh, context, EXACT, beta);
            worst[pass]       = fmax(worst[pass], distance(16, a, b));
            free(a);
            free(b);
        }
    }
    printf("# a table of 16 steps is off by %.2g at order 4, of 32 by %.2g\n", worst[0], worst[1]);
    assert_true(worst[0] < 0.05 && worst[0] > 1e-3);
    assert_true(worst[1] < 0.6 * worst[0]); /* first order near 0 (roots), second elsewhere */
    assay_basis_destroy(hsh);
}

/* ---- what is lost ---- */

/* A uniform sky after a turn by beta gives pi (1 + cos beta) / 2: the digon that comes up is dark.
 */
static void test_furnace(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh     = make(context, 4, ASSAY_CONVENTION_THESIS);
    double         one[16], cosine[16];
    lobe_coefficients(hsh, 0, one);
    lobe_coefficients(hsh, 1, cosine);
    for (int k = 0; k <= 18; k++) {
        const double beta = k * PI / 18.0;
        double      *a = turned(hsh, context, EXACT, beta), irradiance = 0.0;
        for (int i = 0; i < 256; i++) {
            irradiance += cosine[i / 16] * a[i] * one[i % 16];
        }
        assert_near(irradiance, 0.5 * PI * (1.0 + cos(beta)), 2e-14);
        free(a);
    }
    assay_basis_destroy(hsh);
}

/* ---- any rotation ---- */

static void test_any_rotation(void **state)
{
    assay_context *context     = context_of(state);
    assay_basis   *hsh         = make(context, 5, ASSAY_CONVENTION_THESIS);
    const double   angles[][3] = {{0.4, 0.9, -2.0}, {1.0, 0.0, 0.5},   {0.3, ASSAY_PI, 0.2},
                                  {0.0, 2.0, 0.0},  {-2.5, 1e-7, 1.5}, {1.0, 0.5 * ASSAY_PI, 3.0}};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        const double a = angles[k][0], b = angles[k][1], g = angles[k][2];
        for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT; way++) {
            const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
            double                           r[9], *matrix = matrix_of(hsh);
            assay_rotation_from_euler_zyz(a, b, g, r);
            const assay_status status = assay_hsh_rotation(hsh, context, &options, r, matrix);
            if (b > 1.6 && way != ASSAY_HSH_EXACT && way != ASSAY_HSH_CONVERSION) {
                assert_int_equal(status, ASSAY_ERR_DOMAIN);
                free(matrix);
                continue;
            }
            assert_int_equal(status, ASSAY_OK);
            double *y = turned(hsh, context, options, b), in[25], mid[25], out[25];
            for (int j = 0; j < 25; j++) {
                memset(in, 0, sizeof in);
                in[j] = 1.0;
                assert_int_equal(assay_basis_rotate_z(hsh, g, 1, in), ASSAY_OK);
                for (int i = 0; i < 25; i++) {
                    mid[i] = 0.0;
                    for (int q = 0; q < 25; q++) {
                        mid[i] += y[i * 25 + q] * in[q];
                    }
                }
                memcpy(out, mid, sizeof out);
                assert_int_equal(assay_basis_rotate_z(hsh, a, 1, out), ASSAY_OK);
                for (int i = 0; i < 25; i++) {
                    assert_near(matrix[i * 25 + j], out[i], 1e-7 * (b == 0.5 * PI) + 2e-14);
                }
            }
            free(y);
            free(matrix);
        }
    }
    assay_basis_destroy(hsh);
}

/* ---- refusals ---- */

static assay_status all_ways(assay_context *context, void *user)
{
    (void)user;
    assay_basis *hsh = NULL;
    double       matrix[81];
    assay_status status =
        assay_basis_create(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS, &hsh);
    for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT && !status; way++) {
        const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
        matrix[0]                                = 7.0;
        status = assay_hsh_rotation_y(hsh, context, &options, 0.4, matrix);
        assert_true(!status || matrix[0] == 7.0);
    }
    assay_basis_destroy(hsh);
    return status;
}

static void test_refusals(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh = make(context, 2, ASSAY_CONVENTION_THESIS), *sh = NULL;
    double         matrix[16] = {7.0}, r[9];
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_SH, 2, ASSAY_CONVENTION_THESIS, &sh),
                     ASSAY_OK);
    assert_int_equal(assay_hsh_rotation_y(sh, context, &EXACT, 0.1, matrix), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_hsh_digon(sh, context, 0.1, matrix), ASSAY_ERR_ARGUMENT);
    const assay_hsh_rotation_options wrong[] = {
        {.way = (assay_hsh_rotation_way)5},
        {.way = (assay_hsh_rotation_way)-1},
        {.way = ASSAY_HSH_CONVERSION, .sh_order = -1},
        {.way = ASSAY_HSH_CONVERSION, .sh_order = ASSAY_BASIS_MAX_ORDER + 1},
        {.way = ASSAY_HSH_TABLE, .table_steps = -1},
    };
    assay_rotation_from_euler_zyz(0.1, 0.2, 0.3, r);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(assay_hsh_rotation_y(hsh, context, &wrong[i], 0.1, matrix),
                         ASSAY_ERR_ARGUMENT);
        assert_int_equal(assay_hsh_rotation(hsh, context, &wrong[i], r, matrix),
                         ASSAY_ERR_ARGUMENT);
        assert_true(assay_context_error(context)[0] != '\0');
    }
    for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT; way++) {
        const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
        const bool   any   = way == ASSAY_HSH_EXACT || way == ASSAY_HSH_CONVERSION;
        const double limit = any ? PI : 0.5 * PI;
        const double bad[] = {NAN, INFINITY, nextafter(limit, 4.0), -nextafter(limit, 4.0)};
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            assert_int_equal(assay_hsh_rotation_y(hsh, context, &options, bad[i], matrix),
                             ASSAY_ERR_DOMAIN);
        }
        r[0] = NAN;
        assert_int_equal(assay_hsh_rotation(hsh, context, &options, r, matrix), ASSAY_ERR_DOMAIN);
    }
    assert_int_equal(assay_hsh_digon(hsh, context, 3.2, matrix), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_hsh_digon(hsh, context, NAN, matrix), ASSAY_ERR_DOMAIN);
    assert_true(matrix[0] == 7.0);
    assay_basis_destroy(hsh);
    assay_basis_destroy(sh);
    assert_true(failing_each(all_ways, NULL) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_method),
        cmocka_unit_test(test_identities),
        cmocka_unit_test(test_orders),
        cmocka_unit_test(test_analytical_error),
        cmocka_unit_test(test_analytical_pole),
        cmocka_unit_test(test_conversion_way),
        cmocka_unit_test(test_conversion_converges),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_any_rotation),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
