/* stage_case.c - the arithmetic is double's, rounded once more: for +, -, *, / and sqrt of numbers
 * with at most 24 digits that is the correctly rounded result (53 >= 2 * 24 + 2, [figueroa95]). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "stage_case.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/array.h"

/* ---- bundles ---- */

stage_case stage_case_begin(assay_context *context)
{
    stage_case  c    = {.context = context};
    const char *root = getenv("TMPDIR");
    snprintf(c.root, sizeof c.root, "%.200s/assay-test-XXXXXX", root ? root : "/tmp");
    assert_non_null(mkdtemp(c.root));
    snprintf(c.path, sizeof c.path, "%s/bundle", c.root);
    assert_int_equal(assay_bundle_create(context, c.path, &c.bundle), ASSAY_OK);
    return c;
}

void stage_case_text(const stage_case *c, const char *key, const char *value)
{
    assert_int_equal(assay_bundle_describe(c->bundle, key, value), ASSAY_OK);
}

void stage_case_table(const stage_case *c, const char *name, const char *unit, size_t rows,
                      size_t columns, const double *values)
{
    assay_array *table = NULL;
    assert_int_equal(assay_array_create(c->context, rows, columns, &table), ASSAY_OK);
    memcpy(assay_array_data(table), values, rows * columns * sizeof *values);
    assert_int_equal(assay_bundle_add_table(c->bundle, name, unit, table), ASSAY_OK);
    assay_array_destroy(table);
}

void stage_case_finish(const stage_case *c)
{
    assert_int_equal(assay_bundle_finish(c->bundle), ASSAY_OK);
}

void stage_case_run(stage_case *c, const char *stage, assay_precision precision)
{
    stage_case_finish(c);
    assert_int_equal(assay_bundle_open(c->context, c->path, &c->reader), ASSAY_OK);
    const oracle_stage *found = assay_stage_find(stage);
    assert_non_null(found);
    if (stage_run_start(&c->run, c->context, found, c->reader, c->scene, &precision, 0, NULL) !=
        ASSAY_OK) {
        fail_msg("%s", assay_context_error(c->context));
    }
}

const stage_output *stage_case_output(const stage_case *c, const char *name)
{
    for (int i = 0; i < c->run.out_count; i++) {
        if (strcmp(c->run.out[i].name, name) == 0) {
            return &c->run.out[i];
        }
    }
    fail_msg("no output %s", name);
    return NULL;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

void stage_case_end(stage_case *c)
{
    if (c->reader) {
        stage_run_release(&c->run);
    }
    assay_bundle_close(c->reader);
    assay_bundle_destroy(c->bundle);
    assert_int_equal(nftw(c->root, remove_entry, 16, FTW_DEPTH | FTW_PHYS), 0);
}

/* ---- few digits ---- */

double few(const few_digits *f, double x)
{
    int exponent = 0;
    if (f->digits == 53 || x == 0.0 || !isfinite(x)) {
        return x;
    }
    const double fraction = frexp(x, &exponent); /* in [1/2, 1) */
    return ldexp(nearbyint(ldexp(fraction, f->digits)), exponent - f->digits);
}

static double sum_in_halves(const few_digits *f, size_t count, const double *terms)
{
    if (count == 1) {
        return terms[0];
    }
    const size_t half = count / 2;
    const double a    = sum_in_halves(f, half, terms);
    return few(f, a + sum_in_halves(f, count - half, terms + half));
}

double few_sum(few_digits *f, size_t count, double *terms)
{
    for (size_t i = count; i > 1; i--) {
        const size_t k    = (size_t)(assay_random_next(&f->random) * (double)i);
        const double last = terms[i - 1];
        terms[i - 1]      = terms[k];
        terms[k]          = last;
    }
    if (count > 0 && assay_random_next(&f->random) < 0.5) {
        return sum_in_halves(f, count, terms);
    }
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum = few(f, sum + terms[i]);
    }
    return sum;
}

double few_dot(few_digits *f, size_t count, const double *a, const double *b)
{
    double *terms = malloc((count + 1) * sizeof *terms);
    assert_non_null(terms);
    for (size_t i = 0; i < count; i++) {
        terms[i] = few(f, few(f, a[i]) * few(f, b[i]));
    }
    const double sum = few_sum(f, count, terms);
    free(terms);
    return sum;
}

/* ---- comparing ---- */

void bound_use_add(bound_use *use, double value, double right, double bound)
{
    const double part = value == right ? 0.0 : fabs(value - right) / bound;
    use->beyond += !(part <= 1.0);
    use->most = part > use->most ? part : use->most;
}
