/* context.h - memory, messages, progress and threads of a set of calls.
 *
 * The library has no global state: everything hangs on a context.  Use a context from one thread
 * at a time; different contexts are independent.  Objects made with a context must be destroyed
 * before it. */
#ifndef ASSAY_CONTEXT_H
#define ASSAY_CONTEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "assay/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct assay_context assay_context;

typedef enum { ASSAY_LOG_INFO = 0, ASSAY_LOG_WARNING = 1 } assay_log_level;

/* Receives one line without a newline.  Called from the thread that made the call. */
typedef void (*assay_log_callback)(void *user, assay_log_level level, const char *line);

/* Receives how far a phase ("load", "build", "render") has come, fraction in [0, 1].
 * Return false to cancel: the running call then ends with ASSAY_ERR_CANCELLED.
 * Called from the thread that made the call. */
typedef bool (*assay_progress_callback)(void *user, const char *phase, double fraction);

/* Both or neither.  allocate returns NULL to refuse; both may be called from several threads. */
typedef struct {
    void *(*allocate)(void *user, size_t bytes);
    void (*release)(void *user, void *memory);
    void *user;
} assay_allocator;

typedef struct {
    int threads;                       /* worker threads, 0 = one a processor, at most 1024; */
                                       /* never changes a result                             */
    assay_allocator         allocator; /* all NULL: malloc and free                          */
    assay_log_callback      log;       /* may be NULL                                        */
    assay_progress_callback progress;  /* may be NULL                                        */
    void                   *user;      /* handed to log and progress                         */
    /* Bytes that all objects of the context may hold together; what would exceed them fails with
     * ASSAY_ERR_MEMORY.  0: what the machine and its control groups have to give when the context
     * is made, less a reserve; UINT64_MAX: no limit.  Never changes a result. */
    uint64_t memory_limit;
} assay_context_options;

/* options may be NULL (all defaults).  Errors: ARGUMENT, MEMORY. */
ASSAY_API assay_status assay_context_create(const assay_context_options *options,
                                            assay_context              **context_out);
ASSAY_API void         assay_context_destroy(assay_context *context);

/* One line that explains the last call on this context that failed: the file, the thing in it,
 * and what to do.  Borrowed until the next failing call; "" when none failed yet. */
ASSAY_API const char *assay_context_error(const assay_context *context);

/* Worker threads in use, at least 1. */
ASSAY_API int assay_context_threads(const assay_context *context);

/* The limit in force, UINT64_MAX for none, and what its objects hold now, bytes.  (Embree's tree
 * counts; what OpenEXR, libpng and the like need while a file is read or written does not.) */
ASSAY_API uint64_t assay_context_memory_limit(const assay_context *context);
ASSAY_API uint64_t assay_context_memory_used(const assay_context *context);

/* Releases a text that a call made; NULL is legal. */
ASSAY_API void assay_text_destroy(assay_context *context, char *text);

/* Writes a text to a file, with a newline at its end where it has none; beside and then renamed: on
 * any error the file of that name is as it was. Errors: WRITE, MEMORY. */
ASSAY_API assay_status assay_text_write(assay_context *context, const char *path, const char *text);

/* "0.1.0"; borrowed. */
ASSAY_API const char *assay_version(void);

#ifdef __cplusplus
}
#endif
#endif
