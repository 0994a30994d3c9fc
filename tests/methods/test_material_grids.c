/* test_material_grids.c - materials' lobes as coefficients: their accuracy against eq. 3.32 of the
 * bases, and what they reflect against quadrature of the BRDF itself. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "methods/material_grids.h"
#include "support/measure.h"
#include "support/near.h"

enum { ORDER = 8, COUNT = ORDER * ORDER };

typedef struct {
    assay_context *context;
    assay_basis   *hsh;
} bench;

static bench open_bench(void)
{
    bench b = {.context = measure_context(1)};
    assert_int_equal(
        assay_basis_create(b.context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &b.hsh),
        ASSAY_OK);
    return b;
}

static void close_bench(bench *b)
{
    assay_basis_destroy(b->hsh);
    assay_context_destroy(b->context);
}

static assay_material material_of(assay_material_model model)
{
    assay_material     m      = {.model           = model,
                                 .base_color      = {0.3, 0.5, 0.7, 1.0},
                                 .roughness       = 0.6,
                                 .ior             = 1.5,
                                 .specular_factor = 1.0,
                                 .specular_color  = rgb(0.4, 0.4, 0.4),
                                 .exponent        = 12.0,
                                 .alpha_x         = 0.3,
                                 .alpha_y         = 0.5};
    assay_texture_ref *refs[] = {&m.base_color_texture,  &m.metallic_roughness_texture,
                                 &m.normal_texture,      &m.emissive_texture,
                                 &m.specular_texture,    &m.specular_color_texture,
                                 &m.transmission_texture};
    for (size_t i = 0; i < sizeof refs / sizeof refs[0]; i++) {
        refs[i]->texture = ASSAY_NONE;
    }
    return m;
}

/* The lobe of assay_basis_accuracy is [ward92] eq. 5 times cosine, and so is this material's. */
static void accuracy_is_that_of_the_lobe(void **state)
{
    (void)state;
    bench                              b        = open_bench();
    const assay_material               m        = material_of(ASSAY_MATERIAL_WARD_PUBLISHED);
    const assay_material_grid_settings settings = {.basis = b.hsh, .beyond_lambert = true};
    for (int k = 0; k < 4; k++) {
        const double       theta = (k & 1) ? 0.25 * ASSAY_PI : 0.1;
        const double       phi   = (k & 2) ? 0.5 * ASSAY_PI : 0.0;
        const assay_sincos t = assay_sincos_radians(theta), p = assay_sincos_radians(phi);
        const assay_lobe   lobe = {.kind      = ASSAY_LOBE_WARD,
                                   .alpha_x   = m.alpha_x,
                                   .alpha_y   = m.alpha_y,
                                   .theta_out = theta,
                                   .phi_out   = phi};
        double             expected[ORDER], found[ORDER];
        assert_int_equal(assay_basis_accuracy(b.hsh, b.context, &lobe, expected, NULL), ASSAY_OK);
        assert_int_equal(assay_material_grids_accuracy(b.context, &settings, &m,
                                                       vec3(t.sin * p.cos, t.sin * p.sin, t.cos),
                                                       found),
                         ASSAY_OK);
        for (int n = 0; n < ORDER; n++) {
            assert_near(found[n], expected[n], 2e-3);
        }
        assert_true(expected[1] < 0.95 && expected[ORDER - 1] > 0.99);
    }
    close_bench(&b);
}

static void what_cannot_be_resolved(void **state)
{
    (void)state;
    bench                              b        = open_bench();
    const assay_material_grid_settings settings = {.basis = b.hsh, .beyond_lambert = true};
    const assay_vec3                   wo       = vec3_normalize(vec3(0.6, 0, 0.8));
    double                             found[ORDER];
    assay_material                     sharp = material_of(ASSAY_MATERIAL_WARD);
    sharp.alpha_x = sharp.alpha_y = 1e-3;
    assert_int_equal(assay_material_grids_accuracy(b.context, &settings, &sharp, wo, found),
                     ASSAY_OK);
    assert_true(found[ORDER - 1] == 0.0);
    assay_material pbr = material_of(ASSAY_MATERIAL_PBR);
    assert_null(assay_material_grids_problem(&pbr));
    pbr.transmission = 0.1;
    assert_non_null(assay_material_grids_problem(&pbr));
    pbr                                    = material_of(ASSAY_MATERIAL_PBR);
    pbr.metallic_roughness_texture.texture = 0;
    assert_non_null(assay_material_grids_problem(&pbr));
    pbr                          = material_of(ASSAY_MATERIAL_PBR);
    pbr.specular_texture.texture = 0;
    assert_non_null(assay_material_grids_problem(&pbr));
    pbr           = material_of(ASSAY_MATERIAL_PBR);
    pbr.roughness = 0.0;
    assert_non_null(assay_material_grids_problem(&pbr));
    close_bench(&b);
}

/* ---- reflecting ---- */

/* Light that order 3 holds exactly: 1 + x + z, other amounts in other channels. */
static void light_at(void *user, assay_vec3 w, double *values_out)
{
    (void)user;
    values_out[0] = 1.0 + w.x;
    values_out[1] = 0.5 + w.y + w.z;
    values_out[2] = 0.2 + w.z;
}

typedef struct {
    assay_bsdf_view view;
    bool            beyond_lambert;
} reflector;

/* What is reflected, as an integrand: light times f cosine, less the Lambertian. */
static void reflected_at(void *user, assay_vec3 w, double *values_out)
{
    const reflector *r = user;
    double           light[3];
    light_at(NULL, w, light);
    assay_rgb f = assay_bsdf_view_evaluate(&r->view, w).value;
    if (r->beyond_lambert) {
        f = rgb_sub(f, rgb_scale(assay_bsdf_view_lambert(&r->view), w.z * ASSAY_INV_PI));
    }
    values_out[0] = f.r * light[0];
    values_out[1] = f.g * light[1];
    values_out[2] = f.b * light[2];
}

/* From the front and from the back, for every model, with and without its Lambertian: coefficients
 * against the integral over the same directions. */
static void reflects_as_the_brdf_does(void **state)
{
    (void)state;
    static const assay_material_model models[] = {ASSAY_MATERIAL_PHONG, ASSAY_MATERIAL_WARD,
                                                  ASSAY_MATERIAL_PBR};
    bench                             b        = open_bench();
    double                            light[3 * COUNT], scratch[COUNT], sums[3 * COUNT];
    assert_int_equal(assay_basis_project(b.hsh, b.context, light_at, NULL, 3, 32, 64, light),
                     ASSAY_OK);
    for (int k = 0; k < 12; k++) {
        const assay_material               m        = material_of(models[k % 3]);
        const bool                         front    = k < 6;
        const assay_material_grid_settings settings = {
            .basis = b.hsh, .side = 8, .nodes = 40, .beyond_lambert = (k / 3) % 2};
        assay_material_grids grids;
        assert_int_equal(assay_material_grids_create(b.context, &settings, &m, &grids), ASSAY_OK);
        const assay_surface_material at     = {.base_color      = rgb(0.3, 0.5, 0.7),
                                               .roughness       = m.roughness,
                                               .specular_factor = m.specular_factor,
                                               .specular_color  = m.specular_color};
        assay_vertex                 vertex = {.front = front, .bsdf = assay_vertex_bsdf(&m, &at)};
        /* The direction of texel (5, 4) of 8 x 8: nothing is interpolated. */
        const double square = 0.375 * 0.375 + 0.125 * 0.125, z = (1.0 - square) / (1.0 + square);
        const assay_vec3 local = vec3(0.375 * (1.0 + z), 0.125 * (1.0 + z), z);
        /* The viewer's frame is x, y, z of the world. */
        vertex.frame = front ? (assay_frame3){vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}
                             : (assay_frame3){vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)};
        vertex.wo    = local;
        reflector r  = {assay_bsdf_seen_from(&vertex.bsdf, local), settings.beyond_lambert};
        assay_rgb found;
        assert_int_equal(
            assay_material_grids_reflect(&grids, COUNT, &vertex, light, scratch, &found), ASSAY_OK);
        assert_int_equal(assay_basis_project(b.hsh, b.context, reflected_at, &r, 3, 64, 128, sums),
                         ASSAY_OK);
        /* The constant function is 1 / sqrt(2 pi). */
        const double scale = sqrt(2.0 * ASSAY_PI);
        assert_near(found.r, scale * sums[0], 1e-3 * fabs(scale * sums[0]));
        assert_near(found.g, scale * sums[COUNT], 1e-3 * fabs(scale * sums[COUNT]));
        assert_near(found.b, scale * sums[2 * COUNT], 1e-3 * fabs(scale * sums[2 * COUNT]));
        assay_material_grids_release(&grids);
        assert_null(grids.slope);
    }
    close_bench(&b);
}

/* ---- the same lobe ---- */

/* What the lobe depends on, one change a number; 0 and 1: no change of the lobe. */
static assay_material changed(assay_material_model model, int number)
{
    assay_material m = material_of(model);
    switch (number) {
    case 1: m.base_color[0] = 0.9; break;
    case 2: m.roughness = 0.7; break;
    case 3: m.metallic = 0.5; break;
    case 4: m.ior = 1.4; break;
    case 5: m.specular_factor = 0.5; break;
    case 6: m.specular_color = rgb(0.4, 0.5, 0.4); break;
    case 7: m.exponent = 13.0; break;
    case 8: m.alpha_x = 0.4; break;
    case 9: m.alpha_y = 0.4; break;
    case 10: m.solid = true; break;
    default: break;
    }
    return m;
}

enum { CHANGES = 11 };

/* Said to be the same: then an own grid has the same bits. */
static void the_same_lobe(void **state)
{
    (void)state;
    static const assay_material_model  models[] = {ASSAY_MATERIAL_PBR, ASSAY_MATERIAL_PHONG,
                                                   ASSAY_MATERIAL_WARD};
    bench                              b        = open_bench();
    const assay_material_grid_settings settings = {
        .basis = b.hsh, .side = 4, .nodes = 12, .beyond_lambert = true};
    const assay_vec3 wo        = vec3_normalize(vec3(0.6, 0.2, 0.8));
    int              differ[3] = {0, 0, 0};
    for (int i = 0; i < 3 * CHANGES; i++) {
        const assay_material m = material_of(models[i / CHANGES]);
        const assay_material n = changed(models[i / CHANGES], i % CHANGES);
        assay_material_grids x = {0}, y = {0};
        double               scratch[COUNT], p[3 * COUNT], q[3 * COUNT];
        assert_int_equal(assay_material_grids_create(b.context, &settings, &m, &x), ASSAY_OK);
        assert_int_equal(assay_material_grids_create(b.context, &settings, &n, &y), ASSAY_OK);
        const assay_rgb base = rgb(0.2, 0.5, 0.8);
        assert_int_equal(assay_material_grids_brdf(&x, COUNT, base, wo, scratch, p), ASSAY_OK);
        assert_int_equal(assay_material_grids_brdf(&y, COUNT, base, wo, scratch, q), ASSAY_OK);
        const bool same_bits = memcmp(p, q, sizeof p) == 0;
        const bool said      = assay_material_grids_same(&m, &n);
        assert_true(same_bits || !said);
        assert_true(said || i % CHANGES > 1);
        differ[i / CHANGES] += !same_bits;
        assay_material_grids_release(&x);
        assay_material_grids_release(&y);
    }
    for (int k = 0; k < 3; k++) {
        assert_true(differ[k] >= 2);
    }
    close_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accuracy_is_that_of_the_lobe),
        cmocka_unit_test(what_cannot_be_resolved),
        cmocka_unit_test(reflects_as_the_brdf_does),
        cmocka_unit_test(the_same_lobe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
