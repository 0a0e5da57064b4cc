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

/** Begins the way of a ray; false if it passes the mesh. The local ray must live as long. */
bool rgi_mesh_begin(rgi_mesh_ray *m, const rgi_mesh *mesh, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Returns true if nothing more is wanted. */
bool rgi_mesh_test(rgi_mesh_ray *m, const rgi_mesh_leaf *leaf, uint32_t triangles);

#endif
