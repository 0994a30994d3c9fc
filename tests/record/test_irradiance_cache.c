/* test_irradiance_cache.c - records against closed forms, waves against one point at a time.
 *
 * A wall that a directional light shines on is a rectangle of known radiance: what a point sees of
 * it, one indirect bounce, is Lambert's formula.  The points need no surface of their own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/closed_form.h"
#include "support/lit_world.h"
#include "support/measure.h"

static assay_irradiance_cache *make_cache(const lit_world                       *w,
                                          const assay_irradiance_cache_settings *settings)
{
    assay_irradiance_cache *cache = NULL;
    assert_int_equal(assay_irradiance_cache_create(w->world, settings, 3, &cache), ASSAY_OK);
    return cache;
}

static assay_status fill(assay_irradiance_cache *cache, size_t count,
                         const assay_cache_point *points, uint32_t *limits)
{
    return assay_irradiance_cache_fill(cache, NULL, 0, 0, count, points, limits);
}

/* ---- closed forms ---- */

static void records_are_lambert_s_formula(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_wall(1);
    assay_irradiance_cache_settings settings = lit_settings(64, 201);
    settings.rules.a                         = 1e-3; /* every point makes a record */
    assay_irradiance_cache *cache            = make_cache(&w, &settings);
    const assay_cache_point points[]         = {lit_point(vec3(0.1, 0, 0.2), vec3(0, 1, 0)),
                                                lit_point(vec3(1.1, 0, 0.3), vec3(0, 1, 0)),
                                                lit_point(vec3(0.3, 0.2, -0.7), vec3(0.2, 1, 0.1)),
                                                lit_point(vec3(-0.9, -0.4, 0.5), vec3(0.3, 1, -0.2))};
    enum { COUNT = sizeof points / sizeof points[0] };
    assert_int_equal(fill(cache, COUNT, points, NULL), ASSAY_OK);
    assay_record_store *store = assay_irradiance_cache_store(cache);
    assert_int_equal(assay_record_store_count(store), COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const assay_record *r = assay_record_store_at(store, i);
        const double e = LIT_RADIANCE * (double)closed_polygon(LIT_WALL, 4, r->position, r->normal);
        const assay_vec3 t =
            vec3_scale(closed_polygon_gradient(LIT_WALL, 4, r->position, r->normal), LIT_RADIANCE);
        const assay_vec3 tangential = vec3_mad(t, -vec3_dot(t, r->normal), r->normal);
        const assay_vec3 g =
            vec3_scale(closed_polygon_rotation(LIT_WALL, 4, r->position, r->normal), LIT_RADIANCE);
        /* What docs/methods/gathering.md has for M = 64: E within 0.5 %, gradients within 3 % of
         * E. */
        assert_true(fabs(r->irradiance.g - e) < 0.005 * e);
        assert_true(vec3_length(vec3_sub(r->translation[0], tangential)) < 0.03 * e);
        assert_true(vec3_length(vec3_sub(r->rotation[2], g)) < 0.03 * e);
        /* The same check sees a sign. */
        assert_true(vec3_length(vec3_add(r->translation[0], tangential)) > 0.06 * e ||
                    vec3_length(tangential) < 0.03 * e);
        assert_true(vec3_length(vec3_add(r->rotation[2], g)) > 0.06 * e ||
                    vec3_length(g) < 0.03 * e);
    }
    assay_irradiance_cache_destroy(cache);
    lit_world_close(&w);
}

/* rms error over the floor in parts of the mean. */
static double error_over_floor(assay_irradiance_cache *cache, const assay_cache_point *points)
{
    double squares = 0.0, sum = 0.0;
    for (int i = 0; i < LIT_FLOOR_POINTS; i++) {
        assay_rgb          e;
        const assay_vec3   p = points[i].site.position, n = points[i].site.frame.z;
        const assay_status status = assay_irradiance_cache_look_up(cache, p, n, UINT32_MAX, 0, &e);
        const double       exact  = LIT_RADIANCE * (double)closed_polygon(LIT_WALL, 4, p, n);
        assert_int_equal(status, ASSAY_OK);
        squares += (e.r - exact) * (e.r - exact);
        sum += exact;
    }
    return sqrt(squares * LIT_FLOOR_POINTS) / sum;
}

/* Interpolated over the floor: the error falls with a, and gradients pay. */
static void interpolation_converges(void **state)
{
    (void)state;
    static const double a[3]   = {0.4, 0.2, 0.1};
    lit_world           w      = lit_world_wall(1);
    assay_cache_point  *points = lit_floor(1.0);
    double              last   = INFINITY;
    for (int i = 0; i < 3; i++) {
        double   error[2];
        uint32_t records = 0;
        for (int k = 0; k < 2; k++) {
            assay_irradiance_cache_settings settings = lit_settings(48, 150);
            settings.rules.a                         = a[i];
            settings.r_max                           = 1.0; /* the sky leaves R large */
            settings.rules.gradients      = k ? ASSAY_GRADIENTS_BOTH : ASSAY_GRADIENTS_NONE;
            assay_irradiance_cache *cache = make_cache(&w, &settings);
            assert_int_equal(fill(cache, LIT_FLOOR_POINTS, points, NULL), ASSAY_OK);
            error[k] = error_over_floor(cache, points);
            records  = assay_record_store_count(assay_irradiance_cache_store(cache));
            assert_int_equal(assay_irradiance_cache_unserved(cache), 0);
            assay_irradiance_cache_destroy(cache);
        }
        print_message("#| a %.2f: %u records, rms error %.4f without gradients, %.4f with\n", a[i],
                      records, error[0], error[1]);
        assert_true(error[1] < 0.6 * error[0]);
        assert_true(error[1] < last);
        last = error[1];
    }
    assert_true(last < 0.005);
    free(points);
    lit_world_close(&w);
}

/* Everything that a record is, in a closed box of one radiance. */
static void furnace(void **state)
{
    (void)state;
    for (int secondary = ASSAY_SECONDARY_PATH; secondary <= ASSAY_SECONDARY_CACHE; secondary++) {
        lit_world                       w        = lit_world_furnace(1);
        assay_irradiance_cache_settings settings = lit_settings(8, 25);
        assay_cache_point               points[5];
        settings.secondary            = (assay_secondary)secondary;
        settings.levels               = 3;
        settings.path.bounces         = ASSAY_BOUNCES_INF;
        settings.layout.jitter        = true;
        settings.rules.a              = 0.4;
        assay_irradiance_cache *cache = make_cache(&w, &settings);
        for (int i = 0; i < 5; i++) {
            points[i] = lit_point(vec3(0.3 * i - 0.6, -1, 0.1), vec3(0, 1, 0));
        }
        assert_int_equal(fill(cache, 5, points, NULL), ASSAY_OK);
        assay_record_store *store = assay_irradiance_cache_store(cache);
        const uint32_t      count = assay_record_store_count(store);
        double              mean  = 0.0;
        assert_true(count >= 1);
        for (uint32_t i = 0; i < count; i++) {
            mean += assay_record_store_at(store, i)->irradiance.r / count;
        }
        /* Radiance 1 of indirect light.  One bounce too few would leave a half (paths, whose end is
         * random) or less than 0.9 (levels 0 to 2 and then paths). */
        print_message("#| furnace, secondary %d: %u records, mean irradiance %.4f pi\n", secondary,
                      count, mean / ASSAY_PI);
        assert_true(fabs(mean / ASSAY_PI - 1.0) < 0.04);
        assay_irradiance_cache_destroy(cache);
        lit_world_close(&w);
    }
}

/* Each level has half the rays and 1.4 times the a of the one above, up to 1. */
static void levels_relax(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_furnace(1);
    assay_irradiance_cache_settings settings = lit_settings(16, 50);
    settings.secondary                       = ASSAY_SECONDARY_CACHE;
    settings.levels                          = 4;
    settings.path.bounces                    = ASSAY_BOUNCES_INF;
    settings.rules.a                         = 0.4;
    static const double     a[]              = {0.4, 0.4 * M_SQRT2, 0.8, 1.0};
    assay_irradiance_cache *cache = make_cache(&w, &settings), *level = cache;
    for (int i = 0; i < 4; i++, level = assay_irradiance_cache_next(level)) {
        const assay_record_rules *rules =
            assay_record_store_rules(assay_irradiance_cache_store(level));
        assert_true(fabs(rules->a - a[i]) < 1e-12);
    }
    assert_null(level);
    assay_irradiance_cache_destroy(cache);
    lit_world_close(&w);
}

/* ---- order and threads ---- */

static void expect_same_records(assay_irradiance_cache *a, assay_irradiance_cache *b)
{
    assay_record_store *x = assay_irradiance_cache_store(a), *y = assay_irradiance_cache_store(b);
    assert_int_equal(assay_record_store_count(x), assay_record_store_count(y));
    for (uint32_t i = 0; i < assay_record_store_count(x); i++) {
        assert_memory_equal(assay_record_store_at(x, i), assay_record_store_at(y, i),
                            sizeof(assay_record));
    }
}

/* Algorithm 1 takes one point at a time. */
static void waves_are_the_serial_algorithm(void **state)
{
    (void)state;
    lit_world                             one = lit_world_wall(1), three = lit_world_wall(3);
    const assay_irradiance_cache_settings settings = lit_settings(4, 12);
    assay_cache_point                    *points   = lit_floor(1.0);
    uint32_t                             *limits   = malloc(LIT_FLOOR_POINTS * sizeof *limits);
    assay_irradiance_cache               *serial   = make_cache(&one, &settings),
                           *waves                  = make_cache(&three, &settings);
    assert_non_null(limits);
    assert_int_equal(fill(waves, LIT_FLOOR_POINTS, points, limits), ASSAY_OK);
    for (int i = 0; i < LIT_FLOOR_POINTS; i++) {
        assay_rgb then, now;
        uint32_t  limit = 0;
        assert_int_equal(fill(serial, 1, &points[i], &limit), ASSAY_OK);
        assert_int_equal(limit, limits[i]);
        /* What a single pass sees is what a look-up limited to it sees later. */
        const assay_vec3 p = points[i].site.position, n = points[i].site.frame.z;
        assert_int_equal(assay_irradiance_cache_look_up(serial, p, n, UINT32_MAX, 0, &then),
                         ASSAY_OK);
        assert_int_equal(assay_irradiance_cache_look_up(waves, p, n, limit, 0, &now), ASSAY_OK);
        assert_memory_equal(&then, &now, sizeof now);
    }
    expect_same_records(serial, waves);
    assert_true(assay_record_store_count(assay_irradiance_cache_store(serial)) > 20);
    assay_irradiance_cache_destroy(serial);
    assay_irradiance_cache_destroy(waves);
    free(limits);
    free(points);
    lit_world_close(&one);
    lit_world_close(&three);
}

/* Eq. 2.9 literally: for a above 1 one record may not be enough, and the sum must reach a. */
static void enough_is_the_sum_of_weights(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_wall(1);
    assay_irradiance_cache_settings settings = lit_settings(4, 12);
    settings.rules.a                         = 1.6;
    settings.r_max                           = 0.2;
    assay_cache_point      *points           = lit_floor(1.0);
    assay_irradiance_cache *cache            = make_cache(&w, &settings);
    assay_contributions     found            = {0};
    size_t                  several          = 0;
    assert_int_equal(fill(cache, LIT_FLOOR_POINTS, points, NULL), ASSAY_OK);
    for (int i = 0; i < LIT_FLOOR_POINTS; i++) {
        assert_int_equal(assay_record_store_find(assay_irradiance_cache_store(cache),
                                                 points[i].site.position, points[i].site.frame.z,
                                                 UINT32_MAX, &found),
                         ASSAY_OK);
        assert_true(found.weight >= settings.rules.a);
        several += found.count > 1 && found.items[0].weight < settings.rules.a;
    }
    assert_true(several > 0);
    assay_contributions_release(&found);
    assay_irradiance_cache_destroy(cache);
    free(points);
    lit_world_close(&w);
}

/* ---- options ---- */

static assay_irradiance_cache *filled(const lit_world                       *w,
                                      const assay_irradiance_cache_settings *settings)
{
    assay_cache_point      *points = lit_floor(1.0);
    assay_irradiance_cache *cache  = make_cache(w, settings);
    assert_int_equal(fill(cache, LIT_FLOOR_POINTS, points, NULL), ASSAY_OK);
    free(points);
    return cache;
}

static void radii_keep_their_limits(void **state)
{
    (void)state;
    lit_world w = lit_world_wall(1);
    for (int k = 0; k < 4; k++) {
        assay_irradiance_cache_settings settings = lit_settings(4, 12);
        double                          least = 0.0, most = INFINITY;
        switch (k) {
        case 0: settings.r_min = least = 50.0; break;
        case 1: settings.r_max = most = 0.7; break;
        case 2: settings.r_min_pixels = 5000.0, least = 50.0; break;
        default: settings.r_max_pixels = 70.0, most = 0.7; break;
        }
        assay_irradiance_cache *cache = filled(&w, &settings);
        assay_record_store     *store = assay_irradiance_cache_store(cache);
        for (uint32_t i = 0; i < assay_record_store_count(store); i++) {
            const double radius = assay_record_store_at(store, i)->radius;
            const double mean   = assay_record_store_at(store, i)->mean;
            assert_true(radius >= least * (1 - 1e-12) && radius <= most * (1 + 1e-12));
            assert_true(mean > 0.7 && mean < 50.0); /* so that every limit is felt */
        }
        assay_irradiance_cache_destroy(cache);
    }
    lit_world_close(&w);
}

static double steepest(assay_irradiance_cache *cache)
{
    assay_record_store *store   = assay_irradiance_cache_store(cache);
    const uint32_t      count   = assay_record_store_count(store);
    double              largest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < count; k++) {
            const assay_record *a = assay_record_store_at(store, i);
            const assay_record *b = assay_record_store_at(store, k);
            const double        d = vec3_length(vec3_sub(a->position, b->position));
            largest               = fmax(largest, (a->radius - b->radius) - d);
        }
    }
    return largest;
}

static void neighbours_are_clamped(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_furnace(1);
    assay_irradiance_cache_settings settings = lit_settings(3, 6);
    settings.layout.jitter                   = true; /* few random rays: radii jump */
    settings.rules.a                         = 0.1;
    assay_irradiance_cache *free_ones        = filled(&w, &settings);
    settings.neighbour_clamp                 = true;
    assay_irradiance_cache *clamped          = filled(&w, &settings);
    print_message("#| radii jump by %.3f m, clamped by %.2g m\n", steepest(free_ones),
                  steepest(clamped));
    assert_true(steepest(free_ones) > 0.1);
    assert_true(steepest(clamped) < 1e-12);
    assay_irradiance_cache_destroy(free_ones);
    assay_irradiance_cache_destroy(clamped);
    lit_world_close(&w);
}

/* Where the wall's light falls off faster than distances say, closed forms of both E and its
 * gradient give R; where R may not be as small, the gradient gives way. */
static void gradients_limit_radii(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_wall(1);
    assay_irradiance_cache_settings settings = lit_settings(64, 201);
    settings.rules.a                         = 1e-3;
    settings.gradient_limit                  = true;
    const assay_cache_point points[]         = {lit_point(vec3(0.3, 0, 0.2), vec3(0, 1, 0)),
                                                lit_point(vec3(0.9, 0, 0.3), vec3(0, 1, 0)),
                                                lit_point(vec3(0.02, 0.2, 0.0), vec3(0, 1, 0))};
    enum { COUNT = sizeof points / sizeof points[0] };
    assay_irradiance_cache *cache = make_cache(&w, &settings);
    settings.r_min                = 4.0;
    assay_irradiance_cache *wide  = make_cache(&w, &settings);
    assert_int_equal(fill(cache, COUNT, points, NULL), ASSAY_OK);
    assert_int_equal(fill(wide, COUNT, points, NULL), ASSAY_OK);
    int limited = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const assay_record *r = assay_record_store_at(assay_irradiance_cache_store(cache), i);
        const double        e = (double)closed_polygon(LIT_WALL, 4, r->position, r->normal);
        const assay_vec3    t = closed_polygon_gradient(LIT_WALL, 4, r->position, r->normal);
        const double falls    = e / vec3_length(vec3_mad(t, -vec3_dot(t, r->normal), r->normal));
        print_message("#| R = %.4f m, E / |gradient| %.4f m, harmonic mean %.4f m\n", r->radius,
                      falls, r->mean);
        const double seen = fmin(r->mean, sqrt(5.0)); /* the scene's diagonal */
        assert_true(fabs(r->radius - fmin(falls, seen)) < 0.03 * r->radius);
        const assay_record *far = assay_record_store_at(assay_irradiance_cache_store(wide), i);
        assert_true(far->radius == 4.0);
        if (falls > seen) {
            continue;
        }
        limited++;
        assert_true(vec3_length(r->translation[1]) * 4.0 > 1.1 * r->irradiance.g);
        assert_true(fabs(vec3_length(far->translation[1]) * 4.0 / far->irradiance.g - 1.0) < 1e-12);
        assert_true(vec3_dot(far->translation[1], r->translation[1]) > 0.0);
    }
    assert_int_equal(limited, 2);
    assay_irradiance_cache_destroy(cache);
    assay_irradiance_cache_destroy(wide);
    lit_world_close(&w);
}

static void records_are_limited(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_wall(1);
    assay_irradiance_cache_settings settings = lit_settings(4, 12);
    settings.max_records                     = 3;
    assay_irradiance_cache *cache            = filled(&w, &settings);
    assay_rgb               e;
    assert_int_equal(assay_record_store_count(assay_irradiance_cache_store(cache)), 3);
    assert_int_equal(
        assay_irradiance_cache_look_up(cache, vec3(1, 0.1, 1), vec3(0, 1, 0), UINT32_MAX, 0, &e),
        ASSAY_OK);
    assert_true(e.r > 0.0);
    assert_int_equal(assay_irradiance_cache_unserved(cache), 1);
    assay_irradiance_cache_destroy(cache);
    lit_world_close(&w);
}

/* Tabellion's weight: R is half the nearest distance. */
static void tabellion_radius(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_wall(1);
    assay_irradiance_cache_settings settings = lit_settings(16, 50);
    settings.rules.weight                    = ASSAY_WEIGHT_TABELLION;
    settings.rules.a                         = 1.0;
    assay_irradiance_cache *cache            = filled(&w, &settings);
    assay_record_store     *store            = assay_irradiance_cache_store(cache);
    for (uint32_t i = 0; i < assay_record_store_count(store); i++) {
        const assay_record *r = assay_record_store_at(store, i);
        assert_true(r->radius == 0.5 * r->nearest);
    }
    assay_irradiance_cache_destroy(cache);
    lit_world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_are_lambert_s_formula),
        cmocka_unit_test(interpolation_converges),
        cmocka_unit_test(furnace),
        cmocka_unit_test(waves_are_the_serial_algorithm),
        cmocka_unit_test(enough_is_the_sum_of_weights),
        cmocka_unit_test(radii_keep_their_limits),
        cmocka_unit_test(neighbours_are_clamped),
        cmocka_unit_test(gradients_limit_radii),
        cmocka_unit_test(levels_relax),
        cmocka_unit_test(records_are_limited),
        cmocka_unit_test(tabellion_radius),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
