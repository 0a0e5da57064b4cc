/* SPDX-License-Identifier: MIT */
#include "lock.h"

enum {
    /* Tries before a thread goes to sleep, which costs some ten microseconds to wake from. A reader waits for a
     * change, mostly well below a microsecond; a writer for readers that have some rays to do yet, up to some 50. */
    READER_SPINS = 100,
    WRITER_SPINS = 3000
};

void rgi_lock_init(rgi_lock *lock) {
    lock->state = lock->writers = lock->waiting = 0;
    lock->readers_asleep = lock->writers_asleep = lock->phase = lock->granted = 0;
    pthread_mutex_init(&lock->mutex, NULL);
    pthread_cond_init(&lock->readers_turn, NULL);
    pthread_cond_init(&lock->writers_turn, NULL);
}

void rgi_lock_destroy(rgi_lock *lock) {
    /* Whoever handed over last may not have let go of the mutex yet. */
    pthread_mutex_lock(&lock->mutex);
    pthread_mutex_unlock(&lock->mutex);
    pthread_cond_destroy(&lock->writers_turn);
    pthread_cond_destroy(&lock->readers_turn);
    pthread_mutex_destroy(&lock->mutex);
}

/* Tells the processor that this is a loop that waits. */
static void pause_briefly(void) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ __volatile__("yield");
#endif
}

static void add(uint32_t *counter, int change) {
    __atomic_fetch_add(counter, (uint32_t)change, __ATOMIC_SEQ_CST);
}

/* ------------------------------------------------------------------------------------------- handing over */

/* With the mutex held. The others sleep on. */
static void let_readers_in(rgi_lock *lock) {
    uint32_t others = lock->writers_asleep ? RGI_LOCK_ASLEEP : 0;
    __atomic_store_n(&lock->state, lock->readers_asleep | others, __ATOMIC_RELEASE);
    lock->readers_asleep = 0;
    lock->phase++;
    pthread_cond_broadcast(&lock->readers_turn);
}

static void let_writer_in(rgi_lock *lock) {
    lock->writers_asleep--;
    lock->granted++;
    uint32_t others = lock->writers_asleep || lock->readers_asleep ? RGI_LOCK_ASLEEP : 0;
    __atomic_store_n(&lock->state, RGI_LOCK_WRITER | others, __ATOMIC_RELEASE);
    pthread_cond_signal(&lock->writers_turn);
}

/*
 * The lock is the leaving thread's to give: with ASLEEP set no other thread changes its state. After a change the
 * readers that wait have their turn, after readers a writer.
 */
void rgi_lock_hand_over(rgi_lock *lock) {
    pthread_mutex_lock(&lock->mutex);
    bool changed = __atomic_load_n(&lock->state, __ATOMIC_ACQUIRE) & RGI_LOCK_WRITER;
    if (lock->readers_asleep && (changed || !lock->writers_asleep))
        let_readers_in(lock);
    else
        let_writer_in(lock);
    pthread_mutex_unlock(&lock->mutex);
}

/* ------------------------------------------------------------------------------------------------- waiting */

/* With the mutex held: gets in by `try`, or leaves word that somebody sleeps. Returns whether it is in. */
static bool get_in_or_leave_word(rgi_lock *lock, bool (*try)(rgi_lock *lock)) {
    for (;;) {
        uint32_t state = __atomic_load_n(&lock->state, __ATOMIC_RELAXED);
        if (state & RGI_LOCK_ASLEEP) return false;
        if (try(lock)) return true;
        if (state && __atomic_compare_exchange_n(&lock->state, &state, state | RGI_LOCK_ASLEEP, false,
                                                 __ATOMIC_ACQ_REL, __ATOMIC_RELAXED))
            return false;
    }
}

static bool try_read(rgi_lock *lock) {
    return rgi_lock_try_read(lock);
}

/* Into an empty lock also past a writer that waits: that one may be waiting for the mutex. */
static bool try_read_last(rgi_lock *lock) {
    uint32_t none = 0;
    return rgi_lock_try_read(lock) ||
           __atomic_compare_exchange_n(&lock->state, &none, 1, false, __ATOMIC_ACQUIRE, __ATOMIC_RELAXED);
}

static bool try_write(rgi_lock *lock) {
    return rgi_lock_try_write(lock);
}

static void sleep_until_readers_turn(rgi_lock *lock) {
    pthread_mutex_lock(&lock->mutex);
    if (!get_in_or_leave_word(lock, try_read_last)) {
        uint32_t phase = lock->phase;
        lock->readers_asleep++;
        while (lock->phase == phase) pthread_cond_wait(&lock->readers_turn, &lock->mutex);
    }
    pthread_mutex_unlock(&lock->mutex);
}

static void sleep_until_granted(rgi_lock *lock) {
    pthread_mutex_lock(&lock->mutex);
    if (!get_in_or_leave_word(lock, try_write)) {
        lock->writers_asleep++;
        while (!lock->granted) pthread_cond_wait(&lock->writers_turn, &lock->mutex);
        lock->granted--;
    }
    pthread_mutex_unlock(&lock->mutex);
}

static bool spin(rgi_lock *lock, bool (*try)(rgi_lock *lock), int times) {
    for (int i = 0; i < times; i++) {
        if (try(lock)) return true;
        pause_briefly();
    }
    return false;
}

void rgi_lock_read_waiting(rgi_lock *lock) {
    add(&lock->waiting, 1);
    if (!spin(lock, try_read, READER_SPINS)) sleep_until_readers_turn(lock);
    add(&lock->waiting, -1);
}

void rgi_lock_write_waiting(rgi_lock *lock) {
    add(&lock->waiting, 1);
    add(&lock->writers, 1);
    if (!spin(lock, try_write, WRITER_SPINS)) sleep_until_granted(lock);
    add(&lock->writers, -1);
    add(&lock->waiting, -1);
}
