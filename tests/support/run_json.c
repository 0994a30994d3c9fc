/* run_json.c - through popen, as anyone would run it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/run_json.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

cJSON *run_json(int code, const char *format, ...)
{
    char        arguments[2048], command[4096];
    const char *program = getenv("ASSAY_BIN");
    va_list     list;
    va_start(list, format);
    vsnprintf(arguments, sizeof arguments, format, list);
    va_end(list);
    snprintf(command, sizeof command, "%s %s", program ? program : "build/release/assay",
             arguments);
    FILE *pipe = popen(command, "r"); /* NOLINT(cert-env33-c): the command is the test's own */
    assert_non_null(pipe);
    char       *text = NULL;
    size_t      size = 0;
    FILE       *out  = open_memstream(&text, &size);
    static char block[4096];
    for (size_t got; (got = fread(block, 1, sizeof block, pipe)) > 0;) {
        fwrite(block, 1, got, out);
    }
    fclose(out);
    const int status = pclose(pipe);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != code) {
        fail_msg("%s: ended with %d, not with exit code %d", command, status, code);
    }
    cJSON *json = cJSON_ParseWithOpts(text, NULL, true);
    if (!json) {
        fail_msg("%s: no JSON: %.200s", command, text);
    }
    free(text);
    return json;
}

const cJSON *json_member(const cJSON *json, const char *path)
{
    char copy[128], *rest = copy;
    snprintf(copy, sizeof copy, "%s", path);
    for (char *name; (name = strsep(&rest, "/"));) {
        json = cJSON_GetObjectItemCaseSensitive(json, name);
        if (!json) {
            fail_msg("there is no %s", path);
        }
    }
    return json;
}
