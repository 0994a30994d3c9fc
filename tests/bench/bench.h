/* bench.h - what every bench needs: clocks, an end with a message, and where scenes lie. */
#ifndef ASSAY_TESTS_BENCH_H
#define ASSAY_TESTS_BENCH_H

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "assay/context.h"

/* Seconds of a clock: CLOCK_MONOTONIC passes, CLOCK_THREAD_CPUTIME_ID and
 * CLOCK_PROCESS_CPUTIME_ID are what a processor has spent. */
static inline double bench_seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void bench_stop(const char *message)
{
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
    exit(1);
}

/* Stops with the context's last error unless the status is ASSAY_OK. */
static inline void bench_require(const assay_context *context, assay_status status)
{
    if (status != ASSAY_OK) {
        bench_stop(assay_context_error(context));
    }
}

/* The path of a scene: our own where it begins with "scenes/", otherwise below the folder that
 * ASSAY_SHARED_SCENES names.  False where it is absent. */
static inline bool bench_find_scene(char *path, size_t size, const char *scene)
{
    const char *shared = getenv("ASSAY_SHARED_SCENES");
    const char *folder = strncmp(scene, "scenes/", 7) == 0 ? "."
                         : shared != NULL                  ? shared
                                                           : "../shared/scenes";
    snprintf(path, size, "%s/%s", folder, scene);
    return access(path, R_OK) == 0;
}

#endif
