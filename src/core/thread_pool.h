/* thread_pool.h - threads that help with a piece of work, if they come in time.
 *
 * The caller never waits for a helper that has not begun: on a busy machine, where a helper may be
 * kept waiting for far longer than the work takes, it is then done by the caller alone. */
#ifndef ASSAY_CORE_THREAD_POOL_H
#define ASSAY_CORE_THREAD_POOL_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

/* What all do together.  Worker 0 is the caller, 1 and up are helpers: whoever comes takes what is
 * left to do, and returns when nothing is. */
typedef void (*assay_thread_task)(void *user, int worker);

typedef struct {
    pthread_mutex_t   lock;
    pthread_cond_t    begun, done;
    assay_thread_task task; /* NULL: who comes now is too late             */
    void             *user;
    atomic_uint       number;  /* of the task, so that none is taken twice    */
    atomic_int        inside;  /* helpers at work                             */
    int               wanted;  /* helpers that may still come                 */
    bool              running; /* a caller is at work, or waits for helpers   */
    bool              ending;
    int               most, started, numbered; /* helpers: there may be, were started, run */
    pthread_t        *helpers;                 /* most of them, the owner's                */
} assay_thread_pool;

/* helpers: room for `most` threads, which are started by the first work that wants them.  False:
 * the system has no lock for it. */
bool assay_thread_pool_open(assay_thread_pool *pool, pthread_t *helpers, int most);
void assay_thread_pool_close(assay_thread_pool *pool);

/* Calls the task as worker 0, and by up to `helpers` helpers; returns when all that began have
 * returned.  From inside a task: by the caller alone. */
void assay_thread_pool_run(assay_thread_pool *pool, int helpers, assay_thread_task task,
                           void *user);

#endif
