/* stage_list.c - the stages: one line each, in the order of the data's way. */
#include "oracle/stage/stage_list.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"

/* clang-format off */
const oracle_stage *const assay_stages[] = {
    &stage_visible,
    &stage_gather,
    &stage_irradiance,
    &stage_weights,
    &stage_interpolate,
    &stage_interpolate_radiance,
    &stage_splat,
    &stage_splat_light,
    &stage_splat_glossy,
    &stage_splat_glossy_light,
    &stage_normalise,
    &stage_normalise_glossy,
    &stage_combine_irradiance,
    &stage_combine,
    &stage_project,
    &stage_rotate,
    &stage_convert,
    &stage_reflect,
    NULL,
};
/* clang-format on */

const oracle_stage *assay_stage_find(const char *name)
{
    for (int i = 0; assay_stages[i]; i++) {
        if (strcmp(assay_stages[i]->info.name, name) == 0) {
            return assay_stages[i];
        }
    }
    return NULL;
}

assay_status stage_fail_unknown(assay_context *context, const char *name)
{
    char   known[512] = "";
    size_t used       = 0;
    for (int i = 0; i < assay_stage_count() && used < sizeof known; i++) {
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "",
                                 assay_stage_at(i).name);
    }
    return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown stage '%.64s'; there are: %s", name,
                      known);
}

int assay_stage_count(void) { return (int)(sizeof assay_stages / sizeof assay_stages[0]) - 1; }

assay_stage_info assay_stage_at(int index) { return assay_stages[index]->info; }
