/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double PI = 3.14159265358979323846;
static const double FILLED = 0.05; /* part of the unit cube's volume, overlaps counted twice */

const struct bench_sizes BENCH_SIZES[] = {{"equal", 1, 0}, {"mixed", 1000, 64}, {NULL, 0, 0}};

double bench_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void bench_check(rg_result result) {
    if (result == RG_OK) return;
    fprintf(stderr, "%s: %s\n", rg_result_name(result), rg_error_message());
    exit(1);
}

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

/* In [0, 1). The generator is splitmix64. */
static double next_random(uint64_t *state) {
    uint64_t z = *state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* Evenly on the unit sphere. */
static void random_direction(uint64_t *state, double direction[3]) {
    double z = 2 * next_random(state) - 1, angle = 2 * PI * next_random(state);
    double r = sqrt(1 - z * z);
    direction[0] = r * cos(angle);
    direction[1] = r * sin(angle);
    direction[2] = z;
}

static double clamp(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* ------------------------------------------------------------------------------------------------- scenes */

static void place_evenly(struct bench_scene *scene) {
    for (uint32_t i = 0; i < scene->count; i++) {
        for (int k = 0; k < 3; k++) scene->positions[i][k] = next_random(&scene->random);
    }
}

/* Around each centre the distance is even in [0, 0.15), so the density falls with its square. */
static void place_in_clusters(struct bench_scene *scene, int clusters) {
    double(*centres)[3] = allocate((size_t)clusters, sizeof *centres);
    for (int c = 0; c < clusters; c++) {
        for (int k = 0; k < 3; k++) centres[c][k] = next_random(&scene->random);
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        double direction[3], distance = 0.15 * next_random(&scene->random);
        const double *centre = centres[(int)(clusters * next_random(&scene->random))];
        random_direction(&scene->random, direction);
        for (int k = 0; k < 3; k++) scene->positions[i][k] = clamp(centre[k] + distance * direction[k]);
    }
    free(centres);
}

static void choose_radii(struct bench_scene *scene, double size_range) {
    double cubes = 0;
    for (int s = 0; s < BENCH_SHAPES; s++) {
        scene->radii[s] = pow(size_range, -(double)s / (BENCH_SHAPES - 1));
        cubes += scene->radii[s] * scene->radii[s] * scene->radii[s] / BENCH_SHAPES;
    }
    double largest = cbrt(FILLED * 3 / (4 * PI * cubes * scene->count));
    for (int s = 0; s < BENCH_SHAPES; s++) {
        scene->radii[s] *= largest;
        bench_check(rg_shape_create_sphere(NULL, scene->radii[s], &scene->shapes[s]));
    }
}

void bench_scene_empty(struct bench_scene *scene) {
    rg_grid_config grid;
    rg_scene_config config;
    bench_check(rg_grid_config_default(&grid, sizeof grid));
    bench_check(rg_scene_config_default(&config, sizeof config));
    grid.kind = scene->kind;
    config.grid = &grid;
    config.workers = 1;
    bench_check(rg_scene_destroy(&scene->scene));
    bench_check(rg_scene_create(&config, &scene->scene));
}

struct bench_scene *bench_scene_create(const struct bench_sizes *sizes, rg_grid_kind kind, uint32_t count) {
    struct bench_scene *scene = allocate(1, sizeof *scene);
    scene->kind = kind;
    scene->count = count;
    scene->random = count;
    scene->shape_of = allocate(count, sizeof *scene->shape_of);
    scene->positions = allocate(count, sizeof *scene->positions);
    scene->objects = allocate(count, sizeof *scene->objects);
    scene->order = allocate(count, sizeof *scene->order);
    choose_radii(scene, sizes->size_range);
    if (sizes->clusters) {
        place_in_clusters(scene, sizes->clusters);
    } else {
        place_evenly(scene);
    }
    for (uint32_t i = 0; i < count; i++) {
        scene->shape_of[i] = (uint8_t)(BENCH_SHAPES * next_random(&scene->random));
        scene->order[i] = i;
    }
    bench_scene_empty(scene);
    return scene;
}

void bench_scene_destroy(struct bench_scene *scene) {
    bench_check(rg_scene_destroy(&scene->scene));
    for (int s = 0; s < BENCH_SHAPES; s++) rg_shape_release(&scene->shapes[s]);
    free(scene->shape_of);
    free(scene->positions);
    free(scene->objects);
    free(scene->order);
    free(scene);
}

rg_shape *bench_shape(const struct bench_scene *scene, uint32_t which) {
    return scene->shapes[scene->shape_of[which]];
}

rg_pose bench_pose(const struct bench_scene *scene, uint32_t which) {
    const double *p = scene->positions[which];
    return rg_pose_at(p[0], p[1], p[2]);
}

void bench_step(struct bench_scene *scene, uint32_t which, double step) {
    double direction[3], length = step * scene->radii[scene->shape_of[which]];
    random_direction(&scene->random, direction);
    for (int k = 0; k < 3; k++) scene->positions[which][k] += length * direction[k];
}

void bench_shuffle(struct bench_scene *scene) {
    for (uint32_t i = scene->count - 1; i > 0; i--) {
        uint32_t j = (uint32_t)((i + 1) * next_random(&scene->random));
        uint32_t other = scene->order[j];
        scene->order[j] = scene->order[i];
        scene->order[i] = other;
    }
}

reference_scene *bench_reference(const struct bench_scene *scene) {
    reference_scene *reference = reference_create();
    const reference_shape *shapes[BENCH_SHAPES];
    for (int s = 0; s < BENCH_SHAPES; s++) shapes[s] = reference_sphere(reference, scene->radii[s]);
    for (uint32_t i = 0; i < scene->count; i++) {
        rg_pose pose = bench_pose(scene, i);
        reference_insert(reference, scene->objects[i], shapes[scene->shape_of[i]], &pose, UINT32_MAX);
    }
    return reference;
}

/* --------------------------------------------------------------------------------------------------- rays */

/* The camera stands before the middle of the cube's face z = 0, which just fills the picture. */
static rg_ray camera_ray(int x, int y, int side) {
    const double origin[3] = {0.5, 0.5, -1.2};
    double direction[3] = {(x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5, 1.2};
    return rg_ray_from(origin, direction);
}

rg_ray *bench_primary_rays(int side, int tile) {
    rg_ray *rays = allocate((size_t)side * (size_t)side, sizeof *rays);
    uint64_t random = 1;
    int across = side / tile, tiles = across * across, done = 0;
    int *order = allocate((size_t)tiles, sizeof *order);
    for (int i = 0; i < tiles; i++) {
        int j = (int)((i + 1) * next_random(&random));
        order[i] = order[j];
        order[j] = i;
    }
    for (int i = 0; i < tiles; i++) {
        int x = order[i] % across * tile, y = order[i] / across * tile;
        for (int p = 0; p < tile * tile; p++) rays[done++] = camera_ray(x + p % tile, y + p / tile, side);
    }
    free(order);
    return rays;
}

rg_ray *bench_random_rays(int count) {
    rg_ray *rays = allocate((size_t)count, sizeof *rays);
    uint64_t random = 2;
    for (int i = 0; i < count; i++) {
        double origin[3], direction[3];
        for (int k = 0; k < 3; k++) origin[k] = next_random(&random);
        random_direction(&random, direction);
        rays[i] = rg_ray_from(origin, direction);
    }
    return rays;
}
