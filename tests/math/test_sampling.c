/* Every routine of math/sampling.h against its density, at the ends of the unit square, and against
 * densities that are wrong. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../support/near.h"
#include "../support/statistics.h"
#include "core/random.h"
#include "math/sampling.h"

enum { DRAWS = 400000, CASES = 8 };

typedef struct {
    const char *name;
    assay_vec3 (*sample)(double height, double u1, double u2);
    double (*pdf)(double height, double z);
    double height; /* of cones */
    double scale;  /* of the density: other than 1 in mutants */
} routine;

static assay_vec3 sphere(double h, double u1, double u2)
{
    (void)h;
    return assay_sample_sphere(u1, u2);
}
static double sphere_pdf(double h, double z)
{
    (void)h;
    (void)z;
    return assay_sphere_pdf();
}
static assay_vec3 hemisphere(double h, double u1, double u2)
{
    (void)h;
    return assay_sample_hemisphere(u1, u2);
}
static double hemisphere_pdf(double h, double z)
{
    (void)h;
    return assay_hemisphere_pdf(z);
}
static assay_vec3 cosine(double h, double u1, double u2)
{
    (void)h;
    return assay_sample_cosine_hemisphere(u1, u2);
}
static double cosine_pdf(double h, double z)
{
    (void)h;
    return assay_cosine_hemisphere_pdf(z);
}
/* The disk, lifted to the hemisphere over it, has the density of the cosine (Nusselt's analog). */
static assay_vec3 lifted_disk(double h, double u1, double u2)
{
    (void)h;
    const assay_point2 p = assay_sample_disk(u1, u2);
    return vec3(p.x, p.y, sqrt(fmax(0.0, 1.0 - p.x * p.x - p.y * p.y)));
}

static const routine ROUTINES[CASES] = {
    {"sphere", sphere, sphere_pdf, 0.0, 1.0},
    {"hemisphere", hemisphere, hemisphere_pdf, 0.0, 1.0},
    {"cosine", cosine, cosine_pdf, 0.0, 1.0},
    {"disk", lifted_disk, cosine_pdf, 0.0, 1.0},
    {"cone 2", assay_sample_cone, assay_cone_pdf, 2.0, 1.0},
    {"cone 1", assay_sample_cone, assay_cone_pdf, 1.0, 1.0},
    {"cone 0.1", assay_sample_cone, assay_cone_pdf, 0.1, 1.0},
    {"cone 1e-3", assay_sample_cone, assay_cone_pdf, 1e-3, 1.0},
};

static bool draw(const void *context, const double u[3], assay_vec3 *direction_out)
{
    const routine *r = context;
    *direction_out   = r->sample(r->height, u[0], u[1]);
    return true;
}

static double density(const void *context, assay_vec3 w)
{
    const routine *r = context;
    return r->scale * r->pdf(r->height, w.z);
}

/* The grid reaches just as far as the density, so that no cell is cut. */
static double p_value(const routine *r, const routine *sampled, uint64_t seed)
{
    const double low = r->height > 0.0 ? 1.0 - r->height : (r->pdf == sphere_pdf ? -1.0 : 0.0);
    const statistics_grid grid  = statistics_grid_between(low, 1.0, 20, 20);
    routine               mixed = *r;
    mixed.sample                = sampled->sample;
    return statistics_test_sampler(&grid, density, draw, &mixed, DRAWS, seed).p;
}

static void test_directions(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; i++) {
        const double p = p_value(&ROUTINES[i], &ROUTINES[i], (uint64_t)i);
        if (!(p > statistics_sidak(0.01, CASES))) {
            fail_msg("%s: p = %g", ROUTINES[i].name, p);
        }
    }
}

static void test_mutants(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; i++) {
        static const double scales[] = {2.0, 0.5, 1.01, 0.99};
        for (int j = 0; j < 4; j++) {
            routine mutant = ROUTINES[i];
            mutant.scale   = scales[j];
            assert_true(p_value(&mutant, &ROUTINES[i], 1) < 1e-6);
        }
    }
    assert_true(p_value(&ROUTINES[1], &ROUTINES[2], 1) < 1e-6); /* cosine dropped   */
    assert_true(p_value(&ROUTINES[2], &ROUTINES[1], 1) < 1e-6); /* cosine too much  */
    assert_true(p_value(&ROUTINES[1], &ROUTINES[0], 1) < 1e-6); /* the other side   */
}

/* Barycentric cells of equal area: 10 rows and diagonals cut the triangle into 100 like ones. */
static double triangle_p(assay_point2 (*sample)(double, double))
{
    enum { N = 10 };
    int observed[N * N] = {0};
    for (int k = 0; k < DRAWS; k++) {
        assay_random       random = assay_random_start(3, ASSAY_STAGE_TEST, 0, (uint32_t)k);
        const double       u1     = assay_random_next(&random);
        const double       u2     = assay_random_next(&random);
        const assay_point2 p      = sample(u1, u2);
        assert_true(p.x >= 0.0 && p.y >= 0.0 && p.x + p.y < 1.0);
        const int  i = (int)(N * p.x), j = (int)(N * p.y);
        const bool upper = N * p.x - i + (N * p.y - j) > 1.0;
        /* Lower halves in the triangle i + j < N, upper halves folded into what is left over. */
        observed[upper ? (N - 1 - i) * N + (N - 1 - j) : i * N + j]++;
    }
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const double e = (double)DRAWS / (N * N);
        sum += (observed[i] - e) * (observed[i] - e) / e;
    }
    return statistics_chi_square_tail(sum, N * N - 1);
}

static assay_point2 without_root(double u1, double u2)
{
    return (assay_point2){u1 * (1.0 - u2), u1 * u2};
}

static void test_triangle(void **state)
{
    (void)state;
    assert_true(triangle_p(assay_sample_triangle) > 0.01);
    assert_true(triangle_p(without_root) < 1e-6);
}

/* Unit length within rounding, the right side, and no surprise at the ends of the intervals. */
static void test_corners(void **state)
{
    (void)state;
    static const double ends[] = {0.0, 0x1p-53, 0.25, 0.5, 0.75, 1.0 - 0x1p-53};
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < CASES; k++) {
                const routine   *r = &ROUTINES[k];
                const assay_vec3 w = r->sample(r->height, ends[i], ends[j]);
                assert_near(vec3_length(w), 1.0, 4e-16);
                assert_true(r->pdf(r->height, w.z) > 0.0 || (r->sample == lifted_disk));
            }
        }
    }
    /* A cone of 1e-8 rad keeps its shape: sin = sqrt(2 height u1) to rounding. */
    const assay_vec3 w = assay_sample_cone(0.5e-16, 0.25, 0.0);
    assert_near(w.x, 0.5e-8, 1e-22);
    assert_near(w.z, 1.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions),
        cmocka_unit_test(test_mutants),
        cmocka_unit_test(test_triangle),
        cmocka_unit_test(test_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
