/* test_bounds.c - bounds by themselves: extremes by trying all of them, and the worst cases that
 * chance does not find. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "oracle/stage/basis_bound.h"
#include "oracle/stage/irradiance_bound.h"
#include "oracle/stage/mean_bound.h"
#include "oracle/stage/record_bound.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/random_places.h"
#include "support/splat_room.h"
#include "support/stage_case.h"

static const rounding FLOAT = {.u = 0x1p-24, .tiny = 0x1p-126, .given = 0x1p-24};

/* Largest and smallest mean over every choice of ends. */
static void test_means(void **state)
{
    enum { MOST = 9 };
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, 5, 0);
    (void)state;
    for (int trial = 0; trial < 400; trial++) {
        mean_part    parts[MOST];
        const size_t count = 1 + (size_t)(assay_random_next(&random) * MOST);
        double       high = -INFINITY, low = INFINITY;
        for (size_t i = 0; i < count; i++) {
            const bool   maybe = assay_random_next(&random) < 0.3;
            const double w     = random_in(&random, 0.1, 3.0);
            parts[i].low       = maybe ? 0.0 : w;
            parts[i].high      = trial % 5 == 0 ? 1e12 : w + random_in(&random, 0.0, 2.0);
            parts[i].said[0].v = random_in(&random, -1.0, 2.0);
            parts[i].said[0].e = random_in(&random, 0.0, 0.1);
        }
        for (unsigned choice = 0; choice < 1U << count; choice++) {
            double top = 0.0, bottom = 0.0, sum = 0.0;
            for (size_t i = 0; i < count; i++) {
                const double w = choice >> i & 1U ? parts[i].high : parts[i].low;
                top += w * (parts[i].said[0].v + parts[i].said[0].e);
                bottom += w * (parts[i].said[0].v - parts[i].said[0].e);
                sum += w;
            }
            if (sum > 0.0) {
                high = fmax(high, top / sum);
                low  = fmin(low, bottom / sum);
            }
        }
        assert_near(mean_highest(parts, count, 0, 1.0), high, 1e-11);
        assert_near(-mean_highest(parts, count, 0, -1.0), low, 1e-11);
    }
}

/* 1, and what is just above half a unit of its last place: every addition rounds up. */
static void test_worst_mean(void **state)
{
    enum { COUNT = 40 };
    mean_part   parts[COUNT];
    float       sum   = 0.0f;
    double      right = 0.0;
    const float small = 0x1.00001p-24f;
    (void)state;
    for (size_t i = 0; i < COUNT; i++) {
        const float x = i == 0 ? 1.0f : small;
        parts[i]      = (mean_part){.low = 1.0, .high = 1.0, .said = {{x, 0.0}}};
        right += (double)x / COUNT;
        sum = sum + x;
    }
    const double error = fabs((double)(sum / (float)COUNT) - right);
    assert_true(error > 0x1p-25);
    assert_true(mean_bound(&FLOAT, parts, COUNT, 0, right) >= error);
}

/* In a hemisphere that is the same to a float everywhere, a float sees no gradient. */
static void test_flat_hemisphere(void **state)
{
    const assay_hemisphere_layout layout = {.theta = 4, .phi = 12, .strata = ASSAY_STRATA_COSINE};
    const assay_frame3            frame  = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assay_hemisphere             *h      = NULL;
    assay_vec3                    rotation[3], translation[3];
    assert_int_equal(assay_hemisphere_create(*state, &layout, &h), ASSAY_OK);
    for (size_t i = 0; i < 48; i++) {
        h->cells[i].radiance = rgb_grey(1.0 + (i % 12 < 6 ? 2e-8 : 0.0));
        h->cells[i].distance = 1.0;
    }
    assay_hemisphere_rotation_gradient(h, rotation);
    assay_hemisphere_translation_gradient(h, false, translation);
    const irradiance_bounds b = irradiance_bounds_of(&FLOAT, h, &frame, ASSAY_MEAN_UNIFORM, false);
    assert_true(fabs(rotation[0].x) > 1e-9 && fabs(translation[0].y) > 1e-9);
    for (int c = 0; c < 3; c++) {
        assert_true(b.rotation[3 * c] >= fabs(rotation[c].x));
        assert_true(b.translation[3 * c + 1] >= fabs(translation[c].y));
    }
    assay_hemisphere_destroy(*state, h);
}

/* What may contribute is no farther away than the reach that an index is made with. */
static void test_reach(void **state)
{
    const rounding           half   = {.u = 0x1p-11, .tiny = 0x1p-25, .given = 0x1p-11};
    const assay_record_rules rules  = {.a = 0.5};
    assay_random             random = assay_random_start(3, ASSAY_STAGE_TEST, 5, 0);
    size_t                   maybe  = 0;
    (void)state;
    for (int trial = 0; trial < 5000; trial++) {
        assay_record       record = {.position = random_box(&random, -9.0, 9.0),
                                     .normal   = random_unit(&random),
                                     .radius   = random_in(&random, 0.1, 1.0)};
        const double       far    = rules.a * record.radius + random_in(&random, 0.0, 0.03);
        const assay_vec3   p      = vec3_mad(record.position, far, random_unit(&random));
        const weight_bound w = record_weight_bound(&half, true, &record, &rules, p, record.normal);
        if (w.member != BOUND_OUT) {
            maybe++;
            assert_true(record_reach_bound(&half, &record, &rules,
                                           fmax(fmax(fabs(p.x), fabs(p.y)), fabs(p.z))) >= far);
        }
    }
    assert_true(maybe > 100);
}

/* A record whose height above the point's plane is all but the margin may be in front or not. */
static void test_margin(void **state)
{
    static const struct {
        double           height;
        bound_membership member;
    } cases[]                       = {{-1e-3 * (1.0 - 1e-8), BOUND_MAYBE},
                                       {-1e-3 * (1.0 + 1e-8), BOUND_MAYBE},
                                       {-1e-3 * (1.0 - 1e-5), BOUND_IN},
                                       {-1e-3 * (1.0 + 1e-5), BOUND_OUT}};
    const assay_record       record = {.normal = {0.0, 0.0, 1.0}, .radius = 1.0};
    const assay_record_rules rules  = {.a = 0.5, .in_front = true};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const weight_bound w = record_weight_bound(
            &FLOAT, true, &record, &rules, vec3(0.1, 0.0, cases[i].height), vec3(0.0, 0.0, 1.0));
        assert_int_equal(w.member, cases[i].member);
    }
}

/* Near a pole, near the horizon, or where cos m phi is all but 0: what the rounding turns there is
 * large beside the function. */
static assay_vec3 delicate_direction(assay_random *random, int trial)
{
    const assay_vec3 d = random_unit(random);
    if (trial % 3 == 0) {
        return vec3_normalize(vec3(1e-4 * d.x, 1e-4 * d.y, 1.0));
    }
    if (trial % 3 == 1) {
        return vec3_normalize(vec3(d.x, d.y, 1e-5 * fabs(d.z)));
    }
    const int          m   = 1 + trial % 7;
    const assay_sincos phi = assay_sincos_radians(0.5 * ASSAY_PI / m + 1e-3 * d.x);
    const double       z = 0.2 + 0.5 * fabs(d.z), sine = sqrt(1.0 - z * z);
    return vec3(sine * phi.cos, sine * phi.sin, z);
}

/* Functions at a direction that was rounded, against those at the direction. */
static void test_rounded_directions(void **state)
{
    enum { ORDER = 8, MOST = ORDER * ORDER };
    const few_digits single = {.digits = 24};
    assay_random     random = assay_random_start(2, ASSAY_STAGE_TEST, 5, 0);
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = NULL;
        double       most  = 0.0;
        if (!basis_bound_known((assay_basis_kind)kind)) {
            continue;
        }
        assert_int_equal(assay_basis_create(*state, (assay_basis_kind)kind, ORDER,
                                            ASSAY_CONVENTION_THESIS, &basis),
                         ASSAY_OK);
        for (int trial = 0; trial < 2000; trial++) {
            double           right[MOST], values[MOST];
            tracked          bound[MOST];
            const assay_vec3 d = delicate_direction(&random, trial);
            const assay_vec3 r = vec3(few(&single, d.x), few(&single, d.y), few(&single, d.z));
            assert_int_equal(assay_basis_evaluate(basis, d, right), ASSAY_OK);
            assert_int_equal(assay_basis_evaluate(basis, r, values), ASSAY_OK);
            basis_bound(&FLOAT, basis, d, right, bound);
            for (size_t i = 0; i < assay_basis_count(basis); i++) {
                const double part = fabs(values[i] - right[i]) / bound[i].e;
                most              = part > most ? part : most;
            }
        }
        print_message("%s: rounding the direction uses %.3f of the bound\n",
                      assay_basis_kind_name((assay_basis_kind)kind), most);
        assert_true(most <= 1.0 && most > 0.01);
        assay_basis_destroy(basis);
    }
}

/* ---- the last batch ---- */

enum { LATE = 60, EARLY = 40, SPOTS = 8 * 8 };

/* `records` of them in the bundle, of which the last batch has EARLY. */
static void run_light(stage_case *c, size_t records)
{
    double       position[3 * LATE], normal[3 * LATE], radius[LATE], light[3 * LATE];
    double       gradients[9 * LATE], at[3 * SPOTS], frame[9 * SPOTS] = {0.0}, albedo[3 * SPOTS];
    double       weight[SPOTS];
    const double end          = EARLY;
    const assay_camera camera = splat_room_camera(false);
    for (uint32_t k = 0; k < LATE; k++) {
        const assay_record r = splat_room_record(3, LATE, k);
        memcpy(position + 3 * (size_t)k, &r.position, 3 * sizeof *position);
        memcpy(normal + 3 * (size_t)k, &r.normal, 3 * sizeof *normal);
        memcpy(light + 3 * (size_t)k, &r.irradiance, 3 * sizeof *light);
        memcpy(gradients + 9 * (size_t)k, r.translation, 9 * sizeof *gradients);
        radius[k] = r.radius;
    }
    for (size_t i = 0; i < SPOTS; i++) {
        assay_vec3 p = vec3(0.5, 0.25, 0.0), n = vec3(0.0, 0.0, 1.0);
        splat_room_point(&camera, 8, 8, i, &p, &n);
        memcpy(at + 3 * i, &p, sizeof p);
        memcpy(frame + 9 * i + 6, &n, sizeof n);
        weight[i] = 2.0;
        for (size_t k = 0; k < 3; k++) {
            albedo[3 * i + k] = 0.5;
        }
    }
    stage_case_text(c, "a", "0.6");
    stage_case_table(c, "records/position", "m", records, 3, position);
    stage_case_table(c, "records/normal", "", records, 3, normal);
    stage_case_table(c, "records/radius", "m", records, 1, radius);
    stage_case_table(c, "records/irradiance", "W/m2", records, 3, light);
    stage_case_table(c, "records/rotation_gradient", "W/(m2 rad)", records, 9, gradients);
    stage_case_table(c, "records/translation_gradient", "W/m3", records, 9, gradients);
    stage_case_table(c, "splat/position", "m", SPOTS, 3, at);
    stage_case_table(c, "splat/frame", "", SPOTS, 9, frame);
    stage_case_table(c, "splat/albedo", "", SPOTS, 3, albedo);
    stage_case_table(c, "splat/batch.0/weight", "", SPOTS, 1, weight);
    stage_case_table(c, "splat/batch_end", "records", 1, 1, &end);
    stage_case_run(c, "splat-light", ASSAY_PRECISION_FLOAT);
}

/* Records that were made later change neither what is right nor how far from it is. */
static void test_last_batch(void **state)
{
    stage_case some = stage_case_begin(*state), all = stage_case_begin(*state);
    size_t     lit = 0;
    run_light(&some, EARLY);
    run_light(&all, LATE);
    const stage_output *a = stage_case_output(&some, "splat/batch.0/radiance");
    const stage_output *b = stage_case_output(&all, "splat/batch.0/radiance");
    for (size_t i = 0; i < (size_t)3 * SPOTS; i++) {
        lit += a->values[i] > 0.0;
        assert_true(a->values[i] == b->values[i] && a->bounds[i] == b->bounds[i]);
    }
    assert_true(lit > SPOTS);
    stage_case_end(&some);
    stage_case_end(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_worst_mean),
        cmocka_unit_test(test_reach),
        cmocka_unit_test(test_margin),
        cmocka_unit_test_setup_teardown(test_flat_hemisphere, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_rounded_directions, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_last_batch, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
