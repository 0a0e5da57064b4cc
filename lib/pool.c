/* SPDX-License-Identifier: MIT */
#include "pool.h"

#include "error.h"

#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Of the time of a worker that has jobs to do, spare work gets one part in so many. */
enum { SPARE_SHARE = 5 };

/* A call that is being worked on, in the caller's stack. Workers that joined are counted under the pool's lock, so
 * the caller knows when the last has left and the job may vanish. */
typedef struct job {
    struct job *next;
    rgi_body body;
    void *context;
    uint64_t count;
    uint64_t taken;  /* atomic: the first index that nobody has taken */
    uint32_t joined; /* workers inside, under the lock */
} job;

struct rgi_pool {
    rgi_memory *memory;
    rg_parallel_for parallel_for;
    void *user;
    uint32_t workers;
    uint32_t started; /* threads that run */
    pid_t process;    /* whose they are */
    bool ending;
    rgi_spare_work spare_work;
    void *spare_context;
    bool has_spare_work, spare_taken; /* read without the lock, too */
    pthread_mutex_t lock;
    pthread_cond_t work; /* a job came, or the end */
    pthread_cond_t done; /* a worker left a job */
    job *jobs;
    pthread_t *threads;
};

/* False: there was nothing left of it. */
static bool work_once(job *j) {
    uint64_t index = __atomic_fetch_add(&j->taken, 1, __ATOMIC_RELAXED);
    if (index >= j->count) return false;
    j->body(j->context, index);
    return true;
}

static void work_on(job *j) {
    while (work_once(j)) continue;
}

#if !defined(RGI_NO_THREADS)
static bool has_work(const job *j) {
    return __atomic_load_n(&j->taken, __ATOMIC_RELAXED) < j->count;
}

static bool has_spare(const rgi_pool *pool) {
    return __atomic_load_n(&pool->has_spare_work, __ATOMIC_RELAXED) &&
           !__atomic_load_n(&pool->spare_taken, __ATOMIC_RELAXED);
}

/* Seconds. */
static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Until nothing is left, or there is spare work as well. With the lock held, but not while it works. Returns the
 * seconds that it took, if there is spare work. */
static double join(rgi_pool *pool, job *j) {
    double start = 0;
    bool spare = false;
    j->joined++;
    pthread_mutex_unlock(&pool->lock);
    do {
        spare = has_spare(pool);
        if (spare) start = now();
    } while (work_once(j) && !spare);
    pthread_mutex_lock(&pool->lock);
    if (--j->joined == 0) pthread_cond_broadcast(&pool->done);
    return spare ? now() - start : 0;
}

/* For so many seconds; one part of it at least. With the lock held, but not while it works. */
static void do_spare(rgi_pool *pool, double seconds) {
    __atomic_store_n(&pool->spare_taken, true, __ATOMIC_RELAXED);
    pthread_mutex_unlock(&pool->lock);
    double start = now();
    bool more;
    do {
        /* Cleared before: so another wake meanwhile is not lost. */
        __atomic_store_n(&pool->has_spare_work, false, __ATOMIC_RELAXED);
        more = pool->spare_work(pool->spare_context);
    } while (more && now() - start < seconds);
    pthread_mutex_lock(&pool->lock);
    if (more) __atomic_store_n(&pool->has_spare_work, true, __ATOMIC_RELAXED);
    __atomic_store_n(&pool->spare_taken, false, __ATOMIC_RELAXED);
}

/* Jobs first, but spare work has its share of the time: so that gets on under any load. */
static void *worker(void *argument) {
    rgi_pool *pool = argument;
    double worked = 0; /* seconds, since the last spare work */
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        job *j = pool->jobs;
        while (j && !has_work(j)) j = j->next;
        if (pool->ending && !j) break;
        if (has_spare(pool) && (!j || worked > 0)) {
            do_spare(pool, worked / (SPARE_SHARE - 1));
            worked = 0;
        } else if (j) {
            worked = join(pool, j);
        } else {
            pthread_cond_wait(&pool->work, &pool->lock);
        }
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

/* Shows the job to the workers, takes part, and waits for those that joined. */
static void share(rgi_pool *pool, job *j) {
    pthread_mutex_lock(&pool->lock);
    j->next = pool->jobs;
    pool->jobs = j;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);

    work_on(j);

    pthread_mutex_lock(&pool->lock);
    job **link = &pool->jobs;
    while (*link != j) link = &(*link)->next;
    *link = j->next;
    while (j->joined) pthread_cond_wait(&pool->done, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
}

/* In a child of the process that made them there are none, and what they held stays as it is. */
static void end_threads(rgi_pool *pool) {
    if (pool->process != getpid()) {
        rgi_release(pool->memory, pool->threads, pool->workers, sizeof *pool->threads);
        return;
    }
    pthread_mutex_lock(&pool->lock);
    pool->ending = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->started; i++) pthread_join(pool->threads[i], NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->work);
    pthread_mutex_destroy(&pool->lock);
    rgi_release(pool->memory, pool->threads, pool->workers, sizeof *pool->threads);
}

/* Workers start with all signals blocked: the host's handlers are for the host's threads. */
static rg_result start_threads(rgi_pool *pool) {
    sigset_t all, before;
    int error = 0;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (!error && pool->started < pool->workers - 1) {
        error = pthread_create(&pool->threads[pool->started], NULL, worker, pool);
        pool->started += !error;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!error) return RG_OK;
    return rgi_fail(RG_OUT_OF_THREADS, "worker %u of %u could not be started (error %d)", pool->started + 1,
                    pool->workers - 1, error);
}

static rg_result make_threads(rgi_pool *pool, uint32_t workers) {
    pool->workers = workers;
    pool->process = getpid();
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->done, NULL);
    if (workers < 2) return RG_OK;
    rg_result result = rgi_allocate(pool->memory, workers, sizeof *pool->threads, "the workers", &pool->threads);
    return result ? result : start_threads(pool);
}

void rgi_pool_wake(rgi_pool *pool) {
    if (!rgi_pool_has_threads(pool)) return;
    pthread_mutex_lock(&pool->lock);
    __atomic_store_n(&pool->has_spare_work, true, __ATOMIC_RELAXED);
    pthread_cond_signal(&pool->work);
    pthread_mutex_unlock(&pool->lock);
}
#else
/* The calling thread works alone, however many were asked for. */
static void share(rgi_pool *pool, job *j) {
    (void)pool;
    work_on(j);
}

static void end_threads(rgi_pool *pool) {
    (void)pool;
}

static rg_result make_threads(rgi_pool *pool, uint32_t workers) {
    (void)workers;
    pool->workers = 1;
    return RG_OK;
}

void rgi_pool_wake(rgi_pool *pool) {
    (void)pool;
}
#endif

bool rgi_pool_has_threads(const rgi_pool *pool) {
    return pool->started && pool->process == getpid();
}

void rgi_pool_set_spare_work(rgi_pool *pool, rgi_spare_work work, void *context) {
    pool->spare_work = work;
    pool->spare_context = context;
}

void rgi_pool_run(rgi_pool *pool, uint64_t count, rgi_body body, void *context) {
    if (pool->parallel_for && count > 1) {
        pool->parallel_for(pool->user, count, body, context);
        return;
    }
    job j = {NULL, body, context, count, 0, 0};
    if (count < 2 || !rgi_pool_has_threads(pool)) {
        work_on(&j);
        return;
    }
    share(pool, &j);
}

uint32_t rgi_pool_workers(const rgi_pool *pool) {
    return pool->parallel_for ? 0 : pool->workers;
}

void rgi_pool_destroy(rgi_pool *pool) {
    if (!pool) return;
    end_threads(pool);
    rgi_memory *memory = pool->memory;
    rgi_release(memory, pool, 1, sizeof *pool);
}

rg_result rgi_pool_create(rgi_memory *memory, uint32_t workers, rg_parallel_for parallel_for, void *user,
                          rgi_pool **out) {
    rgi_pool *pool;
    rg_result result = rgi_allocate(memory, 1, sizeof *pool, "the pool of workers", &pool);
    if (result) return result;
    memset(pool, 0, sizeof *pool);
    pool->memory = memory;
    pool->parallel_for = parallel_for;
    pool->user = user;
    result = make_threads(pool, parallel_for ? 1 : workers);
    if (result) {
        rgi_pool_destroy(pool);
        return result;
    }
    *out = pool;
    return RG_OK;
}
