/* SPDX-License-Identifier: MIT */
#include "intersect.h"
#include "vec.h"

/* Where a line is inside the slabs, and through which faces (0 to 5) it enters and leaves. */
typedef struct crossing {
    double t[2];
    uint32_t face[2];
} crossing;

/*
 * The slab test. Divisions, not products with a reciprocal: a correctly rounded quotient depends on the exact ratio
 * only, so planes that a ray meets at the same place in exact arithmetic (at an edge, a corner) give the same t. A
 * zero component of either sign takes no part except that the origin must be between the planes, which are part of
 * the box. Strict comparisons keep the lowest face where several meet.
 */
static bool cross(const double lo[3], const double hi[3], const double origin[3], const double direction[3],
                  crossing *out) {
    out->t[0] = -INFINITY;
    out->t[1] = INFINITY;
    out->face[0] = out->face[1] = 0;
    for (uint32_t i = 0; i < 3; i++) {
        if (direction[i] == 0) {
            if (origin[i] < lo[i] || origin[i] > hi[i]) return false;
            continue;
        }
        bool up = direction[i] > 0;
        double enter = ((up ? lo[i] : hi[i]) - origin[i]) / direction[i];
        double leave = ((up ? hi[i] : lo[i]) - origin[i]) / direction[i];
        if (enter > out->t[0]) {
            out->t[0] = enter;
            out->face[0] = 2 * i + !up;
        }
        if (leave < out->t[1]) {
            out->t[1] = leave;
            out->face[1] = 2 * i + up;
        }
    }
    return out->t[0] <= out->t[1];
}

bool rgi_box_intersect(const double lo[3], const double hi[3], const rgi_local_ray *ray, rgi_candidate *candidate) {
    crossing c;
    if (!cross(lo, hi, ray->origin, ray->direction, &c)) return false;
    for (int i = 0; i < 2; i++) {
        if (!isfinite(c.t[i]) || !rgi_in_range(ray, c.t[i], i == 0 ? RGI_FRONT : RGI_BACK, candidate)) continue;
        rgi_set(candidate->normal, 0, 0, 0);
        candidate->normal[c.face[i] / 2] = c.face[i] % 2 ? 1 : -1;
        candidate->u = candidate->v = 0;
        candidate->primitive = c.face[i];
        if (rgi_accepted(ray, candidate)) return true;
    }
    return false;
}
