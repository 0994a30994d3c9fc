/* Values of every basis against the judge of basis_judge.h, against polynomials written out, and
 * against each other: conventions, parity, the batch. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/basis_judge.h"
#include "../support/near.h"
#include "assay/assay.h"

enum { MAX_COUNT = ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER };

static const double pi = 3.14159265358979323846;

static assay_basis *create(assay_context *context, assay_basis_kind kind, int order,
                           assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, kind, order, convention, &basis), ASSAY_OK);
    return basis;
}

static int start(void **state)
{
    return assay_context_create(NULL, (assay_context **)state) == ASSAY_OK ? 0 : -1;
}

static int stop(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

/* A direction of the i-th of eight sorts, by low-discrepancy numbers.  z and the sign of z are
 * spread over the sphere; `above` folds it to the hemisphere. */
static assay_vec3 direction(int i, bool above)
{
    const double u     = fmod(0.5 + i * 0.7548776662466927, 1.0);
    const double v     = fmod(0.5 + i * 0.5698402909980532, 1.0);
    double       z     = 2.0 * u - 1.0;
    double       scale = 1.0;
    switch (i % 8) {
    case 1: z = copysign(1.0 - pow(10.0, -16.0 * u), v - 0.5); break;
    case 2: z = copysign(pow(10.0, -16.0 * u), v - 0.5); break;
    case 3: z = copysign(0.25 + 0.5 * floor(2.0 * u), v - 0.5); break;
    case 4: scale = 1.0 + (v - 0.5) * 0x1p-21; break;
    case 5: z = copysign(1e-12 * u, v - 0.5); break;
    default: break;
    }
    z              = above ? fabs(z) : z;
    const double r = i % 16 == 1 ? 1e-12 * u : sqrt((1.0 - z) * (1.0 + z));
    z              = i % 16 == 1 ? copysign(1.0, z) : z;
    return (assay_vec3){scale * r * cos(2.0 * pi * v), scale * r * sin(2.0 * pi * v), scale * z};
}

static const assay_vec3 special[] = {{0.0, 0.0, 1.0},      {-0.0, 0.0, 1.0},   {0x1p-600, 0.0, 1.0},
                                     {1.0, 0.0, 0.0},      {0.0, -1.0, 0.0},   {0.6, 0.8, 0.0},
                                     {0.6, 0.8, -0.0},     {0.6, 0.8, 1e-310}, {-0.8, 0.6, 0x1p-40},
                                     {0.8, 0.0, 0.6},      {0.0, 0.0, -1.0},   {0.6, 0.0, -0.8},
                                     {1e-12, -1e-12, -1.0}};
enum { SPECIAL = sizeof special / sizeof special[0], SPECIAL_ABOVE = SPECIAL - 3 };

/* The largest error, and the largest value of all. */
static double worst_error(const assay_basis *basis, int directions, double *largest_out)
{
    double     values[MAX_COUNT];
    judged     truth[MAX_COUNT];
    const bool above = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    double     worst = 0.0, largest = 0.0;
    const int  extra = above ? SPECIAL_ABOVE : SPECIAL;
    for (int i = 0; i < extra + directions; i++) {
        const assay_vec3 d = i < extra ? special[i] : direction(i - extra, above);
        assert_int_equal(assay_basis_evaluate(basis, d, values), ASSAY_OK);
        basis_judge(basis, d, truth);
        for (size_t j = 0; j < assay_basis_count(basis); j++) {
            const double error = basis_judge_error(values[j], truth[j]);
            largest            = fmax(largest, fabs(truth[j].hi));
            if (!(error <= worst)) { /* NaN, too */
                worst = error;
            }
        }
    }
    *largest_out = largest;
    return worst;
}

/* Limits in units of the last place of the largest value, [0]: l <= 16, [1]: l <= 32. */
static void test_precision(void **state)
{
    static const int    orders[2] = {17, 33};
    static const int    counts[2] = {480, 64};
    static const double limits[2] = {2.5, 3.5};
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        for (int i = 0; i < 2; i++) {
            double       largest = 0.0;
            assay_basis *basis =
                create(*state, (assay_basis_kind)kind, orders[i], ASSAY_CONVENTION_THESIS);
            const double worst = worst_error(basis, counts[i], &largest);
            const double unit  = ldexp(1.0, ilogb(largest) - 52);
            print_message("%-14s l <= %2d  largest %7.3f  worst error %.3g, %.2f units\n",
                          assay_basis_kind_name((assay_basis_kind)kind), orders[i] - 1, largest,
                          worst, worst / unit);
            assert_true(worst <= limits[i] * unit);
            assay_basis_destroy(basis);
        }
    }
}

/* Bands 0 to 2, [gautron06] eq. 3.7 by hand, in the plain convention. */
static void test_low_bands(void **state)
{
    const double     a = sqrt(1.0 / (4.0 * pi)), b = sqrt(3.0 / (4.0 * pi));
    const double     c = sqrt(15.0 / (4.0 * pi)), e = sqrt(5.0 / (16.0 * pi));
    const assay_vec3 d           = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
    const double     expected[9] = {
            a,
            b * d.y,
            b * d.z,
            b * d.x,
            c * d.x * d.y,
            c * d.y * d.z,
            e * (3.0 * d.z * d.z - 1.0),
            c * d.x * d.z,
            c / 2.0 * (d.x * d.x - d.y * d.y),
    };
    static const int kontkanen[9] = {0, 3, 1, 2, 7, 5, 4, 6, 8};
    double           plain[9], thesis[9], table[9];
    assay_basis     *p = create(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_PLAIN);
    assay_basis     *t = create(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_THESIS);
    assay_basis     *k = create(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_KONTKANEN);
    assert_int_equal(assay_basis_evaluate(p, d, plain), ASSAY_OK);
    assert_int_equal(assay_basis_evaluate(t, d, thesis), ASSAY_OK);
    assert_int_equal(assay_basis_evaluate(k, d, table), ASSAY_OK);
    for (int i = 0; i < 9; i++) {
        int l = 0, m = 0;
        assay_basis_function(t, (size_t)i, &l, &m);
        assert_int_equal(l * l + l + m, i);
        assert_near(plain[i], expected[i], 4e-16);
        assert_true(thesis[i] == (m % 2 != 0 ? -plain[i] : plain[i]));
        assert_true(table[i] == plain[kontkanen[i]]);
        int lk = 0, mk = 0;
        assay_basis_function(k, (size_t)i, &lk, &mk);
        assert_int_equal(lk * lk + lk + mk, kontkanen[i]);
    }
    assay_basis_destroy(p);
    assay_basis_destroy(t);
    assay_basis_destroy(k);
}

/* The first functions of the hemisphere by hand; u, v have the length of b. */
static void test_low_bands_of_hemisphere(void **state)
{
    const assay_vec3 d = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
    const double     z = d.z, rho = sqrt(1.0 - z), r = hypot(d.x, d.y);
    const double     c = d.x / r, s = d.y / r;
    const double     h = sqrt(3.0 / (2.0 * pi)) * sqrt(4.0 * z * (1.0 - z));
    const double     k = sqrt(12.0 / pi) * sqrt(z * (1.0 - z));
    const struct {
        assay_basis_kind kind;
        double           values[4];
    } cases[] = {
        {ASSAY_BASIS_HSH, {sqrt(0.5 / pi), -h * s, sqrt(1.5 / pi) * (2.0 * z - 1.0), -h * c}},
        {ASSAY_BASIS_ZERNIKE, {sqrt(0.5 / pi), sqrt(2.0 / pi) * rho * s, sqrt(2.0 / pi) * rho * c}},
        {ASSAY_BASIS_MAKHOTKIN, {sqrt(1.0 / pi), k * s, sqrt(2.0 / pi) * (3.0 * z - 2.0), k * c}},
        {ASSAY_BASIS_ESH, {sqrt(0.5 / pi), -sqrt(1.5 / pi) * d.y, -sqrt(1.5 / pi) * d.x}},
        {ASSAY_BASIS_LSOSH,
         {sqrt(0.25 / pi), -sqrt(0.75 / pi) * d.y, sqrt(0.75 / pi) * z, -sqrt(0.75 / pi) * d.x}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double       values[4];
        assay_basis *basis = create(*state, cases[i].kind, 2, ASSAY_CONVENTION_THESIS);
        assert_int_equal(assay_basis_evaluate(basis, d, values), ASSAY_OK);
        for (size_t j = 0; j < assay_basis_count(basis); j++) {
            assert_near(values[j], cases[i].values[j], 1e-15);
        }
        assay_basis_destroy(basis);
    }
}

/* Functions that are others times a number: the same to a few roundings, so neither's signs or
 * order can move alone. */
static void test_kinships(void **state)
{
    double       sh[MAX_COUNT], lsosh[MAX_COUNT], esh[MAX_COUNT], a[MAX_COUNT], b[MAX_COUNT];
    assay_basis *s = create(*state, ASSAY_BASIS_SH, 9, ASSAY_CONVENTION_THESIS);
    assay_basis *l = create(*state, ASSAY_BASIS_LSOSH, 9, ASSAY_CONVENTION_THESIS);
    assay_basis *e = create(*state, ASSAY_BASIS_ESH, 9, ASSAY_CONVENTION_THESIS);
    assay_basis *m = create(*state, ASSAY_BASIS_MAKHOTKIN, 9, ASSAY_CONVENTION_THESIS);
    assay_basis *q = create(*state, ASSAY_BASIS_MAKHOTKIN_SQRT, 9, ASSAY_CONVENTION_THESIS);
    for (int i = 0; i < 64; i++) {
        const assay_vec3 d = direction(8 * i, true);
        assay_basis_evaluate(s, d, sh);
        assay_basis_evaluate(l, d, lsosh);
        assay_basis_evaluate(e, d, esh);
        assay_basis_evaluate(m, d, a);
        assay_basis_evaluate(q, d, b);
        assert_memory_equal(sh, lsosh, 81 * sizeof(double));
        for (size_t j = 0; j < assay_basis_count(e); j++) {
            int band = 0, number = 0;
            assay_basis_function(e, j, &band, &number);
            assert_int_equal((band + number) % 2, 0);
            assert_near(esh[j], sqrt(2.0) * sh[band * band + band + number], 1e-15);
        }
        for (int j = 0; j < 81; j++) {
            assert_near(b[j], a[j] * sqrt(d.z), 4e-15);
        }
    }
    assay_basis_destroy(s);
    assay_basis_destroy(l);
    assay_basis_destroy(e);
    assay_basis_destroy(m);
    assay_basis_destroy(q);
}

/* Y(-d) = (-1)^l Y(d), and mirrored at the horizon (-1)^(l+m): to the bit.  What is odd in z is 0
 * on the horizon, what has m != 0 is 0 at the pole, HSH with m != 0 also on the horizon. */
static void test_parity(void **state)
{
    double       at[MAX_COUNT], opposite[MAX_COUNT], mirrored[MAX_COUNT];
    assay_basis *sh  = create(*state, ASSAY_BASIS_SH, 33, ASSAY_CONVENTION_THESIS);
    assay_basis *hsh = create(*state, ASSAY_BASIS_HSH, 33, ASSAY_CONVENTION_THESIS);
    for (int i = 0; i < 64; i++) {
        const assay_vec3 d = direction(i, false);
        assay_basis_evaluate(sh, d, at);
        assay_basis_evaluate(sh, (assay_vec3){-d.x, -d.y, -d.z}, opposite);
        assay_basis_evaluate(sh, (assay_vec3){d.x, d.y, -d.z}, mirrored);
        for (size_t j = 0; j < assay_basis_count(sh); j++) {
            int l = 0, m = 0;
            assay_basis_function(sh, j, &l, &m);
            assert_true(opposite[j] == (l % 2 != 0 ? -at[j] : at[j]));
            assert_true(mirrored[j] == ((l + m) % 2 != 0 ? -at[j] : at[j]));
        }
    }
    for (size_t j = 0; j < assay_basis_count(sh); j++) {
        int l = 0, m = 0;
        assay_basis_function(sh, j, &l, &m);
        assay_basis_evaluate(sh, (assay_vec3){0.6, -0.8, 0.0}, at);
        assert_true((l + m) % 2 == 0 || at[j] == 0.0);
        assay_basis_evaluate(hsh, (assay_vec3){0.6, -0.8, 0.0}, at);
        assert_true(m == 0 || at[j] == 0.0);
        assert_true(m != 0 || at[j] != 0.0);
        assay_basis_evaluate(sh, (assay_vec3){0.0, 0.0, 1.0}, at);
        assert_true(m == 0 || at[j] == 0.0);
        assay_basis_evaluate(hsh, (assay_vec3){0.0, 0.0, 1.0}, at);
        assert_true(m == 0 || at[j] == 0.0);
    }
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

/* Many directions, of every number up to 9, have the bits of each alone. */
static void test_batch(void **state)
{
    static double    many[9 * MAX_COUNT + 1];
    static const int orders[4] = {1, 3, 16, 33};
    double           one[MAX_COUNT];
    assay_vec3       d[9];
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        for (int o = 0; o < 4; o++) {
            assay_basis *basis =
                create(*state, (assay_basis_kind)kind, orders[o], ASSAY_CONVENTION_THESIS);
            const size_t count = assay_basis_count(basis);
            for (size_t n = 0; n <= 9; n++) {
                for (size_t i = 0; i < n; i++) {
                    d[i] = direction((int)(10 * n + i), kind != ASSAY_BASIS_SH);
                }
                many[n * count] = -7.0;
                assert_int_equal(assay_basis_evaluate_many(basis, n, d, many), ASSAY_OK);
                assert_true(many[n * count] == -7.0);
                for (size_t i = 0; i < n; i++) {
                    assert_int_equal(assay_basis_evaluate(basis, d[i], one), ASSAY_OK);
                    assert_memory_equal(one, many + i * count, count * sizeof(double));
                }
            }
            assay_basis_destroy(basis);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_precision),
        cmocka_unit_test(test_low_bands),
        cmocka_unit_test(test_low_bands_of_hemisphere),
        cmocka_unit_test(test_kinships),
        cmocka_unit_test(test_parity),
        cmocka_unit_test(test_batch),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
