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

static double coefficient_error(const double *a, const double *exact)
{
    double d = 0.0, e = 0.0;
    for (int f = 0; f < COUNT; f++) {
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
    return (project_errors){coefficient_error(found + COUNT, c),
                            gradient_error(points + COUNT, g, false),
                            gradient_error(points + COUNT, g, true),
                            gradient_error(walls + COUNT, g, false),
                            gradient_error(walls + COUNT, g, true)};
}

static void converges(const char *name, const seen_scene *scene, coefficients exact)
{
    bench b = open_bench(ASSAY_BASIS_HSH);
    for (int strata = 0; strata < 2; strata++) {
        for (int m = 16; m <= 256; m *= 4) {
            const project_errors e = errors_at(&b, scene, exact, m, (assay_strata)strata);
            print_message("#| %s %s M %3d: %.5f points %.5f flat %.5f walls %.5f flat %.5f\n", name,
                          strata ? "uniform" : "cosine ", m, e.value, e.points, e.points_flat, e.walls, e.walls_flat);
        }
    }
    close_bench(&b);
}

static void smooth_room(void **state)
{
    (void)state;
    const seen_object wall  = room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = vec3(0.2, -0.15, 0.1);
    converges("room", &scene, room_coefficients);
}

static void behind_something(void **state)
{
    (void)state;
    const seen_scene scene = seen_from_origin(hidden(), 2);
    converges("occluder", &scene, hidden_coefficients);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(smooth_room),
                                       cmocka_unit_test(behind_something)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
