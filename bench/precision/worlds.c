/* SPDX-License-Identifier: MIT */
#include "worlds.h"

#include "measure.h"
#include "mesh.h"
#include "vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const WORLDS[] = {"ordinary", "huge", "tiny beside huge", "slivers", "grazing", NULL};

enum { FORMS = 4, BLADES = 5, STRIPS = 12, HUGE_ONES = 8, MESH_LEVELS = 0 };

static const double FILLED = 0.05; /* part of the cube that the objects' balls fill */
static const double HUGE_RADIUS = 1e6;

static double between(uint64_t *random, double lo, double hi) {
    return lo + (hi - lo) * bench_random(random);
}

/* ------------------------------------------------------------------------------------------------- shapes */

static struct bench_shape box(uint64_t *random) {
    struct bench_shape shape = {.kind = RG_SHAPE_BOX, .size = {1, 0, 0}};
    for (int k = 1; k < 3; k++) shape.size[k] = rounded(between(random, 0.1, 1));
    const double *s = shape.size;
    shape.reach = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    return shape;
}

static struct bench_shape capsule(uint64_t *random) {
    struct bench_shape shape = {.kind = RG_SHAPE_CAPSULE, .size = {1, rounded(between(random, 0.02, 1)), 0}};
    shape.reach = shape.size[0] + shape.size[1];
    return shape;
}

/* A sheet of long thin triangles of that width, side by side along x, each 1 long along y, a little out of flat. */
static struct bench_shape blade(double width, uint64_t *random) {
    struct bench_mesh *mesh = bench_allocate(1, sizeof *mesh);
    mesh->vertex_count = 2 * (STRIPS + 1);
    mesh->triangle_count = 2 * STRIPS;
    mesh->vertices = bench_allocate(3 * (size_t)mesh->vertex_count + 1, sizeof *mesh->vertices);
    mesh->corners = bench_allocate(3 * (size_t)mesh->triangle_count, sizeof *mesh->corners);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float *vertex = &mesh->vertices[3 * (size_t)i];
        vertex[0] = (float)(width * (i / 2 - 0.5 * STRIPS));
        vertex[1] = i % 2 ? 0.5f : -0.5f;
        vertex[2] = (float)(width * bench_random(random));
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t corners[3] = {i, i % 2 ? i + 2 : i + 1, i % 2 ? i + 1 : i + 2};
        memcpy(&mesh->corners[3 * (size_t)i], corners, sizeof corners);
    }
    double half = 0.5 * STRIPS * width;
    return (struct bench_shape){RG_SHAPE_MESH, {half, 0.5, width}, mesh, sqrt(half * half + 0.25 + width * width), 0};
}

/* --------------------------------------------------------------------------------------------- the worlds */

static void scatter(struct bench_scene *bodies, uint32_t first) {
    for (uint32_t i = first; i < bodies->count; i++) {
        for (int k = 0; k < 3; k++) bodies->positions[i][k] = rounded(bench_random(&bodies->random));
        bodies->shape_of[i] = (uint8_t)(bodies->shape_count * bench_random(&bodies->random));
    }
}

/* Of one size on average, so that their balls fill their part of the cube. */
static void size_evenly(struct bench_scene *bodies) {
    double radius = cbrt(FILLED / (4.18879 * bodies->count));
    for (uint32_t i = 0; i < bodies->count; i++) {
        bodies->scales[i] = 1;
        double factor = radius / bench_reach(bodies, i);
        bodies->scales[i] = rounded(factor * between(&bodies->random, 0.5, 1.5));
    }
}

/* Rows of floats that are orthogonal but for their rounding. Spheres stay as they are. */
static void turn(struct bench_scene *bodies) {
    bodies->linears = bench_allocate(bodies->count, sizeof *bodies->linears);
    for (uint32_t i = 0; i < bodies->count; i++) {
        double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        if (bench_shape_of(bodies, i)->kind != RG_SHAPE_SPHERE) {
            double other[3];
            bench_random_direction(&bodies->random, rows[0]);
            bench_random_direction(&bodies->random, other);
            cross(rows[0], other, rows[1]);
            normalise(rows[1]);
            cross(rows[0], rows[1], rows[2]);
        }
        for (int k = 0; k < 9; k++) bodies->linears[i][k] = (float)rows[k / 3][k % 3];
    }
}

static void make_ordinary(struct world *world) {
    struct bench_scene *bodies = world->bodies;
    struct bench_shape sphere = {RG_SHAPE_SPHERE, {1, 0, 0}, NULL, 1, 0};
    struct bench_shape mesh = {RG_SHAPE_MESH, {0}, bench_icosphere(MESH_LEVELS), 1, 0};
    for (int i = 0; i < FORMS; i++) {
        bodies->shapes[bodies->shape_count++] = sphere;
        bodies->shapes[bodies->shape_count++] = box(&bodies->random);
        bodies->shapes[bodies->shape_count++] = capsule(&bodies->random);
    }
    bodies->shapes[bodies->shape_count++] = mesh;
    scatter(bodies, 0);
    size_evenly(bodies);
    turn(bodies);
    world->nearest = 0.5;
    world->farthest = strcmp(world->name, "grazing") == 0 ? 8 : 3;
    world->aim = strcmp(world->name, "grazing") == 0 ? WORLD_AT_RIMS : WORLD_ANYWHERE;
}

static void make_slivers(struct world *world) {
    struct bench_scene *bodies = world->bodies;
    for (int i = 0; i < BLADES; i++) {
        bodies->shapes[bodies->shape_count++] = blade(pow(10, -3 - i), &bodies->random);
    }
    scatter(bodies, 0);
    size_evenly(bodies);
    turn(bodies);
    world->nearest = 0;
    world->farthest = 2;
    world->aim = WORLD_AT_BOTH;
}

/* The first ones, or all, are so large that of each only a piece of its surface lies in the cube, as good as flat. */
static void make_huge(struct world *world, bool tiny) {
    struct bench_scene *bodies = world->bodies;
    bodies->shapes[bodies->shape_count++] = (struct bench_shape){RG_SHAPE_SPHERE, {1, 0, 0}, NULL, 1, 0};
    scatter(bodies, 0);
    world->side = tiny ? 1 : 100;
    for (uint32_t i = 0; i < bodies->count; i++) {
        double outward[3];
        bench_random_direction(&bodies->random, outward);
        bool large = !tiny || i < HUGE_ONES;
        bodies->scales[i] = rounded(large ? HUGE_RADIUS * between(&bodies->random, 0.5, 2)
                                          : pow(10, between(&bodies->random, -6, -2)));
        for (int k = 0; k < 3; k++) {
            double at = bodies->positions[i][k] * world->side;
            bodies->positions[i][k] = rounded(large ? at + bodies->scales[i] * outward[k] : at);
        }
    }
    world->aim_first = tiny && bodies->count > HUGE_ONES ? HUGE_ONES : 0;
    world->aim = tiny ? WORLD_AT_BOTH : WORLD_AT_RIMS;
    world->nearest = tiny ? 0.2 : -6;
    world->farthest = tiny ? 2 : -2;
}

struct world *world_create(const char *name, uint32_t count, double offset, uint64_t seed) {
    struct world *world = bench_allocate(1, sizeof *world);
    struct bench_scene *bodies = bench_allocate(1, sizeof *bodies);
    world->name = bodies->name = name;
    world->bodies = bodies;
    world->side = 1;
    /* Every ray may meet each of the huge ones: more would show nothing more. */
    bodies->count = strcmp(name, "huge") == 0 && count > HUGE_ONES ? HUGE_ONES : count;
    bodies->random = seed;
    bodies->shapes = bench_allocate(BENCH_SHAPES, sizeof *bodies->shapes);
    bodies->shape_of = bench_allocate(count, sizeof *bodies->shape_of);
    bodies->positions = bench_allocate(count, sizeof *bodies->positions);
    bodies->scales = bench_allocate(count, sizeof *bodies->scales);
    if (strcmp(name, "slivers") == 0) {
        make_slivers(world);
    } else if (strcmp(name, "huge") == 0 || strcmp(name, "tiny beside huge") == 0) {
        make_huge(world, strcmp(name, "huge") != 0);
    } else {
        make_ordinary(world);
    }
    /* Not the same on all axes: nothing must be right by symmetry. */
    const double by[3] = {offset, -0.71 * offset, 0.13 * offset};
    for (int k = 0; k < 3; k++) {
        world->offset[k] = by[k];
        for (uint32_t i = 0; i < bodies->count; i++) bodies->positions[i][k] += by[k];
    }
    return world;
}

void world_destroy(struct world *world) {
    if (!world) return;
    bench_scene_destroy(world->bodies);
    free(world);
}

/* --------------------------------------------------------------------------------------------------- rays */

/* A point of a body's edge, or of a segment inside a round one, local. */
static void point_of_edge(const struct bench_shape *shape, uint64_t *random, double point[3]) {
    double along = bench_random(random);
    if (shape->kind == RG_SHAPE_MESH) {
        uint32_t corner = (uint32_t)(3 * (double)shape->mesh->triangle_count * bench_random(random));
        uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
        const float *a = &shape->mesh->vertices[3 * (size_t)shape->mesh->corners[corner]];
        const float *b = &shape->mesh->vertices[3 * (size_t)shape->mesh->corners[next]];
        if (along > 0.9) along = 1; /* a vertex */
        for (int k = 0; k < 3; k++) point[k] = (double)a[k] + along * ((double)b[k] - (double)a[k]);
    } else if (shape->kind == RG_SHAPE_BOX) {
        int axis = (int)(3 * bench_random(random));
        for (int k = 0; k < 3; k++) point[k] = bench_random(random) < 0.5 ? -shape->size[k] : shape->size[k];
        if (along < 0.9) point[axis] = shape->size[axis] * between(random, -1, 1);
    } else {
        for (int k = 0; k < 3; k++) point[k] = 0;
        if (shape->kind == RG_SHAPE_CAPSULE) point[0] = shape->size[0] * between(random, -1, 1);
    }
}

static void to_world(const struct bench_scene *bodies, uint32_t body, const double local[3], double out[3]) {
    for (int r = 0; r < 3; r++) {
        const float *row = bodies->linears ? &bodies->linears[body][3 * r] : NULL;
        double turned =
            row ? (double)row[0] * local[0] + (double)row[1] * local[1] + (double)row[2] * local[2] : local[r];
        out[r] = bodies->scales[body] * turned;
    }
}

/* From a body to the middle of the cube. */
static void to_middle(const struct world *world, uint32_t body, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = world->offset[k] - world->bodies->positions[body][k] + 0.5 * world->side;
}

/* Across the way, out of the body's axis if it is a capsule: there the silhouette is. Towards the other objects, if
 * the body is far larger than the room that they have. */
static void across(const struct world *world, uint32_t body, const double way[3], uint64_t *random, double out[3]) {
    const struct bench_scene *bodies = world->bodies;
    double guide[3];
    bench_random_direction(random, guide);
    if (bench_reach(bodies, body) > 10 * world->side) {
        double outward[3], spread = 2e-5;
        to_middle(world, body, outward);
        normalise(outward);
        for (int k = 0; k < 3; k++) guide[k] = outward[k] + spread * guide[k];
        double along = guide[0] * way[0] + guide[1] * way[1] + guide[2] * way[2];
        for (int k = 0; k < 3; k++) out[k] = guide[k] - along * way[k];
        normalise(out);
        return;
    }
    if (bench_shape_of(bodies, body)->kind == RG_SHAPE_CAPSULE && bench_random(random) < 0.7) {
        to_world(bodies, body, (const double[3]){1, 0, 0}, guide);
    }
    cross(way, guide, out);
    normalise(out);
}

/* The direction in which a ray at a rim goes: any; past a very large body along its surface in the cube. */
static void way_at_rim(const struct world *world, uint32_t body, uint64_t *random, double way[3]) {
    const struct bench_scene *bodies = world->bodies;
    bench_random_direction(random, way);
    if (bench_reach(bodies, body) <= 10 * world->side) return;
    double outward[3], turned[3];
    to_middle(world, body, outward);
    cross(outward, way, turned);
    normalise(turned);
    memcpy(way, turned, sizeof turned);
}

/* A ray past a body, or through it. All is reckoned relative to the body, so that the aim is as fine as doubles near
 * it are, wherever it lies: only the origin is rounded, and the direction starts from what that became. */
static rg_ray aimed(const struct world *world, bool at_rim, uint64_t *random) {
    const struct bench_scene *bodies = world->bodies;
    uint32_t targets = bodies->count - world->aim_first;
    uint32_t body = world->aim_first + (uint32_t)((double)targets * bench_random(random));
    const struct bench_shape *shape = bench_shape_of(bodies, body);
    double reach = bench_reach(bodies, body), way[3], point[3], target[3], side[3];
    double off = pow(10, -between(random, 1, 15)) * (bench_random(random) < 0.5 ? -1 : 1);
    way_at_rim(world, body, random, way);
    across(world, body, way, random, side);
    point_of_edge(shape, random, point);
    if (!at_rim && shape->kind == RG_SHAPE_MESH) {
        for (int k = 0; k < 2; k++) point[k] = 1.05 * shape->size[k] * between(random, -1, 1);
    }
    to_world(bodies, body, point, target);
    bool round = shape->kind == RG_SHAPE_SPHERE || shape->kind == RG_SHAPE_CAPSULE;
    double radius = shape->kind == RG_SHAPE_CAPSULE ? shape->size[1] * bodies->scales[body] : reach;
    double aside = round ? radius * (at_rim ? 1 + off : between(random, 0, 1.2)) : at_rim ? reach * off : 0;
    double distance = reach * pow(10, between(random, world->nearest, world->farthest));
    rg_ray ray = {.t_max = INFINITY, .mask = UINT32_MAX};
    for (int k = 0; k < 3; k++) {
        double position = bodies->positions[body][k];
        target[k] += aside * side[k];
        ray.origin[k] = position + (target[k] - distance * way[k]);
        if (world->floats) ray.origin[k] = rounded(ray.origin[k]);
        ray.direction[k] = target[k] - (ray.origin[k] - position);
        if (world->floats) ray.direction[k] = rounded(ray.direction[k]);
    }
    return ray;
}

rg_ray world_ray(const struct world *world, uint64_t *random) {
    if (world->aim != WORLD_ANYWHERE) {
        return aimed(world, world->aim == WORLD_AT_RIMS || bench_random(random) < 0.5, random);
    }
    rg_ray ray = {.t_max = INFINITY, .mask = UINT32_MAX};
    bench_random_direction(random, ray.direction);
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = world->offset[k] + rounded(world->side * bench_random(random));
        ray.direction[k] = rounded(ray.direction[k]);
    }
    return ray;
}
