/* test_light_stages.c - irradiance from cells: what candidates of few digits make lies within the
 * bounds and uses them; what is wrong lies far beyond.
 *
 * The candidate is written here, after docs/methods/gathering.md, in rounded operations and orders
 * of chance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "gather/hemisphere.h"
#include "support/measure.h"
#include "support/random_places.h"
#include "support/stage_case.h"

static const int DIGITS[] = {11, 24, 53};

/* ---- irradiance ---- */

enum { M = 6, N = 18, CELLS = M * N, RECORDS = 12 };

typedef struct {
    double radiance[3 * RECORDS * CELLS], distance[RECORDS * CELLS], direction[3 * RECORDS * CELLS];
    double frame[9 * RECORDS];
} cells;

static cells *make_cells(assay_strata strata)
{
    cells                        *d      = calloc(1, sizeof *d);
    assay_random                  random = assay_random_start(11, ASSAY_STAGE_TEST, 1, 0);
    const assay_hemisphere_layout layout = {.theta = M, .phi = N, .strata = strata};
    assert_non_null(d);
    for (size_t i = 0; i < RECORDS * CELLS; i++) {
        const int        cell = (int)(i % CELLS);
        const double     u1   = assay_random_next(&random);
        const double     u2   = assay_random_next(&random);
        const assay_vec3 w    = assay_hemisphere_direction(&layout, cell / N, cell % N, u1, u2);
        memcpy(d->direction + 3 * i, &w, sizeof w);
        d->distance[i] = i % 17 == 0 ? INFINITY : random_in(&random, 0.2, 4.0);
        for (size_t c = 0; c < 3; c++) {
            d->radiance[3 * i + c] = random_in(&random, 0.0, 3.0);
        }
    }
    for (size_t k = 0; k < RECORDS; k++) {
        const assay_frame3 frame = frame3_from_z(random_unit(&random));
        memcpy(d->frame + 9 * k, &frame, sizeof frame);
    }
    return d;
}

typedef enum {
    RIGHT,
    ARITHMETIC,    /* mean of distances that is not harmonic     */
    FLIPPED,       /* sign of the translational gradient         */
    ROTATION_SIGN, /* sign of the rotational gradient            */
    NO_WRAP,       /* phi is not cyclic                          */
    FARTHER,       /* max(r) for min(r)                          */
    LOCAL,         /* not turned to the world                    */
    NO_COSINE,     /* of uniform strata                          */
    ENERGY         /* one percent of radiance                    */
} defect;

typedef struct {
    few_digits   f;
    const cells *d;
    assay_strata strata;
    defect       defect;
    double       sin[M + 1], cos[M + 1], theta[M + 1];
} candidate;

/* Each function is rounded, its argument before it. */
static void prepare(candidate *c)
{
    for (int j = 0; j <= M; j++) {
        const double part = few(&c->f, (double)j / M);
        if (c->strata == ASSAY_STRATA_COSINE) {
            c->sin[j] = few(&c->f, sqrt(part));
            c->cos[j] = few(&c->f, sqrt(few(&c->f, 1.0 - part)));
        } else {
            c->cos[j] = few(&c->f, 1.0 - part);
            c->sin[j] = few(&c->f, sqrt(few(&c->f, 1.0 - few(&c->f, c->cos[j] * c->cos[j]))));
        }
        c->theta[j] = few(&c->f, assay_asin(c->sin[j]));
    }
}

static double azimuth(const candidate *c, double k)
{
    return few(&c->f, few(&c->f, few(&c->f, ASSAY_TWO_PI) * k) / N);
}

static double radiance_of(const candidate *c, size_t record, int j, int k, size_t channel)
{
    const size_t at = record * CELLS + (size_t)(j * N + k);
    return few(&c->f, (c->defect == ENERGY ? 1.01 : 1.0) * c->d->radiance[3 * at + channel]);
}

static double distance_of(const candidate *c, size_t record, int j, int k)
{
    return few(&c->f, c->d->distance[record * CELLS + (size_t)(j * N + k)]);
}

static int before(const candidate *c, int k)
{
    return k > 0 ? k - 1 : c->defect == NO_WRAP ? 0 : N - 1;
}

static double step_over(const candidate *c, size_t record, const int a[2], const int b[2],
                        size_t channel)
{
    const double step = few(&c->f, radiance_of(c, record, b[0], b[1], channel) -
                                       radiance_of(c, record, a[0], a[1], channel));
    const double r = distance_of(c, record, a[0], a[1]), s = distance_of(c, record, b[0], b[1]);
    const double nearer = (c->defect == FARTHER) == (r < s) ? s : r;
    return few(&c->f, step * few(&c->f, 1.0 / nearer));
}

static double few_irradiance(candidate *c, size_t record, size_t channel)
{
    double terms[CELLS];
    for (size_t i = 0; i < CELLS; i++) {
        terms[i] = radiance_of(c, record, (int)i / N, (int)i % N, channel);
        if (c->strata == ASSAY_STRATA_UNIFORM && c->defect != NO_COSINE) {
            terms[i] =
                few(&c->f, terms[i] * few(&c->f, c->d->direction[3 * (record * CELLS + i) + 2]));
        }
    }
    const double pi    = c->strata == ASSAY_STRATA_UNIFORM ? ASSAY_TWO_PI : ASSAY_PI;
    const double scale = few(&c->f, few(&c->f, pi) / CELLS);
    return few(&c->f, scale * few_sum(&c->f, CELLS, terms));
}

static double few_mean(candidate *c, size_t record)
{
    double all[CELLS], near[CELLS];
    for (int i = 0; i < CELLS; i++) {
        const double share = few(&c->f, c->cos[i / N] - c->cos[i / N + 1]);
        const double r     = distance_of(c, record, i / N, i % N);
        all[i]             = share;
        near[i]            = c->defect == ARITHMETIC ? isinf(r) ? 0.0 : few(&c->f, share * r)
                                                     : few(&c->f, share / r);
    }
    const double bottom = few_sum(&c->f, CELLS, near);
    const double top    = few_sum(&c->f, CELLS, all);
    return few(&c->f, c->defect == ARITHMETIC ? bottom / top : top / bottom);
}

static void few_to_world(candidate *c, size_t record, const double local[3], double out[3])
{
    for (size_t i = 0; i < 3; i++) {
        const double *f       = c->d->frame + 9 * record;
        const double  axes[3] = {f[i], f[3 + i], f[6 + i]};
        out[i]                = c->defect == LOCAL ? local[i] : few_dot(&c->f, 3, axes, local);
    }
}

static void few_rotation(candidate *c, size_t record, size_t channel, double out[3])
{
    double x[CELLS], y[CELLS], local[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < CELLS; i++) {
        const int    j = i / N, k = i % N;
        const double a = few(&c->f, c->theta[j] - few(&c->f, c->sin[j] * c->cos[j]));
        const double b = few(&c->f, c->theta[j + 1] - few(&c->f, c->sin[j + 1] * c->cos[j + 1]));
        const double weight = 0.5 * few(&c->f, b - a);
        const double step   = few(&c->f, radiance_of(c, record, j, k, channel) -
                                             radiance_of(c, record, j, before(c, k), channel));
        const double part   = few(&c->f, (c->defect == ROTATION_SIGN ? weight : -weight) * step);
        x[i]                = few(&c->f, part * few(&c->f, assay_cos(azimuth(c, k))));
        y[i]                = few(&c->f, part * few(&c->f, assay_sin(azimuth(c, k))));
    }
    local[0] = few_sum(&c->f, CELLS, x);
    local[1] = few_sum(&c->f, CELLS, y);
    few_to_world(c, record, local, out);
}

static void few_translation(candidate *c, size_t record, size_t channel, double out[3])
{
    double x[2 * CELLS], y[2 * CELLS], local[3] = {0.0, 0.0, 0.0};
    int    count = 0;
    for (int i = 0; i < CELLS; i++) {
        const int    j = i / N, k = i % N;
        const double sign    = c->defect == FLIPPED ? -1.0 : 1.0;
        const int    here[2] = {j, k}, left[2] = {j, before(c, k)}, inner[2] = {j - 1, k};
        const double flux     = sign * few(&c->f, c->sin[j + 1] - c->sin[j]);
        const double sideways = few(&c->f, flux * step_over(c, record, left, here, channel));
        x[count]              = few(&c->f, sideways * -few(&c->f, assay_sin(azimuth(c, k))));
        y[count++]            = few(&c->f, sideways * few(&c->f, assay_cos(azimuth(c, k))));
        if (j > 0) {
            const double chord = 2.0 * few(&c->f, assay_sin(few(&c->f, few(&c->f, ASSAY_PI) / N)));
            const double wide =
                few(&c->f, few(&c->f, few(&c->f, c->sin[j] * c->cos[j]) * c->cos[j]) * chord);
            const double outwards =
                few(&c->f, sign * wide * step_over(c, record, inner, here, channel));
            x[count]   = few(&c->f, outwards * few(&c->f, assay_cos(azimuth(c, k + 0.5))));
            y[count++] = few(&c->f, outwards * few(&c->f, assay_sin(azimuth(c, k + 0.5))));
        }
    }
    local[0] = few_sum(&c->f, (size_t)count, x);
    local[1] = few_sum(&c->f, (size_t)count, y);
    few_to_world(c, record, local, out);
}

typedef struct {
    bound_use irradiance, rotation, translation, mean, nearest;
} uses;

static void use_record(candidate *c, const stage_case *s, size_t i, uses *use)
{
    const stage_output *e = stage_case_output(s, "records/irradiance");
    const stage_output *r = stage_case_output(s, "records/rotation_gradient");
    const stage_output *t = stage_case_output(s, "records/translation_gradient");
    const stage_output *m = stage_case_output(s, "records/harmonic_mean");
    const stage_output *n = stage_case_output(s, "records/nearest");
    for (size_t k = 0; k < 3; k++) {
        double g[3];
        bound_use_add(&use->irradiance, few_irradiance(c, i, k), e->values[3 * i + k],
                      e->bounds[3 * i + k]);
        few_rotation(c, i, k, g);
        for (size_t x = 0; x < 3; x++) {
            const size_t at = 9 * i + 3 * k + x;
            bound_use_add(&use->rotation, g[x], r->values[at], r->bounds[at]);
        }
        few_translation(c, i, k, g);
        for (size_t x = 0; x < 3; x++) {
            const size_t at = 9 * i + 3 * k + x;
            bound_use_add(&use->translation, g[x], t->values[at], t->bounds[at]);
        }
    }
    bound_use_add(&use->mean, few_mean(c, i), m->values[i], m->bounds[i]);
    bound_use_add(&use->nearest, few(&c->f, n->values[i]), n->values[i], n->bounds[i]);
}

static uses use_cells(const cells *d, assay_context *context, int precision, assay_strata strata,
                      defect planted)
{
    stage_case s   = stage_case_begin(context);
    uses       use = {{0.0, 0}, {0.0, 0}, {0.0, 0}, {0.0, 0}, {0.0, 0}};
    candidate  c   = {.d = d, .strata = strata, .defect = planted};
    c.f            = (few_digits){DIGITS[precision], assay_random_start(5, ASSAY_STAGE_TEST, 2, 0)};
    stage_case_text(&s, "theta_strata", "6");
    stage_case_text(&s, "phi_strata", "18");
    stage_case_text(&s, "strata", strata == ASSAY_STRATA_COSINE ? "cosine" : "uniform");
    stage_case_table(&s, "gather/radiance", "W/(m2 sr)", RECORDS * CELLS, 3, d->radiance);
    stage_case_table(&s, "gather/distance", "m", RECORDS * CELLS, 1, d->distance);
    stage_case_table(&s, "gather/direction", "", RECORDS * CELLS, 3, d->direction);
    stage_case_table(&s, "gather/frame", "", RECORDS, 9, d->frame);
    stage_case_run(&s, "irradiance", (assay_precision)precision);
    prepare(&c);
    for (size_t i = 0; i < RECORDS; i++) {
        use_record(&c, &s, i, &use);
    }
    stage_case_end(&s);
    return use;
}

static void test_irradiance(void **state)
{
    for (int strata = ASSAY_STRATA_COSINE; strata <= ASSAY_STRATA_UNIFORM; strata++) {
        cells *d = make_cells((assay_strata)strata);
        for (int p = 0; p < 3; p++) {
            const uses u = use_cells(d, *state, p, (assay_strata)strata, RIGHT);
            print_message("strata %d, %d digits: irradiance %.3f, rotation %.3f, translation %.3f, "
                          "mean %.3f, nearest %.3f of the bound\n",
                          strata, DIGITS[p], u.irradiance.most, u.rotation.most, u.translation.most,
                          u.mean.most, u.nearest.most);
            assert_int_equal(u.irradiance.beyond + u.rotation.beyond + u.translation.beyond +
                                 u.mean.beyond + u.nearest.beyond,
                             0);
            assert_true(p == ASSAY_PRECISION_DOUBLE ||
                        (u.irradiance.most > 0.005 && u.rotation.most > 0.002 &&
                         u.translation.most > 0.002 && u.mean.most > 0.002));
        }
        free(d);
    }
}

static void test_irradiance_defects(void **state)
{
    cells       *d = make_cells(ASSAY_STRATA_COSINE), *e = make_cells(ASSAY_STRATA_UNIFORM);
    const double most = 30.0;
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, ARITHMETIC).mean.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, FLIPPED).translation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, ROTATION_SIGN).rotation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, NO_WRAP).translation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, NO_WRAP).rotation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, FARTHER).translation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, LOCAL).rotation.most > most);
    assert_true(use_cells(d, *state, 1, ASSAY_STRATA_COSINE, ENERGY).irradiance.most > most);
    assert_true(use_cells(e, *state, 1, ASSAY_STRATA_UNIFORM, NO_COSINE).irradiance.most > most);
    free(d);
    free(e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_irradiance, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_irradiance_defects, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
