/* thread_pool.c - helpers that sleep between tasks.
 *
 * Invariant: task, user, wanted, running, ending and count change under the lock alone; a helper
 * that has taken a task is counted in `inside` before the lock is free again, so that the caller,
 * who closes the task under the lock, sees everyone it has to wait for.
 *
 * Pieces of work are often shorter than going to sleep and waking up takes, and follow one another
 * closely: both sides look for a while before they sleep. */
#include "core/thread_pool.h"

#include <signal.h>

/* Looks before sleeping: some 10 to 50 us. */
enum { LOOKS = 1000 };

static void relax(void)
{
#if defined __x86_64__
    __builtin_ia32_pause();
#elif defined __aarch64__
    __asm__ volatile("yield");
#endif
}

/* ---- helpers ---- */

/* Sleeps, with the lock, until there is a task other than the last one.  False: the pool ends. */
static bool wait_for_task(assay_thread_pool *pool, unsigned last)
{
    pthread_mutex_unlock(&pool->lock);
    for (int i = 0; i < LOOKS && atomic_load(&pool->number) == last; i++) {
        relax();
    }
    pthread_mutex_lock(&pool->lock);
    while (!pool->ending && atomic_load(&pool->number) == last) {
        pthread_cond_wait(&pool->begun, &pool->lock);
    }
    return !pool->ending;
}

static void *help(void *user)
{
    assay_thread_pool *pool = user;
    unsigned           last = 0;
    pthread_mutex_lock(&pool->lock);
    const int worker = ++pool->numbered;
    while (wait_for_task(pool, last)) {
        const assay_thread_task task = pool->task;
        void *const             of   = pool->user;
        last                         = atomic_load(&pool->number);
        if (!task || pool->wanted == 0) {
            continue;
        }
        pool->wanted--;
        atomic_fetch_add(&pool->inside, 1);
        pthread_mutex_unlock(&pool->lock);
        task(of, worker);
        pthread_mutex_lock(&pool->lock);
        if (atomic_fetch_sub(&pool->inside, 1) == 1) {
            pthread_cond_signal(&pool->done);
        }
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

/* With the lock held.  Signals are the caller's affair.  Where the system gives no more threads,
 * there are fewer. */
static void start_helpers(assay_thread_pool *pool, int wanted)
{
    sigset_t all, before;
    sigfillset(&all);
    if (pool->started >= wanted || pthread_sigmask(SIG_SETMASK, &all, &before) != 0) {
        return;
    }
    while (pool->started < wanted &&
           pthread_create(&pool->helpers[pool->started], NULL, help, pool) == 0) {
        pool->started++;
    }
    pool->most = pool->started < wanted ? pool->started : pool->most;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* ---- the caller ---- */

bool assay_thread_pool_open(assay_thread_pool *pool, pthread_t *helpers, int most)
{
    *pool = (assay_thread_pool){.helpers = helpers, .most = most};
    if (pthread_mutex_init(&pool->lock, NULL) != 0) {
        return false;
    }
    if (pthread_cond_init(&pool->begun, NULL) != 0) {
        pthread_mutex_destroy(&pool->lock);
        return false;
    }
    if (pthread_cond_init(&pool->done, NULL) != 0) {
        pthread_cond_destroy(&pool->begun);
        pthread_mutex_destroy(&pool->lock);
        return false;
    }
    return true;
}

void assay_thread_pool_close(assay_thread_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    pool->ending = true;
    atomic_fetch_add(&pool->number, 1);
    pthread_cond_broadcast(&pool->begun);
    pthread_mutex_unlock(&pool->lock);
    for (int i = 0; i < pool->started; i++) {
        pthread_join(pool->helpers[i], NULL);
    }
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->begun);
    pthread_mutex_destroy(&pool->lock);
}

/* False: someone else's task is running. */
static bool begin(assay_thread_pool *pool, int helpers, assay_thread_task task, void *user)
{
    pthread_mutex_lock(&pool->lock);
    const bool free = !pool->running;
    if (free) {
        const int wanted = helpers < pool->most ? helpers : pool->most;
        start_helpers(pool, wanted);
        pool->running = true;
        pool->task    = task;
        pool->user    = user;
        pool->wanted  = wanted;
        atomic_fetch_add(&pool->number, 1);
        if (wanted > 0) {
            pthread_cond_broadcast(&pool->begun);
        }
    }
    pthread_mutex_unlock(&pool->lock);
    return free;
}

static void end(assay_thread_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    pool->task = NULL;
    pthread_mutex_unlock(&pool->lock);
    for (int i = 0; i < LOOKS && atomic_load(&pool->inside) > 0; i++) {
        relax();
    }
    pthread_mutex_lock(&pool->lock);
    while (atomic_load(&pool->inside) > 0) {
        pthread_cond_wait(&pool->done, &pool->lock);
    }
    pool->running = false;
    pthread_mutex_unlock(&pool->lock);
}

void assay_thread_pool_run(assay_thread_pool *pool, int helpers, assay_thread_task task, void *user)
{
    const bool begun = begin(pool, helpers, task, user);
    task(user, 0);
    if (begun) {
        end(pool);
    }
}
