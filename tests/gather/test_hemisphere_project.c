/* test_hemisphere_project.c - coefficients of radiance and their gradients against quadrature: how
 * they converge, and what they are in the mean. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/numerics.h"
#include "support/closed_form.h"
#include "support/harmonics.h"
#include "support/measure.h"
#include "support/near.h"

/* ---- convergence ---- */

typedef struct {
    double value, points, points_flat, walls, walls_flat;
    double sum, sum_horizon, sum_flat; /* of sum_points */
} project_errors;

/* Gradients of fixed points as they are usually written, sum of L (H grad Omega + Omega grad H) in
 * the directions of the cells, green; horizon: with what sinks below it. */
static void sum_points(const harmonics_bench *b, const assay_hemisphere *h, bool horizon,
                       assay_vec3 *out)
{
    double     values[HARMONICS_COUNT];
    assay_vec3 slopes[HARMONICS_COUNT];
    memset(out, 0, HARMONICS_COUNT * sizeof *out);
    for (int i = 0; i < h->layout.theta * h->layout.phi; i++) {
        const assay_cell *cell = &h->cells[i];
        const int         j    = i / h->layout.phi;
        const double omega = assay_hemisphere_solid_angle(h, j) * cell->radiance.g / cell->distance;
        const double xi    = -vec3_dot(cell->hit_normal, cell->direction);
        const assay_vec3 grow =
            vec3_mad(vec3_scale(cell->direction, 3.0), xi > 0.0 ? 1.0 / xi : 0.0, cell->hit_normal);
        assert_int_equal(assay_basis_gradient(b->basis, cell->direction, values, slopes), ASSAY_OK);
        for (int f = 0; f < HARMONICS_COUNT; f++) {
            out[f] = vec3_mad(out[f], omega, vec3_sub(vec3_scale(grow, values[f]), slopes[f]));
        }
        if (horizon && j == h->layout.theta - 1) {
            const assay_vec3 level = vec3_normalize(vec3(cell->direction.x, cell->direction.y, 0));
            assert_int_equal(assay_basis_evaluate(b->basis, level, values), ASSAY_OK);
            for (int f = 0; f < HARMONICS_COUNT; f++) {
                out[f].z -=
                    2.0 * ASSAY_PI / h->layout.phi * cell->radiance.g / cell->distance * values[f];
            }
        }
    }
}

static project_errors errors_at(const harmonics_bench *b, const seen_scene *scene,
                                harmonics_exact exact, int m, assay_strata strata)
{
    double            c[HARMONICS_COUNT], found[3 * HARMONICS_COUNT];
    assay_vec3        g[HARMONICS_COUNT], points[3 * HARMONICS_COUNT], walls[3 * HARMONICS_COUNT];
    const int         n = (int)floor(ASSAY_PI * m + 0.5);
    assay_hemisphere *h = seen_hemisphere(b->context, scene, m, n, strata, false, 0);
    exact(b->basis, b->context, scene->eye, c);
    harmonics_differences(exact, b->basis, b->context, scene->eye, g);
    assert_int_equal(assay_hemisphere_project(h, b->context, b->basis, found), ASSAY_OK);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b->context, b->basis, ASSAY_GRADIENT_POINTS, points),
        ASSAY_OK);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b->context, b->basis, ASSAY_GRADIENT_WALLS, walls),
        ASSAY_OK);
    assay_vec3 sums[HARMONICS_COUNT], sums_horizon[HARMONICS_COUNT];
    sum_points(b, h, false, sums);
    sum_points(b, h, true, sums_horizon);
    assay_hemisphere_destroy(b->context, h);
    return (project_errors){harmonics_value_error(found + HARMONICS_COUNT, c, HARMONICS_COUNT),
                            harmonics_gradient_error(points + HARMONICS_COUNT, g, false),
                            harmonics_gradient_error(points + HARMONICS_COUNT, g, true),
                            harmonics_gradient_error(walls + HARMONICS_COUNT, g, false),
                            harmonics_gradient_error(walls + HARMONICS_COUNT, g, true),
                            harmonics_gradient_error(sums, g, false),
                            harmonics_gradient_error(sums_horizon, g, false),
                            harmonics_gradient_error(sums, g, true)};
}

/* Largest errors that are accepted at M; 0: anything. */
typedef project_errors (*allowance)(assay_strata strata, int m);

static void check_below(double value, double allowed)
{
    assert_true(isfinite(value) && (allowed == 0.0 || value <= allowed));
}

static void converges(const char *name, const seen_scene *scene, harmonics_exact exact,
                      allowance allowed)
{
    static const int M[] = {16, 64, 256};
    harmonics_bench  b   = harmonics_open(ASSAY_BASIS_HSH);
    for (int i = 0; i < 6; i++) {
        const assay_strata   strata = i < 3 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        const project_errors e      = errors_at(&b, scene, exact, M[i % 3], strata);
        const project_errors most   = allowed(strata, M[i % 3]);
        print_message("#| %s, %s strata, M %3d: value %.5f; points %.5f, tangential %.5f; walls "
                      "%.5f, tangential %.5f\n",
                      name, i < 3 ? "uniform" : "cosine", M[i % 3], e.value, e.points,
                      e.points_flat, e.walls, e.walls_flat);
        print_message(
            "#|     points as a sum over directions %.5f, with the horizon %.5f, tangential "
            "%.5f\n",
            e.sum, e.sum_horizon, e.sum_flat);
        check_below(e.value, most.value);
        check_below(e.points, most.points);
        check_below(e.points_flat, most.points_flat);
        check_below(e.walls, most.walls);
        check_below(e.walls_flat, most.walls_flat);
        check_below(e.sum_flat, most.sum_flat);
    }
    harmonics_close(&b);
}

/* Nothing has an edge here.  Midpoints err as M^-1.5 by the functions' roots at the horizon, cells
 * of constant radiance as 1 / M in the last of the cosine strata; borders taken at the nearer
 * distance as 1 / M; and what changes between the last stratum's middle and the horizon is not
 * seen, which weighs in the normal components alone: 1 / M, or M^-1/2 times a large number in
 * cosine strata, which are not fit for that. */
static project_errors room_allowance(assay_strata strata, int m)
{
    const double root = pow(m, -1.5);
    if (strata == ASSAY_STRATA_COSINE) {
        return (project_errors){.value = 0.5 / m, .points_flat = 1.0 / m, .walls_flat = 1.0 / m};
    }
    return (project_errors){.value       = 2.0 * root,
                            .points      = 3.0 / m,
                            .points_flat = 2.0 * root,
                            .walls       = 3.0 / m,
                            .walls_flat  = 0.5 / m,
                            .sum_flat    = 30.0 * root};
}

static void smooth_room(void **state)
{
    (void)state;
    const seen_object wall  = harmonics_room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = vec3(0.2, -0.15, 0.1);
    converges("a room", &scene, harmonics_of_room, room_allowance);
}

/* Edges: values as five standard deviations of cells that are cut by chance, walls as the distance
 * at the edge.  Uniform strata of M = 16 have their first border at 20 degrees, beyond half of what
 * hides the lamp. */
static project_errors hidden_allowance(assay_strata strata, int m)
{
    if (strata == ASSAY_STRATA_UNIFORM && m == 16) {
        return (project_errors){.value = 0.0};
    }
    return (project_errors){.value = 10.0 * pow(m, -1.5), .walls = 3.0 / m, .walls_flat = 3.0 / m};
}

/* Fixed points do not know that the nearer one hides the other: wrong by half and more at any M. */
static void behind_something(void **state)
{
    (void)state;
    const seen_scene scene = seen_from_origin(harmonics_hidden(), 2);
    converges("a lamp behind something", &scene, harmonics_of_hidden, hidden_allowance);
    harmonics_bench      b = harmonics_open(ASSAY_BASIS_HSH);
    const project_errors e = errors_at(&b, &scene, harmonics_of_hidden, 64, ASSAY_STRATA_UNIFORM);
    assert_true(e.points > 0.5 && e.points_flat > 0.5);
    harmonics_close(&b);
}

/* Every basis that is orthonormal on the hemisphere, in both strata. */
static void other_bases(void **state)
{
    (void)state;
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_ZERNIKE, ASSAY_BASIS_MAKHOTKIN_SQRT,
                                             ASSAY_BASIS_ESH};
    const seen_object             wall    = harmonics_room();
    seen_scene                    scene   = seen_from_origin(&wall, 1);
    scene.eye                             = vec3(0.2, -0.15, 0.1);
    for (int i = 0; i < 6; i++) {
        const assay_strata strata = i < 3 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        double             c[HARMONICS_COUNT], found[3 * HARMONICS_COUNT];
        harmonics_bench    b     = harmonics_open(kinds[i % 3]);
        const size_t       count = assay_basis_count(b.basis);
        assay_hemisphere  *h     = seen_hemisphere(b.context, &scene, 64, 201, strata, false, 0);
        harmonics_of_room(b.basis, b.context, scene.eye, c);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, found), ASSAY_OK);
        check_below(harmonics_value_error(found + count, c, count),
                    room_allowance(strata, 64).value);
        assay_hemisphere_destroy(b.context, h);
        harmonics_close(&b);
    }
}

static void clamped_cosine(void *user, assay_vec3 direction, double *values_out)
{
    (void)user;
    values_out[0] = direction.z;
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
    harmonics_bench b = harmonics_open(ASSAY_BASIS_HSH);
    for (int i = 0; i < 2; i++) {
        double            cosine[HARMONICS_COUNT];
        assay_vec3        g[3 * HARMONICS_COUNT], sum = {0, 0, 0};
        assay_hemisphere *h =
            seen_hemisphere(b.context, &scene, 64, 201, (assay_strata)i, false, 0);
        assert_int_equal(
            assay_basis_project(b.basis, b.context, clamped_cosine, NULL, 1, 20, 40, cosine),
            ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_POINTS, g),
            ASSAY_OK);
        for (int f = 0; f < HARMONICS_COUNT; f++) {
            sum = vec3_mad(sum, cosine[f], g[f]);
        }
        assert_near(vec3_length(vec3_sub(sum, exact)), 0.0, 3.0 / 64 * vec3_length(exact));
        assay_hemisphere_destroy(b.context, h);
    }
    harmonics_close(&b);
}

/* ---- jittered cells ---- */

enum { RUNS = 300, JITTERED_M = 12, JITTERED_N = 38, NUMBERS = 3 * HARMONICS_COUNT };

/* Of every function: value, and x and y of the gradient by walls. */
typedef struct {
    double sum[NUMBERS], square[NUMBERS];
} tally;

static void repeat(const harmonics_bench *b, const seen_scene *scene, assay_strata strata,
                   tally *all)
{
    double            found[3 * HARMONICS_COUNT];
    assay_vec3        walls[3 * HARMONICS_COUNT];
    assay_hemisphere *h =
        seen_hemisphere(b->context, scene, JITTERED_M, JITTERED_N, strata, true, 0);
    for (int run = 0; run < RUNS; run++) {
        seen_fill(scene, (uint64_t)run, h);
        assert_int_equal(assay_hemisphere_project(h, b->context, b->basis, found), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b->context, b->basis, ASSAY_GRADIENT_WALLS, walls),
            ASSAY_OK);
        for (int i = 0; i < NUMBERS; i++) {
            const int    f    = HARMONICS_COUNT + i / 3;
            const double x[3] = {found[f], walls[f].x, walls[f].y};
            all->sum[i] += x[i % 3];
            all->square[i] += x[i % 3] * x[i % 3];
        }
    }
    assay_hemisphere_destroy(b->context, h);
}

static double length_of(const double *exact, bool gradient)
{
    double sum = 0.0;
    for (int i = 0; i < NUMBERS; i++) {
        sum += gradient == (i % 3 > 0) ? exact[i] * exact[i] : 0.0;
    }
    return sqrt(sum);
}

/* Means over many jitters: values in uniform strata have no bias, in cosine strata that of cells of
 * constant radiance; gradients of walls that of the nearer distance. */
static void check_means(const tally *all, const double *exact, assay_strata strata)
{
    const double length[2] = {length_of(exact, false), length_of(exact, true)};
    const double band[2]   = {strata == ASSAY_STRATA_UNIFORM ? 0.0 : 0.5 * length[0] / JITTERED_M,
                            length[1] / JITTERED_M};
    double worst[2] = {0.0, 0.0};
    for (int i = 0; i < NUMBERS; i++) {
        const int    kind  = i % 3 > 0;
        const double mean  = all->sum[i] / RUNS;
        const double noise = sqrt((all->square[i] - RUNS * mean * mean) / (RUNS - 1.0) / RUNS);
        worst[kind]        = fmax(worst[kind], fabs(mean - exact[i]) / length[kind]);
        assert_near(mean, exact[i], 5.0 * noise + band[kind]);
    }
    print_message("#| a room, %s strata, M %d jittered, mean of %d: values off %.5f, walls %.5f\n",
                  strata == ASSAY_STRATA_UNIFORM ? "uniform" : "cosine", JITTERED_M, RUNS, worst[0],
                  worst[1]);
}

static void jittered_cells(void **state)
{
    (void)state;
    const seen_object wall  = harmonics_room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    harmonics_bench   b     = harmonics_open(ASSAY_BASIS_HSH);
    double            c[HARMONICS_COUNT], exact[NUMBERS];
    assay_vec3        g[HARMONICS_COUNT];
    scene.eye = vec3(0.2, -0.15, 0.1);
    harmonics_of_room(b.basis, b.context, scene.eye, c);
    harmonics_differences(harmonics_of_room, b.basis, b.context, scene.eye, g);
    for (int i = 0; i < NUMBERS; i++) {
        exact[i] = i % 3 == 0 ? c[i / 3] : i % 3 == 1 ? g[i / 3].x : g[i / 3].y;
    }
    for (int s = 0; s < 2; s++) {
        const assay_strata strata = s == 0 ? ASSAY_STRATA_COSINE : ASSAY_STRATA_UNIFORM;
        tally              all    = {{0}, {0}};
        repeat(&b, &scene, strata, &all);
        check_means(&all, exact, strata);
    }
    harmonics_close(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_room), cmocka_unit_test(behind_something),
        cmocka_unit_test(other_bases), cmocka_unit_test(points_of_a_polygon),
        cmocka_unit_test(jittered_cells)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
