/* SPDX-License-Identifier: MIT */
/* A ray on its way inside a mesh. */
#ifndef RAYGRID_LIB_MESH_RAY_H
#define RAYGRID_LIB_MESH_RAY_H

#include "beam.h"
#include "triangle.h"

/** What the float test of triangles knows of a ray: see kernels_mesh.h. */
typedef struct rgi_triangle_filter {
    uint32_t x, y, z; /* the axes, as in rgi_triangle_line */
    float origin_x, origin_y, origin_z;
    float shear_x, shear_y;
    float error; /* of a corner's place across the ray */
} rgi_triangle_filter;

typedef struct rgi_mesh_ray {
    const rgi_mesh *mesh;
    rgi_triangle_ray triangles;
    rgi_triangle_filter filter;
    rgi_beam beam;
} rgi_mesh_ray;

/** Rays inside meshes, one a lane: in the local frame, and in that of the mesh. */
typedef struct rgi_mesh_packet {
    const rgi_mesh *mesh[RGI_PACKET]; /* of rays that go together all the same */
    rgi_packet rays; /* in the frame of the mesh; active: those that take part, and are still on their way */
    rgi_triangle_filter filters[RGI_PACKET];
    double origin[3][RGI_PACKET] __attribute__((aligned(64))), direction[3][RGI_PACKET], shift[RGI_PACKET];
    double shear[2][RGI_PACKET];
    double t_min[RGI_PACKET], t_max[RGI_PACKET]; /* as in rgi_local_ray; t_max falls to where the nearest hit is */
    uint32_t sides;                              /* that count */
    rgi_accept accept;                           /* NULL: all count */
    void *contexts[RGI_PACKET];
    uint32_t found;               /* bits of the rays that hit something */
    uint32_t changed;             /* of those whose hit is new */
    const void *leaf[RGI_PACKET]; /* what they hit */
    uint32_t triangle[RGI_PACKET];
} rgi_mesh_packet;

/** Objects that are meshes, one a lane: what a ray that comes to one needs of it. */
typedef struct rgi_mesh_doors {
    double position[3][RGI_PACKET] __attribute__((aligned(64))), reach[RGI_PACKET];
    double turned[RGI_PACKET], inverse[9][RGI_PACKET]; /* 1: it has a linear part; of which the inverse */
    bool any_turned;
    double origin[3][RGI_PACKET], scale[RGI_PACKET], rounding[RGI_PACKET]; /* of the mesh: see rgi_mesh, rgi_middle */
    double centre[3][RGI_PACKET], radius[RGI_PACKET], extent[RGI_PACKET];
} rgi_mesh_doors;

/** Nodes and leaves that a ray has still to look into, at the most; what comes after the last may be written, too. */
enum { RGI_MESH_ROOM = 112, RGI_MESH_LEVELS = (RGI_MESH_ROOM - RGI_CHILDREN - 1) / (RGI_CHILDREN - 1) };

/** Rays that may be on their way side by side: enough that one is always ready while others wait for memory. */
enum { RGI_SIDE_BY_SIDE = 2 * RGI_PACKET };

/** As many of them as are computed at once. */
typedef struct rgi_mesh_row {
    rgi_bundle rays; /* as in rgi_ray; t_max: the nearest hit so far */
    rgi_mesh_doors doors;
    rgi_mesh_packet inside;
    uint32_t negative[RGI_PACKET], towards[3][RGI_PACKET]; /* as in rgi_beam */
} rgi_mesh_row;

/** Rays side by side, each in a mesh or at the door of one. Lanes are taken from the first on, all are gone through,
 * and all are left. */
typedef struct rgi_mesh_lanes {
    uint32_t count;
    rgi_beam *beams[RGI_SIDE_BY_SIDE];
    rgi_mesh_row rows[RGI_SIDE_BY_SIDE / RGI_PACKET];
    uint32_t depth[RGI_SIDE_BY_SIDE];
    rgi_mesh_ref refs[RGI_SIDE_BY_SIDE][RGI_MESH_ROOM] __attribute__((aligned(64)));
    float ts[RGI_SIDE_BY_SIDE][RGI_MESH_ROOM];
} rgi_mesh_lanes;

/** Notes an object at a lane; `any_turned` is false before the first. */
static inline void rgi_mesh_door(rgi_mesh_doors *d, uint32_t lane, const rgi_object *object,
                                 const rgi_linear *linear) {
    const rgi_mesh *mesh = object->shape->of.mesh;
    for (int a = 0; a < 3; a++) {
        d->position[a][lane] = object->position[a];
        d->origin[a][lane] = mesh->origin[a];
        d->centre[a][lane] = mesh->middle.centre[a];
    }
    d->reach[lane] = object->reach;
    d->scale[lane] = mesh->scale;
    d->rounding[lane] = (double)mesh->rounding;
    d->radius[lane] = mesh->middle.radius;
    d->extent[lane] = mesh->middle.extent;
    d->turned[lane] = linear != NULL;
    if (!linear) return;
    d->any_turned = true;
    for (int k = 0; k < 9; k++) d->inverse[k][lane] = linear->inverse[k];
}

/** The float test's part of a ray in the frame of a mesh; inverse: 1 / the direction's component along z. */
static inline void rgi_triangle_filter_init(rgi_triangle_filter *f, const rgi_triangle_line *t, const float origin[3],
                                            const float direction[3], float inverse, float error) {
    f->x = (uint32_t)t->x;
    f->y = (uint32_t)t->y;
    f->z = (uint32_t)t->z;
    f->origin_x = origin[t->x];
    f->origin_y = origin[t->y];
    f->origin_z = origin[t->z];
    f->shear_x = direction[t->x] * inverse;
    f->shear_y = direction[t->y] * inverse;
    f->error = error;
}

/** What a corner's place across the ray may be wrong by, in the frame: mesh_ray.c says why. */
static inline float rgi_place_error(double extent, double rounding, const float origin[3]) {
    float most = (float)extent + fabsf(origin[0]) + fabsf(origin[1]) + fabsf(origin[2]);
    return 0x1p-20f * most + (float)rounding;
}

/** One of them as the test of triangles needs it. */
static inline void rgi_mesh_packet_line(const rgi_mesh_packet *m, uint32_t ray, rgi_triangle_line *l) {
    const rgi_triangle_filter *f = &m->filters[ray];
    for (int a = 0; a < 3; a++) {
        l->origin[a] = m->origin[a][ray];
        l->direction[a] = m->direction[a][ray];
    }
    l->shear[0] = m->shear[0][ray];
    l->shear[1] = m->shear[1][ray];
    l->x = (int)f->x;
    l->y = (int)f->y;
    l->z = (int)f->z;
}

/** Asks the filter, which there is, about a triangle that a ray meets. */
bool rgi_mesh_packet_accepts(const rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangle);

/** Begins the way of a ray; false if it passes the mesh. The local ray must live as long. */
bool rgi_mesh_begin(rgi_mesh_ray *m, const rgi_mesh *mesh, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Returns true if nothing more is wanted. */
bool rgi_mesh_test(rgi_mesh_ray *m, const void *leaf, uint32_t triangles);

/* Builds without meshes never come here. */
#if defined(RGI_NO_MESH)
#define rgi_mesh_begin(m, mesh, ray) ((void)(m), (void)(mesh), (void)(ray), false)
#define rgi_triangle_ray_init(t, ray) ((void)(t), (void)(ray))
#define rgi_triangle_meets(t, mesh, leaf, triangle, candidate)                                                       \
    ((void)(t), (void)(leaf), (void)(triangle), (void)memset(candidate, 0, sizeof *(candidate)))
#endif

#endif
