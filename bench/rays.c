/* SPDX-License-Identifier: MIT */
#include "rays.h"

#include <math.h>
#include <stdlib.h>

static const double EYE[3] = {0.5, 0.5, -1.2};
static const double LIGHT[3] = {-0.4, 2.0, -0.7};

/* How far before a surface its shadow ray starts, in parts of the distance: some ten roundings of a float. */
static const float BEFORE_SURFACE = 1e-6f;

enum { TILE = 8 };

struct bench_rays *bench_rays_create(const char *name, uint32_t count, bool any, bool coherent) {
    struct bench_rays *rays = bench_allocate(1, sizeof *rays);
    rays->name = name;
    rays->count = count;
    rays->t_max = INFINITY;
    rays->any = any;
    rays->coherent = coherent;
    for (int k = 0; k < 3; k++) {
        rays->origin[k] = bench_allocate(count, sizeof(float));
        rays->direction[k] = bench_allocate(count, sizeof(float));
    }
    return rays;
}

void bench_rays_destroy(struct bench_rays *rays) {
    if (!rays) return;
    for (int k = 0; k < 3; k++) {
        free(rays->origin[k]);
        free(rays->direction[k]);
    }
    free(rays);
}

/* Bits 0, 2 and 4 of the number, put together. */
static int even_bits(int number) {
    return (number & 1) | (number >> 1 & 2) | (number >> 2 & 4);
}

struct bench_rays *bench_primary_rays(const struct bench_scene *scene, int side, bool aimed) {
    struct bench_rays *rays =
        bench_rays_create(aimed ? "aimed primary" : "primary", (uint32_t)(side * side), false, true);
    double lo[3] = {0, 0, 0}, hi[3] = {1, 1, 0};
    for (int k = 0; aimed && k < 3; k++) {
        lo[k] = scene->aim_lo[k];
        hi[k] = scene->aim_hi[k];
    }
    for (uint32_t i = 0; i < rays->count; i++) {
        int tile = (int)i / (TILE * TILE), within = (int)i % (TILE * TILE), across = side / TILE;
        int x = tile % across * TILE + even_bits(within), y = tile / across * TILE + even_bits(within >> 1);
        const double target[3] = {lo[0] + (hi[0] - lo[0]) * (x + 0.5) / side,
                                  lo[1] + (hi[1] - lo[1]) * (y + 0.5) / side, lo[2]};
        for (int k = 0; k < 3; k++) {
            rays->origin[k][i] = (float)EYE[k];
            rays->direction[k][i] = (float)(target[k] - EYE[k]);
        }
    }
    return rays;
}

void bench_refill_shadow_rays(struct bench_rays *shadows, const struct bench_rays *rays, const float *t) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        if (!(t[i] < INFINITY)) continue;
        float before = t[i] * (1 - BEFORE_SURFACE);
        for (int k = 0; k < 3; k++) {
            float from = rays->origin[k][i] + before * rays->direction[k][i];
            shadows->origin[k][count] = from;
            shadows->direction[k][count] = (float)LIGHT[k] - from;
        }
        count++;
    }
    shadows->count = count;
}

struct bench_rays *bench_shadow_rays(const struct bench_rays *rays, const float *t) {
    struct bench_rays *shadows = bench_rays_create("shadow", rays->count, true, true);
    shadows->t_max = 1;
    bench_refill_shadow_rays(shadows, rays, t);
    return shadows;
}

static const char *name_of_random(bool aimed, bool any) {
    if (aimed) return any ? "aimed random any" : "aimed random";
    return any ? "random any" : "random";
}

struct bench_rays *bench_random_rays(const struct bench_scene *scene, uint32_t count, bool aimed, bool any) {
    struct bench_rays *rays = bench_rays_create(name_of_random(aimed, any), count, any, false);
    uint64_t random = 2;
    for (uint32_t i = 0; i < count; i++) {
        double origin[3], direction[3];
        for (int k = 0; k < 3; k++) origin[k] = bench_random(&random);
        bench_random_direction(&random, direction);
        for (int k = 0; k < 3; k++) {
            double share = bench_random(&random);
            if (aimed) direction[k] = scene->aim_lo[k] + share * (scene->aim_hi[k] - scene->aim_lo[k]) - origin[k];
            rays->origin[k][i] = (float)origin[k];
            rays->direction[k][i] = (float)direction[k];
        }
    }
    return rays;
}

void bench_shift_rays(struct bench_rays *rays, const double by[3]) {
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < rays->count; i++) rays->origin[k][i] = (float)(rays->origin[k][i] + by[k]);
    }
}

rg_ray bench_ray(const struct bench_rays *rays, uint32_t which) {
    rg_ray ray = {.t_max = (double)rays->t_max, .mask = UINT32_MAX};
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = (double)rays->origin[k][which];
        ray.direction[k] = (double)rays->direction[k][which];
    }
    return ray;
}

struct bench_answers bench_answers_create(uint32_t count) {
    return (struct bench_answers){bench_allocate(count, sizeof(float)),
                                  bench_allocate(count, sizeof(uint64_t)),
                                  bench_allocate(count, 1),
                                  {NULL, NULL, NULL}};
}

void bench_answers_destroy(struct bench_answers *answers) {
    free(answers->t);
    free(answers->id);
    free(answers->occluded);
    for (int k = 0; k < 3; k++) free(answers->normal[k]);
}
