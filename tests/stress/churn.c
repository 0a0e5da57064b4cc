/* SPDX-License-Identifier: MIT */
/*
 * churn: a scene through any number of inserts, moves and removes of single objects: the memory that it holds stays
 * what it was after the first of them, to the byte what its allocator counts; its rays look into as much as in a
 * scene made afresh; and what they hit is right.
 *
 * churn [--changes N] [--seed N]: of each kind of grid; 100000000 by hand.
 */
#include "common.h"

#include "../reference/random.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    MOST = 4000, /* objects */
    RAYS = 400,
    WARM_UP = 25 * MOST /* changes, after which memory is to stay */
};

static const double SIDE = 60; /* of the cube that they are in, radius 1 */

struct crowd {
    struct books books;
    rg_scene *scene;
    rg_shape *ball;
    random_source random;
    rg_object objects[MOST];
    double at[MOST][3];
    int count;
};

/* ------------------------------------------------------------------------------------------------- changes */

static void place_anywhere(struct crowd *crowd, double at[3]) {
    for (int k = 0; k < 3; k++) at[k] = random_between(&crowd->random, 0, SIDE);
}

static void insert(struct crowd *crowd) {
    int i = crowd->count++;
    place_anywhere(crowd, crowd->at[i]);
    const rg_pose pose = rg_pose_at(crowd->at[i][0], crowd->at[i][1], crowd->at[i][2]);
    MUST(rg_scene_insert(crowd->scene, crowd->ball, &pose, &crowd->objects[i]));
}

static void take_out(struct crowd *crowd) {
    int i = (int)random_below(&crowd->random, (uint32_t)crowd->count), last = --crowd->count;
    MUST(rg_scene_remove(crowd->scene, crowd->objects[i]));
    crowd->objects[i] = crowd->objects[last];
    for (int k = 0; k < 3; k++) crowd->at[i][k] = crowd->at[last][k];
}

static void move(struct crowd *crowd, bool far) {
    int i = (int)random_below(&crowd->random, (uint32_t)crowd->count);
    double to[3];
    place_anywhere(crowd, to);
    for (int k = 0; k < 3; k++) {
        double step = crowd->at[i][k] + random_between(&crowd->random, -0.5, 0.5);
        crowd->at[i][k] = far ? to[k] : fmin(fmax(step, 0), SIDE);
    }
    MUST(rg_scene_move_to(crowd->scene, crowd->objects[i], crowd->at[i]));
}

/* Between half of the objects and all of them there are at any time. */
static void change(struct crowd *crowd) {
    uint32_t die = random_below(&crowd->random, 10);
    if (die < 5) {
        move(crowd, die == 0);
    } else if (crowd->count == MOST || (die < 7 && crowd->count > MOST / 2)) {
        take_out(crowd);
    } else {
        insert(crowd);
    }
}

/* ------------------------------------------------------------------------------------------------- judging */

static double t_of_ball(const double centre[3], const rg_ray *ray) {
    double oc[3], b = 0, perpendicular = 0;
    for (int k = 0; k < 3; k++) {
        oc[k] = centre[k] - ray->origin[k];
        b += oc[k] * ray->direction[k];
    }
    for (int k = 0; k < 3; k++) {
        double p = oc[k] - b * ray->direction[k];
        perpendicular += p * p;
    }
    if (perpendicular > 1) return INFINITY;
    double near = b - sqrt(1 - perpendicular), far = b + sqrt(1 - perpendicular);
    return near >= 0 ? near : far >= 0 ? far : INFINITY;
}

static void judge(const struct crowd *crowd, const rg_ray *ray, double t) {
    double best = INFINITY;
    for (int i = 0; i < crowd->count; i++) best = fmin(best, t_of_ball(crowd->at[i], ray));
    demand(best == t || fabs(best - t) <= 1e-6, "the closest object is hit");
}

/* Cells and objects that the same rays look at; what they hit is judged. */
static uint64_t look(const struct crowd *crowd, rg_scene *scene) {
    rg_ray rays[RAYS];
    double t[RAYS];
    uint32_t cells[RAYS], tests[RAYS];
    random_source random = {42};
    rg_ray_views ray_views = {.size = sizeof ray_views};
    rg_hit_views hit_views = {.size = sizeof hit_views};
    uint64_t sum = 0;
    for (int i = 0; i < RAYS; i++) {
        double origin[3], direction[3];
        for (int k = 0; k < 3; k++) origin[k] = random_between(&random, 0, SIDE);
        random_direction(&random, direction);
        rays[i] = rg_ray_from(origin, direction);
    }
    ray_views.origin = rg_input3_packed(rays->origin, sizeof *rays, RG_F64);
    ray_views.direction = rg_input3_packed(rays->direction, sizeof *rays, RG_F64);
    hit_views.t = (rg_output){t, sizeof *t, RG_F64};
    hit_views.cells = (rg_output){cells, sizeof *cells, RG_U32};
    hit_views.tests = (rg_output){tests, sizeof *tests, RG_U32};
    MUST(rg_scene_trace_views(scene, NULL, &ray_views, &hit_views, RAYS));
    for (int i = 0; i < RAYS; i++) {
        judge(crowd, &rays[i], t[i]);
        sum += cells[i] + tests[i];
    }
    return sum;
}

/* The same objects in a scene made afresh. */
static uint64_t look_afresh(const struct crowd *crowd, rg_grid_kind kind) {
    struct books books = {0};
    rg_scene *scene = create_scene(&books, kind, 1);
    for (int i = 0; i < crowd->count; i++) {
        const rg_pose pose = rg_pose_at(crowd->at[i][0], crowd->at[i][1], crowd->at[i][2]);
        MUST(rg_scene_insert(scene, crowd->ball, &pose, NULL));
    }
    uint64_t cost = look(crowd, scene);
    destroy_scene(&books, &scene);
    return cost;
}

static void check_books(const struct crowd *crowd) {
    rg_scene_report report = {.size = sizeof report};
    MUST(rg_scene_stats(crowd->scene, &report));
    demand(report.bytes == crowd->books.bytes, "a scene holds the bytes that its allocator has given it");
    demand(report.objects == (uint64_t)crowd->count, "a scene holds the objects that are left");
    demand(report.slots <= MOST, "slots are used again");
}

static void run(rg_grid_kind kind, uint64_t changes, uint64_t seed) {
    struct crowd *crowd = calloc(1, sizeof *crowd);
    if (!crowd) exit(EXIT_FAILURE);
    crowd->random.state = seed;
    MUST(rg_shape_create_sphere(NULL, 1, &crowd->ball));
    crowd->scene = create_scene(&crowd->books, kind, 1);
    while (crowd->count < MOST) insert(crowd);
    for (uint64_t i = 0; i < WARM_UP; i++) change(crowd);
    check_books(crowd);
    uint64_t peak = crowd->books.peak;
    books_reset_peak(&crowd->books);
    for (uint64_t i = 0; i < changes; i++) change(crowd);
    check_books(crowd);
    uint64_t cost = look(crowd, crowd->scene), afresh = look_afresh(crowd, kind);
    printf("%s, seed %" PRIu64 ": %" PRIu64 " changes; at most %" PRIu64 " bytes, %" PRIu64
           " in the first %d; rays look "
           "at %.3f of what they do afresh\n",
           kind_name(kind), seed, changes, crowd->books.peak, peak, WARM_UP, (double)cost / (double)afresh);
    fflush(stdout);
    demand(10 * crowd->books.peak <= 11 * peak, "memory stays what it was");
    demand(100 * cost <= 125 * afresh, "rays look at little more than in a fresh scene");
    destroy_scene(&crowd->books, &crowd->scene);
    rg_shape_release(&crowd->ball);
    free(crowd);
}

int main(int argc, char **argv) {
    uint64_t changes = option(argc, argv, "--changes", 300000), seed = option(argc, argv, "--seed", 1);
    for (int k = 0; k < 3; k++) run(KINDS[k], changes, seed);
    return EXIT_SUCCESS;
}
