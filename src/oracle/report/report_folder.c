/* report_folder.c - Invariant: the list does not depend on the order in which a folder is read, and
 * an image is in it once: the reference is no candidate.
 *
 * Without a reference the truth is what has no bias: the image by path with the most samples. */
#include "oracle/report/report_folder.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/alloc.h"
#include "core/context.h"
#include "oracle/report/report_source.h"

static assay_status add(assay_context *context, assay_report_list *list, const char *path)
{
    if (list->count == ASSAY_REPORT_MAX_CANDIDATES) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "%s: more than %d images; a report shows no more", path,
                          ASSAY_REPORT_MAX_CANDIDATES);
    }
    char *copy = assay_copy_text(context, path);
    if (!copy) {
        return assay_fail_memory(context, "a list of images");
    }
    list->candidates[list->count++] = copy;
    return ASSAY_OK;
}

static bool is_image_or_bundle(const char *path, const char *name)
{
    struct stat  info;
    const size_t length = strlen(name);
    if (name[0] == '.' || stat(path, &info) != 0) {
        return false;
    }
    return S_ISDIR(info.st_mode) ? assay_report_is_bundle(path)
                                 : length > 4 && strcmp(name + length - 4, ".exr") == 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static assay_status add_folder(assay_context *context, assay_report_list *list, const char *path)
{
    const size_t first  = list->count;
    DIR         *folder = opendir(path);
    if (!folder) {
        return assay_fail(context, ASSAY_ERR_NOT_FOUND, "%s: %s", path, strerror(errno));
    }
    assay_status   status = ASSAY_OK;
    struct dirent *entry;
    while (status == ASSAY_OK && (entry = readdir(folder))) {
        char         file[ASSAY_REPORT_PATH_SIZE];
        const size_t length = strlen(path);
        snprintf(file, sizeof file, "%.3800s%s%s", path,
                 length > 0 && path[length - 1] == '/' ? "" : "/", entry->d_name);
        if (is_image_or_bundle(file, entry->d_name)) {
            status = add(context, list, file);
        }
    }
    closedir(folder);
    qsort(list->candidates + first, list->count - first, sizeof *list->candidates, by_name);
    if (status == ASSAY_OK && list->count == first) {
        status = assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "%s: the folder holds no .exr image and no bundle", path);
    }
    return status;
}

static assay_status add_all(assay_context *context, const assay_report_options *options,
                            assay_report_list *list)
{
    assay_status status = ASSAY_OK;
    for (size_t i = 0; status == ASSAY_OK && i < options->candidate_count; i++) {
        struct stat info;
        const char *path = options->candidates[i];
        const bool  folder =
            stat(path, &info) == 0 && S_ISDIR(info.st_mode) && !assay_report_is_bundle(path);
        status = folder ? add_folder(context, list, path) : add(context, list, path);
    }
    return status;
}

static bool same_file(const char *a, const char *b)
{
    struct stat one, two;
    return stat(a, &one) == 0 && stat(b, &two) == 0 && one.st_dev == two.st_dev &&
           one.st_ino == two.st_ino;
}

static assay_status choose_reference(assay_context *context, assay_report_list *list)
{
    double       best   = 0.0;
    size_t       chosen = list->count;
    assay_status status = ASSAY_OK;
    for (size_t i = 0; status == ASSAY_OK && i < list->count; i++) {
        assay_report_source source = {.image = NULL};
        status = assay_report_source_read(context, list->candidates[i], &source);
        if (status == ASSAY_OK) {
            const char  *method  = assay_report_source_method(&source);
            const double samples = assay_report_source_samples(&source);
            if (method && strcmp(method, "path") == 0 && samples > best) {
                best   = samples;
                chosen = i;
            }
            assay_report_source_release(&source);
        }
    }
    if (status == ASSAY_OK && chosen == list->count) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "no image by the method path that could be the reference; name one with "
                          "--reference");
    }
    if (status == ASSAY_OK) {
        list->reference = assay_copy_text(context, list->candidates[chosen]);
        status = list->reference ? ASSAY_OK : assay_fail_memory(context, "a list of images");
    }
    return status;
}

static void leave_out_reference(assay_context *context, assay_report_list *list)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        if (list->reference && list->count > 1 && same_file(list->candidates[i], list->reference)) {
            assay_release(context, list->candidates[i]);
        } else {
            list->candidates[kept++] = list->candidates[i];
        }
    }
    list->count = kept;
}

assay_status assay_report_list_make(assay_context *context, const assay_report_options *options,
                                    assay_report_list *list_out)
{
    assay_report_list list = {
        .candidates = assay_allocate(context, ASSAY_REPORT_MAX_CANDIDATES, sizeof(char *))};
    if (!list.candidates) {
        return assay_fail_memory(context, "a list of images");
    }
    assay_status status = add_all(context, options, &list);
    if (status == ASSAY_OK && options->reference) {
        list.reference = assay_copy_text(context, options->reference);
        status         = list.reference ? ASSAY_OK : assay_fail_memory(context, "a name");
    } else if (status == ASSAY_OK) {
        status = list.count > 1
                     ? choose_reference(context, &list)
                     : assay_fail(context, ASSAY_ERR_ARGUMENT,
                                  "one image alone is compared with nothing; name the other with "
                                  "--reference");
    }
    if (status == ASSAY_OK) {
        leave_out_reference(context, &list);
    }
    if (status == ASSAY_OK && list.count == 0) {
        status = assay_fail(context, ASSAY_ERR_ARGUMENT, "no image to compare with the reference");
    }
    if (status != ASSAY_OK) {
        assay_report_list_release(context, &list);
        return status;
    }
    *list_out = list;
    return ASSAY_OK;
}

/* "ic.exr" or "ic (bundle)". */
static void name_with_kind(const char *path, char out[ASSAY_REPORT_LABEL_SIZE])
{
    char        name[ASSAY_REPORT_NAME_SIZE];
    const char *dot = strrchr(path, '.');
    assay_report_name_of(path, name);
    snprintf(out, ASSAY_REPORT_LABEL_SIZE, "%s%.16s", name,
             assay_report_is_bundle(path)                                    ? " (bundle)"
             : dot && (strcmp(dot, ".exr") == 0 || strcmp(dot, ".hdr") == 0) ? dot
                                                                             : "");
}

void assay_report_list_label(const assay_report_list *list, size_t index,
                             char label_out[ASSAY_REPORT_LABEL_SIZE])
{
    char   mine[ASSAY_REPORT_NAME_SIZE], kind[ASSAY_REPORT_LABEL_SIZE];
    size_t same = 0, before = 0;
    assay_report_name_of(list->candidates[index], mine);
    name_with_kind(list->candidates[index], kind);
    for (size_t i = 0; i < list->count; i++) {
        char name[ASSAY_REPORT_NAME_SIZE], other[ASSAY_REPORT_LABEL_SIZE];
        assay_report_name_of(list->candidates[i], name);
        name_with_kind(list->candidates[i], other);
        same += strcmp(name, mine) == 0;
        before += i < index && strcmp(other, kind) == 0;
    }
    if (same == 1) {
        snprintf(label_out, ASSAY_REPORT_LABEL_SIZE, "%s", mine);
    } else if (before == 0) {
        snprintf(label_out, ASSAY_REPORT_LABEL_SIZE, "%s", kind);
    } else {
        snprintf(label_out, ASSAY_REPORT_LABEL_SIZE, "%.272s, %d", kind, (int)before + 1);
    }
}

void assay_report_list_release(assay_context *context, assay_report_list *list)
{
    for (size_t i = 0; list->candidates && i < list->count; i++) {
        assay_release(context, list->candidates[i]);
    }
    assay_release(context, list->candidates);
    assay_release(context, list->reference);
    list->candidates = NULL;
    list->reference  = NULL;
    list->count      = 0;
}
