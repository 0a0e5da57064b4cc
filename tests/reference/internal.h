/* SPDX-License-Identifier: MIT */
/* internal.h: what the files of the reference know of each other. */
#ifndef RAYGRID_REFERENCE_INTERNAL_H
#define RAYGRID_REFERENCE_INTERNAL_H

#include "reference.h"

#include <float.h>
#include <math.h>

typedef reference_real real;

#ifdef REFERENCE_QUAD
#include <quadmath.h>
#define REAL_DIGITS FLT128_MANT_DIG
#define fabsl fabsq
#define fminl fminq
#define fmaxl fmaxq
#define sqrtl sqrtq
#define sinl sinq
#define cosl cosq
#else
#define REAL_DIGITS LDBL_MANT_DIG
#endif

/** A ray in a shape's frame: the points base + s * direction, which the world ray has at t = t_base + s. */
typedef struct line {
    real base[3], direction[3], t_base;
} line;

/** A place where a line goes through a surface. `normal` is local, outward, of any length. */
typedef struct crossing {
    real t;
    uint32_t primitive;
    real normal[3];
    real u, v;
} crossing;

typedef void crossing_visitor(void *context, const crossing *at);

struct reference_shape {
    reference_shape *next; /* the scene's list */
    rg_shape_kind kind;
    real lo[3], hi[3];      /* the local box that holds it; infinite for infinite boxes */
    real centre[3], radius; /* a local sphere that holds it; radius +inf for infinite boxes */
    real curvature;         /* the largest of its surface, 1 / length; 0 if it is flat */
    real a[3], b[3], r;     /* capsule; of a sphere only r */
    double *vertices;       /* mesh, 3 a vertex */
    uint32_t *indices;      /* mesh, 3 a triangle */
    size_t triangle_count;
};

typedef struct object {
    rg_object id;
    const reference_shape *shape;
    rg_pose pose;
    uint32_t mask;
    bool plain;              /* the linear part is the identity */
    real matrix[9];          /* scale times linear part */
    real inverse[9];         /* of it */
    real stretch, condition; /* of it: its 2-norm, and that times the 2-norm of the inverse */
    real centre[3], radius;  /* a sphere around position + centre that holds the object */
    real world_radius;       /* of the object around its position: the R of trace.h */
    reference_bound bound;   /* that it is judged by */
} object;

struct reference_scene {
    reference_shape *shapes;
    object *objects;
    size_t count, capacity;
    uint32_t *index_of_slot; /* slot -> index in objects; slots that hold none have UINT32_MAX */
    size_t slots;
    reference_bound bound; /* of objects inserted from now on */
};

/* vectors */
static inline real dot(const real a[3], const real b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline real length(const real a[3]) {
    return sqrtl(dot(a, a));
}
static inline void cross(const real a[3], const real b[3], real out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

void *reference_allocate(size_t count, size_t size);

/* transform.c */
void prepare_object(object *o);
/** The object's line for a ray whose origin is moved aside by `aside` (world; NULL: not at all). */
line line_to_object(const object *o, const rg_ray *ray, const real aside[3]);
/** The length in the world of a local difference. */
real length_in_world(const object *o, const real local[3]);
/** The unit world normal of a local one; returns the length that the covector has in the world before that. */
real normal_to_world(const object *o, const real local[3], real world[3]);
/** Whether not even a ray moved aside by `margin` (world) could meet the object; decided with a lot to spare. */
bool passes_by(const object *o, const rg_ray *ray, real margin);

/* shapes.c, mesh.c: report every place where the whole line crosses the surface */
void cross_shape(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context);
void cross_mesh(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context);

/** A point of a surface, local. */
typedef struct place {
    real point[3], normal[3]; /* the normal of any length, outward */
    real u, v;
    real thickness; /* of a triangle: its least height; of others +inf */
} place;

/* nearest.c */
/** The point of a primitive that is nearest to p; false if there is no such primitive. */
bool nearest_place(const reference_shape *shape, uint32_t primitive, const real p[3], place *near);
/** Calls visit for each edge of a box or mesh, or for the segment within a round shape and less its radius, with the
 *  line's distance from it and the t where it comes so near. */
typedef void edge_visitor(void *context, real t, real distance);
void edges_of(const reference_shape *shape, const line *at, edge_visitor *visit, void *context);

/* reference.c */
const object *find_object(const reference_scene *scene, rg_object id);
/** The ray with its range cut to where it may hit anything: see t_max of rg_ray in raygrid/trace.h. */
rg_ray within_reach(const rg_ray *ray);
/** -1 if the line enters through the surface's front there, 1 if through its back, 0 if it grazes it. */
int side_of(const line *at, const crossing *where);
static inline bool culled(rg_cull cull, int side) {
    return (cull == RG_CULL_BACK && side >= 0) || (cull == RG_CULL_FRONT && side <= 0);
}

#endif
