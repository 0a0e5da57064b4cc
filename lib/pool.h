/* SPDX-License-Identifier: MIT */
/* The workers of a scene, or the host's job system in their place. */
#ifndef RAYGRID_LIB_POOL_H
#define RAYGRID_LIB_POOL_H

#include "memory.h"

#include <stdbool.h>

typedef struct rgi_pool rgi_pool;

typedef void (*rgi_body)(void *context, uint64_t index);

/**
 * A pool of `workers` threads, the calling one among them: makes workers - 1. With `parallel_for` none.
 * RG_OUT_OF_MEMORY, RG_OUT_OF_THREADS: all threads made so far have ended again.
 */
rg_result rgi_pool_create(rgi_memory *memory, uint32_t workers, rg_parallel_for parallel_for, void *user,
                          rgi_pool **pool);

/** What a worker does when there is nothing to run, once it was woken for it: a part of something long. Returns
 * whether there is more. */
typedef bool (*rgi_spare_work)(void *context);

/** Sets it, before the pool is used. */
void rgi_pool_set_spare_work(rgi_pool *pool, rgi_spare_work work, void *context);

/** Tells the workers that there is some. It is worked on by one at a time, as soon as one is free; also between two
 * runs. Does nothing without threads. */
void rgi_pool_wake(rgi_pool *pool);

/** Whether the pool has threads of its own. Not in the child of a fork: they are the parent's. */
bool rgi_pool_has_threads(const rgi_pool *pool);

/** Ends and joins the threads. */
void rgi_pool_destroy(rgi_pool *pool);

/** Threads that work together, the calling one among them; 0: the host's, as many as it likes. */
uint32_t rgi_pool_workers(const rgi_pool *pool);

/**
 * Calls body(context, i) once for each i below count and returns when all have returned. The calling thread takes
 * part and never waits for a worker to become free, so several threads may run at once.
 */
void rgi_pool_run(rgi_pool *pool, uint64_t count, rgi_body body, void *context);

#endif
