/* stage_combine.c - stage `combine`: direct and indirect light to the image. */
#include "oracle/stage_list.h"

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
/* clang-format on */

static assay_status run_combine(stage_run *run)
{
    const stage_table *direct = &run->in[DIRECT], *indirect = &run->in[INDIRECT];
    stage_output      *out = NULL;
    if (indirect->rows != direct->rows) {
        return stage_fail_rows(run, INDIRECT, direct->rows, "one a pixel, as radiance/direct has");
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
