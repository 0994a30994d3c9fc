/* run_json.h - the command's JSON.  The program is $ASSAY_BIN, else build/release/assay. */
#ifndef ASSAY_TESTS_RUN_JSON_H
#define ASSAY_TESTS_RUN_JSON_H

#include <cjson/cJSON.h>

/* Runs `assay ARGUMENTS`, which must end with this exit code, and parses its stdout. */
cJSON *run_json(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A member by its path, "rays/total"; it must be there. */
const cJSON *json_member(const cJSON *json, const char *path);

#endif
