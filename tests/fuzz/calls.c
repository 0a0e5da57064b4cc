/* SPDX-License-Identifier: MIT */
/* calls.c: the calls that change a scene, with whatever the bytes say; what succeeds is done to the reference too. */
#include "script.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_plain(const rg_pose *pose) {
    static const float IDENTITY[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int i = 0; i < 9; i++) {
        if (pose->linear[i] != IDENTITY[i]) return false;
    }
    return pose->scale == 0 || pose->scale == 1;
}

/* What the header demands of the position and of each number; the determinant is left to the library. */
static bool plausible(const rg_pose *pose) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(pose->position[i]) <= RG_COORDINATE_MAX)) return false;
    }
    for (int i = 0; i < 9; i++) {
        if (!(fabsf(pose->linear[i]) <= FLT_MAX)) return false;
    }
    return pose->scale == 0 || (pose->scale >= RG_RADIUS_MIN && pose->scale <= RG_COORDINATE_MAX);
}

static int index_of(const script *s, rg_object id) {
    for (int i = 0; i < s->object_count; i++) {
        if (id != RG_NO_OBJECT && s->objects[i] == id) return i;
    }
    return -1;
}

static void inserted(script *s, rg_object id, const script_shape *shape, const rg_pose *pose, uint32_t mask) {
    if (!plausible(pose)) script_fail("a pose that is not finite was taken");
    if (id == RG_NO_OBJECT || index_of(s, id) >= 0) script_fail("an id was given out twice");
    reference_insert(s->reference, id, shape->reference, pose, mask);
    misdeed misdeed = shape->user ? shape->user->misdeed : NO_MISDEED;
    s->objects[s->object_count] = id;
    s->wild[s->object_count] = shape->wild;
    s->misbehaves[s->object_count++] = misdeed == FAILS || misdeed == RETURNS_NAN || misdeed == RETURNS_NONSENSE;
}

void insert_one(script *s) {
    if (s->shape_count == 0 || s->object_count == MOST_OBJECTS) return;
    const script_shape *shape = &s->shapes[read_byte(s) % s->shape_count];
    rg_pose pose = read_pose(s);
    rg_object id = RG_NO_OBJECT;
    rg_result result = script_check(rg_scene_insert(s->scene, shape->shape, &pose, &id));
    if (result == RG_OK)
        inserted(s, id, shape, &pose, UINT32_MAX);
    else if (id != RG_NO_OBJECT)
        script_fail("a failed insert wrote an id");
    if (result != RG_OK && plausible(&pose) && is_plain(&pose)) script_fail("a plain pose was refused");
}

static rg_pose_views views_of(script *s, const rg_pose *poses, uint8_t flags) {
    rg_pose_views views = {.size = read_size(s, sizeof views)};
    views.position = rg_input3_packed(poses[0].position, sizeof *poses, RG_F64);
    for (int k = 0; k < 3; k++) {
        const float *top = poses[0].linear + k;
        views.column[k] = (rg_input3){top, top + 3, top + 6, sizeof *poses, RG_F32};
    }
    views.scale = (rg_input){&poses[0].scale, sizeof *poses, RG_F64};
    if (flags & 1) views.column[flags % 3].x = NULL; /* two of three */
    if (flags & 2) views.column[0].x = views.column[1].x = views.column[2].x = NULL;
    if (flags & 4) views.position.x = NULL;
    if (flags & 8) views.position.type = (rg_type)read_below(s, 8) - 1;
    if (views.position.type == RG_F32) views.position.type = RG_U8; /* doubles read as floats would be right views */
    return views;
}

/* Whether the library may take the views at all, and the poses are those of the array. */
static bool right_views(const rg_pose_views *views, uint8_t flags) {
    return views->size == sizeof *views && !(flags & 1 && !(flags & 2)) && !(flags & 4) &&
           views->position.type == RG_F64;
}

void insert_some(script *s) {
    if (s->shape_count == 0 || s->object_count + MANY > MOST_OBJECTS) return;
    rg_pose poses[MANY];
    rg_shape *shapes[MANY];
    int which[MANY];
    uint32_t masks[MANY];
    rg_object ids[MANY] = {0};
    uint8_t flags = read_byte(s), mask_flags = read_byte(s);
    for (int i = 0; i < MANY; i++) {
        which[i] = read_byte(s) % s->shape_count;
        shapes[i] = s->shapes[which[i]].shape;
        masks[i] = read_byte(s);
        poses[i] = read_pose(s);
        if (flags & 2)
            poses[i] = (rg_pose){{poses[i].position[0], poses[i].position[1], poses[i].position[2]},
                                 {1, 0, 0, 0, 1, 0, 0, 0, 1},
                                 poses[i].scale};
    }
    rg_pose_views pose_views = views_of(s, poses, flags);
    rg_insert_views views = {.size = read_size(s, sizeof views), .shapes = shapes, .shapes_stride = sizeof *shapes};
    views.poses = mask_flags & 64 ? NULL : &pose_views;
    views.grid = read_grid(s);
    if (mask_flags & 1) views.mask = (rg_input){masks, sizeof *masks, mask_flags & 16 ? RG_U8 : RG_U32};
    if (mask_flags & 32) shapes[MANY / 2] = NULL;
    if (mask_flags & 128) views.shapes = NULL;
    rg_output out = {ids, sizeof *ids, mask_flags & 8 ? RG_F64 : RG_U64};
    rg_result result = script_check(rg_scene_insert_many(s->scene, &views, MANY, &out));
    bool right = right_views(&pose_views, flags) && views.size == sizeof views &&
                 !(mask_flags & (8 | 32 | 64 | 128)) && !(mask_flags & 1 && mask_flags & 16);
    if (result == RG_OK && !right) script_fail("wrong views were taken");
    for (int i = 0; i < MANY; i++) {
        if (result == RG_OK) {
            inserted(s, ids[i], &s->shapes[which[i]], &poses[i], mask_flags & 1 ? masks[i] : UINT32_MAX);
        } else if (ids[i] != 0) {
            script_fail("a failed insert wrote an id");
        }
    }
}

static void demand_known(const script *s, rg_object id, rg_result result) {
    if ((result == RG_INVALID_ID) == reference_has(s->reference, id)) script_fail("an id was judged wrong");
}

void move_one(script *s) {
    rg_object id = read_object(s);
    rg_pose pose = read_pose(s);
    rg_result result = script_check(rg_scene_move(s->scene, id, &pose));
    if (result == RG_OK && !plausible(&pose)) script_fail("a pose that is not finite was taken");
    if (plausible(&pose) && is_plain(&pose)) demand_known(s, id, result);
    if (result == RG_OK) reference_move(s->reference, id, &pose);
}

void move_to(script *s) {
    rg_object id = read_object(s);
    double position[3];
    for (int i = 0; i < 3; i++) position[i] = read_number(s);
    rg_result result = script_check(rg_scene_move_to(s->scene, id, position));
    if (result != RG_OK) return;
    rg_pose pose = *reference_pose(s->reference, id);
    memcpy(pose.position, position, sizeof position);
    if (!plausible(&pose)) script_fail("a position that is not finite was taken");
    reference_move(s->reference, id, &pose);
}

void move_some(script *s) {
    rg_pose poses[MANY];
    rg_object ids[MANY];
    uint8_t flags = read_byte(s);
    for (int i = 0; i < MANY; i++) {
        ids[i] = read_object(s);
        poses[i] = read_pose(s);
    }
    rg_pose_views views = views_of(s, poses, flags);
    rg_input in = {flags & 128 ? NULL : ids, sizeof *ids, flags & 64 ? RG_U32 : RG_U64};
    rg_result result = script_check(rg_scene_move_many(s->scene, &in, &views, MANY));
    if (result != RG_OK) return;
    if (!right_views(&views, flags) || flags & (64 | 128)) script_fail("wrong views were taken");
    for (int i = 0; i < MANY; i++) {
        if (flags & 2) memcpy(poses[i].linear, reference_pose(s->reference, ids[i])->linear, sizeof poses[i].linear);
        if (!plausible(&poses[i])) script_fail("a pose that is not finite was taken");
        reference_move(s->reference, ids[i], &poses[i]);
    }
}

void set_mask(script *s) {
    rg_object id = read_object(s);
    uint32_t mask = read_byte(s);
    rg_result result = script_check(rg_scene_set_mask(s->scene, id, mask));
    demand_known(s, id, result);
    if (result == RG_OK) reference_set_mask(s->reference, id, mask);
}

void remove_one(script *s) {
    rg_object id = read_object(s);
    rg_result result = script_check(rg_scene_remove(s->scene, id));
    demand_known(s, id, result);
    if (result == RG_OK) reference_remove(s->reference, id);
}

void remove_some(script *s) {
    rg_object ids[MANY];
    uint32_t count = read_below(s, MANY);
    for (uint32_t i = 0; i < count; i++) ids[i] = read_object(s);
    rg_input in = {ids, sizeof *ids, RG_U64};
    rg_result result = script_check(rg_scene_remove_many(s->scene, &in, count));
    for (uint32_t i = 0; result == RG_OK && i < count; i++) reference_remove(s->reference, ids[i]);
}

void look_up(script *s) {
    rg_object id = read_object(s);
    rg_object_report report = {.size = read_size(s, sizeof report)};
    rg_result result = script_check(rg_scene_lookup(s->scene, id, &report));
    if (result != RG_OK || report.size != sizeof report) return;
    demand_known(s, id, result);
    if (report.mask != reference_mask(s->reference, id)) script_fail("lookup: another mask");
}

void ask_stats(script *s) {
    rg_scene_report scene = {.size = read_size(s, sizeof scene)};
    rg_grid_report grid = {.size = read_size(s, sizeof grid)};
    rg_result result = script_check(rg_scene_stats(s->scene, &scene));
    if (result == RG_OK && scene.objects != reference_count(s->reference)) script_fail("stats: number of objects");
    script_check(rg_grid_stats(s->scene, read_grid(s), &grid));
}

void create_grid(script *s) {
    rg_grid_config config = read_grid_config(s);
    rg_grid grid = 0;
    if (s->grid_count == MOST_GRIDS) return;
    if (script_check(rg_grid_create(s->scene, &config, &grid)) == RG_OK) s->grids[s->grid_count++] = grid;
}

void destroy_grid(script *s) {
    script_check(rg_grid_destroy(s->scene, read_grid(s)));
}

void configure_grid(script *s) {
    rg_grid_config config = read_grid_config(s);
    script_check(rg_grid_configure(s->scene, read_grid(s), &config));
}

void rebuild_grid(script *s) {
    script_check(rg_grid_rebuild(s->scene, read_grid(s)));
}

static void must_be_refused(rg_result result) {
    /* Where the id is wrong as well, either may be named. */
    if (script_check(result) != RG_INVALID_ARGUMENT && result != RG_INVALID_ID) script_fail("NULL was taken");
}

void pass_null(script *s) {
    const rg_output no_output = {NULL, 0, RG_U64};
    rg_object ids[1] = {RG_NO_OBJECT};
    rg_input in = {ids, sizeof *ids, RG_U64};
    switch (read_below(s, 12)) {
    case 0:
        must_be_refused(rg_scene_insert(s->scene, NULL, NULL, NULL));
        break;
    case 1:
        must_be_refused(rg_scene_insert_many(s->scene, NULL, 3, &no_output));
        break;
    case 2:
        must_be_refused(rg_scene_move(NULL, 1, NULL));
        break;
    case 3:
        must_be_refused(rg_scene_move_many(s->scene, &in, NULL, 1));
        break;
    case 4:
        must_be_refused(rg_scene_remove_many(s->scene, NULL, 1));
        break;
    case 5:
        must_be_refused(rg_scene_trace(s->scene, NULL, NULL, 1));
        break;
    case 6:
        must_be_refused(rg_scene_occluded(NULL, NULL, NULL, 1));
        break;
    case 7:
        must_be_refused(rg_scene_trace_views(s->scene, NULL, NULL, NULL, 1));
        break;
    case 8:
        must_be_refused(rg_grid_create(s->scene, NULL, NULL));
        break;
    case 9:
        must_be_refused(rg_scene_stats(s->scene, NULL));
        break;
    case 10:
        must_be_refused(rg_shape_create_sphere(NULL, 1, NULL));
        break;
    default:
        must_be_refused(rg_scene_lookup(s->scene, ids[0], NULL));
        break;
    }
}
