/* SPDX-License-Identifier: MIT */
#include "lock.h"
#include "unit.h"

#include <pthread.h>
#include <sched.h>

enum { THREADS = 6, ROUNDS = 20000 };

/** Two numbers that only a writer changes, both at once, and counts of those inside. */
typedef struct guarded {
    rgi_lock lock;
    int rounds;
    uint64_t one, other;
    uint32_t readers, writers; /* inside now, atomic */
    uint32_t errors;           /* atomic */
    uint32_t finished;         /* readers, atomic */
    uint64_t written, yielded; /* atomic */
} guarded;

static void expect(guarded *g, bool right) {
    if (!right) __atomic_fetch_add(&g->errors, 1, __ATOMIC_RELAXED);
}

static void write_both(guarded *g) {
    rgi_lock_write(&g->lock);
    expect(g, __atomic_add_fetch(&g->writers, 1, __ATOMIC_RELAXED) == 1);
    expect(g, __atomic_load_n(&g->readers, __ATOMIC_RELAXED) == 0);
    g->one++;
    g->other++;
    __atomic_sub_fetch(&g->writers, 1, __ATOMIC_RELAXED);
    rgi_lock_leave_write(&g->lock);
}

/* Some readers stay inside until a writer waits, as long calls do. */
static void read_both(guarded *g, bool long_call) {
    rgi_lock_read(&g->lock);
    __atomic_add_fetch(&g->readers, 1, __ATOMIC_RELAXED);
    expect(g, __atomic_load_n(&g->writers, __ATOMIC_RELAXED) == 0);
    expect(g, g->one == g->other);
    for (int i = 0; long_call && i < 100; i++) {
        if (rgi_lock_is_wanted(&g->lock)) {
            __atomic_add_fetch(&g->yielded, 1, __ATOMIC_RELAXED);
            break;
        }
        expect(g, g->one == g->other);
    }
    __atomic_sub_fetch(&g->readers, 1, __ATOMIC_RELAXED);
    rgi_lock_leave_read(&g->lock);
}

static void *read_often(void *context) {
    guarded *g = context;
    for (int i = 0; i < g->rounds; i++) read_both(g, i % 3 == 0);
    __atomic_fetch_add(&g->finished, 1, __ATOMIC_RELAXED);
    return NULL;
}

static void *write_often(void *context) {
    guarded *g = context;
    for (int i = 0; i < g->rounds; i++) {
        write_both(g);
        if (i % 16 == 0) sched_yield();
    }
    __atomic_fetch_add(&g->written, (uint64_t)g->rounds, __ATOMIC_RELAXED);
    return NULL;
}

static void run(int writers, int rounds) {
    guarded g = {.rounds = rounds};
    pthread_t threads[THREADS];
    rgi_lock_init(&g.lock);
    for (int i = 0; i < THREADS; i++)
        ck_assert_int_eq(pthread_create(&threads[i], NULL, i < writers ? write_often : read_often, &g), 0);
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
    ck_assert_uint_eq(g.errors, 0);
    ck_assert_uint_eq(g.one, g.written);
    ck_assert_uint_eq(g.other, g.written);
    ck_assert_uint_eq(g.lock.state, 0);
    ck_assert_uint_eq(g.lock.waiting, 0);
    ck_assert_uint_eq(g.lock.writers, 0);
    ck_assert(!rgi_lock_has_waiting(&g.lock));
    rgi_lock_destroy(&g.lock);
}

START_TEST(writers_are_alone) {
    for (int writers = 1; writers <= THREADS; writers++) run(writers, ROUNDS);
}
END_TEST

START_TEST(readers_share) {
    rgi_lock lock;
    rgi_lock_init(&lock);
    ck_assert(rgi_lock_try_read(&lock));
    ck_assert(rgi_lock_try_read(&lock));
    ck_assert(!rgi_lock_try_write(&lock));
    rgi_lock_leave_read(&lock);
    ck_assert(!rgi_lock_try_write(&lock));
    rgi_lock_leave_read(&lock);
    ck_assert(rgi_lock_try_write(&lock));
    ck_assert(!rgi_lock_try_read(&lock));
    ck_assert(!rgi_lock_try_write(&lock));
    rgi_lock_leave_write(&lock);
    ck_assert(rgi_lock_try_read(&lock));
    rgi_lock_leave_read(&lock);
    rgi_lock_destroy(&lock);
}
END_TEST

static void *write_once(void *context) {
    write_both(context);
    return NULL;
}

static void *read_once(void *context) {
    read_both(context, false);
    return NULL;
}

static void wait_until_waiting(const guarded *g, uint32_t count) {
    while (__atomic_load_n(&g->lock.waiting, __ATOMIC_ACQUIRE) < count) sched_yield();
}

/* A writer waits for the reader inside, and no reader gets in before it: it can't starve. */
START_TEST(a_waiting_writer_holds_readers_back) {
    guarded g = {.rounds = 1};
    pthread_t writer, reader;
    rgi_lock_init(&g.lock);
    rgi_lock_read(&g.lock);
    ck_assert(!rgi_lock_is_wanted(&g.lock));
    ck_assert_int_eq(pthread_create(&writer, NULL, write_once, &g), 0);
    wait_until_waiting(&g, 1);
    while (!rgi_lock_is_wanted(&g.lock)) sched_yield();
    ck_assert(!rgi_lock_try_read(&g.lock));
    ck_assert_int_eq(pthread_create(&reader, NULL, read_once, &g), 0);
    wait_until_waiting(&g, 2);
    ck_assert_uint_eq(g.one, 0);
    rgi_lock_leave_read(&g.lock);
    pthread_join(writer, NULL);
    pthread_join(reader, NULL);
    ck_assert_uint_eq(g.one, 1);
    ck_assert_uint_eq(g.errors, 0);
    ck_assert_uint_eq(g.lock.state, 0);
    rgi_lock_destroy(&g.lock);
}
END_TEST

/* A thread that does nothing but change lets readers in all the same: each waits for one change. */
START_TEST(readers_do_not_starve) {
    guarded g = {.rounds = 200};
    pthread_t threads[THREADS];
    rgi_lock_init(&g.lock);
    for (int i = 0; i < THREADS; i++) ck_assert_int_eq(pthread_create(&threads[i], NULL, read_often, &g), 0);
    while (__atomic_load_n(&g.finished, __ATOMIC_RELAXED) < THREADS) write_both(&g);
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
    ck_assert_uint_eq(g.errors, 0);
    rgi_lock_destroy(&g.lock);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("lock");
    TCase *tests = tcase_create("lock");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, readers_share);
    tcase_add_test(tests, a_waiting_writer_holds_readers_back);
    tcase_add_test(tests, writers_are_alone);
    tcase_add_test(tests, readers_do_not_starve);
    suite_add_tcase(suite, tests);
    return suite;
}
