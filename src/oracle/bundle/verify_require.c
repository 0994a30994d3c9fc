/* verify_require.c - Invariant: a stage that was asked for has a finding afterwards. */
#include <stdio.h>
#include <string.h>

#include "assay/replay.h"
#include "oracle/stage/stage.h"
#include "oracle/verdict/verdict_data.h"

static bool has_finding(const assay_verdict *verdict, const char *stage)
{
    for (size_t i = 0; i < verdict->count; i++) {
        if (strcmp(verdict->findings[i].stage, stage) == 0) {
            return true;
        }
    }
    return false;
}

static assay_status require(assay_verdict *verdict, const char *stage)
{
    assay_finding f = assay_finding_default();
    f.stage         = stage;
    f.array         = stage;
    f.test          = "required";
    f.kind          = ASSAY_VERDICT_CANNOT_TELL;
    f.meaning =
        "The stage was to be judged, but the bundle has not both what it takes and what "
        "it makes, or no scene was given that it looks at, or its parameters are among those "
        "of which it replays nothing.";
    return has_finding(verdict, stage) ? ASSAY_OK : assay_verdict_add(verdict, &f);
}

assay_status assay_verify_require(assay_verdict *verdict, const char *stages)
{
    for (const char *at = stages; at;) {
        const char  *end    = strchr(at, ',');
        const size_t length = end ? (size_t)(end - at) : strlen(at);
        char         name[64];
        snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), at);
        if (!assay_stage_find(name)) {
            return stage_fail_unknown(verdict->context, name);
        }
        const assay_status status = require(verdict, name);
        if (status != ASSAY_OK) {
            return status;
        }
        at = end ? end + 1 : NULL;
    }
    return ASSAY_OK;
}
