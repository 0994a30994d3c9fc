/* stage_normalise.c - stages `normalise` and `normalise-glossy`: sums of the last batch to
 * radiance, [gautron06] eq. 4.1.
 *
 * A sum of weights that is 0 divides nothing: the result is black. */
#include "oracle/stage/stage_list.h"

enum { WEIGHT, RADIANCE };

/* clang-format off */
static const assay_param_desc PARAMS[] = {{0}};

#define SUMS(LAYER)                                                                                \
    {LAYER "/batch.#/weight", "", "W", "pixel", "sum of weights, of the last batch",               \
     false, false, false},                                                                         \
    {LAYER "/batch.#/radiance", "W/(m2 sr)", "R G B", "pixel",                                     \
     "sum of weight times outgoing radiance", false, false, false}

#define RESULT(LAYER)                                                                              \
    {LAYER "/result", "W/(m2 sr)", "R G B", "pixel", "the quotient; black where the weight is 0",  \
     false, false, false}

static const assay_stage_array INPUTS[]         = {SUMS("splat"), {0}};
static const assay_stage_array OUTPUTS[]        = {RESULT("splat"), {0}};
static const assay_stage_array GLOSSY_INPUTS[]  = {SUMS("splat_glossy"), {0}};
static const assay_stage_array GLOSSY_OUTPUTS[] = {RESULT("splat_glossy"), {0}};
/* clang-format on */

static assay_status run_normalise(stage_run *run)
{
    const stage_table *weight = &run->in[WEIGHT], *sum = &run->in[RADIANCE];
    stage_output      *out = NULL;
    if (sum->rows != weight->rows) {
        return stage_fail_rows(run, RADIANCE, weight->rows, "one a pixel, as the weights have");
    }
    const assay_status status = stage_output_make(run, 0, 0, weight->rows, 3, &out);
    for (size_t i = 0; i < 3 * weight->rows && status == ASSAY_OK; i++) {
        const double w = weight->values[i / 3];
        if (w < 0.0) {
            return stage_fail_value(run, WEIGHT, i / 3, 0, "a weight below 0");
        }
        out->values[i] = w > 0.0 ? sum->values[i] / w : 0.0;
        if (out->bounds && w > 0.0) {
            const rounding *r = &run->rounding;
            out->bounds[i] =
                tracked_div(r, tracked_given(r, sum->values[i]), tracked_given(r, w)).e;
        }
    }
    return status;
}

const oracle_stage stage_normalise = {
    .info = {.name    = "normalise",
             .summary = "weights and weighted radiance of the last batch to radiance",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_normalise};

const oracle_stage stage_normalise_glossy = {
    .info = {.name    = "normalise-glossy",
             .summary = "the same of what radiance records reflect",
             .params  = PARAMS,
             .inputs  = GLOSSY_INPUTS,
             .outputs = GLOSSY_OUTPUTS},
    .run  = run_normalise};
