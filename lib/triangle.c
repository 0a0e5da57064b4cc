/* SPDX-License-Identifier: MIT */
#include "triangle.h"

#include "vec.h"

void rgi_triangle_ray_init(rgi_triangle_ray *t, const rgi_local_ray *ray) {
    t->ray = ray;
    rgi_triangle_axes(t, ray->direction);
    t->found = false;
    t->best.t = ray->t_max;
}

/* A corner in the frame in which the ray is the z axis. */
static void to_ray(const rgi_triangle_ray *t, const double vertex[3], double relative[3], double out[2]) {
    rgi_sub(vertex, t->ray->origin, relative);
    out[0] = relative[t->x] - t->shear[0] * relative[t->z];
    out[1] = relative[t->y] - t->shear[1] * relative[t->z];
}

/* Which side of edge a to b the ray passes. Exactly the negative for edge b to a, so neighbours never both miss. */
static double edge(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/* Keeps a root where the ray is in the box of the corners r: for rays almost in the plane. So a hit never lies beside
 * the boxes around its triangle, by which it is found. */
static double in_box(const double direction[3], double r[3][3], double root) {
    for (int a = 0; a < 3; a++) {
        double d = direction[a], low = rgi_min(rgi_min(r[0][a], r[1][a]), r[2][a]);
        double high = rgi_max(rgi_max(r[0][a], r[1][a]), r[2][a]);
        if (d == 0) continue;
        root = rgi_min(rgi_max(root, (d > 0 ? low : high) / d), (d > 0 ? high : low) / d);
    }
    return root;
}

/*
 * Where the ray meets the triangle's plane; along = normal * direction. The plane form stays exact for long thin
 * triangles, but not for a ray almost in the plane: the result is kept between the corners' depths, where it must be.
 */
static double plane_root(const rgi_triangle_ray *t, const double normal[3], double along, double r[3][3]) {
    const double *d = t->ray->direction;
    double dz = d[t->z];
    double z0 = r[0][t->z] / dz, z1 = r[1][t->z] / dz, z2 = r[2][t->z] / dz;
    double low = rgi_min(rgi_min(z0, z1), z2), high = rgi_max(rgi_max(z0, z1), z2);
    double root = along != 0 ? rgi_dot(normal, r[0]) / along : low;
    root = rgi_min(rgi_max(root, low), high);
    double lengths = (fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2])) * fabs(dz);
    return fabs(along) < RGI_GRAZING * lengths ? in_box(d, r, root) : root;
}

/*
 * S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013), section 3, in double. Zero counts
 * as inside for both neighbours. Returns false for a miss; true with the root unchecked.
 */
static bool meets(const rgi_triangle_ray *t, double v[3][3], double *root, uint32_t *side, rgi_candidate *candidate) {
    double r[3][3], p[3][2];
    for (int c = 0; c < 3; c++) to_ray(t, v[c], r[c], p[c]);
    double e0 = edge(p[1], p[2]), e1 = edge(p[2], p[0]), e2 = edge(p[0], p[1]);
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return false;
    double sum = e0 + e1 + e2;
    if (sum == 0) return false;

    double ab[3], ac[3], *n = candidate->normal;
    rgi_sub(v[1], v[0], ab);
    rgi_sub(v[2], v[0], ac);
    rgi_cross(ab, ac, n);
    double along = rgi_dot(n, t->ray->direction);
    *root = plane_root(t, n, along, r);
    *side = along < 0 ? RGI_FRONT : RGI_BACK;
    candidate->u = e1 / sum;
    candidate->v = e2 / sum;
    return true;
}

uint32_t rgi_triangle_meets(const rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangle,
                            rgi_candidate *candidate) {
    double v[3][3], root;
    uint32_t side;
    rgi_triangle_corners(mesh, leaf, triangle, v);
    if (!meets(t, v, &root, &side, candidate)) return 0;
    candidate->t = t->ray->shift + root;
    candidate->primitive = rgi_mesh_primitive(mesh, leaf, triangle);
    return side;
}

bool rgi_triangles_test(rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangles) {
    for (; triangles; triangles &= triangles - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(triangles), side;
        rgi_candidate c;
        double root, v[3][3];
        rgi_triangle_corners(mesh, leaf, i, v);
        if (!meets(t, v, &root, &side, &c)) continue;
        if (!rgi_in_range(t->ray, root, side, &c)) continue;
        c.primitive = rgi_mesh_primitive(mesh, leaf, i);
        if (c.t > t->best.t || (t->found && c.t == t->best.t && c.primitive > t->best.primitive)) continue;
        if (!rgi_accepted(t->ray, &c)) continue;
        t->best = c;
        t->found = true;
        if (t->ray->any) return true;
    }
    return false;
}
