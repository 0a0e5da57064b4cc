/* SPDX-License-Identifier: MIT */
#include "object.h"

#include "exact.h"
#include "vec.h"

#include <float.h>
#include <string.h>

/* 2^e for -1022 <= e <= 1023. */
static double power_of_two(int e) {
    uint64_t bits = (uint64_t)(e + 1023) << 52;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The e for which 2^e <= x < 2^(e + 1), for 0 < x < infinity. */
static int exponent_of(double x) {
    uint64_t bits;
    int exponent;
    memcpy(&bits, &x, sizeof bits);
    if (bits >> 52) return (int)(bits >> 52) - 1023;
    frexp(x, &exponent);
    return exponent - 1;
}

/*
 * A limit of t in scaled units. What underflows keeps its sign: t = 0 is out of the range of a ray that starts at the
 * smallest t above it. The caller has clipped it to where t in its own units is a double: a hit must not look like a
 * miss.
 */
static double scaled_limit(double t, double scale, double scale2) {
    double scaled = t * scale * scale2;
    return scaled == 0 && t != 0 ? copysign(0x1p-1074, t) : scaled;
}

bool rgi_ray_init(rgi_ray *ray, const double origin[3], const double direction[3], double t_min, double t_max,
                  uint32_t mask) {
    bool valid = t_min <= t_max;
    for (int i = 0; i < 3; i++) valid &= fabs(origin[i]) <= RG_COORDINATE_MAX && fabs(direction[i]) <= DBL_MAX;
    double largest = rgi_max_magnitude(direction);
    if (!valid || largest == 0) return false;
    int exponent = exponent_of(largest);
    int half = exponent / 2;
    ray->to_world = power_of_two(-half);
    ray->to_world2 = power_of_two(-(exponent - half));
    double from_world = power_of_two(half), from_world2 = power_of_two(exponent - half);
    for (int i = 0; i < 3; i++) {
        ray->origin[i] = origin[i];
        ray->direction[i] = direction[i] * ray->to_world * ray->to_world2;
    }
    ray->t_min = rgi_max(scaled_limit(rgi_max(t_min, -DBL_MAX), from_world, from_world2), -RGI_FARTHEST);
    ray->t_max = rgi_min(scaled_limit(rgi_min(t_max, DBL_MAX), from_world, from_world2), RGI_FARTHEST);
    ray->dd = rgi_dot(ray->direction, ray->direction);
    ray->mask = mask;
    return true;
}

/*
 * Whether a ray passes the ball around the object's position by so much that no rounding matters: the distance
 * squared (times dd: no division for the many that pass) has an error of some 2^-50 of oo, and the ball gets 2^-8
 * more radius.
 */
static bool passes(double oo, double b, double reach, const rgi_ray *ray) {
    return oo * ray->dd - b * b > (reach * reach * (1 + 0x1p-8) + oo * 0x1p-40) * ray->dd;
}

bool rgi_object_local(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray, rgi_local_ray *local) {
    double oc[3];
    rgi_sub(ray->origin, object->position, oc);
    double oo = rgi_dot(oc, oc), b = rgi_dot(oc, ray->direction);
    if (passes(oo, b, object->reach, ray)) return false;
    local->shift = 0;
    if (oo > (double)(RGI_NEAR * RGI_NEAR) * object->reach * object->reach) {
        local->shift = -(b / ray->dd);
        rgi_rebase3(ray->origin, object->position, local->shift, ray->direction, oc);
    }
    if (linear) {
        rgi_transform(linear->inverse, oc, local->origin);
        rgi_transform(linear->inverse, ray->direction, local->direction);
    } else {
        rgi_copy(oc, local->origin);
        rgi_copy(ray->direction, local->direction);
    }
    return true;
}

bool rgi_object_intersect(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray,
                          rgi_local_ray *local, rgi_candidate *candidate) {
    if (!rgi_object_local(object, linear, ray, local)) return false;
    if (object->shape->kind == RG_SHAPE_SPHERE && !linear)
        return rgi_sphere_intersect(object->reach, local, candidate);
    return rgi_shape_intersect(object->shape, local, candidate);
}
