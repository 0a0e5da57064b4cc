/* SPDX-License-Identifier: MIT */
#include "lanes.h"

#include "../reference/random.h"

#include <math.h>
#include <string.h>

enum {
    ROW = 28,     /* lanes side by side */
    APART = 3,    /* their distance; all shapes reach one unit to all sides */
    PHASE = 12,   /* states in the same region; then all go on to the next, and grids must be rebuilt */
    REGIONS = 8,  /* in turn, */
    WIDTH = 100,  /* of a region along x */
    JUMP = 1500,  /* from one to the next */
    TOGETHER = 64 /* lanes moved by one call, at most */
};

/* Where rays begin, x, far from everything. */
static const double FAR_AWAY = 1e5;

static uint64_t mix(const struct lanes *lanes, int lane, uint64_t number, uint64_t salt) {
    random_source r = {lanes->seed ^ salt};
    r.state += random_bits(&r) + (uint64_t)lane;
    r.state += random_bits(&r) + number;
    return random_bits(&r);
}

enum lane_state lane_state_of(const struct lanes *lanes, int lane, uint64_t number) {
    if (lane < STILL || number == 0) return LANE_SEEN;
    uint32_t die = (uint32_t)(mix(lanes, lane, number, 1) & 15);
    if (die < 2) return LANE_EMPTY;
    return die == 2 && lanes->masks ? LANE_HIDDEN : LANE_SEEN;
}

double lane_x(const struct lanes *lanes, int lane, uint64_t number) {
    uint64_t region = lane < STILL ? 0 : number / PHASE % REGIONS;
    double side = region % 2 ? -1 : 1;
    return side * JUMP * (double)region + WIDTH * ((double)(mix(lanes, lane, number, 2) >> 11) * 0x1p-53);
}

static rg_pose pose_of(const struct lanes *lanes, int lane, uint64_t number) {
    return rg_pose_at(lane_x(lanes, lane, number), APART * (lane % ROW), APART * (lane / ROW));
}

/* ------------------------------------------------------------------------------------------------- changes */

static void begin(struct lane *lane) {
    __atomic_store_n(&lane->begun, lane->begun + 1, __ATOMIC_SEQ_CST);
}

static void done(struct lane *lane) {
    __atomic_store_n(&lane->done, lane->begun, __ATOMIC_SEQ_CST);
}

/* That an object was inserted with the state that has begun. */
static void note_id(struct lane *lane, rg_object object) {
    uint64_t at = lane->inserts % IDS;
    lane->object = object;
    __atomic_store_n(&lane->ids[at], object, __ATOMIC_SEQ_CST);
    __atomic_store_n(&lane->since[at], lane->begun, __ATOMIC_SEQ_CST);
    __atomic_store_n(&lane->inserts, lane->inserts + 1, __ATOMIC_SEQ_CST);
}

static rg_shape *shape_of(const struct lanes *lanes, int lane) {
    /* Mostly balls, which go the quickest ways. */
    return lanes->shapes[lane % 8 < 5 ? 0 : lane % 8 - 4];
}

static void insert(struct lanes *lanes, int which, const rg_pose *pose, bool hidden) {
    struct lane *lane = &lanes->all[which];
    rg_object object;
    rg_shape *shape = shape_of(lanes, which);
    if (!hidden && which >= STILL) {
        MUST(rg_scene_insert(lanes->scene, shape, pose, &object));
    } else {
        /* With its mask, or its grid, from the first. */
        const uint32_t mask = hidden ? HIDDEN_MASK : UINT32_MAX;
        rg_pose_views poses = {.size = sizeof poses};
        const rg_insert_views views = {.size = sizeof views,
                                       .shapes = &shape,
                                       .poses = &poses,
                                       .mask = {&mask, 0, RG_U32},
                                       .grid = which < STILL ? lanes->still_grid : RG_GRID_OF_SCENE};
        const rg_output ids = {&object, 0, RG_U64};
        MUST(rg_pose_views_of(&poses, sizeof poses, pose, 0));
        MUST(rg_scene_insert_many(lanes->scene, &views, 1, &ids));
    }
    note_id(lane, object);
}

static void take_out(struct lanes *lanes, struct lane *lane) {
    const rg_object object = lane->object;
    MUST(rg_scene_remove(lanes->scene, object));
    demand(rg_scene_remove(lanes->scene, object) == RG_INVALID_ID, "the id of what was removed is refused");
    lane->object = RG_NO_OBJECT;
}

/* From hidden to seen it moves first, unseen. */
static void move(struct lanes *lanes, int which, const rg_pose *pose, bool was_hidden, bool hidden) {
    const rg_object object = lanes->all[which].object;
    if (hidden && !was_hidden) MUST(rg_scene_set_mask(lanes->scene, object, HIDDEN_MASK));
    if (which % 2) {
        MUST(rg_scene_move(lanes->scene, object, pose));
    } else {
        MUST(rg_scene_move_to(lanes->scene, object, pose->position));
    }
    if (was_hidden && !hidden) MUST(rg_scene_set_mask(lanes->scene, object, UINT32_MAX));
}

void lane_advance(struct lanes *lanes, int which) {
    struct lane *lane = &lanes->all[which];
    const rg_pose pose = pose_of(lanes, which, lane->begun + 1);
    enum lane_state before = lane_state_of(lanes, which, lane->begun);
    enum lane_state after = lane_state_of(lanes, which, lane->begun + 1);
    begin(lane);
    if (before == LANE_EMPTY) {
        if (after != LANE_EMPTY) insert(lanes, which, &pose, after == LANE_HIDDEN);
    } else if (after == LANE_EMPTY) {
        take_out(lanes, lane);
    } else {
        move(lanes, which, &pose, before == LANE_HIDDEN, after == LANE_HIDDEN);
    }
    done(lane);
}

int lanes_move_together(struct lanes *lanes, int first, int count) {
    rg_object ids[TOGETHER];
    rg_pose to[TOGETHER];
    int n = 0;
    for (; n < count && n < TOGETHER; n++) {
        struct lane *lane = &lanes->all[first + n];
        if (lane_state_of(lanes, first + n, lane->begun) != LANE_SEEN) break;
        if (lane_state_of(lanes, first + n, lane->begun + 1) != LANE_SEEN) break;
        ids[n] = lane->object;
        to[n] = pose_of(lanes, first + n, lane->begun + 1);
    }
    if (n == 0) return 0;
    rg_pose_views poses = {.size = sizeof poses};
    const rg_input objects = {ids, sizeof *ids, RG_U64};
    MUST(rg_pose_views_of(&poses, sizeof poses, to, sizeof *to));
    for (int i = 0; i < n; i++) begin(&lanes->all[first + i]);
    MUST(rg_scene_move_many(lanes->scene, &objects, &poses, (uint64_t)n));
    for (int i = 0; i < n; i++) done(&lanes->all[first + i]);
    return n;
}

/* ------------------------------------------------------------------------------------------- begin and end */

/* A cube of twelve triangles, one unit to all sides. */
static rg_shape *create_cube(void) {
    static const uint32_t corners[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                                            {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    double vertices[8][3];
    rg_mesh_views views = {.size = sizeof views};
    rg_shape *cube = NULL;
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) vertices[i][k] = i >> k & 1 ? 1 : -1;
    }
    views.vertices = rg_input3_packed(vertices[0], sizeof *vertices, RG_F64);
    views.vertex_count = 8;
    views.indices = rg_input3_packed(corners[0], sizeof *corners, RG_U32);
    views.triangle_count = 12;
    MUST(rg_shape_create_mesh(NULL, &views, &cube));
    return cube;
}

void lanes_begin(struct lanes *lanes, rg_scene *scene, bool masks, uint64_t seed) {
    const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1}, a[3] = {0, -0.5, 0}, b[3] = {0, 0.5, 0};
    memset(lanes, 0, sizeof *lanes);
    lanes->scene = scene;
    lanes->masks = masks;
    lanes->seed = seed;
    MUST(rg_grid_create(scene, NULL, &lanes->still_grid));
    MUST(rg_shape_create_sphere(NULL, 1, &lanes->shapes[0]));
    MUST(rg_shape_create_box(NULL, lo, hi, &lanes->shapes[1]));
    MUST(rg_shape_create_capsule(NULL, a, b, 1, &lanes->shapes[2]));
    lanes->shapes[3] = create_cube();
    for (int i = 0; i < LANES; i++) {
        const rg_pose pose = pose_of(lanes, i, 0);
        insert(lanes, i, &pose, false);
    }
}

void lanes_end(struct lanes *lanes) {
    for (int i = 0; i < 4; i++) rg_shape_release(&lanes->shapes[i]);
}

uint64_t lanes_count(const struct lanes *lanes) {
    uint64_t count = 0;
    for (int i = 0; i < LANES; i++) count += lane_state_of(lanes, i, lanes->all[i].done) != LANE_EMPTY;
    return count;
}

/* ------------------------------------------------------------------------------------------------ judging */

/* Across: from between the lanes to the middle of this one. */
static const double ASIDE = 1.5;

rg_ray lane_ray(const struct lanes *lanes, const struct lane_look *look) {
    const double y = APART * (look->lane % ROW), z = APART * (look->lane / ROW);
    const double along[3] = {look->way == LANE_BACKWARD ? FAR_AWAY : -FAR_AWAY, y, z};
    const double aside[3] = {lane_x(lanes, look->lane, look->aim), y, z - ASIDE};
    const double direction[LANE_WAYS][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    rg_ray ray = rg_ray_from(look->way == LANE_ACROSS ? aside : along, direction[look->way]);
    if (look->way == LANE_ACROSS) ray.t_max = ASIDE;
    ray.mask = RAY_MASK;
    return ray;
}

/* The t that a state shows, +inf for none; NaN if it may be any: what looks across just misses the middle. */
static double t_of(const struct lanes *lanes, const struct lane_look *look, uint64_t number) {
    if (lane_state_of(lanes, look->lane, number) != LANE_SEEN) return INFINITY;
    double x = lane_x(lanes, look->lane, number);
    if (look->way != LANE_ACROSS) return (look->way == LANE_BACKWARD ? -x : x) + FAR_AWAY - 1;
    double beside = fabs(x - lane_x(lanes, look->lane, look->aim));
    return beside == 0 ? ASIDE - 1 : beside < 2 ? (double)NAN : INFINITY;
}

/* The id of what a state shows, once its change is done; 0 if it has been forgotten. */
static rg_object id_of(const struct lane *lane, uint64_t number) {
    while (__atomic_load_n(&lane->done, __ATOMIC_SEQ_CST) < number) continue;
    uint64_t inserts = __atomic_load_n(&lane->inserts, __ATOMIC_SEQ_CST), at = inserts;
    while (at > 0 && inserts - at < IDS && __atomic_load_n(&lane->since[(at - 1) % IDS], __ATOMIC_SEQ_CST) > number)
        at--;
    if (at == 0 || inserts - at >= IDS) return RG_NO_OBJECT;
    rg_object id = __atomic_load_n(&lane->ids[(at - 1) % IDS], __ATOMIC_SEQ_CST);
    /* It may have been written over meanwhile. */
    bool kept = __atomic_load_n(&lane->inserts, __ATOMIC_SEQ_CST) - at < IDS - 1;
    return kept ? id : RG_NO_OBJECT;
}

static bool shows(const struct lanes *lanes, const struct lane_look *look, uint64_t number, const rg_hit *hit) {
    double t = t_of(lanes, look, number);
    if (isnan(t)) return true;
    if (t == INFINITY) return hit->object == RG_NO_OBJECT && hit->t == INFINITY;
    return hit->object != RG_NO_OBJECT && fabs(hit->t - t) <= 0x1p-30;
}

/* Whether a hit that may be of this state is of the object that was there then. */
static bool has_id(const struct lanes *lanes, const struct lane_look *look, uint64_t number, const rg_hit *hit) {
    rg_object id = hit->object == RG_NO_OBJECT ? RG_NO_OBJECT : id_of(&lanes->all[look->lane], number);
    return id == RG_NO_OBJECT || id == hit->object;
}

bool lane_judge(const struct lanes *lanes, const struct lane_look *look, struct lane_span span, const rg_hit *hit,
                const char **why) {
    bool placed = false, was = false;
    for (uint64_t number = span.from; number <= span.to; number++) {
        if (!shows(lanes, look, number, hit)) continue;
        if (has_id(lanes, look, number, hit)) return true;
        placed = true;
    }
    for (uint64_t number = 0; number < span.from; number++) was |= shows(lanes, look, number, hit);
    *why = placed                        ? "the right place under the id of another object"
           : hit->object == RG_NO_OBJECT ? "nothing, where something was all the time"
           : was                         ? "a ghost: where the object had been before the call began"
                                         : "a place where the object never was";
    return false;
}

bool lane_judge_occluded(const struct lanes *lanes, const struct lane_look *look, struct lane_span span,
                         bool occluded) {
    for (uint64_t number = span.from; number <= span.to; number++) {
        double t = t_of(lanes, look, number);
        if (isnan(t) || (t < INFINITY) == occluded) return true;
    }
    return false;
}
