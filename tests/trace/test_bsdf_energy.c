/* Energy: the directional albedo of every BSDF by quadrature and by its own sampler, in a white
 * furnace; bounds; a glass sphere; and tables of what the models gain and lose (docs/bsdf.md). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/bsdf_cases.h"
#include "../support/near.h"
#include "../support/statistics.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "trace/fresnel.h"

enum { DRAWS = 20000 };

/* Radiance on the other side of a refracting boundary over that on wo's side, in equilibrium: the
 * square of the quotient of the indices. */
static double beyond(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi)
{
    if (!bsdf_has_inside(bsdf) || wo.z * wi.z > 0.0) {
        return 1.0;
    }
    return wo.z > 0.0 ? bsdf->ior * bsdf->ior : 1.0 / (bsdf->ior * bsdf->ior);
}

typedef struct {
    assay_bsdf bsdf;
    assay_vec3 wo;
    double (*mutate)(double value, assay_vec3 wo, assay_vec3 wi);
} furnace;

static double reflected(const void *context, assay_vec3 wi)
{
    const furnace *f = context;
    const double   value =
        assay_bsdf_evaluate(&f->bsdf, f->wo, wi).value.b * beyond(&f->bsdf, f->wo, wi);
    return f->mutate ? f->mutate(value, f->wo, wi) : value;
}

/* What the specular lobes scatter: weight times probability, once for each side. */
static double specular_albedo(const furnace *f)
{
    double sides[2] = {0.0, 0.0};
    for (int i = 0; i < 4096; i++) {
        assay_bsdf_sample s;
        if (assay_bsdf_sample_direction(&f->bsdf, f->wo, (i + 0.5) / 4096.0, 0.5, 0.5, &s) &&
            s.specular) {
            sides[s.transmitted] = s.weight.b * s.pdf * beyond(&f->bsdf, f->wo, s.wi);
        }
    }
    return sides[0] + sides[1];
}

static double quadrature(const furnace *f, double width, double tolerance)
{
    statistics_grid grid = statistics_grid_between(-1.0, 1.0, 12, 12);
    if (bsdf_has_inside(&f->bsdf) && f->bsdf.ior > 0.0) {
        statistics_grid_cut(&grid, f->wo.z > 0.0 ? -f->wo.z / f->bsdf.ior : -f->wo.z * f->bsdf.ior);
    }
    if (width < 0.5) {
        statistics_grid_focus(&grid, vec3(-f->wo.x, -f->wo.y, f->wo.z), width);
        statistics_grid_focus(&grid, vec3_negate(f->wo), width);
    }
    return statistics_integrate(&grid, reflected, f, tolerance, NULL) + specular_albedo(f);
}

static statistics_mean sampled(const furnace *f, uint64_t seed, int draws)
{
    statistics_mean mean = {0};
    for (int k = 0; k < draws; k++) {
        assay_random      random = assay_random_start(seed, ASSAY_STAGE_TEST, 1, (uint32_t)k);
        const double      u0     = assay_random_next(&random);
        const double      u1     = assay_random_next(&random);
        const double      u2     = assay_random_next(&random);
        assay_bsdf_sample s;
        const bool        any = assay_bsdf_sample_direction(&f->bsdf, f->wo, u0, u1, u2, &s);
        statistics_mean_add(&mean, any ? s.weight.b * beyond(&f->bsdf, f->wo, s.wi) : 0.0);
    }
    return mean;
}

/* Quadrature to 1e-5; means to 5 standard errors (1 in 1.7e6 by chance). */
static bool agree(double integral, const statistics_mean *mean)
{
    return fabs(integral - mean->mean) <= 5.0 * statistics_mean_error(mean) + 1e-5;
}

/* The i-th of all cases, directions and sides, white. */
static bool furnace_at(int index, bsdf_case *c, furnace *f)
{
    const int directions = 2 * bsdf_direction_count();
    if (index >= bsdf_case_count() * directions) {
        return false;
    }
    const int d = index % directions;
    *c          = bsdf_case_at(index / directions);
    *f          = (furnace){.bsdf = bsdf_whitened(c->bsdf), .wo = bsdf_direction_at(d / 2)};
    if (d % 2) {
        f->wo.z = -f->wo.z;
    }
    return true;
}

static bool mirrored_front(int index, const furnace *f)
{
    return f->wo.z < 0.0 && !bsdf_has_inside(&f->bsdf) && index % 12 != 5;
}

static void test_furnace(void **state)
{
    (void)state;
    bsdf_case c;
    furnace   f;
    int       failures = 0;
    for (int i = 0; furnace_at(i, &c, &f); i++) {
        if (mirrored_front(i, &f)) {
            continue;
        }
        const double          integral = quadrature(&f, c.width, 1e-7);
        const statistics_mean mean     = sampled(&f, (uint64_t)i, DRAWS);
        const bool            bounded  = integral <= 1.0 + 1e-5;
        if (!agree(integral, &mean) || (c.conserves && !bounded)) {
            print_error("%s, wo.z %g: albedo %.8f, sampled %.6f +- %.6f\n", c.name, f.wo.z,
                        integral, mean.mean, statistics_mean_error(&mean));
            failures++;
        }
    }
    assert_int_equal(failures, 0);
}

/* ---- mutants ---- */

static double cosine_dropped(double value, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    return value / fmax(fabs(wi.z), 1e-6);
}
static double doubled(double value, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    (void)wi;
    return 2.0 * value;
}
static double fresnel_twice(double value, assay_vec3 wo, assay_vec3 wi)
{
    const double c = 0.5 * vec3_length(vec3_add(wo, wi));
    return value * (0.04 + 0.96 * assay_schlick(c));
}
static double percent_more(double value, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    (void)wi;
    return 1.01 * value;
}
static double no_transmission(double value, assay_vec3 wo, assay_vec3 wi)
{
    return wo.z * wi.z > 0.0 ? value : 0.0;
}

/* Refraction without the 1 / eta^2 of radiance. */
static double unscaled(double value, assay_vec3 wo, assay_vec3 wi)
{
    return wo.z * wi.z > 0.0 ? value : value * (wo.z > 0.0 ? 2.25 : 1.0 / 2.25);
}

static void expect_caught(const char *name, int draws,
                          double (*mutate)(double, assay_vec3, assay_vec3))
{
    bsdf_case c;
    furnace   f;
    for (int i = 0; furnace_at(i, &c, &f); i++) {
        if (strcmp(c.name, name) == 0 && i % 12 == 4) {
            f.mutate                   = mutate;
            const statistics_mean mean = sampled(&f, 1, draws);
            assert_false(agree(quadrature(&f, c.width, 1e-6), &mean));
            f.mutate = NULL;
            assert_true(agree(quadrature(&f, c.width, 1e-6), &mean));
            return;
        }
    }
    fail_msg("no case %s", name);
}

static void test_mutants(void **state)
{
    (void)state;
    static const char *const names[] = {"lambert", "plastic 0.5", "metal 1", "phong 20",
                                        "ward 0.15"};
    for (int i = 0; i < 5; i++) {
        expect_caught(names[i], 10 * DRAWS, cosine_dropped);
        expect_caught(names[i], 10 * DRAWS, doubled);
        expect_caught(names[i], 10 * DRAWS, fresnel_twice);
        expect_caught(names[i], 40 * DRAWS, percent_more);
    }
    expect_caught("solid 0.7", 10 * DRAWS, no_transmission);
    expect_caught("thin 0.8", 10 * DRAWS, no_transmission);
    expect_caught("solid 0.7", 10 * DRAWS, unscaled);
}

/* ---- closed forms ---- */

static void test_exact(void **state)
{
    (void)state;
    bsdf_case c;
    furnace   f;
    for (int i = 0; furnace_at(i, &c, &f); i++) {
        f.bsdf.base_color = rgb(0.7, 0.5, 0.25);
        assay_bsdf_sample s;
        if (f.bsdf.model == ASSAY_BSDF_LAMBERT) {
            assert_near(quadrature(&f, 1.0, 1e-9), 0.25, 1e-14);
            assert_true(assay_bsdf_sample_direction(&f.bsdf, f.wo, 0.1, 0.2, 0.3, &s));
            assert_near(s.weight.r, 0.7, 2e-16);
            assert_near(s.weight.g, 0.5, 2e-16);
            assert_near(s.weight.b, 0.25, 1e-16);
        }
        f.bsdf.base_color = rgb_grey(1.0);
        const bool smooth = bsdf_is_specular(&f.bsdf) && f.bsdf.metallic != 0.3;
        if (smooth) { /* metal, thin wall and solid: all light is scattered, to rounding */
            assert_near(specular_albedo(&f), 1.0, 1e-14);
        }
    }
}

static double lobe_at_normal(assay_bsdf bsdf, double width)
{
    const furnace f = {.bsdf = bsdf, .wo = {0.0, 0.0, 1.0}};
    return quadrature(&f, width, 1e-9);
}

static void test_closed_forms(void **state)
{
    (void)state;
    /* Phong at normal incidence: (n + 2) / (2 pi) times the integral of cos^(n + 1), which is 1. */
    assay_bsdf phong     = assay_bsdf_default(ASSAY_BSDF_PHONG);
    phong.base_color     = rgb_grey(0.0);
    phong.specular_color = rgb_grey(0.8);
    for (double n = 1.0; n < 1e3; n *= 3.0) {
        phong.exponent = n;
        assert_near(lobe_at_normal(phong, 1.0 / sqrt(n)), 0.8, 1e-8);
    }
    /* Bounded Ward: the integral over t = tan^2 of (1 - t) exp(-t / a^2) / a^2, t < 1. */
    assay_bsdf ward     = assay_bsdf_default(ASSAY_BSDF_WARD);
    ward.base_color     = rgb_grey(0.0);
    ward.specular_color = rgb_grey(1.0);
    for (double a = 0.1; a < 1.05; a += 0.3) {
        ward.alpha_x = ward.alpha_y = a;
        assert_near(lobe_at_normal(ward, a), 1.0 + a * a * expm1(-1.0 / (a * a)), 1e-8);
    }
    /* GGX of alpha 1, where D is constant: the integral of c / (1 + c), 1 - log 2. */
    const assay_bsdf metal = assay_bsdf_default(ASSAY_BSDF_METALLIC_ROUGHNESS);
    assert_near(lobe_at_normal(metal, 1.0), 1.0 - log(2.0), 1e-8);
}

/* Without a diffuse base nothing gains energy, whatever the factors; with one, glTF's mixing bounds
 * the albedo by the specular one plus 1 - f0, no less (docs/bsdf.md). */
static void test_plastic_bound(void **state)
{
    (void)state;
    bsdf_case c;
    furnace   f;
    for (int i = 0; furnace_at(i, &c, &f); i++) {
        if (f.bsdf.model != ASSAY_BSDF_METALLIC_ROUGHNESS || c.conserves || mirrored_front(i, &f)) {
            continue;
        }
        const double both   = quadrature(&f, c.width, 1e-6);
        f.bsdf.base_color   = rgb_grey(0.0);
        f.bsdf.transmission = 0.0;
        const double layer  = quadrature(&f, c.width, 1e-6);
        assert_true(layer <= 1.0 + 1e-4);
        assert_true(both <= layer + 1.0 + f.bsdf.metallic + 1e-4);
    }
}

/* ---- a glass sphere in a furnace ---- */

/* The radiance that a path brings back which starts at the unit sphere's pole, towards `wo` from
 * there, and ends where it leaves; the furnace outside has radiance 1.  What is caught inside by
 * total reflection brings nothing; grazing light stays for thousands of reflections. */
static double sphere_path(const assay_bsdf *bsdf, assay_vec3 wo, uint32_t sample)
{
    assay_random random   = assay_random_start(2, ASSAY_STAGE_TEST, 2, sample);
    assay_vec3   n        = {0.0, 0.0, 1.0};
    double       strength = 1.0;
    for (int bounce = 0; bounce < 20000; bounce++) {
        const assay_frame3 frame = frame3_from_z(n);
        const double       u0    = assay_random_next(&random);
        const double       u1    = assay_random_next(&random);
        const double       u2    = assay_random_next(&random);
        assay_bsdf_sample  s;
        if (!assay_bsdf_sample_direction(bsdf, frame3_to_local(&frame, wo), u0, u1, u2, &s)) {
            return 0.0;
        }
        strength *= s.weight.g;
        const assay_vec3 w = frame3_to_world(&frame, s.wi);
        if (s.wi.z > 0.0) {
            return strength;
        }
        /* The chord from n along w ends at n - 2 (n . w) w. */
        n  = vec3_normalize(vec3_mad(n, -2.0 * vec3_dot(n, w), w));
        wo = vec3_negate(w);
    }
    return 0.0;
}

static void test_glass_sphere(void **state)
{
    (void)state;
    assay_bsdf glass   = assay_bsdf_default(ASSAY_BSDF_METALLIC_ROUGHNESS);
    glass.metallic     = 0.0;
    glass.transmission = 1.0;
    glass.solid        = true;
    for (double roughness = 0.0; roughness < 0.7; roughness += 0.3) {
        glass.roughness = roughness;
        for (int d = 0; d < bsdf_direction_count(); d++) {
            assay_vec3      wo      = bsdf_direction_at(d);
            statistics_mean outside = {0}, inside = {0};
            for (uint32_t k = 0; k < 2000; k++) {
                statistics_mean_add(&outside, sphere_path(&glass, wo, k));
                /* Smooth glass loses nothing on any path. */
                assert_true(roughness > 0.0 || fabs(outside.mean - 1.0) < 1e-11);
            }
            for (uint32_t k = 0; k < 50; k++) {
                const double from_inside = sphere_path(&glass, vec3(wo.x, wo.y, -wo.z), k);
                statistics_mean_add(&inside, from_inside);
                /* Nor from inside, where radiance is the squared index times as much. */
                assert_true(roughness > 0.0 || from_inside == 0.0 ||
                            fabs(from_inside - 2.25) < 1e-11);
            }
            assert_true(outside.mean <= 1.0 + 5.0 * statistics_mean_error(&outside) + 1e-11);
            assert_true(inside.mean <= 2.25 + 5.0 * statistics_mean_error(&inside) + 1e-11);
        }
    }
}

/* ---- tables ---- */

enum { COLUMNS = 8 };

/* Albedo by angle, and the mean over cosine-weighted directions by sampling. */
static void print_row(const char *name, assay_bsdf bsdf, double width)
{
    static const double degrees[COLUMNS] = {0.0, 30.0, 60.0, 75.0, 85.0, 89.0, 89.9, 89.99};
    print_message("| %s", name);
    for (int i = 0; i < COLUMNS; i++) {
        const assay_sincos a = assay_sincos_radians(degrees[i] * ASSAY_PI / 180.0);
        const furnace      f = {.bsdf = bsdf, .wo = vec3(a.sin, 0.0, a.cos)};
        print_message(" | %.4f", quadrature(&f, width, 1e-6));
    }
    statistics_mean mean = {0};
    for (uint32_t k = 0; k < 40000; k++) {
        assay_random      random = assay_random_start(4, ASSAY_STAGE_TEST, 4, k);
        double            u[5];
        assay_bsdf_sample s;
        for (int i = 0; i < 5; i++) {
            u[i] = assay_random_next(&random);
        }
        const assay_vec3 wo  = assay_sample_cosine_hemisphere(u[3], u[4]);
        const bool       any = assay_bsdf_sample_direction(&bsdf, wo, u[0], u[1], u[2], &s);
        statistics_mean_add(&mean, any ? s.weight.b * beyond(&bsdf, wo, s.wi) : 0.0);
    }
    print_message(" | %.3f |\n", mean.mean);
}

/* White throughout; nothing is asserted here but that the numbers exist. */
static void test_tables(void **state)
{
    (void)state;
    static const double roughness[] = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
    char                name[64];
    for (int kind = 0; kind < 4; kind++) {
        static const char *const kinds[] = {"metal", "plastic", "thin", "solid"};
        for (int i = 0; i < 6; i++) {
            assay_bsdf b   = assay_bsdf_default(ASSAY_BSDF_METALLIC_ROUGHNESS);
            b.metallic     = kind == 0 ? 1.0 : 0.0;
            b.transmission = kind >= 2 ? 1.0 : 0.0;
            b.solid        = kind == 3;
            b.roughness    = roughness[i];
            (void)snprintf(name, sizeof name, "%s, roughness %.1f", kinds[kind], roughness[i]);
            print_row(name, b, b.roughness > 0.0 ? b.roughness * b.roughness : 1.0);
        }
    }
    static const double alphas[][2] = {{0.1, 0.1}, {0.2, 0.2}, {0.5, 0.5}, {0.5, 0.1}, {1.0, 1.0}};
    for (int bounded = 0; bounded < 2; bounded++) {
        for (int i = 0; i < 5; i++) {
            assay_bsdf b =
                assay_bsdf_default(bounded ? ASSAY_BSDF_WARD : ASSAY_BSDF_WARD_PUBLISHED);
            b.base_color     = rgb_grey(0.0);
            b.specular_color = rgb_grey(1.0);
            b.alpha_x        = alphas[i][0];
            b.alpha_y        = alphas[i][1];
            (void)snprintf(name, sizeof name, "ward%s %.1f, %.1f", bounded ? "" : "92", b.alpha_x,
                           b.alpha_y);
            print_row(name, b, fmin(b.alpha_x, b.alpha_y));
        }
    }
    static const double exponents[] = {1.0, 5.0, 20.0, 100.0, 1000.0};
    for (int i = 0; i < 5; i++) {
        assay_bsdf b     = assay_bsdf_default(ASSAY_BSDF_PHONG);
        b.base_color     = rgb_grey(0.0);
        b.specular_color = rgb_grey(1.0);
        b.exponent       = exponents[i];
        (void)snprintf(name, sizeof name, "phong, exponent %g", b.exponent);
        print_row(name, b, 1.0 / sqrt(b.exponent));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),       cmocka_unit_test(test_mutants),
        cmocka_unit_test(test_exact),         cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_plastic_bound), cmocka_unit_test(test_glass_sphere),
        cmocka_unit_test(test_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
