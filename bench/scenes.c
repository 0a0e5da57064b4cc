/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#include "measure.h"
#include "mesh.h"
#include "vectors.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double FILLED = 0.05; /* part of the volume, overlaps counted twice */

enum { CLUSTERS = 64, BIG_ONES = 10, MESH_LEVELS = 4, FORMS = 16 };

const char *const BENCH_SCENES[] = {"uniform", "mixed",  "stadium", "boxes", "capsules",
                                    "mixture", "meshes", "noisy",   "soup",  NULL};

static double clamp(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static double between(uint64_t *random, double lo, double hi) {
    return lo + (hi - lo) * bench_random(random);
}

/* ------------------------------------------------------------------------------------------------- shapes */

static struct bench_shape sphere(void) {
    return (struct bench_shape){RG_SHAPE_SPHERE, {1, 0, 0}, NULL, 1, 4 * PI / 3};
}

/* Sides in the ratio of up to 1:4. */
static struct bench_shape box(uint64_t *random) {
    struct bench_shape shape = {.kind = RG_SHAPE_BOX};
    for (int k = 0; k < 3; k++) shape.size[k] = rounded(exp2(between(random, -1, 1)));
    const double *s = shape.size;
    shape.reach = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    shape.volume = 8 * s[0] * s[1] * s[2];
    return shape;
}

/* Up to three times as long as wide. */
static struct bench_shape capsule(uint64_t *random) {
    struct bench_shape shape = {.kind = RG_SHAPE_CAPSULE};
    shape.size[0] = rounded(between(random, 0.5, 2));
    shape.size[1] = 1;
    shape.reach = shape.size[0] + shape.size[1];
    shape.volume = PI * (2 * shape.size[0] + 4.0 / 3);
    return shape;
}

static struct bench_shape mesh(void) {
    return (struct bench_shape){RG_SHAPE_MESH, {0}, bench_icosphere(MESH_LEVELS), 1, 4 * PI / 3};
}

/* ----------------------------------------------------------------------------------------------- placing */

static void place_evenly(struct bench_scene *scene, uint32_t first, const double lo[3], const double hi[3]) {
    for (uint32_t i = first; i < scene->count; i++) {
        for (int k = 0; k < 3; k++) scene->positions[i][k] = rounded(between(&scene->random, lo[k], hi[k]));
    }
}

/* Around each centre the distance is even in [0, 0.15), so the density falls with its square. */
static void place_in_clusters(struct bench_scene *scene) {
    double centres[CLUSTERS][3];
    for (int c = 0; c < CLUSTERS; c++) {
        for (int k = 0; k < 3; k++) centres[c][k] = bench_random(&scene->random);
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        double direction[3], distance = 0.15 * bench_random(&scene->random);
        const double *centre = centres[(int)(CLUSTERS * bench_random(&scene->random))];
        bench_random_direction(&scene->random, direction);
        for (int k = 0; k < 3; k++) {
            scene->positions[i][k] = rounded(clamp(centre[k] + distance * direction[k]));
        }
    }
}

/* Gives the objects from `first` on one common factor, so that they fill their part of `volume`. */
static void fill(struct bench_scene *scene, uint32_t first, double volume) {
    double sum = 0;
    for (uint32_t i = first; i < scene->count; i++) {
        sum += bench_shape_of(scene, i)->volume * pow(scene->scales[i], 3);
    }
    double factor = cbrt(FILLED * volume / sum);
    for (uint32_t i = first; i < scene->count; i++) scene->scales[i] = rounded(factor * scene->scales[i]);
}

/* A rotation by a random unit quaternion. */
static void turn(uint64_t *random, float m[9]) {
    double axis[3], half = PI * bench_random(random);
    bench_random_direction(random, axis);
    double w = cos(half), x = sin(half) * axis[0], y = sin(half) * axis[1], z = sin(half) * axis[2];
    const double rotation[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                                2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                                2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int k = 0; k < 9; k++) m[k] = (float)rotation[k];
}

void bench_turn_all(struct bench_scene *scene) {
    static const float STRAIGHT[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    scene->linears = bench_allocate(scene->count, sizeof *scene->linears);
    for (uint32_t i = 0; i < scene->count; i++) {
        if (bench_shape_of(scene, i)->kind == RG_SHAPE_SPHERE) {
            memcpy(scene->linears[i], STRAIGHT, sizeof STRAIGHT);
        } else {
            turn(&scene->random, scene->linears[i]);
        }
    }
}

void bench_spread_shapes(struct bench_scene *scene) {
    scene->shape_of = bench_allocate(scene->count, sizeof *scene->shape_of);
    for (uint32_t i = 0; i < scene->count; i++) {
        scene->shape_of[i] = (uint8_t)(scene->shape_count * bench_random(&scene->random));
    }
}

/* ------------------------------------------------------------------------------------------------- scenes */

static const double UNIT_LO[3] = {0, 0, 0}, UNIT_HI[3] = {1, 1, 1};

static void add_shape(struct bench_scene *scene, struct bench_shape shape) {
    scene->shapes[scene->shape_count++] = shape;
}

/* Radii 1:1000, evenly on a logarithmic scale. */
static void make_mixed(struct bench_scene *scene) {
    add_shape(scene, sphere());
    place_in_clusters(scene);
    for (uint32_t i = 0; i < scene->count; i++) scene->scales[i] = pow(1000, -bench_random(&scene->random));
    fill(scene, 0, 1);
}

/* The cluster keeps clear of the big spheres, so that rays see it. */
static bool touches_big_ones(const struct bench_scene *scene, const double lo[3], double side) {
    for (int i = 0; i < BIG_ONES; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++) square += pow(scene->positions[i][k] - lo[k] - side / 2, 2);
        if (sqrt(square) < scene->scales[i] + 2 * side) return true;
    }
    return false;
}

/* Ten spheres that fill their part of the cube, all others in a cube of 1/100 its side. */
static void make_stadium(struct bench_scene *scene) {
    const double side = 0.01;
    uint32_t count = scene->count;
    add_shape(scene, sphere());
    scene->count = BIG_ONES;
    place_evenly(scene, 0, UNIT_LO, UNIT_HI);
    fill(scene, 0, 1);
    scene->count = count;
    do {
        for (int k = 0; k < 3; k++) {
            scene->aim_lo[k] = between(&scene->random, 0.3, 0.7);
            scene->aim_hi[k] = scene->aim_lo[k] + side;
        }
    } while (touches_big_ones(scene, scene->aim_lo, side));
    scene->has_aim = true;
    place_evenly(scene, BIG_ONES, scene->aim_lo, scene->aim_hi);
    fill(scene, BIG_ONES, side * side * side);
}

/* Shapes of the kinds asked for, of like size, evenly spread. */
static void make_even(struct bench_scene *scene) {
    bool mixture = strcmp(scene->name, "mixture") == 0;
    if (strcmp(scene->name, "uniform") == 0) {
        add_shape(scene, sphere());
    } else if (strcmp(scene->name, "meshes") == 0) {
        add_shape(scene, mesh());
    } else if (mixture) {
        add_shape(scene, mesh());
        for (int i = 0; i < 3; i++) add_shape(scene, sphere());
    }
    for (int i = 0; mixture && i < 3; i++) add_shape(scene, box(&scene->random));
    for (int i = 0; mixture && i < 3; i++) add_shape(scene, capsule(&scene->random));
    while (strcmp(scene->name, "boxes") == 0 && scene->shape_count < FORMS) {
        add_shape(scene, box(&scene->random));
    }
    while (strcmp(scene->name, "capsules") == 0 && scene->shape_count < FORMS) {
        add_shape(scene, capsule(&scene->random));
    }
    if (scene->shape_count > 1) bench_spread_shapes(scene);
    place_evenly(scene, 0, UNIT_LO, UNIT_HI);
    fill(scene, 0, 1);
    if (strcmp(scene->name, "uniform") != 0) bench_turn_all(scene);
}

void bench_settle(struct bench_scene *scene) {
    scene->homes = bench_allocate(scene->count, sizeof *scene->homes);
    memcpy(scene->homes, scene->positions, scene->count * sizeof *scene->homes);
}

static struct bench_scene *allocate_scene(const char *name, uint32_t size, uint32_t count) {
    struct bench_scene *scene = bench_allocate(1, sizeof *scene);
    scene->name = name;
    scene->size = size;
    scene->count = count;
    scene->random = count;
    scene->shapes = bench_allocate(FORMS, sizeof *scene->shapes);
    scene->positions = bench_allocate(count, sizeof *scene->positions);
    scene->scales = bench_allocate(count, sizeof *scene->scales);
    for (uint32_t i = 0; i < count; i++) scene->scales[i] = 1;
    return scene;
}

struct bench_scene *bench_scene_of_mesh(const char *name, uint32_t size, struct bench_mesh *mesh) {
    struct bench_scene *scene = allocate_scene(name, size, 1);
    scene->one_mesh = true;
    add_shape(scene, (struct bench_shape){RG_SHAPE_MESH, {0}, mesh, sqrt(3.0), 1});
    bench_settle(scene);
    return scene;
}

struct bench_scene *bench_scene_create(const char *name, uint32_t count) {
    if (strcmp(name, "noisy") == 0) return bench_scene_of_mesh(name, count, bench_noisy_sphere(count));
    if (strcmp(name, "soup") == 0) return bench_scene_of_mesh(name, count, bench_soup(count));
    struct bench_scene *scene = allocate_scene(name, count, count);
    if (strcmp(name, "mixed") == 0) {
        make_mixed(scene);
    } else if (strcmp(name, "stadium") == 0) {
        make_stadium(scene);
    } else {
        make_even(scene);
    }
    bench_settle(scene);
    return scene;
}

void bench_scene_destroy(struct bench_scene *scene) {
    if (!scene) return;
    for (int s = 0; s < scene->shape_count; s++) bench_mesh_destroy(scene->shapes[s].mesh);
    free(scene->shapes);
    free(scene->shape_of);
    free(scene->positions);
    free(scene->homes);
    free(scene->scales);
    free(scene->linears);
    free(scene);
}

rg_pose bench_pose(const struct bench_scene *scene, uint32_t which) {
    const double *p = scene->positions[which];
    rg_pose pose = rg_pose_at(p[0], p[1], p[2]);
    if (scene->linears) memcpy(pose.linear, scene->linears[which], sizeof pose.linear);
    pose.scale = scene->scales[which];
    return pose;
}

bool bench_is_one_mesh(const struct bench_scene *scene) {
    return scene->one_mesh;
}

bool bench_all_spheres(const struct bench_scene *scene) {
    for (int s = 0; s < scene->shape_count; s++) {
        if (scene->shapes[s].kind != RG_SHAPE_SPHERE) return false;
    }
    return true;
}

static void step_along(const struct bench_scene *scene, uint32_t which, double length, const double direction[3],
                       double position[3]) {
    for (int k = 0; k < 3; k++) position[k] = rounded(scene->positions[which][k] + length * direction[k]);
}

void bench_step(struct bench_scene *scene, uint32_t which, double step, double position[3]) {
    double direction[3];
    bench_random_direction(&scene->random, direction);
    step_along(scene, which, step * bench_reach(scene, which), direction, position);
}

void bench_step_near_home(struct bench_scene *scene, uint32_t which, double step, double position[3]) {
    double home[3], square = 0, radius = bench_reach(scene, which);
    for (int k = 0; k < 3; k++) {
        home[k] = scene->homes[which][k] - scene->positions[which][k];
        square += home[k] * home[k];
    }
    if (square <= 4 * radius * radius) {
        bench_step(scene, which, step, position);
    } else {
        step_along(scene, which, step * radius / sqrt(square), home, position);
    }
}

uint32_t *bench_choose(struct bench_scene *scene, uint32_t count) {
    uint32_t *all = bench_allocate(scene->count, sizeof *all);
    for (uint32_t i = 0; i < scene->count; i++) all[i] = i;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = i + (uint32_t)((scene->count - i) * bench_random(&scene->random));
        uint32_t other = all[j];
        all[j] = all[i];
        all[i] = other;
    }
    return all;
}
