/* SPDX-License-Identifier: MIT */
/*
 * worlds.h: the scenes of the precision report and of the long run, and the rays that are aimed where it is hard.
 *
 * Numbers of a world at the origin are floats, kept as double, so that a peer which knows no double has the same one.
 * A world that is moved is rounded to what doubles there are; that rounded world is the one all answers are held to.
 */
#ifndef RAYGRID_BENCH_PRECISION_WORLDS_H
#define RAYGRID_BENCH_PRECISION_WORLDS_H

#include "scenes.h"

/** Where a world's rays go. */
enum world_aim {
    WORLD_ANYWHERE, /* from anywhere among the objects in any direction */
    WORLD_AT_RIMS, /* past silhouettes, edges and corners by 10^-1 to 10^-15 of the object's radius, on either side */
    WORLD_AT_BOTH  /* half of the rays at rims, the others anywhere on an object */
};

struct world {
    const char *name; /* one of WORLDS */
    struct bench_scene *bodies;
    enum world_aim aim;
    uint32_t aim_first;       /* rays are aimed at bodies from here on */
    double nearest, farthest; /* where aimed rays start: 10 to the power of these, in radii of the body */
    double offset[3];         /* from the origin to the corner of the cube that they fill */
    double side;              /* of that cube */
    bool floats;              /* aimed rays are rounded to float, so less finely aimed */
};

/** The names, NULL at the end: ordinary, huge, tiny beside huge, slivers, grazing. */
extern const char *const WORLDS[];

/** One of WORLDS of about `count` objects, its middle moved away from the origin by about `offset` on each axis. */
struct world *world_create(const char *name, uint32_t count, double offset, uint64_t seed);
void world_destroy(struct world *world);

/** The next ray of a row. Those that go anywhere are floats but for the world's offset. */
rg_ray world_ray(const struct world *world, uint64_t *random);

#endif
