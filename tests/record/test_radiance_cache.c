/* test_radiance_cache.c - records of incident radiance against quadrature, closed forms and the
 * turns of the bases. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "math/quadrature.h"
#include "record/radiance_cache.h"
#include "support/lit_world.h"
#include "support/near.h"

enum { ORDER = 5, COUNT = ORDER * ORDER, ALL = 3 * COUNT };

/* A cache with the irradiance cache that it stands beside. */
typedef struct {
    assay_irradiance_cache *irradiance;
    assay_radiance_cache   *radiance;
} both_caches;

static assay_radiance_cache_settings settings_of(int theta, int phi)
{
    return (assay_radiance_cache_settings){
        .records        = lit_settings(theta, phi),
        .order          = ORDER,
        .gradient       = ASSAY_COEFFICIENT_GRADIENT_WALLS,
        .rotation       = ASSAY_HSH_TABLE,
        .rotation_steps = 16,
        .sh_order       = 8,
    };
}

static both_caches make(const lit_world *w, const assay_radiance_cache_settings *settings)
{
    both_caches c = {NULL, NULL};
    assert_int_equal(assay_irradiance_cache_create(w->world, &settings->records, 3, &c.irradiance),
                     ASSAY_OK);
    assert_int_equal(assay_radiance_cache_create(w->context, c.irradiance, settings, &c.radiance),
                     ASSAY_OK);
    return c;
}

static void drop(both_caches *c)
{
    assay_radiance_cache_destroy(c->radiance);
    assay_irradiance_cache_destroy(c->irradiance);
}

static uint32_t fill(both_caches *c, size_t count, const assay_cache_point *points,
                     uint32_t *limits)
{
    assay_irradiance_cache *records = assay_radiance_cache_records(c->radiance);
    assert_int_equal(assay_irradiance_cache_fill(records, NULL, 0, 0, count, points, limits),
                     ASSAY_OK);
    return assay_record_store_count(assay_irradiance_cache_store(records));
}

static bool look_up(both_caches *c, assay_vec3 position, const assay_frame3 *frame, uint32_t limit,
                    double *coefficients)
{
    bool found = false;
    assert_int_equal(
        assay_radiance_cache_look_up(c->radiance, position, frame, limit, 0, coefficients, &found),
        ASSAY_OK);
    return found;
}

static double norm_of(const double *a, const double *b, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        const double d = a[i] - (b ? b[i] : 0.0);
        sum += d * d;
    }
    return sqrt(sum);
}

/* ---- the wall by quadrature ---- */

enum { NODES = 16 };

/* Integral over the wall of L H_i cos xi / r^2: COUNT numbers, all channels have the same.  The
 * wall must be above the horizon. */
static void wall_coefficients(const assay_basis *hsh, assay_vec3 p, const assay_frame3 *frame,
                              double *coefficients_out)
{
    double node[NODES], weight[NODES];
    assay_gauss_legendre(NODES, node, weight);
    memset(coefficients_out, 0, COUNT * sizeof *coefficients_out);
    for (int i = 0; i < NODES * NODES; i++) {
        const assay_vec3 q = vec3(0.5 * node[i % NODES], 1.0, node[i / NODES]);
        const assay_vec3 d = vec3_sub(q, p);
        const double     r = vec3_length(d);
        const double     power =
            LIT_RADIANCE * 0.5 * weight[i % NODES] * weight[i / NODES] * d.y / (r * r * r);
        double values[COUNT];
        assert_int_equal(
            assay_basis_evaluate(hsh, frame3_to_local(frame, vec3_scale(d, 1.0 / r)), values),
            ASSAY_OK);
        for (int k = 0; k < COUNT; k++) {
            coefficients_out[k] += power * values[k];
        }
    }
}

/* The change of the same along a world direction, frame fixed. */
static void wall_slope(const assay_basis *hsh, assay_vec3 p, const assay_frame3 *frame,
                       assay_vec3 along, double *slope_out)
{
    const double h = 1e-4;
    double       ahead[COUNT], behind[COUNT];
    wall_coefficients(hsh, vec3_mad(p, h, along), frame, ahead);
    wall_coefficients(hsh, vec3_mad(p, -h, along), frame, behind);
    for (int k = 0; k < COUNT; k++) {
        slope_out[k] = (ahead[k] - behind[k]) / (2.0 * h);
    }
}

/* Records and their gradients in both forms.  (POINTS is not for UNIFORM strata: gather.h.) */
static void records_are_quadrature(void **state)
{
    (void)state;
    lit_world                     w        = lit_world_wall(1);
    assay_radiance_cache_settings settings = settings_of(64, 201);
    settings.records.rules.a               = 1e-3; /* every point makes a record */
    both_caches             c              = make(&w, &settings);
    const assay_cache_point points[]       = {lit_point(vec3(0.1, 0, 0.2), vec3(0, 1, 0)),
                                              lit_point(vec3(0.7, 0, 0.3), vec3(0, 1, 0)),
                                              lit_point(vec3(0.3, 0.2, -0.4), vec3(0.2, 1, 0.1))};
    enum { POINT_COUNT = sizeof points / sizeof points[0] };
    assert_int_equal(fill(&c, POINT_COUNT, points, NULL), POINT_COUNT);
    const assay_basis *hsh = assay_radiance_cache_basis(c.radiance);
    for (uint32_t i = 0; i < POINT_COUNT; i++) {
        const assay_gather_site *site = &points[i].site;
        const double            *made = assay_radiance_cache_coefficients(c.radiance, i);
        const assay_vec3        *g    = assay_radiance_cache_gradients(c.radiance, i);
        double                   exact[COUNT], slope[2][COUNT], made_slope[2][COUNT];
        wall_coefficients(hsh, site->position, &site->frame, exact);
        wall_slope(hsh, site->position, &site->frame, site->frame.x, slope[0]);
        wall_slope(hsh, site->position, &site->frame, site->frame.y, slope[1]);
        for (int k = 0; k < COUNT; k++) {
            made_slope[0][k] = g[COUNT + k].x;
            made_slope[1][k] = g[COUNT + k].y;
        }
        const double size  = norm_of(exact, NULL, COUNT);
        const double error = norm_of(made + 2 * COUNT, exact, COUNT) / size;
        const double ex    = norm_of(made_slope[0], slope[0], COUNT) / size;
        const double ey    = norm_of(made_slope[1], slope[1], COUNT) / size;
        print_message("#| record %u: coefficients off by %.4f, gradients by %.3f and %.3f /m of "
                      "them; gradients are %.2f and %.2f /m\n",
                      i, error, ex, ey, norm_of(slope[0], NULL, COUNT) / size,
                      norm_of(slope[1], NULL, COUNT) / size);
        assert_true(error < 0.01 && ex < 0.06 && ey < 0.06);
    }
    drop(&c);
    lit_world_close(&w);
}

/* ---- interpolation ---- */

/* rms over the floor of the error of the coefficients, in parts of their own. */
static double error_over_floor(both_caches *c, const assay_cache_point *points)
{
    double squares = 0.0, sum = 0.0;
    for (int i = 0; i < LIT_FLOOR_POINTS; i += 17) {
        const assay_gather_site *site = &points[i].site;
        double                   found[ALL], exact[COUNT];
        assert_true(look_up(c, site->position, &site->frame, UINT32_MAX, found));
        wall_coefficients(assay_radiance_cache_basis(c->radiance), site->position, &site->frame,
                          exact);
        const double error = norm_of(found, exact, COUNT), size = norm_of(exact, NULL, COUNT);
        squares += error * error;
        sum += size * size;
    }
    return sqrt(squares / sum);
}

static double interpolation_error(const lit_world *w, double a, double bend,
                                  assay_coefficient_gradient gradient, assay_hsh_rotation_way way)
{
    assay_cache_point            *points   = lit_floor(bend);
    assay_radiance_cache_settings settings = settings_of(32, 100);
    settings.records.rules.a               = a;
    settings.records.r_max                 = 1.0; /* the sky leaves R large */
    settings.gradient                      = gradient;
    settings.rotation                      = way;
    both_caches    c                       = make(w, &settings);
    const uint32_t records                 = fill(&c, LIT_FLOOR_POINTS, points, NULL);
    const double   error                   = error_over_floor(&c, points);
    print_message("#| a %.2f, bend %.0f, gradient %d, rotation %d: %u records, error %.4f\n", a,
                  bend, (int)gradient, (int)way, records, error);
    assert_int_equal(assay_irradiance_cache_unserved(assay_radiance_cache_records(c.radiance)), 0);
    drop(&c);
    free(points);
    return error;
}

/* On a flat floor the error falls with a, and gradients pay. */
static void interpolation_converges(void **state)
{
    (void)state;
    lit_world w    = lit_world_wall(1);
    double    last = INFINITY;
    for (double a = 0.4; a > 0.08; a *= 0.5) {
        const double with =
            interpolation_error(&w, a, 0.0, ASSAY_COEFFICIENT_GRADIENT_WALLS, ASSAY_HSH_TABLE);
        const double without =
            interpolation_error(&w, a, 0.0, ASSAY_COEFFICIENT_GRADIENT_NONE, ASSAY_HSH_TABLE);
        assert_true(with < 0.8 * without);
        assert_true(with < last);
        last = with;
    }
    assert_true(last < 0.025);
    lit_world_close(&w);
}

/* On a bent floor records are turned, too: exactly and by the table alike. */
static void bent_floor(void **state)
{
    (void)state;
    lit_world                        w    = lit_world_wall(1);
    const assay_coefficient_gradient form = ASSAY_COEFFICIENT_GRADIENT_WALLS;
    const double exact = interpolation_error(&w, 0.2, 1.0, form, ASSAY_HSH_EXACT);
    const double table = interpolation_error(&w, 0.2, 1.0, form, ASSAY_HSH_TABLE);
    assert_near(table, exact, 1e-3);
    assert_true(exact < 0.05);
    lit_world_close(&w);
}

/* One record, asked with twisted and tilted frames: what the bases' matrix makes of its
 * coefficients, moved along its gradients. */
static void a_look_up_turns_and_moves(void **state)
{
    (void)state;
    lit_world                     w        = lit_world_wall(1);
    assay_radiance_cache_settings settings = settings_of(8, 25);
    settings.records.rules.a               = 0.9;
    settings.rotation                      = ASSAY_HSH_EXACT;
    both_caches             c              = make(&w, &settings);
    const assay_cache_point point          = lit_point(vec3(0.2, 0, 0.1), vec3(0.1, 1, -0.3));
    assert_int_equal(fill(&c, 1, &point, NULL), 1);
    const assay_basis  *hsh  = assay_radiance_cache_basis(c.radiance);
    const double       *made = assay_radiance_cache_coefficients(c.radiance, 0);
    const assay_vec3   *g    = assay_radiance_cache_gradients(c.radiance, 0);
    const assay_frame3 *from = &point.site.frame;
    for (int k = 0; k < 6; k++) {
        const assay_vec3   offset = vec3(0.02 * k, 0.03, -0.01 * k);
        const assay_frame3 to =
            frame3_from_zx(vec3_normalize(vec3(0.1 + 0.1 * k, 1, -0.3)), vec3(k - 2.0, 0.3, 1));
        const assay_vec3 f[3] = {from->x, from->y, from->z}, t[3] = {to.x, to.y, to.z};
        double           r[9], matrix[COUNT * COUNT], moved[ALL], found[ALL], expected[ALL];
        for (int i = 0; i < 9; i++) {
            r[i] = vec3_dot(t[i / 3], f[i % 3]);
        }
        for (int i = 0; i < ALL; i++) {
            moved[i] = made[i] + vec3_dot(frame3_to_world(from, g[i]), offset);
        }
        assert_int_equal(assay_hsh_rotation(hsh, w.context, NULL, r, matrix), ASSAY_OK);
        for (int i = 0; i < ALL; i++) {
            expected[i] = 0.0;
            for (int j = 0; j < COUNT; j++) {
                expected[i] += matrix[i % COUNT * COUNT + j] * moved[i / COUNT * COUNT + j];
            }
        }
        assert_true(look_up(&c, vec3_add(point.site.position, offset), &to, UINT32_MAX, found));
        assert_true(norm_of(found, expected, ALL) < 1e-12 * norm_of(expected, NULL, ALL));
    }
    drop(&c);
    lit_world_close(&w);
}

/* Several records: the mean by weight of what each says alone. */
static void records_are_averaged(void **state)
{
    (void)state;
    lit_world                     w        = lit_world_wall(1);
    assay_radiance_cache_settings settings = settings_of(8, 25);
    const assay_vec3              places[] = {{0, 0, 0}, {0.1, 0, 0.05}, {-0.04, 0, 0.12}};
    const assay_frame3            here     = frame3_from_z(vec3(0, 1, 0));
    const assay_vec3              position = vec3(0.02, 0, 0.04);
    double                        sum[ALL] = {0.0}, total = 0.0, found[ALL];
    assay_cache_point             points[3];
    for (int i = 0; i < 3; i++) {
        points[i] = lit_point(places[i], vec3(0.02 * i, 1, 0.01));
    }
    /* Each in a cache of its own, as the first would serve the others; rays through the centres of
     * cells are the same.  Tables would depend on a. */
    settings.rotation        = ASSAY_HSH_EXACT;
    settings.records.rules.a = 0.9;
    for (int i = 0; i < 3; i++) {
        both_caches c = make(&w, &settings);
        fill(&c, 1, &points[i], NULL);
        assert_true(look_up(&c, position, &here, UINT32_MAX, found));
        const assay_record *r = assay_record_store_at(
            assay_irradiance_cache_store(assay_radiance_cache_records(c.radiance)), 0);
        const double weight =
            assay_record_weight(r, &settings.records.rules, position, vec3(0, 1, 0));
        assert_true(weight > 0.0);
        for (int k = 0; k < ALL; k++) {
            sum[k] += weight * found[k];
        }
        total += weight;
        drop(&c);
    }
    for (int k = 0; k < ALL; k++) {
        sum[k] /= total;
    }
    /* The same three at once: nearly nothing is enough for a point (eq. 2.9) when a is large. */
    settings.records.rules.a = 40.0;
    both_caches c            = make(&w, &settings);
    assert_int_equal(fill(&c, 3, points, NULL), 3);
    assert_true(look_up(&c, position, &here, UINT32_MAX, found));
    assert_true(norm_of(found, sum, ALL) < 1e-12 * norm_of(sum, NULL, ALL));
    drop(&c);
    lit_world_close(&w);
}

/* ---- furnace ---- */

/* Coefficients of a constant 1/2; tilted by b, the irradiance that is left is 1 - (1 - cos b) / 2
 * of pi / 2, by the exact turn and the table; and what a Lambertian of 0.8 shows of it. */
static void furnace_and_digon(void **state)
{
    (void)state;
    lit_world                     w        = lit_world_furnace(1);
    assay_radiance_cache_settings settings = settings_of(128, 12);
    const assay_cache_point       point    = lit_point(vec3(0.2, -1, 0.1), vec3(0, 1, 0));
    settings.records.path.estimator        = ASSAY_ESTIMATOR_BSDF;
    settings.records.rules.a               = 0.9;
    settings.rotation_steps                = 64;
    for (int k = 0; k < 2; k++) {
        settings.rotation         = k ? ASSAY_HSH_TABLE : ASSAY_HSH_EXACT;
        both_caches c             = make(&w, &settings);
        double      cosine[COUNT] = {0.0}, found[ALL];
        assert_int_equal(fill(&c, 1, &point, NULL), 1);
        const double     *made = assay_radiance_cache_coefficients(c.radiance, 0);
        const assay_vec3 *g    = assay_radiance_cache_gradients(c.radiance, 0);
        for (int i = 0; i < ALL; i++) {
            const double constant = i % COUNT ? 0.0 : 0.5 * sqrt(2.0 * ASSAY_PI);
            assert_near(made[i], constant, i % COUNT ? 5e-4 : 1e-12);
            assert_near(vec3_length(g[i]), 0.0, 1e-9);
        }
        /* cos theta = (1 + (2 cos theta - 1)) / 2: functions (0, 0) and (1, 0). */
        cosine[0] = 0.5 * sqrt(2.0 * ASSAY_PI);
        cosine[2] = 0.5 * sqrt(2.0 * ASSAY_PI / 3.0);
        for (int degrees = 0; degrees <= 70; degrees += 10) {
            const double       b    = degrees * (ASSAY_PI / 180.0);
            const assay_sincos tilt = assay_sincos_radians(b);
            const assay_frame3 frame =
                frame3_from_z(vec3(0.6 * tilt.sin, tilt.cos, 0.8 * tilt.sin));
            assert_true(look_up(&c, point.site.position, &frame, UINT32_MAX, found));
            const double e = assay_basis_dot(assay_radiance_cache_basis(c.radiance), found, cosine);
            const double shown = 0.8 * e * ASSAY_INV_PI, whole = 0.8 * 0.5;
            const double loss = 0.5 * (1.0 - tilt.cos);
            if (k) {
                print_message("#| tilt %d deg: radiance %.5f of albedo times it, predicted %.5f\n",
                              degrees, shown / whole, 1.0 - loss);
            }
            assert_near(shown / whole, 1.0 - loss, 1e-4);
        }
        drop(&c);
    }
    lit_world_close(&w);
}

/* ---- order, limits, threads ---- */

static void waves_are_the_serial_algorithm(void **state)
{
    (void)state;
    lit_world                           one = lit_world_wall(1), three = lit_world_wall(3);
    const assay_radiance_cache_settings settings = settings_of(4, 12);
    assay_cache_point                  *points   = lit_floor(1.0);
    uint32_t                           *limits   = malloc(LIT_FLOOR_POINTS * sizeof *limits);
    both_caches serial = make(&one, &settings), waves = make(&three, &settings);
    assert_non_null(limits);
    const uint32_t count = fill(&waves, LIT_FLOOR_POINTS, points, limits);
    assert_true(count > 20);
    for (int i = 0; i < LIT_FLOOR_POINTS; i++) {
        double              then[ALL], now[ALL];
        uint32_t            limit = 0;
        const assay_frame3 *frame = &points[i].site.frame;
        fill(&serial, 1, &points[i], &limit);
        assert_int_equal(limit, limits[i]);
        assert_true(look_up(&serial, points[i].site.position, frame, UINT32_MAX, then));
        assert_true(look_up(&waves, points[i].site.position, frame, limit, now));
        assert_memory_equal(then, now, sizeof now);
    }
    for (uint32_t i = 0; i < count; i++) {
        assert_memory_equal(assay_radiance_cache_coefficients(serial.radiance, i),
                            assay_radiance_cache_coefficients(waves.radiance, i),
                            ALL * sizeof(double));
    }
    drop(&serial);
    drop(&waves);
    free(limits);
    free(points);
    lit_world_close(&one);
    lit_world_close(&three);
}

static void points_out_of_reach(void **state)
{
    (void)state;
    lit_world                           w          = lit_world_wall(1);
    const assay_radiance_cache_settings settings   = settings_of(4, 12);
    both_caches                         c          = make(&w, &settings);
    const assay_cache_point             point      = lit_point(vec3(0, 0, 0), vec3(0, 1, 0));
    const assay_frame3                  up         = frame3_from_z(vec3(0, 1, 0));
    double                              found[ALL] = {7.0};
    assert_false(look_up(&c, vec3(0, 0, 0), &up, UINT32_MAX, found));
    fill(&c, 1, &point, NULL);
    assert_false(look_up(&c, vec3(50, 0, 0), &up, UINT32_MAX, found));
    assert_false(look_up(&c, vec3(0, 0, 0), &up, 0, found));
    assert_true(found[0] == 7.0);
    assert_int_equal(assay_irradiance_cache_unserved(assay_radiance_cache_records(c.radiance)), 3);
    assert_true(look_up(&c, vec3(0, 0, 0), &up, 1, found));
    drop(&c);
    lit_world_close(&w);
}

static void bad_settings(void **state)
{
    (void)state;
    lit_world                     w        = lit_world_wall(1);
    assay_radiance_cache_settings settings = settings_of(4, 12);
    assay_irradiance_cache       *beside   = NULL;
    assay_radiance_cache         *cache    = NULL;
    assert_int_equal(assay_irradiance_cache_create(w.world, &settings.records, 3, &beside),
                     ASSAY_OK);
    settings.order = 0;
    assert_int_equal(assay_radiance_cache_create(w.context, beside, &settings, &cache),
                     ASSAY_ERR_ARGUMENT);
    settings                 = settings_of(4, 12);
    settings.records.rules.a = 1.5; /* tilts beyond 90 degrees */
    settings.rotation        = ASSAY_HSH_ANALYTICAL;
    assert_int_equal(assay_radiance_cache_create(w.context, beside, &settings, &cache),
                     ASSAY_ERR_ARGUMENT);
    settings.records.layout.theta = 1;
    assert_int_equal(assay_radiance_cache_create(w.context, beside, &settings, &cache),
                     ASSAY_ERR_ARGUMENT);
    assert_null(cache);
    assay_irradiance_cache_destroy(beside);
    lit_world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_are_quadrature),
        cmocka_unit_test(interpolation_converges),
        cmocka_unit_test(bent_floor),
        cmocka_unit_test(a_look_up_turns_and_moves),
        cmocka_unit_test(records_are_averaged),
        cmocka_unit_test(furnace_and_digon),
        cmocka_unit_test(waves_are_the_serial_algorithm),
        cmocka_unit_test(points_out_of_reach),
        cmocka_unit_test(bad_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
