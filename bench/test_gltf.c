/* SPDX-License-Identifier: MIT */
/* A glTF file as one mesh has the same triangles in the same places as with each of its parts a mesh. */
#include "gltf.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SKIPPED = 77 };

/* Of a place in the unit cube, whose roundings to floats, of vertices and poses, are some 2^-24 each. */
static const double ALLOWED = 1e-6;

/* The part's vertices from number `first` on. */
static double farthest(const struct bench_scene *parts, uint32_t part, const struct bench_mesh *whole,
                       uint32_t first) {
    const struct bench_mesh *mesh = bench_shape_of(parts, part)->mesh;
    const rg_pose pose = bench_pose(parts, part);
    double most = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *from = mesh->vertices + 3 * (size_t)i, *to = whole->vertices + 3 * (size_t)(first + i);
        for (int r = 0; r < 3; r++) {
            double place = pose.position[r];
            for (int c = 0; c < 3; c++) place += pose.scale * (double)pose.linear[3 * r + c] * (double)from[c];
            most = fmax(most, fabs(place - (double)to[r]));
        }
    }
    return most;
}

static uint32_t other_corners(const struct bench_mesh *mesh, const struct bench_mesh *whole, uint32_t vertex,
                              uint32_t triangle) {
    uint32_t count = 0;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        count += whole->corners[3 * (size_t)triangle + i] != vertex + mesh->corners[i];
    }
    return count;
}

int main(void) {
    const char *path = bench_gltf_usual();
    FILE *file = fopen(path, "rb");
    if (!file) {
        printf("skipped: no %s here\n", path);
        return SKIPPED;
    }
    fclose(file);
    struct bench_scene *parts = bench_gltf_scene(path), *one = bench_gltf_mesh(path, "one");
    if (!parts || !one || !bench_is_one_mesh(one)) return 1;
    const struct bench_mesh *whole = one->shapes[0].mesh;
    uint32_t vertices = 0, triangles = 0, others = 0;
    double most = 0;
    for (uint32_t part = 0; part < parts->count; part++) {
        const struct bench_mesh *mesh = bench_shape_of(parts, part)->mesh;
        if (vertices + mesh->vertex_count > whole->vertex_count) return 1;
        if (triangles + mesh->triangle_count > whole->triangle_count) return 1;
        most = fmax(most, farthest(parts, part, whole, vertices));
        others += other_corners(mesh, whole, vertices, triangles);
        vertices += mesh->vertex_count;
        triangles += mesh->triangle_count;
    }
    printf("%u parts, %u triangles: vertices up to %g away, %u other corners\n", parts->count, triangles, most,
           others);
    bool same = triangles == whole->triangle_count && vertices == whole->vertex_count && triangles == one->size;
    bench_scene_destroy(parts);
    bench_scene_destroy(one);
    return same && most <= ALLOWED && others == 0 ? 0 : 1;
}
