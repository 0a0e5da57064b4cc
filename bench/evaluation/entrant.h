/* SPDX-License-Identifier: MIT */
/*
 * entrant.h: one who takes part: raygrid with some grid, or the peer.
 *
 * The library leaves out what tiles are for as long as nothing has left a grid's box; there is no switch. So the
 * uniform grid takes part three times: as it is, without tiles; with one tiny object just outside of the box, where
 * no ray comes, so that every ray goes from tile to tile, but nearly all is in one; and with a box of half the
 * scene's side and cells as wide as the others', so that the scene lies in eight tiles: the grid at factor 2, before
 * its rebuild.
 */
#ifndef RAYGRID_BENCH_EVALUATION_ENTRANT_H
#define RAYGRID_BENCH_EVALUATION_ENTRANT_H

#include "evaluation.h"

enum entrant_kind {
    ENTRANT_UNIFORM,
    ENTRANT_TILES,
    ENTRANT_EIGHT_TILES,
    ENTRANT_HIERARCHICAL,
    ENTRANT_LOOSE,
    ENTRANT_PEER,
    ENTRANT_KINDS
};

extern const char *const ENTRANT_NAMES[ENTRANT_KINDS];

struct entrant {
    enum entrant_kind kind;
    struct evaluation *evaluation;
    struct animation *animation;
    struct own *own;
    struct peer *peer;
    struct peer_way ways[2];         /* of primary and shadow rays */
    struct bench_answers answers[2]; /* to them */
    double seconds[2];               /* the least that they took, kept by the caller; +inf at first */
    double update, single;           /* seconds an object: where all move, the least; where only one does */
};

/** `resolution` 0: the grid chooses. Grids do not rebuild themselves. One thread. The animation is at time 0. */
struct entrant *entrant_create(struct evaluation *evaluation, enum entrant_kind kind, struct animation *animation,
                               uint32_t resolution, uint32_t rays);
void entrant_destroy(struct entrant *entrant);

/** Traces a picture's primary rays (which 0) or shadow rays (1) once: returns the seconds of processor time. */
double entrant_trace(struct entrant *entrant, const struct bench_rays *rays, int which);

/** Moves all bodies to where the animation has them, one call each; the peer commits once for all, and once for one.
 */
void entrant_move(struct entrant *entrant);

json_t *entrant_judge(struct entrant *entrant, struct exact_sample *sample, int which);

/** Cells that a ray looked into and objects that it was tested against, on average; NaN of the peer. */
void entrant_count(const struct entrant *entrant, const struct bench_rays *rays, double *cells, double *tests);

#endif
