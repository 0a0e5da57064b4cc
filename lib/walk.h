/* SPDX-License-Identifier: MIT */
/* The walk of a ray through cells. */
#ifndef RAYGRID_LIB_WALK_H
#define RAYGRID_LIB_WALK_H

#include "cells.h"

/** Tests an object; returns true to end the walk. */
typedef bool (*rgi_visit)(void *context, uint32_t object);

typedef struct rgi_walk {
    double origin[3];
    double direction[3]; /* largest component in [1, 2) */
    double inverse[3];   /* of the direction, at most 2^60: for use inside a tile */
    double t_min;
    double t_max; /* what visit has found may make it smaller; the walk ends there */
    rgi_visit visit;
    void *context;
    uint32_t cells; /* counts cells looked into */
} rgi_walk;

/** Fills all but visit and context. */
void rgi_walk_init(rgi_walk *walk, const double origin[3], const double direction[3], double t_min, double t_max);

/**
 * Visits every object whose box the ray may meet between t_min and t_max, nearer cells first; lo and hi hold all
 * objects that are not unbounded. An object in several cells is visited several times. Returns true if visit did.
 */
bool rgi_cells_walk(const rgi_cells *cells, const double lo[3], const double hi[3], rgi_walk *walk);

#endif
