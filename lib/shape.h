/* SPDX-License-Identifier: MIT */
/* Shapes behind one door: made and counted here, asked through rgi_shape_intersect. */
#ifndef RAYGRID_LIB_SHAPE_H
#define RAYGRID_LIB_SHAPE_H

#include "intersect.h"
#include "memory.h"
#include "mesh.h"

struct rg_shape {
    rgi_memory memory;
    uint32_t references; /* atomic */
    rg_shape_kind kind;
    struct rg_shape *next;        /* of a list of those put aside */
    double lo[3], hi[3];          /* the local box; for a box the box itself */
    void (*released)(void *user); /* of a mesh that has borrowed: what it is to call when it has ended; else NULL */
    void *released_user;
    union {
        double radius; /* sphere */
        rgi_capsule capsule;
        rgi_mesh *mesh;
        rg_user_shape user;
    } of;
};

/**
 * Gives a reference back while a scene is held: the host's `destroy` is not to be called then. If it was the last one
 * the shape comes to a list, and rgi_shapes_destroy ends what is there.
 */
void rgi_shape_put_aside(rg_shape *shape, rg_shape **list);
void rgi_shapes_destroy(rg_shape *list);

/** As the functions of intersect.h, for any shape. ray->failed is set if a callback failed. */
bool rgi_shape_intersect(const rg_shape *shape, rgi_local_ray *ray, rgi_candidate *candidate);

/**
 * The world box of the shape at a position, with a linear part or NULL for the identity: holds the posed shape with
 * all rounding counted. *reach: a distance from the position beyond which it does not reach, or infinity: that of
 * the box's corners is as good. RG_INVALID_VALUE: beyond 4 * RG_COORDINATE_MAX, or an infinite shape with a linear
 * part.
 */
rg_result rgi_shape_bounds(const rg_shape *shape, const double position[3], const double *matrix, double lo[3],
                           double hi[3], double *reach);

/** The same for a sphere of that radius. Also RG_INVALID_VALUE: a radius out of its range. */
rg_result rgi_ball_bounds(double radius, const double position[3], double lo[3], double hi[3]);

#endif
