/* test_projection_hemisphere.c - maps on a hemisphere: against digons, against SH of the whole
 * sphere, against a product rule on a quarter of it, and against themselves on finer texels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "assay/basis.h"
#include "math/quadrature.h"
#include "support/basis_fixture.h"
#include "support/failing_context.h"
#include "support/near.h"

enum { ORDER = 8, COUNT = ORDER * ORDER, HIGH = 33 };
static const double PI = 3.14159265358979323846;

static assay_image *make_map(assay_context *context, int width, int height, assay_channel out[3])
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_image             *map      = NULL;
    assert_int_equal(assay_image_create(context, width, height, &map), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        assert_int_equal(assay_image_add_channel(map, names[c], ASSAY_CHANNEL_FLOAT, &out[c]),
                         ASSAY_OK);
    }
    for (int c = 0; c < 3; c++) {
        assert_true(assay_image_find_channel(map, names[c], &out[c]));
    }
    return map;
}

static void project(const assay_basis *basis, assay_context *context, const assay_image *map,
                    double turn, const double *frame, double *out)
{
    assert_int_equal(
        assay_basis_project_environment_hemisphere(basis, context, map, turn, frame, out),
        ASSAY_OK);
}

static void multiply(const double *a, const double *b, double *out)
{
    for (int i = 0; i < 9; i++) {
        out[i] = 0.0;
        for (int k = 0; k < 3; k++) {
            out[i] += a[i / 3 * 3 + k] * b[k * 3 + i % 3];
        }
    }
}

/* About the world's y axis: z goes towards x. */
static void spin(double angle, const double *frame, double *out)
{
    const double about_y[9] = {cos(angle), 0.0,         sin(angle), 0.0,       1.0,
                               0.0,        -sin(angle), 0.0,        cos(angle)};
    multiply(about_y, frame, out);
}

/* The world's upper half, y > 0, in a frame where its axis is (-sin b, 0, cos b): what the digon
 * matrix keeps.  So also the half x > 0, whose edges are meridians. */
static void halves_are_digons(void **state)
{
    static const double betas[] = {0.3, 1.5, -0.7, 2.4, 1e-3, 1e-9, 3.1};
    static double       matrix[HIGH * HIGH * HIGH * HIGH], out[3 * HIGH * HIGH];
    assay_channel       c[3], d[3];
    assay_image        *upper = make_map(*state, 3, 4, c), *right = make_map(*state, 8, 3, d);
    for (int i = 0; i < 6; i++) {
        c[1].data.f32[i] = 2.0f;
    }
    for (int i = 0; i < 24; i++) {
        d[1].data.f32[i] = i % 8 >= 4 ? 2.0f : 0.0f;
    }
    for (size_t k = 0; k < sizeof betas / sizeof betas[0]; k++) {
        const int    order = k == 0 ? HIGH : 6, count = order * order;
        const double b   = betas[k];
        assay_basis *hsh = basis_make(*state, ASSAY_BASIS_HSH, order);
        assert_int_equal(assay_hsh_digon(hsh, *state, b, matrix), ASSAY_OK);
        /* Local axes in the world, as columns: R (-sin b, 0, cos b) = +y, then +x. */
        const double up[9]    = {0.0, 1.0, 0.0, -sin(b), 0.0, cos(b), cos(b), 0.0, sin(b)};
        const double aside[9] = {-sin(b), 0.0, cos(b), cos(b), 0.0, sin(b), 0.0, 1.0, 0.0};
        double       frame[9];
        double       worst = 0.0;
        spin(0.4 * (double)k, up, frame);
        for (int half = 0; half < 2; half++) {
            project(hsh, *state, half ? right : upper, 0.0, half ? aside : frame, out);
            for (int i = 0; i < count; i++) {
                const double expected = 2.0 * sqrt(2.0 * PI) * matrix[i * count];
                worst                 = fmax(worst, fabs(out[count + i] - expected));
                assert_near(out[i], 0.0, 0.0);
            }
        }
        print_message("digon %g, order %d: %.2g\n", b, order, worst);
        assert_true(worst < 2e-14);
        assay_basis_destroy(hsh);
    }
    assay_image_destroy(upper);
    assay_image_destroy(right);
}

static void fill(assay_channel c[3], int texels)
{
    uint32_t seed = 7;
    for (int i = 0; i < 3 * texels; i++) {
        seed                               = seed * 1664525u + 1013904223u;
        c[i / texels].data.f32[i % texels] = (float)(seed >> 8) * 0x1p-24f;
    }
}

static const assay_vec3 poles[] = {{0.0, 0.0, 1.0},    {0.0, 1.0, 0.0},     {0.0, -1.0, 0.0},
                                   {1.0, 0.0, 0.0},    {0.6, 0.0, -0.8},    {0.36, 0.48, 0.8},
                                   {0.0, -0.28, 0.96}, {-0.48, -0.6, 0.64}, {0.0, 0.0, -1.0}};
enum { POLES = sizeof poles / sizeof poles[0] };

/* Both hemispheres of an axis in ESH, which are SH there, make SH of the sphere: in the frame of
 * the other one y and z are negative, and functions with l + m even only see y. */
static void both_halves_make_the_sphere(void **state)
{
    assay_channel c[3];
    assay_image  *map = make_map(*state, 12, 7, c);
    assay_basis  *esh = basis_make(*state, ASSAY_BASIS_ESH, HIGH);
    assay_basis  *sh  = basis_make(*state, ASSAY_BASIS_SH, HIGH);
    static double one[3 * HIGH * HIGH], other[3 * HIGH * HIGH], whole[3 * HIGH * HIGH];
    static double turned[3 * HIGH * HIGH], matrix[HIGH * HIGH * HIGH * HIGH];
    const size_t  count = assay_basis_count(esh);
    double        worst = 0.0;
    fill(c, 12 * 7);
    assert_int_equal(assay_basis_project_environment(sh, map, 0.3, whole), ASSAY_OK);
    for (int p = 0; p < POLES; p++) {
        double frame[9], opposite[9], back[9];
        assert_int_equal(assay_rotation_to_pole(poles[p], frame), ASSAY_OK);
        for (int i = 0; i < 9; i++) {
            opposite[i] = i % 3 ? -frame[i] : frame[i];
            back[i]     = frame[i % 3 * 3 + i / 3];
        }
        project(esh, *state, map, 0.3, frame, one);
        project(esh, *state, map, 0.3, opposite, other);
        assert_int_equal(assay_sh_rotation(sh, back, matrix), ASSAY_OK);
        assert_int_equal(assay_sh_rotate(sh, matrix, 3, whole, turned), ASSAY_OK);
        for (size_t i = 0; i < 3 * count; i++) {
            int l, m;
            assay_basis_function(esh, i % count, &l, &m);
            const double sum = one[i] + (m < 0 ? -other[i] : other[i]);
            const size_t at  = i / count * HIGH * HIGH + (size_t)(l * l + l + m);
            worst            = fmax(worst, fabs(sum - sqrt(2.0) * turned[at]));
        }
    }
    print_message("both halves, order %d: %.2g\n", HIGH, worst);
    assert_true(worst < 1e-14);
    assay_basis_destroy(esh);
    assay_basis_destroy(sh);
    assay_image_destroy(map);
}

/* Every kind on the quarter x > 0, z > 0, where a product rule has nothing but analytic functions:
 * z = cos^2 u, the radius sin u sqrt(1 + cos^2 u). */
static void every_kind_on_a_quarter(void **state)
{
    enum { U = 40, P = 40 };
    double        u[U], uw[U], phi[P], pw[P];
    assay_channel c[3];
    assay_image  *map = make_map(*state, 4, 1, c);
    c[0].data.f32[2] = c[0].data.f32[3] = 1.0f;
    assay_gauss_legendre_on(0.0, 0.5 * PI, U, u, uw);
    assay_gauss_legendre_on(-0.5 * PI, 0.5 * PI, P, phi, pw);
    for (int kind = ASSAY_BASIS_HSH; kind < ASSAY_BASIS_LSOSH; kind++) {
        assay_basis *basis = basis_make(*state, (assay_basis_kind)kind, ORDER);
        const size_t count = assay_basis_count(basis);
        double       out[3 * COUNT], expected[COUNT] = {0.0}, values[COUNT], worst = 0.0;
        for (int i = 0; i < U * P; i++) {
            const double     a = cos(u[i / P]), b = sin(u[i / P]), z = a * a, r = b * sqrt(1.0 + z);
            const assay_vec3 d      = {r * cos(phi[i % P]), r * sin(phi[i % P]), z};
            const double     cosine = kind == ASSAY_BASIS_MAKHOTKIN ? z : 1.0;
            assert_int_equal(assay_basis_evaluate(basis, d, values), ASSAY_OK);
            for (size_t k = 0; k < count; k++) {
                expected[k] += 2.0 * a * b * uw[i / P] * pw[i % P] * cosine * values[k];
            }
        }
        project(basis, *state, map, 0.0, NULL, out);
        for (size_t k = 0; k < count; k++) {
            worst = fmax(worst, fabs(out[k] - expected[k]));
        }
        print_message("quarter, %s: %.2g\n", assay_basis_kind_name((assay_basis_kind)kind), worst);
        assert_true(worst < 1e-14);
        assay_basis_destroy(basis);
    }
    assay_image_destroy(map);
}

/* LSOSH: a constant is a constant; what is fitted to the half y > 0 about +y is one, too. */
static void least_squares_of_a_constant(void **state)
{
    assay_channel c[3];
    assay_image  *map   = make_map(*state, 5, 4, c);
    assay_basis  *basis = basis_make(*state, ASSAY_BASIS_LSOSH, 6);
    double        frame[9], out[3 * 36];
    for (int i = 0; i < 20; i++) {
        c[0].data.f32[i] = 1.0f;
        c[1].data.f32[i] = i < 10 ? 1.0f : 0.0f;
    }
    assert_int_equal(assay_rotation_to_pole((assay_vec3){0.0, 1.0, 0.0}, frame), ASSAY_OK);
    project(basis, *state, map, 0.0, frame, out);
    for (int i = 0; i < 72; i++) {
        assert_near(out[i], i % 36 ? 0.0 : 2.0 * sqrt(PI), 1e-9);
    }
    assay_basis_destroy(basis);
    assay_image_destroy(map);
}

/* The same patches cut finer: other arcs, the same integral. */
static void texels_are_patches(void **state)
{
    enum { W = 5, H = 3, FINER = 7 };
    static double coarse[3 * HIGH * HIGH], fine[3 * HIGH * HIGH];
    assay_channel a[3], b[3];
    assay_image  *one   = make_map(*state, W, H, a);
    assay_image  *many  = make_map(*state, W * FINER, H * FINER, b);
    assay_basis  *hsh   = basis_make(*state, ASSAY_BASIS_HSH, HIGH);
    double        worst = 0.0;
    fill(a, W * H);
    for (int i = 0; i < W * H * FINER * FINER; i++) {
        for (int c = 0; c < 3; c++) {
            b[c].data.f32[i] = a[c].data.f32[i / (W * FINER) / FINER * W + i % (W * FINER) / FINER];
        }
    }
    /* The last poles' horizons all but touch a circle of latitude, from either side. */
    for (int p = 0; p < POLES + 4; p++) {
        const double tilt = PI / 6.0 + (p & 1 ? -1.0 : 1.0) * (p & 2 ? 1e-3 : 1e-7);
        double       frame[9];
        assert_int_equal(
            assay_rotation_to_pole(
                p < POLES ? poles[p] : (assay_vec3){0.6 * sin(tilt), cos(tilt), 0.8 * sin(tilt)},
                frame),
            ASSAY_OK);
        project(hsh, *state, one, -0.9, frame, coarse);
        project(hsh, *state, many, -0.9, frame, fine);
        for (int i = 0; i < 3 * HIGH * HIGH; i++) {
            worst = fmax(worst, fabs(coarse[i] - fine[i]));
        }
    }
    print_message("finer texels, order %d: %.2g\n", HIGH, worst);
    assert_true(worst < 1e-14);
    assay_basis_destroy(hsh);
    assay_image_destroy(one);
    assay_image_destroy(many);
}

/* A horizon that misses an edge of texels by next to nothing moves nothing by more than that, to
 * the power of the root that functions have there. */
static void a_horizon_beside_an_edge(void **state)
{
    static double at[3 * COUNT], beside[3 * COUNT];
    assay_channel c[3];
    assay_image  *map = make_map(*state, 6, 4, c);
    assay_basis  *hsh = basis_make(*state, ASSAY_BASIS_HSH, ORDER);
    fill(c, 24);
    for (double tilt = 1e-3; tilt > 1e-18; tilt *= 1e-3) {
        double frame[9];
        assert_int_equal(assay_rotation_to_pole((assay_vec3){0.0, 1.0, 0.0}, frame), ASSAY_OK);
        project(hsh, *state, map, 0.1, frame, at);
        assert_int_equal(
            assay_rotation_to_pole((assay_vec3){0.6 * tilt, cos(tilt), 0.8 * tilt}, frame),
            ASSAY_OK);
        project(hsh, *state, map, 0.1, frame, beside);
        for (int i = 0; i < 3 * COUNT; i++) {
            assert_near(beside[i], at[i], 60.0 * tilt + 1e-13);
        }
    }
    assay_basis_destroy(hsh);
    assay_image_destroy(map);
}

static void rotation_to_a_pole(void **state)
{
    (void)state;
    for (int p = 0; p < POLES; p++) {
        double       r[9];
        const double v[3] = {poles[p].x, poles[p].y, poles[p].z};
        assert_int_equal(assay_rotation_to_pole(poles[p], r), ASSAY_OK);
        for (int i = 0; i < 9; i++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++) {
                dot += r[i / 3 * 3 + k] * r[i % 3 * 3 + k];
            }
            assert_near(dot, i % 4 ? 0.0 : 1.0, 4e-16);
        }
        /* Smallest: its trace is 1 + 2 cos of the angle between the poles. */
        assert_near(r[0] + r[4] + r[8], 1.0 + 2.0 * v[2], 4e-16);
        for (int i = 0; i < 3; i++) {
            assert_near(r[3 * i + 2], v[i], 2e-16);
        }
    }
    double r[9] = {5.0};
    assert_int_equal(assay_rotation_to_pole((assay_vec3){0.0, 0.0, 2.0}, r), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_rotation_to_pole((assay_vec3){NAN, 0.0, 1.0}, r), ASSAY_ERR_DOMAIN);
    assert_near(r[0], 5.0, 0.0);
}

static void bad_input(void **state)
{
    static const double mirror[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0};
    assay_channel       c[3];
    assay_image        *map          = make_map(*state, 2, 2, c);
    assay_basis        *sh           = basis_make(*state, ASSAY_BASIS_SH, 2);
    assay_basis        *hsh          = basis_make(*state, ASSAY_BASIS_HSH, 2);
    assay_basis        *lsosh        = basis_make(*state, ASSAY_BASIS_LSOSH, 20);
    double              out[3 * 400] = {4.0};
    assert_int_equal(assay_basis_project_environment_hemisphere(sh, *state, map, 0.0, NULL, out),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_project_environment_hemisphere(hsh, *state, map, NAN, NULL, out),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_project_environment_hemisphere(hsh, *state, map, 0.0, mirror, out),
                     ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_basis_project_environment_hemisphere(lsosh, *state, map, 0.0, NULL, out),
                     ASSAY_ERR_DOMAIN);
    c[2].data.f32[1] = NAN;
    assert_int_equal(assay_basis_project_environment_hemisphere(hsh, *state, map, 0.0, NULL, out),
                     ASSAY_ERR_DOMAIN);
    assert_near(out[0], 4.0, 0.0);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
    assay_basis_destroy(lsosh);
    assay_image_destroy(map);
}

static assay_status project_once(assay_context *context, void *user)
{
    assay_channel c[3];
    assay_image  *map   = NULL;
    assay_basis  *basis = NULL;
    double        out[3 * 9];
    assay_status  status = assay_image_create(context, 2, 2, &map);
    for (int k = 0; k < 3 && !status; k++) {
        status = assay_image_add_channel(map,
                                         k == 0   ? "R"
                                         : k == 1 ? "G"
                                                  : "B",
                                         ASSAY_CHANNEL_FLOAT, &c[k]);
    }
    status =
        status ? status
               : assay_basis_create(context, ASSAY_BASIS_LSOSH, 3, ASSAY_CONVENTION_THESIS, &basis);
    status = status
                 ? status
                 : assay_basis_project_environment_hemisphere(basis, context, map, 0.0, NULL, out);
    assay_basis_destroy(basis);
    assay_image_destroy(map);
    (void)user;
    return status;
}

static void refused_memory(void **state)
{
    (void)state;
    assert_true(failing_each(project_once, NULL) > 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(halves_are_digons, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(both_halves_make_the_sphere, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(every_kind_on_a_quarter, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(least_squares_of_a_constant, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(texels_are_patches, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(a_horizon_beside_an_edge, basis_set_up, basis_tear_down),
        cmocka_unit_test(rotation_to_a_pole),
        cmocka_unit_test_setup_teardown(bad_input, basis_set_up, basis_tear_down),
        cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
