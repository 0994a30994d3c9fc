/* test_gather_raster.c - a hemisphere filled by rasterisation against rays through its pixels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/numerics.h"
#include "gather/gather.h"
#include "gather/hemisphere_plane.h"
#include "support/lit_world.h"
#include "support/measure.h"
#include "support/raster_judge.h"

static const double FOV = 2.2142974355881810;

static assay_hemisphere *plane_of(assay_context *context, int rows, int columns)
{
    const assay_hemisphere_layout layout = {.theta   = rows,
                                            .phi     = columns,
                                            .strata  = ASSAY_STRATA_PLANE,
                                            .fov     = FOV,
                                            .missing = ASSAY_MISSING_BORDER_CORRECTED};
    assay_hemisphere             *h      = NULL;
    assert_int_equal(assay_hemisphere_create(context, &layout, &h), ASSAY_OK);
    return h;
}

/* What the vertex is, as three numbers, and the next number of the stream. */
static assay_rgb portrait(void *user, int cell, assay_vertex *vertex, assay_random *random,
                          int worker)
{
    const assay_world *world = user;
    (void)cell;
    (void)worker;
    assay_vertex_dress(world, vertex);
    const assay_surface *s = &vertex->surface;
    return rgb(fabs(s->position.x) + fabs(s->uv[0][0]), 2.0 + s->ns.y + vertex->wo_local.z,
               vertex->bsdf.base_color.g + assay_random_next(random));
}

static assay_gather_site site_of(const assay_world *world, uint64_t number)
{
    const assay_raster_view view = raster_judge_view(world, 21, number, 2.0, 8);
    const assay_vec3        n    = view.frame.z;
    assay_gather_site       site = {
              .position = vec3_mad(view.eye, -world->offset, n), .ng = n, .frame = view.frame};
    if (number % 2) { /* a shading normal that leans */
        site.frame = frame3_from_zx(vec3_normalize(vec3_mad(n, 0.9, view.frame.x)), view.frame.y);
    }
    return site;
}

/* The same vertices as rays find, with the same numbers to go on with; nothing under the geometric
 * normal. */
static void sees_what_rays_see(void **state)
{
    (void)state;
    lit_world w = {.context = measure_context(2)};
    assert_int_equal(assay_scene_load(w.context, "scenes/colonnade/colonnade.gltf", NULL, &w.scene),
                     ASSAY_OK);
    assert_int_equal(assay_world_create(w.scene, &w.world), ASSAY_OK);
    assay_ray_counts     counts[2] = {{0}, {0}};
    const assay_gatherer gatherer  = {.world         = w.world,
                                      .seed          = 9,
                                      .radiance      = portrait,
                                      .user          = w.world,
                                      .worker_counts = counts};
    assay_hemisphere    *h         = plane_of(w.context, 24, 40);
    int                  hits = 0, under = 0;
    for (uint64_t k = 0; k < 12; k++) {
        const assay_gather_site site = site_of(w.world, k);
        assert_int_equal(assay_gather(&gatherer, &site, k, h), ASSAY_OK);
        for (int i = 0; i < 24 * 40; i++) {
            const assay_cell *cell   = &h->cells[i];
            const assay_vec3  d      = frame3_to_world(&site.frame, cell->direction);
            uint64_t          rays   = 0;
            assay_random      random = assay_random_start(9, ASSAY_STAGE_GATHER, k, (uint64_t)i);
            const assay_vec3  centre =
                assay_hemisphere_direction(&h->layout, i / 40, i % 40, 0.5, 0.5);
            assay_hit hit;
            assert_true(vec3_length(vec3_sub(centre, cell->direction)) < 1e-15);
            const bool above = vec3_dot(d, site.ng) > 0.0;
            under += !above;
            if (!above || !assay_world_closest(
                              w.world, assay_world_offset(w.world, site.position, site.ng, d), d,
                              false, &random, &rays, &hit)) {
                assert_true(cell->distance == INFINITY && rgb_is_black(cell->radiance));
                continue;
            }
            assay_vertex vertex;
            assay_vertex_place(w.world, &hit, d, &vertex);
            const assay_vec3 ng = frame3_to_local(&site.frame, vertex.surface.ng);
            const assay_rgb  l  = portrait(w.world, i, &vertex, &random, 0);
            assert_true(fabs(cell->distance - hit.t) < 1e-9);
            assert_true(fabs(fabs(vec3_dot(ng, cell->hit_normal)) - 1.0) < 1e-12);
            assert_true(vec3_dot(cell->hit_normal, cell->direction) <= 0.0);
            assert_true(rgb_max(rgb_sub(l, cell->radiance)) < 1e-6 &&
                        rgb_max(rgb_sub(cell->radiance, l)) < 1e-6);
            hits++;
        }
    }
    assert_true(hits > 5000 && under > 100);
    assert_int_equal(counts[0].scatter + counts[1].scatter, 0);
    assay_hemisphere_destroy(w.context, h);
    lit_world_close(&w);
}

static assay_rgb one(void *user, int cell, assay_vertex *vertex, assay_random *random, int worker)
{
    (void)user;
    (void)cell;
    (void)vertex;
    (void)random;
    (void)worker;
    return rgb_grey(2.0);
}

static assay_rgb nothing(void *user, int cell, assay_vertex *vertex, assay_random *random,
                         int worker)
{
    (void)user;
    (void)vertex;
    (void)random;
    (void)worker;
    return rgb_grey(cell == 70 ? NAN : 0.0);
}

/* From the floor of a closed box E is pi L; light that is no number is an error. */
static void furnace(void **state)
{
    (void)state;
    lit_world               w         = lit_world_furnace(2);
    assay_ray_counts        counts[2] = {{0}, {0}};
    const assay_gather_site site      = {vec3(0.2, -1, 0.3), vec3(0, 1, 0),
                                         frame3_from_z(vec3(0, 1, 0))};
    assay_gatherer          gatherer = {.world = w.world, .radiance = one, .worker_counts = counts};
    assay_hemisphere       *h        = plane_of(w.context, 64, 64);
    assert_int_equal(assay_gather(&gatherer, &site, 0, h), ASSAY_OK);
    assert_true(fabs(assay_hemisphere_irradiance(h).r - 2.0 * ASSAY_PI) < 1e-12);
    gatherer.radiance = nothing;
    assert_int_equal(assay_gather(&gatherer, &site, 0, h), ASSAY_ERR_DOMAIN);
    assay_hemisphere_destroy(w.context, h);
    lit_world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sees_what_rays_see),
        cmocka_unit_test(furnace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
