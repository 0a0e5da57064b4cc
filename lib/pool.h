/* SPDX-License-Identifier: MIT */
/* The workers of a scene, or the host's job system in their place. */
#ifndef RAYGRID_LIB_POOL_H
#define RAYGRID_LIB_POOL_H

#include "memory.h"

typedef struct rgi_pool rgi_pool;

typedef void (*rgi_body)(void *context, uint64_t index);

/**
 * A pool of `workers` threads, the calling one among them: makes workers - 1. With `parallel_for` none.
 * RG_OUT_OF_MEMORY, RG_OUT_OF_THREADS: all threads made so far have ended again.
 */
rg_result rgi_pool_create(rgi_memory *memory, uint32_t workers, rg_parallel_for parallel_for, void *user,
                          rgi_pool **pool);

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
