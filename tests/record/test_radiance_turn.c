/* test_radiance_turn.c - turns from frame to frame against the matrices of the bases, and against
 * what a turn is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "record/radiance_turn.h"
#include "record/record.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/near.h"

enum { ORDER = 5, COUNT = ORDER * ORDER, ALL = 3 * COUNT, PAIRS = 7 };

typedef struct {
    assay_context *context;
    assay_basis   *hsh;
} bench;

static bench open_bench(void)
{
    bench b = {.context = measure_context(1)};
    assert_int_equal(
        assay_basis_create(b.context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &b.hsh),
        ASSAY_OK);
    return b;
}

static void close_bench(bench *b)
{
    assay_basis_destroy(b->hsh);
    assay_context_destroy(b->context);
}

static assay_radiance_turn *make(const bench *b, assay_hsh_rotation_way way, int steps, double most)
{
    const assay_radiance_turn_settings settings = {
        .way = way, .steps = steps, .sh_order = 7, .tilt_max = most};
    assay_radiance_turn *turn = NULL;
    assert_int_equal(assay_radiance_turn_create(b->context, b->hsh, &settings, 1, &turn), ASSAY_OK);
    return turn;
}

/* Frames about normals that stand `tilt` apart, twisted about them. */
static void frames_of(int pair, double tilt, assay_frame3 *from, assay_frame3 *to)
{
    const assay_sincos a = assay_sincos_radians(1.1 * pair), b = assay_sincos_radians(2.3 * pair);
    const assay_sincos t = assay_sincos_radians(tilt);
    const assay_frame3 start =
        frame3_from_zx(vec3_normalize(vec3(a.cos, 0.3 * pair - 1.0, a.sin)), vec3(b.sin, b.cos, 0));
    const assay_vec3 side =
        vec3_add(vec3_scale(start.x, b.cos), vec3_scale(start.y, b.sin)); /* unit, to tilt to */
    *from = start;
    *to   = frame3_from_zx(vec3_add(vec3_scale(start.z, t.cos), vec3_scale(side, t.sin)),
                           vec3(a.sin, a.cos, b.cos));
}

static void rotation_between(const assay_frame3 *from, const assay_frame3 *to, double r[9])
{
    const assay_vec3 f[3] = {from->x, from->y, from->z}, t[3] = {to->x, to->y, to->z};
    for (int i = 0; i < 9; i++) {
        r[i] = vec3_dot(t[i / 3], f[i % 3]);
    }
}

static void some_coefficients(int seed, double *c)
{
    for (int i = 0; i < ALL; i++) {
        c[i] = assay_sin(1.7 * i + seed) / (1.0 + i % COUNT);
    }
}

static double norm_of_difference(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < ALL; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(sum);
}

/* By the dense matrix of include/assay/basis.h. */
static void by_matrix(const bench *b, const assay_hsh_rotation_options *options,
                      const assay_frame3 *from, const assay_frame3 *to, double *c)
{
    double r[9], matrix[COUNT * COUNT], turned[ALL];
    rotation_between(from, to, r);
    assert_int_equal(assay_hsh_rotation(b->hsh, b->context, options, r, matrix), ASSAY_OK);
    for (int i = 0; i < ALL; i++) {
        turned[i] = 0.0;
        for (int j = 0; j < COUNT; j++) {
            turned[i] += matrix[i % COUNT * COUNT + j] * c[i / COUNT * COUNT + j];
        }
    }
    memcpy(c, turned, sizeof turned);
}

static double turned_difference(const bench *b, assay_radiance_turn *turn,
                                const assay_hsh_rotation_options *options, int pair, double tilt)
{
    assay_frame3 from, to;
    double       c[ALL], expected[ALL];
    frames_of(pair, tilt, &from, &to);
    some_coefficients(pair, c);
    some_coefficients(pair, expected);
    assert_int_equal(assay_radiance_turn_apply(turn, 0, &from, &to, c), ASSAY_OK);
    by_matrix(b, options, &from, &to, expected);
    return norm_of_difference(c, expected);
}

/* Every way is its matrix; tabulated ones at angles of their own table. */
static void ways_are_their_matrices(void **state)
{
    (void)state;
    bench        b    = open_bench();
    const double most = 0.8;
    enum { STEPS = 4 };
    for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT; way++) {
        assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way, .sh_order = 7};
        assay_radiance_turn       *turn    = make(&b, options.way, STEPS, most);
        if (way == ASSAY_HSH_TABLE) {
            options.way = ASSAY_HSH_EXACT;
        }
        for (int pair = 0; pair < PAIRS; pair++) {
            for (int step = 0; step <= STEPS; step++) {
                const double tilt = most * step * step / (STEPS * STEPS);
                /* The conversion loses something even where nothing is turned; ours does not. */
                if (step > 0 || way != ASSAY_HSH_CONVERSION) {
                    assert_true(turned_difference(&b, turn, &options, pair, tilt) < 1e-9);
                }
            }
        }
        assay_radiance_turn_destroy(turn);
    }
    close_bench(&b);
}

/* Between the angles of a table: the error falls by 4 for twice as many. */
static void tables_converge(void **state)
{
    (void)state;
    bench                            b       = open_bench();
    const assay_hsh_rotation_options options = {.way = ASSAY_HSH_EXACT};
    double                           last    = 0.0;
    for (int steps = 4; steps <= 32; steps *= 2) {
        assay_radiance_turn *turn    = make(&b, ASSAY_HSH_TABLE, steps, 0.5);
        double               largest = 0.0;
        for (int pair = 0; pair < PAIRS; pair++) {
            for (int k = 0; k < 20; k++) {
                largest = fmax(largest,
                               turned_difference(&b, turn, &options, pair, 0.5 * (k + 0.3) / 20));
            }
        }
        print_message("#| %d steps: %.2e\n", steps, largest);
        assert_true(steps == 4 || largest < 0.35 * last);
        last = largest;
        assay_radiance_turn_destroy(turn);
    }
    assert_true(last < 2e-3);
    close_bench(&b);
}

/* A function that the basis holds, evaluated in a direction of the world, keeps its value as long
 * as nothing of it is near the horizon; here exactly, since turns about z lose nothing. */
static void turns_about_z_keep_values(void **state)
{
    (void)state;
    bench                b    = open_bench();
    assay_radiance_turn *turn = make(&b, ASSAY_HSH_TABLE, 4, 0.5);
    for (int pair = 0; pair < PAIRS; pair++) {
        assay_frame3 from, to, twisted;
        double       c[ALL], before[COUNT], after[COUNT];
        frames_of(pair, 0.0, &from, &to);
        twisted = (assay_frame3){to.x, to.y, from.z};
        some_coefficients(pair, c);
        const assay_vec3 w = frame3_to_world(&from, vec3_normalize(vec3(0.3, -0.5, 0.4)));
        assert_int_equal(assay_basis_evaluate(b.hsh, frame3_to_local(&from, w), before), ASSAY_OK);
        assert_int_equal(assay_basis_evaluate(b.hsh, frame3_to_local(&twisted, w), after),
                         ASSAY_OK);
        const double value = assay_basis_dot(b.hsh, c, before);
        assert_int_equal(assay_radiance_turn_apply(turn, 0, &from, &twisted, c), ASSAY_OK);
        assert_near(assay_basis_dot(b.hsh, c, after), value, 1e-13);
    }
    assay_radiance_turn_destroy(turn);
    close_bench(&b);
}

typedef struct {
    assay_vec3 axis;
} smooth_lobe;

static void lobe_at(void *user, assay_vec3 w, double *values_out)
{
    const smooth_lobe *lobe = user;
    const double       c    = vec3_dot(lobe->axis, w);
    for (int i = 0; i < 3; i++) {
        values_out[i] = c > 0.0 ? c * c * c * c : 0.0;
    }
}

/* A lobe of the world that neither horizon cuts: what is turned are the coefficients of the same
 * lobe in the other frame, as far as order 5 holds it.  The wrong way is far off. */
static void lobes_stay_in_the_world(void **state)
{
    (void)state;
    bench                b    = open_bench();
    assay_radiance_turn *turn = make(&b, ASSAY_HSH_TABLE, 32, 0.5);
    for (int pair = 0; pair < PAIRS; pair++) {
        assay_frame3 from, to;
        double       here[ALL], there[ALL], wrong[ALL];
        frames_of(pair, 0.4, &from, &to);
        const assay_vec3 axis = vec3_normalize(vec3_mad(from.z, 0.4, to.x));
        smooth_lobe local = {frame3_to_local(&from, axis)}, other = {frame3_to_local(&to, axis)};
        assert_int_equal(assay_basis_project(b.hsh, b.context, lobe_at, &local, 3, 32, 32, here),
                         ASSAY_OK);
        assert_int_equal(assay_basis_project(b.hsh, b.context, lobe_at, &other, 3, 32, 32, there),
                         ASSAY_OK);
        memcpy(wrong, here, sizeof wrong);
        double zero[ALL] = {0.0};
        assert_int_equal(assay_radiance_turn_apply(turn, 0, &from, &to, here), ASSAY_OK);
        assert_int_equal(assay_radiance_turn_apply(turn, 0, &to, &from, wrong), ASSAY_OK);
        const double norm = norm_of_difference(there, zero);
        assert_true(norm_of_difference(here, there) < 0.05 * norm);
        assert_true(norm_of_difference(wrong, there) > 0.2 * norm);
    }
    assay_radiance_turn_destroy(turn);
    close_bench(&b);
}

static void refuses_what_is_undefined(void **state)
{
    (void)state;
    bench                        b        = open_bench();
    assay_radiance_turn         *turn     = NULL;
    assay_radiance_turn_settings settings = {
        .way = ASSAY_HSH_ANALYTICAL, .steps = 4, .sh_order = 5, .tilt_max = 1.6};
    assert_int_equal(assay_radiance_turn_create(b.context, b.hsh, &settings, 1, &turn),
                     ASSAY_ERR_ARGUMENT);
    settings.way = ASSAY_HSH_DIGON;
    assert_int_equal(assay_radiance_turn_create(b.context, b.hsh, &settings, 1, &turn),
                     ASSAY_ERR_ARGUMENT);
    settings.tilt_max = NAN;
    settings.way      = ASSAY_HSH_EXACT;
    assert_int_equal(assay_radiance_turn_create(b.context, b.hsh, &settings, 1, &turn),
                     ASSAY_ERR_ARGUMENT);
    settings.tilt_max = 1.0;
    settings.steps    = 0;
    assert_int_equal(assay_radiance_turn_create(b.context, b.hsh, &settings, 1, &turn),
                     ASSAY_ERR_ARGUMENT);
    assert_null(turn);
    /* A frame that is none: a status, and no change. */
    turn                      = make(&b, ASSAY_HSH_TABLE, 2, 0.5);
    double             c[ALL] = {1.0};
    const assay_frame3 frame  = frame3_from_z(vec3(0, 0, 1));
    const assay_frame3 none   = {vec3(NAN, 0, 0), vec3(0, 1, 0), vec3(0, 0, NAN)};
    assert_int_equal(assay_radiance_turn_apply(turn, 0, &frame, &none, c), ASSAY_ERR_DOMAIN);
    assert_true(c[0] == 1.0);
    assay_radiance_turn_destroy(turn);
    close_bench(&b);
}

/* The largest tilt of a record that still contributes, against the weight itself. */
static void largest_tilt(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const assay_record_rules rules  = {.a = k < 4 ? 0.1 * (1 << k) : 1.5 * (1 << (k - 4)),
                                           .weight =
                                              k < 4 ? ASSAY_WEIGHT_WARD : ASSAY_WEIGHT_TABELLION};
        const assay_record       record = {.normal = vec3(0, 0, 1), .radius = 1.0};
        const double             most   = assay_record_tilt_max(&rules);
        const assay_sincos       in     = assay_sincos_radians(most * (1 - 1e-6)),
                           out          = assay_sincos_radians(most * (1 + 1e-6));
        assert_true(most > 0.0 && most <= ASSAY_PI);
        assert_true(assay_record_weight(&record, &rules, vec3(0, 0, 0), vec3(in.sin, 0, in.cos)) >
                    0.0);
        assert_true(
            most == ASSAY_PI ||

            assay_record_weight(&record, &rules, vec3(0, 0, 0), vec3(out.sin, 0, out.cos)) == 0.0);
    }
    const assay_record_rules any = {.a = 10.0, .weight = ASSAY_WEIGHT_WARD};
    assert_true(assay_record_tilt_max(&any) == ASSAY_PI);
}

static assay_status make_on(assay_context *context, void *user)
{
    const assay_hsh_rotation_way      *way      = user;
    const assay_radiance_turn_settings settings = {
        .way = *way, .steps = 2, .sh_order = 3, .tilt_max = 0.5};
    assay_basis         *hsh  = NULL;
    assay_radiance_turn *turn = NULL;
    assay_status         status =
        assay_basis_create(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS, &hsh);
    status = status ? status : assay_radiance_turn_create(context, hsh, &settings, 2, &turn);
    assay_radiance_turn_destroy(turn);
    assay_basis_destroy(hsh);
    return status;
}

static void refused_memory(void **state)
{
    (void)state;
    for (int k = 0; k < ASSAY_HSH_ROTATION_WAY_COUNT; k++) {
        assay_hsh_rotation_way way = (assay_hsh_rotation_way)k;
        assert_true(failing_each(make_on, &way) > 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ways_are_their_matrices),
        cmocka_unit_test(tables_converge),
        cmocka_unit_test(turns_about_z_keep_values),
        cmocka_unit_test(lobes_stay_in_the_world),
        cmocka_unit_test(refuses_what_is_undefined),
        cmocka_unit_test(largest_tilt),
        cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
