/* SPDX-License-Identifier: MIT */
#include "pool.h"
#include "unit.h"

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <time.h>

enum { MANY = 2000 };

typedef struct work {
    uint32_t done[MANY]; /* atomic */
    pthread_t by[MANY];
} work;

static void body(void *context, uint64_t index) {
    work *w = context;
    __atomic_fetch_add(&w->done[index], 1, __ATOMIC_RELAXED);
    w->by[index] = pthread_self();
}

static void run_and_check(rgi_pool *pool, uint64_t count) {
    work *w = calloc(1, sizeof *w);
    ck_assert_ptr_nonnull(w);
    rgi_pool_run(pool, count, body, w);
    for (uint64_t i = 0; i < MANY; i++) ck_assert_uint_eq(w->done[i], i < count);
    free(w);
}

START_TEST(each_index_once) {
    const uint32_t workers[] = {1, 2, 3, 8};
    for (int i = 0; i < 4; i++) {
        rgi_memory memory;
        rgi_pool *pool;
        rgi_memory_init(&memory, NULL);
        ck_assert_int_eq(rgi_pool_create(&memory, workers[i], NULL, NULL, &pool), RG_OK);
        ck_assert_uint_eq(rgi_pool_workers(pool), workers[i]);
        for (uint64_t n = 0; n < 40; n++) run_and_check(pool, n);
        run_and_check(pool, MANY);
        rgi_pool_destroy(pool);
        ck_assert_uint_eq(memory.bytes, 0);
    }
}
END_TEST

START_TEST(one_worker_is_the_caller) {
    rgi_memory memory;
    rgi_pool *pool;
    work *w = calloc(1, sizeof *w);
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_pool_create(&memory, 1, NULL, NULL, &pool), RG_OK);
    rgi_pool_run(pool, MANY, body, w);
    for (int i = 0; i < MANY; i++) ck_assert(pthread_equal(w->by[i], pthread_self()));
    rgi_pool_destroy(pool);
    free(w);
}
END_TEST

static void *several(void *argument) {
    for (int i = 0; i < 50; i++) run_and_check(argument, 1 + (uint64_t)i * 37);
    return NULL;
}

START_TEST(several_callers_at_once) {
    rgi_memory memory;
    rgi_pool *pool;
    pthread_t threads[4];
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_pool_create(&memory, 3, NULL, NULL, &pool), RG_OK);
    for (int i = 0; i < 4; i++) ck_assert_int_eq(pthread_create(&threads[i], NULL, several, pool), 0);
    for (int i = 0; i < 4; i++) pthread_join(threads[i], NULL);
    rgi_pool_destroy(pool);
}
END_TEST

static void signals_blocked(void *context, uint64_t index) {
    sigset_t blocked;
    work *w = context;
    pthread_sigmask(SIG_SETMASK, NULL, &blocked);
    w->by[index] = pthread_self();
    w->done[index] = (uint32_t)sigismember(&blocked, SIGUSR1);
    /* Long enough for the worker to wake up and take its share. */
    for (struct timespec ms = {0, 1000000}; nanosleep(&ms, &ms);) continue;
}

START_TEST(signals_are_for_the_host) {
    rgi_memory memory;
    rgi_pool *pool;
    sigset_t blocked;
    int by_worker = 0;
    work *w = calloc(1, sizeof *w);
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_pool_create(&memory, 2, NULL, NULL, &pool), RG_OK);
    pthread_sigmask(SIG_SETMASK, NULL, &blocked);
    ck_assert(!sigismember(&blocked, SIGUSR1));
    for (int turn = 0; turn < 100 && !by_worker; turn++) {
        rgi_pool_run(pool, 40, signals_blocked, w);
        for (int i = 0; i < 40; i++) {
            bool own = pthread_equal(w->by[i], pthread_self());
            by_worker += !own;
            ck_assert_uint_eq(w->done[i], !own);
        }
    }
    ck_assert_int_gt(by_worker, 0);
    rgi_pool_destroy(pool);
    free(w);
}
END_TEST

static void backwards(void *user, uint64_t count, void (*each)(void *, uint64_t), void *context) {
    ++*(int *)user;
    while (count) each(context, --count);
}

START_TEST(the_hosts_own) {
    rgi_memory memory;
    rgi_pool *pool;
    int calls = 0;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_pool_create(&memory, 8, backwards, &calls, &pool), RG_OK);
    ck_assert_uint_eq(rgi_pool_workers(pool), 0);
    run_and_check(pool, MANY);
    ck_assert_int_eq(calls, 1);
    rgi_pool_destroy(pool);
}
END_TEST

/* Spare work of some parts, beside a job of many. */
static struct {
    uint32_t parts;  /* atomic: that are left */
    uint64_t taken;  /* atomic: of the job */
    uint64_t before; /* so many of them when the last part was done */
    pthread_t caller;
} spare;

enum { PARTS = 10, LONG_JOB = 5000000 };

static bool spare_part(void *context) {
    (void)context;
    uint32_t left = __atomic_sub_fetch(&spare.parts, 1, __ATOMIC_RELEASE);
    if (!left) spare.before = __atomic_load_n(&spare.taken, __ATOMIC_RELAXED);
    return left > 0;
}

/* The caller is kept until the spare work is done, so that the worker alone gets on with the job. */
static void beside_spare(void *context, uint64_t index) {
    const struct timespec briefly = {0, 100000};
    (void)context, (void)index;
    __atomic_fetch_add(&spare.taken, 1, __ATOMIC_RELAXED);
    while (pthread_equal(pthread_self(), spare.caller) && __atomic_load_n(&spare.parts, __ATOMIC_ACQUIRE))
        nanosleep(&briefly, NULL);
}

/* Spare work gets on while a worker has a long job to do. */
START_TEST(spare_work_gets_on) {
    rgi_memory memory;
    rgi_pool *pool;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_pool_create(&memory, 2, NULL, NULL, &pool), RG_OK);
    rgi_pool_set_spare_work(pool, spare_part, NULL);
    for (int turn = 0; turn < 5; turn++) {
        spare.caller = pthread_self();
        spare.parts = PARTS;
        spare.taken = 0;
        rgi_pool_wake(pool);
        rgi_pool_run(pool, LONG_JOB, beside_spare, NULL);
        ck_assert_uint_eq(spare.parts, 0);
        ck_assert_uint_eq(spare.taken, LONG_JOB);
        ck_assert_uint_lt(spare.before, LONG_JOB / 2);
    }
    rgi_pool_destroy(pool);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("pool");
    TCase *tests = tcase_create("pool");
    tcase_add_test(tests, each_index_once);
    tcase_add_test(tests, one_worker_is_the_caller);
    tcase_add_test(tests, several_callers_at_once);
    tcase_add_test(tests, signals_are_for_the_host);
    tcase_add_test(tests, the_hosts_own);
    tcase_add_test(tests, spare_work_gets_on);
    suite_add_tcase(suite, tests);
    return suite;
}
