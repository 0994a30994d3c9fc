/* verify_bundles.c - a folder is taken for a bundle, any other file for an image. */
#include "verify_bundles.h"

#include <math.h>
#include <sys/stat.h>

cli_bundle_request cli_bundle_request_default(void)
{
    return (cli_bundle_request){.judged = NAN, .options = cli_scene_request_default()};
}

bool cli_is_bundle(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool cli_is_image(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
}

const char *cli_bundle_check(const cli_bundle_request *request, int count, const char *candidate)
{
    if (!cli_is_bundle(candidate)) {
        return request->scene           ? "--scene goes with bundles"
               : request->require       ? "--require goes with bundles"
               : request->judged >= 0.0 ? "--judged goes with bundles"
                                        : NULL;
    }
    return count > 1 ? "one bundle at a time" : cli_scene_check(&request->options);
}

assay_status cli_verify_bundle(assay_context *context, const char *candidate, const char *reference,
                               const cli_bundle_request   *request,
                               const assay_verify_options *options, assay_verdict **verdict_out)
{
    assay_scene   *scene   = NULL;
    assay_verdict *verdict = NULL;
    assay_status   status  = assay_verdict_create(context, candidate,
                                               reference ? reference : "its own inputs", &verdict);
    if (status == ASSAY_OK && request->scene) {
        status = assay_scene_load(context, request->scene, &request->options.options, &scene);
        status = status ? status : assay_scene_set_time(scene, request->time);
    }
    status = status ? status
                    : assay_verify_bundle(context, candidate, reference, scene, options->precision,
                                          verdict);
    status = status ? status : assay_verify_insist(verdict, options->detect, request->judged);
    if (status == ASSAY_OK && request->require) {
        status = assay_verify_require(verdict, request->require);
    }
    assay_scene_destroy(scene);
    if (status != ASSAY_OK) {
        assay_verdict_destroy(verdict);
        return status;
    }
    *verdict_out = verdict;
    return ASSAY_OK;
}
