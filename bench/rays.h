/* SPDX-License-Identifier: MIT */
/* rays.h: sets of rays, as arrays of floats that both sides read where they lie, and what the sides answer. */
#ifndef RAYGRID_BENCH_RAYS_H
#define RAYGRID_BENCH_RAYS_H

#include "measure.h"
#include "scenes.h"

struct bench_rays {
    const char *name;
    uint32_t count;
    float *origin[3], *direction[3];
    float t_max;   /* the same for all; t_min is 0 */
    bool any;      /* any hit is asked for, not the closest */
    bool coherent; /* neighbours in the set are neighbours in space */
};

/** What a side answers; both write all of it where a set asks for it, and nothing else. */
struct bench_answers {
    float *t;          /* of closest hits; +inf for a miss */
    uint64_t *id;      /* of closest hits, as the side names objects */
    uint8_t *occluded; /* of any-hit sets */
    float *normal[3];  /* of closest hits, of any length, if not NULL; only the peer writes it */
};

/** Room for as many rays. */
struct bench_rays *bench_rays_create(const char *name, uint32_t count, bool any, bool coherent);

/**
 * side * side rays from a camera before the middle of the cube's face z = 0, aimed at the cube, or with `aimed` at
 * the scene's cluster: tiles of 8x8, each in blocks of 4x4, each of those in blocks of 2x2.
 */
struct bench_rays *bench_primary_rays(const struct bench_scene *scene, int side, bool aimed);

/** From where the closest hits of `rays` were to a point light above the cube; misses have none. */
struct bench_rays *bench_shadow_rays(const struct bench_rays *rays, const float *t);

/** The same into rays that have room for as many as `rays`. */
void bench_refill_shadow_rays(struct bench_rays *shadows, const struct bench_rays *rays, const float *t);

/** From anywhere in the cube in any direction; with `aimed` towards anywhere in the scene's cluster. */
struct bench_rays *bench_random_rays(const struct bench_scene *scene, uint32_t count, bool aimed, bool any);

void bench_rays_destroy(struct bench_rays *rays);

/** Moves the origins of all. */
void bench_shift_rays(struct bench_rays *rays, const double by[3]);

rg_ray bench_ray(const struct bench_rays *rays, uint32_t which);

struct bench_answers bench_answers_create(uint32_t count);
void bench_answers_destroy(struct bench_answers *answers);

#endif
