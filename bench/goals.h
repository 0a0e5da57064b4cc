/* SPDX-License-Identifier: MIT */
/* goals.h: what raygrid is to reach on each line that has a goal. Ratios are to Embree 4.4 in the same run. */
#ifndef RAYGRID_BENCH_GOALS_H
#define RAYGRID_BENCH_GOALS_H

#include <stdint.h>

struct bench_goal {
    double value; /* NaN: none */
    int on_ratio; /* the ratio is to be at least the value; else the figure is to be at most that */
};

/** What is to be reached. */
enum bench_aim {
    GOAL_COHERENT, /* whole batches of coherent rays, closest and any hit */
    GOAL_COHERENT_STADIUM,
    GOAL_INCOHERENT,  /* whole batches */
    GOAL_SINGLE,      /* one incoherent ray a call */
    GOAL_MOVE_SMALL,  /* ns: a tenth of the radius */
    GOAL_MOVE_RADIUS, /* ns */
    GOAL_INSERT,      /* ns */
    GOAL_REMOVE,      /* ns */
    GOAL_FRAME,
    GOAL_LASTING, /* of the speed of a fresh scene */
    GOAL_BYTES,   /* a sphere */
    GOAL_TWO_THREADS,
    GOAL_CHANGE_USUAL,   /* us: all but one of 10,000 single changes */
    GOAL_CHANGE_LONGEST, /* us */
    GOAL_REBUILD_FRAME,  /* of a frame's speed, while a grid is rebuilt */
    GOAL_REBUILD_MEMORY, /* times what the scene held before */
    /* Of one mesh, by its triangles; _ROBUST: against a peer in its robust mode. */
    GOAL_MESH_INCOHERENT,
    GOAL_MESH_INCOHERENT_ROBUST,
    GOAL_MESH_PRIMARY,
    GOAL_MESH_PRIMARY_ROBUST,
    GOAL_MESH_SHADOW,
    GOAL_MESH_SHADOW_ROBUST,
    GOAL_MESH_SINGLE,
    GOAL_MESH_SINGLE_ROBUST,
    GOAL_MESH_BEST,
    GOAL_MESH_FAST,
    GOAL_MESH_REFIT,
    GOAL_MESH_BYTES,
    GOAL_MESH_BYTES_SOUP,
    /* Of instances of one, by their number. */
    GOAL_INSTANCES_COHERENT,
    GOAL_INSTANCES_INCOHERENT,
    GOAL_INSTANCES_MOVED,
    GOALS
};

/** The goal for a scene of `count` objects: that of the nearest power of ten; there are none below 10^3. */
struct bench_goal bench_goal(enum bench_aim aim, uint32_t count);

struct bench_goal bench_no_goal(void);

#endif
