/* What makes a basis one: orthonormality, the addition theorem, and what turns and slopes do. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "../support/near.h"
#include "assay/assay.h"

enum { MAX_COUNT = ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER, MAX_NODES = 64 };

static const double pi = 3.14159265358979323846;

static int start(void **state)
{
    return assay_context_create(NULL, (assay_context **)state) == ASSAY_OK ? 0 : -1;
}

static int stop(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

static assay_basis *create(assay_context *context, assay_basis_kind kind, int order)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, kind, order, ASSAY_CONVENTION_THESIS, &basis),
                     ASSAY_OK);
    return basis;
}

/* Gauss-Legendre nodes and weights on [a, 1]: Newton's rule on the three-term recurrence. */
static void gauss(int n, double a, double *nodes, double *weights)
{
    for (int i = 0; i < n; i++) {
        double x = cos(pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int round = 0; round < 20; round++) {
            double p = 1.0, before = 0.0;
            for (int k = 0; k < n; k++) {
                const double next = ((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0);
                before            = p;
                p                 = next;
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        nodes[i]   = a + (1.0 - a) * (x + 1.0) / 2.0;
        weights[i] = (1.0 - a) / ((1.0 - x * x) * slope * slope);
    }
}

/* Products of two functions of the same |m| are polynomials in z, all others vanish by the
 * azimuth's trapezium rule: both rules are exact. */
static void gram(const assay_basis *basis, double *matrix)
{
    const assay_basis_kind kind    = assay_basis_kind_of(basis);
    const size_t           count   = assay_basis_count(basis);
    const int              columns = 2 * assay_basis_order(basis) + 1;
    double                 z[MAX_NODES], weight[MAX_NODES], values[MAX_COUNT];
    gauss(24, kind == ASSAY_BASIS_SH ? -1.0 : 0.0, z, weight);
    for (int i = 0; i < 24; i++) {
        for (int j = 0; j < columns; j++) {
            const double phi = 2.0 * pi * j / columns, r = sqrt((1.0 - z[i]) * (1.0 + z[i]));
            const double w =
                weight[i] * 2.0 * pi / columns * (kind == ASSAY_BASIS_MAKHOTKIN ? z[i] : 1.0);
            assert_int_equal(
                assay_basis_evaluate(basis, (assay_vec3){r * cos(phi), r * sin(phi), z[i]}, values),
                ASSAY_OK);
            for (size_t a = 0; a < count; a++) {
                for (size_t b = 0; b < count; b++) {
                    matrix[a * count + b] += w * values[a] * values[b];
                }
            }
        }
    }
}

static void test_orthonormal(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        if (kind == ASSAY_BASIS_LSOSH) {
            continue; /* the functions of SH, on half the sphere: not orthogonal there */
        }
        assay_basis *basis  = create(*state, (assay_basis_kind)kind, 8);
        const size_t count  = assay_basis_count(basis);
        double      *matrix = calloc(count * count, sizeof *matrix);
        assert_non_null(matrix);
        gram(basis, matrix);
        for (size_t i = 0; i < count * count; i++) {
            assert_near(matrix[i], i / count == i % count ? 1.0 : 0.0, 3e-14);
        }
        free(matrix);
        assay_basis_destroy(basis);
    }
}

/* The same up to the largest order, in the plane phi = 0: one m at a time. */
static void test_orthonormal_to_the_last(void **state)
{
    static double rows[48 * MAX_COUNT];
    double        z[MAX_NODES], weight[MAX_NODES];
    for (int kind = 0; kind < ASSAY_BASIS_LSOSH; kind++) {
        assay_basis *basis = create(*state, (assay_basis_kind)kind, ASSAY_BASIS_MAX_ORDER);
        const size_t count = assay_basis_count(basis);
        gauss(48, kind == ASSAY_BASIS_SH ? -1.0 : 0.0, z, weight);
        for (int i = 0; i < 48; i++) {
            const assay_vec3 d = {sqrt((1.0 - z[i]) * (1.0 + z[i])), 0.0, z[i]};
            assert_int_equal(assay_basis_evaluate(basis, d, rows + (size_t)i * count), ASSAY_OK);
        }
        for (size_t a = 0; a < count; a++) {
            for (size_t b = 0; b < count; b++) {
                int la = 0, ma = 0, lb = 0, mb = 0;
                assay_basis_function(basis, a, &la, &ma);
                assay_basis_function(basis, b, &lb, &mb);
                if (ma != mb || ma < 0) {
                    continue;
                }
                double sum = 0.0;
                for (int i = 0; i < 48; i++) {
                    sum += weight[i] * (kind == ASSAY_BASIS_MAKHOTKIN ? z[i] : 1.0) *
                           rows[(size_t)i * count + a] * rows[(size_t)i * count + b];
                }
                assert_near(sum * (ma == 0 ? 2.0 * pi : pi), a == b ? 1.0 : 0.0, 1e-13);
            }
        }
        assay_basis_destroy(basis);
    }
}

/* The sum over m of Y(u) Y(v) is (2l + 1) P_l(u . v) / 4 pi.  HSH are SH of the direction whose
 * height is 2 z - 1, times sqrt(2): the same theorem with that. */
static void test_addition_theorem(void **state)
{
    double u[MAX_COUNT], v[MAX_COUNT];
    for (int kind = 0; kind < 2; kind++) {
        assay_basis *basis = create(*state, (assay_basis_kind)kind, ASSAY_BASIS_MAX_ORDER);
        for (int i = 0; i < 40; i++) {
            const double za = fmod(0.37 + i * 0.618, 1.0), zb = fmod(0.11 + i * 0.755, 1.0);
            const double angle = 0.1 * i * i;
            const double ra = sqrt(1.0 - za * za), rb = sqrt(1.0 - zb * zb);
            assay_basis_evaluate(basis, (assay_vec3){ra, 0.0, za}, u);
            assay_basis_evaluate(basis, (assay_vec3){rb * cos(angle), rb * sin(angle), zb}, v);
            const double ta = kind ? 2.0 * za - 1.0 : za, tb = kind ? 2.0 * zb - 1.0 : zb;
            const double cosine = ta * tb + sqrt((1.0 - ta * ta) * (1.0 - tb * tb)) * cos(angle);
            double       p = 1.0, before = 0.0;
            for (int l = 0; l < ASSAY_BASIS_MAX_ORDER; l++) {
                double sum = 0.0;
                for (int m = -l; m <= l; m++) {
                    sum += u[l * l + l + m] * v[l * l + l + m];
                }
                assert_near(sum, (2.0 * l + 1.0) / (kind ? 2.0 * pi : 4.0 * pi) * p,
                            1e-13 * (l + 1));
                const double next = ((2.0 * l + 1.0) * cosine * p - l * before) / (l + 1.0);
                before            = p;
                p                 = next;
            }
        }
        assay_basis_destroy(basis);
    }
}

/* ---- slopes ---- */

static double dot(assay_vec3 a, assay_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* Two unit tangents. */
static void tangents(assay_vec3 d, assay_vec3 t[2])
{
    const assay_vec3 other =
        fabs(d.x) < 0.6 ? (assay_vec3){1.0, 0.0, 0.0} : (assay_vec3){0.0, 1.0, 0.0};
    const double     along = dot(d, other);
    const assay_vec3 u     = {other.x - along * d.x, other.y - along * d.y, other.z - along * d.z};
    const double     s     = 1.0 / sqrt(dot(u, u));
    t[0]                   = (assay_vec3){s * u.x, s * u.y, s * u.z};
    t[1]                   = (assay_vec3){d.y * t[0].z - d.z * t[0].y, d.z * t[0].x - d.x * t[0].z,
                                          d.x * t[0].y - d.y * t[0].x};
}

/* Central differences of the 8th order along the great circle. */
static void differences(const assay_basis *basis, assay_vec3 d, assay_vec3 t, double h,
                        double *slopes)
{
    static const double weights[4] = {4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
    const size_t        count      = assay_basis_count(basis);
    double              values[MAX_COUNT];
    for (size_t i = 0; i < count; i++) {
        slopes[i] = 0.0;
    }
    for (int k = -4; k <= 4; k++) {
        if (k == 0) {
            continue;
        }
        const double     c = cos(k * h), s = sin(k * h);
        const assay_vec3 at = {c * d.x + s * t.x, c * d.y + s * t.y, c * d.z + s * t.z};
        assert_int_equal(assay_basis_evaluate(basis, at, values), ASSAY_OK);
        for (size_t i = 0; i < count; i++) {
            slopes[i] += (k < 0 ? -1.0 : 1.0) * weights[abs(k) - 1] / h * values[i];
        }
    }
}

static void check_slopes(const assay_basis *basis, assay_vec3 d, double h, double tolerance)
{
    double     values[MAX_COUNT], again[MAX_COUNT], slopes[MAX_COUNT];
    assay_vec3 gradients[MAX_COUNT], t[2];
    assert_int_equal(assay_basis_gradient(basis, d, values, gradients), ASSAY_OK);
    assert_int_equal(assay_basis_evaluate(basis, d, again), ASSAY_OK);
    assert_memory_equal(values, again, assay_basis_count(basis) * sizeof(double));
    tangents(d, t);
    for (int k = 0; k < 2; k++) {
        differences(basis, d, t[k], h, slopes);
        for (size_t i = 0; i < assay_basis_count(basis); i++) {
            assert_near(dot(gradients[i], t[k]), slopes[i], tolerance);
            assert_near(dot(gradients[i], d), 0.0, 1e-13);
        }
    }
}

static void test_gradients(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = create(*state, (assay_basis_kind)kind, 6);
        for (int i = 0; i < 60; i++) {
            const double z   = i == 0 ? 1.0 : i == 1 ? 1.0 - 1e-13 : fmod(i * 0.618, 1.0);
            const double r   = sqrt((1.0 - z) * (1.0 + z));
            assay_vec3   d   = {r * cos(1.7 * i), r * sin(1.7 * i), z};
            const bool   low = kind != ASSAY_BASIS_SH && z < 0.2;
            if (low) {
                continue; /* the differences would reach below the horizon */
            }
            if (kind == ASSAY_BASIS_SH && i % 2 != 0) {
                d.z = -d.z;
            }
            check_slopes(basis, d, 0.004, 3e-11);
        }
        assay_basis_destroy(basis);
    }
}

/* Bands in closed form, where differences do not reach: Y_1 has constant slopes in space; at the
 * poles to the last band; and a slope on the horizon, Zernike's and SH's. */
static void test_gradients_at_the_ends(void **state)
{
    double       values[MAX_COUNT];
    assay_vec3   g[MAX_COUNT];
    assay_basis *sh = create(*state, ASSAY_BASIS_SH, ASSAY_BASIS_MAX_ORDER);
    assert_int_equal(assay_basis_gradient(sh, (assay_vec3){0.0, 0.0, 1.0}, values, g), ASSAY_OK);
    for (int l = 1; l < ASSAY_BASIS_MAX_ORDER; l++) {
        /* P_l^1 = -sin theta dP_l/dx, and that is l (l + 1) / 2 at x = 1 */
        const double slope = -sqrt((2.0 * l + 1.0) * l * (l + 1.0) / (8.0 * pi));
        for (int m = -l; m <= l; m++) {
            const assay_vec3 at = g[l * l + l + m];
            assert_near(at.x, m == 1 ? slope : 0.0, 1e-12);
            assert_near(at.y, m == -1 ? slope : 0.0, 1e-12);
            assert_true(at.z == 0.0);
        }
    }
    assert_int_equal(assay_basis_gradient(sh, (assay_vec3){1.0, 0.0, 0.0}, values, g), ASSAY_OK);
    const double b = sqrt(3.0 / (4.0 * pi));
    assert_near(g[1].y, -b, 1e-15);
    assert_near(g[2].z, b, 1e-15);
    assert_near(g[3].x, 0.0, 1e-15);
    assay_basis_destroy(sh);
    assay_basis *zernike = create(*state, ASSAY_BASIS_ZERNIKE, 2);
    assert_int_equal(assay_basis_gradient(zernike, (assay_vec3){1.0, 0.0, 0.0}, values, g),
                     ASSAY_OK);
    /* sqrt(2 / pi) sqrt(1 - z) cos phi */
    assert_near(g[2].z, -0.5 * sqrt(2.0 / pi), 1e-15);
    assay_basis_destroy(zernike);
}

/* ---- turns, convolution ---- */

/* Coefficients of what a turn makes of a function are those whose sum at a turned direction is the
 * sum before at the direction. */
static void check_turns(const assay_basis *basis)
{
    static const double angles[] = {0.0, 0.3, -2.0, 3.14159, 100.0, 123456.789};
    double              before[2 * MAX_COUNT], after[2 * MAX_COUNT], u[MAX_COUNT], v[MAX_COUNT];
    const size_t        count = assay_basis_count(basis);
    for (size_t a = 0; a < sizeof angles / sizeof angles[0]; a++) {
        const double     c = cos(angles[a]), s = sin(angles[a]);
        const assay_vec3 d      = {0.48, -0.6, 0.64},
                         turned = {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
        assay_basis_evaluate(basis, d, u);
        assay_basis_evaluate(basis, turned, v);
        double sum[2] = {0.0, 0.0}, sum_turned[2] = {0.0, 0.0};
        for (size_t i = 0; i < 2 * count; i++) {
            before[i] = after[i] = sin(1.0 + (double)i * (double)i);
        }
        assert_int_equal(assay_basis_rotate_z(basis, angles[a], 2, after), ASSAY_OK);
        for (size_t i = 0; i < 2 * count; i++) {
            sum[i / count] += before[i] * u[i % count];
            sum_turned[i / count] += after[i] * v[i % count];
        }
        assert_near(sum_turned[0], sum[0], 2e-13);
        assert_near(sum_turned[1], sum[1], 2e-13);
    }
}

static void test_rotation_about_z(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = create(*state, (assay_basis_kind)kind, 12);
        check_turns(basis);
        assay_basis_destroy(basis);
    }
    for (int convention = 1; convention < ASSAY_CONVENTION_COUNT; convention++) {
        assay_basis *basis = NULL;
        assert_int_equal(
            assay_basis_create(*state, ASSAY_BASIS_SH, 3, (assay_convention)convention, &basis),
            ASSAY_OK);
        check_turns(basis);
        assay_basis_destroy(basis);
    }
}

/* 2 pi times the integral of z P_l(z) over [0, 1], by a rule that is exact. */
static void test_clamped_cosine(void **state)
{
    (void)state;
    double z[MAX_NODES], weight[MAX_NODES], a[ASSAY_BASIS_MAX_ORDER];
    gauss(24, 0.0, z, weight);
    assert_int_equal(assay_clamped_cosine(ASSAY_BASIS_MAX_ORDER, a), ASSAY_OK);
    double expected[ASSAY_BASIS_MAX_ORDER] = {0.0};
    for (int i = 0; i < 24; i++) {
        double p = 1.0, before = 0.0;
        for (int l = 0; l < ASSAY_BASIS_MAX_ORDER; l++) {
            expected[l] += 2.0 * pi * weight[i] * z[i] * p;
            const double next = ((2.0 * l + 1.0) * z[i] * p - l * before) / (l + 1.0);
            before            = p;
            p                 = next;
        }
    }
    for (int l = 0; l < ASSAY_BASIS_MAX_ORDER; l++) {
        assert_near(a[l], expected[l], 2e-14);
    }
    assert_true(a[0] == pi);
    assert_near(a[1], 2.0 * pi / 3.0, 4.5e-16);
    assert_true(a[2] == pi / 4.0);
    assert_true(a[3] == 0.0);
    assert_near(a[4], -pi / 24.0, 3e-17);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orthonormal),
        cmocka_unit_test(test_orthonormal_to_the_last),
        cmocka_unit_test(test_addition_theorem),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_gradients_at_the_ends),
        cmocka_unit_test(test_rotation_about_z),
        cmocka_unit_test(test_clamped_cosine),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
