/* SPDX-License-Identifier: MIT */
/*
 * A lock for many readers or one writer, fair by phases: a writer waits for the readers inside, a reader for at most
 * one writer. What pthread_rwlock_t does, with the cost of one atomic operation each way as long as nobody has to
 * wait, for calls that take some ten nanoseconds; and readers can see that a writer waits, and let it in.
 *
 * B. B. Brandenburg, J. H. Anderson, "Reader-Writer Synchronization for Shared-Memory Multiprocessor Real-Time
 * Systems" (ECRTS 2009), is where the idea of phases is from. Here who waits for long sleeps, and who leaves hands
 * the lock over to it.
 */
#ifndef RAYGRID_LIB_LOCK_H
#define RAYGRID_LIB_LOCK_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct rgi_lock {
    uint32_t state;   /* atomic: readers inside, RGI_LOCK_WRITER, RGI_LOCK_ASLEEP */
    uint32_t writers; /* atomic: writers that wait; while there are some, no reader enters */
    uint32_t waiting; /* atomic: all that wait */
    pthread_mutex_t mutex;
    /* All below under the mutex. */
    pthread_cond_t readers_turn, writers_turn;
    uint32_t readers_asleep, writers_asleep;
    uint32_t phase;   /* grows whenever the sleeping readers are let in, all at once */
    uint32_t granted; /* writers that were let in and have not woken yet: 0 or 1 */
} rgi_lock;

/*
 * ASLEEP: some thread sleeps until the lock is handed over to it. Who then is the last to leave does so; until it
 * has, nobody else gets in. It is only set while somebody is inside, so somebody always is to hand over.
 */
#define RGI_LOCK_WRITER 0x80000000u
#define RGI_LOCK_ASLEEP 0x40000000u

void rgi_lock_init(rgi_lock *lock);

/** When nobody is inside or waits. Those that have just left may still be about to return. */
void rgi_lock_destroy(rgi_lock *lock);

void rgi_lock_read_waiting(rgi_lock *lock);
void rgi_lock_write_waiting(rgi_lock *lock);
void rgi_lock_hand_over(rgi_lock *lock);

/** One try, without waiting. */
static inline bool rgi_lock_try_read(rgi_lock *lock) {
    uint32_t state = __atomic_load_n(&lock->state, __ATOMIC_RELAXED);
    return !(state & (RGI_LOCK_WRITER | RGI_LOCK_ASLEEP)) && !__atomic_load_n(&lock->writers, __ATOMIC_RELAXED) &&
           __atomic_compare_exchange_n(&lock->state, &state, state + 1, false, __ATOMIC_ACQUIRE, __ATOMIC_RELAXED);
}

static inline bool rgi_lock_try_write(rgi_lock *lock) {
    uint32_t none = 0;
    return __atomic_compare_exchange_n(&lock->state, &none, RGI_LOCK_WRITER, false, __ATOMIC_ACQUIRE,
                                       __ATOMIC_RELAXED);
}

static inline void rgi_lock_read(rgi_lock *lock) {
    if (!rgi_lock_try_read(lock)) rgi_lock_read_waiting(lock);
}

static inline void rgi_lock_write(rgi_lock *lock) {
    if (!rgi_lock_try_write(lock)) rgi_lock_write_waiting(lock);
}

static inline void rgi_lock_leave_read(rgi_lock *lock) {
    if (__atomic_sub_fetch(&lock->state, 1, __ATOMIC_ACQ_REL) == RGI_LOCK_ASLEEP) rgi_lock_hand_over(lock);
}

static inline void rgi_lock_leave_write(rgi_lock *lock) {
    uint32_t state = RGI_LOCK_WRITER;
    if (!__atomic_compare_exchange_n(&lock->state, &state, 0, false, __ATOMIC_RELEASE, __ATOMIC_RELAXED))
        rgi_lock_hand_over(lock);
}

/** For a reader inside: whether a writer waits for it. */
static inline bool rgi_lock_is_wanted(const rgi_lock *lock) {
    return __atomic_load_n(&lock->writers, __ATOMIC_RELAXED) != 0;
}

/** For the writer inside: whether others wait. */
static inline bool rgi_lock_has_waiting(const rgi_lock *lock) {
    return __atomic_load_n(&lock->waiting, __ATOMIC_ACQUIRE) != 0;
}

#endif
