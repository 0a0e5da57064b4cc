/* SPDX-License-Identifier: MIT */
/* sides.h: who answers: raygrid with each kind of grid, and the peer in the ways that hosts use it. */
#ifndef RAYGRID_BENCH_PRECISION_SIDES_H
#define RAYGRID_BENCH_PRECISION_SIDES_H

#include "own.h"
#include "peer.h"
#include "worlds.h"

enum { SIDES = 6 };

/** One who answers. */
struct side {
    const char *name;
    struct own *own;
    struct peer *peer;
    struct bench_scene *bodies; /* the peer's copy of them, where its host has moved the origin; else NULL */
    struct bench_rays *floats;  /* the rays as the peer gets them */
    struct bench_answers answers;
    double *t; /* raygrid's, of the timed run */
    struct peer_way way;
    double seconds; /* the least that the rays took */
};

/**
 * All sides for a world's rays; returns how many. Raygrid's own are the first three, and their ids are the same.
 * With a peer, if `api` is not NULL: robust and fast, with coordinates rounded to float as they are; and where the
 * world is away from the origin, robust once more, its host having subtracted the world's offset in double before.
 */
int sides_create(struct side sides[SIDES], const struct world *world, const rg_ray *rays, uint32_t count,
                 const struct embree_api *api);
void sides_destroy(struct side *sides, int count);

/** Traces all rays once and keeps the time if it is the least so far. Raygrid writes t and object, as the bench. */
void side_time(struct side *side, const rg_ray *rays, uint32_t count);

/** What a side answers to each ray. Of the peer: t, object (by raygrid's id), normal. */
void side_answer(struct side *side, const struct side *own, const rg_ray *rays, rg_hit *hits, uint32_t count);

#endif
