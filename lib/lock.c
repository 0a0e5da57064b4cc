/* SPDX-License-Identifier: MIT */
#include "lock.h"

void rgi_lock_init(rgi_lock *lock) {
    lock->state = lock->writers = lock->sleepers = 0;
    pthread_mutex_init(&lock->mutex, NULL);
    pthread_cond_init(&lock->changed, NULL);
}

void rgi_lock_destroy(rgi_lock *lock) {
    pthread_cond_destroy(&lock->changed);
    pthread_mutex_destroy(&lock->mutex);
}

/*
 * No wake is lost: a thread counts itself as a sleeper before it tries again, and one that leaves looks at the
 * sleepers after it has left, both in one total order. So either the try succeeds or the leaving thread sees the
 * sleeper; and as that one holds the mutex from its try until it waits, the wake comes after.
 */
static void wait_for(rgi_lock *lock, bool (*try)(rgi_lock *lock)) {
    pthread_mutex_lock(&lock->mutex);
    __atomic_add_fetch(&lock->sleepers, 1, __ATOMIC_SEQ_CST);
    while (!try(lock)) pthread_cond_wait(&lock->changed, &lock->mutex);
    __atomic_sub_fetch(&lock->sleepers, 1, __ATOMIC_SEQ_CST);
    pthread_mutex_unlock(&lock->mutex);
}

/* A try to read may fail because another reader came in between, which wakes nobody: then it is made again. */
static bool try_read(rgi_lock *lock) {
    while (!rgi_lock_try_read(lock)) {
        if (__atomic_load_n(&lock->writers, __ATOMIC_SEQ_CST)) return false;
        if (__atomic_load_n(&lock->state, __ATOMIC_SEQ_CST) & RGI_LOCK_WRITER) return false;
    }
    return true;
}

static bool try_write(rgi_lock *lock) {
    return rgi_lock_try_write(lock);
}

void rgi_lock_read_waiting(rgi_lock *lock) {
    if (!try_read(lock)) wait_for(lock, try_read);
}

/* Readers that were held back by a waiting writer find the lock held by it then; its leaving wakes them. */
void rgi_lock_write_waiting(rgi_lock *lock) {
    __atomic_add_fetch(&lock->writers, 1, __ATOMIC_SEQ_CST);
    wait_for(lock, try_write);
    __atomic_sub_fetch(&lock->writers, 1, __ATOMIC_SEQ_CST);
}

void rgi_lock_wake(rgi_lock *lock) {
    pthread_mutex_lock(&lock->mutex);
    pthread_cond_broadcast(&lock->changed);
    pthread_mutex_unlock(&lock->mutex);
}
