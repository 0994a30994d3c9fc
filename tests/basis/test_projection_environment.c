/* test_projection_environment.c - SH coefficients of maps against closed forms and brute force. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "assay/basis.h"
#include "support/basis_fixture.h"
#include "support/near.h"

enum { WIDTH = 8, HEIGHT = 4, ORDER = 5, COUNT = ORDER * ORDER };
static const double PI = 3.14159265358979323846;

static void add_channel(assay_image *map, const char *name)
{
    assay_channel channel;
    assert_int_equal(assay_image_add_channel(map, name, ASSAY_CHANNEL_FLOAT, &channel), ASSAY_OK);
}

static assay_image *make_map(assay_context *context, int width, int height, assay_channel out[3])
{
    assay_image *map = NULL;
    assert_int_equal(assay_image_create(context, width, height, &map), ASSAY_OK);
    add_channel(map, "R");
    add_channel(map, "G");
    add_channel(map, "B");
    assert_true(assay_image_find_channel(map, "R", &out[0]));
    assert_true(assay_image_find_channel(map, "G", &out[1]));
    assert_true(assay_image_find_channel(map, "B", &out[2]));
    return map;
}

static assay_basis *make_sh(assay_context *context, int order, assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_SH, order, convention, &basis),
                     ASSAY_OK);
    return basis;
}

/* docs/conventions.md: x, y in [0, 1) from the left and the top. */
static assay_vec3 map_direction(double x, double y)
{
    const double phi = 2.0 * PI * (x - 0.5), theta = PI * y;
    return (assay_vec3){sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
}

static void constant_map(void **state)
{
    assay_channel c[3];
    assay_image  *map   = make_map(*state, WIDTH, HEIGHT, c);
    assay_basis  *basis = make_sh(*state, ORDER, ASSAY_CONVENTION_THESIS);
    double        out[3 * COUNT];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        c[0].data.f32[i] = 1.0f;
        c[1].data.f32[i] = 0.5f;
    }
    assert_int_equal(assay_basis_project_environment(basis, map, 0.7, out), ASSAY_OK);
    for (int i = 0; i < 3 * COUNT; i++) {
        const double expected = i == 0 ? 2.0 * sqrt(PI) : i == COUNT ? sqrt(PI) : 0.0;
        assert_near(out[i], expected, 3e-14);
    }
    assay_basis_destroy(basis);
    assay_image_destroy(map);
}

/* Midpoints inside the texel (column, row), turned about +y counter-clockwise from above: -z goes
 * to -x. */
static void brute_force(const assay_basis *basis, int column, int row, double turn, double *out)
{
    enum { FINE = 300 };
    const double dx = 1.0 / (WIDTH * FINE), dy = 1.0 / (HEIGHT * FINE);
    for (int i = 0; i < COUNT; i++) {
        out[i] = 0.0;
    }
    for (int j = 0; j < FINE; j++) {
        for (int i = 0; i < FINE; i++) {
            const double     x  = (double)column / WIDTH + (i + 0.5) * dx;
            const double     y  = (double)row / HEIGHT + (j + 0.5) * dy;
            const assay_vec3 d  = map_direction(x, y);
            const assay_vec3 e  = {cos(turn) * d.x + sin(turn) * d.z, d.y,
                                   cos(turn) * d.z - sin(turn) * d.x};
            const double     dw = 2.0 * PI * dx * PI * dy * sin(PI * y);
            double           v[COUNT];
            assert_int_equal(assay_basis_evaluate(basis, e, v), ASSAY_OK);
            for (int k = 0; k < COUNT; k++) {
                out[k] += dw * v[k];
            }
        }
    }
}

static void single_texels_against_brute_force(void **state)
{
    static const struct {
        int    column, row;
        double turn;
    } cases[] = {{0, 0, 0.0}, {5, 1, 0.0}, {2, 2, 0.0}, {5, 1, 0.9}, {7, 3, -2.0}};
    assay_channel c[3];
    assay_image  *map   = make_map(*state, WIDTH, HEIGHT, c);
    assay_basis  *basis = make_sh(*state, ORDER, ASSAY_CONVENTION_THESIS);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const int at = cases[k].row * WIDTH + cases[k].column;
        double    out[3 * COUNT], expected[COUNT];
        c[2].data.f32[at] = 3.0f;
        assert_int_equal(assay_basis_project_environment(basis, map, cases[k].turn, out), ASSAY_OK);
        brute_force(basis, cases[k].column, cases[k].row, cases[k].turn, expected);
        for (int i = 0; i < COUNT; i++) {
            assert_near(out[i], 0.0, 0.0);
            assert_near(out[2 * COUNT + i], 3.0 * expected[i], 2e-5);
        }
        c[2].data.f32[at] = 0.0f;
    }
    assay_basis_destroy(basis);
    assay_image_destroy(map);
}

/* The same signal on finer texels: a texel is a patch, so nothing changes but rounding.  At one row
 * the quadrature in theta has the most to do. */
static void texels_are_patches(void **state)
{
    enum { HIGH = 33 };
    static double coarse[3 * HIGH * HIGH], fine[3 * HIGH * HIGH];
    assay_channel a[3], b[3];
    assay_image  *one   = make_map(*state, 3, 1, a);
    assay_image  *many  = make_map(*state, 12, 64, b);
    assay_basis  *basis = make_sh(*state, HIGH, ASSAY_CONVENTION_PLAIN);
    for (int i = 0; i < 3; i++) {
        a[0].data.f32[i] = (float)(i + 1);
        for (int j = 0; j < 64 * 4; j++) {
            b[0].data.f32[(j / 4) * 12 + 4 * i + j % 4] = (float)(i + 1);
        }
    }
    assert_int_equal(assay_basis_project_environment(basis, one, 0.3, coarse), ASSAY_OK);
    assert_int_equal(assay_basis_project_environment(basis, many, 0.3, fine), ASSAY_OK);
    for (int i = 0; i < HIGH * HIGH; i++) {
        assert_near(coarse[i], fine[i], 1e-13);
    }
    assay_basis_destroy(basis);
    assay_image_destroy(one);
    assay_image_destroy(many);
}

/* In closed form: the half of the sphere with y > 0 has sqrt(pi) and, on sqrt(3 / 4 pi) y,
 * sqrt(3 pi) / 2; so for x > 0, the right half of the map, and z > 0, its outer quarters. */
static void axes_of_the_world(void **state)
{
    assay_channel c[3];
    assay_image  *map   = make_map(*state, WIDTH, HEIGHT, c);
    assay_basis  *basis = make_sh(*state, 2, ASSAY_CONVENTION_KONTKANEN);
    double        out[3 * 4];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int column = i % WIDTH;
        c[0].data.f32[i] = i / WIDTH < HEIGHT / 2 ? 1.0f : 0.0f;
        c[1].data.f32[i] = column >= WIDTH / 2 ? 1.0f : 0.0f;
        c[2].data.f32[i] = column < WIDTH / 4 || column >= 3 * WIDTH / 4 ? 1.0f : 0.0f;
    }
    assert_int_equal(assay_basis_project_environment(basis, map, 0.0, out), ASSAY_OK);
    const double half           = 0.5 * sqrt(3.0 * PI);
    const double expected[3][4] = {
        {sqrt(PI), 0.0, half, 0.0}, {sqrt(PI), half, 0.0, 0.0}, {sqrt(PI), 0.0, 0.0, half}};
    for (int i = 0; i < 12; i++) {
        assert_near(out[i], expected[i / 4][i % 4], 1e-14);
    }
    assay_basis_destroy(basis);
    assay_image_destroy(map);
}

static void bad_input(void **state)
{
    assay_channel c[3];
    assay_image  *map = make_map(*state, 2, 2, c), *empty = NULL;
    assay_basis  *sh = make_sh(*state, 2, ASSAY_CONVENTION_THESIS), *hsh = NULL;
    double        out[12] = {0.0};
    assert_int_equal(assay_image_create(*state, 2, 2, &empty), ASSAY_OK);
    assert_int_equal(assay_basis_create(*state, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS, &hsh),
                     ASSAY_OK);
    assert_int_equal(assay_basis_project_environment(sh, empty, 0.0, out), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_project_environment(hsh, map, 0.0, out), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_project_environment(sh, map, NAN, out), ASSAY_ERR_ARGUMENT);
    c[1].data.f32[3] = INFINITY;
    assert_int_equal(assay_basis_project_environment(sh, map, 0.0, out), ASSAY_ERR_DOMAIN);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
    assay_image_destroy(map);
    assay_image_destroy(empty);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(constant_map, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(single_texels_against_brute_force, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(texels_are_patches, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(axes_of_the_world, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(bad_input, basis_set_up, basis_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
