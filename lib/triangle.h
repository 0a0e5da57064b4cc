/* SPDX-License-Identifier: MIT */
/* Where a ray meets triangles of a mesh, in double: the verdict, the same on every machine. */
#ifndef RAYGRID_LIB_TRIANGLE_H
#define RAYGRID_LIB_TRIANGLE_H

#include "mesh.h"

/** A ray made ready for triangles, and its nearest hit so far. */
typedef struct rgi_triangle_ray {
    const rgi_local_ray *ray;
    int x, y, z; /* z: the direction's largest component; x, y, z is a rotation of the axes */
    double shear[2];
    bool found;
    rgi_candidate best; /* best.t: nothing beyond it is wanted */
} rgi_triangle_ray;

void rgi_triangle_ray_init(rgi_triangle_ray *t, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Among equal t the lowest primitive wins. Returns true if nothing more is
 * wanted. */
bool rgi_triangles_test(rgi_triangle_ray *t, const rgi_mesh *mesh, const rgi_mesh_leaf *leaf, uint32_t triangles);

#endif
