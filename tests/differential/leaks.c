/* SPDX-License-Identifier: MIT */
/*
 * leaks: rays from inside a closed mesh, aimed at its vertices and at points of its edges, never get out; whichever
 * way they are traced, wherever the mesh is, however it is posed. And a ray that starts anew where one has hit, by
 * the offset that the hit tells, never meets the same triangle again.
 *
 *   leaks [--rays N]
 *
 * N rays for each place and pose; each is traced alone, in a batch, among rays that go the same way and among rays
 * that do not, and asked for any hit. 10^7 in all are those of --rays 1111112.
 */
#include "random.h"

#include <inttypes.h>
#include <math.h>
#include <raygrid/raygrid.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 60, RINGS = 29, VERTICES = RINGS * AROUND + 2, TRIANGLES = 2 * RINGS * AROUND, BATCH = 4096 };

static double vertices[VERTICES][3];
static uint32_t triangles[TRIANGLES][3];
static random_source source = {20021};

typedef struct counts {
    uint64_t rays, leaks, again;
} counts;

static void demand(rg_result result, const char *call) {
    if (result == RG_OK) return;
    fprintf(stderr, "%s: %s\n", call, rg_error_message());
    exit(EXIT_FAILURE);
}

/* ------------------------------------------------------------------------------------------------- the mesh */

static void add_triangle(uint32_t *count, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corners[3] = {a, b, c};
    memcpy(triangles[(*count)++], corners, sizeof corners);
}

/* A sphere with bumps, in doubles that are no floats; the last two vertices are its poles. */
static void make_surface(void) {
    const double pi = acos(-1);
    uint32_t count = 0;
    for (uint32_t r = 0; r < RINGS; r++) {
        for (uint32_t s = 0; s < AROUND; s++) {
            double polar = pi * (r + 1) / (RINGS + 1), around = 2 * pi * s / AROUND;
            double radius = 1 + 0.1 * sin(5 * around) * sin(4 * polar), *v = vertices[r * AROUND + s];
            v[0] = radius * sin(polar) * cos(around);
            v[1] = radius * sin(polar) * sin(around);
            v[2] = radius * cos(polar);
        }
    }
    vertices[VERTICES - 2][2] = 1;
    vertices[VERTICES - 1][2] = -1;
    for (uint32_t s = 0; s < AROUND; s++) {
        uint32_t t = (s + 1) % AROUND, last = (RINGS - 1) * AROUND;
        add_triangle(&count, VERTICES - 2, s, t);
        add_triangle(&count, VERTICES - 1, last + t, last + s);
        for (uint32_t r = 0; r + 1 < RINGS; r++) {
            uint32_t up = r * AROUND, down = up + AROUND;
            add_triangle(&count, up + s, down + s, down + t);
            add_triangle(&count, up + s, down + t, up + t);
        }
    }
}

static rg_pose pose_of(int which, double offset) {
    static const float LINEARS[3][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},
                                        {0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1},
                                        {-1.5f, 0.3f, 0, 0, 0.7f, 0.1f, 0, 0, 2}};
    rg_pose pose = rg_pose_at(offset, 0.7 * offset, -offset);
    memcpy(pose.linear, LINEARS[which], sizeof pose.linear);
    if (which == 1) pose.scale = 3.7;
    return pose;
}

static void to_world(const rg_pose *pose, const double local[3], double out[3]) {
    double scale = pose->scale > 0 ? pose->scale : 1;
    for (int r = 0; r < 3; r++) {
        const float *row = pose->linear + 3 * r;
        double at = (double)row[0] * local[0] + (double)row[1] * local[1] + (double)row[2] * local[2];
        out[r] = pose->position[r] + scale * at;
    }
}

/* ------------------------------------------------------------------------------------------------- the rays */

static void pick_eye(const rg_pose *pose, double eye[3]) {
    double local[3];
    for (int a = 0; a < 3; a++) local[a] = random_between(&source, -0.3, 0.3);
    to_world(pose, local, eye);
}

/* Half of them at a vertex, half at a point of an edge; neighbours in the batch at the same part of the surface. */
static void aim(const rg_pose *pose, bool together, rg_ray *rays) {
    double eye[3];
    uint32_t near_by = 0;
    for (uint32_t i = 0; i < BATCH; i++) {
        double target[3], local[3], w = i % 2 ? random_between(&source, 0, 1) : 0;
        if (i == 0 || !together) pick_eye(pose, eye);
        if (i % 16 == 0) near_by = random_below(&source, TRIANGLES - 32);
        const uint32_t *t =
            triangles[together ? near_by + random_below(&source, 32) : random_below(&source, TRIANGLES)];
        uint32_t c = random_below(&source, 3);
        for (int a = 0; a < 3; a++) local[a] = (1 - w) * vertices[t[c]][a] + w * vertices[t[(c + 1) % 3]][a];
        to_world(pose, local, target);
        for (int a = 0; a < 3; a++) target[a] -= eye[a];
        rays[i] = rg_ray_from(eye, target);
    }
}

/* A ray of any direction that leaves on the side from which the first one came. */
static bool meets_again(rg_scene *scene, const rg_ray *ray, const rg_hit *hit) {
    double direction[3], origin[3], along = 0, before = 0;
    rg_hit next;
    random_direction(&source, direction);
    for (int a = 0; a < 3; a++) {
        along += direction[a] * (double)hit->normal[a];
        before += (double)ray->direction[a] * (double)hit->normal[a];
    }
    for (int a = 0; a < 3; a++) {
        if ((along < 0) == (before < 0)) direction[a] = -direction[a];
        double away = (double)hit->offset * (double)hit->normal[a];
        origin[a] = hit->position[a] + (before < 0 ? away : -away);
    }
    const rg_ray from = rg_ray_from(origin, direction);
    demand(rg_scene_trace(scene, &from, &next, 1), "trace");
    return next.t < INFINITY && next.primitive == hit->primitive;
}

static void trace_batch(rg_scene *scene, const rg_ray *rays, counts *n) {
    static rg_hit hits[BATCH];
    static uint8_t any[BATCH];
    demand(rg_scene_trace(scene, rays, hits, BATCH), "trace");
    demand(rg_scene_occluded(scene, rays, any, BATCH), "occluded");
    for (uint32_t i = 0; i < BATCH; i++) {
        uint8_t one_any;
        rg_hit one;
        demand(rg_scene_trace(scene, &rays[i], &one, 1), "trace");
        demand(rg_scene_occluded(scene, &rays[i], &one_any, 1), "occluded");
        bool leak = !(hits[i].t < INFINITY) || !any[i] || !(one.t < INFINITY) || !one_any;
        if (leak && n->leaks == 0)
            fprintf(stderr, "from %a %a %a along %a %a %a: batch %g, any %d, alone %g, any %d\n", rays[i].origin[0],
                    rays[i].origin[1], rays[i].origin[2], (double)rays[i].direction[0], (double)rays[i].direction[1],
                    (double)rays[i].direction[2], hits[i].t, any[i], one.t, one_any);
        n->leaks += leak;
        n->again += hits[i].t < INFINITY && meets_again(scene, &rays[i], &hits[i]);
    }
    n->rays += BATCH;
}

static counts check(rg_shape *shape, int which, double offset, uint64_t rays) {
    static rg_ray batch[BATCH];
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    const rg_pose pose = pose_of(which, offset);
    counts n = {0, 0, 0};
    rg_scene *scene;
    demand(rg_scene_create(&config, &scene), "create");
    demand(rg_scene_insert(scene, shape, &pose, NULL), "insert");
    for (bool together = true; n.rays < rays; together = !together) {
        aim(&pose, together, batch);
        trace_batch(scene, batch, &n);
    }
    demand(rg_scene_destroy(&scene), "destroy");
    printf("pose %d, %g from the origin: %" PRIu64 " rays at edges and vertices, %" PRIu64 " leaks; %" PRIu64
           " met a triangle again\n",
           which, offset, n.rays, n.leaks, n.again);
    return n;
}

int main(int argc, char **argv) {
    static const double OFFSETS[] = {0, 1e3, 1e7};
    uint64_t rays = 2 * BATCH, wrong = 0;
    rg_mesh_views views = {.size = sizeof views, .vertex_count = VERTICES, .triangle_count = TRIANGLES};
    rg_shape *shape;
    if (argc == 3 && strcmp(argv[1], "--rays") == 0) {
        rays = strtoull(argv[2], NULL, 10);
    } else if (argc != 1) {
        fprintf(stderr, "usage: leaks [--rays N]\n");
        return 2;
    }
    make_surface();
    views.vertices = rg_input3_packed(vertices, sizeof *vertices, RG_F64);
    views.indices = rg_input3_packed(triangles, sizeof *triangles, RG_U32);
    demand(rg_shape_create_mesh(NULL, &views, &shape), "mesh");
    for (int o = 0; o < 3; o++) {
        for (int which = 0; which < 3; which++) {
            const counts n = check(shape, which, OFFSETS[o], rays);
            wrong += n.leaks + n.again;
        }
    }
    rg_shape_release(&shape);
    return wrong ? EXIT_FAILURE : EXIT_SUCCESS;
}
