/* stage_combine.c - stages `combine` and `combine-irradiance`: direct and indirect light to their
 * sum, which is the image, or the irradiance of what the pixels see.
 *
 * Both parts are means over the same samples, so their sum is the mean of the sums. */
#include "oracle/stage/stage_list.h"

enum { DIRECT, INDIRECT };

/* clang-format off */
static const assay_param_desc PARAMS[] = {{0}};

static const assay_stage_array INPUTS[] = {
    {"radiance/direct", "W/(m2 sr)", "R G B", "pixel", "direct light and emission",
     false, false, false},
    {"radiance/indirect", "W/(m2 sr)", "R G B", "pixel", "all other light", false, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"radiance/total", "W/(m2 sr)", "R G B", "pixel", "the image", false, false, false}, {0}};

static const assay_stage_array IRRADIANCE_INPUTS[] = {
    {"irradiance/direct", "W/m2", "R G B", "pixel", "from lights and the environment",
     false, false, false},
    {"irradiance/indirect", "W/m2", "R G B", "pixel", "all other", false, false, false},
    {0}};

static const assay_stage_array IRRADIANCE_OUTPUTS[] = {
    {"irradiance/total", "W/m2", "R G B", "pixel", "of what the pixel sees", false, false, false},
    {0}};
/* clang-format on */

static assay_status run_combine(stage_run *run)
{
    const stage_table *direct = &run->in[DIRECT], *indirect = &run->in[INDIRECT];
    stage_output      *out = NULL;
    if (indirect->rows != direct->rows) {
        return stage_fail_rows(run, INDIRECT, direct->rows, "one a pixel, as direct light has");
    }
    const assay_status status = stage_output_make(run, 0, 0, direct->rows, 3, &out);
    for (size_t i = 0; i < 3 * direct->rows && status == ASSAY_OK; i++) {
        const rounding *r = &run->rounding;
        out->values[i]    = direct->values[i] + indirect->values[i];
        if (out->bounds) {
            out->bounds[i] = tracked_add(r, tracked_given(r, direct->values[i]),
                                         tracked_given(r, indirect->values[i]))
                                 .e;
        }
    }
    return status;
}

const oracle_stage stage_combine = {.info = {.name    = "combine",
                                             .summary = "direct and indirect light to the image",
                                             .params  = PARAMS,
                                             .inputs  = INPUTS,
                                             .outputs = OUTPUTS},
                                    .run  = run_combine};

const oracle_stage stage_combine_irradiance = {
    .info = {.name    = "combine-irradiance",
             .summary = "direct and indirect irradiance to their sum",
             .params  = PARAMS,
             .inputs  = IRRADIANCE_INPUTS,
             .outputs = IRRADIANCE_OUTPUTS},
    .run  = run_combine};
