/* SPDX-License-Identifier: MIT */
/* host_jobs.h: stands for the job system that a game has anyway. It knows nothing of raygrid. */
#ifndef HOST_JOBS_H
#define HOST_JOBS_H

#include <stdint.h>

/* A loop over [0, count) that the caller and the threads work off together. One loop at a time. */
struct jobs;

struct jobs *jobs_start(int threads);
void jobs_end(struct jobs *jobs);

/* Fits rg_parallel_for, with a struct jobs as `user`. */
void jobs_parallel_for(void *user, uint64_t count, void (*body)(void *context, uint64_t index), void *context);

#endif
