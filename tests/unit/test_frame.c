/* SPDX-License-Identifier: MIT */
/* Frames: what they show is what the scene held at their last update, to the bit, whatever happened since. */
#include "unit.h"

#include <raygrid/raygrid.h>

#include <pthread.h>
#include <stdbool.h>
#include <string.h>

enum { MOST = 300, RAYS = 200 };

static rg_scene *scene, *frame;
static rg_shape *shapes[3];
static rg_object ids[MOST];
static int count;
static rg_ray rays[RAYS];
static rg_hit before[RAYS], after[RAYS];
static rg_object_report reports[MOST]; /* of the last update; of objects that there were */
static rg_object reported[MOST];
static long blocks_left;

static void *allocate(void *user, size_t size, size_t alignment) {
    void *block;
    (void)user;
    if (blocks_left == 0 || posix_memalign(&block, alignment, size)) return NULL;
    blocks_left -= blocks_left > 0;
    return block;
}

static void release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(block);
}

static const rg_scene_config scarce = {.size = sizeof scarce, .workers = 1, .allocator = {NULL, allocate, release}};

static void begin(void) {
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    blocks_left = -1;
    count = 0;
    memset(ids, 0, sizeof ids);
    memset(reported, 0, sizeof reported);
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &shapes[0]), RG_OK);
    ck_assert_int_eq(rg_shape_create_box(NULL, (double[]){-1, -2, -1}, (double[]){1, 1, 3}, &shapes[1]), RG_OK);
    ck_assert_int_eq(rg_shape_create_capsule(NULL, (double[]){0, 0, 0}, (double[]){2, 1, 0}, 0.5, &shapes[2]), RG_OK);
    ck_assert_int_eq(rg_scene_create(&config, &scene), RG_OK);
    for (int i = 0; i < RAYS; i++) {
        double origin[3], direction[3];
        for (int a = 0; a < 3; a++) {
            origin[a] = 80 * unit_random() - 40;
            direction[a] = 2 * unit_random() - 1;
        }
        rays[i] = rg_ray_from(origin, direction);
        rays[i].mask = 1u << i % 3;
    }
}

static void end(void) {
    ck_assert_int_eq(rg_scene_destroy(&frame), RG_OK);
    ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
    for (int i = 0; i < 3; i++) rg_shape_release(&shapes[i]);
}

/* ------------------------------------------------------------------------------------------ what happens */

static rg_pose any_pose(void) {
    rg_pose pose = rg_pose_at(60 * unit_random() - 30, 60 * unit_random() - 30, 60 * unit_random() - 30);
    pose.scale = 0.5 + unit_random();
    for (int i = 0; i < 9 && unit_random() < 0.9; i += 4) pose.linear[i] = (float)(0.5 + unit_random());
    if (unit_random() < 0.3) pose.linear[1] = 0.25f;
    return pose;
}

static rg_grid any_grid(void) {
    rg_grid grid = RG_GRID_OF_SCENE;
    rg_grid_config config = {.size = sizeof config, .kind = 1 + (rg_grid_kind)(unit_random() * 3)};
    if (unit_random() < 0.5) ck_assert_int_eq(rg_grid_create(scene, &config, &grid), RG_OK);
    return grid;
}

static void insert_one(int i) {
    static rg_grid last;
    const rg_pose pose = any_pose();
    rg_pose_views poses;
    rg_insert_views views = {.size = sizeof views, .shapes = &shapes[i % 3], .poses = &poses};
    const uint32_t mask = unit_random() < 0.7 ? UINT32_MAX : 5;
    const rg_output out = {&ids[i], 0, RG_U64};
    if (unit_random() < 0.05) last = any_grid();
    views.grid = last;
    views.mask = (rg_input){&mask, 0, RG_U32};
    ck_assert_int_eq(rg_pose_views_of(&poses, sizeof poses, &pose, 0), RG_OK);
    rg_result result = rg_scene_insert_many(scene, &views, 1, &out);
    if (result == RG_INVALID_ID) {
        last = RG_GRID_OF_SCENE;
        views.grid = last;
        result = rg_scene_insert_many(scene, &views, 1, &out);
    }
    ck_assert_int_eq(result, RG_OK);
}

static void change_one(void) {
    int i = (int)(unit_random() * MOST);
    double what = unit_random();
    if (!ids[i]) {
        insert_one(i);
        count++;
    } else if (what < 0.2) {
        ck_assert_int_eq(rg_scene_remove(scene, ids[i]), RG_OK);
        ids[i] = RG_NO_OBJECT;
        count--;
    } else if (what < 0.6) {
        const rg_pose pose = any_pose();
        ck_assert_int_eq(rg_scene_move_to(scene, ids[i], pose.position), RG_OK);
    } else if (what < 0.9) {
        const rg_pose pose = any_pose();
        ck_assert_int_eq(rg_scene_move(scene, ids[i], &pose), RG_OK);
    } else {
        ck_assert_int_eq(rg_scene_set_mask(scene, ids[i], what < 0.95 ? 3 : UINT32_MAX), RG_OK);
    }
    for (rg_grid g = 1; what > 0.99 && g < 3000; g++) (void)rg_grid_destroy(scene, g); /* those that are empty */
    if (what > 0.985 && what < 0.99) /* of all that have it */
        ck_assert_int_eq(rg_scene_replace_shape(scene, shapes[i % 3], shapes[(i + 1) % 3]), RG_OK);
    const rg_grid_config other = {.size = sizeof other, .kind = 1 + i % 3, .resolution = 4};
    if (what > 0.993) ck_assert_int_eq(rg_grid_configure(scene, RG_GRID_OF_SCENE, &other), RG_OK);
}

static void change(int times) {
    while (times--) change_one();
}

/* -------------------------------------------------------------------------------------- what must come of it */

static rg_object_report report_of(rg_scene *of, rg_object id) {
    rg_object_report r;
    memset(&r, 0, sizeof r);
    r.size = sizeof r;
    ck_assert_int_eq(rg_scene_lookup(of, id, &r), RG_OK);
    return r;
}

/* The frame has been updated: it is like the scene. */
static void note_update(void) {
    rg_scene_report a = {.size = sizeof a}, b = {.size = sizeof b};
    ck_assert_int_eq(rg_scene_stats(scene, &a), RG_OK);
    ck_assert_int_eq(rg_scene_stats(frame, &b), RG_OK);
    ck_assert_uint_eq(a.objects, b.objects);
    ck_assert_uint_eq(a.slots, b.slots);
    ck_assert_uint_eq(a.grids, b.grids);
    for (int i = 0; i < MOST; i++) {
        reported[i] = ids[i];
        if (!ids[i]) continue;
        reports[i] = report_of(scene, ids[i]);
        const rg_object_report of_frame = report_of(frame, ids[i]);
        MUST(memcmp(&reports[i], &of_frame, sizeof of_frame) == 0);
    }
    ck_assert_int_eq(rg_scene_trace(scene, rays, before, RAYS), RG_OK);
    ck_assert_int_eq(rg_scene_trace(frame, rays, after, RAYS), RG_OK);
    ck_assert_mem_eq(before, after, sizeof before);
}

/* The scene has changed: the frame has not. */
static void check_frame(void) {
    for (int i = 0; i < MOST; i++) {
        if (!reported[i]) continue;
        const rg_object_report r = report_of(frame, reported[i]);
        MUST(memcmp(&reports[i], &r, sizeof r) == 0);
    }
    ck_assert_int_eq(rg_scene_trace(frame, rays, after, RAYS), RG_OK);
    ck_assert_mem_eq(before, after, sizeof before);
}

START_TEST(it_is_what_the_scene_was) {
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    begin();
    change(_i ? 1000 : 0);
    ck_assert_int_eq(rg_scene_create_frame(scene, &config, &frame), RG_OK);
    for (int turn = 0; turn < 60; turn++) {
        note_update();
        change((int)(200 * unit_random() * unit_random()));
        check_frame();
        ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
    }
    note_update();
    end();
}
END_TEST

/* A frame is a scene: it may have frames. */
START_TEST(frames_of_frames) {
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    rg_scene *second;
    begin();
    change(500);
    ck_assert_int_eq(rg_scene_create_frame(scene, &config, &frame), RG_OK);
    ck_assert_int_eq(rg_scene_create_frame(frame, &config, &second), RG_OK);
    for (int turn = 0; turn < 10; turn++) {
        change(100);
        ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
        note_update();
        ck_assert_int_eq(rg_scene_update_frame(second), RG_OK);
        ck_assert_int_eq(rg_scene_trace(second, rays, after, RAYS), RG_OK);
        ck_assert_mem_eq(before, after, sizeof before);
    }
    ck_assert_int_eq(rg_scene_destroy(&second), RG_OK);
    end();
}
END_TEST

START_TEST(what_is_refused) {
    rg_scene *other = NULL;
    rg_pose pose = rg_pose_at(0, 0, 0);
    rg_grid grid;
    begin();
    change(50);
    ck_assert_int_eq(rg_scene_create_frame(NULL, NULL, &frame), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_create_frame(scene, NULL, NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_create_frame(scene, NULL, &frame), RG_OK);
    note_update();
    ck_assert_int_eq(rg_scene_update_frame(NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_update_frame(scene), RG_INVALID_ARGUMENT);
    rg_object id = RG_NO_OBJECT;
    for (int i = 0; !id; i++) id = ids[i];
    ck_assert_int_eq(rg_scene_insert(frame, shapes[0], &pose, NULL), RG_BUSY);
    ck_assert_int_eq(rg_scene_move(frame, id, &pose), RG_BUSY);
    ck_assert_int_eq(rg_scene_move_to(frame, id, pose.position), RG_BUSY);
    ck_assert_int_eq(rg_scene_remove(frame, id), RG_BUSY);
    ck_assert_int_eq(rg_scene_set_mask(frame, id, 1), RG_BUSY);
    ck_assert_int_eq(rg_grid_create(frame, NULL, &grid), RG_BUSY);
    ck_assert_int_eq(rg_grid_rebuild(frame, RG_GRID_OF_SCENE), RG_BUSY);
    check_frame();
    other = scene;
    ck_assert_int_eq(rg_scene_destroy(&other), RG_BUSY);
    ck_assert_ptr_eq(other, scene);
    check_frame();
    end();
}
END_TEST

/* The memory ends at each point of making a frame, and of an update: the next one makes up for it. */
START_TEST(without_memory) {
    begin();
    change(400);
    long blocks = 0;
    for (rg_result result = RG_OUT_OF_MEMORY; result; blocks++) {
        blocks_left = blocks;
        frame = NULL;
        result = rg_scene_create_frame(scene, &scarce, &frame);
        ck_assert(result == RG_OK || (result == RG_OUT_OF_MEMORY && !frame));
    }
    ck_assert_int_gt(blocks, 5);
    for (int turn = 0; turn < 20; turn++) {
        blocks_left = turn;
        change(40);
        rg_result result = rg_scene_update_frame(frame);
        ck_assert(result == RG_OK || result == RG_OUT_OF_MEMORY);
        change(20);
        blocks_left = -1;
        ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
        note_update();
    }
    end();
}
END_TEST

/* ------------------------------------------------------------------------------------------------- threads */

enum { PAIRS = 64, TURNS = SHORT_TESTS ? 100 : 1000 };

static rg_object pairs[PAIRS][2];
static int finished; /* atomic */

/* Two objects each, moved in one call to the same x. */
static void *move_pairs(void *unused) {
    for (int turn = 0; turn < TURNS; turn++) {
        for (int i = 0; i < PAIRS; i++) {
            double at[2][3] = {{100 * unit_random(), 4.0 * i, 0}, {0, 4.0 * i, 4}};
            const rg_input objects = {pairs[i], sizeof **pairs, RG_U64};
            rg_pose_views poses = {.size = sizeof poses, .position = rg_input3_packed(at[0], sizeof *at, RG_F64)};
            at[1][0] = at[0][0];
            MUST(rg_scene_move_many(scene, &objects, &poses, 2) == RG_OK);
        }
    }
    __atomic_store_n(&finished, 1, __ATOMIC_RELEASE);
    return unused;
}

/* However long a trace of the frame takes, it sees one instant. */
START_TEST(one_instant_for_all_rays) {
    const rg_scene_config config = {.size = sizeof config, .workers = 2};
    static rg_ray along[2 * PAIRS];
    static rg_hit hits[2 * PAIRS];
    pthread_t mover;
    int updates = 0;
    begin();
    finished = 0;
    for (int i = 0; i < 2 * PAIRS; i++) {
        const rg_pose pose = rg_pose_at(0, 4.0 * (i / 2), 4.0 * (i % 2));
        ck_assert_int_eq(rg_scene_insert(scene, shapes[0], &pose, &pairs[i / 2][i % 2]), RG_OK);
        along[i] = rg_ray_from((double[]){-50, 4.0 * (i / 2), 4.0 * (i % 2)}, (double[]){1, 0, 0});
    }
    ck_assert_int_eq(rg_scene_create_frame(scene, &config, &frame), RG_OK);
    ck_assert_int_eq(pthread_create(&mover, NULL, move_pairs, NULL), 0);
    while (!__atomic_load_n(&finished, __ATOMIC_ACQUIRE) || !updates) {
        ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
        updates++;
        ck_assert_int_eq(rg_scene_trace(frame, along, hits, 2 * PAIRS), RG_OK);
        for (int i = 0; i < PAIRS; i++) {
            MUST(hits[2 * i].object == pairs[i][0] && hits[2 * i + 1].object == pairs[i][1]);
            MUST(hits[2 * i].t == hits[2 * i + 1].t);
        }
    }
    pthread_join(mover, NULL);
    end();
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("frame");
    TCase *tests = tcase_create("frame");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, it_is_what_the_scene_was, 0, 2);
    tcase_add_test(tests, frames_of_frames);
    tcase_add_test(tests, what_is_refused);
    tcase_add_test(tests, without_memory);
    tcase_add_test(tests, one_instant_for_all_rays);
    suite_add_tcase(suite, tests);
    return suite;
}
