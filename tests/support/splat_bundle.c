/* splat_bundle.c - Invariant: outputs are what our stages make of the inputs, rounded to floats
 * once, so a right candidate's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "splat_bundle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/splat_room.h"

const splat_array splat_arrays[SPLAT_ARRAY_COUNT] = {
    [SPLAT_RECORD_POSITION]     = {"records/position", "m", SPLAT_RECORDS, 3},
    [SPLAT_RECORD_NORMAL]       = {"records/normal", "", SPLAT_RECORDS, 3},
    [SPLAT_RECORD_RADIUS]       = {"records/radius", "m", SPLAT_RECORDS, 1},
    [SPLAT_RECORD_IRRADIANCE]   = {"records/irradiance", "W/m2", SPLAT_RECORDS, 3},
    [SPLAT_RECORD_ROTATION]     = {"records/rotation_gradient", "W/(m2 rad)", SPLAT_RECORDS, 9},
    [SPLAT_RECORD_TRANSLATION]  = {"records/translation_gradient", "W/m3", SPLAT_RECORDS, 9},
    [SPLAT_POSITION]            = {"splat/position", "m", SPLAT_PIXELS, 3},
    [SPLAT_FRAME]               = {"splat/frame", "", SPLAT_PIXELS, 9},
    [SPLAT_ALBEDO]              = {"splat/albedo", "", SPLAT_PIXELS, 3},
    [SPLAT_WEIGHT]              = {"splat/batch.0/weight", "", SPLAT_PIXELS, 1},
    [SPLAT_SUM]                 = {"splat/batch.0/radiance", "W/(m2 sr)", SPLAT_PIXELS, 3},
    [SPLAT_RESULT]              = {"splat/result", "W/(m2 sr)", SPLAT_PIXELS, 3},
    [SPLAT_DIRECT]              = {"radiance/direct", "W/(m2 sr)", SPLAT_PIXELS, 3},
    [SPLAT_INDIRECT]            = {"radiance/indirect", "W/(m2 sr)", SPLAT_PIXELS, 3},
    [SPLAT_TOTAL]               = {"radiance/total", "W/(m2 sr)", SPLAT_PIXELS, 3},
    [SPLAT_IRRADIANCE_DIRECT]   = {"irradiance/direct", "W/m2", SPLAT_PIXELS, 3},
    [SPLAT_IRRADIANCE_INDIRECT] = {"irradiance/indirect", "W/m2", SPLAT_PIXELS, 3},
    [SPLAT_IRRADIANCE_TOTAL]    = {"irradiance/total", "W/m2", SPLAT_PIXELS, 3},
};

/* ---- numbers ---- */

void splat_round(splat_data *d)
{
    const few_digits single = {.digits = 24};
    for (int a = 0; a < SPLAT_ARRAY_COUNT; a++) {
        for (size_t i = 0; i < SPLAT_MOST; i++) {
            d->values[a][i] = few(&single, d->values[a][i]);
        }
    }
}

static void put(splat_data *d, int array, size_t row, const void *from)
{
    const size_t columns = splat_arrays[array].columns;
    memcpy(&d->values[array][columns * row], from, columns * sizeof(double));
}

static void make_records(splat_data *d)
{
    for (uint32_t k = 0; k < SPLAT_RECORDS; k++) {
        const assay_record r = splat_room_record(5, SPLAT_RECORDS, k);
        put(d, SPLAT_RECORD_POSITION, k, &r.position);
        put(d, SPLAT_RECORD_NORMAL, k, &r.normal);
        put(d, SPLAT_RECORD_RADIUS, k, &r.radius);
        put(d, SPLAT_RECORD_IRRADIANCE, k, &r.irradiance);
        put(d, SPLAT_RECORD_ROTATION, k, r.rotation);
        put(d, SPLAT_RECORD_TRANSLATION, k, r.translation);
    }
}

static void make_pixels(splat_data *d)
{
    const assay_camera camera = splat_room_camera(false);
    for (size_t i = 0; i < SPLAT_PIXELS; i++) {
        assay_vec3 p = vec3(NAN, NAN, NAN), n = vec3(0.0, 0.0, 1.0);
        splat_room_point(&camera, SPLAT_SIDE, SPLAT_SIDE, i, &p, &n);
        p = i == 7 ? vec3(NAN, NAN, NAN) : p;
        if (i == SPLAT_STANDS) {
            memcpy(&p, &d->values[SPLAT_RECORD_POSITION][15], sizeof p);
            memcpy(&n, &d->values[SPLAT_RECORD_NORMAL][15], sizeof n);
        }
        put(d, SPLAT_POSITION, i, &p);
        memcpy(&d->values[SPLAT_FRAME][9 * i + 6], &n, sizeof n);
        for (size_t c = 0; c < 3; c++) {
            d->values[SPLAT_ALBEDO][3 * i + c]              = 0.25 + 0.25 * (double)c;
            d->values[SPLAT_DIRECT][3 * i + c]              = 0.01 * (double)((7 * i + c) % 50);
            d->values[SPLAT_IRRADIANCE_DIRECT][3 * i + c]   = 0.03 * (double)((5 * i + c) % 40);
            d->values[SPLAT_IRRADIANCE_INDIRECT][3 * i + c] = 0.7 + 0.02 * (double)(i % 30);
        }
    }
}

/* ---- stages ---- */

static void run_stage(assay_context *context, splat_data *d, const char *stage)
{
    stage_case c = stage_case_begin(context);
    splat_add_arrays(&c, d, -1);
    stage_case_run(&c, stage, ASSAY_PRECISION_FLOAT);
    for (int i = 0; i < c.run.out_count; i++) {
        for (int a = 0; a < SPLAT_ARRAY_COUNT; a++) {
            const splat_array *array = &splat_arrays[a];
            if (strcmp(array->name, c.run.out[i].name) == 0) {
                memcpy(d->values[a], c.run.out[i].values,
                       array->rows * array->columns * sizeof(double));
            }
        }
    }
    stage_case_end(&c);
    splat_round(d);
}

void splat_make_stages(assay_context *context, splat_data *d)
{
    run_stage(context, d, "splat");
    run_stage(context, d, "normalise");
    run_stage(context, d, "combine");
    run_stage(context, d, "combine-irradiance");
}

splat_data *splat_make_data(assay_context *context)
{
    splat_data *d = calloc(1, sizeof *d);
    assert_non_null(d);
    make_records(d);
    make_pixels(d);
    splat_round(d);
    splat_make_stages(context, d);
    memcpy(d->values[SPLAT_INDIRECT], d->values[SPLAT_RESULT], sizeof d->values[SPLAT_RESULT]);
    run_stage(context, d, "combine");
    return d;
}

splat_data *splat_copy(const splat_data *data)
{
    splat_data *copy = malloc(sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, data, sizeof *copy);
    return copy;
}

/* ---- bundles ---- */

void splat_add_arrays(const stage_case *c, const splat_data *data, int without)
{
    stage_case_text(c, "assay:method", "splat");
    stage_case_text(c, "assay:splat.a", "0.25");
    stage_case_text(c, "assay:scene.digest", "abc");
    stage_case_text(c, "assay:camera.position", "1 2 3");
    for (int a = 0; a < SPLAT_ARRAY_COUNT; a++) {
        const splat_array *array = &splat_arrays[a];
        if (a != without) {
            stage_case_table(c, array->name, array->unit, array->rows, array->columns,
                             data->values[a]);
        }
    }
}

static assay_verdict *verify(stage_case *c, stage_case *r, bool alone, assay_precision precision)
{
    assay_verdict *verdict = NULL;
    stage_case_finish(c);
    stage_case_finish(r);
    assert_int_equal(assay_verdict_create(c->context, "candidate", "reference", &verdict),
                     ASSAY_OK);
    if (assay_verify_bundle(c->context, c->path, alone ? NULL : r->path, NULL, precision,
                            verdict) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(c->context));
    }
    stage_case_end(c);
    stage_case_end(r);
    return verdict;
}

assay_verdict *splat_verify_cases(stage_case *candidate, stage_case *reference)
{
    return verify(candidate, reference, false, ASSAY_PRECISION_FLOAT);
}

assay_verdict *splat_verify(assay_context *context, const splat_data *candidate,
                            const splat_data *reference, assay_precision precision)
{
    stage_case c = stage_case_begin(context), r = stage_case_begin(context);
    splat_add_arrays(&c, candidate, -1);
    splat_add_arrays(&r, reference ? reference : candidate, -1);
    return verify(&c, &r, !reference, precision);
}

/* ---- findings ---- */

int splat_count_of(const assay_verdict *verdict, const char *stage)
{
    int count = 0;
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        count += strcmp(assay_verdict_at(verdict, i).stage, stage) == 0;
    }
    return count;
}

assay_finding splat_first(const assay_verdict *verdict)
{
    assert_true(assay_verdict_first(verdict) >= 0);
    return assay_verdict_at(verdict, assay_verdict_first(verdict));
}
