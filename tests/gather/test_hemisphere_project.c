/* test_hemisphere_project.c - coefficients of radiance and their gradients against quadrature. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "core/numerics.h"
#include "math/quadrature.h"
#include "support/closed_form.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/seen.h"

enum { ORDER = 6, COUNT = ORDER * ORDER };

/* ---- scenes and their exact coefficients ---- */

/* Exact coefficients of the green channel of what is seen from the eye. */
typedef void (*coefficients)(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                             double *out);

/* Inside a sphere whose radiance is a smooth function of place. */
static seen_object room(void)
{
    seen_object o = seen_sphere(vec3(0, 0, 0), 1.0, 1.0);
    o.slope       = vec3(0.5, -0.3, 0.4);
    return o;
}

static void see(void *user, assay_vec3 direction, double *values_out)
{
    values_out[0] = seen_cell(user, direction).radiance.g;
}

/* By Gauss over directions: nodes that change nothing in 13 digits. */
static void room_coefficients(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                              double *out)
{
    const seen_object wall  = room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = eye;
    assert_int_equal(assay_basis_project(basis, context, see, &scene, 1, 40, 64, out), ASSAY_OK);
}

static const seen_object *hidden(void)
{
    static const seen_object objects[2] = {
        {.shape    = SEEN_POLYGON,
         .vertices = {{-1.2, -1.1, 2}, {1.6, -1.1, 2}, {1.6, 1.3, 2}, {-1.2, 1.3, 2}},
         .count    = 4,
         .radiance = {1, 1, 1}},
        {.shape    = SEEN_POLYGON,
         .vertices = {{0.0, -0.4, 0.75}, {0.6, -0.2, 0.85}, {0.5, 0.3, 0.85}, {-0.1, 0.1, 0.75}},
         .count    = 4}};
    return objects;
}

/* Adds `sign` times a parallelogram's coefficients, by Gauss over its area:
 * dw = cos xi dA / r^2 = n . q dA / |q|^3. */
static void add_area(const assay_basis *basis, const seen_object *o, assay_vec3 eye, double sign,
                     double *out)
{
    enum { NODES = 24 };
    double           x[NODES], w[NODES], values[COUNT];
    const assay_vec3 a = vec3_sub(o->vertices[1], o->vertices[0]);
    const assay_vec3 b = vec3_sub(o->vertices[3], o->vertices[0]);
    const assay_vec3 n = vec3_cross(a, b);
    assay_gauss_legendre_on(0.0, 1.0, NODES, x, w);
    for (int i = 0; i < NODES * NODES; i++) {
        const assay_vec3 q =
            vec3_sub(vec3_mad(vec3_mad(o->vertices[0], x[i % NODES], a), x[i / NODES], b), eye);
        const double r      = vec3_length(q);
        const double weight = w[i % NODES] * w[i / NODES] * fabs(vec3_dot(n, q)) / (r * r * r);
        assert_int_equal(assay_basis_evaluate(basis, vec3_scale(q, 1.0 / r), values), ASSAY_OK);
        for (int f = 0; f < COUNT; f++) {
            out[f] += sign * weight * values[f];
        }
    }
}

/* A lamp and something dark before it. */
static void hidden_coefficients(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                                double *out)
{
    (void)context;
    memset(out, 0, COUNT * sizeof *out);
    add_area(basis, &hidden()[0], eye, 1.0, out);
    add_area(basis, &hidden()[1], eye, -1.0, out);
}

/* By differences of fourth order: error some (h / distance)^4. */
static void differences(coefficients exact, const assay_basis *basis, assay_context *context,
                        assay_vec3 eye, assay_vec3 *out)
{
    const double h = 0.004;
    for (int axis = 0; axis < 3; axis++) {
        double at[4][COUNT];
        for (int i = 0; i < 4; i++) {
            const double s = (i < 2 ? i - 2 : i - 1) * h; /* -2, -1, 1, 2 */
            const double x = axis == 0 ? s : 0.0, y = axis == 1 ? s : 0.0;
            const double z = axis == 2 ? s : 0.0;
            exact(basis, context, vec3_add(eye, vec3(x, y, z)), at[i]);
        }
        for (int f = 0; f < COUNT; f++) {
            const double d = (8.0 * (at[2][f] - at[1][f]) - (at[3][f] - at[0][f])) / (12.0 * h);
            *(axis == 0 ? &out[f].x : axis == 1 ? &out[f].y : &out[f].z) = d;
        }
    }
}

/* ---- errors of whole vectors, relative ---- */

static double coefficient_error(const double *a, const double *exact, size_t count)
{
    double d = 0.0, e = 0.0;
    for (size_t f = 0; f < count; f++) {
        d += (a[f] - exact[f]) * (a[f] - exact[f]);
        e += exact[f] * exact[f];
    }
    return sqrt(d / e);
}

static double gradient_error(const assay_vec3 *a, const assay_vec3 *exact, bool tangential)
{
    double d = 0.0, e = 0.0;
    for (int f = 0; f < COUNT; f++) {
        assay_vec3 off = vec3_sub(a[f], exact[f]), all = exact[f];
        off.z = tangential ? 0.0 : off.z;
        all.z = tangential ? 0.0 : all.z;
        d += vec3_dot(off, off);
        e += vec3_dot(all, all);
    }
    return sqrt(d / e);
}

typedef struct {
    assay_context *context;
    assay_basis   *basis;
} bench;

static bench open_bench(assay_basis_kind kind)
{
    bench b = {measure_context(1), NULL};
    assert_int_equal(assay_basis_create(b.context, kind, ORDER, ASSAY_CONVENTION_THESIS, &b.basis),
                     ASSAY_OK);
    return b;
}

static void close_bench(bench *b)
{
    assay_basis_destroy(b->basis);
    assay_context_destroy(b->context);
}

/* ---- convergence ---- */

typedef struct {
    double value, points, points_flat, walls, walls_flat;
} project_errors;

static project_errors errors_at(const bench *b, const seen_scene *scene, coefficients exact, int m,
                                assay_strata strata)
{
    double            c[COUNT], found[3 * COUNT];
    assay_vec3        g[COUNT], points[3 * COUNT], walls[3 * COUNT];
    const int         n = (int)floor(ASSAY_PI * m + 0.5);
    assay_hemisphere *h = seen_hemisphere(b->context, scene, m, n, strata, false, 0);
    exact(b->basis, b->context, scene->eye, c);
    differences(exact, b->basis, b->context, scene->eye, g);
    assert_int_equal(assay_hemisphere_project(h, b->context, b->basis, found), ASSAY_OK);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b->context, b->basis, ASSAY_GRADIENT_POINTS, points),
        ASSAY_OK);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b->context, b->basis, ASSAY_GRADIENT_WALLS, walls),
        ASSAY_OK);
    assay_hemisphere_destroy(b->context, h);
    return (project_errors){
        coefficient_error(found + COUNT, c, COUNT), gradient_error(points + COUNT, g, false),
        gradient_error(points + COUNT, g, true), gradient_error(walls + COUNT, g, false),
        gradient_error(walls + COUNT, g, true)};
}

/* Largest errors that are accepted at M; 0: anything. */
typedef project_errors (*allowance)(assay_strata strata, int m);

static void check_below(double value, double allowed)
{
    assert_true(isfinite(value) && (allowed == 0.0 || value <= allowed));
}

static void converges(const char *name, const seen_scene *scene, coefficients exact,
                      allowance allowed)
{
    static const int M[] = {16, 64, 256};
    bench            b   = open_bench(ASSAY_BASIS_HSH);
    for (int i = 0; i < 6; i++) {
        const assay_strata   strata = i < 3 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        const project_errors e      = errors_at(&b, scene, exact, M[i % 3], strata);
        const project_errors most   = allowed(strata, M[i % 3]);
        print_message("#| %s, %s strata, M %3d: value %.5f; points %.5f, tangential %.5f; walls "
                      "%.5f, tangential %.5f\n",
                      name, i < 3 ? "uniform" : "cosine", M[i % 3], e.value, e.points,
                      e.points_flat, e.walls, e.walls_flat);
        check_below(e.value, most.value);
        check_below(e.points, most.points);
        check_below(e.points_flat, most.points_flat);
        check_below(e.walls, most.walls);
        check_below(e.walls_flat, most.walls_flat);
    }
    close_bench(&b);
}

/* Nothing has an edge here.  Midpoints err as M^-1.5 by the functions' roots at the horizon, cells
 * of constant radiance as 1 / M in the last of the cosine strata; borders taken at the nearer
 * distance as 1 / M; and what changes between the last stratum's middle and the horizon is not
 * seen, which weighs in the normal components alone: 1 / M, or M^-1/2 times a large number in
 * cosine strata, which are not fit for that. */
static project_errors room_allowance(assay_strata strata, int m)
{
    return strata == ASSAY_STRATA_UNIFORM
               ? (project_errors){2.0 * pow(m, -1.5), 3.0 / m, 2.0 * pow(m, -1.4), 3.0 / m, 0.5 / m}
               : (project_errors){0.5 / m, 0.0, 1.0 / m, 0.0, 1.0 / m};
}

static void smooth_room(void **state)
{
    (void)state;
    const seen_object wall  = room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = vec3(0.2, -0.15, 0.1);
    converges("a room", &scene, room_coefficients, room_allowance);
}

/* Edges: values as five standard deviations of cells that are cut by chance, walls as the distance
 * at the edge.  Uniform strata of M = 16 have their first border at 20 degrees, beyond half of what
 * hides the lamp. */
static project_errors hidden_allowance(assay_strata strata, int m)
{
    return strata == ASSAY_STRATA_UNIFORM && m == 16
               ? (project_errors){0}
               : (project_errors){10.0 * pow(m, -1.5), 0.0, 0.0, 3.0 / m, 3.0 / m};
}

/* Fixed points do not know that the nearer one hides the other: wrong by half and more at any M. */
static void behind_something(void **state)
{
    (void)state;
    const seen_scene scene = seen_from_origin(hidden(), 2);
    converges("a lamp behind something", &scene, hidden_coefficients, hidden_allowance);
    bench                b = open_bench(ASSAY_BASIS_HSH);
    const project_errors e = errors_at(&b, &scene, hidden_coefficients, 64, ASSAY_STRATA_UNIFORM);
    assert_true(e.points > 0.5 && e.points_flat > 0.5);
    close_bench(&b);
}

/* Every basis that is orthonormal on the hemisphere, in both strata. */
static void other_bases(void **state)
{
    (void)state;
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_ZERNIKE, ASSAY_BASIS_MAKHOTKIN_SQRT,
                                             ASSAY_BASIS_ESH};
    const seen_object             wall    = room();
    seen_scene                    scene   = seen_from_origin(&wall, 1);
    scene.eye                             = vec3(0.2, -0.15, 0.1);
    for (int i = 0; i < 6; i++) {
        const assay_strata strata = i < 3 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        double             c[COUNT], found[3 * COUNT];
        bench              b     = open_bench(kinds[i % 3]);
        const size_t       count = assay_basis_count(b.basis);
        assay_hemisphere  *h     = seen_hemisphere(b.context, &scene, 64, 201, strata, false, 0);
        room_coefficients(b.basis, b.context, scene.eye, c);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, found), ASSAY_OK);
        check_below(coefficient_error(found + count, c, count), room_allowance(strata, 64).value);
        assay_hemisphere_destroy(b.context, h);
        close_bench(&b);
    }
}

/* ---- irradiance, which is the product with the cosine ---- */

static void clamped_cosine(void *user, assay_vec3 direction, double *values_out)
{
    (void)user;
    values_out[0] = direction.z;
}

/* The cosine is a sum of two functions of HSH and of Zernike: sums over coefficients are those of
 * irradiance to rounding, jittered or not. */
static void contracts_to_irradiance(void **state)
{
    (void)state;
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_HSH, ASSAY_BASIS_ZERNIKE};
    const seen_scene              scene   = seen_from_origin(hidden(), 2);
    for (int i = 0; i < 8; i++) {
        double             cosine[COUNT], c[3 * COUNT];
        assay_vec3         g[3 * COUNT], t[3], sum = {0, 0, 0};
        bench              b      = open_bench(kinds[i % 2]);
        const size_t       count  = assay_basis_count(b.basis);
        const assay_strata strata = i & 2 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        assay_hemisphere  *h      = seen_hemisphere(b.context, &scene, 24, 75, strata, i >= 4, 11);
        assert_int_equal(
            assay_basis_project(b.basis, b.context, clamped_cosine, NULL, 1, 20, 40, cosine),
            ASSAY_OK);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_WALLS, g),
            ASSAY_OK);
        assay_hemisphere_translation_gradient(h, true, t);
        for (size_t f = 0; f < count; f++) {
            sum = vec3_mad(sum, cosine[f], g[2 * count + f]);
        }
        assert_near(assay_basis_dot(b.basis, cosine, c), assay_hemisphere_irradiance(h).r, 1e-13);
        assert_true(vec3_length(t[2]) > 0.1);
        assert_near(vec3_length(vec3_sub(sum, t[2])), 0.0, 1e-13);
        assay_hemisphere_destroy(b.context, h);
        close_bench(&b);
    }
}

/* A polygon that nothing hides is fixed points: contracted, the closed form in all components. */
static void points_of_a_polygon(void **state)
{
    (void)state;
    const seen_object quad =
        seen_quad(vec3(0.5, -0.3, 1.3), vec3(0.6, 0, -0.2), vec3(0, 0.7, 0), 1.0);
    const seen_scene scene = seen_from_origin(&quad, 1);
    const assay_vec3 exact =
        closed_polygon_gradient(quad.vertices, 4, vec3(0, 0, 0), vec3(0, 0, 1));
    bench b = open_bench(ASSAY_BASIS_HSH);
    for (int i = 0; i < 2; i++) {
        double            cosine[COUNT];
        assay_vec3        g[3 * COUNT], sum = {0, 0, 0};
        assay_hemisphere *h =
            seen_hemisphere(b.context, &scene, 64, 201, (assay_strata)i, false, 0);
        assert_int_equal(
            assay_basis_project(b.basis, b.context, clamped_cosine, NULL, 1, 20, 40, cosine),
            ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_POINTS, g),
            ASSAY_OK);
        for (int f = 0; f < COUNT; f++) {
            sum = vec3_mad(sum, cosine[f], g[f]);
        }
        assert_near(vec3_length(vec3_sub(sum, exact)), 0.0, 3.0 / 64 * vec3_length(exact));
        assay_hemisphere_destroy(b.context, h);
    }
    close_bench(&b);
}

/* ---- a furnace ---- */

/* One coefficient, sqrt(2 pi) L.  WALLS are 0 to the bit; POINTS cancel to the first order. */
static void furnace(void **state)
{
    (void)state;
    const seen_object wall  = seen_sphere(vec3(0.2, -0.1, -0.3), 1.0, 0.7);
    const seen_scene  scene = seen_from_origin(&wall, 1);
    bench             b     = open_bench(ASSAY_BASIS_HSH);
    for (int i = 0; i < 4; i++) {
        const assay_strata strata = i % 2 ? ASSAY_STRATA_COSINE : ASSAY_STRATA_UNIFORM;
        double             c[3 * COUNT];
        assay_vec3         walls[3 * COUNT], points[3 * COUNT];
        assay_hemisphere  *h = seen_hemisphere(b.context, &scene, 32, 101, strata, i >= 2, 2);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_WALLS, walls),
            ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_POINTS, points),
            ASSAY_OK);
        double sum = 0.0;
        for (int f = 0; f < 3 * COUNT; f++) {
            /* Cells of the cosine strata: exact.  Directions: midpoints, or noise, at most
             * L |H| (2 pi) / sqrt(3) / M / sqrt(M N) at a slope of 2 |H| a stratum's height. */
            const double exact = f % COUNT == 0 ? sqrt(2.0 * ASSAY_PI) * 0.7 : 0.0;
            assert_near(c[f], exact, strata == ASSAY_STRATA_COSINE ? 3e-14 : i < 2 ? 0.03 : 0.15);
            assert_true(walls[f].x == 0.0 && walls[f].y == 0.0 && walls[f].z == 0.0);
            sum += points[f].x * points[f].x + points[f].y * points[f].y;
        }
        print_message("#| furnace, %s strata%s, M 32: tangential gradient of points %.4f, not 0\n",
                      i % 2 ? "cosine" : "uniform", i < 2 ? "" : ", jittered", sqrt(sum / 3.0));
        assert_true(sqrt(sum / 3.0) < 2.0 / 32.0);
        assay_hemisphere_destroy(b.context, h);
    }
    close_bench(&b);
}

/* A channel has what its own radiance gives: powers of 2 scale without rounding. */
static void channels_are_apart(void **state)
{
    (void)state;
    seen_object wall       = room();
    wall.radiance          = rgb(0.5, 1.0, 4.0);
    const seen_scene scene = seen_from_origin(&wall, 1);
    bench            b     = open_bench(ASSAY_BASIS_HSH);
    for (int i = 0; i < 4; i++) {
        const assay_strata strata = i % 2 ? ASSAY_STRATA_COSINE : ASSAY_STRATA_UNIFORM;
        double             c[3 * COUNT];
        assay_vec3         g[3 * COUNT];
        assay_hemisphere  *h = seen_hemisphere(b.context, &scene, 6, 19, strata, true, 3);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(
                h, b.context, b.basis, i < 2 ? ASSAY_GRADIENT_WALLS : ASSAY_GRADIENT_POINTS, g),
            ASSAY_OK);
        for (int f = 0; f < COUNT; f++) {
            assert_true(c[f] == 0.5 * c[COUNT + f] && c[2 * COUNT + f] == 4.0 * c[COUNT + f]);
            assert_true(g[f].x == 0.5 * g[COUNT + f].x && g[f].y == 0.5 * g[COUNT + f].y);
            assert_true(g[2 * COUNT + f].y == 4.0 * g[COUNT + f].y &&
                        g[2 * COUNT + f].z == 4.0 * g[COUNT + f].z);
        }
        assay_hemisphere_destroy(b.context, h);
    }
    close_bench(&b);
}

/* ---- jittered cells ---- */

enum { RUNS = 300 };

/* Means over many jitters: values in uniform strata have no bias, in cosine strata that of cells of
 * constant radiance; gradients of walls that of the nearer distance. */
static void jittered_cells(void **state)
{
    (void)state;
    enum { M = 12, N = 38, NUMBERS = 3 * COUNT };
    static double     sum[NUMBERS], square[NUMBERS];
    const seen_object wall  = room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = vec3(0.2, -0.15, 0.1);
    bench      b            = open_bench(ASSAY_BASIS_HSH);
    double     c[COUNT], found[3 * COUNT];
    assay_vec3 g[COUNT], walls[3 * COUNT];
    room_coefficients(b.basis, b.context, scene.eye, c);
    differences(room_coefficients, b.basis, b.context, scene.eye, g);
    double c_length = 0.0, g_length = 0.0;
    for (int f = 0; f < COUNT; f++) {
        c_length += c[f] * c[f];
        g_length += g[f].x * g[f].x + g[f].y * g[f].y;
    }
    for (int s = 0; s < 2; s++) {
        const assay_strata strata = s ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        assay_hemisphere  *h      = seen_hemisphere(b.context, &scene, M, N, strata, true, 0);
        memset(sum, 0, sizeof sum);
        memset(square, 0, sizeof square);
        for (int run = 0; run < RUNS; run++) {
            seen_fill(&scene, (uint64_t)run, h);
            assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, found), ASSAY_OK);
            assert_int_equal(assay_hemisphere_project_gradient(h, b.context, b.basis,
                                                               ASSAY_GRADIENT_WALLS, walls),
                             ASSAY_OK);
            for (int f = 0; f < COUNT; f++) {
                const double x[3] = {found[COUNT + f], walls[COUNT + f].x, walls[COUNT + f].y};
                for (int q = 0; q < 3; q++) {
                    sum[3 * f + q] += x[q];
                    square[3 * f + q] += x[q] * x[q];
                }
            }
        }
        double worst[2] = {0.0, 0.0};
        for (int i = 0; i < NUMBERS; i++) {
            const int    f = i / 3, q = i % 3;
            const double mean  = sum[i] / RUNS;
            const double noise = sqrt((square[i] - RUNS * mean * mean) / (RUNS - 1.0) / RUNS);
            const double exact = q == 0 ? c[f] : q == 1 ? g[f].x : g[f].y;
            const double band  = q > 0    ? sqrt(g_length) / M
                                 : s == 0 ? 0.5 * sqrt(c_length) / M
                                          : 0.0;
            worst[q > 0] = fmax(worst[q > 0], fabs(mean - exact) / sqrt(q ? g_length : c_length));
            assert_near(mean, exact, 5.0 * noise + band);
        }
        print_message("#| a room, %s strata, M %d jittered, mean of %d: off %.5f, walls %.5f\n",
                      s ? "uniform" : "cosine", M, RUNS, worst[0], worst[1]);
        assay_hemisphere_destroy(b.context, h);
    }
    close_bench(&b);
}

/* ---- what is refused ---- */

static void refuses(void **state)
{
    (void)state;
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_SH, ASSAY_BASIS_LSOSH,
                                             ASSAY_BASIS_MAKHOTKIN};
    const seen_object             wall    = room();
    const seen_scene              scene   = seen_from_origin(&wall, 1);
    double                        c[3 * COUNT];
    assay_vec3                    g[3 * COUNT];
    c[0]   = 17.0;
    g[0].x = 17.0;
    for (int i = 0; i < 3; i++) {
        bench             b = open_bench(kinds[i]);
        assay_hemisphere *h =
            seen_hemisphere(b.context, &scene, 2, 2, ASSAY_STRATA_UNIFORM, false, 0);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(b.context), assay_basis_kind_name(kinds[i])));
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_WALLS, g),
            ASSAY_ERR_ARGUMENT);
        assay_hemisphere_destroy(b.context, h);
        close_bench(&b);
    }
    bench             b = open_bench(ASSAY_BASIS_HSH);
    assay_hemisphere *h = seen_hemisphere(b.context, &scene, 4, 4, ASSAY_STRATA_UNIFORM, false, 0);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b.context, b.basis, (assay_gradient_form)7, g),
        ASSAY_ERR_ARGUMENT);
    h->cells[9].direction = vec3(0, 0, -1);
    assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_ERR_DOMAIN);
    assert_non_null(strstr(assay_context_error(b.context), "stratum 2"));
    assert_true(c[0] == 17.0 && g[0].x == 17.0);
    assay_hemisphere_destroy(b.context, h);
    close_bench(&b);
}

typedef struct {
    assay_strata strata;
    bool         gradient;
} memory_case;

static assay_status project_once(assay_context *context, void *user)
{
    const memory_case            *what       = user;
    const assay_hemisphere_layout layout     = {3, 4, what->strata, false};
    assay_hemisphere             *hemisphere = NULL;
    assay_basis                  *basis      = NULL;
    double                        c[3 * COUNT];
    assay_vec3                    g[3 * COUNT];
    assay_status                  status = assay_hemisphere_create(context, &layout, &hemisphere);
    c[0] = g[0].x = 17.0;
    if (status == ASSAY_OK) {
        status =
            assay_basis_create(context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_PLAIN, &basis);
    }
    if (status == ASSAY_OK) {
        status = what->gradient ? assay_hemisphere_project_gradient(hemisphere, context, basis,
                                                                    ASSAY_GRADIENT_POINTS, g)
                                : assay_hemisphere_project(hemisphere, context, basis, c);
    }
    assay_basis_destroy(basis);
    assay_hemisphere_destroy(context, hemisphere);
    if (status != ASSAY_OK && !(c[0] == 17.0 && g[0].x == 17.0)) {
        return ASSAY_ERR_DOMAIN; /* outputs were touched: not what failing_each expects */
    }
    return status;
}

static void survives_without_memory(void **state)
{
    (void)state;
    memory_case cases[] = {
        {ASSAY_STRATA_COSINE, false}, {ASSAY_STRATA_UNIFORM, false}, {ASSAY_STRATA_UNIFORM, true}};
    for (int i = 0; i < 3; i++) {
        assert_true(failing_each(project_once, &cases[i]) >= 4 + 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(smooth_room),
                                       cmocka_unit_test(behind_something),
                                       cmocka_unit_test(other_bases),
                                       cmocka_unit_test(contracts_to_irradiance),
                                       cmocka_unit_test(points_of_a_polygon),
                                       cmocka_unit_test(furnace),
                                       cmocka_unit_test(channels_are_apart),
                                       cmocka_unit_test(jittered_cells),
                                       cmocka_unit_test(refuses),
                                       cmocka_unit_test(survives_without_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
