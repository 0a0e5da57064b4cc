/* SPDX-License-Identifier: MIT */
#include "animation.h"

#if defined(BENCH_GLTF)
#include "gltf.h"
#endif
#include "mesh.h"
#include "vectors.h"

#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

enum {
    CHILDREN = 9,  /* of a sphere of the flake */
    AROUND = 6,    /* of them, around its equator; the others on the side away from its parent */
    MESHES = 3,    /* icospheres of 20, 80 and 320 triangles */
    SIZES = 100,   /* from the smallest mesh to the largest */
    SWINGS = 4,    /* of a body, to and fro, from time 0 to 1 */
    ESCAPING = 100 /* one in so many escapes */
};

static const double FILLED = 0.05; /* part of the cube that the crowd fills, as in scenes.c */
static const double FLIGHT = 5; /* what the flake grows by on average; its spheres by half of it to one and a half */
static const double WALK = 3;   /* cubes that a mesh goes at most */

/* -------------------------------------------------------------------------------------------- the flake */

/* Two directions square to the axis and to each other. */
static void around(const double axis[3], double u[3], double v[3]) {
    double least[3] = {0, 0, 0};
    int k = fabs(axis[0]) < fabs(axis[1]) ? 0 : 1;
    if (fabs(axis[2]) < fabs(axis[k])) k = 2;
    least[k] = 1;
    cross(axis, least, u);
    normalise(u);
    cross(axis, u, v);
}

/* Children sit as nine of the twelve neighbours of a sphere in the closest packing: six around it, three on top. */
static void direction_of_child(const double axis[3], uint32_t child, double out[3]) {
    double u[3], v[3], up = 0, angle = PI / 3 * child;
    around(axis, u, v);
    if (child >= AROUND) {
        up = sqrt(2.0 / 3);
        angle = PI / 6 + 2 * PI / 3 * (child - AROUND);
    }
    double out_of_axis = sqrt(1 - up * up);
    for (int k = 0; k < 3; k++) out[k] = up * axis[k] + out_of_axis * (cos(angle) * u[k] + sin(angle) * v[k]);
}

/* Generation by generation, each a third as large as the one before (the "balls" of E. Haines, "A Proposal for
 * Standard Graphics Environments", IEEE CG&A 7(11), 1987): sphere i has the children 9 i + 1 to 9 i + 9. */
static void place_flake(struct bench_scene *scene) {
    double(*axes)[3] = bench_allocate(scene->count, sizeof *axes);
    /* With all generations its radius is twice that of the first sphere. */
    scene->scales[0] = rounded(0.24);
    for (int k = 0; k < 3; k++) scene->positions[0][k] = 0.5;
    axes[0][1] = 1;
    for (uint32_t i = 1; i < scene->count; i++) {
        uint32_t parent = (i - 1) / CHILDREN;
        scene->scales[i] = rounded(scene->scales[parent] / 3);
        direction_of_child(axes[parent], (i - 1) % CHILDREN, axes[i]);
        for (int k = 0; k < 3; k++) {
            double away = (scene->scales[parent] + scene->scales[i]) * axes[i][k];
            scene->positions[i][k] = rounded(scene->positions[parent][k] + away);
        }
    }
    free(axes);
}

static struct bench_scene *empty_scene(const char *name, uint32_t count, int shapes) {
    struct bench_scene *scene = bench_allocate(1, sizeof *scene);
    scene->name = name;
    scene->count = scene->size = count;
    scene->random = count;
    scene->shape_count = shapes;
    scene->shapes = bench_allocate((size_t)shapes, sizeof *scene->shapes);
    scene->positions = bench_allocate(count, sizeof *scene->positions);
    scene->scales = bench_allocate(count, sizeof *scene->scales);
    return scene;
}

static struct bench_scene *create_flake(uint32_t count) {
    struct bench_scene *scene = empty_scene("flake", count, 1);
    scene->shapes[0] = (struct bench_shape){RG_SHAPE_SPHERE, {1, 0, 0}, NULL, 1, 4 * PI / 3};
    place_flake(scene);
    bench_settle(scene);
    return scene;
}

/* -------------------------------------------------------------------------------------------- the crowd */

/* Sizes evenly on a logarithmic scale; the largest so that all together fill their part of the cube. */
static void place_crowd(struct bench_scene *scene) {
    double mean_cube = (1 - pow(SIZES, -3)) / (3 * log(SIZES));
    double largest = fmin(0.25, cbrt(FILLED / (scene->count * 4 * PI / 3 * mean_cube)));
    for (uint32_t i = 0; i < scene->count; i++) {
        double radius = rounded(largest * pow(SIZES, -bench_random(&scene->random)));
        scene->scales[i] = radius;
        for (int k = 0; k < 3; k++) {
            scene->positions[i][k] = rounded(radius + (1 - 2 * radius) * bench_random(&scene->random));
        }
    }
}

static struct bench_scene *create_crowd(uint32_t count) {
    struct bench_scene *scene = empty_scene("crowd", count, MESHES);
    for (int s = 0; s < MESHES; s++) {
        scene->shapes[s] = (struct bench_shape){RG_SHAPE_MESH, {0}, bench_icosphere(s), 1, 4 * PI / 3};
    }
    bench_spread_shapes(scene);
    place_crowd(scene);
    bench_turn_all(scene);
    bench_settle(scene);
    return scene;
}

/* -------------------------------------------------------------------------------------------- the paths */

static void fly_apart(struct animation *a, double flight) {
    struct bench_scene *bodies = a->bodies;
    for (uint32_t i = 0; i < bodies->count; i++) {
        double share = flight * (0.5 + bench_random(&bodies->random));
        for (int k = 0; k < 3; k++) a->ways[i][k] = share * (bodies->homes[i][k] - 0.5);
    }
    a->growth = 1.5 * flight;
}

static void walk(struct animation *a) {
    struct bench_scene *bodies = a->bodies;
    for (uint32_t i = 0; i < a->moving; i++) {
        double direction[3], length = WALK * bench_random(&bodies->random);
        bench_random_direction(&bodies->random, direction);
        for (int k = 0; k < 3; k++) a->ways[i][k] = length * direction[k];
    }
}

static void swing(struct animation *a, double radii) {
    for (uint32_t i = 0; i < a->moving; i++) {
        bench_random_direction(&a->bodies->random, a->swings[i]);
        for (int k = 0; k < 3; k++) a->swings[i][k] *= radii * bench_reach(a->bodies, i);
    }
}

static struct bench_scene *create_bodies(const char *name, uint32_t count) {
    if (strcmp(name, "flake") == 0) return create_flake(count);
    if (strcmp(name, "crowd") == 0) return create_crowd(count);
    if (strcmp(name, "equal") == 0 || strcmp(name, "escape") == 0) return bench_scene_create("uniform", count);
#if defined(BENCH_GLTF)
    if (strcmp(name, "engine") == 0) return bench_gltf_scene(bench_gltf_usual());
#endif
    return NULL;
}

struct animation *animation_create(const char *name, uint32_t count) {
    struct bench_scene *bodies = create_bodies(name, count);
    if (!bodies) return NULL;
    struct animation *a = bench_allocate(1, sizeof *a);
    bodies->name = name;
    a->bodies = bodies;
    a->ways = bench_allocate(bodies->count, sizeof *a->ways);
    a->swings = bench_allocate(bodies->count, sizeof *a->swings);
    a->moving = bodies->count;
    if (strcmp(name, "crowd") == 0) {
        walk(a);
        swing(a, 2);
        a->growth = 2 * WALK;
    } else if (strcmp(name, "equal") == 0) {
        swing(a, 2);
    } else if (strcmp(name, "escape") == 0) {
        a->moving = bodies->count / ESCAPING;
        walk(a);
    } else {
        fly_apart(a, FLIGHT);
    }
    return a;
}

void animation_destroy(struct animation *animation) {
    if (!animation) return;
    bench_scene_destroy(animation->bodies);
    free(animation->ways);
    free(animation->swings);
    free(animation);
}

void animation_go(struct animation *animation, double time) {
    struct bench_scene *bodies = animation->bodies;
    double aside = sin(2 * PI * SWINGS * time);
    for (uint32_t i = 0; i < animation->moving; i++) {
        for (int k = 0; k < 3; k++) {
            double moved = time * animation->ways[i][k] + aside * animation->swings[i][k];
            bodies->positions[i][k] = rounded(bodies->homes[i][k] + moved);
        }
    }
}

void animation_look(const struct animation *animation, double time, const struct bench_rays *cube,
                    struct bench_rays *rays) {
    float scale = (float)(1 + time * animation->growth);
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < cube->count; i++) {
            rays->origin[k][i] = 0.5f + scale * (cube->origin[k][i] - 0.5f);
            rays->direction[k][i] = scale * cube->direction[k][i];
        }
    }
}
