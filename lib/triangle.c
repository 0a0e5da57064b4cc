/* SPDX-License-Identifier: MIT */
#include "triangle.h"

#include "vec.h"

void rgi_triangle_ray_init(rgi_triangle_ray *t, const rgi_local_ray *ray) {
    t->ray = ray;
    rgi_copy(ray->origin, t->line.origin);
    rgi_triangle_axes(&t->line, ray->direction);
    t->found = false;
    t->best.t = ray->t_max;
}

double rgi_triangle_in_box(const double direction[3], double r[3][3], double root) {
    for (int a = 0; a < 3; a++) {
        double d = direction[a], low = rgi_min(rgi_min(r[0][a], r[1][a]), r[2][a]);
        double high = rgi_max(rgi_max(r[0][a], r[1][a]), r[2][a]);
        if (d == 0) continue;
        root = rgi_min(rgi_max(root, (d > 0 ? low : high) / d), (d > 0 ? high : low) / d);
    }
    return root;
}

static void describe(const rgi_triangle_ray *t, const rgi_triangle_meeting *met, rgi_candidate *candidate) {
    candidate->t = t->ray->shift + met->root;
    rgi_copy(met->normal, candidate->normal);
    candidate->u = met->edge1 / met->sum;
    candidate->v = met->edge2 / met->sum;
}

uint32_t rgi_triangle_meets(const rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangle,
                            rgi_candidate *candidate) {
    double v[3][3];
    rgi_triangle_meeting met;
    rgi_triangle_corners(mesh, leaf, triangle, v);
    if (!rgi_triangle_meet(&t->line, v, &met)) return 0;
    describe(t, &met, candidate);
    candidate->primitive = rgi_mesh_primitive(mesh, leaf, triangle);
    return met.side;
}

bool rgi_triangles_test(rgi_triangle_ray *t, const rgi_mesh *mesh, const void *leaf, uint32_t triangles) {
    for (; triangles; triangles &= triangles - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(triangles);
        rgi_candidate c;
        rgi_triangle_meeting met;
        double v[3][3];
        rgi_triangle_corners(mesh, leaf, i, v);
        if (!rgi_triangle_meet(&t->line, v, &met)) continue;
        if (!rgi_in_range(t->ray, met.root, met.side, &c)) continue;
        c.primitive = rgi_mesh_primitive(mesh, leaf, i);
        if (c.t > t->best.t || (t->found && c.t == t->best.t && c.primitive > t->best.primitive)) continue;
        describe(t, &met, &c);
        if (!rgi_accepted(t->ray, &c)) continue;
        t->best = c;
        t->found = true;
        if (t->ray->any) return true;
    }
    return false;
}
