/* test_sh_rotation.c - D against the recurrence of Ivanic and Ruedenberg in long double, and what a
 * rotation must do to functions. */
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
#include "support/near.h"

enum { ORDER = ASSAY_BASIS_MAX_ORDER, COUNT = ORDER * ORDER };

typedef struct {
    assay_context *context;
    assay_basis   *sh; /* PLAIN, largest order */
    double        *a, *b, *c;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    assert_int_equal(assay_context_create(NULL, &f->context), ASSAY_OK);
    assert_int_equal(
        assay_basis_create(f->context, ASSAY_BASIS_SH, ORDER, ASSAY_CONVENTION_PLAIN, &f->sh),
        ASSAY_OK);
    f->a   = malloc(sizeof(double) * COUNT * COUNT);
    f->b   = malloc(sizeof(double) * COUNT * COUNT);
    f->c   = malloc(sizeof(double) * COUNT * COUNT);
    *state = f;
    return f->a && f->b && f->c ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    free(f->a);
    free(f->b);
    free(f->c);
    assay_basis_destroy(f->sh);
    assay_context_destroy(f->context);
    free(f);
    return 0;
}

static assay_basis *make(const fixture *f, assay_basis_kind kind, int order,
                         assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(f->context, kind, order, convention, &basis), ASSAY_OK);
    return basis;
}

/* ---- the second method: [ivanic96] with the corrections of [ivanic98] ---- */

typedef struct {
    long double  r[3][3]; /* by m + 1: y, z, x */
    long double *band[ORDER];
} recurrence;

static long double entry(const recurrence *t, int l, int m, int k)
{
    return t->band[l][(m + l) * (2 * l + 1) + k + l];
}

static long double p_term(const recurrence *t, int l, int i, int a, int b)
{
    const long double *r = t->r[i + 1];
    if (b == -l) {
        return r[2] * entry(t, l - 1, a, -l + 1) + r[0] * entry(t, l - 1, a, l - 1);
    }
    if (b == l) {
        return r[2] * entry(t, l - 1, a, l - 1) - r[0] * entry(t, l - 1, a, -l + 1);
    }
    return r[1] * entry(t, l - 1, a, b);
}

static long double v_term(const recurrence *t, int l, int m, int k)
{
    if (m == 0) {
        return p_term(t, l, 1, 1, k) + p_term(t, l, -1, -1, k);
    }
    if (m > 0) {
        return p_term(t, l, 1, m - 1, k) * sqrtl(m == 1 ? 2.0L : 1.0L) -
               (m == 1 ? 0.0L : p_term(t, l, -1, -m + 1, k));
    }
    return (m == -1 ? 0.0L : p_term(t, l, 1, m + 1, k)) +
           p_term(t, l, -1, -m - 1, k) * sqrtl(m == -1 ? 2.0L : 1.0L);
}

static long double w_term(const recurrence *t, int l, int m, int k)
{
    return m > 0 ? p_term(t, l, 1, m + 1, k) + p_term(t, l, -1, -m - 1, k)
                 : p_term(t, l, 1, m - 1, k) - p_term(t, l, -1, -m + 1, k);
}

static long double recur(const recurrence *t, int l, int m, int k)
{
    const int         n = abs(m), d = m == 0;
    const long double down =
        abs(k) < l ? (long double)(l + k) * (l - k) : (long double)(2 * l) * (2 * l - 1);
    const long double u = sqrtl((long double)(l + m) * (l - m) / down);
    const long double v =
        0.5L * sqrtl((1 + d) * (long double)(l + n - 1) * (l + n) / down) * (1 - 2 * d);
    const long double w   = -0.5L * sqrtl((long double)(l - n - 1) * (l - n) / down) * (1 - d);
    long double       sum = 0.0L;
    if (u != 0.0L) {
        sum += u * p_term(t, l, 0, m, k);
    }
    if (v != 0.0L) {
        sum += v * v_term(t, l, m, k);
    }
    if (w != 0.0L) {
        sum += w * w_term(t, l, m, k);
    }
    return sum;
}

static void orthogonalize(long double r[3][3])
{
    for (int step = 0; step < 4; step++) {
        long double y[3][3];
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                y[i][j] = 1.5L * r[i][j];
                for (int k = 0; k < 9; k++) {
                    y[i][j] -= 0.5L * r[i][k % 3] * r[k / 3][k % 3] * r[k / 3][j];
                }
            }
        }
        memcpy(r, y, sizeof y);
    }
}

static recurrence *recurrence_of(const double rotation[9])
{
    static const int axis[3] = {1, 2, 0};
    recurrence      *t       = calloc(1, sizeof *t);
    assert_non_null(t);
    long double r[3][3];
    for (int i = 0; i < 9; i++) {
        r[i / 3][i % 3] = (long double)rotation[i];
    }
    orthogonalize(r);
    for (int i = 0; i < 9; i++) {
        t->r[i / 3][i % 3] = r[axis[i / 3]][axis[i % 3]];
    }
    for (int l = 0; l < ORDER; l++) {
        const int n = 2 * l + 1;
        t->band[l]  = calloc((size_t)(n * n), sizeof(long double));
        assert_non_null(t->band[l]);
        for (int i = 0; i < n * n; i++) {
            t->band[l][i] = l == 0   ? 1.0L
                            : l == 1 ? t->r[i / 3][i % 3]
                                     : recur(t, l, i / n - l, i % n - l);
        }
    }
    return t;
}

static void recurrence_destroy(recurrence *t)
{
    for (int l = 0; l < ORDER; l++) {
        free(t->band[l]);
    }
    free(t);
}

static double distance(const double *matrix, const recurrence *t)
{
    double worst = 0.0;
    for (int l = 0; l < ORDER; l++) {
        for (int m = -l; m <= l; m++) {
            for (int k = -l; k <= l; k++) {
                const int         i = l * l + l + m, j = l * l + l + k;
                const long double d = (long double)matrix[i * COUNT + j] - entry(t, l, m, k);
                worst               = fmax(worst, (double)fabsl(d));
            }
        }
    }
    return worst;
}

static const double ANGLES[][3] = {
    {0.3, 0.7, -1.1},   {2.0, 0.0, 1.0},     {-3.0, 3.14159265358979311600, 0.5},
    {1.0, 1e-3, 2.0},   {1.0, 1e-8, 2.0},    {1.0, 1e-12, 2.0},
    {-1.0, 3.14159, 2}, {0.2, 3.1415926, 0}, {0.0, 1.57079632679489661923, 0.0},
    {0.0, -0.9, 0.0},   {0.7, 2.5, 2.9},     {3.1, 1.2, -2.0},
    {1.0, 1e-200, 2.0},
};
enum { ANGLE_COUNT = sizeof ANGLES / sizeof *ANGLES };

static void test_against_the_recurrence(void **state)
{
    fixture *f     = *state;
    double   worst = 0.0;
    for (int i = 0; i < ANGLE_COUNT; i++) {
        double r[9];
        assay_rotation_from_euler_zyz(ANGLES[i][0], ANGLES[i][1], ANGLES[i][2], r);
        assert_int_equal(assay_sh_rotation(f->sh, r, f->a), ASSAY_OK);
        recurrence  *t    = recurrence_of(r);
        const double here = distance(f->a, t);
        worst             = fmax(worst, here);
        recurrence_destroy(t);
    }
    printf("# D to l = %d, worst entry off by %.2g\n", ORDER - 1, worst);
    assert_true(worst <= 1e-15);
}

/* Halves of degrees, a third of the turns by hand: matrices that are orthogonal to single precision
 * alone count as the rotation nearest to them. */
static void test_rough_matrices(void **state)
{
    fixture *f = *state;
    double   r[9];
    assay_rotation_from_euler_zyz(0.4, 1.3, -0.8, r);
    for (int i = 0; i < 9; i++) {
        r[i] = (double)(float)r[i];
    }
    assert_int_equal(assay_sh_rotation(f->sh, r, f->a), ASSAY_OK);
    recurrence *t = recurrence_of(r);
    assert_true(distance(f->a, t) <= 1e-15);
    recurrence_destroy(t);
}

/* ---- what D must be ---- */

static double product_distance(const double *a, const double *b, bool transposed, const double *c)
{
    double worst = 0.0;
    for (int l = 0; l < ORDER; l++) {
        for (int i = l * l; i < (l + 1) * (l + 1); i++) {
            for (int j = l * l; j < (l + 1) * (l + 1); j++) {
                double sum = 0.0;
                for (int k = l * l; k < (l + 1) * (l + 1); k++) {
                    sum += a[i * COUNT + k] * (transposed ? b[j * COUNT + k] : b[k * COUNT + j]);
                }
                worst = fmax(worst, fabs(sum - (c ? c[i * COUNT + j] : (i == j))));
            }
        }
    }
    return worst;
}

static void test_group(void **state)
{
    fixture *f = *state;
    double   r[9], s[9], rs[9], orthogonal = 0.0, composed = 0.0;
    for (int n = 0; n + 1 < ANGLE_COUNT; n++) {
        assay_rotation_from_euler_zyz(ANGLES[n][0], ANGLES[n][1], ANGLES[n][2], r);
        assay_rotation_from_euler_zyz(ANGLES[n + 1][0], ANGLES[n + 1][1], ANGLES[n + 1][2], s);
        for (int i = 0; i < 9; i++) {
            const int row = 3 * (i / 3), column = i % 3;
            rs[i] = r[row] * s[column] + r[row + 1] * s[3 + column] + r[row + 2] * s[6 + column];
        }
        assert_int_equal(assay_sh_rotation(f->sh, r, f->a), ASSAY_OK);
        assert_int_equal(assay_sh_rotation(f->sh, s, f->b), ASSAY_OK);
        assert_int_equal(assay_sh_rotation(f->sh, rs, f->c), ASSAY_OK);
        orthogonal = fmax(orthogonal, product_distance(f->a, f->a, true, NULL));
        composed   = fmax(composed, product_distance(f->a, f->b, false, f->c));
    }
    printf("# D D' off by %.2g, D(R S) - D(R) D(S) by %.2g\n", orthogonal, composed);
    assert_true(orthogonal <= 5e-15);
    assert_true(composed <= 2e-14); /* R S is rounded: 32 units of 2^-53, and the sums */
}

static void test_about_z(void **state)
{
    fixture *f = *state;
    double   r[9], in[COUNT], turned[COUNT];
    for (int i = 0; i < COUNT; i++) {
        in[i] = turned[i] = 1.0 / (1.0 + i % 17);
    }
    const double angle = 0.83;
    assay_rotation_from_euler_zyz(angle, 0.0, 0.0, r);
    assert_int_equal(assay_sh_rotation(f->sh, r, f->a), ASSAY_OK);
    assert_int_equal(assay_basis_rotate_z(f->sh, angle, 1, turned), ASSAY_OK);
    double out[COUNT];
    assert_int_equal(assay_sh_rotate(f->sh, f->a, 1, in, out), ASSAY_OK);
    for (int i = 0; i < COUNT; i++) {
        assert_near(out[i], turned[i], 2e-14);
        const int l = (int)sqrt(i + 0.5), m = i - l * l - l;
        assert_near(f->a[i * COUNT + i], cos(m * angle), 2e-14);
        if (m > 0) { /* the image of the cosine has + sin in the sine */
            assert_near(f->a[(i - 2 * m) * COUNT + i], sin(m * angle), 2e-14);
        }
    }
}

static double value(const assay_basis *basis, const double *coefficients, assay_vec3 d)
{
    double values[COUNT], sum = 0.0;
    assert_int_equal(assay_basis_evaluate(basis, d, values), ASSAY_OK);
    for (size_t i = 0; i < assay_basis_count(basis); i++) {
        sum += values[i] * coefficients[i];
    }
    return sum;
}

/* f(R^-1 w) at random directions, in every convention: dense product and blocks. */
static void check_functions(fixture *f, const assay_basis *basis, double tolerance)
{
    assay_random random = assay_random_start(11, ASSAY_STAGE_TEST, 0, 0);
    const size_t count  = assay_basis_count(basis);
    double       in[2 * COUNT], out[2 * COUNT], r[9];
    for (size_t i = 0; i < 2 * count; i++) {
        in[i] = assay_random_next(&random) - 0.5;
    }
    assay_rotation_from_euler_zyz(0.9, 2.1, -2.7, r);
    assert_int_equal(assay_sh_rotation(basis, r, f->a), ASSAY_OK);
    assert_int_equal(assay_sh_rotate(basis, f->a, 2, in, out), ASSAY_OK);
    for (size_t i = 0; i < count; i++) {
        double sum = 0.0;
        for (size_t j = 0; j < count; j++) {
            sum += f->a[i * count + j] * in[count + j];
        }
        assert_near(out[count + i], sum, 1e-14);
    }
    for (int n = 0; n < 50; n++) {
        const double     z = 2.0 * assay_random_next(&random) - 1.0, s = sqrt(1.0 - z * z);
        const double     phi = ASSAY_TWO_PI * assay_random_next(&random);
        const assay_vec3 w   = {s * cos(phi), s * sin(phi), z};
        const assay_vec3 u   = {r[0] * w.x + r[3] * w.y + r[6] * w.z,
                                r[1] * w.x + r[4] * w.y + r[7] * w.z,
                                r[2] * w.x + r[5] * w.y + r[8] * w.z};
        assert_near(value(basis, out, w), value(basis, in, u), tolerance);
    }
}

static void test_functions(void **state)
{
    fixture *f = *state;
    for (int order = 1; order <= ORDER; order += 8) {
        for (int convention = 0; convention < ASSAY_CONVENTION_KONTKANEN; convention++) {
            assay_basis *b = make(f, ASSAY_BASIS_SH, order, (assay_convention)convention);
            check_functions(f, b, 1e-12);
            assay_basis_destroy(b);
        }
    }
    assay_basis *b = make(f, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_KONTKANEN);
    check_functions(f, b, 1e-13);
    assay_basis_destroy(b);
}

/* In the order x, y, z the band l = 1 is the rotation itself. */
static void test_band_one(void **state)
{
    fixture     *f = *state;
    assay_basis *b = make(f, ASSAY_BASIS_SH, 2, ASSAY_CONVENTION_KONTKANEN);
    double       r[9], d[16];
    assay_rotation_from_euler_zyz(0.5, 0.25, 0.125, r);
    assert_near(r[2], cos(0.5) * sin(0.25), 1e-16); /* the pole goes towards +x, then by alpha */
    assert_near(r[5], sin(0.5) * sin(0.25), 1e-16);
    assert_near(r[8], cos(0.25), 1e-16);
    assert_int_equal(assay_sh_rotation(b, r, d), ASSAY_OK);
    for (int i = 0; i < 9; i++) {
        assert_near(d[4 * (1 + i / 3) + 1 + i % 3], r[i], 3e-16);
    }
    assay_basis_destroy(b);
}

static void test_refusals(void **state)
{
    fixture     *f     = *state;
    assay_basis *hsh   = make(f, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS);
    assay_basis *lsosh = make(f, ASSAY_BASIS_LSOSH, 2, ASSAY_CONVENTION_THESIS);
    assay_basis *sh    = make(f, ASSAY_BASIS_SH, 2, ASSAY_CONVENTION_THESIS);
    double       r[9], d[16], e[16];
    assay_rotation_from_euler_zyz(0.5, 0.25, 0.125, r);
    d[0] = 7.0;
    assert_int_equal(assay_sh_rotation(hsh, r, d), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_sh_rotate(hsh, d, 1, e, e), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_sh_rotate(sh, d, 0, e, e), ASSAY_ERR_ARGUMENT);
    double wrong[9];
    for (int i = 0; i < 9; i++) {
        wrong[i] = -r[i]; /* improper */
    }
    assert_int_equal(assay_sh_rotation(sh, wrong, d), ASSAY_ERR_DOMAIN);
    memcpy(wrong, r, sizeof r);
    wrong[4] += 0x1p-18;
    assert_int_equal(assay_sh_rotation(sh, wrong, d), ASSAY_ERR_DOMAIN);
    wrong[4] = NAN;
    assert_int_equal(assay_sh_rotation(sh, wrong, d), ASSAY_ERR_DOMAIN);
    wrong[4] = INFINITY;
    assert_int_equal(assay_sh_rotation(sh, wrong, d), ASSAY_ERR_DOMAIN);
    memset(wrong, 0, sizeof wrong);
    assert_int_equal(assay_sh_rotation(sh, wrong, d), ASSAY_ERR_DOMAIN);
    assert_true(d[0] == 7.0);
    assert_int_equal(assay_sh_rotation(lsosh, r, d), ASSAY_OK);
    assert_int_equal(assay_sh_rotation(sh, r, e), ASSAY_OK);
    assert_memory_equal(d, e, sizeof d);
    assay_basis_destroy(hsh);
    assay_basis_destroy(lsosh);
    assay_basis_destroy(sh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_the_recurrence),
        cmocka_unit_test(test_rough_matrices),
        cmocka_unit_test(test_group),
        cmocka_unit_test(test_about_z),
        cmocka_unit_test(test_functions),
        cmocka_unit_test(test_band_one),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
