/* Every BSDF's sampler against its density, over a grid of materials and directions, from both
 * sides; the parts of a sample against each other; and mutants of both. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/bsdf_cases.h"
#include "../support/near.h"
#include "../support/statistics.h"
#include "core/numerics.h"
#include "core/random.h"
#include "trace/fresnel.h"
#include "trace/ggx.h"

enum { DRAWS = 40000 };

typedef struct {
    assay_bsdf bsdf;
    assay_vec3 wo;
    /* The density under test: the library's, or a mutant made from it. */
    double (*mutate)(double pdf, assay_vec3 wo, assay_vec3 wi);
} setting;

static bool draw(const void *context, const double u[3], assay_vec3 *direction_out)
{
    const setting    *s = context;
    assay_bsdf_sample sample;
    if (!assay_bsdf_sample_direction(&s->bsdf, s->wo, u[0], u[1], u[2], &sample) ||
        sample.specular) {
        return false;
    }
    *direction_out = sample.wi;
    return true;
}

static double density(const void *context, assay_vec3 wi)
{
    const setting *s   = context;
    const double   pdf = assay_bsdf_evaluate(&s->bsdf, s->wo, wi).pdf;
    return s->mutate ? s->mutate(pdf, s->wo, wi) : pdf;
}

/* Both hemispheres, finer where the case has narrow lobes. */
static statistics_grid grid_for(const bsdf_case *c, assay_vec3 wo)
{
    statistics_grid grid = statistics_grid_between(-1.0, 1.0, 16, 16);
    if (c->width < 0.5) {
        statistics_grid_focus(&grid, vec3(-wo.x, -wo.y, wo.z), c->width);
        if (c->bsdf.transmission > 0.0 && !c->bsdf.solid) {
            statistics_grid_focus(&grid, vec3_negate(wo), c->width);
        }
    }
    if (c->bsdf.solid) {
        /* Microfacets seen edge on: D does not vanish there, so that the lobe ends with a jump. */
        statistics_grid_cut(&grid, wo.z > 0.0 ? -wo.z / c->bsdf.ior : -wo.z * c->bsdf.ior);
    }
    if (c->width < 0.5 && c->bsdf.transmission > 0.0 && c->bsdf.solid) {
        const assay_vec3 n   = vec3(0.0, 0.0, wo.z > 0.0 ? 1.0 : -1.0);
        const double     eta = wo.z > 0.0 ? c->bsdf.ior : 1.0 / c->bsdf.ior;
        const double     t   = assay_refracted_cosine(fabs(wo.z), eta);
        if (t > 0.0) {
            statistics_grid_focus(&grid, assay_refract(wo, n, fabs(wo.z), t, eta), 0.5 * c->width);
        }
    }
    return grid;
}

/* Case, direction and side of a test, numbered. */
typedef struct {
    bsdf_case       c;
    setting         s;
    statistics_grid grid;
} test_point;

static bool point_at(int index, test_point *point)
{
    const int directions = 2 * bsdf_direction_count();
    if (index >= bsdf_case_count() * directions) {
        return false;
    }
    const int d = index % directions;
    point->c    = bsdf_case_at(index / directions);
    point->s    = (setting){.bsdf = point->c.bsdf, .wo = bsdf_direction_at(d / 2)};
    if (d % 2) {
        point->s.wo.z = -point->s.wo.z;
    }
    point->grid = grid_for(&point->c, point->s.wo);
    return true;
}

/* The level of one test, so that all together err with probability 0.01. */
static double level(void)
{
    return statistics_sidak(0.01, bsdf_case_count() * 2 * bsdf_direction_count());
}

static void test_chi_square(void **state)
{
    (void)state;
    test_point point;
    int        failures = 0;
    for (int i = 0; point_at(i, &point); i++) {
        /* Where the back is the mirrored front, one direction is enough. */
        if (point.s.wo.z < 0.0 && !bsdf_has_inside(&point.s.bsdf) && i % 12 != 5) {
            continue;
        }
        const statistics_verdict v =
            statistics_test_sampler(&point.grid, density, draw, &point.s, DRAWS, (uint64_t)i);
        if (!(v.p > level())) {
            print_error("%s, wo (%g, %g, %g): p = %g, mass %.7f, drawn %.5f, chi2 %g of %d\n",
                        point.c.name, point.s.wo.x, point.s.wo.y, point.s.wo.z, v.p, v.mass,
                        v.drawn, v.chi_square, v.degrees);
            failures++;
        }
    }
    assert_int_equal(failures, 0);
}

/* ---- mutants ---- */

static double doubled(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    (void)wi;
    return 2.0 * pdf;
}
static double percent_more(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    (void)wi;
    return 1.01 * pdf;
}
static double percent_less(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    (void)wi;
    return 0.99 * pdf;
}
/* The Jacobian of reflection forgotten: density of half vectors, not of directions. */
static double no_jacobian(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    return wi.z * wo.z > 0.0 ? pdf * 2.0 * vec3_length(vec3_add(wo, wi)) : pdf;
}
/* The cosine of the diffuse lobe dropped. */
static double no_cosine(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    return pdf / fmax(fabs(wi.z), 1e-3) * 0.5;
}
/* Asymmetric by a tenth about the plane of x and z. */
static double lopsided(double pdf, assay_vec3 wo, assay_vec3 wi)
{
    (void)wo;
    return pdf * (1.0 + 0.1 * wi.y);
}

static void test_chi_square_mutants(void **state)
{
    (void)state;
    double (*const mutants[])(double, assay_vec3, assay_vec3) = {
        doubled, percent_more, percent_less, no_jacobian, no_cosine, lopsided};
    static const char *const names[] = {"metal 0.5", "lambert",  "plastic 0.5",
                                        "solid 0.7", "phong 20", "ward 0.15"};
    test_point               point;
    for (int i = 0; point_at(i, &point); i++) {
        bool wanted = false;
        for (int k = 0; k < 6; k++) {
            wanted = wanted || strcmp(names[k], point.c.name) == 0;
        }
        if (!wanted || i % 12 != 2) { /* front, 0.5 rad from the normal */
            continue;
        }
        for (int k = 0; k < 6; k++) {
            point.s.mutate = mutants[k];
            const double p =
                statistics_test_sampler(&point.grid, density, draw, &point.s, 6 * DRAWS, 1).p;
            if (!(p < level())) {
                fail_msg("%s: mutant %d passes, p = %g", point.c.name, k, p);
            }
        }
    }
}

/* ---- parts of a sample ---- */

typedef struct {
    uint64_t samples, specular;
} tally;

static void check_sample(const test_point *point, const assay_bsdf_sample *sample, tally *counts)
{
    const assay_vec3 wo = point->s.wo;
    assert_near(vec3_length(sample->wi), 1.0, 1e-14);
    assert_int_equal(sample->transmitted, sample->wi.z * wo.z < 0.0);
    assert_true(isfinite(sample->pdf) && sample->pdf > 0.0 && rgb_finite(sample->weight));
    assert_true(sample->weight.r >= 0.0 && sample->weight.g >= 0.0 && sample->weight.b >= 0.0);
    counts->samples++;
    if (sample->specular) {
        counts->specular++;
        assert_true(sample->pdf <= 1.0 + 1e-15);
        return;
    }
    assert_false(bsdf_is_specular(&point->s.bsdf));
    const assay_bsdf_value f = assay_bsdf_evaluate(&point->s.bsdf, wo, sample->wi);
    assert_near(f.pdf, sample->pdf, 1e-10 * sample->pdf);
    assert_near(f.value.r / f.pdf, sample->weight.r, 1e-10 * sample->weight.r);
    assert_near(f.value.g / f.pdf, sample->weight.g, 1e-10 * sample->weight.g);
    assert_near(f.value.b / f.pdf, sample->weight.b, 1e-10 * sample->weight.b);
}

static void test_parts(void **state)
{
    (void)state;
    test_point point;
    for (int i = 0; point_at(i, &point); i++) {
        tally counts = {0};
        for (uint32_t k = 0; k < 2000; k++) {
            assay_random      random = assay_random_start(9, ASSAY_STAGE_TEST, (uint64_t)i, k);
            const double      u0     = assay_random_next(&random);
            const double      u1     = assay_random_next(&random);
            const double      u2     = assay_random_next(&random);
            assay_bsdf_sample sample;
            if (assay_bsdf_sample_direction(&point.s.bsdf, point.s.wo, u0, u1, u2, &sample)) {
                check_sample(&point, &sample, &counts);
            }
        }
        assert_true(counts.samples > 0);
        assert_true(!bsdf_is_specular(&point.s.bsdf) || counts.specular == counts.samples);
    }
}

/* A specular lobe is drawn as often as its probability says: 5 standard errors. */
static void test_specular_probability(void **state)
{
    (void)state;
    test_point point;
    for (int i = 0; point_at(i, &point); i++) {
        double probability[2] = {0.0, 0.0};
        double counts[2]      = {0.0, 0.0};
        for (uint32_t k = 0; k < 20000; k++) {
            assay_random      random = assay_random_start(11, ASSAY_STAGE_TEST, (uint64_t)i, k);
            const double      u0     = assay_random_next(&random);
            assay_bsdf_sample sample;
            if (assay_bsdf_sample_direction(&point.s.bsdf, point.s.wo, u0, 0.3, 0.6, &sample) &&
                sample.specular) {
                counts[sample.transmitted] += 1.0;
                probability[sample.transmitted] = sample.pdf;
            }
        }
        for (int side = 0; side < 2; side++) {
            const double p = probability[side];
            assert_near(counts[side] / 20000.0, p, 5.0 * sqrt(p * (1.0 - p) / 20000.0) + 1e-15);
        }
    }
}

/* Visible normals alone: 2 D(h) (wo . h) / masking integrates to 1 over those that wo sees. */
typedef struct {
    double     alpha;
    assay_vec3 wo;
    bool       all; /* mutant: normals as in [walter07], not the visible ones */
} normals;

static bool draw_normal(const void *context, const double u[3], assay_vec3 *direction_out)
{
    const normals *n = context;
    *direction_out   = assay_ggx_sample_visible(n->alpha, n->wo, u[0], u[1]);
    return true;
}

static double normal_density(const void *context, assay_vec3 h)
{
    const normals *n = context;
    const double   seen =
        n->all ? h.z : 2.0 * fmax(0.0, vec3_dot(n->wo, h)) / assay_ggx_masking(n->alpha, n->wo.z);
    return h.z > 0.0 ? seen * assay_ggx_density(n->alpha, h) : 0.0;
}

static void test_visible_normals(void **state)
{
    (void)state;
    static const double alphas[] = {1.0, 0.5, 0.1, 0.01};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < bsdf_direction_count(); j++) {
            normals         n    = {alphas[i], bsdf_direction_at(j), false};
            statistics_grid grid = statistics_grid_between(0.0, 1.0, 16, 16);
            statistics_grid_focus(&grid, vec3(0.0, 0.0, 1.0), n.alpha);
            const double p =
                statistics_test_sampler(&grid, normal_density, draw_normal, &n, DRAWS, 5).p;
            if (!(p > statistics_sidak(0.01, 24))) {
                fail_msg("alpha %g, cos %g: p = %g", n.alpha, n.wo.z, p);
            }
            n.all = true;
            assert_true(
                j < 2 || i == 3 ||
                statistics_test_sampler(&grid, normal_density, draw_normal, &n, DRAWS, 5).p < 1e-6);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chi_square),      cmocka_unit_test(test_chi_square_mutants),
        cmocka_unit_test(test_parts),           cmocka_unit_test(test_specular_probability),
        cmocka_unit_test(test_visible_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
