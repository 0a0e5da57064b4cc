/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include "measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float GOLDEN = 1.61803398875f;

/* The mesh while it grows: edges are found by their two ends, in a table with open addressing. */
struct builder {
    struct bench_mesh *mesh;
    uint64_t *edges;   /* smaller end in the high half; 0: free, as no edge goes from 0 to 0 */
    uint32_t *middles; /* the vertex in the middle of each edge */
    uint32_t mask;
};

static uint32_t add_vertex(struct bench_mesh *mesh, float x, float y, float z) {
    float scale = 1 / sqrtf(x * x + y * y + z * z);
    float *vertex = &mesh->vertices[3 * (size_t)mesh->vertex_count];
    vertex[0] = x * scale;
    vertex[1] = y * scale;
    vertex[2] = z * scale;
    return mesh->vertex_count++;
}

static uint32_t middle_of(struct builder *builder, uint32_t a, uint32_t b) {
    uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    uint32_t at = (uint32_t)((key * 0x9E3779B97F4A7C15u) >> 40) & builder->mask;
    while (builder->edges[at] && builder->edges[at] != key) at = (at + 1) & builder->mask;
    if (!builder->edges[at]) {
        const float *p = &builder->mesh->vertices[3 * (size_t)a], *q = &builder->mesh->vertices[3 * (size_t)b];
        builder->edges[at] = key;
        builder->middles[at] = add_vertex(builder->mesh, p[0] + q[0], p[1] + q[1], p[2] + q[2]);
    }
    return builder->middles[at];
}

/* Each triangle becomes four. */
static void divide(struct bench_mesh *mesh) {
    uint32_t size = 4;
    while (size < 4 * mesh->triangle_count) size *= 2;
    struct builder builder = {mesh, bench_allocate(size, sizeof *builder.edges),
                              bench_allocate(size, sizeof *builder.middles), size - 1};
    uint32_t old = mesh->triangle_count;
    for (uint32_t i = 0; i < old; i++) {
        uint32_t a = mesh->corners[3 * i], b = mesh->corners[3 * i + 1], c = mesh->corners[3 * i + 2];
        uint32_t ab = middle_of(&builder, a, b), bc = middle_of(&builder, b, c), ca = middle_of(&builder, c, a);
        const uint32_t outer[9] = {a, ab, ca, ab, b, bc, ca, bc, c}, inner[3] = {ab, bc, ca};
        memcpy(&mesh->corners[3 * (size_t)mesh->triangle_count], outer, sizeof outer);
        memcpy(&mesh->corners[3 * i], inner, sizeof inner);
        mesh->triangle_count += 3;
    }
    free(builder.edges);
    free(builder.middles);
}

struct bench_mesh *bench_icosphere(int levels) {
    static const uint32_t CORNERS[60] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                         4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                         6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    size_t triangles = 20u << 2 * levels;
    struct bench_mesh *mesh = bench_allocate(1, sizeof *mesh);
    mesh->vertices = bench_allocate(3 * (triangles / 2 + 2) + 1, sizeof *mesh->vertices);
    mesh->corners = bench_allocate(3 * triangles, sizeof *mesh->corners);
    for (int axis = 0; axis < 3; axis++) {
        for (int corner = 0; corner < 4; corner++) {
            float p[3] = {0, 0, 0};
            p[axis] = corner % 2 ? 1.0f : -1.0f;
            p[(axis + 1) % 3] = corner < 2 ? GOLDEN : -GOLDEN;
            add_vertex(mesh, p[0], p[1], p[2]);
        }
    }
    memcpy(mesh->corners, CORNERS, sizeof CORNERS);
    mesh->triangle_count = 20;
    for (int i = 0; i < levels; i++) divide(mesh);
    return mesh;
}

/* Three waves a direction, the shorter the smaller. */
static float bump(const float *v) {
    float sum = 0;
    for (int octave = 0; octave < 4; octave++) {
        float f = 7.0f * (float)(1 << octave);
        sum += (sinf(f * v[0] + 1) * sinf(f * v[1] + 2) + sinf(f * v[1]) * sinf(f * v[2] + 3)) / f;
    }
    return sum;
}

struct bench_mesh *bench_noisy_sphere(uint32_t triangles) {
    int levels = (int)lround(log2(triangles / 20.0) / 2);
    struct bench_mesh *mesh = bench_icosphere(levels);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float *v = &mesh->vertices[3 * (size_t)i], radius = 0.4f * (1 + 0.5f * bump(v));
        for (int k = 0; k < 3; k++) v[k] = 0.5f + radius * v[k];
    }
    return mesh;
}

struct bench_mesh *bench_soup(uint32_t triangles) {
    struct bench_mesh *mesh = bench_allocate(1, sizeof *mesh);
    double side = 1.2 / cbrt(triangles);
    uint64_t random = 5;
    mesh->triangle_count = triangles;
    mesh->vertex_count = 3 * triangles;
    mesh->vertices = bench_allocate(9 * (size_t)triangles + 1, sizeof *mesh->vertices);
    mesh->corners = bench_allocate(3 * (size_t)triangles, sizeof *mesh->corners);
    for (uint32_t i = 0; i < 3 * triangles; i++) mesh->corners[i] = i;
    for (uint32_t i = 0; i < triangles; i++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = bench_random(&random);
        for (int c = 0; c < 9; c++)
            mesh->vertices[9 * (size_t)i + c] = (float)(centre[c % 3] + side * (bench_random(&random) - 0.5));
    }
    return mesh;
}

void bench_mesh_destroy(struct bench_mesh *mesh) {
    if (!mesh) return;
    free(mesh->vertices);
    free(mesh->corners);
    free(mesh);
}

struct bench_bend bench_bend_create(struct bench_mesh *mesh) {
    size_t floats = 3 * (size_t)mesh->vertex_count;
    struct bench_bend bend = {mesh, bench_allocate(floats, sizeof *bend.home), 0};
    memcpy(bend.home, mesh->vertices, floats * sizeof *bend.home);
    return bend;
}

void bench_bend_next(struct bench_bend *bend) {
    float phase = 0.7f * (float)++bend->forms;
    for (uint32_t i = 0; i < bend->mesh->vertex_count; i++) {
        const float *from = bend->home + 3 * (size_t)i;
        float *to = bend->mesh->vertices + 3 * (size_t)i;
        for (int k = 0; k < 3; k++) to[k] = from[k] + 0.01f * sinf(20 * from[(k + 1) % 3] + phase);
    }
}

void bench_bend_destroy(struct bench_bend *bend) {
    free(bend->home);
}
