/* stage_reflect.c - stage `reflect`: coefficients of light times those of a BRDF to radiance,
 * [gautron06] eq. 3.14, both in one orthonormal basis and frame. */
#include "oracle/stage/stage_list.h"

enum { LIGHT, BRDF, CHANNELS = 3 };

/* clang-format off */
static const assay_param_desc PARAMS[] = {{0}};

static const assay_stage_array INPUTS[] = {
    {"reflect/light", "W/(m2 sr)", NULL, "point", "coefficients of R, of G, of B",
     false, false, false},
    {"reflect/brdf", "1/sr", NULL, "point", "of BRDF times cosine, likewise", false, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"reflect/radiance", "W/(m2 sr)", "R G B", "point", "", false, false, false}, {0}};
/* clang-format on */

static void reflect(const stage_run *run, size_t count, size_t at, const stage_output *out)
{
    const double *a = run->in[LIGHT].values + at * count, *b = run->in[BRDF].values + at * count;
    double        sum   = 0.0;
    tracked_sum   bound = {0};
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
        if (run->bounded) {
            const rounding *r = &run->rounding;
            tracked_sum_add(&bound, tracked_mul(r, tracked_given(r, a[i]), tracked_given(r, b[i])));
        }
    }
    out->values[at] = sum;
    if (run->bounded) {
        out->bounds[at] = tracked_sum_of(&run->rounding, &bound).e;
    }
}

static assay_status run_reflect(stage_run *run)
{
    const size_t  rows = run->in[LIGHT].rows, columns = run->in[LIGHT].columns;
    stage_output *out = NULL;
    if (run->in[BRDF].rows != rows) {
        return stage_fail_rows(run, BRDF, rows, "one a point, as of reflect/light");
    }
    if (columns % CHANNELS != 0) {
        return stage_fail_columns(run, LIGHT, columns - columns % CHANNELS + CHANNELS);
    }
    if (run->in[BRDF].columns != columns) {
        return stage_fail_columns(run, BRDF, columns);
    }
    const assay_status status = stage_output_make(run, 0, 0, rows, CHANNELS, &out);
    for (size_t i = 0; i < CHANNELS * rows && status == ASSAY_OK; i++) {
        reflect(run, columns / CHANNELS, i, out);
    }
    return status;
}

const oracle_stage stage_reflect = {
    .info = {.name    = "reflect",
             .summary = "coefficients of light times those of a BRDF to radiance",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_reflect};
