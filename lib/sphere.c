/* SPDX-License-Identifier: MIT */
#include "intersect.h"
#include "vec.h"

/*
 * E. Haines, J. Guenther, T. Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems
 * (2019), chapter 7. The discriminant is taken from the foot of the perpendicular (section 7.2): no cancellation far
 * away. The root that would cancel is c/q (section 7.3), so an origin on the sphere gives exactly 0. It can't be
 * farther than the other one, q/dd: where it is, at the foot of a tangent, c and q are nothing but rounding, and the
 * root as it stands is as good as h.
 */
bool rgi_sphere_roots(double radius, const double origin[3], const double direction[3], double roots[2]) {
    double dd = rgi_dot(direction, direction);
    double b = rgi_dot(origin, direction);
    double foot[3];
    rgi_along(origin, -(b / dd), direction, foot);
    double inside = radius * radius - rgi_dot(foot, foot);
    if (!(inside >= 0)) return false;
    /* Under linear parts near the limits of scales the product may underflow. */
    double square = dd * inside;
    double h = square >= 0x1p-900 ? sqrt(square) : sqrt(dd) * sqrt(inside);
    double c = rgi_dot(origin, origin) - radius * radius;
    double q = b > 0 ? -b - h : -b + h;
    double far_from_zero = q / dd;
    double near_zero = q != 0 ? c / q : 0;
    if (fabs(c) > 2 * (q * far_from_zero)) near_zero = (b > 0 ? -b + h : -b - h) / dd;
    roots[0] = b > 0 ? far_from_zero : near_zero;
    roots[1] = b > 0 ? near_zero : far_from_zero;
    return true;
}

bool rgi_sphere_intersect(double radius, const rgi_local_ray *ray, rgi_candidate *candidate) {
    double roots[2];
    if (!rgi_sphere_roots(radius, ray->origin, ray->direction, roots)) return false;
    for (int i = 0; i < 2; i++) {
        if (!rgi_in_range(ray, roots[i], i == 0 ? RGI_FRONT : RGI_BACK, candidate)) continue;
        rgi_along(ray->origin, roots[i], ray->direction, candidate->normal);
        candidate->u = candidate->v = 0;
        candidate->primitive = 0;
        if (rgi_accepted(ray, candidate)) return true;
    }
    return false;
}
