/* test_hemisphere_identities.c - coefficients of radiance and their gradients: what holds exactly,
 * and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/numerics.h"
#include "support/failing_context.h"
#include "support/harmonics.h"
#include "support/measure.h"
#include "support/near.h"

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
    const seen_scene              scene   = seen_from_origin(harmonics_hidden(), 2);
    for (int i = 0; i < 8; i++) {
        double             cosine[HARMONICS_COUNT], c[3 * HARMONICS_COUNT];
        assay_vec3         g[3 * HARMONICS_COUNT], t[3], sum = {0, 0, 0};
        harmonics_bench    b      = harmonics_open(kinds[i % 2]);
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
        harmonics_close(&b);
    }
}

/* ---- a furnace ---- */

/* One coefficient, sqrt(2 pi) L.  WALLS are 0 to the bit; POINTS cancel to the first order. */
static void furnace(void **state)
{
    (void)state;
    const seen_object wall  = seen_sphere(vec3(0.2, -0.1, -0.3), 1.0, 0.7);
    const seen_scene  scene = seen_from_origin(&wall, 1);
    harmonics_bench   b     = harmonics_open(ASSAY_BASIS_HSH);
    for (int i = 0; i < 4; i++) {
        const assay_strata strata = i % 2 ? ASSAY_STRATA_COSINE : ASSAY_STRATA_UNIFORM;
        double             c[3 * HARMONICS_COUNT];
        assay_vec3         walls[3 * HARMONICS_COUNT], points[3 * HARMONICS_COUNT];
        assay_hemisphere  *h = seen_hemisphere(b.context, &scene, 32, 101, strata, i >= 2, 2);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_WALLS, walls),
            ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_POINTS, points),
            ASSAY_OK);
        double sum = 0.0;
        for (int f = 0; f < 3 * HARMONICS_COUNT; f++) {
            /* Cells of the cosine strata: exact.  Directions: midpoints, or noise, at most
             * L |H| (2 pi) / sqrt(3) / M / sqrt(M N) at a slope of 2 |H| a stratum's height. */
            const double exact = f % HARMONICS_COUNT == 0 ? sqrt(2.0 * ASSAY_PI) * 0.7 : 0.0;
            assert_near(c[f], exact, strata == ASSAY_STRATA_COSINE ? 3e-14 : i < 2 ? 0.03 : 0.15);
            assert_true(walls[f].x == 0.0 && walls[f].y == 0.0 && walls[f].z == 0.0);
            sum += points[f].x * points[f].x + points[f].y * points[f].y;
        }
        print_message("#| furnace, %s strata%s, M 32: tangential gradient of points %.4f, not 0\n",
                      i % 2 ? "cosine" : "uniform", i < 2 ? "" : ", jittered", sqrt(sum / 3.0));
        assert_true(sqrt(sum / 3.0) < 2.0 / 32.0);
        assay_hemisphere_destroy(b.context, h);
    }
    harmonics_close(&b);
}

/* A channel has what its own radiance gives: powers of 2 scale without rounding. */
static void channels_are_apart(void **state)
{
    (void)state;
    seen_object wall       = harmonics_room();
    wall.radiance          = rgb(0.5, 1.0, 4.0);
    const seen_scene scene = seen_from_origin(&wall, 1);
    harmonics_bench  b     = harmonics_open(ASSAY_BASIS_HSH);
    for (int i = 0; i < 4; i++) {
        const assay_strata strata = i % 2 ? ASSAY_STRATA_COSINE : ASSAY_STRATA_UNIFORM;
        double             c[3 * HARMONICS_COUNT];
        assay_vec3         g[3 * HARMONICS_COUNT];
        assay_hemisphere  *h = seen_hemisphere(b.context, &scene, 6, 19, strata, true, 3);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_OK);
        assert_int_equal(
            assay_hemisphere_project_gradient(
                h, b.context, b.basis, i < 2 ? ASSAY_GRADIENT_WALLS : ASSAY_GRADIENT_POINTS, g),
            ASSAY_OK);
        for (int f = 0; f < HARMONICS_COUNT; f++) {
            assert_true(c[f] == 0.5 * c[HARMONICS_COUNT + f] &&
                        c[2 * HARMONICS_COUNT + f] == 4.0 * c[HARMONICS_COUNT + f]);
            assert_true(g[f].x == 0.5 * g[HARMONICS_COUNT + f].x &&
                        g[f].y == 0.5 * g[HARMONICS_COUNT + f].y);
            assert_true(g[2 * HARMONICS_COUNT + f].y == 4.0 * g[HARMONICS_COUNT + f].y &&
                        g[2 * HARMONICS_COUNT + f].z == 4.0 * g[HARMONICS_COUNT + f].z);
        }
        assay_hemisphere_destroy(b.context, h);
    }
    harmonics_close(&b);
}

/* ---- what is refused ---- */

static void refuses(void **state)
{
    (void)state;
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_SH, ASSAY_BASIS_LSOSH,
                                             ASSAY_BASIS_MAKHOTKIN};
    const seen_object             wall    = harmonics_room();
    const seen_scene              scene   = seen_from_origin(&wall, 1);
    double                        c[3 * HARMONICS_COUNT];
    assay_vec3                    g[3 * HARMONICS_COUNT];
    c[0]   = 17.0;
    g[0].x = 17.0;
    for (int i = 0; i < 3; i++) {
        harmonics_bench   b = harmonics_open(kinds[i]);
        assay_hemisphere *h =
            seen_hemisphere(b.context, &scene, 2, 2, ASSAY_STRATA_UNIFORM, false, 0);
        assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(b.context), assay_basis_kind_name(kinds[i])));
        assert_int_equal(
            assay_hemisphere_project_gradient(h, b.context, b.basis, ASSAY_GRADIENT_WALLS, g),
            ASSAY_ERR_ARGUMENT);
        assay_hemisphere_destroy(b.context, h);
        harmonics_close(&b);
    }
    harmonics_bench   b = harmonics_open(ASSAY_BASIS_HSH);
    assay_hemisphere *h = seen_hemisphere(b.context, &scene, 4, 4, ASSAY_STRATA_UNIFORM, false, 0);
    assert_int_equal(
        assay_hemisphere_project_gradient(h, b.context, b.basis, (assay_gradient_form)7, g),
        ASSAY_ERR_ARGUMENT);
    h->cells[9].direction = vec3(0, 0, -1);
    assert_int_equal(assay_hemisphere_project(h, b.context, b.basis, c), ASSAY_ERR_DOMAIN);
    assert_non_null(strstr(assay_context_error(b.context), "stratum 2"));
    assert_true(c[0] == 17.0 && g[0].x == 17.0);
    assay_hemisphere_destroy(b.context, h);
    harmonics_close(&b);
}

typedef struct {
    assay_strata strata;
    bool         gradient;
} memory_case;

static assay_status project_once(assay_context *context, void *user)
{
    const memory_case            *what       = user;
    const assay_hemisphere_layout layout     = {.theta = 3, .phi = 4, .strata = what->strata};
    assay_hemisphere             *hemisphere = NULL;
    assay_basis                  *basis      = NULL;
    double                        c[3 * HARMONICS_COUNT];
    assay_vec3                    g[3 * HARMONICS_COUNT];
    assay_status                  status = assay_hemisphere_create(context, &layout, &hemisphere);
    c[0] = g[0].x = 17.0;
    if (status == ASSAY_OK) {
        status = assay_basis_create(context, ASSAY_BASIS_HSH, HARMONICS_ORDER,
                                    ASSAY_CONVENTION_PLAIN, &basis);
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
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contracts_to_irradiance), cmocka_unit_test(furnace),
        cmocka_unit_test(channels_are_apart), cmocka_unit_test(refuses),
        cmocka_unit_test(survives_without_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
