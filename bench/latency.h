/* SPDX-License-Identifier: MIT */
/* latency.h: what latency.c and the frames while a grid is rebuilt share. */
#ifndef RAYGRID_BENCH_LATENCY_H
#define RAYGRID_BENCH_LATENCY_H

#include "bench.h"

/**
 * How a scene of the unit cube is taken along x so that its grid must be rebuilt. A loose one drifts as a whole by
 * more than four of its radii; the paper's kinds are rebuilt when the logical box is twice the physical one, of one
 * by one by one: there the scene spreads.
 */
enum { BENCH_DRIFT = 8, BENCH_SPREAD = 4 };

/** Takes a body there, and its home with it; the scene is told by others. */
void bench_drift(struct bench_scene *bodies, uint32_t body, rg_grid_kind kind);

/** Frames while the grid is quiet and while it is rebuilt, and the memory that the rebuild takes. */
void bench_rebuild_frames(struct bench_run *run, const char *scene, uint32_t count, rg_grid_kind kind,
                          uint32_t workers);

#endif
