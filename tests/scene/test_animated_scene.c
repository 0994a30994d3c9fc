/* test_animated_scene.c - scenes/animated moves as its README says: every vertex, at many times. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "../support/own_gltf.h"
#include "scene/scene_data.h"

/* m; positions are floats of up to 4 m, and so are the keys of the turns */
#define TOLERANCE 1e-6

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static assay_vec3 spinner(assay_vec3 p, double t)
{
    const double a = 0.5 * acos(-1.0) * t;
    return vec3(-3.0 + cos(a) * p.x + sin(a) * p.z, 0.5 + p.y, -sin(a) * p.x + cos(a) * p.z);
}

static assay_vec3 stepper(assay_vec3 p, double t)
{
    const double height = t < 1.0 ? 0.25 : t < 2.0 ? 0.75 : t < 3.0 ? 1.25 : 0.25;
    return vec3(p.x - 1.5, p.y + height, p.z);
}

static assay_vec3 jumper(assay_vec3 p, double t)
{
    const double s = t < 2.0 ? t : t - 2.0;
    return vec3(p.x, p.y + 0.25 + 2.0 * s - s * s, p.z);
}

static assay_vec3 grower(assay_vec3 p, double t)
{
    const double w = t < 2.0 ? t / 2.0 : (4.0 - t) / 2.0;
    return vec3(p.x + 1.5, p.y > 0.25 ? p.y + 0.5 * w : p.y, p.z);
}

static assay_vec3 bender(assay_vec3 p, double t)
{
    const double a = 0.25 * acos(-1.0) * (t < 2.0 ? t : 4.0 - t);
    const double w = clamp(2.0 * (p.y - 0.5), 0.0, 1.0), y = p.y - 0.75;
    return vec3(3.0 + (1.0 - w) * p.x + w * (cos(a) * p.x - sin(a) * y),
                (1.0 - w) * p.y + w * (0.75 + sin(a) * p.x + cos(a) * y), p.z);
}

typedef assay_vec3 (*motion)(assay_vec3 p, double t);

static const struct {
    const char *name;
    motion      moved;
} parts[5] = {{"spinner", spinner},
              {"stepper", stepper},
              {"jumper", jumper},
              {"grower", grower},
              {"bender", bender}};

/* Largest distance (m) of any vertex of a part from where a motion puts it. */
static double largest_error(const assay_scene *scene, const own_mesh *rest, const char *name,
                            motion moved, double t)
{
    double worst = -1.0;
    for (uint32_t s = 0; s < scene->shape_count; s++) {
        const assay_shape *const shape = &scene->shapes[s];
        if (strcmp(scene->meshes[shape->mesh].name, name) != 0) {
            continue;
        }
        assert_int_equal(shape->vertex_count, rest->vertex_count);
        for (uint32_t v = 0; v < shape->vertex_count; v++) {
            const float *const r        = rest->positions + 3 * v;
            const float *const p        = scene->positions + 3 * (size_t)(shape->first_vertex + v);
            const assay_vec3   expected = moved(vec3((double)r[0], (double)r[1], (double)r[2]), t);
            const double       error =
                vec3_length(vec3_sub(vec3((double)p[0], (double)p[1], (double)p[2]), expected));
            worst = error > worst ? error : worst;
        }
    }
    assert_true(worst >= 0.0);
    return worst;
}

static assay_scene *load(assay_context **context)
{
    assay_scene *scene;
    assert_int_equal(assay_context_create(NULL, context), ASSAY_OK);
    assert_int_equal(assay_scene_load(*context, "scenes/animated/animated.gltf", NULL, &scene),
                     ASSAY_OK);
    assert_true(assay_scene_describe(scene).duration == 4.0);
    return scene;
}

static void every_part_follows_its_formula(void **state)
{
    (void)state;
    assay_context     *context;
    assay_scene *const scene = load(&context);
    own_gltf           own   = own_gltf_read("scenes", "animated");
    for (int k = -2; k <= 70; k++) {
        const double t = k / 16.0 + (k % 3 ? 0.0 : 0.01); /* before 0 and past 4: the ends hold */
        const double held = clamp(t, 0.0, 4.0);
        assert_int_equal(assay_scene_set_time(scene, t), ASSAY_OK);
        for (int i = 0; i < 5; i++) {
            const double error = largest_error(scene, own_gltf_mesh(&own, parts[i].name),
                                               parts[i].name, parts[i].moved, held);
            if (!(error < TOLERANCE)) {
                fail_msg("%s at %g s: off by %g m", parts[i].name, t, error);
            }
        }
    }
    own_gltf_release(&own);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* The check must see a motion that is late by 30 ms, or another part's. */
static void wrong_motions_are_noticed(void **state)
{
    (void)state;
    assay_context     *context;
    assay_scene *const scene = load(&context);
    own_gltf           own   = own_gltf_read("scenes", "animated");
    assert_int_equal(assay_scene_set_time(scene, 0.98), ASSAY_OK);
    for (int i = 0; i < 5; i++) {
        const own_mesh *const rest = own_gltf_mesh(&own, parts[i].name);
        const char *const     name = parts[i].name;
        assert_true(largest_error(scene, rest, name, parts[i].moved, 1.01) > 1e-5);
        assert_true(largest_error(scene, rest, name, parts[(i + 1) % 5].moved, 0.98) > 0.1);
    }
    own_gltf_release(&own);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_follows_its_formula),
        cmocka_unit_test(wrong_motions_are_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
