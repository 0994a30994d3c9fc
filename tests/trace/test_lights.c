/* test_lights.c - light sampling against its own density, and against what lights there are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "core/random.h"
#include "support/closed_form.h"
#include "support/measure.h"
#include "support/scene_builder.h"
#include "trace/lights.h"
#include "trace/world.h"

static const assay_vec3 SMALL[4] = {{0, 2, 0}, {0.1, 2, 0}, {0.1, 2, 0.1}, {0, 2, 0.1}};
static const assay_vec3 LARGE[4] = {{1, 3, 0}, {3, 3, 0}, {3, 3, 3}, {1, 3, 3}};

/* A small bright and a large dim square above, both shining down, and a constant sky. */
static assay_scene *two_squares(assay_context *context, double sky)
{
    scene_builder      *b       = scene_builder_create();
    assay_scene_options options = assay_scene_options_default();
    options.background          = rgb(sky, sky, sky);
    const int bright            = scene_builder_diffuse(b, 0.0, 100.0, false);
    const int dim               = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_quad(b, bright, SMALL[0], SMALL[1], SMALL[2], SMALL[3]);
    scene_builder_quad(b, dim, LARGE[0], LARGE[1], LARGE[2], LARGE[3]);
    return scene_builder_load(b, context, &options);
}

/* Mean over samples of radiance * cosine / pdf is the irradiance: closed forms of both squares, and
 * pi for the sky (no shadows are asked for, so the squares do not hide it). */
static void sampling_measures_irradiance_of(assay_vec3 normal)
{
    enum { N = 200000 };
    assay_context *context = measure_context(1);
    assay_scene   *scene   = two_squares(context, 0.5);
    assay_lights  *lights  = NULL;
    assert_int_equal(assay_lights_create(scene, &lights), ASSAY_OK);
    const assay_vec3     p = vec3(0.5, 0, 0.5), n = vec3(0, 1, 0);
    const assay_receiver receiver = {p, normal};
    assay_random         random   = assay_random_start(0, ASSAY_STAGE_TEST, 0, 0);
    double               sum = 0.0, squares = 0.0;
    for (int i = 0; i < N; i++) {
        const double u = assay_random_next(&random), u1 = assay_random_next(&random),
                     u2 = assay_random_next(&random);
        assay_light_sample s;
        double             value = 0.0;
        if (assay_lights_sample(lights, &receiver, false, u, u1, u2, &s)) {
            const double cosine = vec3_dot(s.direction, n);
            value               = cosine > 0.0 ? s.radiance.r * cosine / s.pdf : 0.0;
            assert_true(fabs(vec3_length(s.direction) - 1.0) < 1e-12);
        }
        sum += value;
        squares += value * value;
    }
    const double   mean     = sum / N;
    const measured m        = {mean, sqrt((squares / N - mean * mean) / N)};
    const double   expected = 100.0 * (double)closed_polygon(SMALL, 4, p, n) +
                            (double)closed_polygon(LARGE, 4, p, n) + 0.5 * ASSAY_PI;
    measure_check("irradiance by light sampling", m, expected, 0.0, 1.03 * expected);
    assay_lights_destroy(lights);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* With the receiver's normal, and for one that light reaches from everywhere. */
static void sampling_measures_irradiance(void **state)
{
    (void)state;
    sampling_measures_irradiance_of(vec3(0, 1, 0));
    sampling_measures_irradiance_of(vec3(0, 0, 0));
}

/* The density of a direction, asked the other way round, is the one it was drawn with. */
static void densities_agree_for(assay_vec3 normal)
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = two_squares(context, 0.05);
    assay_world   *world   = NULL;
    assert_int_equal(assay_world_create(scene, &world), ASSAY_OK);
    const assay_receiver receiver = {vec3(0.5, 0, 0.5), normal};
    assay_random         random   = assay_random_start(1, ASSAY_STAGE_TEST, 0, 0);
    int                  on_tree = 0, at_sky = 0;
    for (int i = 0; i < 2000; i++) {
        const double u = assay_random_next(&random), u1 = assay_random_next(&random),
                     u2 = assay_random_next(&random);
        assay_light_sample s;
        if (!assay_lights_sample(world->lights, &receiver, false, u, u1, u2, &s)) {
            continue;
        }
        if (s.infinite) {
            at_sky++;
            assert_true(s.pdf == assay_lights_pdf_infinite(world->lights, &receiver, s.direction));
            assert_true(vec3_dot(s.direction, normal) >= 0.0);
            continue;
        }
        const assay_ray ray = assay_ray_start(receiver.point, s.direction, INFINITY);
        assay_hit       hit;
        assert_true(assay_bvh_closest(world->bvh, &ray, &hit));
        const double pdf =
            assay_lights_pdf_triangle(world->lights, hit.triangle, hit.t, s.direction.y);
        if (fabs(pdf - s.pdf) > 1e-6 * s.pdf) {
            fail_msg("drawn with %.9g, asked %.9g", s.pdf, pdf);
        }
        on_tree++;
    }
    assert_true(on_tree > 300 && at_sky > 300);
    assay_world_destroy(world);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void densities_agree(void **state)
{
    (void)state;
    densities_agree_for(vec3(0, 1, 0));
    densities_agree_for(vec3(0, 0, 0));
}

/* Choice is proportional to power: pi A L of the squares (100 * 0.01 against 1 * 6). */
static void choice_is_by_power(void **state)
{
    (void)state;
    enum { N = 100000 };
    assay_context *context = measure_context(1);
    assay_scene   *scene   = two_squares(context, 0.0);
    assay_lights  *lights  = NULL;
    assert_int_equal(assay_lights_create(scene, &lights), ASSAY_OK);
    assay_random random = assay_random_start(2, ASSAY_STAGE_TEST, 0, 0);
    int          small  = 0;
    for (int i = 0; i < N; i++) {
        const double u = assay_random_next(&random), u1 = assay_random_next(&random),
                     u2               = assay_random_next(&random);
        const assay_receiver receiver = {vec3(0, 0, 0), vec3(0, 0, 0)};
        assay_light_sample   s;
        assert_true(assay_lights_sample(lights, &receiver, false, u, u1, u2, &s));
        small += s.radiance.r > 50.0;
    }
    const double   p = 1.0 / 7.0;
    const measured m = {(double)small / N, sqrt(p * (1.0 - p) / N)};
    measure_check("share of the small square", m, p, 0.0, 0.5);
    assay_lights_destroy(lights);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void no_light_at_all(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    scene_builder *b       = scene_builder_create();
    scene_builder_sphere(b, scene_builder_diffuse(b, 0.5, 0.0, false), vec3(0, 0, 0), 1.0, 1);
    assay_scene  *scene  = scene_builder_load(b, context, NULL);
    assay_lights *lights = NULL;
    assert_int_equal(assay_lights_create(scene, &lights), ASSAY_OK);
    const assay_receiver receiver = {vec3(0, 0, 0), vec3(0, 0, 0)};
    assay_light_sample   s;
    assert_false(assay_lights_sample(lights, &receiver, false, 0.5, 0.5, 0.5, &s));
    assert_false(assay_lights_sample(lights, &receiver, true, 0.5, 0.5, 0.5, &s));
    assert_true(assay_lights_pdf_infinite(lights, &receiver, vec3(0, 1, 0)) == 0.0);
    assert_true(assay_lights_pdf_triangle(lights, 0, 1.0, 1.0) == 0.0);
    assay_lights_destroy(lights);
    assay_lights_destroy(NULL);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampling_measures_irradiance),
        cmocka_unit_test(densities_agree),
        cmocka_unit_test(choice_is_by_power),
        cmocka_unit_test(no_light_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
