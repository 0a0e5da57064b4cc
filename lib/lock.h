/* SPDX-License-Identifier: MIT */
/*
 * A lock for many readers or one writer, writers first: pthread_rwlock_t with the cost of one atomic operation each
 * way as long as nobody has to wait, for calls that take some ten nanoseconds.
 */
#ifndef RAYGRID_LIB_LOCK_H
#define RAYGRID_LIB_LOCK_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct rgi_lock {
    uint32_t state;    /* atomic: readers inside, or RGI_LOCK_WRITER */
    uint32_t writers;  /* atomic: writers that wait; while there are some, no reader enters */
    uint32_t sleepers; /* atomic: threads that wait; who leaves wakes them */
    pthread_mutex_t mutex;
    pthread_cond_t changed;
} rgi_lock;

#define RGI_LOCK_WRITER 0x80000000u

void rgi_lock_init(rgi_lock *lock);
void rgi_lock_destroy(rgi_lock *lock);

void rgi_lock_read_waiting(rgi_lock *lock);
void rgi_lock_write_waiting(rgi_lock *lock);
void rgi_lock_wake(rgi_lock *lock);

/** One try, without waiting. */
static inline bool rgi_lock_try_read(rgi_lock *lock) {
    uint32_t state = __atomic_load_n(&lock->state, __ATOMIC_RELAXED);
    return !(state & RGI_LOCK_WRITER) && !__atomic_load_n(&lock->writers, __ATOMIC_SEQ_CST) &&
           __atomic_compare_exchange_n(&lock->state, &state, state + 1, false, __ATOMIC_SEQ_CST, __ATOMIC_RELAXED);
}

static inline bool rgi_lock_try_write(rgi_lock *lock) {
    uint32_t none = 0;
    return __atomic_compare_exchange_n(&lock->state, &none, RGI_LOCK_WRITER, false, __ATOMIC_SEQ_CST,
                                       __ATOMIC_RELAXED);
}

static inline void rgi_lock_read(rgi_lock *lock) {
    if (!rgi_lock_try_read(lock)) rgi_lock_read_waiting(lock);
}

static inline void rgi_lock_write(rgi_lock *lock) {
    if (!rgi_lock_try_write(lock)) rgi_lock_write_waiting(lock);
}

static inline void rgi_lock_leave_read(rgi_lock *lock) {
    uint32_t left = __atomic_sub_fetch(&lock->state, 1, __ATOMIC_SEQ_CST);
    if (left == 0 && __atomic_load_n(&lock->sleepers, __ATOMIC_SEQ_CST)) rgi_lock_wake(lock);
}

static inline void rgi_lock_leave_write(rgi_lock *lock) {
    (void)__atomic_exchange_n(&lock->state, 0, __ATOMIC_SEQ_CST);
    if (__atomic_load_n(&lock->sleepers, __ATOMIC_SEQ_CST)) rgi_lock_wake(lock);
}

#endif
