/* test_hemisphere_plane.c - what pixels of one plane weigh, and what follows from them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "core/numerics.h"
#include "core/random.h"
#include "gather/hemisphere_plane.h"
#include "math/quadrature.h"
#include "support/closed_form.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/seen.h"

static const double FOV = 2.2142974355881810; /* 2 atan 2 = 126.87 degrees */

static assay_hemisphere *plane_of(assay_context *context, int rows, int columns, double fov,
                                  assay_missing missing)
{
    const assay_hemisphere_layout layout = {.theta   = rows,
                                            .phi     = columns,
                                            .strata  = ASSAY_STRATA_PLANE,
                                            .fov     = fov,
                                            .missing = missing};
    assay_hemisphere             *h      = NULL;
    assert_int_equal(assay_hemisphere_create(context, &layout, &h), ASSAY_OK);
    return h;
}

static size_t count_of(const assay_hemisphere *h)
{
    return (size_t)h->layout.theta * (size_t)h->layout.phi;
}

static void fill_grey(assay_hemisphere *h, double radiance, double distance)
{
    for (size_t i = 0; i < count_of(h); i++) {
        h->cells[i].radiance = rgb_grey(radiance);
        h->cells[i].distance = distance;
    }
}

/* Radiance, distance and what is behind them, different in every cell. */
static void fill_random(assay_hemisphere *h)
{
    for (size_t i = 0; i < count_of(h); i++) {
        assay_random random    = assay_random_start(1, ASSAY_STAGE_TEST, i, 0);
        h->cells[i].radiance   = rgb(assay_random_next(&random), 0.0, 0.0);
        h->cells[i].radiance.g = assay_random_next(&random);
        h->cells[i].radiance.b = assay_random_next(&random);
        h->cells[i].distance   = 0.5 + assay_random_next(&random);
    }
}

/* ---- the furnace ---- */

/* Of the plane of 126.87 degrees: shares of solid angle and of irradiance in closed form, not 0.86
 * (ERRATA S2). */
static void plane_in_a_furnace(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    assay_hemisphere *h       = plane_of(context, 64, 64, FOV, ASSAY_MISSING_PLANE);
    fill_grey(h, 1.0, 3.0);
    double solid = 0.0;
    for (size_t i = 0; i < count_of(h); i++) {
        solid += h->plane->cell[i].solid;
    }
    const double share = 4.0 / ASSAY_PI * (2.0 / sqrt(5.0)) * assay_atan(2.0 / sqrt(5.0));
    const double e     = assay_hemisphere_irradiance(h).g / ASSAY_PI;
    assert_near(e, share, 1e-13);
    assert_near(solid, 4.0 * assay_asin(0.8), 1e-12);
    assert_near(solid / ASSAY_TWO_PI, 0.5903, 5e-5);
    assert_near(e / 0.86, 0.966, 5e-4);
    assay_hemisphere_destroy(context, h);
    assay_context_destroy(context);
}

/* The published pixel, A cos theta / d^2, and the published border (FORMULAS 8: 0.8311, 1.1727; a
 * solid angle of 2 pi). */
static void border_in_a_furnace(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    assay_hemisphere *h       = plane_of(context, 64, 64, FOV, ASSAY_MISSING_BORDER);
    double            plane = 0.0, solid = 0.0, corrected = 0.0;
    fill_grey(h, 1.0, 3.0);
    for (size_t i = 0; i < count_of(h); i++) {
        const double x = ((double)(i % 64) + 0.5) / 16.0 - 2.0;
        const double y = ((double)(i / 64) + 0.5) / 16.0 - 2.0, d2 = x * x + y * y + 1.0;
        plane += 1.0 / 256.0 / (d2 * d2) / ASSAY_PI;
        solid += h->plane->cell[i].solid;
    }
    for (int i = 0; i < 64; i++) {
        const double t0 = i / 16.0 - 2.0, t1 = t0 + 1.0 / 16.0, t = 0.5 * (t0 + t1);
        corrected += 4.0 * 0.5 / (5.0 + t * t) * (assay_atan(t1 / 2) - assay_atan(t0 / 2));
    }
    assert_near(plane, 0.8311, 5e-5);
    assert_near(plane + corrected / ASSAY_PI, 1.0, 5e-5);
    assert_near(assay_hemisphere_irradiance(h).r / ASSAY_PI, 1.1727, 5e-5);
    assert_near(solid / ASSAY_TWO_PI, 1.0, 5e-5);
    assay_hemisphere_destroy(context, h);
    assay_context_destroy(context);
}

/* What reaches down to the horizon is all of it, for any plane; the ratio is right here by
 * definition.  Nothing changes when the surface moves or turns. */
static void whole_in_a_furnace(void **state)
{
    (void)state;
    static const struct {
        int    rows, columns;
        double fov;
    } planes[] = {{64, 64, 2.2142974355881810}, {2, 2, 1.5}, {3, 7, 0.02}, {32, 5, 3.139}};
    assay_context *context = measure_context(1);
    for (size_t k = 0; k < 2 * sizeof planes / sizeof planes[0]; k++) {
        const assay_missing missing = k % 2 ? ASSAY_MISSING_RATIO : ASSAY_MISSING_BORDER_CORRECTED;
        assay_hemisphere   *h       = plane_of(context, planes[k / 2].rows, planes[k / 2].columns,
                                               planes[k / 2].fov, missing);
        assay_vec3          g[3], flux = vec3(0, 0, 0);
        double              solid = 0.0;
        fill_grey(h, 3.0, 2.0);
        for (size_t i = 0; i < count_of(h); i++) {
            solid += h->plane->cell[i].solid;
            flux = vec3_add(flux, h->plane->cell[i].flux);
            assert_true(h->plane->cell[i].solid > h->plane->cell[i].flux.z);
        }
        assert_near(assay_hemisphere_irradiance(h).b, 3.0 * ASSAY_PI, 1e-11);
        assert_near(solid, ASSAY_TWO_PI, 1e-11);
        assert_near(fabs(flux.x) + fabs(flux.y), 0.0, 1e-12);
        assay_hemisphere_rotation_gradient(h, g);
        assert_near(vec3_length(g[0]), 0.0, 1e-11);
        assay_hemisphere_translation_gradient(h, true, g);
        assert_true(g[1].x == 0.0 && g[1].y == 0.0 && g[1].z == 0.0);
        assert_near(assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_UNIFORM), 2.0, 1e-13);
        assert_near(assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_COSINE), 2.0, 1e-13);
        assert_true(assay_hemisphere_nearest(h) == 2.0);
        assay_hemisphere_destroy(context, h);
    }
    assay_context_destroy(context);
}

/* ---- cells one by one ---- */

/* Solid angle, integral of w, and the integral of each function over a cell by many nodes. */
enum { NODES = 24, ORDER = 5, COUNT = ORDER * ORDER };

typedef struct {
    double     solid;
    assay_vec3 flux;
    double     functions[COUNT];
} by_nodes;

static void add_node(by_nodes *sum, const assay_basis *basis, assay_vec3 w, double weight)
{
    double values[COUNT];
    assert_int_equal(assay_basis_evaluate(basis, w, values), ASSAY_OK);
    sum->solid += weight;
    sum->flux = vec3_mad(sum->flux, weight, w);
    for (int i = 0; i < COUNT; i++) {
        sum->functions[i] += weight * values[i];
    }
}

/* The pixel's own: dx dy / d^3. */
static void add_pixel(by_nodes *sum, const assay_basis *basis, double x0, double x1, double y0,
                      double y1)
{
    double x[NODES], wx[NODES], y[NODES], wy[NODES];
    assay_gauss_legendre_on(x0, x1, NODES, x, wx);
    assay_gauss_legendre_on(y0, y1, NODES, y, wy);
    for (int k = 0; k < NODES * NODES; k++) {
        const int        i = k % NODES, j = k / NODES;
        const assay_vec3 at = vec3(x[i], y[j], 1.0);
        const double     d  = vec3_length(at);
        add_node(sum, basis, vec3_scale(at, 1.0 / d), wx[i] * wy[j] / (d * d * d));
    }
}

/* Beyond the edge from p to q (counter-clockwise): in azimuth and the root of z. */
static void add_beyond(by_nodes *sum, const assay_basis *basis, double px, double py, double qx,
                       double qy)
{
    const double from = assay_atan2(py, px);
    double       turn = assay_atan2(qy, qx) - from, phi[NODES], wphi[NODES], s[NODES], ws[NODES];
    turn += turn < 0.0 ? ASSAY_TWO_PI : 0.0;
    assay_gauss_legendre_on(0.0, 1.0, NODES, phi, wphi);
    for (int i = 0; i < NODES; i++) {
        const double c = assay_cos(from + turn * phi[i]), sine = assay_sin(from + turn * phi[i]);
        /* Where the ray of this azimuth crosses the edge's line. */
        const double r = (px * qy - py * qx) / (c * (qy - py) - sine * (qx - px));
        assay_gauss_legendre_on(0.0, sqrt(sqrt(1.0 / (1.0 + r * r))), NODES, s, ws);
        for (int j = 0; j < NODES; j++) {
            const double z = s[j] * s[j], out = sqrt(1.0 - z * z);
            add_node(sum, basis, vec3(out * c, out * sine, z), turn * wphi[i] * 2.0 * s[j] * ws[j]);
        }
    }
}

static by_nodes integrate(const assay_hemisphere *h, const assay_basis *basis, int j, int k)
{
    const int    rows = h->layout.theta, columns = h->layout.phi;
    const double half = assay_tan(0.5 * h->layout.fov);
    const double x0 = half * (2.0 * k / columns - 1.0), x1 = half * (2.0 * (k + 1) / columns - 1.0);
    const double y0 = half * (2.0 * j / rows - 1.0), y1 = half * (2.0 * (j + 1) / rows - 1.0);
    by_nodes     sum = {0};
    add_pixel(&sum, basis, x0, x1, y0, y1);
    if (k == columns - 1) {
        add_beyond(&sum, basis, x1, y0, x1, y1);
    }
    if (j == rows - 1) {
        add_beyond(&sum, basis, x1, y1, x0, y1);
    }
    if (k == 0) {
        add_beyond(&sum, basis, x0, y1, x0, y0);
    }
    if (j == 0) {
        add_beyond(&sum, basis, x0, y0, x1, y0);
    }
    return sum;
}

static assay_basis *hsh_of(assay_context *context, int order)
{
    assay_basis *basis = NULL;
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_HSH, order, ASSAY_CONVENTION_THESIS, &basis),
        ASSAY_OK);
    return basis;
}

/* Every cell of a small plane, also its corners, against many nodes. */
static void cells_against_quadrature(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    assay_basis      *basis   = hsh_of(context, ORDER);
    assay_hemisphere *h       = plane_of(context, 12, 21, FOV, ASSAY_MISSING_BORDER_CORRECTED);
    for (int i = 0; i < 12 * 21; i++) {
        const by_nodes    exact = integrate(h, basis, i / 21, i % 21);
        const plane_cell *cell  = &h->plane->cell[i];
        double            c[3 * COUNT];
        assert_near(cell->solid, exact.solid, 1e-13);
        assert_near(vec3_length(vec3_sub(cell->flux, exact.flux)), 0.0, 1e-13);
        fill_grey(h, 0.0, 1.0);
        h->cells[i].radiance = rgb(1.0, 2.0, 4.0);
        assert_int_equal(assay_hemisphere_project(h, context, basis, c), ASSAY_OK);
        for (int f = 0; f < COUNT; f++) {
            /* Two nodes a side of a pixel. */
            assert_near(c[f], exact.functions[f], 5e-4);
            assert_near(c[2 * COUNT + f], 4.0 * c[f], 1e-13);
        }
    }
    assay_hemisphere_destroy(context, h);
    assay_basis_destroy(basis);
    assay_context_destroy(context);
}

/* A constant has one coefficient, up to the rule over 64 x 64 pixels. */
static void constant_has_one_coefficient(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    assay_basis      *basis   = hsh_of(context, 10);
    assay_hemisphere *h       = plane_of(context, 64, 64, FOV, ASSAY_MISSING_BORDER_CORRECTED);
    static double     c[300];
    static assay_vec3 g[300];
    fill_grey(h, 1.0, 2.0);
    assert_int_equal(assay_hemisphere_project(h, context, basis, c), ASSAY_OK);
    assert_int_equal(assay_hemisphere_project_gradient(h, context, basis, ASSAY_GRADIENT_WALLS, g),
                     ASSAY_OK);
    assert_near(c[0], sqrt(ASSAY_TWO_PI), 1e-7);
    for (int i = 1; i < 100; i++) {
        assert_near(c[i], 0.0, 1e-7);
        assert_true(g[i].x == 0.0 && g[i].y == 0.0 && g[i].z == 0.0);
    }
    assay_hemisphere_destroy(context, h);
    assay_basis_destroy(basis);
    assay_context_destroy(context);
}

/* The cosine is sqrt(2 pi) / 2 (H_0 + H_2 / sqrt 3): so irradiance and its translational gradient
 * follow from coefficients and theirs, but where irradiance is raised by a ratio of its own. */
static void coefficients_hold_irradiance(void **state)
{
    (void)state;
    static const assay_missing ways[]  = {ASSAY_MISSING_PLANE, ASSAY_MISSING_BORDER,
                                          ASSAY_MISSING_BORDER_CORRECTED};
    assay_context             *context = measure_context(1);
    assay_basis               *basis   = hsh_of(context, 2);
    const double               f0 = 0.5 * sqrt(ASSAY_TWO_PI), f2 = f0 / sqrt(3.0);
    for (int k = 0; k < 3; k++) {
        assay_hemisphere *h = plane_of(context, 48, 40, FOV, ways[k]);
        double            c[12];
        assay_vec3        g[12], t[3];
        fill_random(h);
        assert_int_equal(assay_hemisphere_project(h, context, basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, context, basis, ASSAY_GRADIENT_WALLS, g),
            ASSAY_OK);
        assay_hemisphere_translation_gradient(h, true, t);
        const assay_rgb e = assay_hemisphere_irradiance(h);
        assert_near(f0 * c[0] + f2 * c[2], e.r, k == 1 ? 1e-13 : 1e-7);
        assert_near(f0 * c[8] + f2 * c[10], e.b, k == 1 ? 1e-13 : 1e-7);
        const assay_vec3 green = vec3_mad(vec3_scale(g[4], f0), f2, g[6]);
        assert_near(vec3_length(vec3_sub(green, t[1])), 0.0, 1e-7);
        assert_true(vec3_length(t[1]) > 1e-3);
        assay_hemisphere_destroy(context, h);
    }
    assay_basis_destroy(basis);
    assay_context_destroy(context);
}

/* ---- scenes in closed form ---- */

static void look(const seen_scene *scene, assay_hemisphere *h)
{
    for (size_t i = 0; i < count_of(h); i++) {
        h->cells[i] = seen_cell(scene, h->cells[i].direction);
    }
}

static double off(assay_vec3 a, assay_vec3 exact)
{
    return vec3_length(vec3_sub(a, exact)) / vec3_length(exact);
}

/* Rectangles within the plane's view: irradiance, both gradients, with each way of dealing with
 * what is missing, for nothing of it is bright.  The ratio raises all by its own. */
static void rectangles_in_view(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    for (int k = 0; k < 8; k++) {
        const seen_object quad =
            k < 4 ? seen_quad(vec3(0.1, -0.2, 1.3), vec3(0.5, 0.1, 0.1), vec3(-0.1, 0.4, -0.1), 2.0)
                  : seen_quad(vec3(1.2, 0.6, 1.4), vec3(0.1, 0.5, 0.2), vec3(-0.4, 0.1, 0.2), 2.0);
        const seen_scene  scene = seen_from_origin(&quad, 1);
        const assay_vec3  p = vec3(0, 0, 0), n = vec3(0, 0, 1);
        assay_hemisphere *h = plane_of(context, 160, 160, FOV, (assay_missing)(k % 4));
        assay_vec3        g[3], t[3];
        look(&scene, h);
        assay_hemisphere_rotation_gradient(h, g);
        assay_hemisphere_translation_gradient(h, false, t);
        assert_true(t[2].z == 0.0);
        const assay_vec3 tangential = t[2];
        assay_hemisphere_translation_gradient(h, true, t);
        assert_true(t[2].x == tangential.x && t[2].y == tangential.y && t[2].z != 0.0);
        const double raise = h->plane->raise_flux;
        const double e     = 2.0 * (double)closed_polygon(quad.vertices, 4, p, n);
        const double eg =
            off(vec3_scale(g[0], 0.5 / raise), closed_polygon_rotation(quad.vertices, 4, p, n));
        const double et =
            off(vec3_scale(t[2], 0.5 / raise), closed_polygon_gradient(quad.vertices, 4, p, n));
        const double ee = fabs(assay_hemisphere_irradiance(h).r / raise / e - 1.0);
        print_message("rectangle %d, way %d: E %.4f, g %.4f, t %.4f\n", k / 4, k % 4, ee, eg, et);
        assert_true(ee < 0.01 && eg < 0.03 && et < 0.03);
        assay_hemisphere_destroy(context, h);
    }
    assay_context_destroy(context);
}

/* What only the missing directions hold: a ring of walls all around, of which rim pixels see the
 * upper part; their upper edges are on borders of pixels.  The corrected border gives the light of
 * the whole, the plane what it sees of it. */
static void walls_beyond_the_view(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    seen_object    walls[4];
    for (int i = 0; i < 4; i++) {
        const assay_vec3 out   = hemisphere_plane_turn(vec3(1, 0, 0), i);
        const assay_vec3 along = hemisphere_plane_turn(vec3(0, 1, 0), i);
        walls[i]               = seen_quad(out, along, vec3(0, 0, 4.0 / 7.0), i == 0 ? 4.0 : 1.0);
    }
    const seen_scene scene = seen_from_origin(walls, 4);
    double           e     = 0.0;
    assay_vec3       g     = vec3(0, 0, 0);
    for (int i = 0; i < 4; i++) {
        const double l = walls[i].radiance.r;
        e += l * (double)closed_polygon(walls[i].vertices, 4, vec3(0, 0, 0), vec3(0, 0, 1));
        g = vec3_mad(g, l,
                     closed_polygon_rotation(walls[i].vertices, 4, vec3(0, 0, 0), vec3(0, 0, 1)));
    }
    assay_hemisphere *whole = plane_of(context, 128, 128, FOV, ASSAY_MISSING_BORDER_CORRECTED);
    assay_hemisphere *plane = plane_of(context, 128, 128, FOV, ASSAY_MISSING_PLANE);
    assay_vec3        turn[3];
    look(&scene, whole);
    look(&scene, plane);
    assay_hemisphere_rotation_gradient(whole, turn);
    print_message("walls: E %.4f of it, without the border %.4f; g off by %.4f\n",
                  assay_hemisphere_irradiance(whole).r / e,
                  assay_hemisphere_irradiance(plane).r / e, off(turn[0], g));
    assert_near(assay_hemisphere_irradiance(whole).r / e, 1.0, 0.01);
    assert_true(off(turn[0], g) < 0.02);
    assert_true(assay_hemisphere_irradiance(plane).r / e < 0.5);
    assay_hemisphere_destroy(context, whole);
    assay_hemisphere_destroy(context, plane);
    assay_context_destroy(context);
}

/* Beyond the plane, too, borders between cells move: what the point sees of two half-spaces of
 * light is an edge that runs to the horizon.  An upright half plane x = 1, y > 0 and another, y <
 * 0: the truth by differences of the same cells' closed forms. */
static void edges_beyond_the_view(void **state)
{
    (void)state;
    assay_context    *context  = measure_context(1);
    const seen_object walls[2] = {
        seen_quad(vec3(1, 20.0, 0), vec3(0, 20, 0), vec3(0, 0, 20), 1.0),
        seen_quad(vec3(1, -20.0, 0), vec3(0, 20, 0), vec3(0, 0, 20), 3.0)};
    const seen_scene  scene = seen_from_origin(walls, 2);
    assay_hemisphere *h     = plane_of(context, 128, 128, FOV, ASSAY_MISSING_BORDER_CORRECTED);
    const assay_vec3  p = vec3(0, 0, 0), n = vec3(0, 0, 1);
    assay_vec3        t[3];
    look(&scene, h);
    assay_hemisphere_translation_gradient(h, false, t);
    const assay_vec3 a     = closed_polygon_gradient(walls[0].vertices, 4, p, n);
    const assay_vec3 b     = closed_polygon_gradient(walls[1].vertices, 4, p, n);
    const double     along = a.y + 3.0 * b.y;
    print_message("edge to the horizon: dE/dy %.5f, exactly %.5f\n", t[0].y, along);
    assert_near(t[0].y / along, 1.0, 0.03);
    assay_hemisphere_destroy(context, h);
    assay_context_destroy(context);
}

/* ---- refusals ---- */

static void refuses(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    static const struct {
        double        fov;
        assay_missing missing;
    } bad[] = {{0.0, ASSAY_MISSING_PLANE}, {3.2, ASSAY_MISSING_PLANE}, {-1.0, ASSAY_MISSING_PLANE},
               {NAN, ASSAY_MISSING_PLANE}, {2.0, (assay_missing)4},    {2.0, (assay_missing)-1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const assay_hemisphere_layout layout = {.theta   = 8,
                                                .phi     = 8,
                                                .strata  = ASSAY_STRATA_PLANE,
                                                .fov     = bad[i].fov,
                                                .missing = bad[i].missing};
        assay_hemisphere             *h      = NULL;
        assert_int_equal(assay_hemisphere_create(context, &layout, &h), ASSAY_ERR_ARGUMENT);
        assert_null(h);
    }
    assay_basis      *basis = hsh_of(context, 2);
    assay_hemisphere *h     = plane_of(context, 2, 2, FOV, ASSAY_MISSING_PLANE);
    assay_vec3        g[12];
    assert_int_equal(assay_hemisphere_project_gradient(h, context, basis, ASSAY_GRADIENT_POINTS, g),
                     ASSAY_ERR_ARGUMENT);
    assay_hemisphere_destroy(context, h);
    assay_basis_destroy(basis);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_in_a_furnace),
        cmocka_unit_test(border_in_a_furnace),
        cmocka_unit_test(whole_in_a_furnace),
        cmocka_unit_test(cells_against_quadrature),
        cmocka_unit_test(constant_has_one_coefficient),
        cmocka_unit_test(coefficients_hold_irradiance),
        cmocka_unit_test(rectangles_in_view),
        cmocka_unit_test(walls_beyond_the_view),
        cmocka_unit_test(edges_beyond_the_view),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
