/* SPDX-License-Identifier: MIT */
/* Where a ray meets triangles of a mesh, in double: the verdict, the same on every machine. */
#ifndef RAYGRID_LIB_TRIANGLE_H
#define RAYGRID_LIB_TRIANGLE_H

#include "mesh.h"
#include "vec.h"

/** A ray made ready for triangles, and its nearest hit so far. */
typedef struct rgi_triangle_ray {
    const rgi_local_ray *ray;
    int x, y, z; /* z: the direction's largest component; x, y, z is a rotation of the axes */
    double shear[2];
    bool found;
    rgi_candidate best; /* best.t: nothing beyond it is wanted */
} rgi_triangle_ray;

/* A ray that runs along the triangle's plane as closely as that, in parts of the lengths of direction and normal. */
#define RGI_GRAZING 0x1p-24

/** The corners of a triangle of a leaf, as they were given. */
static inline void rgi_triangle_corners(const rgi_mesh *mesh, const void *leaf, uint32_t triangle, double v[3][3]) {
    if (mesh->vertices) {
        for (uint32_t c = 0; c < 3; c++) rgi_copy(mesh->vertices[rgi_mesh_vertex(mesh, leaf, triangle, c)], v[c]);
    } else if (mesh->soup) {
        const rgi_soup_leaf *l = leaf;
        for (int c = 0; c < 3; c++)
            rgi_set(v[c], l->at[c][0][triangle], l->at[c][1][triangle], l->at[c][2][triangle]);
    } else {
        const rgi_mesh_leaf *l = leaf;
        for (int c = 0; c < 3; c++) {
            uint32_t lane = l->corner[c][triangle];
            rgi_set(v[c], l->at[0][lane], l->at[1][lane], l->at[2][lane]);
        }
    }
}

/** Sets x, y, z and shear. No branches: which axis is the longest can't be foreseen. */
static inline void rgi_triangle_axes(rgi_triangle_ray *t, const double d[3]) {
    int y_over_x = !(fabs(d[0]) > fabs(d[1])), z_over = fabs(d[2]) > rgi_max(fabs(d[0]), fabs(d[1]));
    t->z = z_over ? 2 : y_over_x;
    t->x = (0x021 >> 4 * t->z) & 3; /* after 0 comes 1, after 1 2, after 2 0 */
    t->y = (0x102 >> 4 * t->z) & 3;
    t->shear[0] = d[t->x] / d[t->z];
    t->shear[1] = d[t->y] / d[t->z];
}

void rgi_triangle_ray_init(rgi_triangle_ray *t, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Among equal t the lowest primitive wins. Returns true if nothing more is
 * wanted. */
bool rgi_triangles_test(rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangles);

/** Returns the side of a triangle that the ray meets, wherever that is, and fills all of *candidate; 0: none. */
uint32_t rgi_triangle_meets(const rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangle,
                            rgi_candidate *candidate);

#endif
