/* context.c - messages, progress and threads of a set of calls. */
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/context_data.h"
#include "core/machine_memory.h"

#ifndef ASSAY_VERSION
#error "the Makefile defines ASSAY_VERSION"
#endif

enum { ASSAY_MAX_THREADS = 1024 };

/* Large blocks are looked up in random places (trees, texels): on huge pages these look-ups miss
 * the page table's cache less often.  A kernel that has none ignores the wish. */
static void *allocate_with_malloc(void *user, size_t bytes)
{
    const size_t page = (size_t)2 << 20;
    (void)user;
    if (bytes < 2 * page || bytes > SIZE_MAX - page) {
        return malloc(bytes);
    }
    const size_t rounded = (bytes + page - 1) / page * page;
    void        *block   = aligned_alloc(page, rounded);
    if (block) {
        (void)madvise(block, rounded, MADV_HUGEPAGE);
    }
    return block;
}

static void release_with_free(void *user, void *memory)
{
    (void)user;
    free(memory);
}

/* Processors that this process may use. */
static int processor_count(void)
{
    cpu_set_t  ours;
    const long all   = sysconf(_SC_NPROCESSORS_ONLN);
    const int  count = sched_getaffinity(0, sizeof ours, &ours) == 0 ? CPU_COUNT(&ours) : (int)all;
    return count < 1 ? 1 : count < ASSAY_MAX_THREADS ? count : ASSAY_MAX_THREADS;
}

assay_status assay_context_create(const assay_context_options *options, assay_context **context_out)
{
    assay_context_options o = {0};
    if (options) {
        o = *options;
    }
    if (o.threads < 0 || o.threads > ASSAY_MAX_THREADS ||
        !o.allocator.allocate != !o.allocator.release) {
        return ASSAY_ERR_ARGUMENT;
    }
    if (!o.allocator.allocate) {
        o.allocator = (assay_allocator){allocate_with_malloc, release_with_free, NULL};
    }
    if (o.threads == 0) {
        o.threads = processor_count();
    }
    const size_t   helpers = (size_t)o.threads - 1;
    assay_context *context = o.allocator.allocate(
        o.allocator.user, sizeof *context + helpers * sizeof context->helpers[0]);
    if (!context) {
        return ASSAY_ERR_MEMORY;
    }
    memset(context, 0, sizeof *context);
    if (!assay_thread_pool_open(&context->pool, context->helpers, (int)helpers)) {
        o.allocator.release(o.allocator.user, context);
        return ASSAY_ERR_MEMORY;
    }
    if (o.memory_limit == 0) {
        o.memory_limit = assay_machine_memory_budget(assay_machine_memory(""));
    }
    context->options = o;
    atomic_init(&context->memory_used, 0);
    atomic_init(&context->memory_refused, 0);
    const char *isa = getenv("ASSAY_ISA");
    if (isa) {
        snprintf(context->isa, sizeof context->isa, "%s", isa);
    }
    *context_out = context;
    return ASSAY_OK;
}

void assay_context_destroy(assay_context *context)
{
    if (context) {
        const assay_allocator allocator = context->options.allocator;
        assay_thread_pool_close(&context->pool);
        allocator.release(allocator.user, context);
    }
}

const char *assay_context_error(const assay_context *context) { return context->error; }

int assay_context_threads(const assay_context *context) { return context->options.threads; }

uint64_t assay_context_memory_limit(const assay_context *context)
{
    return context->options.memory_limit;
}

uint64_t assay_context_memory_used(const assay_context *context)
{
    return atomic_load(&context->memory_used);
}

const char *assay_context_isa(const assay_context *context)
{
    return context->isa[0] ? context->isa : NULL;
}

const char *assay_version(void) { return ASSAY_VERSION; }

assay_status assay_fail(assay_context *context, assay_status status, const char *format, ...)
{
    /* A message may quote the previous one, so it is made aside. */
    char    message[sizeof context->error];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    memcpy(context->error, message, sizeof message);
    return status;
}

void assay_inform(assay_context *context, assay_log_level level, const char *format, ...)
{
    if (!context->options.log) {
        return;
    }
    char    line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    context->options.log(context->options.user, level, line);
}

assay_status assay_progress(assay_context *context, const char *phase, uint64_t done,
                            uint64_t total)
{
    if (!context->options.progress) {
        return ASSAY_OK;
    }
    const double fraction = total ? (double)done / (double)total : 1.0;
    if (context->options.progress(context->options.user, phase, fraction)) {
        return ASSAY_OK;
    }
    return assay_fail(context, ASSAY_ERR_CANCELLED, "cancelled while in phase '%s'", phase);
}
