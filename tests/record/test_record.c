/* test_record.c - weights and extrapolation of one record, against closed forms and long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "core/numerics.h"
#include "record/record.h"
#include "support/near.h"
#include "support/random_places.h"

static const assay_vec3 ORIGIN = {0.0, 0.0, 0.0}, UP = {0.0, 0.0, 1.0};

static assay_record record_at(assay_vec3 position, assay_vec3 normal, double radius)
{
    return (assay_record){.position = position, .normal = normal, .radius = radius};
}

/* A unit vector at about the angle to n, rad. */
static assay_vec3 tilted(assay_random *random, assay_vec3 n, double angle)
{
    return vec3_normalize(vec3_add(n, random_box(random, -angle, angle)));
}

static void ward_values(void **state)
{
    (void)state;
    const assay_record_rules rules  = {.a = 10.0};
    const assay_record       record = record_at(vec3(1.0, 2.0, 3.0), UP, 2.0);
    const assay_vec3         p      = record.position;
    assert_true(assay_record_weight(&record, &rules, p, UP) == ASSAY_WEIGHT_MAX);
    assert_true(assay_record_weight(&record, &rules, vec3(1.5, 2.0, 3.0), UP) == 4.0);
    assert_true(assay_record_weight(&record, &rules, vec3(1.0, 2.0, 1.0), UP) == 1.0);
    /* 1 - n . n_k = 1 / 16 */
    const assay_vec3 n = vec3(sqrt(1.0 - 0.9375 * 0.9375), 0.0, 0.9375);
    assert_true(assay_record_weight(&record, &rules, p, n) == 4.0);
    assert_true(assay_record_weight(&record, &rules, vec3(1.0, 2.5, 3.0), n) == 2.0);
    assert_near(assay_record_weight(&record, &rules, p, vec3_negate(UP)), sqrt(0.5), 1e-15);
    assert_true(assay_record_weight(&record, &rules, p, vec3(1.0, 0.0, 0.0)) == 1.0);
}

/* Unit vectors whose product is rounded to above 1. */
static void ward_survives_rounded_normals(void **state)
{
    (void)state;
    const assay_record_rules rules = {.a = 0.1};
    const assay_vec3         n     = vec3(0.0, 0.0, 1.0 + 0x1p-52);
    const assay_record       r     = record_at(ORIGIN, n, 1.0);
    assert_true(vec3_dot(n, n) > 1.0);
    assert_true(assay_record_weight(&r, &rules, ORIGIN, n) == ASSAY_WEIGHT_MAX);
    assert_near(assay_record_weight(&r, &rules, vec3(0.0625, 0.0, 0.0), n), 16.0, 0.0);
}

static void threshold_is_where_it_is_printed(void **state)
{
    (void)state;
    const double             quarter = 0.25;
    const assay_record_rules rules   = {.a = quarter};
    const assay_record       record  = record_at(ORIGIN, UP, 1.0);
    assert_true(assay_record_weight(&record, &rules, vec3(quarter, 0.0, 0.0), UP) == 4.0);
    assert_true(assay_record_weight(&record, &rules, vec3(nextafter(quarter, 1.0), 0.0, 0.0), UP) ==
                0.0);
    const assay_record_rules less = {.a = nextafter(quarter, 0.0)};
    assert_true(assay_record_weight(&record, &less, vec3(quarter, 0.0, 0.0), UP) == 0.0);
    const assay_vec3 n = vec3(sqrt(1.0 - 0.9375 * 0.9375), 0.0, 0.9375);
    assert_true(assay_record_weight(&record, &rules, ORIGIN, n) == 4.0);
    assert_true(assay_record_weight(&record, &less, ORIGIN, n) == 0.0);
    assert_true(assay_record_weight(&record, &rules, vec3(0x1p-40, 0.0, 0.0), n) == 0.0);
}

/* sqrt((1 - cos 5 deg) / (1 - cos 10 deg)) = 1 / (2 cos 2.5 deg) */
static void tabellion_values(void **state)
{
    (void)state;
    const assay_record_rules rules  = {.a = 2.0, .weight = ASSAY_WEIGHT_TABELLION};
    const assay_record_rules one    = {.a = 1.0, .weight = ASSAY_WEIGHT_TABELLION};
    const assay_record       record = record_at(ORIGIN, UP, 0.5);
    const assay_sincos five = assay_sincos_turns(5.0 / 360.0), ten = assay_sincos_turns(1.0 / 36);
    const assay_vec3   n5 = vec3(five.sin, 0.0, five.cos), n10 = vec3(0.0, ten.sin, ten.cos);
    assert_true(assay_record_weight(&record, &rules, ORIGIN, UP) == 1.0);
    assert_true(assay_record_weight(&record, &rules, vec3(0.0, 0.25, 0.0), UP) == 0.75);
    assert_true(assay_record_weight(&record, &rules, vec3(0.0, 1.0, 0.0), UP) == 0.0);
    assert_true(assay_record_weight(&record, &one, vec3(0.0, 0.5, 0.0), UP) == 0.0);
    assert_true(assay_record_weight(&record, &one, vec3(0.0, nextafter(0.5, 0.0), 0.0), UP) > 0.0);
    assert_near(assay_record_weight(&record, &rules, ORIGIN, n10), 0.5, 1e-14);
    assert_near(assay_record_weight(&record, &rules, vec3(0.0, 0.25, 0.0), n10), 0.5, 1e-14);
    assert_near(assay_record_weight(&record, &rules, vec3(0.0, 0.75, 0.0), n10), 0.25, 1e-14);
    const double cos25 = assay_sincos_turns(2.5 / 360.0).cos;
    assert_near(assay_record_weight(&record, &one, ORIGIN, n5), 1.0 - 0.5 / cos25, 1e-13);
}

/* What the two formulas say, in long double, without tests ahead and without clamps. */
static long double literal_weight(const assay_record *r, const assay_record_rules *rules,
                                  assay_vec3 p, assay_vec3 n)
{
    const long double x = (long double)p.x - r->position.x, y = (long double)p.y - r->position.y;
    const long double z      = (long double)p.z - r->position.z;
    const long double moved  = sqrtl(x * x + y * y + z * z) / r->radius;
    const long double cosine = (long double)n.x * r->normal.x + (long double)n.y * r->normal.y +
                               (long double)n.z * r->normal.z;
    const long double turned = sqrtl(fmaxl(0.0L, 1.0L - cosine));
    if (rules->weight == ASSAY_WEIGHT_TABELLION) {
        const long double ten = cosl(acosl(-1.0L) / 18.0L);
        return 1.0L - fmaxl(moved, turned / sqrtl(1.0L - ten)) / rules->a;
    }
    return 1.0L / (moved + turned);
}

/* Random cases; n . n_k is rounded by some 1e-16, so turned is uncertain by 1e-16 / turned. */
static void weights_are_what_is_printed(void **state)
{
    (void)state;
    assay_random random = assay_random_start(7, ASSAY_STAGE_TEST, 0, 0);
    int          within = 0, beyond = 0;
    for (int i = 0; i < 200000; i++) {
        const assay_record_rules rules = {.a = random_in(&random, 0.05, 1.5),
                                          .weight =
                                              i % 2 ? ASSAY_WEIGHT_WARD : ASSAY_WEIGHT_TABELLION};
        const assay_record record = record_at(random_box(&random, -1.0, 1.0), random_unit(&random),
                                              random_in(&random, 0.1, 2.0));
        const double       size   = rules.a * record.radius;
        const assay_vec3   p =
            vec3_add(record.position, random_box(&random, -0.7 * size, 0.7 * size));
        const assay_vec3 n         = tilted(&random, record.normal, random_in(&random, 0.01, 0.2));
        const double     weight    = assay_record_weight(&record, &rules, p, n);
        const double     expected  = (double)literal_weight(&record, &rules, p, n);
        const double     threshold = rules.weight == ASSAY_WEIGHT_WARD ? 1.0 / rules.a : 0.0;
        if (fabs(expected - threshold) < 1e-9) {
            continue;
        }
        assert_near(weight, expected > threshold ? expected : 0.0, 1e-9 * fmax(1.0, expected));
        assert_true(weight <= ASSAY_WEIGHT_MAX);
        within += weight > 0.0;
        beyond += weight == 0.0;
    }
    assert_true(within > 40000 && beyond > 40000);
}

/* Points at the reach and a few units of the last place about it: a weight above 0 is within. */
static void nothing_counts_beyond_the_reach(void **state)
{
    (void)state;
    assay_random random = assay_random_start(8, ASSAY_STAGE_TEST, 0, 0);
    int          inside = 0;
    for (int i = 0; i < 100000; i++) {
        const assay_record_rules rules  = {.a = random_in(&random, 0.01, 3.0),
                                           .weight =
                                              i % 2 ? ASSAY_WEIGHT_WARD : ASSAY_WEIGHT_TABELLION};
        const assay_record       record = record_at(random_box(&random, -10.0, 10.0), UP,
                                                    ldexp(random_in(&random, 0.5, 1.0), i % 60 - 30));
        const double             reach  = assay_record_reach(&record, &rules);
        const double             by     = rules.a * record.radius * (1.0 + (i % 9 - 4) * 0x1p-52);
        const assay_vec3         p      = vec3_mad(record.position, by, random_unit(&random));
        const double             d      = vec3_length(vec3_sub(p, record.position));
        const bool               counts = assay_record_weight(&record, &rules, p, UP) > 0.0;
        assert_true(reach >= rules.a * record.radius);
        assert_true(reach <= rules.a * record.radius * (1.0 + 2e-12));
        assert_true(!counts || d <= reach);
        inside += counts;
    }
    assert_true(inside > 10000);
}

static void not_a_number_never_counts(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        const assay_record_rules rules = {
            .a = 1.0, .weight = kind ? ASSAY_WEIGHT_WARD : ASSAY_WEIGHT_TABELLION};
        const assay_record record = record_at(ORIGIN, UP, 1.0);
        assert_true(assay_record_weight(&record, &rules, vec3(NAN, 0.0, 0.0), UP) == 0.0);
        assert_true(assay_record_weight(&record, &rules, vec3(0.0, INFINITY, 0.0), UP) == 0.0);
        assert_true(assay_record_weight(&record, &rules, vec3(0.0, 1e200, 0.0), UP) == 0.0);
        assert_true(assay_record_weight(&record, &rules, ORIGIN, vec3(0.0, NAN, 0.0)) == 0.0);
    }
}

/* A record on a step in front of the point is left out, one behind it is not. */
static void records_in_front_are_left_out(void **state)
{
    (void)state;
    const assay_record_rules with = {.a = 0.5, .in_front = true}, without = {.a = 0.5};
    const assay_record       record = record_at(vec3(0.0, 0.0, 1.0), UP, 2.0);
    const double             step   = ASSAY_IN_FRONT * record.radius;
    const assay_vec3         below = vec3(0.1, 0.0, 1.0 - 1.01 * step), above = vec3(0.1, 0.0, 1.3);
    const assay_vec3         barely = vec3(0.1, 0.0, 1.0 - 0.99 * step);
    assert_true(assay_record_weight(&record, &without, below, UP) > 0.0);
    assert_true(assay_record_weight(&record, &with, below, UP) == 0.0);
    assert_true(assay_record_weight(&record, &with, barely, UP) > 0.0);
    assert_true(assay_record_weight(&record, &with, above, UP) ==
                assay_record_weight(&record, &without, above, UP));
    /* Both normals count: the mean of (0, 0, 1) and (3, 0, 4) / 5 is (0.3, 0, 0.9). */
    const assay_record_rules wide = {.a = 2.0, .in_front = true};
    const assay_vec3         n    = vec3(0.6, 0.0, 0.8);
    assert_true(assay_record_weight(&record, &wide, vec3(0.9, 0.0, 0.701), n) > 0.0);
    assert_true(assay_record_weight(&record, &wide, vec3(0.9, 0.0, 0.695), n) == 0.0);
}

/* On a plane and on a sphere the product is 0: only rounding could leave a record out. */
static void smooth_surfaces_have_no_front(void **state)
{
    (void)state;
    const assay_record_rules rules  = {.a = 3.0, .in_front = true};
    assay_random             random = assay_random_start(9, ASSAY_STAGE_TEST, 0, 0);
    const assay_vec3         middle = vec3(1000.0, -2000.0, 3000.0);
    for (int i = 0; i < 20000; i++) {
        const assay_vec3   a = random_unit(&random), b = tilted(&random, a, 0.5);
        const assay_record on_sphere = record_at(vec3_mad(middle, 0.01, a), a, 0.01);
        assert_true(assay_record_weight(&on_sphere, &rules, vec3_mad(middle, 0.01, b), b) > 0.0);
        const assay_frame3 f        = frame3_from_z(a);
        const assay_record on_plane = record_at(middle, a, 0.01);
        const assay_vec3   p        = vec3_mad(middle, random_in(&random, -0.02, 0.02), f.x);
        assert_true(assay_record_weight(&on_plane, &rules, p, a) > 0.0);
    }
}

/* E(p, n) = c + g . p, and in n the irradiance of a light vector v, of which one term of the series
 * is kept: (n_k x n) . (n_k x v) = v . n - (n_k . n)(n_k . v). */
static void extrapolation_follows_the_field(void **state)
{
    (void)state;
    assay_random random = assay_random_start(10, ASSAY_STAGE_TEST, 0, 0);
    for (int i = 0; i < 2000; i++) {
        assay_vec3   g[3], v[3];
        assay_record r = record_at(random_box(&random, -2.0, 2.0), random_unit(&random), 1.0);
        for (int c = 0; c < 3; c++) {
            g[c]             = random_box(&random, -3.0, 3.0);
            v[c]             = random_box(&random, -3.0, 3.0);
            r.translation[c] = g[c];
            r.rotation[c]    = vec3_cross(r.normal, v[c]);
        }
        r.irradiance       = rgb(5.0 + vec3_dot(g[0], r.position), 6.0 + vec3_dot(g[1], r.position),
                                 7.0 + vec3_dot(g[2], r.position));
        const assay_vec3 p = random_box(&random, -2.0, 2.0), n = random_unit(&random);
        for (int kind = 0; kind < 4; kind++) {
            const assay_record_rules rules = {.a = 1.0, .gradients = (assay_gradients)kind};
            const assay_rgb          e     = assay_record_extrapolate(&r, &rules, p, n);
            const bool turns = kind == ASSAY_GRADIENTS_ROTATION || kind == ASSAY_GRADIENTS_BOTH;
            const bool moves = kind == ASSAY_GRADIENTS_TRANSLATION || kind == ASSAY_GRADIENTS_BOTH;
            const double got[3] = {e.r, e.g, e.b};
            for (int c = 0; c < 3; c++) {
                const double expected =
                    5.0 + c + vec3_dot(g[c], moves ? p : r.position) +
                    (turns ? vec3_dot(v[c], n) - vec3_dot(r.normal, n) * vec3_dot(r.normal, v[c])
                           : 0.0);
                assert_near(got[c], expected, 1e-13);
            }
        }
    }
}

static void at_home_a_record_says_what_it_holds(void **state)
{
    (void)state;
    const assay_record_rules rules  = {.a = 1.0, .gradients = ASSAY_GRADIENTS_BOTH};
    assay_random             random = assay_random_start(11, ASSAY_STAGE_TEST, 0, 0);
    for (int i = 0; i < 1000; i++) {
        assay_record r = record_at(random_box(&random, -2.0, 2.0), random_unit(&random), 1.0);
        for (int c = 0; c < 3; c++) {
            r.translation[c] = random_box(&random, -1e6, 1e6);
            r.rotation[c]    = random_box(&random, -1e6, 1e6);
        }
        r.irradiance      = rgb(0.1, 0.0, 3e9);
        const assay_rgb e = assay_record_extrapolate(&r, &rules, r.position, r.normal);
        assert_true(e.r == 0.1 && e.g == 0.0 && e.b == 3e9);
    }
}

static void what_falls_below_zero(void **state)
{
    (void)state;
    assay_record_rules rules = {.a = 1.0, .gradients = ASSAY_GRADIENTS_TRANSLATION};
    assay_record       r     = record_at(ORIGIN, UP, 1.0);
    r.irradiance             = rgb(1.0, 1.0, 1.0);
    r.translation[1]         = vec3(-4.0, 0.0, 0.0);
    r.translation[2]         = vec3(2.0, 0.0, 0.0);
    const assay_vec3 p       = vec3(0.5, 0.0, 0.0);
    assay_rgb        e       = assay_record_extrapolate(&r, &rules, p, UP);
    assert_true(e.r == 1.0 && e.g == -1.0 && e.b == 2.0);
    rules.clamp_negative = true;
    e                    = assay_record_extrapolate(&r, &rules, p, UP);
    assert_true(e.r == 1.0 && e.g == 0.0 && e.b == 2.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ward_values),
                                       cmocka_unit_test(ward_survives_rounded_normals),
                                       cmocka_unit_test(threshold_is_where_it_is_printed),
                                       cmocka_unit_test(tabellion_values),
                                       cmocka_unit_test(weights_are_what_is_printed),
                                       cmocka_unit_test(nothing_counts_beyond_the_reach),
                                       cmocka_unit_test(not_a_number_never_counts),
                                       cmocka_unit_test(records_in_front_are_left_out),
                                       cmocka_unit_test(smooth_surfaces_have_no_front),
                                       cmocka_unit_test(extrapolation_follows_the_field),
                                       cmocka_unit_test(at_home_a_record_says_what_it_holds),
                                       cmocka_unit_test(what_falls_below_zero)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
