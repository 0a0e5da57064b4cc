/* SPDX-License-Identifier: MIT */
/* Where a ray meets triangles of a mesh, in double: the verdict, the same on every machine. */
#ifndef RAYGRID_LIB_TRIANGLE_H
#define RAYGRID_LIB_TRIANGLE_H

#include "mesh.h"
#include "vec.h"

/** A ray as the test of triangles needs it. */
typedef struct rgi_triangle_line {
    double origin[3], direction[3], shear[2];
    int x, y, z; /* z: the direction's largest component; x, y, z is a rotation of the axes */
} rgi_triangle_line;

/** A ray made ready for triangles, and its nearest hit so far. */
typedef struct rgi_triangle_ray {
    const rgi_local_ray *ray;
    rgi_triangle_line line;
    bool found;
    rgi_candidate best; /* best.t: nothing beyond it is wanted */
} rgi_triangle_ray;

/** Where a line meets a triangle. */
typedef struct rgi_triangle_meeting {
    double root; /* unchecked */
    double normal[3];
    double edge1, edge2, sum; /* barycentrics: edge1 / sum, edge2 / sum */
    uint32_t side;
} rgi_triangle_meeting;

/* A ray that runs along the triangle's plane as closely as that, in parts of the lengths of direction and normal. */
#define RGI_GRAZING 0x1p-24

/** The corners of a triangle of a leaf, as they were given. */
static inline void rgi_triangle_corners(const rgi_mesh *mesh, const void *leaf, uint32_t triangle, double v[3][3]) {
    if (!mesh->exact) {
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t vertex = rgi_mesh_vertex(mesh, leaf, triangle, c);
            if (mesh->kept_vertices) /* no type and no stride to ask for: some 4 % of coherent rays in soups */
                rgi_copy(mesh->kept_vertices[vertex], v[c]);
            else
                rgi_load3(&mesh->vertices, vertex, v[c]);
        }
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

/** Sets all but the origin. No branches: which axis is the longest can't be foreseen. */
static inline void rgi_triangle_axes(rgi_triangle_line *l, const double d[3]) {
    int y_over_x = !(fabs(d[0]) > fabs(d[1])), z_over = fabs(d[2]) > rgi_max(fabs(d[0]), fabs(d[1]));
    rgi_copy(d, l->direction);
    l->z = z_over ? 2 : y_over_x;
    l->x = (0x021 >> 4 * l->z) & 3; /* after 0 comes 1, after 1 2, after 2 0 */
    l->y = (0x102 >> 4 * l->z) & 3;
    l->shear[0] = d[l->x] / d[l->z];
    l->shear[1] = d[l->y] / d[l->z];
}

/** Keeps a root where the ray is in the box of the corners r: for rays almost in the plane. So a hit never lies
 * beside the boxes around its triangle, by which it is found. */
double rgi_triangle_in_box(const double direction[3], double r[3][3], double root);

/* Which side of edge a to b the ray passes. Exactly the negative for edge b to a, so neighbours never both miss. */
static inline double rgi_triangle_edge(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/*
 * Where the ray meets the triangle's plane; along = normal * direction. The plane form stays exact for long thin
 * triangles, but not for a ray almost in the plane: the result is kept between the corners' depths, where it must be.
 */
static inline double rgi_triangle_root(const rgi_triangle_line *l, const double normal[3], double along,
                                       double r[3][3]) {
    double dz = l->direction[l->z], r0 = r[0][l->z], r1 = r[1][l->z], r2 = r[2][l->z];
    /* Quotients by one divisor are in order: the least of three is that of the least, or of the most. */
    double least = rgi_min(rgi_min(r0, r1), r2), most = rgi_max(rgi_max(r0, r1), r2);
    double low = (dz > 0 ? least : most) / dz, high = (dz > 0 ? most : least) / dz;
    double root = along != 0 ? rgi_dot(normal, r[0]) / along : low;
    root = rgi_min(rgi_max(root, low), high);
    double lengths = (fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2])) * fabs(dz);
    return fabs(along) < RGI_GRAZING * lengths ? rgi_triangle_in_box(l->direction, r, root) : root;
}

/**
 * S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013), section 3, in double. Zero counts
 * as inside for both neighbours. Returns false for a miss.
 */
static inline bool rgi_triangle_meet(const rgi_triangle_line *l, double v[3][3], rgi_triangle_meeting *met) {
    double r[3][3], p[3][2];
    for (int c = 0; c < 3; c++) {
        rgi_sub(v[c], l->origin, r[c]);
        p[c][0] = r[c][l->x] - l->shear[0] * r[c][l->z];
        p[c][1] = r[c][l->y] - l->shear[1] * r[c][l->z];
    }
    double e0 = rgi_triangle_edge(p[1], p[2]), e1 = rgi_triangle_edge(p[2], p[0]), e2 = rgi_triangle_edge(p[0], p[1]);
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return false;
    met->edge1 = e1;
    met->edge2 = e2;
    met->sum = e0 + e1 + e2;
    if (met->sum == 0) return false;

    double ab[3], ac[3];
    rgi_sub(v[1], v[0], ab);
    rgi_sub(v[2], v[0], ac);
    rgi_cross(ab, ac, met->normal);
    double along = rgi_dot(met->normal, l->direction);
    met->root = rgi_triangle_root(l, met->normal, along, r);
    met->side = along < 0 ? RGI_FRONT : RGI_BACK;
    return true;
}

void rgi_triangle_ray_init(rgi_triangle_ray *t, const rgi_local_ray *ray);

/** Tests triangles of a leaf, named by bits. Among equal t the lowest primitive wins. Returns true if nothing more is
 * wanted. */
bool rgi_triangles_test(rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangles);

/** Returns the side of a triangle that the ray meets, wherever that is, and fills all of *candidate; 0: none. */
uint32_t rgi_triangle_meets(const rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangle,
                            rgi_candidate *candidate);

#endif
