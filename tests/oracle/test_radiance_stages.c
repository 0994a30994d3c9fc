/* test_radiance_stages.c - what records of radiance say: what candidates of few digits make of them
 * lies within the bounds of stages `interpolate-radiance` and `rotate`; what is wrong lies far
 * beyond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "oracle/stage/turn_bound.h"
#include "support/measure.h"
#include "support/radiance_candidate.h"
#include "support/random_places.h"

static const int DIGITS[] = {11, 24, 53};

static size_t few_ask(radiance_candidate *c, size_t i, double out[ROW], double *sum_out)
{
    static double said[RECORDS][ROW];
    double        weights[RECORDS], terms[RECORDS], values[RECORDS], here[9], frame[9];
    const double *n     = c->d->frame + 9 * i + 6;
    const size_t  count = few_terms(c, c->d->at + 3 * i, n, weights, said);
    put_values(terms, weights, count);
    *sum_out = few_sum(&c->f, count, terms);
    for (size_t k = 0; k < ROW; k++) {
        for (size_t j = 0; j < count; j++) {
            values[j] = said[j][c->defect == SWAPPED ? (k + 2 * COUNT) % ROW : k];
        }
        out[k] = few_mean(c, count, weights, values);
    }
    few_frame(&c->f, n, here);
    for (int k = 0; k < 9; k++) {
        frame[k] = few(&c->f, c->d->frame[9 * i + (size_t)k]);
    }
    if (c->defect != OTHER_FRAME) {
        c->threshold += 1.0; /* one z */
        few_turn(c, here, frame, out);
        c->threshold -= 1.0;
    }
    for (size_t l = 1; l < ORDER && c->defect == MIRRORED; l++) {
        for (size_t k = 0; k < ROW; k += COUNT) {
            const double last      = out[k + l * l + 2 * l];
            out[k + l * l + 2 * l] = out[k + l * l];
            out[k + l * l]         = last;
        }
    }
    return count;
}

/* ---- asking ---- */

/* alone: of points where one record counts, so that no weight is in the answer. */
static bound_use use_coefficients(const radiance_data *d, radiance_candidate *c,
                                  assay_precision precision, bound_use *sums, bound_use *alone)
{
    stage_case s   = stage_case_begin(c->context);
    bound_use  use = {0};
    stage_case_text(&s, "rotation", c->exact ? "exact" : "table");
    radiance_data_add(&s, d);
    stage_case_table(&s, "radiance_query/position", "m", d->count, 3, d->at);
    stage_case_table(&s, "radiance_query/frame", "", d->count, 9, d->frame);
    stage_case_run(&s, "interpolate-radiance", precision);
    const stage_output *mean = stage_case_output(&s, "radiance_query/coefficients");
    const stage_output *sum  = stage_case_output(&s, "radiance_query/weight_sum");
    assert_int_equal(mean->columns, ROW);
    for (size_t i = 0; i < d->count; i++) {
        double       out[ROW], weight = 0.0;
        const size_t count = few_ask(c, i, out, &weight);
        bound_use_add(sums, weight, sum->values[i], sum->bounds[i]);
        for (size_t k = 0; k < ROW; k++) {
            bound_use_add(&use, out[k], mean->values[ROW * i + k], mean->bounds[ROW * i + k]);
            if (count == 1) {
                bound_use_add(alone, out[k], mean->values[ROW * i + k], mean->bounds[ROW * i + k]);
            }
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_interpolate_radiance(void **state)
{
    radiance_data     *d = radiance_data_make();
    radiance_candidate c;
    radiance_candidate_open(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        bound_use alone = {0};
        double    most  = 0.0;
        for (int way = 0; way < 2 * WAYS; way++) {
            bound_use sums = {0};
            radiance_candidate_choose(&c, p, RIGHT, (turning)(way / 2), way % 2);
            c.exact               = false;
            const bound_use right = use_coefficients(d, &c, (assay_precision)p, &sums, &alone);
            assert_int_equal(right.beyond, 0);
            assert_int_equal(sums.beyond, 0);
            most = fmax(most, right.most);
        }
        print_message("interpolate-radiance, %d digits: %.3f of the bound, one record %.3f\n",
                      DIGITS[p], most, alone.most);
        assert_true(p == ASSAY_PRECISION_DOUBLE || (most > 0.03 && alone.most > 0.01));
    }
    bound_use exact = {0}, exact_sums = {0};
    radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, BY_ANGLES, true);
    c.exact  = true;
    d->count = 15;
    assert_int_equal(use_coefficients(d, &c, ASSAY_PRECISION_FLOAT, &exact_sums, &exact).beyond, 0);
    d->count                    = POINTS;
    static const defect wrong[] = {FLIPPED, NOT_LOCAL, NOT_TURNED, INVERSE, OTHER_FRAME,
                                   SWAPPED, MIRRORED,  LOST,       LARGER_R};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        bound_use sums = {0}, alone = {0};
        radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        c.exact             = false;
        const bound_use bad = use_coefficients(d, &c, ASSAY_PRECISION_FLOAT, &sums, &alone);
        print_message("  defect %d: %.3g times the bound, %zu values\n", wrong[i], bad.most,
                      bad.beyond);
        assert_true(bad.most > 50.0);
    }
    radiance_candidate_close(&c);
    free(d);
}

/* The bundle has floats, the candidate what was rounded to them. */
static void test_stored_as_floats(void **state)
{
    radiance_data     *d = radiance_data_make(), *stored = radiance_data_stored(d, 24);
    bound_use          sums = {0}, alone = {0};
    radiance_candidate c;
    radiance_candidate_open(&c, *state, d);
    for (int way = 0; way < WAYS; way++) {
        radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, (turning)way, way % 2);
        const bound_use use = use_coefficients(stored, &c, ASSAY_PRECISION_FLOAT, &sums, &alone);
        print_message("stored as floats: %.3f of the bound\n", use.most);
        assert_int_equal(use.beyond, 0);
    }
    radiance_candidate_close(&c);
    free(stored);
    free(d);
}

/* ---- turns by themselves ---- */

/* As a stage reads what was stored with few digits. */
static assay_vec3 stored(const few_digits *given, assay_vec3 n)
{
    const assay_vec3 rounded = vec3(few(given, n.x), few(given, n.y), few(given, n.z));
    return given->digits == 53 ? n : vec3_normalize(rounded);
}

/* Normals were stored with fewer digits than the candidate computes with, or with as many.  widest:
 * of the table's bounds where there is next to no tilt, in parts of a row's length. */
static bound_use use_turns(radiance_candidate *c, const rounding *r, const few_digits *given,
                           double *widest)
{
    enum { PAIRS = ORDER * (ORDER + 1) / 2 };
    const assay_radiance_turn_settings settings = {.way =
                                                       c->exact ? ASSAY_HSH_EXACT : ASSAY_HSH_TABLE,
                                                   .steps    = STEPS,
                                                   .tilt_max = c->nodes[STEPS]};
    assay_radiance_turn               *turn     = NULL;
    turn_bound                        *bound    = NULL;
    bound_use                          use      = {0};
    assay_random                       random   = assay_random_start(31, ASSAY_STAGE_TEST, 3, 0);
    assert_int_equal(assay_radiance_turn_create(c->context, c->hsh, &settings, 1, &turn), ASSAY_OK);
    assert_int_equal(turn_bound_create(c->context, c->hsh, turn, &settings, &bound), ASSAY_OK);
    for (size_t i = 0; i < (c->exact ? 50u : 200u); i++) {
        const assay_vec3    a = random_unit(&random), b = tilted(a, i, &random);
        const assay_vec3    n = stored(given, a), m = stored(given, b);
        const assay_frame3  from = frame3_from_z(n), to = frame3_from_z(m);
        const tracked_frame near = tracked_frame_from_z(r, n), far = tracked_frame_from_z(r, m);
        double there[9], here[9], ours[ROW], theirs[ROW], scratch[2 * (PAIRS + PAIRS * PAIRS)];
        double before[3 * PAIRS], after[3 * PAIRS], errors[3 * PAIRS] = {0.0}, away[3 * PAIRS];
        for (size_t k = 0; k < ROW; k++) {
            ours[k]   = few(&c->f, random_in(&random, -1.0, 1.0));
            theirs[k] = ours[k];
        }
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, ours + k * COUNT, before + k * PAIRS);
        }
        few_frame(&c->f, &a.x, there);
        few_frame(&c->f, &b.x, here);
        few_turn(c, there, here, theirs);
        assert_int_equal(assay_radiance_turn_apply(turn, 0, &from, &to, ours), ASSAY_OK);
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, ours + k * COUNT, after + k * PAIRS);
        }
        assert_int_equal(
            turn_bound_turn(bound, r, &near, &far, false, before, after, errors, scratch),
            ASSAY_OK);
        for (size_t k = 0; k < ROW; k++) {
            theirs[k] -= ours[k];
        }
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, theirs + k * COUNT, away + k * PAIRS);
        }
        for (size_t k = 0; k < (size_t)3 * PAIRS; k++) {
            if (!c->exact && vec3_length(vec3_sub(a, b)) < 1.5e-6) {
                *widest = fmax(*widest, errors[k] / sqrt(COUNT / 3.0));
            }
            bound_use_add(&use, away[k], 0.0, errors[k]);
        }
    }
    turn_bound_destroy(bound);
    assay_radiance_turn_destroy(turn);
    return use;
}

static void test_turns(void **state)
{
    radiance_candidate c;
    radiance_candidate_open(&c, *state, NULL);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        for (int stored = 0; stored <= p; stored++) {
            const bool exact  = p == ASSAY_PRECISION_FLOAT; /* takes its time */
            bound_use  most   = {0};
            double     widest = 0.0;
            for (int way = 0; way < 4 * WAYS; way += way % 4 == 1 && !exact ? 3 : 1) {
                radiance_candidate_choose(&c, p, RIGHT, (turning)(way / 4), way % 2);
                c.exact                = way % 4 > 1;
                const few_digits given = {.digits = DIGITS[stored]};
                rounding         r     = stage_rounding_of((assay_precision)p);
                r.given = fmax(r.given, (stored < p ? 2.0 : 1.0) * ldexp(1.0, -DIGITS[stored]));
                const bound_use use = use_turns(&c, &r, &given, &widest);
                most.most           = fmax(most.most, use.most);
                most.beyond += use.beyond;
            }
            print_message("turns, %d digits of %d given: %.3f of the bound; widest %.3g\n",
                          DIGITS[p], DIGITS[stored], most.most, widest);
            assert_int_equal(most.beyond, 0);
            assert_true(p != ASSAY_PRECISION_FLOAT || stored < p || widest < 0.03);
            assert_true(p == ASSAY_PRECISION_DOUBLE || most.most > (stored < p ? 0.003 : 0.03));
        }
    }
    radiance_candidate_close(&c);
}

/* 1, and what is just above half a unit of its last place: every addition rounds up. */
static void test_worst_product(void **state)
{
    enum { PAIRS = ORDER * (ORDER + 1) / 2 };
    const assay_radiance_turn_settings exact = {.way = ASSAY_HSH_EXACT};
    const rounding                     r     = stage_rounding_of(ASSAY_PRECISION_FLOAT);
    double norms[PAIRS * PAIRS], sizes[PAIRS], none[PAIRS] = {0.0}, errors[PAIRS], right = 0.0;
    assay_basis *hsh   = NULL;
    turn_bound  *bound = NULL;
    float        sum   = 0.0f;
    assert_int_equal(
        assay_basis_create(*state, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &hsh),
        ASSAY_OK);
    assert_int_equal(turn_bound_create(*state, hsh, NULL, &exact, &bound), ASSAY_OK);
    for (size_t i = 0; i < (size_t)PAIRS * PAIRS; i++) {
        norms[i] = 1.0;
    }
    for (size_t i = 0; i < PAIRS; i++) {
        sizes[i] = i == 0 ? 1.0 : 0x1.00001p-24;
        right += sizes[i];
        sum = sum + (float)sizes[i];
    }
    turn_bound_product(bound, &r, norms, norms, 0.0, sizes, none, errors);
    assert_true(fabs(sum - right) > 8.0 * 0x1p-24 && fabs(sum - right) <= errors[0]);
    turn_bound_destroy(bound);
    assay_basis_destroy(hsh);
}

/* Just where its weight is 1 / a a record may count or not, and nothing else does. */
static void test_edge(void **state)
{
    const double position[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0}, radius = 1.0;
    const double at[3] = {0.6, 0.0, 0.0}, frame[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double coefficients[3] = {2.0, 3.0, 4.0};
    stage_case   s               = stage_case_begin(*state);
    stage_case_text(&s, "a", "0.6");
    stage_case_text(&s, "order", "1");
    stage_case_text(&s, "coefficient_gradient", "none");
    stage_case_table(&s, "radiance_records/position", "m", 1, 3, position);
    stage_case_table(&s, "radiance_records/normal", "", 1, 3, up);
    stage_case_table(&s, "radiance_records/radius", "m", 1, 1, &radius);
    stage_case_table(&s, "radiance_records/coefficients", "W/(m2 sr)", 1, 3, coefficients);
    stage_case_table(&s, "radiance_query/position", "m", 1, 3, at);
    stage_case_table(&s, "radiance_query/frame", "", 1, 9, frame);
    stage_case_run(&s, "interpolate-radiance", ASSAY_PRECISION_FLOAT);
    const stage_output *mean = stage_case_output(&s, "radiance_query/coefficients");
    for (size_t k = 0; k < 3; k++) {
        assert_true(mean->values[k] == coefficients[k] && mean->bounds[k] >= coefficients[k]);
    }
    stage_case_end(&s);
}

/* ---- HSH by angles ---- */

/* far: a hundred turns farther, where the angle is known less well than its sine. */
static bound_use use_angles(radiance_candidate *c, int precision, double sign, bool whole, bool far)
{
    const double alpha = 0.3, beta = far ? 629.4321 : 1.1, gamma = -2.0;
    double       in[2 * ROW], matrix[COUNT * COUNT];
    bound_use    use = {0};
    stage_case   s   = stage_case_begin(c->context);
    for (size_t i = 0; i < (size_t)2 * ROW; i++) {
        in[i] = random_in(&c->f.random, -1.0, 1.0);
    }
    stage_case_text(&s, "basis", "hsh");
    stage_case_text(&s, "order", "4");
    stage_case_text(&s, "alpha", "0.3");
    stage_case_text(&s, "beta", far ? "629.4321" : "1.1");
    stage_case_text(&s, "gamma", "-2");
    stage_case_table(&s, "rotate/in", "W/(m2 sr)", 6, COUNT, in);
    stage_case_run(&s, "rotate", (assay_precision)precision);
    const stage_output *out = stage_case_output(&s, "rotate/out");
    const few_digits   *f   = &c->f;
    for (size_t i = 0; i < 2; i++) {
        double       row[ROW];
        const double a = few(f, alpha), g = few(f, gamma);
        const double b = remainder(few(f, beta), ASSAY_TWO_PI);
        for (size_t k = 0; k < ROW; k++) {
            row[k] = few(f, in[ROW * i + k]);
        }
        few_matrix(c, sign * b, matrix);
        if (whole) {
            few_whole_turn(c, few(f, assay_cos(a)), few(f, assay_sin(a)), few(f, assay_cos(g)),
                           few(f, assay_sin(g)), sign * b, row);
        } else {
            few_spin(f, few(f, assay_cos(g)), few(f, assay_sin(g)), row);
            few_multiply(c, matrix, row);
            few_spin(f, few(f, assay_cos(a)), few(f, assay_sin(a)), row);
        }
        for (size_t k = 0; k < ROW; k++) {
            bound_use_add(&use, row[k], out->values[ROW * i + k], out->bounds[ROW * i + k]);
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_angles(void **state)
{
    radiance_candidate c;
    radiance_candidate_open(&c, *state, NULL);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        radiance_candidate_choose(&c, p, RIGHT, BY_ANGLES, false);
        c.exact               = true;
        const bound_use parts = use_angles(&c, p, 1.0, false, false);
        const bound_use whole = use_angles(&c, p, 1.0, true, false);
        const bound_use far   = use_angles(&c, p, 1.0, false, true);
        print_message("rotate, hsh, %d digits: %.3f, %.3f, %.3f of the bound\n", DIGITS[p],
                      parts.most, whole.most, far.most);
        assert_int_equal(parts.beyond + whole.beyond + far.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || parts.most > 5e-4);
    }
    radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, BY_ANGLES, false);
    c.exact             = true;
    const bound_use bad = use_angles(&c, ASSAY_PRECISION_FLOAT, -1.0, false, false);
    print_message("  inverse: %.3g times the bound\n", bad.most);
    assert_true(bad.most > 100.0);
    radiance_candidate_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_turns, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_interpolate_radiance, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(test_stored_as_floats, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_worst_product, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_edge, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_angles, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
