/* SPDX-License-Identifier: MIT */
#include "intersect.h"
#include "vec.h"

void rgi_capsule_init(rgi_capsule *capsule, const double a[3], const double b[3], double radius) {
    rgi_copy(a, capsule->a);
    rgi_copy(b, capsule->b);
    capsule->radius = radius;
    double d[3];
    rgi_sub(b, a, d);
    double m = rgi_max_magnitude(d);
    capsule->length = 0;
    rgi_set(capsule->axis, 0, 0, 1);
    if (m == 0) return;
    for (int i = 0; i < 3; i++) d[i] /= m;
    double norm = sqrt(rgi_dot(d, d));
    capsule->length = m * norm;
    for (int i = 0; i < 3; i++) capsule->axis[i] = d[i] / norm;
}

/* The roots of a line and the endless cylinder around the axis. A line along the axis is inside for all t. */
static bool cylinder_roots(const rgi_capsule *capsule, const double m[3], const double d[3], double along_m,
                           double along_d, double roots[2]) {
    double mp[3], dp[3];
    rgi_along(m, -along_m, capsule->axis, mp);
    rgi_along(d, -along_d, capsule->axis, dp);
    /* Below 2^-50 of the direction the part across the axis is rounding error of the part along it. */
    if (rgi_dot(dp, dp) <= 0x1p-100 * rgi_dot(d, d)) {
        roots[0] = -INFINITY;
        roots[1] = INFINITY;
        return rgi_dot(mp, mp) <= capsule->radius * capsule->radius;
    }
    return rgi_sphere_roots(capsule->radius, mp, dp, roots);
}

/*
 * The capsule is the union of the cylinder between its ends and a ball at each. A line enters the capsule where it
 * enters the endless cylinder if that place lies between the ends, else where it enters the ball of the end beyond
 * which it lies; it leaves likewise. For in the half space beyond an end, the capsule is that end's half ball, and a
 * line that crosses the end's plane inside the cylinder does so inside the ball.
 */
bool rgi_capsule_intersect(const rgi_capsule *capsule, const rgi_local_ray *ray, rgi_candidate *candidate) {
    const double *d = ray->direction;
    double m[3], roots[2];
    rgi_sub(ray->origin, capsule->a, m);
    double along_m = rgi_dot(m, capsule->axis), along_d = rgi_dot(d, capsule->axis);
    if (!cylinder_roots(capsule, m, d, along_m, along_d, roots)) return false;
    for (int i = 0; i < 2; i++) {
        double root = roots[i], centre;
        /* An infinite root times along_d, which is then not 0, is a signed infinity: beyond one end. */
        double height = along_m + root * along_d;
        if (height >= 0 && height <= capsule->length) {
            centre = height;
        } else {
            double n[3], ball[2];
            centre = height < 0 ? 0 : capsule->length;
            rgi_along(m, -centre, capsule->axis, n);
            if (!rgi_sphere_roots(capsule->radius, n, d, ball)) return false;
            root = ball[i];
        }
        if (!rgi_in_range(ray, root, i == 0 ? RGI_FRONT : RGI_BACK, candidate)) continue;
        rgi_along(m, root, d, candidate->normal);
        rgi_along(candidate->normal, -centre, capsule->axis, candidate->normal);
        candidate->u = candidate->v = 0;
        candidate->primitive = 0;
        if (rgi_accepted(ray, candidate)) return true;
    }
    return false;
}
