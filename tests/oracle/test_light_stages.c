/* test_light_stages.c - irradiance from cells, coefficients: what candidates of few digits make
 * lies within the bounds and uses them; what is wrong lies far beyond.
 *
 * The candidates are written here: cells after docs/methods/gathering.md, functions after
 * [gautron06] eq. 3.4 to 3.7 and 3.18 as printed (with the recurrence in l, factorials and angles),
 * in rounded operations and orders of chance. */
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

/* ---- functions ---- */

enum { MOST_ORDER = 10 };

/* As printed, unnormalised: P_m^m, P_(m+1)^m, and the recurrence in l; root: sqrt(1 - x^2). */
static double few_legendre(const few_digits *f, int l, int m, double x, double root)
{
    double p = 1.0, before = 0.0;
    for (int i = 1; i <= m; i++) {
        p = few(f, few(f, p * -(2.0 * i - 1.0)) * root);
    }
    for (int k = m + 1; k <= l; k++) {
        const double a    = few(f, few(f, (2.0 * k - 1.0) * x) * p);
        const double b    = few(f, (k + m - 1.0) * before);
        const double next = few(f, few(f, a - b) / (k - m));
        before            = p;
        p                 = next;
    }
    return p;
}

static double few_norm(const few_digits *f, int l, int m, double circle)
{
    double ratio = few(f, (2.0 * l + 1.0) / few(f, circle));
    for (int i = l - m + 1; i <= l + m; i++) {
        ratio = few(f, ratio / i);
    }
    return few(f, sqrt(ratio));
}

/* SH and HSH of `thesis`; phi by its angle. */
static double few_function(const few_digits *f, bool hemisphere, int l, int m, assay_vec3 d)
{
    const int    n    = abs(m);
    const double z    = few(f, d.z);
    const double x    = hemisphere ? few(f, 2.0 * z - 1.0) : z;
    const double root = few(f, sqrt(few(f, 1.0 - few(f, x * x))));
    const double phi  = few(f, assay_atan2(few(f, d.y), few(f, d.x)));
    const double k    = few_norm(f, l, n, hemisphere ? ASSAY_TWO_PI : 4.0 * ASSAY_PI);
    const double p    = few(f, k * few_legendre(f, l, n, x, root));
    const double turn = few(f, n * phi);
    const double part = m < 0 ? few(f, assay_sin(turn)) : few(f, assay_cos(turn));
    return m == 0 ? p : few(f, few(f, few(f, sqrt(2.0)) * p) * part);
}

/* last: of the highest band alone. */
static bound_use use_projection(assay_context *context, int precision, bool hemisphere, int order,
                                bool planted, bound_use *last)
{
    enum { SAMPLES = 60 };
    double       d[3 * SAMPLES], pdf[SAMPLES], value[2 * SAMPLES];
    assay_random random = assay_random_start(6, ASSAY_STAGE_TEST, (uint64_t)order, 0);
    few_digits   f      = {DIGITS[precision], random};
    bound_use    use    = {0};
    stage_case   s      = stage_case_begin(context);
    char         text[8];
    for (size_t i = 0; i < SAMPLES; i++) {
        assay_vec3 w     = random_unit(&random);
        w.z              = hemisphere ? fabs(w.z) : w.z;
        pdf[i]           = random_in(&random, 0.05, 0.4);
        value[2 * i]     = random_in(&random, 0.0, 2.0);
        value[2 * i + 1] = random_in(&random, -1.0, 1.0);
        memcpy(d + 3 * i, &w, sizeof w);
    }
    snprintf(text, sizeof text, "%d", order);
    stage_case_text(&s, "basis", hemisphere ? "hsh" : "sh");
    stage_case_text(&s, "order", text);
    stage_case_table(&s, "project/direction", "", SAMPLES, 3, d);
    stage_case_table(&s, "project/pdf", "1/sr", SAMPLES, 1, pdf);
    stage_case_table(&s, "project/value", "W/(m2 sr)", SAMPLES, 2, value);
    stage_case_run(&s, "project", (assay_precision)precision);
    const stage_output *out = stage_case_output(&s, "project/coefficients");
    assert_string_equal(out->unit, "W/(m2 sr)");
    for (size_t i = 0; i < out->rows * out->columns; i++) {
        double    terms[SAMPLES];
        const int index = (int)(i % out->columns);
        int       l     = 0;
        while ((l + 1) * (l + 1) <= index) {
            l++;
        }
        for (size_t k = 0; k < SAMPLES; k++) {
            const double v = few(&f, few(&f, value[2 * k + i / out->columns]) / few(&f, pdf[k]));
            const int    m = index - l * l - l;
            const double y = few_function(&f, hemisphere, l, planted ? -m : m,
                                          vec3(d[3 * k], d[3 * k + 1], d[3 * k + 2]));
            terms[k]       = few(&f, v * y);
        }
        const double mean = few(&f, few_sum(&f, SAMPLES, terms) / SAMPLES);
        bound_use_add(&use, mean, out->values[i], out->bounds[i]);
        if (l == order - 1) {
            bound_use_add(last, mean, out->values[i], out->bounds[i]);
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_project(void **state)
{
    for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
        for (int order = 1; order <= MOST_ORDER; order += 3) {
            for (int p = 0; p < 3; p++) {
                bound_use       last = {0.0, 0};
                const bound_use u    = use_projection(*state, p, hemisphere, order, false, &last);
                print_message("project, %s, order %d, %d digits: %.3f of the bound, band %d %.3f\n",
                              hemisphere ? "hsh" : "sh", order, DIGITS[p], u.most, order - 1,
                              last.most);
                assert_int_equal(u.beyond, 0);
                assert_true(p == ASSAY_PRECISION_DOUBLE || last.most > 0.001);
            }
        }
        bound_use last = {0.0, 0};
        assert_true(use_projection(*state, 1, hemisphere, 4, true, &last).most > 100.0);
    }
}

/* ---- matrices ---- */

enum { ORDER = 6, COUNT = ORDER * ORDER, ROWS = 5 };

static void make_rows(double rows[ROWS * COUNT])
{
    assay_random random = assay_random_start(8, ASSAY_STAGE_TEST, 3, 0);
    for (size_t i = 0; i < ROWS * COUNT; i++) {
        rows[i] = random_in(&random, -1.0, 1.0);
    }
}

/* What a dense product with a matrix that is rounded once makes; from the stage's own matrix. */
static bound_use use_product(const stage_case *s, int precision, const char *name,
                             const double *matrix, size_t count, const double *rows)
{
    few_digits          f   = {DIGITS[precision], assay_random_start(9, ASSAY_STAGE_TEST, 3, 0)};
    bound_use           use = {0};
    const stage_output *out = stage_case_output(s, name);
    for (size_t i = 0; i < out->rows * out->columns; i++) {
        const double *row = matrix + (i % out->columns) * count;
        bound_use_add(&use, few_dot(&f, count, row, rows + (i / out->columns) * count),
                      out->values[i], out->bounds[i]);
    }
    return use;
}

static void test_rotate(void **state)
{
    double       rows[ROWS * COUNT], matrix[COUNT * COUNT], rotation[9];
    assay_basis *sh = NULL;
    make_rows(rows);
    assert_int_equal(
        assay_basis_create(*state, ASSAY_BASIS_SH, ORDER, ASSAY_CONVENTION_THESIS, &sh), ASSAY_OK);
    assay_rotation_from_euler_zyz(0.3, 1.1, -2.0, rotation);
    assert_int_equal(assay_sh_rotation(sh, rotation, matrix), ASSAY_OK);
    for (int given = 0; given < 2; given++) {
        for (int p = 0; p < 3; p++) {
            stage_case s = stage_case_begin(*state);
            stage_case_text(&s, "order", "6");
            stage_case_text(&s, "alpha", "0.3");
            stage_case_text(&s, "beta", "1.1");
            stage_case_text(&s, "gamma", "-2");
            stage_case_table(&s, "rotate/in", "W/(m2 sr)", ROWS, COUNT, rows);
            if (given) {
                stage_case_table(&s, "rotate/matrix", "", COUNT, COUNT, matrix);
            }
            stage_case_run(&s, "rotate", (assay_precision)p);
            const bound_use u = use_product(&s, p, "rotate/out", matrix, COUNT, rows);
            print_message("rotate, given %d, %d digits: %.3f of the bound\n", given, DIGITS[p],
                          u.most);
            assert_int_equal(u.beyond, 0);
            assert_true(p == ASSAY_PRECISION_DOUBLE || u.most > 0.003);
            stage_case_end(&s);
        }
    }
    /* The other sense of rotation. */
    stage_case s = stage_case_begin(*state);
    stage_case_text(&s, "order", "6");
    stage_case_text(&s, "alpha", "2");
    stage_case_text(&s, "beta", "-1.1");
    stage_case_text(&s, "gamma", "-0.3");
    stage_case_table(&s, "rotate/in", "W/(m2 sr)", ROWS, COUNT, rows);
    stage_case_run(&s, "rotate", ASSAY_PRECISION_FLOAT);
    assert_true(use_product(&s, 1, "rotate/out", matrix, COUNT, rows).most > 100.0);
    stage_case_end(&s);
    assay_basis_destroy(sh);
}

static void dense_of(const assay_sparse *sparse, bool transposed, double *dense)
{
    const assay_sparse_view c = assay_sparse_entries(sparse);
    memset(dense, 0, c.rows * c.columns * sizeof *dense);
    for (size_t i = 0; i < c.rows; i++) {
        for (size_t k = c.row_start[i]; k < c.row_start[i + 1]; k++) {
            dense[transposed ? c.column[k] * c.rows + i : i * c.columns + c.column[k]] = c.value[k];
        }
    }
}

static void test_convert(void **state)
{
    double        rows[ROWS * COUNT], matrix[COUNT * COUNT];
    assay_basis  *sh = NULL, *hsh = NULL;
    assay_sparse *sparse = NULL;
    make_rows(rows);
    assert_int_equal(
        assay_basis_create(*state, ASSAY_BASIS_SH, ORDER, ASSAY_CONVENTION_THESIS, &sh), ASSAY_OK);
    assert_int_equal(
        assay_basis_create(*state, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &hsh),
        ASSAY_OK);
    assert_int_equal(assay_basis_conversion(*state, sh, hsh, &sparse), ASSAY_OK);
    for (int p = 0; p < 3; p++) {
        stage_case s = stage_case_begin(*state);
        stage_case_text(&s, "from_order", "6");
        stage_case_text(&s, "to_order", "6");
        stage_case_table(&s, "convert/in", "", ROWS, COUNT, rows);
        stage_case_run(&s, "convert", (assay_precision)p);
        dense_of(sparse, false, matrix);
        const bound_use u = use_product(&s, p, "convert/out", matrix, COUNT, rows);
        dense_of(sparse, true, matrix);
        const bound_use bad = use_product(&s, p, "convert/out", matrix, COUNT, rows);
        print_message("convert, %d digits: %.3f of the bound; transposed %.3g\n", DIGITS[p], u.most,
                      bad.most);
        assert_int_equal(u.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || u.most > 0.1);
        assert_true(p == ASSAY_PRECISION_HALF || bad.most > 1000.0);
        stage_case_end(&s);
    }
    assay_sparse_destroy(sparse);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

static void test_reflect(void **state)
{
    enum { POINTS = 40, N_LIGHT = 3 * COUNT };
    static double light[POINTS * N_LIGHT], brdf[POINTS * N_LIGHT];
    assay_random  random = assay_random_start(10, ASSAY_STAGE_TEST, 3, 0);
    for (size_t i = 0; i < POINTS * N_LIGHT; i++) {
        light[i] = random_in(&random, -1.0, 2.0);
        brdf[i]  = random_in(&random, -0.5, 1.0);
    }
    for (int p = 0; p < 3; p++) {
        stage_case s   = stage_case_begin(*state);
        bound_use  use = {0}, bad = {0};
        few_digits f = {DIGITS[p], random};
        stage_case_table(&s, "reflect/light", "W/(m2 sr)", POINTS, N_LIGHT, light);
        stage_case_table(&s, "reflect/brdf", "1/sr", POINTS, N_LIGHT, brdf);
        stage_case_run(&s, "reflect", (assay_precision)p);
        const stage_output *out = stage_case_output(&s, "reflect/radiance");
        for (size_t i = 0; i < 3 * POINTS; i++) {
            const double *a = light + i * COUNT, *b = brdf + i * COUNT;
            bound_use_add(&use, few_dot(&f, COUNT, a, b), out->values[i], out->bounds[i]);
            bound_use_add(&bad, few_dot(&f, COUNT - 1, a, b), out->values[i], out->bounds[i]);
        }
        print_message("reflect, %d digits: %.3f of the bound\n", DIGITS[p], use.most);
        assert_int_equal(use.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || use.most > 0.03);
        assert_true(p == ASSAY_PRECISION_HALF || bad.most > 1000.0);
        stage_case_end(&s);
    }
}

/* 1, and what is just above half a unit of its last place: every addition rounds up. */
static void test_worst_sum(void **state)
{
    double       light[3 * COUNT], brdf[3 * COUNT];
    const double small = 0x1.00001p-24;
    float        sum   = 0.0f;
    for (size_t i = 0; i < (size_t)3 * COUNT; i++) {
        light[i] = i % COUNT == 0 ? 1.0 : small;
        brdf[i]  = 1.0;
    }
    for (size_t i = 0; i < COUNT; i++) {
        sum = sum + (float)light[i];
    }
    stage_case s = stage_case_begin(*state);
    stage_case_table(&s, "reflect/light", "W/(m2 sr)", 1, (size_t)3 * COUNT, light);
    stage_case_table(&s, "reflect/brdf", "1/sr", 1, (size_t)3 * COUNT, brdf);
    stage_case_run(&s, "reflect", ASSAY_PRECISION_FLOAT);
    const stage_output *out   = stage_case_output(&s, "reflect/radiance");
    const double        error = fabs(sum - out->values[0]);
    assert_true(error > 30.0 * 0x1p-24 && error <= out->bounds[0]);
    stage_case_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_irradiance, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_irradiance_defects, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_project, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_rotate, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_convert, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_reflect, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_worst_sum, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
