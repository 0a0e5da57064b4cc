/* SPDX-License-Identifier: MIT */
/* nearest.c: how far a point is from a surface, and a line from the edges of a shape. */
#include "internal.h"

static real clamped(real x, real lo, real hi) {
    return fminl(fmaxl(x, lo), hi);
}

static bool near_round(const reference_shape *shape, const real p[3], place *near) {
    real axis[3], from[3], foot[3];
    for (int i = 0; i < 3; i++) axis[i] = shape->b[i] - shape->a[i], from[i] = p[i] - shape->a[i];
    real aa = dot(axis, axis), along = aa > 0 ? clamped(dot(from, axis) / aa, 0, 1) : 0;
    for (int i = 0; i < 3; i++) {
        foot[i] = shape->a[i] + along * axis[i];
        near->normal[i] = p[i] - foot[i];
    }
    real l = length(near->normal);
    for (int i = 0; i < 3; i++) near->point[i] = foot[i] + near->normal[i] * (shape->r / l);
    return l > 0;
}

static bool near_face(const reference_shape *shape, uint32_t face, const real p[3], place *near) {
    if (face > 5) return false;
    uint32_t axis = face / 2;
    for (int i = 0; i < 3; i++) near->point[i] = clamped(p[i], shape->lo[i], shape->hi[i]);
    near->point[axis] = face & 1 ? shape->hi[axis] : shape->lo[axis];
    near->normal[axis] = face & 1 ? 1 : -1;
    return isfinite(near->point[axis]);
}

/* The nearest point of the segment from o to o + d: its parameter. */
static real along_segment(const real o[3], const real d[3], const real p[3]) {
    real from[3] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]}, dd = dot(d, d);
    return dd > 0 ? clamped(dot(from, d) / dd, 0, 1) : 0;
}

static real distance(const real a[3], const real b[3]) {
    real d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length(d);
}

/* The nearest point of triangle v: its foot if that lies inside, else the best of the three edges. */
static void near_in_triangle(const real v[3][3], const real normal[3], const real p[3], place *near) {
    real ab[3], ac[3], ap[3], c[3], nn = dot(normal, normal);
    for (int i = 0; i < 3; i++) ab[i] = v[1][i] - v[0][i], ac[i] = v[2][i] - v[0][i], ap[i] = p[i] - v[0][i];
    cross(ap, ac, c);
    near->u = dot(c, normal) / nn;
    cross(ab, ap, c);
    near->v = dot(c, normal) / nn;
    bool inside = near->u >= 0 && near->v >= 0 && near->u + near->v <= 1;
    for (int i = 0; i < 3; i++) near->point[i] = v[0][i] + near->u * ab[i] + near->v * ac[i];
    for (int k = 0; !inside && k < 3; k++) {
        const real *from = v[k], *to = v[(k + 1) % 3];
        real d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, q[3], s = along_segment(from, d, p);
        for (int i = 0; i < 3; i++) q[i] = from[i] + s * d[i];
        if (k > 0 && distance(q, p) >= distance(near->point, p)) continue;
        for (int i = 0; i < 3; i++) near->point[i] = q[i];
        near->u = k == 0 ? s : k == 1 ? 1 - s : 0;
        near->v = k == 1 ? s : k == 2 ? 1 - s : 0;
    }
}

static void corners(const reference_shape *shape, size_t triangle, real v[3][3]) {
    for (int k = 0; k < 3; k++) {
        const double *vertex = shape->vertices + 3 * (size_t)shape->indices[3 * triangle + k];
        for (int i = 0; i < 3; i++) v[k][i] = vertex[i];
    }
}

static bool near_triangle(const reference_shape *shape, uint32_t triangle, const real p[3], place *near) {
    real v[3][3], ab[3], ac[3];
    if (triangle >= shape->triangle_count) return false;
    corners(shape, triangle, v);
    for (int k = 0; k < 3; k++) {
        /* Two corners in one place: never hit, whatever the bounds. */
        if (distance(v[k], v[(k + 1) % 3]) == 0) return false;
    }
    for (int i = 0; i < 3; i++) ab[i] = v[1][i] - v[0][i], ac[i] = v[2][i] - v[0][i];
    cross(ab, ac, near->normal);
    near_in_triangle((const real(*)[3])v, near->normal, p, near);
    near->thickness = length(near->normal) / fmaxl(fmaxl(length(ab), length(ac)), distance(v[1], v[2]));
    return true;
}

bool nearest_place(const reference_shape *shape, uint32_t primitive, const real p[3], place *near) {
    *near = (place){.thickness = HUGE_VALL};
    if (shape->kind == RG_SHAPE_BOX) return near_face(shape, primitive, p, near);
    if (shape->kind == RG_SHAPE_MESH) return near_triangle(shape, primitive, p, near);
    return primitive == 0 && near_round(shape, p, near);
}

/* -------------------------------------------------------------------------------------------------- edges */

/* The point of the segment from a to b that is nearest to the line p + s d, and its distance from the line. */
static real near_line(const line *at, const real a[3], const real b[3], real point[3]) {
    real n[3], ab[3], ap[3], c[3];
    const real *d = at->direction;
    for (int i = 0; i < 3; i++) ab[i] = b[i] - a[i], ap[i] = at->base[i] - a[i];
    cross(d, ab, n);
    cross(d, n, c); /* lies in the plane of d and the common normal, across d */
    real across = dot(ab, c), s = across != 0 ? clamped(dot(ap, c) / across, 0, 1) : 0, from[3], off[3];
    for (int i = 0; i < 3; i++) point[i] = a[i] + s * ab[i], from[i] = point[i] - at->base[i];
    cross(from, d, off);
    return length(off) / length(d);
}

static void visit_edge(const line *at, const real a[3], const real b[3], real thickness, edge_visitor *visit,
                       void *context) {
    real point[3], from[3];
    real off = near_line(at, a, b, point);
    for (int i = 0; i < 3; i++) from[i] = point[i] - at->base[i];
    real t = at->t_base + dot(from, at->direction) / dot(at->direction, at->direction);
    visit(context, t, fmaxl(0, off - thickness));
}

static void box_corner(const reference_shape *shape, int number, real corner[3]) {
    for (int i = 0; i < 3; i++) {
        corner[i] = number >> i & 1 ? shape->hi[i] : shape->lo[i];
        /* Long enough for any line that runs at an angle; those along the axis see no end anyway. */
        if (!isfinite(corner[i])) corner[i] = corner[i] < 0 ? -1e200L : 1e200L;
    }
}

void edges_of(const reference_shape *shape, const line *at, edge_visitor *visit, void *context) {
    for (int number = 0; shape->kind == RG_SHAPE_BOX && number < 8; number++) {
        real a[3], b[3];
        box_corner(shape, number, a);
        for (int axis = 0; axis < 3; axis++) {
            if (number >> axis & 1) continue;
            box_corner(shape, number | 1 << axis, b);
            visit_edge(at, a, b, 0, visit, context);
        }
    }
    if (shape->r > 0) visit_edge(at, shape->a, shape->b, shape->r, visit, context);
    for (size_t t = 0; t < shape->triangle_count; t++) {
        real v[3][3];
        corners(shape, t, v);
        for (int k = 0; k < 3; k++) visit_edge(at, v[k], v[(k + 1) % 3], 0, visit, context);
    }
}
