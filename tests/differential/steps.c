/* SPDX-License-Identifier: MIT */
/* steps.c: random changes, each made in both scenes. */
#include "world.h"

#include <string.h>

rg_object world_pick(world *w) {
    return reference_object(w->reference, random_below(&w->random, (uint32_t)reference_count(w->reference)));
}

static const world_shape *pick_shape(world *w) {
    const world_shape *shape;
    do {
        shape = &w->shapes[random_below(&w->random, (uint32_t)w->shape_count)];
    } while ((shape->rare && !random_once_in(&w->random, 20)) || (w->balls && !shape->ball) ||
             (w->all_finite && !shape->finite));
    return shape;
}

static const world_shape *shape_of(world *w, rg_object id) {
    rg_object_report report = {.size = sizeof report};
    world_expect(w, "rg_scene_lookup", rg_scene_lookup(w->scene, id, &report), RG_OK);
    for (int i = 0; i < w->shape_count; i++) {
        if (w->shapes[i].shape == report.shape) return &w->shapes[i];
    }
    world_fail(w, "rg_scene_lookup reports a shape that was never made");
    return NULL;
}

/* Few bits, so that rays with few bits pass through most of the scene. */
static uint32_t pick_mask(world *w) {
    return w->balls || w->all_finite || random_once_in(&w->random, 4) ? UINT32_MAX
                                                                      : UINT32_C(1) << random_below(&w->random, 8);
}

static void note_inserted(world *w, rg_object id, const world_shape *shape, const rg_pose *pose, uint32_t mask) {
    if (id == RG_NO_OBJECT || reference_has(w->reference, id)) world_fail(w, "insert gave a used id");
    for (uint32_t i = 0; i < WORLD_STALE; i++) {
        if (w->stale[i] == id) world_fail(w, "insert gave a stale id again");
    }
    reference_insert(w->reference, id, shape->reference, pose, mask);
    if (reference_count(w->reference) > w->most_objects) w->most_objects = (uint32_t)reference_count(w->reference);
}

static void note_removed(world *w, rg_object id) {
    reference_remove(w->reference, id);
    w->stale[w->removed++ % WORLD_STALE] = id;
}

/* Now and then the very twin of an object: of the two the one of the lower id must be hit. */
void world_insert_one(world *w) {
    const world_shape *shape = pick_shape(w);
    rg_pose pose = world_pose(w, shape);
    if (reference_count(w->reference) > 0 && random_once_in(&w->random, 10)) {
        rg_object twin = world_pick(w);
        shape = shape_of(w, twin);
        pose = *reference_pose(w->reference, twin);
    }
    rg_object id = RG_NO_OBJECT;
    world_expect(w, "rg_scene_insert", rg_scene_insert(w->scene, shape->shape, &pose, &id), RG_OK);
    note_inserted(w, id, shape, &pose, UINT32_MAX);
}

/* A view of the poses of an array: as they lie, or from the last to the first. */
static rg_pose_views views_of(const rg_pose *poses, uint32_t count, bool backward, bool with_linear,
                              bool with_scale) {
    ptrdiff_t stride = backward ? -(ptrdiff_t)sizeof *poses : (ptrdiff_t)sizeof *poses;
    const rg_pose *first = backward ? poses + count - 1 : poses;
    rg_pose_views views = {.size = sizeof views};
    views.position = rg_input3_packed(first->position, stride, RG_F64);
    for (int k = 0; with_linear && k < 3; k++) {
        const float *top = first->linear + k;
        views.column[k] = (rg_input3){top, top + 3, top + 6, stride, RG_F32};
    }
    if (with_scale) views.scale = (rg_input){&first->scale, stride, RG_F64};
    return views;
}

void world_insert_many(world *w, uint32_t count) {
    static rg_pose poses[WORLD_MANY];
    static rg_shape *handles[WORLD_MANY];
    static const world_shape *shapes[WORLD_MANY];
    static uint32_t masks[WORLD_MANY];
    static rg_object ids[WORLD_MANY];
    memset(ids, 0, count * sizeof *ids);
    for (uint32_t i = 0; i < count; i++) {
        shapes[i] = pick_shape(w);
        handles[i] = shapes[i]->shape;
        poses[i] = world_pose(w, shapes[i]);
        masks[i] = pick_mask(w);
    }
    rg_insert_views views = {.size = sizeof views, .shapes = handles, .shapes_stride = sizeof *handles};
    rg_pose_views pose_views = views_of(poses, count, false, true, true);
    views.poses = &pose_views;
    views.mask = (rg_input){masks, sizeof *masks, RG_U32};
    views.grid = w->grids[random_below(&w->random, (uint32_t)w->grid_count)];
    rg_output out = {ids, sizeof *ids, RG_U64};
    world_expect(w, "rg_scene_insert_many", rg_scene_insert_many(w->scene, &views, count, &out), RG_OK);
    for (uint32_t i = 0; i < count; i++) note_inserted(w, ids[i], shapes[i], &poses[i], masks[i]);
}

/* Half of the moves are small against the object: those are the ones a grid may take a short way with. */
static void next_position(world *w, rg_object id, double position[3]) {
    double lo[3], hi[3];
    rg_pose anywhere = world_pose(w, &w->shapes[0]);
    reference_bounds(w->reference, id, lo, hi);
    memcpy(position, anywhere.position, sizeof anywhere.position);
    if (random_once_in(&w->random, 2)) return;
    for (int i = 0; i < 3; i++) {
        double size = isfinite(hi[i] - lo[i]) ? hi[i] - lo[i] : 1;
        position[i] = reference_pose(w->reference, id)->position[i] + random_between(&w->random, -0.5, 0.5) * size;
    }
}

void world_move_one(world *w) {
    rg_object id = world_pick(w);
    rg_pose pose = *reference_pose(w->reference, id);
    if (random_once_in(&w->random, 2)) {
        next_position(w, id, pose.position);
        world_expect(w, "rg_scene_move_to", rg_scene_move_to(w->scene, id, pose.position), RG_OK);
    } else {
        pose = world_pose(w, shape_of(w, id));
        if (random_once_in(&w->random, 2)) next_position(w, id, pose.position);
        world_expect(w, "rg_scene_move", rg_scene_move(w->scene, id, &pose), RG_OK);
    }
    reference_move(w->reference, id, &pose);
}

/* Draws ids with repetition, so now and then one is named twice and must end at its last pose. */
void world_move_many(world *w, uint32_t count) {
    static rg_pose poses[WORLD_MANY];
    static rg_object ids[WORLD_MANY];
    bool backward = random_once_in(&w->random, 2), with_linear = random_once_in(&w->random, 2);
    bool with_scale = random_once_in(&w->random, 2);
    for (uint32_t i = 0; i < count; i++) {
        ids[i] = world_pick(w);
        rg_pose *pose = &poses[backward ? count - 1 - i : i];
        *pose = world_pose(w, shape_of(w, ids[i]));
        if (random_once_in(&w->random, 2)) next_position(w, ids[i], pose->position);
    }
    rg_pose_views views = views_of(poses, count, backward, with_linear, with_scale);
    rg_input in = {ids, sizeof *ids, RG_U64};
    world_expect(w, "rg_scene_move_many", rg_scene_move_many(w->scene, &in, &views, count), RG_OK);
    for (uint32_t i = 0; i < count; i++) {
        rg_pose pose = poses[backward ? count - 1 - i : i];
        if (!with_linear) {
            memcpy(pose.linear, reference_pose(w->reference, ids[i])->linear, sizeof pose.linear);
        }
        if (!with_scale) pose.scale = reference_pose(w->reference, ids[i])->scale;
        reference_move(w->reference, ids[i], &pose);
    }
}

void world_remove_one(world *w) {
    rg_object id = world_pick(w);
    world_expect(w, "rg_scene_remove", rg_scene_remove(w->scene, id), RG_OK);
    note_removed(w, id);
}

/* Those that the reference has side by side, from some place on; sometimes one of them twice: then none may go. */
void world_remove_many(world *w, uint32_t count) {
    static rg_object ids[WORLD_MANY];
    size_t all = reference_count(w->reference), first = random_below(&w->random, (uint32_t)all);
    if (count > all) count = (uint32_t)all;
    bool twice = count > 1 && random_once_in(&w->random, 4);
    for (uint32_t i = 0; i < count; i++) ids[i] = reference_object(w->reference, (first + i) % all);
    if (twice) ids[random_below(&w->random, count - 1)] = ids[count - 1];
    rg_input in = {ids, sizeof *ids, RG_U64};
    world_expect(w, "rg_scene_remove_many", rg_scene_remove_many(w->scene, &in, count),
                 twice ? RG_INVALID_ID : RG_OK);
    for (uint32_t i = 0; !twice && i < count; i++) note_removed(w, ids[i]);
}

/* The reference knows no such call: its objects go and come back. */
void world_replace_shape(world *w) {
    const world_shape *from = shape_of(w, world_pick(w)), *to = pick_shape(w);
    if (!to->finite || to == from) return;
    for (size_t i = reference_count(w->reference); i-- > 0;) {
        rg_object id = reference_object(w->reference, i);
        if (shape_of(w, id) != from) continue;
        rg_pose pose = *reference_pose(w->reference, id);
        uint32_t mask = reference_mask(w->reference, id);
        reference_remove(w->reference, id);
        reference_insert(w->reference, id, to->reference, &pose, mask);
    }
    world_expect(w, "rg_scene_replace_shape", rg_scene_replace_shape(w->scene, from->shape, to->shape), RG_OK);
}

static uint64_t rebuilds_of(const world *w, int g) {
    rg_grid_report report = {.size = sizeof report};
    world_expect(w, "rg_grid_stats", rg_grid_stats(w->scene, w->grids[g], &report), RG_OK);
    return report.rebuilds;
}

static void rebuild_one(world *w) {
    int g = (int)random_below(&w->random, (uint32_t)w->grid_count);
    uint64_t before = rebuilds_of(w, g);
    world_expect(w, "rg_grid_rebuild", rg_grid_rebuild(w->scene, w->grids[g]), RG_OK);
    w->rebuilds[g] = before + 1;
    world_check_rebuilt(w, g);
}

void world_configure(world *w) {
    static const uint32_t RESOLUTIONS[] = {0, 0, 1, 7, 32};
    int g = (int)random_below(&w->random, (uint32_t)w->grid_count);
    uint64_t before = rebuilds_of(w, g);
    rg_grid_config config = {.size = sizeof config, .kind = (rg_grid_kind)random_below(&w->random, 4)};
    config.resolution = RESOLUTIONS[random_below(&w->random, 5)];
    if (random_once_in(&w->random, 3)) {
        for (int i = 0; i < 3; i++) {
            config.lo[i] = w->centre[i] - 8;
            config.hi[i] = w->centre[i] + 8;
        }
    }
    world_expect(w, "rg_grid_configure", rg_grid_configure(w->scene, w->grids[g], &config), RG_OK);
    w->rebuilds[g] = before + 1;
    world_check_rebuilt(w, g);
}

static void set_mask(world *w) {
    rg_object id = world_pick(w);
    uint32_t mask = pick_mask(w);
    world_expect(w, "rg_scene_set_mask", rg_scene_set_mask(w->scene, id, mask), RG_OK);
    reference_set_mask(w->reference, id, mask);
}

/* Calls that must fail and change nothing; that nothing changed, the queries that follow will tell. */
static void misuse(world *w) {
    rg_object id = world_pick(w), ids[2] = {id, w->removed ? w->stale[0] : RG_NO_OBJECT};
    rg_pose pose = *reference_pose(w->reference, id), poses[2];
    rg_input in = {ids, sizeof *ids, RG_U64};
    pose.position[random_below(&w->random, 3)] += 1;
    poses[0] = poses[1] = pose;
    rg_pose_views views = views_of(poses, 2, false, true, true);
    world_expect(w, "rg_scene_move_many", rg_scene_move_many(w->scene, &in, &views, 2), RG_INVALID_ID);
    world_expect(w, "rg_scene_remove_many", rg_scene_remove_many(w->scene, &in, 2), RG_INVALID_ID);
    pose.linear[random_below(&w->random, 9)] = random_once_in(&w->random, 2) ? NAN : INFINITY;
    world_expect(w, "rg_scene_move", rg_scene_move(w->scene, id, &pose), RG_INVALID_VALUE);
    memset(pose.linear, 0, sizeof pose.linear);
    world_expect(w, "rg_scene_move", rg_scene_move(w->scene, id, &pose), RG_INVALID_VALUE);
    pose = poses[0];
    pose.position[random_below(&w->random, 3)] = random_once_in(&w->random, 2) ? NAN : 1.1e100;
    world_expect(w, "rg_scene_move_to", rg_scene_move_to(w->scene, id, pose.position), RG_INVALID_VALUE);
    world_expect(w, "rg_scene_insert", rg_scene_insert(w->scene, w->shapes[0].shape, &pose, NULL), RG_INVALID_VALUE);
}

static void step_of_many(world *w, uint32_t population, uint32_t many) {
    uint32_t count = (uint32_t)reference_count(w->reference), what = random_below(&w->random, 3);
    if (count < population / 2) what = 0;
    if (count > population + population / 2) what = 2;
    if (what == 0)
        world_insert_many(w, many);
    else if (what == 1 && count > 0)
        world_move_many(w, many);
    else if (count > 0)
        world_remove_many(w, many);
}

void world_step(world *w, uint32_t population) {
    uint32_t count = (uint32_t)reference_count(w->reference), many = 1 + random_below(&w->random, w->most_at_once);
    uint32_t what = random_below(&w->random, 1000);
    w->step++;
    if (random_below(&w->random, 16) < w->many_of_16) {
        step_of_many(w, population, many);
        return;
    }
    if (w->configures && random_once_in(&w->random, 64)) world_configure(w);
    if (count == 0 || count < population / 2) what %= 250;
    if (count > population + population / 2) what = 580 + what % 130;
    if (what < 240)
        world_insert_one(w);
    else if (what < 250)
        world_insert_many(w, many);
    else if (what < 560)
        world_move_one(w);
    else if (what < 580)
        world_move_many(w, many);
    else if (what < 820)
        world_remove_one(w);
    else if (what < 830)
        world_remove_many(w, many / 4 + 1);
    else if (what < 990)
        set_mask(w);
    else if (what < 997)
        misuse(w);
    else if (what < 999)
        rebuild_one(w);
    else
        world_replace_shape(w);
}
