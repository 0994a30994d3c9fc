/* test_splat_gloss.c - what a record says of a glossy pixel, by the way of radiance-cache: there
 * light is turned into the BRDF's frame, here the BRDF into the light's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "methods/splat/splat_gloss.h"
#include "support/lit_world.h"

enum { ORDER = 6, COUNT = ORDER * ORDER, PIXELS = 5 };

typedef struct {
    lit_world               w;
    assay_irradiance_cache *beside;
    assay_radiance_cache   *cache;
    assay_material_grids    grids;
    splat_gloss            *gloss;
} studio;

/* A lobe whose axes are told apart, off-white. */
static assay_material ward(void)
{
    assay_material     m      = {.model           = ASSAY_MATERIAL_WARD,
                                 .base_color      = {0.3, 0.5, 0.7, 1.0},
                                 .roughness       = 0.6,
                                 .ior             = 1.5,
                                 .specular_factor = 1.0,
                                 .specular_color  = rgb(0.4, 0.5, 0.6),
                                 .alpha_x         = 0.25,
                                 .alpha_y         = 0.6};
    assay_texture_ref *refs[] = {&m.base_color_texture,  &m.metallic_roughness_texture,
                                 &m.normal_texture,      &m.emissive_texture,
                                 &m.specular_texture,    &m.specular_color_texture,
                                 &m.transmission_texture};
    for (size_t i = 0; i < sizeof refs / sizeof refs[0]; i++) {
        refs[i]->texture = ASSAY_NONE;
    }
    return m;
}

static void open_studio(studio *s)
{
    const assay_radiance_cache_settings settings = {.records  = lit_settings(8, 25),
                                                    .order    = ORDER,
                                                    .gradient = ASSAY_COEFFICIENT_GRADIENT_WALLS,
                                                    .rotation = ASSAY_HSH_TABLE,
                                                    .rotation_steps = 16,
                                                    .sh_order       = 8};
    const assay_material                m        = ward();
    *s                                           = (studio){.w = lit_world_wall(1)};
    assert_int_equal(assay_irradiance_cache_create(s->w.world, &settings.records, 3, &s->beside),
                     ASSAY_OK);
    assert_int_equal(assay_radiance_cache_create(s->w.context, s->beside, &settings, &s->cache),
                     ASSAY_OK);
    const assay_material_grid_settings grid = {
        .basis = assay_radiance_cache_basis(s->cache), .side = 12, .nodes = 24};
    assert_int_equal(assay_material_grids_create(s->w.context, &grid, &m, &s->grids), ASSAY_OK);
    assert_int_equal(splat_gloss_create(s->w.context, PIXELS, s->cache, &s->gloss), ASSAY_OK);
    const assay_cache_point point = lit_point(vec3(0.1, 0, 0.2), vec3(0.1, 1, 0.05));
    assert_int_equal(assay_irradiance_cache_make(assay_radiance_cache_records(s->cache), &point),
                     ASSAY_OK);
}

static void close_studio(studio *s)
{
    splat_gloss_destroy(s->gloss);
    assay_material_grids_release(&s->grids);
    assay_radiance_cache_destroy(s->cache);
    assay_irradiance_cache_destroy(s->beside);
    lit_world_close(&s->w);
}

/* A point whose tangent is turned so far about a normal that is tilted against the record's. */
static assay_vertex vertex_at(double angle, bool front, assay_rgb base_color)
{
    const assay_vec3   n    = vec3_normalize(vec3(0.05, 1, 0.0));
    const assay_frame3 f    = frame3_from_z(n);
    const assay_sincos turn = assay_sincos_radians(angle);
    const assay_vec3   x =
        vec3_normalize(vec3_add(vec3_scale(f.x, turn.cos), vec3_scale(f.y, turn.sin)));
    const double side       = front ? 1.0 : -1.0;
    assay_vertex vertex     = {.frame = frame3_from_zx(vec3_scale(n, side), x),
                               .wo    = vec3_normalize(vec3(0.5, 0.7, -0.4)),
                               .front = front};
    vertex.surface.position = vec3(0.05, 0, 0.15);
    vertex.bsdf             = assay_bsdf_default(ASSAY_BSDF_WARD);
    vertex.bsdf.base_color  = base_color;
    return vertex;
}

static assay_rgb reflected(studio *s, const assay_vertex *vertex)
{
    const assay_frame3 frame = assay_material_frame(vertex);
    double             light[3 * COUNT], scratch[COUNT];
    bool               found  = false;
    assay_rgb          result = rgb_grey(0.0);
    assert_int_equal(assay_radiance_cache_look_up(s->cache, vertex->surface.position, &frame,
                                                  UINT32_MAX, 0, light, &found),
                     ASSAY_OK);
    assert_true(found);
    assert_int_equal(
        assay_material_grids_reflect(&s->grids, COUNT, vertex, light, scratch, &result), ASSAY_OK);
    return result;
}

static bool near_to(assay_rgb a, assay_rgb b)
{
    return fabs(a.r - b.r) <= 1e-12 * fabs(b.r) && fabs(a.g - b.g) <= 1e-12 * fabs(b.g) &&
           fabs(a.b - b.b) <= 1e-12 * fabs(b.b);
}

static assay_rgb said(studio *s, size_t pixel, int slot, const assay_vertex *vertex)
{
    const assay_splat_place place = {.slot     = slot,
                                     .pixel    = pixel,
                                     .position = vertex->surface.position,
                                     .normal   = assay_material_frame(vertex).z};
    assay_rgb               result;
    assert_int_equal(splat_gloss_say(s->gloss, &place, 0, &result), ASSAY_OK);
    return result;
}

static void same_as_looking_up(void **state)
{
    (void)state;
    studio    s;
    assay_rgb before = rgb_grey(0.0);
    open_studio(&s);
    for (int k = 0; k < PIXELS; k++) {
        const assay_vertex vertex = vertex_at(0.5 * k, k % 2 == 0, rgb(0.2, 0.4, 0.1 * k));
        splat_gloss_set(s.gloss, (size_t)k, &s.grids, &vertex);
        const assay_rgb expected = reflected(&s, &vertex);
        assert_true(expected.r > 0.0);
        /* One slot for all: who had it before plays no part, nor does asking again. */
        assert_true(near_to(said(&s, (size_t)k, 7, &vertex), expected));
        assert_true(near_to(said(&s, (size_t)k, 7, &vertex), expected));
        assert_false(near_to(expected, before));
        before = expected;
    }
    close_studio(&s);
}

/* A pixel that shows something else in the next sweep. */
static void another_sweep(void **state)
{
    (void)state;
    studio             s;
    const assay_vertex one   = vertex_at(0.3, true, rgb_grey(0.1)),
                       other = vertex_at(1.1, true, rgb_grey(0.9));
    open_studio(&s);
    splat_gloss_set(s.gloss, 1, &s.grids, &one);
    assert_true(near_to(said(&s, 1, 0, &one), reflected(&s, &one)));
    splat_gloss_begin(s.gloss);
    splat_gloss_set(s.gloss, 1, &s.grids, &other);
    assert_true(near_to(said(&s, 1, 0, &other), reflected(&s, &other)));
    close_studio(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_looking_up),
        cmocka_unit_test(another_sweep),
    };
    return cmocka_run_group_tests_name("splat_gloss", tests, NULL, NULL);
}
