/* test_thread_pool.c - helpers: who comes, who is waited for, and who is not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "core/thread_pool.h"

enum { HELPERS = 3 };

typedef struct {
    assay_thread_pool *pool;
    atomic_int         items, taken, entered, left, inside, most_inside, nested;
    atomic_int         seen[HELPERS + 1]; /* a worker at work, so that none is twice */
    int                pause_us;
    bool               nests;
} job;

static void sleep_us(int us)
{
    const struct timespec t = {0, us * 1000L};
    nanosleep(&t, NULL);
}

static void count_nested(void *user, int worker)
{
    assert_int_equal(worker, 0);
    atomic_fetch_add((atomic_int *)user, 1);
}

static void take_items(void *user, int worker)
{
    job *j = user;
    assert_true(worker >= 0 && worker <= HELPERS);
    assert_int_equal(atomic_fetch_add(&j->seen[worker], 1), 0);
    atomic_fetch_add(&j->entered, 1);
    const int inside = atomic_fetch_add(&j->inside, 1) + 1;
    if (inside > atomic_load(&j->most_inside)) {
        atomic_store(&j->most_inside, inside);
    }
    while (atomic_fetch_sub(&j->items, 1) > 0) {
        atomic_fetch_add(&j->taken, 1);
        if (j->nests) {
            assay_thread_pool_run(j->pool, HELPERS, count_nested, &j->nested);
        }
        if (j->pause_us) {
            sleep_us(j->pause_us);
        }
    }
    if (worker > 0 && j->pause_us) {
        sleep_us(10 * j->pause_us);
    }
    atomic_fetch_sub(&j->inside, 1);
    atomic_fetch_add(&j->left, 1);
    atomic_fetch_sub(&j->seen[worker], 1);
}

typedef struct {
    assay_thread_pool pool;
    pthread_t         helpers[HELPERS];
} fixture;

static void open(fixture *f) { assert_true(assay_thread_pool_open(&f->pool, f->helpers, HELPERS)); }

static void run(fixture *f, job *j, int helpers, int items)
{
    j->pool = &f->pool;
    atomic_store(&j->items, items);
    assay_thread_pool_run(&f->pool, helpers, take_items, j);
    /* All are done, once, and nobody is at work any more. */
    assert_int_equal(atomic_load(&j->taken), items);
    assert_int_equal(atomic_load(&j->entered), atomic_load(&j->left));
    assert_int_equal(atomic_load(&j->inside), 0);
    assert_true(atomic_load(&j->entered) <= helpers + 1);
}

/* Many short pieces of work, one after another. */
static void short_work(void **state)
{
    (void)state;
    fixture f;
    open(&f);
    for (int i = 0; i < 20000; i++) {
        job j = {.pause_us = 0};
        run(&f, &j, i % (HELPERS + 1), i % 7);
    }
    assay_thread_pool_close(&f.pool);
}

/* Work long enough for helpers to come; they are waited for to the end. */
static void helpers_come(void **state)
{
    (void)state;
    fixture f;
    int     most = 0;
    open(&f);
    for (int i = 0; i < 200 && most < HELPERS + 1; i++) {
        job j = {.pause_us = 500};
        run(&f, &j, HELPERS, 12);
        most = atomic_load(&j.most_inside) > most ? atomic_load(&j.most_inside) : most;
    }
    assert_int_equal(most, HELPERS + 1);
    assay_thread_pool_close(&f.pool);
}

/* No more of them than are wanted, though more are there. */
static void no_more_than_wanted(void **state)
{
    (void)state;
    fixture f;
    open(&f);
    for (int i = 0; i < 30; i++) {
        job all = {.pause_us = 100}, one = {.pause_us = 100}, none = {.pause_us = 100};
        run(&f, &all, HELPERS, 8);
        run(&f, &one, 1, 8);
        assert_true(atomic_load(&one.most_inside) <= 2);
        run(&f, &none, 0, 8);
        assert_int_equal(atomic_load(&none.most_inside), 1);
    }
    assay_thread_pool_close(&f.pool);
}

/* Inside a task a worker is alone. */
static void nested(void **state)
{
    (void)state;
    fixture f;
    open(&f);
    for (int i = 0; i < 50; i++) {
        job j = {.nests = true, .pause_us = 50};
        run(&f, &j, HELPERS, 9);
        assert_int_equal(atomic_load(&j.nested), 9);
    }
    assay_thread_pool_close(&f.pool);
}

/* Pools that never worked, or whose helpers are still on their way. */
static void opened_and_closed(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        fixture f;
        open(&f);
        if (i % 2) {
            job j = {.pause_us = 0};
            run(&f, &j, HELPERS, 1);
        }
        assay_thread_pool_close(&f.pool);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_work),          cmocka_unit_test(helpers_come),
        cmocka_unit_test(no_more_than_wanted), cmocka_unit_test(nested),
        cmocka_unit_test(opened_and_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
