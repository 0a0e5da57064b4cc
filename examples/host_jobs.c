/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "host_jobs.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_THREADS = 16 };

struct jobs {
    pthread_t threads[MAX_THREADS];
    int thread_count;
    pthread_mutex_t lock;
    pthread_cond_t wake, finished;
    void (*body)(void *context, uint64_t index);
    void *context;
    uint64_t count, next, done;
    bool stop;
};

/* Called, and returns, with the lock held. */
static void jobs_work(struct jobs *jobs) {
    while (jobs->next < jobs->count) {
        uint64_t index = jobs->next++;
        pthread_mutex_unlock(&jobs->lock);
        jobs->body(jobs->context, index);
        pthread_mutex_lock(&jobs->lock);
        if (++jobs->done == jobs->count) pthread_cond_signal(&jobs->finished);
    }
}

static void *jobs_thread(void *user) {
    struct jobs *jobs = user;
    pthread_mutex_lock(&jobs->lock);
    while (!jobs->stop) {
        jobs_work(jobs);
        if (!jobs->stop) pthread_cond_wait(&jobs->wake, &jobs->lock);
    }
    pthread_mutex_unlock(&jobs->lock);
    return NULL;
}

void jobs_parallel_for(void *user, uint64_t count, void (*body)(void *, uint64_t), void *context) {
    struct jobs *jobs = user;
    pthread_mutex_lock(&jobs->lock);
    jobs->body = body;
    jobs->context = context;
    jobs->count = count;
    jobs->next = jobs->done = 0;
    pthread_cond_broadcast(&jobs->wake);
    jobs_work(jobs);
    while (jobs->done < jobs->count) pthread_cond_wait(&jobs->finished, &jobs->lock);
    pthread_mutex_unlock(&jobs->lock);
}

struct jobs *jobs_start(int threads) {
    struct jobs *jobs = calloc(1, sizeof *jobs);
    if (!jobs || threads > MAX_THREADS) abort();
    pthread_mutex_init(&jobs->lock, NULL);
    pthread_cond_init(&jobs->wake, NULL);
    pthread_cond_init(&jobs->finished, NULL);
    /* Fewer threads than wished for do as well: the caller works too. */
    while (jobs->thread_count < threads &&
           pthread_create(&jobs->threads[jobs->thread_count], NULL, jobs_thread, jobs) == 0) {
        jobs->thread_count++;
    }
    return jobs;
}

void jobs_end(struct jobs *jobs) {
    pthread_mutex_lock(&jobs->lock);
    jobs->stop = true;
    pthread_cond_broadcast(&jobs->wake);
    pthread_mutex_unlock(&jobs->lock);
    for (int i = 0; i < jobs->thread_count; i++) pthread_join(jobs->threads[i], NULL);
    pthread_cond_destroy(&jobs->finished);
    pthread_cond_destroy(&jobs->wake);
    pthread_mutex_destroy(&jobs->lock);
    free(jobs);
}
