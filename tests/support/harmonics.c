/* harmonics.c - see harmonics.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "math/quadrature.h"
#include "support/harmonics.h"
#include "support/measure.h"

/* Inside a sphere whose radiance is a smooth function of place. */
seen_object harmonics_room(void)
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
void harmonics_of_room(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                       double *out)
{
    const seen_object wall  = harmonics_room();
    seen_scene        scene = seen_from_origin(&wall, 1);
    scene.eye               = eye;
    assert_int_equal(assay_basis_project(basis, context, see, &scene, 1, 40, 64, out), ASSAY_OK);
}

const seen_object *harmonics_hidden(void)
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
    double           x[NODES], w[NODES], values[HARMONICS_COUNT];
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
        for (int f = 0; f < HARMONICS_COUNT; f++) {
            out[f] += sign * weight * values[f];
        }
    }
}

/* A lamp and something dark before it. */
void harmonics_of_hidden(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                         double *out)
{
    (void)context;
    memset(out, 0, HARMONICS_COUNT * sizeof *out);
    add_area(basis, &harmonics_hidden()[0], eye, 1.0, out);
    add_area(basis, &harmonics_hidden()[1], eye, -1.0, out);
}

/* By differences of fourth order: error some (h / distance)^4. */
void harmonics_differences(harmonics_exact exact, const assay_basis *basis, assay_context *context,
                           assay_vec3 eye, assay_vec3 *out)
{
    const double h = 0.004;
    for (int axis = 0; axis < 3; axis++) {
        double at[4][HARMONICS_COUNT];
        for (int i = 0; i < 4; i++) {
            const double s = (i < 2 ? i - 2 : i - 1) * h; /* -2, -1, 1, 2 */
            const double x = axis == 0 ? s : 0.0, y = axis == 1 ? s : 0.0;
            const double z = axis == 2 ? s : 0.0;
            exact(basis, context, vec3_add(eye, vec3(x, y, z)), at[i]);
        }
        for (int f = 0; f < HARMONICS_COUNT; f++) {
            const double d = (8.0 * (at[2][f] - at[1][f]) - (at[3][f] - at[0][f])) / (12.0 * h);
            *(axis == 0 ? &out[f].x : axis == 1 ? &out[f].y : &out[f].z) = d;
        }
    }
}

/* ---- errors of whole vectors, relative ---- */

double harmonics_value_error(const double *a, const double *exact, size_t count)
{
    double d = 0.0, e = 0.0;
    for (size_t f = 0; f < count; f++) {
        d += (a[f] - exact[f]) * (a[f] - exact[f]);
        e += exact[f] * exact[f];
    }
    return sqrt(d / e);
}

double harmonics_gradient_error(const assay_vec3 *a, const assay_vec3 *exact, bool tangential)
{
    double d = 0.0, e = 0.0;
    for (int f = 0; f < HARMONICS_COUNT; f++) {
        assay_vec3 off = vec3_sub(a[f], exact[f]), all = exact[f];
        off.z = tangential ? 0.0 : off.z;
        all.z = tangential ? 0.0 : all.z;
        d += vec3_dot(off, off);
        e += vec3_dot(all, all);
    }
    return sqrt(d / e);
}

harmonics_bench harmonics_open(assay_basis_kind kind)
{
    harmonics_bench b = {measure_context(1), NULL};
    assert_int_equal(
        assay_basis_create(b.context, kind, HARMONICS_ORDER, ASSAY_CONVENTION_THESIS, &b.basis),
        ASSAY_OK);
    return b;
}

void harmonics_close(harmonics_bench *b)
{
    assay_basis_destroy(b->basis);
    assay_context_destroy(b->context);
}
