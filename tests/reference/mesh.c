/* SPDX-License-Identifier: MIT */
/* mesh.c: where a line crosses the triangles of a mesh, without leaks at their edges. */
#include "internal.h"

#include <string.h>

const reference_shape *reference_mesh(reference_scene *scene, const double *vertices, size_t vertex_count,
                                      const uint32_t *indices, size_t triangle_count) {
    reference_shape *shape = reference_allocate(1, sizeof *shape);
    shape->kind = RG_SHAPE_MESH;
    shape->next = scene->shapes;
    scene->shapes = shape;
    shape->triangle_count = triangle_count;
    shape->vertices = reference_allocate(3 * vertex_count, sizeof *vertices);
    shape->indices = reference_allocate(3 * triangle_count, sizeof *indices);
    memcpy(shape->vertices, vertices, 3 * vertex_count * sizeof *vertices);
    memcpy(shape->indices, indices, 3 * triangle_count * sizeof *indices);
    for (int i = 0; i < 3; i++) shape->lo[i] = HUGE_VALL, shape->hi[i] = -HUGE_VALL;
    /* Only vertices of triangles count: others are no part of the surface. */
    for (size_t k = 0; k < 3 * triangle_count; k++) {
        for (int i = 0; i < 3; i++) {
            shape->lo[i] = fminl(shape->lo[i], vertices[3 * indices[k] + i]);
            shape->hi[i] = fmaxl(shape->hi[i], vertices[3 * indices[k] + i]);
        }
    }
    real half[3];
    for (int i = 0; i < 3; i++) {
        half[i] = (shape->hi[i] - shape->lo[i]) / 2;
        shape->centre[i] = shape->lo[i] + half[i];
    }
    shape->radius = length(half);
    return shape;
}

/* The line's frame: the axis along which it runs most, the two others, and the shear that makes it run along that one
 * alone. A vertex shared by two triangles gets the same sheared place in both. */
typedef struct shear {
    int x, y, z;
    real per_x, per_y;
} shear;

static shear shear_of(const line *at) {
    const real *d = at->direction;
    shear s = {0};
    for (int i = 1; i < 3; i++) {
        if (fabsl(d[i]) > fabsl(d[s.z])) s.z = i;
    }
    s.x = (s.z + 1) % 3;
    s.y = (s.z + 2) % 3;
    s.per_x = d[s.x] / d[s.z];
    s.per_y = d[s.y] / d[s.z];
    return s;
}

/* Twice the area that the line's foot spans with an edge. Exactly the negative if the edge runs the other way, since
 * products commute and a - b is rounded as -(b - a): so no line slips between two triangles that share an edge. */
static real edge(const real p[2], const real q[2]) {
    return p[0] * q[1] - p[1] * q[0];
}

static void cross_triangle(const real v[3][3], const shear *s, const line *at, uint32_t primitive,
                           crossing_visitor *visit, void *context) {
    real flat[3][2];
    for (int k = 0; k < 3; k++) {
        flat[k][0] = v[k][s->x] - s->per_x * v[k][s->z];
        flat[k][1] = v[k][s->y] - s->per_y * v[k][s->z];
    }
    real wa = edge(flat[1], flat[2]), wb = edge(flat[2], flat[0]), wc = edge(flat[0], flat[1]);
    bool some_negative = wa < 0 || wb < 0 || wc<0, some_positive = wa> 0 || wb > 0 || wc > 0;
    if (some_negative == some_positive) return; /* outside, or the line lies in the triangle's plane */
    real ab[3], ac[3], normal[3];
    for (int i = 0; i < 3; i++) ab[i] = v[1][i] - v[0][i], ac[i] = v[2][i] - v[0][i];
    cross(ab, ac, normal);
    real facing = dot(normal, at->direction), sum = wa + wb + wc;
    if (facing == 0) return;
    crossing c = {.t = at->t_base + dot(normal, v[0]) / facing,
                  .primitive = primitive,
                  .normal = {normal[0], normal[1], normal[2]},
                  .u = wb / sum,
                  .v = wc / sum};
    visit(context, &c);
}

void cross_mesh(const reference_shape *shape, const line *at, crossing_visitor *visit, void *context) {
    shear s = shear_of(at);
    for (size_t t = 0; t < shape->triangle_count; t++) {
        real v[3][3];
        for (int k = 0; k < 3; k++) {
            const double *vertex = shape->vertices + 3 * (size_t)shape->indices[3 * t + k];
            for (int i = 0; i < 3; i++) v[k][i] = vertex[i] - at->base[i];
        }
        cross_triangle((const real(*)[3])v, &s, at, (uint32_t)t, visit, context);
    }
}
