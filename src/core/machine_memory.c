/* machine_memory.c - Linux tells in text files: /proc/meminfo, and two kinds of control groups.
 *
 * Invariant: what cannot be read sets no limit.  A page cache counts as used in a control group,
 * though the kernel drops it before it kills; so the inactive part of it is taken as free. */
#include "core/machine_memory.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 1024, LINE_SIZE = 512 };

/* The files of a kind of control group. */
typedef struct {
    const char *folder, *limit, *usage, *inactive;
} group_files;

static const group_files VERSION_1 = {"/sys/fs/cgroup/memory", "memory.limit_in_bytes",
                                      "memory.usage_in_bytes", "total_inactive_file"};
static const group_files VERSION_2 = {"/sys/fs/cgroup", "memory.max", "memory.current",
                                      "inactive_file"};

static uint64_t lower(uint64_t a, uint64_t b) { return a < b ? a : b; }

/* The number behind a word at the start of a line ("" for a file that is one number). */
static bool read_number(const char *path, const char *word, uint64_t *number_out)
{
    char         line[LINE_SIZE];
    const size_t length = strlen(word);
    bool         found  = false;
    FILE        *file   = fopen(path, "re");
    while (file && !found && fgets(line, sizeof line, file)) {
        const char *text = line + length;
        if (strncmp(line, word, length) == 0 && (length == 0 || *text == ' ' || *text == ':')) {
            char *end = NULL;
            text += strspn(text, ": ");
            const uint64_t number = strtoull(text, &end, 10);
            found                 = end != text;
            *number_out           = found ? number : *number_out;
        }
    }
    if (file) {
        fclose(file);
    }
    return found;
}

static uint64_t left_in_group(const char *root, const group_files *files, const char *group)
{
    char     path[PATH_SIZE];
    uint64_t limit = 0, usage = 0, inactive = 0;
    snprintf(path, sizeof path, "%s%s%s/%s", root, files->folder, group, files->limit);
    if (!read_number(path, "", &limit)) {
        return ASSAY_MEMORY_UNKNOWN;
    }
    snprintf(path, sizeof path, "%s%s%s/%s", root, files->folder, group, files->usage);
    if (!read_number(path, "", &usage)) {
        return ASSAY_MEMORY_UNKNOWN;
    }
    snprintf(path, sizeof path, "%s%s%s/memory.stat", root, files->folder, group);
    (void)read_number(path, files->inactive, &inactive);
    usage -= lower(usage, inactive);
    return limit > usage ? limit - usage : 0;
}

/* A group and all above it; in a container the group's own path often is not to be seen. */
static uint64_t left_in_groups(const char *root, const group_files *files, char *group)
{
    uint64_t left = ASSAY_MEMORY_UNKNOWN;
    while (*group) {
        left        = lower(left, left_in_group(root, files, strcmp(group, "/") == 0 ? "" : group));
        char *slash = strrchr(group, '/');
        if (!slash || strcmp(group, "/") == 0) {
            break;
        }
        slash[slash == group ? 1 : 0] = '\0';
    }
    return left;
}

/* A line is NUMBER:CONTROLLERS:PATH; version 2 has no controllers. */
static uint64_t left_in_line(const char *root, char *line)
{
    line[strcspn(line, "\n")] = '\0';
    char *controllers         = strchr(line, ':');
    char *group               = controllers ? strchr(controllers + 1, ':') : NULL;
    if (!group) {
        return ASSAY_MEMORY_UNKNOWN;
    }
    *group++ = '\0';
    if (strcmp(controllers, ":") == 0) {
        return left_in_groups(root, &VERSION_2, group);
    }
    return strcmp(controllers, ":memory") == 0 ? left_in_groups(root, &VERSION_1, group)
                                               : ASSAY_MEMORY_UNKNOWN;
}

uint64_t assay_machine_memory(const char *root)
{
    char     path[PATH_SIZE], line[PATH_SIZE];
    uint64_t left = ASSAY_MEMORY_UNKNOWN, kibibytes = 0;
    snprintf(path, sizeof path, "%s/proc/meminfo", root);
    if (read_number(path, "MemAvailable", &kibibytes)) {
        left = kibibytes * 1024;
    }
    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *file = fopen(path, "re");
    while (file && fgets(line, sizeof line, file)) {
        left = lower(left, left_in_line(root, line));
    }
    if (file) {
        fclose(file);
    }
    return left;
}

uint64_t assay_machine_memory_budget(uint64_t available)
{
    if (available == ASSAY_MEMORY_UNKNOWN) {
        return available;
    }
    const uint64_t least   = UINT64_C(64) << 20;
    const uint64_t wanted  = available / 16 > least ? available / 16 : least;
    const uint64_t reserve = lower(wanted, available / 2);
    return available - reserve;
}
