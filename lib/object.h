/* SPDX-License-Identifier: MIT */
/* Objects: shapes in their places, and where a world ray meets one. */
#ifndef RAYGRID_LIB_OBJECT_H
#define RAYGRID_LIB_OBJECT_H

#include "intersect.h"
#include "lattice.h"
#include "pose.h"
#include "shape.h"
#include "slots.h"

#include <raygrid/scene.h>

/** A slot for an object: one cache line. While it is free, shape is NULL and generation that of its next use. */
typedef struct rgi_object {
    uint32_t linear; /* record of its linear part and scale, or RGI_NONE; while it is free, the list's */
    uint32_t generation;
    rg_shape *shape;
    double position[3];
    double reach; /* the object is within this distance of its position; may be infinite. Of a sphere without
                     a linear part exactly its radius. */
    uint32_t mask;
    uint32_t grid;      /* index of its grid */
    rgi_location place; /* there; in the paper's kinds `block` is the number of its member */
} rgi_object;

/**
 * A ray as traces use it: the direction scaled by 2^-exponent so that its largest component is in [1, 2), and t_min
 * and t_max by 2^exponent. Scaling by powers of two rounds nothing, and no product below over- or underflows.
 */
typedef struct rgi_ray {
    double origin[3];
    double direction[3];
    double t_min, t_max;
    double dd;       /* direction squared */
    double to_world; /* what a t found is multiplied by twice: 2^(-exponent / 2), in two steps of like size */
    double to_world2;
    uint32_t mask;
} rgi_ray;

/** Farther along the ray than any object reaches but infinite boxes (raygrid/shape.h, RG_COORDINATE_MAX): so
 * positions of hits stay far from overflow. */
#define RGI_FARTHEST 0x1p340

/**
 * Beyond this many radii the ray's origin is first moved along the ray to the point nearest to the object: then what
 * rounding makes of the test depends on the size of the object, not on its distance. Nearer by, an origin's own bits
 * are best.
 */
enum { RGI_NEAR = 64 };

/** Fills *ray; false if it is invalid (raygrid/trace.h says when). */
bool rgi_ray_init(rgi_ray *ray, const double origin[3], const double direction[3], double t_min, double t_max,
                  uint32_t mask);

/** A t of rgi_ray in units of the direction that the caller gave. */
static inline double rgi_world_t(const rgi_ray *ray, double t) {
    return t * ray->to_world * ray->to_world2;
}

/** Brings a ray into the local frame of an object: sets origin, direction and shift. False if it passes the object
 * by. */
bool rgi_object_local(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray, rgi_local_ray *local);

/**
 * Where the ray meets the object. The caller has filled t_min, t_max, sides, any, accept and context of `local`; the
 * rest is set here. `linear`: the object's linear part or NULL. The answer depends on the ray and the object alone.
 */
bool rgi_object_intersect(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray,
                          rgi_local_ray *local, rgi_candidate *candidate);

#endif
