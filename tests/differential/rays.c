/* SPDX-License-Identifier: MIT */
/* rays.c: rays that are likely to find something out: aimed at objects and just past them, along axes, from far. */
#include "world.h"

#include <string.h>

/* A point in the box of some object, or a little outside; or its very corner, or on one of its faces' planes. */
static void pick_target(world *w, double target[3], double *size) {
    double lo[3], hi[3];
    *size = 1;
    for (int i = 0; i < 3; i++) target[i] = w->centre[i] + random_between(&w->random, -w->spread, w->spread);
    if (reference_count(w->reference) == 0 || random_once_in(&w->random, 8)) return;
    reference_bounds(w->reference, world_pick(w), lo, hi);
    bool exact = random_once_in(&w->random, 6);
    for (int i = 0; i < 3; i++) {
        if (!isfinite(lo[i]) || !isfinite(hi[i])) continue;
        target[i] = lo[i] + random_between(&w->random, -0.1, 1.1) * (hi[i] - lo[i]);
        if (exact && random_once_in(&w->random, 2)) target[i] = random_once_in(&w->random, 2) ? lo[i] : hi[i];
        *size = fmax(*size, hi[i] - lo[i]);
    }
}

static void pick_origin(world *w, const double target[3], double size, double origin[3]) {
    double d[3], distance = 0;
    random_direction(&w->random, d);
    switch (random_below(&w->random, 10)) {
    case 0:
        break; /* at the target, often inside something */
    case 1:
        distance = size * random_decade(&w->random, 3, 9);
        break;
    case 2:
    case 3:
        distance = size * random_decade(&w->random, -2, 1);
        break;
    default:
        distance = w->spread * random_between(&w->random, 0, 4);
        break;
    }
    if (random_once_in(&w->random, 5)) { /* along an axis, or in one of its planes */
        d[random_below(&w->random, 3)] = 0;
        d[random_below(&w->random, 3)] = -0.0;
        if (d[0] == 0 && d[1] == 0 && d[2] == 0) d[0] = 1;
    }
    for (int i = 0; i < 3; i++) origin[i] = target[i] - distance * d[i];
}

static void pick_direction(world *w, const double origin[3], const double target[3], double direction[3]) {
    double scale = random_once_in(&w->random, 3) ? random_decade(&w->random, -3, 3) : 1;
    for (int i = 0; i < 3; i++) direction[i] = target[i] - origin[i];
    if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) random_direction(&w->random, direction);
    for (int i = 0; i < 3; i++) direction[i] *= scale;
}

/* The target mostly lies at t = 1: ranges are drawn around that. */
static void pick_range(world *w, rg_ray *ray) {
    if (random_once_in(&w->random, 4)) ray->t_max = random_decade(&w->random, -2, 1);
    if (random_once_in(&w->random, 8)) ray->t_min = fmin(ray->t_max, random_between(&w->random, -1, 1));
    if (random_once_in(&w->random, 30)) ray->t_min = -HUGE_VAL;
    if (random_once_in(&w->random, 200)) ray->t_max = ray->t_min;
}

/* One number of the ray becomes what no ray may have. */
static void spoil(world *w, rg_ray *ray) {
    static const double BAD[] = {NAN, HUGE_VAL, -HUGE_VAL};
    double bad = BAD[random_below(&w->random, 3)];
    switch (random_below(&w->random, 4)) {
    case 0:
        ray->origin[random_below(&w->random, 3)] = bad;
        break;
    case 1:
        ray->direction[random_below(&w->random, 3)] = bad;
        break;
    case 2:
        ray->t_min = NAN;
        break;
    default:
        ray->direction[0] = ray->direction[1] = ray->direction[2] = 0;
        break;
    }
}

/* Centre and radius of some sphere that is only moved; false if none is found in a few draws. */
static bool pick_ball(world *w, double centre[3], double *radius) {
    for (int draws = 0; draws < 30 && reference_count(w->reference) > 0; draws++) {
        rg_object_report object = {.size = sizeof object};
        rg_shape_report shape = {.size = sizeof shape};
        world_expect(w, "rg_scene_lookup", rg_scene_lookup(w->scene, world_pick(w), &object), RG_OK);
        world_expect(w, "rg_shape_stats", rg_shape_stats(object.shape, &shape), RG_OK);
        const rg_pose plain = rg_pose_at(0, 0, 0);
        bool moved_only = memcmp(object.pose.linear, plain.linear, sizeof plain.linear) == 0;
        if (shape.kind != RG_SHAPE_SPHERE || !moved_only) continue;
        memcpy(centre, object.pose.position, sizeof object.pose.position);
        *radius = shape.hi[0];
        return true;
    }
    return false;
}

/*
 * A ray that passes a sphere's silhouette so closely, on either side, that the last bits decide; from up to 1e9 radii
 * away. Direction and origin are rounded, which moves it by more than the distance asked for: all the better.
 */
static bool pick_silhouette(world *w, rg_ray *ray) {
    double centre[3], radius, along[3], across[3], dot = 0, length = 0;
    if (!pick_ball(w, centre, &radius)) return false;
    random_direction(&w->random, along);
    random_direction(&w->random, across);
    for (int i = 0; i < 3; i++) dot += along[i] * across[i];
    for (int i = 0; i < 3; i++) across[i] -= dot * along[i];
    for (int i = 0; i < 3; i++) length += across[i] * across[i];
    if (length < 1e-3) return false;
    double beside = random_between(&w->random, -1, 1) * random_decade(&w->random, -14, -8);
    double by = radius * (1 + beside) / sqrt(length), from = radius * random_decade(&w->random, 1, 9);
    for (int i = 0; i < 3; i++) {
        ray->origin[i] = centre[i] + by * across[i] - from * along[i];
        ray->direction[i] = along[i];
    }
    return true;
}

/*
 * A ray that runs exactly in walls between cells, through their edges or corner after corner: those of the grid as it
 * is now, in the tile of some object.
 */
static void pick_walls(world *w, rg_ray *ray) {
    rg_grid_report grid = {.size = sizeof grid};
    double target[3], size;
    rg_grid which = w->grids[random_below(&w->random, (uint32_t)w->grid_count)];
    world_expect(w, "rg_grid_stats", rg_grid_stats(w->scene, which, &grid), RG_OK);
    pick_target(w, target, &size);
    for (int i = 0; i < 3; i++) {
        double cell = grid.levels ? (grid.physical_hi[i] - grid.physical_lo[i]) / grid.resolution[i] : 1;
        double index = floor((target[i] - grid.physical_lo[i]) / cell);
        double back = random_once_in(&w->random, 2) ? 20 : -20;
        ray->direction[i] = random_once_in(&w->random, 2) ? 0 : back < 0 ? cell : -cell;
        if (ray->direction[i] != 0) index += back;
        ray->origin[i] = random_once_in(&w->random, 4) ? target[i] : grid.physical_lo[i] + index * cell;
    }
    if (ray->direction[0] == 0 && ray->direction[1] == 0) ray->direction[2] = random_once_in(&w->random, 2) ? 1 : -1;
}

rg_ray world_ray(world *w) {
    rg_ray ray = {.t_min = 0, .t_max = HUGE_VAL, .mask = UINT32_MAX};
    double target[3], size;
    uint32_t kind = random_below(&w->random, 10);
    if (kind == 0) {
        pick_walls(w, &ray);
    } else if (kind > 1 || !pick_silhouette(w, &ray)) {
        pick_target(w, target, &size);
        pick_origin(w, target, size, ray.origin);
        pick_direction(w, ray.origin, target, ray.direction);
    }
    pick_range(w, &ray);
    if (random_once_in(&w->random, 3)) ray.mask = UINT32_C(1) << random_below(&w->random, 8);
    if (random_once_in(&w->random, 100)) spoil(w, &ray);
    return ray;
}

void world_rays(world *w, rg_ray *rays, uint32_t count) {
    batch_space space = {{w->centre[0], w->centre[1], w->centre[2]}, w->spread};
    double size;
    if (random_once_in(&w->random, 2)) {
        for (uint32_t i = 0; i < count; i++) rays[i] = world_ray(w);
        return;
    }
    /* Around some object, so that not all pass by. */
    if (random_once_in(&w->random, 2)) {
        pick_target(w, space.centre, &size);
        space.spread = size * random_between(&w->random, 0.2, 2);
    }
    batch_rays(&w->random, &space, rays, count);
    bool masked = random_once_in(&w->random, 4);
    for (uint32_t i = 0; i < count && masked; i++) rays[i].mask = UINT32_C(1) << random_below(&w->random, 8);
}
