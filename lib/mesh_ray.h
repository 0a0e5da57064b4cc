/* SPDX-License-Identifier: MIT */
/* A ray on its way inside a mesh. */
#ifndef RAYGRID_LIB_MESH_RAY_H
#define RAYGRID_LIB_MESH_RAY_H

#include "beam.h"
#include "triangle.h"

/** What the float test of triangles knows of a ray: see kernels_mesh.h. */
typedef struct rgi_triangle_filter {
    uint32_t x, y, z; /* the axes, as in rgi_triangle_ray */
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

/** Rays of a packet that go through a mesh together: in the local frame, and in that of the mesh. */
typedef struct rgi_mesh_packet {
    const rgi_mesh *mesh;
    rgi_packet rays; /* in the frame of the mesh; active: those that take part, and are still on their way */
    rgi_triangle_filter filters[RGI_PACKET];
    double origin[3][RGI_PACKET] __attribute__((aligned(64))), direction[3][RGI_PACKET], shift[RGI_PACKET];
    double shear[2][RGI_PACKET];
    double t_min[RGI_PACKET], t_max[RGI_PACKET]; /* as in rgi_local_ray; t_max falls to where the nearest hit is */
    uint32_t along[3];                           /* bits of the rays whose longest component is along an axis */
    uint32_t sides;                              /* that count */
    uint32_t found;                              /* bits of the rays that hit something */
    const void *leaf[RGI_PACKET];                /* what they hit */
    uint32_t triangle[RGI_PACKET];
} rgi_mesh_packet;

/** The float test's part of a ray in the frame of a mesh; inverse: 1 / the direction's component along z. */
static inline void rgi_triangle_filter_init(rgi_triangle_filter *f, const rgi_triangle_ray *t, const float origin[3],
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
static inline float rgi_place_error(const rgi_mesh *mesh, const float origin[3]) {
    float most = (float)mesh->middle.extent + fabsf(origin[0]) + fabsf(origin[1]) + fabsf(origin[2]);
    return 0x1p-20f * most + mesh->rounding;
}

/** A triangle that a ray of a packet may meet: all of *candidate; whether it does, on a side that counts, and where.
 */
void rgi_mesh_packet_describe(const rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangle,
                              rgi_candidate *candidate);
bool rgi_mesh_packet_test(const rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangle, double *t);

/** Begins the way of a ray; false if it passes the mesh. The local ray must live as long. */
bool rgi_mesh_begin(rgi_mesh_ray *m, const rgi_mesh *mesh, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Returns true if nothing more is wanted. */
bool rgi_mesh_test(rgi_mesh_ray *m, const void *leaf, uint32_t triangles);

/* Builds without meshes never come here. */
#if defined(RGI_NO_MESH)
#define rgi_mesh_begin(m, mesh, ray) ((void)(m), (void)(mesh), (void)(ray), false)
#define rgi_mesh_packet_describe(m, ray, leaf, triangle, candidate)                                                  \
    ((void)(m), (void)memset(candidate, 0, sizeof *(candidate)))
#define rgi_triangle_ray_init(t, ray) ((void)(t), (void)(ray))
#define rgi_triangle_meets(t, mesh, leaf, triangle, candidate)                                                       \
    ((void)(t), (void)(leaf), (void)(triangle), (void)memset(candidate, 0, sizeof *(candidate)))
#endif

#endif
