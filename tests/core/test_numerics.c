/* test_numerics.c - the elementary functions against libm in long double, and their special values.
 *
 * x86's long double has 11 bits more than double, so an error of 1 unit of the last place shows as
 * about 2048 of its own; where long double is double the tolerance grows by libm's own half unit.
 */
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "core/random.h"

typedef double (*function)(double);
typedef long double (*exact_function)(long double);

static double ulp_error(double value, long double exact)
{
    int exponent;
    if (exact == 0.0L) {
        return value == 0.0 ? 0.0 : INFINITY;
    }
    (void)frexpl(exact, &exponent);
    const long double unit = ldexpl(1.0L, exponent - 53);
    return (double)(fabsl((long double)value - exact) / unit);
}

static double worst_error(function f, exact_function exact, double low, double high, uint64_t item)
{
    double       worst  = 0.0;
    assay_random random = assay_random_start(0, ASSAY_STAGE_TEST, item, 0);
    for (int i = 0; i < 20000; i++) {
        const double x     = low + (high - low) * assay_random_next(&random);
        const double error = ulp_error(f(x), exact((long double)x));
        worst              = error > worst ? error : worst;
    }
    return worst;
}

/* Over its period of three powers of two, and at the ends of its range. */
static void cube_root(void **state)
{
    (void)state;
    assert_true(worst_error(assay_cbrt, cbrtl, 0.125, 1.0, 90) <= 5.0);
    assert_true(worst_error(assay_cbrt, cbrtl, DBL_MIN, 1e-300, 91) <= 5.0);
    assert_true(worst_error(assay_cbrt, cbrtl, 1e300, DBL_MAX, 92) <= 5.0);
}

static long double exact_exp2(long double x) { return exp2l(x); }

static const double TOLERANCE = LDBL_MANT_DIG > 53 ? 1.0 : 1.6;

static void one_argument(void **state)
{
    (void)state;
    static const struct {
        const char    *name;
        function       f;
        exact_function exact;
        double         low, high;
    } CASES[] = {
        {"sin", assay_sin, sinl, -10.0, 10.0},
        {"cos", assay_cos, cosl, -10.0, 10.0},
        {"tan", assay_tan, tanl, -1.5, 1.5},
        {"asin", assay_asin, asinl, -1.0, 1.0},
        {"acos", assay_acos, acosl, -1.0, 1.0},
        {"atan", assay_atan, atanl, -20.0, 20.0},
        {"exp", assay_exp, expl, -700.0, 700.0},
        {"exp2", assay_exp2, exact_exp2, -1000.0, 1000.0},
        {"expm1", assay_expm1, expm1l, -2.0, 2.0},
        {"ln", assay_log, logl, 1e-300, 1e3},
        {"log1p", assay_log1p, log1pl, -0.99, 10.0},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        const double worst =
            worst_error(CASES[i].f, CASES[i].exact, CASES[i].low, CASES[i].high, i);
        if (!(worst <= TOLERANCE)) {
            fail_msg("%s: %.3f units of the last place", CASES[i].name, worst);
        }
    }
}

static double wrong_sin(double x) { return assay_sin(x) * (1.0 + 2.0 * DBL_EPSILON); }

/* The check must see an error of two units. */
static void mutant_is_caught(void **state)
{
    (void)state;
    assert_true(worst_error(wrong_sin, sinl, -10.0, 10.0, 0) > TOLERANCE);
}

static void two_arguments(void **state)
{
    (void)state;
    assay_random random = assay_random_start(0, ASSAY_STAGE_TEST, 99, 0);
    for (int i = 0; i < 20000; i++) {
        const double x = 10.0 * assay_random_next(&random) + 1e-9;
        const double y = 20.0 * assay_random_next(&random) - 10.0;
        assert_true(ulp_error(assay_pow(x, y), powl(x, y)) <= TOLERANCE);
        assert_true(ulp_error(assay_atan2(y, x - 5.0), atan2l(y, x - 5.0)) <= TOLERANCE);
    }
}

/* sin and cos of 2 pi x with the quarters taken off exactly, so that zeros keep their digits. */
static void exact_turns(double x, long double *sine_out, long double *cosine_out)
{
    const long double quarter = floorl(4.0L * x + 0.5L);
    const long double angle   = (4.0L * x - quarter) * 1.57079632679489661923132169163975144L;
    const int         q       = (int)((long long)quarter & 3);
    const long double s[4]    = {sinl(angle), cosl(angle), -sinl(angle), -cosl(angle)};
    *sine_out                 = s[q];
    *cosine_out               = s[(q + 1) & 3];
}

/* In turns, multiples of a quarter are exact, and everything is within the stated 2 units. */
static void turns(void **state)
{
    (void)state;
    static const double QUARTERS[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int i = -9; i < 10; i++) {
        const assay_sincos s = assay_sincos_turns(0.25 * i);
        assert_true(s.sin == QUARTERS[i & 3][0] && s.cos == QUARTERS[i & 3][1]);
    }
    assay_random random = assay_random_start(0, ASSAY_STAGE_TEST, 7, 0);
    double       worst  = 0.0;
    for (int i = 0; i < 200000; i++) {
        double      x = assay_random_next(&random);
        long double sine, cosine;
        x = i % 4 == 1 ? 40.0 * x - 20.0 : i % 4 == 2 ? 0.25 * (i % 9) + 1e-9 * x : x;
        exact_turns(x, &sine, &cosine);
        const assay_sincos s = assay_sincos_turns(x);
        worst                = fmax(worst, fmax(ulp_error(s.sin, sine), ulp_error(s.cos, cosine)));
    }
    print_message("#| sine and cosine of turns: at most %.2f units of the last place\n", worst);
    assert_true(worst <= 2.0);
    assert_true(isnan(assay_sincos_turns(NAN).sin) && isnan(assay_sincos_turns(INFINITY).cos));
    const assay_sincos below = assay_sincos_turns(0x1.fffffffffffffp-2);
    assert_true(below.cos == -1.0 && below.sin > 0.0 && below.sin < 1e-15);
    assert_true(assay_sincos_turns(4503599627370497.0).cos == 1.0);
    assert_true(assay_sincos_turns(1e18).cos == 1.0 && assay_sincos_turns(-1e18).sin == 0.0);
    const assay_sincos one = assay_sincos_radians(1.0);
    assert_true(one.sin == assay_sin(1.0) && one.cos == assay_cos(1.0));
}

static void special_values(void **state)
{
    (void)state;
    assert_true(assay_pow(0.0, 0.0) == 1.0);
    assert_true(assay_pow(0.5, INFINITY) == 0.0);
    assert_true(assay_pow(1.0, INFINITY) == 1.0);
    assert_true(assay_exp(-1e6) == 0.0);
    assert_true(isinf(assay_log(0.0)));
    assert_true(isnan(assay_acos(1.1)));
    assert_true(assay_acos(1.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_root),
        cmocka_unit_test(one_argument),
        cmocka_unit_test(mutant_is_caught),
        cmocka_unit_test(two_arguments),
        cmocka_unit_test(turns),
        cmocka_unit_test(special_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
