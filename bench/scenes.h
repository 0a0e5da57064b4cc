/* SPDX-License-Identifier: MIT */
/*
 * scenes.h: what is measured: objects in the unit cube, 5 % of it filled (overlaps counted twice).
 *
 * All numbers are floats, kept as double: raygrid and a peer that knows no double then have the same scene to the
 * last bit, and both can be held against the same exact answers.
 */
#ifndef RAYGRID_BENCH_SCENES_H
#define RAYGRID_BENCH_SCENES_H

#include <raygrid/raygrid.h>
#include <stdbool.h>

/** The triangles of a mesh, indexed. */
struct bench_mesh {
    float *vertices; /* x, y, z */
    uint32_t vertex_count;
    uint32_t *corners; /* three a triangle */
    uint32_t triangle_count;
};

/** A shape around its local origin. */
struct bench_shape {
    rg_shape_kind kind;
    double size[3]; /* sphere: radius; box: half its sides; capsule: half its segment, along x, and its radius */
    struct bench_mesh *mesh;
    double reach; /* the farthest point from the origin */
    double volume;
};

enum { BENCH_SHAPES = 256 }; /* of a scene, at most */

struct bench_scene {
    const char *name;
    uint32_t count;
    uint32_t size; /* as lines name it: objects, or of a scene of one mesh triangles */
    struct bench_shape *shapes;
    int shape_count;
    uint8_t *shape_of;           /* of each object; NULL: all have the first */
    double (*positions)[3];      /* of each object */
    double (*homes)[3];          /* where it was at first */
    double *scales;              /* of each object */
    float (*linears)[9];         /* of each object; NULL: none is turned */
    double aim_lo[3], aim_hi[3]; /* of its cluster, where it has one that rays are aimed at */
    bool has_aim;
    bool one_mesh; /* and nothing else */
    uint64_t random;
};

/** The names of the scenes that come in any size, NULL at the end. */
extern const char *const BENCH_SCENES[];

/** One of BENCH_SCENES. */
struct bench_scene *bench_scene_create(const char *name, uint32_t count);

/** That mesh, which the scene takes over and which fills the unit cube, and nothing else; `size` as lines name it. */
struct bench_scene *bench_scene_of_mesh(const char *name, uint32_t size, struct bench_mesh *mesh);

/* For those who make a scene: gives each body one of the shapes; turns all but spheres, which no host would turn;
 * makes the present positions the homes. */
void bench_spread_shapes(struct bench_scene *scene);
void bench_turn_all(struct bench_scene *scene);
void bench_settle(struct bench_scene *scene);

void bench_scene_destroy(struct bench_scene *scene);

static inline const struct bench_shape *bench_shape_of(const struct bench_scene *scene, uint32_t which) {
    return &scene->shapes[scene->shape_of ? scene->shape_of[which] : 0];
}

/** The radius of an object around its position. */
static inline double bench_reach(const struct bench_scene *scene, uint32_t which) {
    return bench_shape_of(scene, which)->reach * scene->scales[which];
}

rg_pose bench_pose(const struct bench_scene *scene, uint32_t which);

/** Whether it is one mesh and nothing else. */
bool bench_is_one_mesh(const struct bench_scene *scene);

/** Whether every object is a sphere. */
bool bench_all_spheres(const struct bench_scene *scene);

/** The point `step` of the object's radius away from its position in a random direction, in floats. */
void bench_step(struct bench_scene *scene, uint32_t which, double step, double position[3]);

/** The same, but back towards its home if it is more than two radii from there: the scene stays what it is. */
void bench_step_near_home(struct bench_scene *scene, uint32_t which, double step, double position[3]);

/** `count` different objects in random order; free() the result. */
uint32_t *bench_choose(struct bench_scene *scene, uint32_t count);

#endif
