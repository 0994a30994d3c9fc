/* verify_bundles.h - the part of `assay verify` that is about bundles. */
#ifndef ASSAY_CLI_VERIFY_BUNDLES_H
#define ASSAY_CLI_VERIFY_BUNDLES_H

#include "assay/replay.h"
#include "assay/verify.h"
#include "scene_options.h"

typedef struct {
    const char       *scene;   /* NULL without */
    double            time;    /* s            */
    const char       *require; /* names of stages, with commas between them; NULL */
    double            judged;  /* part of an array's numbers; NaN */
    cli_scene_request options;
} cli_bundle_request;

/* Whether the path is a folder. */
bool cli_is_bundle(const char *path);
/* Whether there is something of this name that is no folder. */
bool cli_is_image(const char *path);

/* What the options say together with so many candidates, the first of them named; NULL, or what is
 * wrong. */
const char *cli_bundle_check(const cli_bundle_request *request, int count, const char *candidate);

/* Nothing of a scene, all stages, whatever is judged. */
cli_bundle_request cli_bundle_request_default(void);

/* reference NULL: stages are judged on the inputs of the candidate alone.  Of `options` the
 * precision and what is to be detected count. */
assay_status cli_verify_bundle(assay_context *context, const char *candidate, const char *reference,
                               const cli_bundle_request   *request,
                               const assay_verify_options *options, assay_verdict **verdict_out);

#endif
