/* SPDX-License-Identifier: MIT */
/*
 * What shapes are asked: where a ray meets them, in their local frame. Shapes know nothing of objects, scenes or
 * grids.
 *
 * The local ray's origin may have been moved along the ray by `shift` to come near the shape. All t that leave a
 * shape, and t_min and t_max, count from the unmoved origin; a root found in the moved frame becomes t = shift +
 * root. So whether a hit is in range is decided on the same number for every shape, grid and order of traversal.
 */
#ifndef RAYGRID_LIB_INTERSECT_H
#define RAYGRID_LIB_INTERSECT_H

#include <raygrid/shape.h>

#include <stdbool.h>
#include <stdint.h>

/** Sides of a surface, as bits. */
enum { RGI_FRONT = 1, RGI_BACK = 2 };

/** A possible hit. */
typedef struct rgi_candidate {
    double t;
    double normal[3]; /* outward, any length, local */
    double u, v;
    uint32_t primitive;
} rgi_candidate;

/** Whether the filter lets a candidate count. */
typedef bool (*rgi_accept)(void *context, const rgi_candidate *candidate);

typedef struct rgi_local_ray {
    double origin[3];
    double direction[3];
    double shift;
    double t_min, t_max;
    uint32_t sides;    /* the sides that count */
    bool any;          /* any hit will do */
    bool failed;       /* out: a user-defined shape failed */
    rgi_accept accept; /* NULL: all count */
    void *context;
} rgi_local_ray;

/** Whether a hit at moved-frame root `root` on side `side` is in range; fills candidate->t. The filter comes after.
 */
static inline bool rgi_in_range(const rgi_local_ray *ray, double root, uint32_t side, rgi_candidate *candidate) {
    candidate->t = ray->shift + root;
    return candidate->t >= ray->t_min && candidate->t <= ray->t_max && (ray->sides & side) != 0;
}

static inline bool rgi_accepted(const rgi_local_ray *ray, const rgi_candidate *candidate) {
    return !ray->accept || ray->accept(ray->context, candidate);
}

/*
 * Each finds the hit with the smallest t in range (any hit, if ray->any), fills all of *candidate and returns true;
 * or returns false, with *candidate undefined.
 */
bool rgi_sphere_intersect(double radius, const rgi_local_ray *ray, rgi_candidate *candidate);
bool rgi_box_intersect(const double lo[3], const double hi[3], const rgi_local_ray *ray, rgi_candidate *candidate);

/** The roots at which a line enters and leaves a sphere around the local origin; false if it misses. */
bool rgi_sphere_roots(double radius, const double origin[3], const double direction[3], double roots[2]);

typedef struct rgi_capsule {
    double a[3], axis[3]; /* one end; unit vector to the other */
    double length, radius;
    double b[3]; /* the other end as it was given, for snapshots */
} rgi_capsule;

void rgi_capsule_init(rgi_capsule *capsule, const double a[3], const double b[3], double radius);
bool rgi_capsule_intersect(const rgi_capsule *capsule, const rgi_local_ray *ray, rgi_candidate *candidate);

#endif
