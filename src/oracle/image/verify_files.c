/* verify_files.c - the images of a comparison, of which only what is compared is kept.
 *
 * Invariant: a message names the file. */
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/image_decode.h"
#include "oracle/image/verify_channels.h"
#include "oracle/verdict/verdict_data.h"

/* "a.exr" or "a.exr and 3 more". */
static void candidate_name(const char *const *candidates, int count, char name_out[4200])
{
    const int length = snprintf(name_out, 4096, "%s", candidates[0]);
    const int end    = length < 4095 ? length : 4095;
    if (count > 1) {
        snprintf(name_out + end, 4200 - (size_t)end, " and %d more", count - 1);
    }
}

static assay_status read_all(assay_context *context, const char *const *candidates, int count,
                             const char *reference, const char *const *wanted, assay_image **images)
{
    assay_status status = assay_image_read_channels(context, reference, wanted, &images[count]);
    for (int k = 0; status == ASSAY_OK && k < count; k++) {
        status = assay_progress(context, "read", (uint64_t)k + 1, (uint64_t)count + 1);
        status = status != ASSAY_OK
                     ? status
                     : assay_image_read_channels(context, candidates[k], wanted, &images[k]);
    }
    return status;
}

static assay_status verify(assay_context *context, const char *const *candidates, int count,
                           const char *reference, assay_image *const *images,
                           const assay_verify_options *options, assay_verdict **verdict_out)
{
    const assay_image *runs[ASSAY_VERIFY_MAX_RUNS];
    char               name[4200];
    candidate_name(candidates, count, name);
    for (int k = 0; k < count; k++) {
        runs[k] = images[k];
    }
    assay_verdict *verdict = NULL;
    assay_status   status  = assay_verdict_create(context, name, reference, &verdict);
    if (status == ASSAY_OK) {
        status = assay_verify_images(runs, count, images[count], options, verdict);
    }
    if (status == ASSAY_ERR_ARGUMENT) {
        char message[1024];
        snprintf(message, sizeof message, "%s", assay_context_error(context));
        status =
            assay_fail(context, status, "%.300s against %.300s: %.380s", name, reference, message);
    }
    if (status != ASSAY_OK) {
        assay_verdict_destroy(verdict);
        return status;
    }
    *verdict_out = verdict;
    return ASSAY_OK;
}

assay_status assay_verify_files(assay_context *context, const char *const *candidates, int count,
                                const char *reference, const assay_verify_options *options,
                                assay_verdict **verdict_out)
{
    assay_image *images[ASSAY_VERIFY_MAX_RUNS + 1] = {NULL};
    const char **wanted                            = NULL;
    if (count < 1 || count > ASSAY_VERIFY_MAX_RUNS) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "a candidate has 1 to %d runs",
                          ASSAY_VERIFY_MAX_RUNS);
    }
    assay_status status = assay_verify_channels_names(context, options->channels, &wanted);
    if (status == ASSAY_OK) {
        status = read_all(context, candidates, count, reference, wanted, images);
    }
    if (status == ASSAY_OK) {
        status = verify(context, candidates, count, reference, images, options, verdict_out);
    }
    for (int k = 0; k <= count; k++) {
        assay_image_destroy(images[k]);
    }
    assay_release(context, wanted);
    return status;
}
