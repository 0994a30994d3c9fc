/* test_coefficient_stages.c - projecting, rotating, converting, reflecting: what candidates of few
 * digits make lies within the bounds and uses them; what is wrong lies far beyond.
 *
 * Functions are written here, after [gautron06] eq. 3.4 to 3.7 and 3.18 as printed (with the
 * recurrence in l, factorials and angles), in rounded operations and orders of chance. */
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

/* last: of m = 0 of the highest band alone, whose recurrence is the longest. */
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
        if (l == order - 1 && index == l * l + l) {
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
        cmocka_unit_test_setup_teardown(test_project, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_rotate, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_convert, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_reflect, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_worst_sum, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
