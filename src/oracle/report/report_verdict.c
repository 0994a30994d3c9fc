/* report_verdict.c - Invariant: only what is whole JSON of format "assay-verdict", version 1, gets
 * into a page. */
#include "oracle/report/report_verdict.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/read_file.h"

enum { VERDICT_LIMIT = 64 << 20, PATH_SIZE = 4096 };

static const char *text_of(const cJSON *root, const char *name)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, name));
}

static bool is_verdict(const cJSON *root)
{
    const char  *format  = text_of(root, "format");
    const cJSON *version = cJSON_GetObjectItemCaseSensitive(root, "version");
    return format && strcmp(format, "assay-verdict") == 0 && cJSON_IsNumber(version) &&
           version->valuedouble == 1.0 && text_of(root, "verdict") && text_of(root, "candidate") &&
           cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(root, "findings"));
}

/* json_out: the tree printed again, so that what follows it in the file, or hides in it, is gone.
 */
static assay_status read_verdict(assay_context *context, const char *path, char **json_out,
                                 char **candidate_out)
{
    uint8_t     *bytes  = NULL;
    size_t       count  = 0;
    assay_status status = assay_read_file(context, path, VERDICT_LIMIT, &bytes, &count);
    if (status != ASSAY_OK) {
        return status;
    }
    cJSON *root = cJSON_ParseWithLength((const char *)bytes, count);
    assay_release(context, bytes);
    if (!is_verdict(root)) {
        cJSON_Delete(root);
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: is not what `assay verify --json` writes (format assay-verdict, "
                          "version 1)",
                          path);
    }
    char *printed   = cJSON_PrintUnformatted(root);
    char *json      = printed ? assay_copy_text(context, printed) : NULL;
    char *candidate = assay_copy_text(context, text_of(root, "candidate"));
    cJSON_free(printed);
    cJSON_Delete(root);
    if (!json || !candidate) {
        assay_release(context, json);
        assay_release(context, candidate);
        return assay_fail_memory(context, "a verdict");
    }
    *json_out      = json;
    *candidate_out = candidate;
    return ASSAY_OK;
}

assay_status assay_report_verdicts_read(assay_context *context, const assay_report_options *options,
                                        assay_report_verdict **verdicts_out)
{
    assay_report_verdict *verdicts =
        assay_allocate(context, options->verdict_count, sizeof *verdicts);
    if (!verdicts) {
        return assay_fail_memory(context, "a list of verdicts");
    }
    assay_status status = ASSAY_OK;
    for (size_t i = 0; status == ASSAY_OK && i < options->verdict_count; i++) {
        status =
            read_verdict(context, options->verdicts[i], &verdicts[i].json, &verdicts[i].candidate);
    }
    if (status != ASSAY_OK) {
        assay_report_verdicts_release(context, verdicts, options->verdict_count);
        return status;
    }
    *verdicts_out = verdicts;
    return ASSAY_OK;
}

void assay_report_verdicts_release(assay_context *context, assay_report_verdict *verdicts,
                                   size_t count)
{
    for (size_t i = 0; verdicts && i < count; i++) {
        assay_release(context, verdicts[i].json);
        assay_release(context, verdicts[i].candidate);
    }
    assay_release(context, verdicts);
}

/* The same name, or the same file by another name. */
static bool is_same(const char *a, const char *b)
{
    struct stat one, two;
    return strcmp(a, b) == 0 || (stat(a, &one) == 0 && stat(b, &two) == 0 &&
                                 one.st_dev == two.st_dev && one.st_ino == two.st_ino);
}

assay_status assay_report_verdict_find(assay_context *context, const char *path, bool alone,
                                       assay_report_verdict *verdicts, size_t count,
                                       const char **json_out, char **own_out)
{
    for (size_t i = 0; i < count; i++) {
        if ((alone && count == 1) || is_same(verdicts[i].candidate, path)) {
            verdicts[i].used = true;
            *json_out        = verdicts[i].json;
            return ASSAY_OK;
        }
    }
    char        beside[PATH_SIZE + 16];
    struct stat info;
    char       *candidate = NULL;
    size_t      length    = strlen(path);
    while (length > 1 && path[length - 1] == '/') {
        length--;
    }
    if (length > 4 && strncmp(path + length - 4, ".exr", 4) == 0) {
        length -= 4;
    }
    snprintf(beside, sizeof beside, "%.*s.verdict.json", (int)length, path);
    if (stat(beside, &info) != 0) {
        return ASSAY_OK;
    }
    const assay_status status = read_verdict(context, beside, own_out, &candidate);
    if (status == ASSAY_OK) {
        assay_release(context, candidate);
        *json_out = *own_out;
    }
    return status;
}
