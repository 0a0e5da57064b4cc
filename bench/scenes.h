/* SPDX-License-Identifier: MIT */
/* scenes.h: the scenes, rays and clock that the benchmarks share. Failures of the library end the benchmark. */
#ifndef RAYGRID_BENCH_SCENES_H
#define RAYGRID_BENCH_SCENES_H

#include <raygrid/raygrid.h>
#include <reference.h>
#include <stdbool.h>

/** How large spheres are and where they lie; all in the unit cube, 5 % of its volume filled. */
struct bench_sizes {
    const char *name;  /* NULL ends the list */
    double size_range; /* largest radius / smallest, spread evenly on a logarithmic scale */
    int clusters;      /* 0: centres spread evenly over the cube */
};

extern const struct bench_sizes BENCH_SIZES[];

enum { BENCH_SHAPES = 64 };

/** Spheres in a scene with one grid of one kind, and what the host knows of them. */
struct bench_scene {
    rg_scene *scene;
    rg_grid_kind kind;
    uint32_t count;
    rg_shape *shapes[BENCH_SHAPES]; /* of falling radius */
    double radii[BENCH_SHAPES];
    uint8_t *shape_of;      /* of each object: index into shapes */
    double (*positions)[3]; /* of each object */
    rg_object *objects;
    uint32_t *order; /* the numbers 0 to count - 1, in any order */
    uint64_t random;
};

/** Chooses the spheres; the scene stays empty. */
struct bench_scene *bench_scene_create(const struct bench_sizes *sizes, rg_grid_kind kind, uint32_t count);
void bench_scene_destroy(struct bench_scene *scene);

/** Puts a new, empty scene in the place of the present one. */
void bench_scene_empty(struct bench_scene *scene);

rg_shape *bench_shape(const struct bench_scene *scene, uint32_t which);
rg_pose bench_pose(const struct bench_scene *scene, uint32_t which);

/** Moves the position of a sphere, not yet the object, by `step` of its radius in a random direction. */
void bench_step(struct bench_scene *scene, uint32_t which, double step);
void bench_shuffle(struct bench_scene *scene);

/** The same objects for brute force. */
reference_scene *bench_reference(const struct bench_scene *scene);

/** side * side rays from a camera that sees the whole cube, in square tiles, the tiles in random order. */
rg_ray *bench_primary_rays(int side, int tile);

/** Rays from anywhere in the cube in any direction. */
rg_ray *bench_random_rays(int count);

/** Seconds since some time in the past. */
double bench_seconds(void);

/** Prints what was wrong and ends the benchmark, unless the result is RG_OK. */
void bench_check(rg_result result);

#endif
