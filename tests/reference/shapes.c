/* SPDX-License-Identifier: MIT */
/* shapes.c: where a line crosses a sphere, a box, a capsule. All three are convex: it goes in once and out once. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

static reference_shape *new_shape(reference_scene *scene, rg_shape_kind kind) {
    reference_shape *shape = reference_allocate(1, sizeof *shape);
    shape->kind = kind;
    shape->next = scene->shapes;
    scene->shapes = shape;
    return shape;
}

const reference_shape *reference_sphere(reference_scene *scene, double radius) {
    reference_shape *shape = new_shape(scene, RG_SHAPE_SPHERE);
    shape->r = shape->radius = radius;
    shape->curvature = 1 / shape->r;
    for (int i = 0; i < 3; i++) shape->lo[i] = -(shape->hi[i] = radius);
    return shape;
}

const reference_shape *reference_box(reference_scene *scene, const double lo[3], const double hi[3]) {
    reference_shape *shape = new_shape(scene, RG_SHAPE_BOX);
    real half[3];
    for (int i = 0; i < 3; i++) {
        shape->lo[i] = lo[i];
        shape->hi[i] = hi[i];
        half[i] = (shape->hi[i] - shape->lo[i]) / 2;
        shape->centre[i] = isfinite(half[i]) ? shape->lo[i] + half[i] : 0;
    }
    shape->radius = length(half);
    return shape;
}

const reference_shape *reference_capsule(reference_scene *scene, const double a[3], const double b[3],
                                         double radius) {
    reference_shape *shape = new_shape(scene, RG_SHAPE_CAPSULE);
    real half[3];
    for (int i = 0; i < 3; i++) {
        shape->a[i] = a[i];
        shape->b[i] = b[i];
        half[i] = (shape->b[i] - shape->a[i]) / 2;
        shape->centre[i] = shape->a[i] + half[i];
        shape->lo[i] = fminl(a[i], b[i]) - radius;
        shape->hi[i] = fmaxl(a[i], b[i]) + radius;
    }
    shape->r = radius;
    shape->curvature = 1 / shape->r;
    shape->radius = length(half) + radius;
    return shape;
}

/* ------------------------------------------------------------------------------------ intervals on a line */

/* The part of a line inside something convex; empty if in > out. */
typedef struct interval {
    real in, out;
} interval;

static const interval nowhere = {HUGE_VALL, -HUGE_VALL};

static interval both(interval a, interval b) {
    return (interval){fmaxl(a.in, b.in), fminl(a.out, b.out)};
}

/* The hull of two parts, of which either may be empty. */
static interval hull(interval a, interval b) {
    if (a.in > a.out) return b;
    if (b.in > b.out) return a;
    return (interval){fminl(a.in, b.in), fmaxl(a.out, b.out)};
}

/* Where |p + s d| <= r. The distance to the line comes from the foot of the perpendicular, never from b^2 - 4ac. */
static interval inside_ball(const real p[3], const real d[3], real r) {
    real dd = dot(d, d), s = -dot(p, d) / dd, foot[3];
    for (int i = 0; i < 3; i++) foot[i] = p[i] + s * d[i];
    real distance = length(foot), rest = (r - distance) * (r + distance);
    if (rest < 0) return nowhere;
    real half = sqrtl(rest / dd);
    return (interval){s - half, s + half};
}

/* Where lo <= p + s d <= hi on one axis. */
static interval inside_slab(real p, real d, real lo, real hi) {
    if (d == 0) return p < lo || p > hi ? nowhere : (interval){-HUGE_VALL, HUGE_VALL};
    real s = (lo - p) / d, e = (hi - p) / d;
    return d > 0 ? (interval){s, e} : (interval){e, s};
}

/* ---------------------------------------------------------------------------------------------- crossings */

static void report(const line *at, real s, uint32_t primitive, const real normal[3], crossing_visitor *visit,
                   void *context) {
    crossing c = {.t = at->t_base + s, .primitive = primitive, .normal = {normal[0], normal[1], normal[2]}};
    visit(context, &c);
}

static void cross_sphere(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context) {
    interval part = inside_ball(at->base, at->direction, shape->r);
    if (part.in > part.out) return;
    for (int end = 0; end < 2; end++) {
        real s = end ? part.out : part.in, normal[3];
        for (int i = 0; i < 3; i++) normal[i] = at->base[i] + s * at->direction[i];
        report(at, s, 0, normal, visit, context);
    }
}

static void cross_box(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context) {
    interval part = {-HUGE_VALL, HUGE_VALL};
    for (int i = 0; i < 3; i++) {
        part = both(part, inside_slab(at->base[i], at->direction[i], shape->lo[i], shape->hi[i]));
    }
    if (part.in > part.out) return;
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2;
        real d = at->direction[axis];
        if (d == 0) continue;
        /* The division is the one in inside_slab, so that equality means: this face ends the part. */
        real s = ((face & 1 ? shape->hi[axis] : shape->lo[axis]) - at->base[axis]) / d;
        if (!isfinite(s) || (s != part.in && s != part.out)) continue;
        real normal[3] = {0};
        normal[axis] = face & 1 ? 1 : -1;
        report(at, s, face, normal, visit, context);
    }
}

/* From the point of the segment that is nearest to `point`. */
static void capsule_normal(const reference_shape *shape, const real point[3], real normal[3]) {
    real axis[3], from[3];
    for (int i = 0; i < 3; i++) axis[i] = shape->b[i] - shape->a[i], from[i] = point[i] - shape->a[i];
    real aa = dot(axis, axis), along = aa > 0 ? dot(from, axis) / aa : 0;
    along = fminl(fmaxl(along, 0), 1);
    for (int i = 0; i < 3; i++) normal[i] = from[i] - along * axis[i];
}

/* Where the line is within r of the segment's inner points: in the endless cylinder and between its end planes. */
static interval inside_cylinder(const reference_shape *shape, const line *at) {
    real axis[3], from[3], p[3], d[3];
    for (int i = 0; i < 3; i++) axis[i] = shape->b[i] - shape->a[i], from[i] = at->base[i] - shape->a[i];
    real aa = dot(axis, axis);
    if (aa == 0) return nowhere;
    real p_along = dot(from, axis) / aa, d_along = dot(at->direction, axis) / aa;
    for (int i = 0; i < 3; i++) {
        p[i] = from[i] - p_along * axis[i];
        d[i] = at->direction[i] - d_along * axis[i];
    }
    interval between = inside_slab(p_along, d_along, 0, 1);
    /* Along the axis there is no foot: what is left of d is rounding. */
    if (dot(d, d) <= 0x1p-110L * dot(at->direction, at->direction)) return length(p) <= shape->r ? between : nowhere;
    return both(inside_ball(p, d, shape->r), between);
}

static void cross_capsule(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context) {
    real from_a[3], from_b[3];
    for (int i = 0; i < 3; i++) from_a[i] = at->base[i] - shape->a[i], from_b[i] = at->base[i] - shape->b[i];
    interval part = hull(inside_ball(from_a, at->direction, shape->r), inside_ball(from_b, at->direction, shape->r));
    part = hull(part, inside_cylinder(shape, at));
    if (part.in > part.out) return;
    for (int end = 0; end < 2; end++) {
        real s = end ? part.out : part.in, point[3], normal[3];
        for (int i = 0; i < 3; i++) point[i] = at->base[i] + s * at->direction[i];
        capsule_normal(shape, point, normal);
        report(at, s, 0, normal, visit, context);
    }
}

void cross_shape(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context) {
    switch (shape->kind) {
    case RG_SHAPE_SPHERE:
        cross_sphere(shape, at, visit, context);
        break;
    case RG_SHAPE_BOX:
        cross_box(shape, at, visit, context);
        break;
    case RG_SHAPE_CAPSULE:
        cross_capsule(shape, at, visit, context);
        break;
    default:
        cross_mesh(shape, at, visit, context);
        break;
    }
}
