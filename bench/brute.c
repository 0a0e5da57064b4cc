/* SPDX-License-Identifier: MIT */
#include "brute.h"

#include "measure.h"

#include <stdlib.h>

const reference_shape *brute_shape(reference_scene *reference, const struct bench_shape *shape) {
    const double *s = shape->size;
    const double lo[3] = {-s[0], -s[1], -s[2]}, a[3] = {-s[0], 0, 0}, b[3] = {s[0], 0, 0};
    if (shape->kind == RG_SHAPE_SPHERE) return reference_sphere(reference, s[0]);
    if (shape->kind == RG_SHAPE_BOX) return reference_box(reference, lo, s);
    if (shape->kind == RG_SHAPE_CAPSULE) return reference_capsule(reference, a, b, s[1]);
    const struct bench_mesh *mesh = shape->mesh;
    double *vertices = bench_allocate(3 * (size_t)mesh->vertex_count, sizeof *vertices);
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) vertices[i] = (double)mesh->vertices[i];
    const reference_shape *result =
        reference_mesh(reference, vertices, mesh->vertex_count, mesh->corners, mesh->triangle_count);
    free(vertices);
    return result;
}
