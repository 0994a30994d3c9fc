/* test_brdf_grid.c - BRDFs on a paraboloid of outgoing directions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "assay/basis.h"
#include "support/basis_fixture.h"
#include "support/near.h"

enum { ORDER = 3, COUNT = ORDER * ORDER, SIDE = 8 };

static assay_basis *make_hsh(assay_context *context)
{
    assay_basis *basis = NULL;
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &basis),
        ASSAY_OK);
    return basis;
}

/* In the paraboloid's coordinates: u times the first function, v times the second, 1 times the
 * third; bilinear, so a lookup must give it back wherever no texel is outside the hemisphere. */
static double linear(void *user, assay_vec3 wo, assay_vec3 wi)
{
    double y[COUNT];
    assert_int_equal(assay_basis_evaluate(user, wi, y), ASSAY_OK);
    return 0.5 * (1.0 + wo.x / (wo.z + 1.0)) * y[0] + 0.5 * (1.0 + wo.y / (wo.z + 1.0)) * y[1] +
           y[2];
}

static void bilinear_functions_come_back(void **state)
{
    assay_basis     *basis = make_hsh(*state);
    assay_brdf_grid *grid  = NULL;
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, SIDE, 8, 8, &grid),
                     ASSAY_OK);
    assert_int_equal(assay_brdf_grid_side(grid), SIDE);
    for (int i = 0; i < 60; i++) {
        const double     z = 0.45 + 0.55 * i / 60.0, s = sqrt(1.0 - z * z), phi = 1.7 * i;
        const assay_vec3 wo = {s * cos(phi), s * sin(phi), z};
        double           c[COUNT];
        assert_int_equal(assay_brdf_grid_lookup(grid, wo, c), ASSAY_OK);
        assert_near(c[0], 0.5 * (1.0 + wo.x / (wo.z + 1.0)), 1e-13);
        assert_near(c[1], 0.5 * (1.0 + wo.y / (wo.z + 1.0)), 1e-13);
        assert_near(c[2], 1.0, 1e-13);
        for (int k = 3; k < COUNT; k++) {
            assert_near(c[k], 0.0, 1e-13);
        }
    }
    assay_brdf_grid_destroy(grid);
    assay_basis_destroy(basis);
}

/* At a texel's centre a lookup is the texel, and the texel is the projection for that direction;
 * corners hold the nearest direction of the horizon. */
static void texels_are_projections(void **state)
{
    assay_basis     *basis = make_hsh(*state);
    assay_brdf_grid *grid  = NULL;
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, SIDE, 8, 8, &grid),
                     ASSAY_OK);
    for (int row = 0; row < SIDE; row++) {
        for (int column = 0; column < SIDE; column++) {
            const double  a = (column + 0.5) / SIDE * 2.0 - 1.0, b = (row + 0.5) / SIDE * 2.0 - 1.0;
            const double  r      = sqrt(a * a + b * b);
            const double *texel  = assay_brdf_grid_texel(grid, column, row);
            const double  shrink = r > 1.0 ? 1.0 / r : 1.0;
            assert_near(texel[0], 0.5 * (1.0 + a * shrink), 1e-13);
            assert_near(texel[1], 0.5 * (1.0 + b * shrink), 1e-13);
            if (r < 1.0) {
                const double     z  = (1.0 - r * r) / (1.0 + r * r);
                const assay_vec3 wo = {a * (1.0 + z), b * (1.0 + z), z};
                double           c[COUNT];
                assert_int_equal(assay_brdf_grid_lookup(grid, wo, c), ASSAY_OK);
                for (int k = 0; k < COUNT; k++) {
                    assert_near(c[k], texel[k], 1e-14);
                }
            }
        }
    }
    assay_brdf_grid_destroy(grid);
    assay_basis_destroy(basis);
}

static double phong_lobe(void *user, assay_vec3 wo, assay_vec3 wi)
{
    const double cosine = wo.z * wi.z - wo.x * wi.x - wo.y * wi.y;
    (void)user;
    return cosine > 0.0 ? pow(cosine, 5.0) : 0.0;
}

static void lobe_channel(void *user, assay_vec3 d, double *values_out)
{
    assert_int_equal(assay_lobe_value(user, d, values_out), ASSAY_OK);
}

/* The largest error of a lookup against a projection for the same direction. */
static double lookup_error(assay_context *context, const assay_basis *basis, int side)
{
    assay_brdf_grid *grid  = NULL;
    double           worst = 0.0;
    assert_int_equal(assay_brdf_grid_create(basis, context, phong_lobe, NULL, side, 24, 32, &grid),
                     ASSAY_OK);
    for (int i = 0; i < 40; i++) {
        const double     z = 0.5 + 0.5 * i / 40.0, s = sqrt(1.0 - z * z), phi = 2.1 * i - 40.0;
        const assay_vec3 wo   = {s * cos(phi), s * sin(phi), z};
        assay_lobe       lobe = {ASSAY_LOBE_PHONG, 5.0, 0.0, 0.0, acos(z), phi};
        double           c[COUNT], exact[COUNT];
        assert_int_equal(assay_brdf_grid_lookup(grid, wo, c), ASSAY_OK);
        assert_int_equal(assay_basis_project(basis, context, lobe_channel, &lobe, 1, 24, 32, exact),
                         ASSAY_OK);
        for (int k = 0; k < COUNT; k++) {
            worst = fmax(worst, fabs(c[k] - exact[k]));
        }
    }
    assay_brdf_grid_destroy(grid);
    return worst;
}

/* 32 x 32 directions, as the thesis has them: between texels the error goes with the square of
 * their distance. */
static void lookup_approaches_the_projection(void **state)
{
    assay_basis *basis  = make_hsh(*state);
    const double coarse = lookup_error(*state, basis, 16), fine = lookup_error(*state, basis, 32);
    assert_true(fine < 1e-2);
    assert_true(coarse > 3.0 * fine && coarse < 6.0 * fine);
    assay_basis_destroy(basis);
}

static double not_finite(void *user, assay_vec3 wo, assay_vec3 wi)
{
    (void)user;
    (void)wi;
    return wo.z > 0.0 ? 1.0 : INFINITY;
}

/* Threads change nothing, and a bad value is named as it is without them. */
static void threads_change_nothing(void **state)
{
    const assay_context_options options = {.threads = 3};
    assay_context              *context = NULL;
    assay_brdf_grid            *one = NULL, *many = NULL, *none = NULL;
    assay_basis                *basis = make_hsh(*state);
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    assert_int_equal(assay_brdf_grid_create(basis, context, phong_lobe, NULL, 9, 8, 8, &one),
                     ASSAY_OK);
    assert_int_equal(
        assay_brdf_grid_create_parallel(basis, context, phong_lobe, NULL, 9, 8, 8, &many),
        ASSAY_OK);
    assert_memory_equal(assay_brdf_grid_texel(one, 0, 0), assay_brdf_grid_texel(many, 0, 0),
                        81 * COUNT * sizeof(double));
    assert_int_equal(
        assay_brdf_grid_create_parallel(basis, context, not_finite, NULL, 9, 4, 4, &none),
        ASSAY_ERR_DOMAIN);
    assert_non_null(strstr(assay_context_error(context), "must be finite"));
    assert_null(none);
    assay_brdf_grid_destroy(one);
    assay_brdf_grid_destroy(many);
    assay_basis_destroy(basis);
    assay_context_destroy(context);
}

static void bad_input(void **state)
{
    assay_basis     *basis    = make_hsh(*state);
    assay_brdf_grid *grid     = NULL;
    double           c[COUNT] = {9.0};
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, 0, 8, 8, &grid),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, 5000, 8, 8, &grid),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, 4, 0, 8, &grid),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_brdf_grid_create(basis, *state, not_finite, NULL, 4, 4, 4, &grid),
                     ASSAY_ERR_DOMAIN);
    assert_null(grid);
    assert_int_equal(assay_brdf_grid_create(basis, *state, linear, basis, 1, 4, 4, &grid),
                     ASSAY_OK);
    assert_int_equal(assay_brdf_grid_lookup(grid, (assay_vec3){0.6, 0.0, -0.8}, c),
                     ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_brdf_grid_lookup(grid, (assay_vec3){0.0, NAN, 1.0}, c),
                     ASSAY_ERR_DOMAIN);
    assert_true(c[0] == 9.0);
    assert_int_equal(assay_brdf_grid_lookup(grid, (assay_vec3){1.0, 0.0, 0.0}, c), ASSAY_OK);
    assay_brdf_grid_destroy(grid);
    assay_brdf_grid_destroy(NULL);
    assay_basis_destroy(basis);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bilinear_functions_come_back, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(texels_are_projections, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(lookup_approaches_the_projection, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(threads_change_nothing, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(bad_input, basis_set_up, basis_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
