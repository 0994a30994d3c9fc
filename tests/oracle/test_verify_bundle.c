/* test_verify_bundle.c - bundles against bundles: what is right passes, what is wrong fails at the
 * stage where it was planted, what cannot be compared is refused by name. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/failing_context.h"
#include "support/measure.h"
#include "support/random_places.h"
#include "support/splat_room.h"
#include "support/stage_case.h"

enum { RECORDS = 200, SIDE = 16, PIXELS = SIDE * SIDE };

static const char *const ARRAYS[] = {"records/position",
                                     "records/normal",
                                     "records/radius",
                                     "records/irradiance",
                                     "records/rotation_gradient",
                                     "records/translation_gradient",
                                     "splat/position",
                                     "splat/frame",
                                     "splat/albedo",
                                     "splat/batch.0/weight",
                                     "splat/batch.0/radiance",
                                     "splat/result",
                                     "radiance/direct",
                                     "radiance/indirect",
                                     "radiance/total"};
static const char *const UNITS[]  = {
     "m", "", "m",         "W/m2",      "W/(m2 rad)", "W/m3",      "m",        "",
     "",  "", "W/(m2 sr)", "W/(m2 sr)", "W/(m2 sr)",  "W/(m2 sr)", "W/(m2 sr)"};
enum { ARRAY_COUNT = sizeof ARRAYS / sizeof ARRAYS[0], MOST = 9 * PIXELS };
static const size_t COLUMNS[ARRAY_COUNT] = {3, 3, 1, 3, 9, 9, 3, 9, 3, 1, 3, 3, 3, 3, 3};
enum { POSITION = 6, ALBEDO = 8, INPUTS = 11 };
/* A pixel at record 5: its weight is 1e12, or what a float makes of that. */
enum { STANDS = 33 };

enum { WEIGHT = 9, SUM, RESULT, DIRECT, INDIRECT, TOTAL };

typedef struct {
    double values[ARRAY_COUNT][MOST];
} data;

static size_t rows_of(int array) { return array < 6 ? RECORDS : PIXELS; }

/* Stages of a right candidate of float: everything is a float. */
static void round_all(data *d)
{
    const few_digits single = {.digits = 24};
    for (int a = 0; a < ARRAY_COUNT; a++) {
        for (size_t i = 0; i < MOST; i++) {
            d->values[a][i] = few(&single, d->values[a][i]);
        }
    }
}

static assay_vec3 vec3_at(const double *v) { return vec3(v[0], v[1], v[2]); }

static void make_inputs(data *d)
{
    const assay_camera camera = splat_room_camera(false);
    for (uint32_t k = 0; k < RECORDS; k++) {
        const assay_record r = splat_room_record(5, RECORDS, k);
        memcpy(&d->values[0][3 * k], &r.position, sizeof r.position);
        memcpy(&d->values[1][3 * k], &r.normal, sizeof r.normal);
        memcpy(&d->values[3][3 * k], &r.irradiance, sizeof r.irradiance);
        memcpy(&d->values[4][9 * k], r.rotation, sizeof r.rotation);
        memcpy(&d->values[5][9 * k], r.translation, sizeof r.translation);
        d->values[2][k] = r.radius;
    }
    for (size_t i = 0; i < PIXELS; i++) {
        assay_vec3 p = vec3(NAN, NAN, NAN), n = vec3(0.0, 0.0, 1.0);
        splat_room_point(&camera, SIDE, SIDE, i, &p, &n);
        p = i == 7 ? vec3(NAN, NAN, NAN) : p;
        if (i == STANDS) {
            p = vec3_at(&d->values[0][15]);
            n = vec3_at(&d->values[1][15]);
        }
        memcpy(&d->values[6][3 * i], &p, sizeof p);
        memcpy(&d->values[7][9 * i + 6], &n, sizeof n);
        for (size_t c = 0; c < 3; c++) {
            d->values[8][3 * i + c]      = 0.25 + 0.25 * (double)c;
            d->values[DIRECT][3 * i + c] = 0.01 * (double)((7 * i + c) % 50);
        }
    }
}

static void add_arrays(const stage_case *c, const data *d, int without)
{
    stage_case_text(c, "assay:method", "splat");
    stage_case_text(c, "assay:splat.a", "0.25");
    stage_case_text(c, "assay:scene.digest", "abc");
    stage_case_text(c, "assay:camera.position", "1 2 3");
    for (int a = 0; a < ARRAY_COUNT; a++) {
        if (a != without) {
            stage_case_table(c, ARRAYS[a], UNITS[a], rows_of(a), COLUMNS[a], d->values[a]);
        }
    }
}

/* A stage of our own makes what comes next. */
static void run_stage(assay_context *context, data *d, const char *stage)
{
    stage_case c = stage_case_begin(context);
    add_arrays(&c, d, -1);
    stage_case_run(&c, stage, ASSAY_PRECISION_FLOAT);
    for (int i = 0; i < c.run.out_count; i++) {
        for (int a = 0; a < ARRAY_COUNT; a++) {
            if (strcmp(ARRAYS[a], c.run.out[i].name) == 0) {
                memcpy(d->values[a], c.run.out[i].values, rows_of(a) * COLUMNS[a] * sizeof(double));
            }
        }
    }
    stage_case_end(&c);
    round_all(d);
}

static void make_stages(assay_context *context, data *d)
{
    run_stage(context, d, "splat");
    run_stage(context, d, "normalise");
    run_stage(context, d, "combine");
}

static data *make_data(assay_context *context)
{
    data *d = calloc(1, sizeof *d);
    assert_non_null(d);
    make_inputs(d);
    round_all(d);
    make_stages(context, d);
    memcpy(d->values[INDIRECT], d->values[RESULT], sizeof d->values[RESULT]);
    run_stage(context, d, "combine");
    return d;
}

static assay_verdict *verify(assay_context *context, const data *candidate, const data *reference,
                             assay_precision precision)
{
    stage_case     c = stage_case_begin(context), r = stage_case_begin(context);
    assay_verdict *verdict = NULL;
    add_arrays(&c, candidate, -1);
    add_arrays(&r, reference ? reference : candidate, -1);
    stage_case_finish(&c);
    stage_case_finish(&r);
    assert_int_equal(assay_verdict_create(context, "candidate", "reference", &verdict), ASSAY_OK);
    if (assay_verify_bundle(context, c.path, reference ? r.path : NULL, NULL, precision, verdict) !=
        ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    stage_case_end(&c);
    stage_case_end(&r);
    return verdict;
}

static int count_of(const assay_verdict *verdict, const char *stage)
{
    int count = 0;
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        count += strcmp(assay_verdict_at(verdict, i).stage, stage) == 0;
    }
    return count;
}

static void test_right(void **state)
{
    data          *d       = make_data(*state);
    assay_verdict *verdict = verify(*state, d, d, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_count(verdict), 5 + INPUTS);
    assert_string_equal(assay_verdict_at(verdict, 0).stage, "splat");
    assert_string_equal(assay_verdict_at(verdict, 2).stage, "splat-light");
    assert_string_equal(assay_verdict_at(verdict, 3).stage, "normalise");
    assert_string_equal(assay_verdict_at(verdict, 4).stage, "combine");
    assert_string_equal(assay_verdict_get(verdict, "precision"), "float");
    assert_int_equal(count_of(verdict, "inputs"), INPUTS);
    assert_null(assay_verdict_get(verdict, "not judged"));
    for (int i = 0; i < 5; i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        assert_true(f.in_bounds >= 0.0 && f.in_bounds <= 1.0 && f.bound > 0.0);
        assert_int_equal(f.values, PIXELS * (i == 0 ? 1 : 3));
    }
    assay_verdict_destroy(verdict);
    /* A float's rounding is seen by who asks for doubles. */
    verdict = verify(*state, d, d, ASSAY_PRECISION_DOUBLE);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_FAIL);
    assay_verdict_destroy(verdict);
    free(d);
}

/* Another albedo, and all that follows from it: every stage is right, on inputs that are not. */
static void test_inputs(void **state)
{
    data *d = make_data(*state), *other = malloc(sizeof *other);
    assert_non_null(other);
    memcpy(other, d, sizeof *other);
    other->values[ALBEDO][31] *= 1.0 + 0x1p-22;
    round_all(other);
    make_stages(*state, other);
    assay_verdict      *verdict = verify(*state, other, d, ASSAY_PRECISION_FLOAT);
    const assay_finding f       = assay_verdict_at(verdict, assay_verdict_first(verdict));
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_string_equal(f.stage, "inputs");
    assert_string_equal(f.array, "splat/albedo");
    assert_true(f.place.row == 10 && f.place.column == 1 && f.in_bounds > 1.0);
    assay_verdict_destroy(verdict);
    /* Rounded to halves it is what a half has of it. */
    verdict = verify(*state, other, d, ASSAY_PRECISION_HALF);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    verdict = verify(*state, other, NULL, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(count_of(verdict, "inputs"), 0);
    assert_non_null(strstr(assay_verdict_get(verdict, "not judged"), "splat/albedo"));
    assert_null(strstr(assay_verdict_get(verdict, "not judged"), "splat/result"));
    assay_verdict_destroy(verdict);
    /* What is rounded once is the reference's. */
    memcpy(other, d, sizeof *other);
    other->values[DIRECT][3] *= 1.0 + 0.9 * 0x1p-24;
    verdict = verify(*state, d, other, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    free(other);
    free(d);
}

/* Who asks nothing of any pixel makes no mistake in any stage, and no image. */
static void test_nothing_asked(void **state)
{
    static const int made[] = {WEIGHT, SUM, RESULT};
    for (int all = 0; all < 2; all++) {
        data *d = make_data(*state), *mine = malloc(sizeof *mine);
        assert_non_null(mine);
        memcpy(mine, d, sizeof *mine);
        for (size_t i = all ? 0 : 100; i < (all ? PIXELS : 101); i++) {
            for (size_t a = 0; a < 3; a++) {
                const size_t columns = COLUMNS[made[a]];
                memset(&mine->values[made[a]][columns * i], 0, columns * sizeof(double));
            }
            for (size_t c = 0; c < 3; c++) {
                mine->values[POSITION][3 * i + c] = NAN;
            }
        }
        assay_verdict      *verdict = verify(*state, mine, d, ASSAY_PRECISION_FLOAT);
        const assay_finding f       = assay_verdict_at(verdict, assay_verdict_first(verdict));
        assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
        assert_string_equal(f.array, "splat/position");
        assert_int_equal(f.place.row, all ? 0 : 100);
        assay_verdict_destroy(verdict);
        free(mine);
        free(d);
    }
}

/* Both parts are just short of the middle between two of a half's smallest steps, so their sum
 * loses nearly one. */
static void test_small_halves(void **state)
{
    enum { AT = 3 * 7 };
    static const struct {
        double             taken, total;
        assay_verdict_kind kind;
    } cases[] = {{16.49, 24.0, ASSAY_VERDICT_PASS},
                 {16.0, 24.0, ASSAY_VERDICT_PASS},
                 {16.49, 23.0, ASSAY_VERDICT_FAIL},
                 {15.0, 23.0, ASSAY_VERDICT_CANNOT_TELL}};
    data *d = make_data(*state), *mine = malloc(sizeof *mine);
    assert_non_null(mine);
    d->values[DIRECT][AT]   = 16.49 * 0x1p-24;
    d->values[INDIRECT][AT] = 8.49 * 0x1p-24;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        memcpy(mine, d, sizeof *mine);
        mine->values[DIRECT][AT] = cases[i].taken * 0x1p-24;
        mine->values[TOTAL][AT]  = cases[i].total * 0x1p-24;
        assay_verdict *verdict   = verify(*state, mine, d, ASSAY_PRECISION_HALF);
        assert_int_equal(assay_verdict_whole(verdict), cases[i].kind);
        assay_verdict_destroy(verdict);
    }
    free(mine);
    free(d);
}

/* Something planted in one array, and where it must be found. */
typedef struct {
    const char *name;
    int         array;
    double      factor, offset;
    size_t      first, end; /* rows of all columns; 0, 0: all */
    const char *stage, *meaning;
} planted;

static const planted DEFECTS[] = {
    {"a weight", WEIGHT, 1.0001, 0.0, 40, 41, "splat", "made in it"},
    {"all weights", WEIGHT, 0.99, 0.0, 0, 0, "splat", "0.99 times"},
    {"the sums", SUM, 3.14159265358979, 0.0, 0, 0, "splat", "3.14159 times"},
    {"radiance where a record stands", SUM, 1.05, 0.0, STANDS, STANDS + 1, "splat-light",
     "made in it"},
    {"the results", RESULT, -1.0, 0.0, 0, 0, "normalise", "wrong sign"},
    {"one result", RESULT, 1.0, 1e-4, 100, 101, "normalise", "made in it"},
    {"the image", TOTAL, 1.0, 0.001, 0, 128, "combine", "made in it"},
};

static void test_planted(void **state)
{
    data *d = make_data(*state), *bad = malloc(sizeof *bad);
    assert_non_null(bad);
    for (size_t i = 0; i < sizeof DEFECTS / sizeof DEFECTS[0]; i++) {
        const planted *p   = &DEFECTS[i];
        const size_t   end = p->end ? p->end : rows_of(p->array);
        memcpy(bad, d, sizeof *bad);
        for (size_t k = p->first * COLUMNS[p->array]; k < end * COLUMNS[p->array]; k++) {
            bad->values[p->array][k] = p->factor * bad->values[p->array][k] + p->offset;
        }
        assay_verdict *verdict = verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
        const int      first   = assay_verdict_first(verdict);
        if (assay_verdict_whole(verdict) != ASSAY_VERDICT_FAIL) {
            fail_msg("%s: not seen", p->name);
        }
        const assay_finding f = assay_verdict_at(verdict, first);
        assert_string_equal(f.stage, p->stage);
        assert_string_equal(f.array, ARRAYS[p->array]);
        assert_true(f.in_bounds > 1.0 && f.ulps > 1.0);
        if (!strstr(f.meaning, p->meaning)) {
            fail_msg("%s: %s", p->name, f.meaning);
        }
        if (p->end == p->first + 1) {
            assert_int_equal(f.place.kind, ASSAY_PLACE_ROW);
            assert_int_equal(f.place.row, p->first);
        }
        assay_verdict_destroy(verdict);
    }
    free(bad);
    free(d);
}

static void test_channels(void **state)
{
    data *d = make_data(*state), *bad = malloc(sizeof *bad);
    assert_non_null(bad);
    memcpy(bad, d, sizeof *bad);
    for (size_t i = 0; i < PIXELS; i++) {
        bad->values[TOTAL][3 * i]     = d->values[TOTAL][3 * i + 2];
        bad->values[TOTAL][3 * i + 2] = d->values[TOTAL][3 * i];
    }
    assay_verdict      *verdict = verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    const assay_finding f       = assay_verdict_at(verdict, assay_verdict_first(verdict));
    assert_string_equal(f.stage, "combine");
    assert_non_null(strstr(f.meaning, "exchanged"));
    assert_true(strcmp(f.channel, "R") == 0 || strcmp(f.channel, "B") == 0);
    assay_verdict_destroy(verdict);
    free(bad);
    free(d);
}

/* ---- refusing ---- */

static void refuse(assay_context *context, const stage_case *c, const data *reference,
                   assay_status status, const char *word)
{
    stage_case     r       = stage_case_begin(context);
    assay_verdict *verdict = NULL;
    add_arrays(&r, reference, -1);
    stage_case_finish(&r);
    assert_int_equal(assay_verdict_create(context, "candidate", "reference", &verdict), ASSAY_OK);
    const assay_status got =
        assay_verify_bundle(context, c->path, r.path, NULL, ASSAY_PRECISION_FLOAT, verdict);
    if (got != status || !strstr(assay_context_error(context), word)) {
        fail_msg("status %d, %s; '%s' was expected", got, assay_context_error(context), word);
    }
    assert_int_equal(assay_status_exit_code(got), 2);
    assay_verdict_destroy(verdict);
    stage_case_end(&r);
}

static void test_other_making(void **state)
{
    static const char *const keys[] = {"assay:splat.a", "assay:scene.digest",
                                       "assay:camera.position"};
    data                    *d      = make_data(*state);
    for (int i = 0; i < 3; i++) {
        for (int missing = 0; missing < 2; missing++) {
            stage_case c = stage_case_begin(*state);
            stage_case_text(&c, "assay:method", "splat");
            for (int k = 0; k < 3; k++) {
                if (k != i || !missing) {
                    stage_case_text(&c, keys[k],
                                    k == i   ? "9 9 9"
                                    : k == 0 ? "2.5e-1"
                                    : k == 1 ? "abc"
                                             : "1.0 2 3.00");
                }
            }
            stage_case_table(&c, ARRAYS[0], UNITS[0], rows_of(0), COLUMNS[0], d->values[0]);
            stage_case_finish(&c);
            refuse(*state, &c, d, ASSAY_ERR_ARGUMENT, keys[i]);
            stage_case_end(&c);
        }
    }
    free(d);
}

static void test_other_arrays(void **state)
{
    data *d = make_data(*state);
    struct {
        const char  *name, *unit;
        size_t       rows, columns;
        double       spoil;
        assay_status status;
        const char  *word;
    } cases[] = {
        {"splat/surprise", "m", PIXELS, 1, 0.0, ASSAY_ERR_FORMAT, "surprise' is not an array"},
        {"splat/result", "W/m2", PIXELS, 3, 0.0, ASSAY_ERR_FORMAT, "W/m2"},
        {"splat/result", "W/(m2 sr)", PIXELS, 4, 0.0, ASSAY_ERR_FORMAT, "splat/result"},
        {"splat/result", "W/(m2 sr)", PIXELS - 1, 3, 0.0, ASSAY_ERR_FORMAT, "splat/result"},
        {"splat/result", "W/(m2 sr)", PIXELS, 3, NAN, ASSAY_ERR_DOMAIN, "splat/result"},
        {"splat/result", "W/(m2 sr)", PIXELS, 3, INFINITY, ASSAY_ERR_DOMAIN, "splat/result"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        double    *v = calloc(4 * PIXELS, sizeof *v);
        assert_non_null(v);
        v[5] = cases[i].spoil;
        add_arrays(&c, d, RESULT);
        stage_case_table(&c, cases[i].name, cases[i].unit, cases[i].rows, cases[i].columns, v);
        stage_case_finish(&c);
        refuse(*state, &c, d, cases[i].status, cases[i].word);
        stage_case_end(&c);
        free(v);
    }
    stage_case c = stage_case_begin(*state);
    add_arrays(&c, d, -1);
    stage_case_table(&c, ARRAYS[RESULT], UNITS[RESULT], PIXELS, 3, d->values[RESULT]);
    stage_case_finish(&c);
    refuse(*state, &c, d, ASSAY_ERR_FORMAT, "twice");
    stage_case_end(&c);
    free(d);
}

/* Bytes that change behind the manifest's back; files that are cut; a manifest that lies. */
static void test_broken_files(void **state)
{
    static const struct {
        const char *file;
        long        at; /* < 0: cut to -at bytes */
        const char *word;
    } cases[] = {{"splat/result.npy", 200, "splat/result"},
                 {"splat/result.npy", 0, "splat/result"},
                 {"records/radius.npy", -100, "records/radius"},
                 {"records/radius.npy", -5, "records/radius"},
                 {"manifest.json", -60, "manifest.json"}};
    data *d   = make_data(*state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        char       path[400];
        add_arrays(&c, d, -1);
        stage_case_finish(&c);
        snprintf(path, sizeof path, "%s/%s", c.path, cases[i].file);
        FILE *file = fopen(path, "r+b");
        assert_non_null(file);
        static uint8_t bytes[1 << 20];
        const size_t   count = fread(bytes, 1, sizeof bytes, file);
        fclose(file);
        if (cases[i].at >= 0) {
            bytes[cases[i].at] ^= 1;
        }
        file = fopen(path, "wb");
        assert_non_null(file);
        fwrite(bytes, 1, cases[i].at < 0 ? (size_t)-cases[i].at : count, file);
        fclose(file);
        refuse(*state, &c, d, ASSAY_ERR_FORMAT, cases[i].word);
        stage_case_end(&c);
    }
    free(d);
}

/* Text of the manifest that is replaced, of an entry that begins with `after`. */
static void replace(const stage_case *c, const char *after, const char *from, const char *to)
{
    static char text[1 << 16];
    char        path[400];
    snprintf(path, sizeof path, "%s/manifest.json", c->path);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    char *entry = strstr(text, after);
    char *at    = entry ? strstr(entry, from) : NULL;
    assert_non_null(at);
    memmove(at + strlen(to), at + strlen(from), strlen(at + strlen(from)) + 1);
    memcpy(at, to, strlen(to));
    file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void test_lying_manifest(void **state)
{
    static const struct {
        const char *after, *from, *to, *word;
    } cases[] = {
        {"\"records/radius\"", "200", "199", "shape"},
        {"\"records/radius\"", "float64", "float32", "dtype"},
        {"\"records/radius\"", "float64", "floaty8", "dtype"},
        {"\"records/radius\"", "records/radius.npy", "records/normal.npy", "'file'"},
        {"\"records/radius\"", "\"unit\"", "\"tinu\"", "unit"},
        {"\"records/radius\"", "\"sha256\":\t\"", "\"sha256\":0,\"\":\"", "'sha256'"},
        {"\"assay-bundle\"", "assay-bundle", "essay-bundle", "not of a bundle"},
        {"\"assay-bundle\"", "\"arrays\"", "\"errays\"", "'arrays'"},
    };
    data *d = make_data(*state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        add_arrays(&c, d, -1);
        stage_case_finish(&c);
        replace(&c, cases[i].after, cases[i].from, cases[i].to);
        refuse(*state, &c, d, ASSAY_ERR_FORMAT, cases[i].word);
        stage_case_end(&c);
    }
    /* A NaN that the reference has, too, is a NaN still. */
    stage_case c           = stage_case_begin(*state);
    d->values[RESULT][100] = NAN;
    add_arrays(&c, d, -1);
    stage_case_finish(&c);
    refuse(*state, &c, d, ASSAY_ERR_DOMAIN, "splat/result");
    stage_case_end(&c);
    free(d);
}

typedef struct {
    const char *candidate, *reference;
} paths;

static assay_status verify_once(assay_context *context, void *user)
{
    const paths   *p       = user;
    assay_verdict *verdict = NULL;
    assay_status   status  = assay_verdict_create(context, "candidate", "reference", &verdict);
    status                 = status ? status
                                    : assay_verify_bundle(context, p->candidate, p->reference, NULL,
                                                          ASSAY_PRECISION_FLOAT, verdict);
    assay_verdict_destroy(verdict);
    return status;
}

static void test_refused_memory(void **state)
{
    data       *d = make_data(*state);
    stage_case  c = stage_case_begin(*state), r = stage_case_begin(*state);
    const paths p = {c.path, r.path};
    add_arrays(&c, d, -1);
    add_arrays(&r, d, -1);
    stage_case_finish(&c);
    stage_case_finish(&r);
    assert_true(failing_each(verify_once, (void *)&p) > 200);
    stage_case_end(&c);
    stage_case_end(&r);
    free(d);
}

/* Records that no stage reads: alone they are nothing to judge, beside an image that is right they
 * must be the reference's. */
static void test_records_alone(void **state)
{
    data *d = make_data(*state);
    for (int other = 0; other < 2; other++) {
        stage_case     c = stage_case_begin(*state), r = stage_case_begin(*state);
        assay_verdict *verdict = NULL;
        for (int a = 0; a < ARRAY_COUNT; a++) {
            if (a == 3 || a >= DIRECT) {
                stage_case_table(&r, ARRAYS[a], UNITS[a], rows_of(a), COLUMNS[a], d->values[a]);
                d->values[3][100] *= other && a == 3 ? 1.5 : 1.0;
                stage_case_table(&c, ARRAYS[a], UNITS[a], rows_of(a), COLUMNS[a], d->values[a]);
            }
        }
        stage_case_finish(&c);
        stage_case_finish(&r);
        assert_int_equal(assay_verdict_create(*state, "c", "r", &verdict), ASSAY_OK);
        assert_int_equal(
            assay_verify_bundle(*state, c.path, r.path, NULL, ASSAY_PRECISION_FLOAT, verdict),
            ASSAY_OK);
        assert_int_equal(assay_verdict_whole(verdict),
                         other ? ASSAY_VERDICT_CANNOT_TELL : ASSAY_VERDICT_PASS);
        assert_int_equal(count_of(verdict, "inputs"), 3);
        assay_verdict_destroy(verdict);
        stage_case_end(&c);
        stage_case_end(&r);
    }
    free(d);
}

/* Nothing that a stage could judge is no pass. */
static void test_nothing(void **state)
{
    data          *d = make_data(*state);
    stage_case     c = stage_case_begin(*state), r = stage_case_begin(*state);
    assay_verdict *verdict = NULL;
    stage_case_table(&c, ARRAYS[0], UNITS[0], rows_of(0), COLUMNS[0], d->values[0]);
    stage_case_table(&r, ARRAYS[0], UNITS[0], rows_of(0), COLUMNS[0], d->values[0]);
    stage_case_finish(&c);
    stage_case_finish(&r);
    assert_int_equal(assay_verdict_create(*state, "candidate", "reference", &verdict), ASSAY_OK);
    assert_int_equal(
        assay_verify_bundle(*state, c.path, r.path, NULL, ASSAY_PRECISION_FLOAT, verdict),
        ASSAY_OK);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assay_verdict_destroy(verdict);
    stage_case_end(&c);
    stage_case_end(&r);
    free(d);
}

/* What the candidate lacks is told; without the sums of the last batch nothing is said of what
 * follows from them, and nothing wrong of the batch before. */
static void test_missing(void **state)
{
    const double   ends[2] = {RECORDS, RECORDS};
    data          *d       = make_data(*state);
    stage_case     c = stage_case_begin(*state), r = stage_case_begin(*state);
    assay_verdict *verdict = NULL;
    for (int k = 0; k < 2; k++) {
        add_arrays(k ? &r : &c, d, k ? -1 : TOTAL);
        stage_case_table(k ? &r : &c, "splat/batch_end", "records", 2, 1, ends);
    }
    stage_case_table(&r, "splat/batch.1/weight", "", PIXELS, 1, d->values[WEIGHT]);
    stage_case_table(&r, "splat/batch.1/radiance", "W/(m2 sr)", PIXELS, 3, d->values[SUM]);
    stage_case_finish(&c);
    stage_case_finish(&r);
    assert_int_equal(assay_verdict_create(*state, "candidate", "reference", &verdict), ASSAY_OK);
    assert_int_equal(
        assay_verify_bundle(*state, c.path, r.path, NULL, ASSAY_PRECISION_FLOAT, verdict),
        ASSAY_OK);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(count_of(verdict, "splat"), 2);
    assert_int_equal(count_of(verdict, "splat-light"), 0);
    assert_int_equal(count_of(verdict, "normalise"), 0);
    assert_string_equal(assay_verdict_get(verdict, "missing"), "radiance/total");
    assert_string_equal(assay_verdict_get(verdict, "not judged"),
                        "splat/result, radiance/direct, radiance/indirect");
    assay_verdict_destroy(verdict);
    stage_case_end(&c);
    stage_case_end(&r);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_right, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_inputs, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_nothing_asked, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_small_halves, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_planted, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_channels, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_other_making, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_other_arrays, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_broken_files, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_lying_manifest, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_refused_memory, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_records_alone, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_missing, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_nothing, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
