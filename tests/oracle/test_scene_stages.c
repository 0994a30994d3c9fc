/* test_scene_stages.c - stages that look at a scene: candidates of few digits that try every
 * triangle lie within the bounds; shifted, mirrored and transposed ones do not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "gather/hemisphere.h"
#include "scene/scene_data.h"
#include "support/measure.h"
#include "support/random_places.h"
#include "support/stage_case.h"

static const char BOX[] = "scenes/cornell-box/cornell-box.gltf";

enum {
    WIDTH   = 40,
    HEIGHT  = 30,
    PIXELS  = WIDTH * HEIGHT,
    M       = 4,
    N       = 12,
    CELLS   = M * N,
    RECORDS = 8
};

/* ---- a candidate ---- */

typedef struct {
    few_digits         f;
    const assay_scene *scene;
} candidate;

static void corner(const candidate *c, uint32_t triangle, int k, double out[3])
{
    const float *p =
        c->scene->positions + 3 * (size_t)c->scene->indices[3 * (size_t)triangle + (size_t)k];
    for (int i = 0; i < 3; i++) {
        out[i] = few(&c->f, p[i]);
    }
}

static double few_dot3(const candidate *c, const double *a, const double *b)
{
    const few_digits *f = &c->f;
    return few(f, few(f, few(f, a[0] * b[0]) + few(f, a[1] * b[1])) + few(f, a[2] * b[2]));
}

static void few_cross(const candidate *c, const double *a, const double *b, double *out)
{
    const few_digits *f = &c->f;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = few(f, few(f, a[j] * b[k]) - few(f, a[k] * b[j]));
    }
}

static void few_sub(const candidate *c, const double *a, const double *b, double *out)
{
    for (int i = 0; i < 3; i++) {
        out[i] = few(&c->f, a[i] - b[i]);
    }
}

static void few_normalize(const candidate *c, double *a)
{
    const double length = few(&c->f, sqrt(few_dot3(c, a, a)));
    for (int i = 0; i < 3; i++) {
        a[i] = few(&c->f, a[i] / length);
    }
}

/* [moeller97], without culling; distance or INFINITY. */
static double few_meet(const candidate *c, uint32_t triangle, const double *o, const double *d,
                       double *normal)
{
    const few_digits *f = &c->f;
    double            a[3], b[3], e[3], side1[3], side2[3], p[3], s[3], q[3];
    corner(c, triangle, 0, a);
    corner(c, triangle, 1, b);
    corner(c, triangle, 2, e);
    few_sub(c, b, a, side1);
    few_sub(c, e, a, side2);
    few_cross(c, d, side2, p);
    const double det = few_dot3(c, side1, p);
    if (det == 0.0) {
        return INFINITY;
    }
    few_sub(c, o, a, s);
    few_cross(c, s, side1, q);
    const double u = few(f, few_dot3(c, s, p) / det), v = few(f, few_dot3(c, d, q) / det);
    const double t = few(f, few_dot3(c, side2, q) / det);
    few_cross(c, side1, side2, normal);
    return u >= 0.0 && v >= 0.0 && few(f, u + v) <= 1.0 && t > 0.0 ? t : INFINITY;
}

static double few_closest(const candidate *c, const double *o, const double *d, double *normal)
{
    double nearest = INFINITY;
    for (uint32_t i = 0; i < c->scene->triangle_count; i++) {
        double       n[3];
        const double t = few_meet(c, i, o, d, n);
        if (t < nearest) {
            nearest = t;
            memcpy(normal, n, sizeof n);
        }
    }
    return nearest;
}

/* ---- visible ---- */

static void few_camera_ray(const candidate *c, const assay_camera *camera, double x, double y,
                           double *o, double *d)
{
    const few_digits *f    = &c->f;
    const double      high = few(f, camera->tan_half_yfov);
    const double      wide = few(f, high * few(f, (double)WIDTH / HEIGHT));
    const double      sx   = few(f, few(f, few(f, 2.0 * x / WIDTH) - 1.0) * wide);
    const double      sy   = few(f, few(f, 1.0 - few(f, 2.0 * y / HEIGHT)) * high);
    double            r[3], u[3], w[3], origin[3];
    memcpy(r, &camera->right, sizeof r);
    memcpy(u, &camera->up, sizeof u);
    memcpy(w, &camera->forward, sizeof w);
    memcpy(origin, &camera->position, sizeof origin);
    for (int i = 0; i < 3; i++) {
        const double a = few(f, sx * few(f, r[i])), b = few(f, sy * few(f, u[i]));
        d[i] = few(f, few(f, few(f, w[i]) + a) + b);
        o[i] = few(f, origin[i]);
    }
    few_normalize(c, d);
}

typedef struct {
    bound_use position, normal;
    size_t    unknown;
} visible_use;

static void begin_view(const stage_case *c, const assay_camera *camera)
{
    const struct {
        const char       *key;
        const assay_vec3 *v;
    } rows[] = {{"assay:camera.position", &camera->position},
                {"assay:camera.forward", &camera->forward},
                {"assay:camera.up", &camera->up},
                {"assay:camera.right", &camera->right}};
    char text[96];
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        snprintf(text, sizeof text, "%.17g %.17g %.17g", rows[i].v->x, rows[i].v->y, rows[i].v->z);
        stage_case_text(c, rows[i].key, text);
    }
    snprintf(text, sizeof text, "%.17g", camera->yfov);
    stage_case_text(c, "assay:camera.yfov", text);
    stage_case_text(c, "width", "40");
    stage_case_text(c, "height", "30");
}

/* shift: pixels, planted; turned: normals look away. */
static visible_use use_visible(assay_context *context, const assay_scene *scene, int precision,
                               int digits, double shift, bool turned)
{
    stage_case          c      = stage_case_begin(context);
    const assay_camera *camera = &scene->world_cameras[0];
    visible_use         use    = {{0.0, 0}, {0.0, 0}, 0};
    candidate           me     = {.scene = scene, .f = {.digits = digits}};
    begin_view(&c, camera);
    c.scene = scene;
    stage_case_run(&c, "visible", (assay_precision)precision);
    const stage_output *p = stage_case_output(&c, "gbuffer/position");
    const stage_output *n = stage_case_output(&c, "gbuffer/normal");
    for (size_t i = 0; i < PIXELS; i++) {
        double o[3], d[3], normal[3] = {0.0, 0.0, 1.0};
        few_camera_ray(&me, camera, (double)(i % WIDTH) + 0.5 + shift, (double)(i / WIDTH) + 0.5, o,
                       d);
        const double t = few_closest(&me, o, d, normal);
        if (isnan(p->bounds[3 * i])) {
            use.unknown++;
            continue;
        }
        few_normalize(&me, normal);
        const double side = (few_dot3(&me, normal, d) < 0.0) != turned ? 1.0 : -1.0;
        for (size_t k = 0; k < 3; k++) {
            const double x = isinf(t) ? 0.0 : few(&me.f, o[k] + few(&me.f, t * d[k]));
            bound_use_add(&use.position, x, p->values[3 * i + k], p->bounds[3 * i + k]);
            bound_use_add(&use.normal, isinf(t) ? 0.0 : side * normal[k], n->values[3 * i + k],
                          n->bounds[3 * i + k]);
        }
    }
    stage_case_end(&c);
    return use;
}

static void test_visible(void **state)
{
    assay_scene *scene = NULL;
    assert_int_equal(assay_scene_load(*state, BOX, NULL, &scene), ASSAY_OK);
    const visible_use right = use_visible(*state, scene, ASSAY_PRECISION_FLOAT, 24, 0.0, false);
    const visible_use exact = use_visible(*state, scene, ASSAY_PRECISION_DOUBLE, 53, 0.0, false);
    print_message("visible, 24 digits: position %.4f, normal %.4f of the bound, %zu of %d pixels "
                  "unknown\n",
                  right.position.most, right.normal.most, right.unknown, PIXELS);
    assert_int_equal(right.position.beyond + right.normal.beyond, 0);
    assert_int_equal(exact.position.beyond + exact.normal.beyond, 0);
    assert_true(right.unknown < PIXELS / 50 && exact.unknown <= right.unknown);
    assert_true(right.position.most > 0.002);
    /* A half sees edges two pixels off: there nothing is known, and elsewhere bounds hold. */
    const visible_use half = use_visible(*state, scene, ASSAY_PRECISION_HALF, 11, 0.0, false);
    print_message("visible, 11 digits: %zu pixels unknown\n", half.unknown);
    assert_int_equal(half.position.beyond + half.normal.beyond, 0);
    assert_true(half.unknown > PIXELS / 20 && half.unknown < PIXELS);
    const visible_use shifted = use_visible(*state, scene, ASSAY_PRECISION_FLOAT, 24, 0.5, false);
    const visible_use turned  = use_visible(*state, scene, ASSAY_PRECISION_FLOAT, 24, 0.0, true);
    assert_true(shifted.position.most > 1000.0);
    assert_true(turned.position.beyond == 0 && turned.normal.most > 1000.0);
    assay_scene_destroy(scene);
}

/* ---- gather ---- */

typedef struct {
    bound_use direction, distance;
    size_t    unknown;
} gather_use;

/* The stratified direction after [gautron06] 2.2.5, numbers from docs/determinism.md. */
static void few_direction(const candidate *c, uint64_t record, int cell, bool transposed, double *d)
{
    const few_digits *f      = &c->f;
    assay_random      random = assay_random_start(9, ASSAY_STAGE_GATHER, record, (uint64_t)cell);
    const double      u1     = few(f, assay_random_next(&random));
    const double      u2     = few(f, assay_random_next(&random));
    const int         j = transposed ? cell % M : cell / N, k = transposed ? cell / M : cell % N;
    const double      part = few(f, few(f, j + u1) / M);
    const double      sine = few(f, sqrt(part)), z = few(f, sqrt(few(f, 1.0 - part)));
    const double      turn = few(f, few(f, few(f, ASSAY_TWO_PI) * few(f, k + u2)) / N);
    d[0]                   = few(f, sine * few(f, assay_cos(turn)));
    d[1]                   = few(f, sine * few(f, assay_sin(turn)));
    d[2]                   = z;
}

static void few_to_world(const candidate *c, const double *frame, const double *local, double *out)
{
    for (int i = 0; i < 3; i++) {
        const double axes[3] = {few(&c->f, frame[i]), few(&c->f, frame[3 + i]),
                                few(&c->f, frame[6 + i])};
        out[i]               = few_dot3(c, axes, local);
    }
}

static gather_use use_gather(assay_context *context, const assay_scene *scene, int precision,
                             int digits, bool transposed)
{
    stage_case  c   = stage_case_begin(context);
    gather_use  use = {{0.0, 0}, {0.0, 0}, 0};
    candidate   me  = {.scene = scene, .f = {.digits = digits}};
    double      position[3 * RECORDS], normal[3 * RECORDS];
    const float y = scene->bounds_min.y > 0.0 ? (float)scene->bounds_min.y : 0.0f;
    for (size_t i = 0; i < RECORDS; i++) {
        const assay_vec3 p = vec3(0.05 + 0.06 * (double)i, y, 0.5 - 0.06 * (double)i);
        const assay_vec3 n = vec3(0.0, 1.0, 0.0);
        memcpy(position + 3 * i, &p, sizeof p);
        memcpy(normal + 3 * i, &n, sizeof n);
    }
    stage_case_text(&c, "theta_strata", "4");
    stage_case_text(&c, "phi_strata", "12");
    stage_case_text(&c, "seed", "9");
    stage_case_text(&c, "secondary", "direct");
    stage_case_table(&c, "records/position", "m", RECORDS, 3, position);
    stage_case_table(&c, "records/normal", "", RECORDS, 3, normal);
    c.scene = scene;
    stage_case_run(&c, "gather", (assay_precision)precision);
    const stage_output *way   = stage_case_output(&c, "gather/direction");
    const stage_output *far   = stage_case_output(&c, "gather/distance");
    const stage_output *frame = stage_case_output(&c, "gather/frame");
    for (size_t i = 0; i < RECORDS * CELLS; i++) {
        double       local[3], d[3], o[3], n[3];
        const size_t record = i / CELLS;
        few_direction(&me, record, (int)(i % CELLS), transposed, local);
        few_to_world(&me, frame->values + 9 * record, local, d);
        for (size_t k = 0; k < 3; k++) {
            bound_use_add(&use.direction, local[k], way->values[3 * i + k], way->bounds[3 * i + k]);
            o[k] = few(&me.f, position[3 * record + k] + (k == 1 ? 1e-5 : 0.0));
        }
        if (isnan(far->bounds[i])) {
            use.unknown++;
        } else {
            bound_use_add(&use.distance, few_closest(&me, o, d, n), far->values[i], far->bounds[i]);
        }
    }
    stage_case_end(&c);
    return use;
}

static void test_gather(void **state)
{
    assay_scene *scene = NULL;
    assert_int_equal(assay_scene_load(*state, BOX, NULL, &scene), ASSAY_OK);
    const gather_use right = use_gather(*state, scene, ASSAY_PRECISION_FLOAT, 24, false);
    print_message("gather, 24 digits: direction %.4f, distance %.4f of the bound, %zu of %d cells "
                  "unknown\n",
                  right.direction.most, right.distance.most, right.unknown, RECORDS * CELLS);
    assert_int_equal(right.direction.beyond + right.distance.beyond, 0);
    assert_true(right.unknown < RECORDS * CELLS / 20);
    assert_true(right.direction.most > 0.01 && right.distance.most > 0.01);
    const gather_use wrong = use_gather(*state, scene, ASSAY_PRECISION_FLOAT, 24, true);
    assert_true(wrong.direction.most > 1000.0 && wrong.distance.most > 1000.0);
    assay_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_visible, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_gather, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
