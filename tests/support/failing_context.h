/* failing_context.h - contexts whose memory is counted, and refused on demand. */
#ifndef ASSAY_TESTS_FAILING_CONTEXT_H
#define ASSAY_TESTS_FAILING_CONTEXT_H

#include <stdint.h>

#include "assay/context.h"

typedef struct {
    uint64_t asked;    /* blocks asked for since the context was made          */
    uint64_t fail_at;  /* which of them is refused, counted from 1; 0: none    */
    uint64_t live;     /* blocks held now; the context itself is one           */
    char     log[256]; /* last warning                                        */
    uint64_t progress_calls;
    uint64_t cancel_at; /* which call of the progress callback cancels, from 1; 0: none */
} failing_memory;

/* A context on the counted memory, one thread.  *memory is reset but for fail_at and cancel_at. */
assay_context *failing_context(failing_memory *memory);

/* A test's set-up and tear-down: *state is a context of counted memory that refuses nothing, and
 * all that the test made must be gone in the end.  One at a time. */
int counted_set_up(void **state);
int counted_tear_down(void **state);

/* Calls `work` with the 1st, 2nd, ... block refused until it succeeds.  Fails the test unless each
 * refusal gives ASSAY_ERR_MEMORY with a message and nothing is left allocated.  work must release
 * all that it makes.  Returns the number of refusals. */
int failing_each(assay_status (*work)(assay_context *context, void *user), void *user);

#endif
