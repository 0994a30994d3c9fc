/* test_splat_bounds.c - boxes about spheres: nothing that is seen is left out, and little more is
 * in. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "core/random.h"
#include "math/frame.h"
#include "record/splat_bounds.h"
#include "support/random_places.h"
#include "trace/camera_ray.h"

enum { WIDTH = 120, HEIGHT = 90 };

/* Far from the origin at times, so that subtraction from the eye rounds. */
static assay_camera random_camera(assay_random *random)
{
    const double       far  = assay_random_next(random) < 0.3 ? 1000.0 : 1.0;
    const assay_vec3   n    = random_unit(random);
    const assay_frame3 f    = frame3_from_z(n);
    const double       half = random_in(random, 0.05, 1.5);
    const double       size = random_in(random, 0.2, 3.0);
    return (assay_camera){.position      = random_box(random, -far, far),
                          .right         = f.x,
                          .up            = f.y,
                          .forward       = vec3_negate(f.z),
                          .orthographic  = assay_random_next(random) < 0.3,
                          .xmag          = size,
                          .ymag          = size,
                          .tan_half_yfov = half};
}

/* A point that pixel (x, y) sees, somewhere within the pixel, or at its centre. */
static assay_vec3 seen_point(const assay_camera *camera, int x, int y, assay_random *random,
                             bool centre)
{
    const double depth = assay_exp(random_in(random, -4.0, 4.0));
    const double u     = centre ? 0.5 : assay_random_next(random);
    const double v     = centre ? 0.5 : assay_random_next(random);
    assay_vec3   origin, direction;
    assay_camera_ray(camera, x + u, y + v, WIDTH, HEIGHT, &origin, &direction);
    return vec3_mad(origin, depth, direction);
}

/* A sphere that holds the point: seen from it, the centre is anywhere within the radius, as often
 * as not exactly on it; radii from far below the distance to far above. */
static assay_vec3 random_centre(assay_random *random, assay_vec3 point, double distance,
                                double *radius_out)
{
    const double radius = distance * assay_exp(random_in(random, -6.0, 2.0));
    const double part   = assay_random_next(random) < 0.7 ? 1.0 : assay_random_next(random);
    *radius_out         = radius;
    return vec3_mad(point, radius * part, random_unit(random));
}

/* A million of spheres and points in them, for centres of pixels and for places within pixels. */
static void holds_what_is_seen(void **state)
{
    enum { CAMERAS = 500, POINTS = 2000 };
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, 0, 0);
    uint64_t     around = 0, behind = 0, lost = 0;
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        const assay_camera camera = random_camera(&random);
        const bool         centre = i % 2 == 0;
        assay_splat_view   view   = assay_splat_view_of(&camera, WIDTH, HEIGHT);
        for (int k = 0; k < POINTS; k++) {
            const int        x = (int)(WIDTH * assay_random_next(&random));
            const int        y = (int)(HEIGHT * assay_random_next(&random));
            const assay_vec3 p = seen_point(&camera, x, y, &random, centre);
            double           radius;
            const assay_vec3 c =
                random_centre(&random, p, vec3_length(vec3_sub(p, camera.position)), &radius);
            /* Rounded to outside. */
            if (!(vec3_length(vec3_sub(p, c)) <= radius)) {
                continue;
            }
            const double depth = assay_camera_depth(&camera, c);
            around += vec3_length(vec3_sub(camera.position, c)) < radius;
            behind += depth < 0.0;
            view.stray = assay_splat_stray(&view, x, y, p);
            assert_true(view.stray <= (centre ? 1e-6 : 0.5 + 1e-6));
            const assay_splat_box box = assay_splat_bounds(&view, c, radius);
            assert_true(box.x0 >= 0 && box.y0 >= 0 && box.x1 <= WIDTH && box.y1 <= HEIGHT);
            assert_true(assay_splat_box_holds(&box, x, y));
            const assay_splat_box square = assay_splat_billboard(&view, c, radius);
            lost += !assay_splat_box_holds(&square, x, y);
        }
    }
    print_message("#| spheres around the eye %llu, behind it %llu; billboards lose %llu\n",
                  (unsigned long long)around, (unsigned long long)behind, (unsigned long long)lost);
    assert_true(around > 10000 && behind > 10000);
    /* Mutant, and [class08]: a box at the depth of the centre. */
    assert_true(lost > 10000);
}

/* Whether the plane through the eye and the centres of the pixels of a column (or, turned, a row)
 * meets the sphere: by its distance from the centre. */
static bool plane_meets(const assay_splat_view *view, double s, double across, double depth,
                        double radius)
{
    return view->orthographic ? fabs(across - s) <= radius
                              : fabs(across - s * depth) <= radius * sqrt(1.0 + s * s);
}

/* Spheres wholly in front: their first and last columns and rows are met, those beside not. */
static void is_tight(void **state)
{
    assay_random random = assay_random_start(2, ASSAY_STAGE_TEST, 0, 0);
    int          inside = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const assay_camera     camera = random_camera(&random);
        const assay_splat_view view   = assay_splat_view_of(&camera, WIDTH, HEIGHT);
        const double           depth  = assay_exp(random_in(&random, -3.0, 3.0));
        const double           radius = depth * random_in(&random, 0.0, 0.9);
        const double           right  = depth * random_in(&random, -2.0, 2.0);
        const double           up     = depth * random_in(&random, -2.0, 2.0);
        const assay_vec3       c =
            vec3_mad(vec3_mad(vec3_mad(camera.position, right, camera.right), up, camera.up), depth,
                     camera.forward);
        const assay_splat_box box      = assay_splat_bounds(&view, c, radius);
        const int             edges[8] = {box.x0, box.x1 - 1, box.x0 - 1, box.x1,
                                          box.y0, box.y1 - 1, box.y0 - 1, box.y1};
        if (box.x0 == 0 || box.y0 == 0 || box.x1 == WIDTH || box.y1 == HEIGHT || box.x1 <= box.x0 ||
            box.y1 <= box.y0) {
            continue;
        }
        inside++;
        for (int e = 0; e < 8; e++) {
            const double s = e < 4 ? view.half_width * (2.0 * (edges[e] + 0.5) / WIDTH - 1.0)
                                   : view.half_height * (1.0 - 2.0 * (edges[e] + 0.5) / HEIGHT);
            assert_true(plane_meets(&view, s, e < 4 ? right : up, depth, radius) == (e % 4 < 2));
        }
    }
    assert_true(inside > 1000);
}

/* The outline of ERRATA's figures: r / sqrt(d^2 - r^2) on the axis, against r / d. */
static void outline_on_the_axis(void **state)
{
    (void)state;
    const assay_camera camera = {
        .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .tan_half_yfov = 2.0};
    const assay_splat_view view     = assay_splat_view_of(&camera, 4000, 4000);
    const double           ratio[3] = {0.3, 0.5, 0.8}, larger[3] = {1.0483, 1.1547, 1.6667};
    for (int i = 0; i < 3; i++) {
        const assay_splat_box box    = assay_splat_bounds(&view, vec3(0, 0, -2), 2.0 * ratio[i]);
        const assay_splat_box square = assay_splat_billboard(&view, vec3(0, 0, -2), 2.0 * ratio[i]);
        const double          r      = ratio[i];
        /* A pixel is 1/1000 of the distance: of 2 r, 1/600 at the most. */
        assert_true(fabs((box.x1 - box.x0) / 2000.0 - r / sqrt(1.0 - r * r)) <= 1e-3);
        assert_true(fabs((square.x1 - square.x0) / 2000.0 - r) <= 1e-3);
        assert_true(fabs((box.y1 - box.y0) / (double)(square.y1 - square.y0) - larger[i]) <= 6e-3);
    }
}

static bool is_all(assay_splat_box box)
{
    return box.x0 == 0 && box.y0 == 0 && box.x1 == WIDTH && box.y1 == HEIGHT;
}

/* The whole image where nothing better is known; nothing behind; half where the sphere passes the
 * eye. */
static void at_the_edges(void **state)
{
    (void)state;
    const assay_camera camera = {
        .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .tan_half_yfov = 1.0};
    assay_splat_view      view   = assay_splat_view_of(&camera, WIDTH, HEIGHT);
    const assay_splat_box behind = assay_splat_bounds(&view, vec3(0, 0, 2), 1.9);
    const assay_splat_box beside = assay_splat_bounds(&view, vec3(2, 0, 0), 1.9);
    const assay_splat_box above  = assay_splat_bounds(&view, vec3(0, 2, -0.1), 1.9);
    assert_true(behind.x0 >= behind.x1 || behind.y0 >= behind.y1);
    assert_true(is_all(assay_splat_bounds(&view, vec3(0, 0, 0.5), 0.6)));
    assert_true(is_all(assay_splat_bounds(&view, vec3(0, 0, -1), INFINITY)));
    assert_true(is_all(assay_splat_bounds(&view, vec3(NAN, 0, -1), 1.0)));
    assert_true(is_all(assay_splat_bounds(&view, vec3(0, 0, -1), 1e200)));
    assert_true(beside.x1 == WIDTH && beside.x0 > WIDTH / 2);
    assert_true(above.y0 == 0 && above.y1 < HEIGHT / 2 && above.x0 == 0 && above.x1 == WIDTH);
    view.stray = INFINITY;
    assert_true(is_all(assay_splat_bounds(&view, vec3(0, 0, -5), 0.1)));
    assert_true(isinf(assay_splat_stray(&view, 3, 3, vec3(0, 0, 1))));
    assert_true(isinf(assay_splat_stray(&view, 3, 3, vec3(NAN, 0, -1))));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_what_is_seen),
        cmocka_unit_test(is_tight),
        cmocka_unit_test(outline_on_the_axis),
        cmocka_unit_test(at_the_edges),
    };
    return cmocka_run_group_tests_name("splat_bounds", tests, NULL, NULL);
}
