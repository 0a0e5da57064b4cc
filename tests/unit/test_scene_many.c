/* SPDX-License-Identifier: MIT */
/* Many objects moved by the workers: as if it had been one thread, one object after the other. */
#include "unit.h"

#include <raygrid/raygrid.h>

#include <stdbool.h>
#include <string.h>

enum { OBJECTS = 5200, RAYS = 400, TURNS = SHORT_TESTS ? 3 : 30, FAR_TURNS = SHORT_TESTS ? 40 : 80 };

/* Balls of lattices are shared out whole, of all others the first look at them. */
static const struct form {
    bool boxes;
    rg_grid_kind kind;
} forms[] = {{false, RG_GRID_LOOSE}, {true, RG_GRID_LOOSE}, {false, RG_GRID_HIERARCHICAL}, {true, RG_GRID_UNIFORM}};

enum { FORMS = sizeof forms / sizeof *forms, LOOSE_FORMS = 2, MOST_WORKERS = 4 };

/* The same twice: moved by one thread, and by several. */
static rg_scene *scenes[2];
static rg_shape *shape;
static rg_object ids[2][OBJECTS];
static double at[OBJECTS][3];

static void begin(uint32_t workers, struct form form) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = form.kind};
    rg_pose_views poses = {.size = sizeof poses, .position = rg_input3_packed(at[0], sizeof *at, RG_F64)};
    if (form.boxes)
        ck_assert_int_eq(rg_shape_create_box(NULL, (double[]){-1, -0.5, -1}, (double[]){1, 0.5, 1}, &shape), RG_OK);
    else
        ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &shape), RG_OK);
    for (int i = 0; i < OBJECTS; i++) {
        for (int a = 0; a < 3; a++) at[i][a] = 100 * unit_random();
    }
    for (int s = 0; s < 2; s++) {
        const rg_scene_config config = {.size = sizeof config, .workers = s ? workers : 1, .grid = &grid};
        const rg_insert_views views = {.size = sizeof views, .shapes = &shape, .poses = &poses};
        const rg_output out = {ids[s], sizeof(rg_object), RG_U64};
        ck_assert_int_eq(rg_scene_create(&config, &scenes[s]), RG_OK);
        ck_assert_int_eq(rg_scene_insert_many(scenes[s], &views, OBJECTS, &out), RG_OK);
    }
}

static void end(void) {
    for (int s = 0; s < 2; s++) ck_assert_int_eq(rg_scene_destroy(&scenes[s]), RG_OK);
    rg_shape_release(&shape);
}

static void check(void) {
    static rg_ray rays[RAYS];
    static rg_hit hits[2][RAYS];
    for (int i = 0; i < RAYS; i++) {
        double origin[3], direction[3];
        for (int a = 0; a < 3; a++) {
            origin[a] = 120 * unit_random() - 10;
            direction[a] = unit_random() - 0.5;
        }
        rays[i] = rg_ray_from(origin, direction);
    }
    for (int s = 0; s < 2; s++) ck_assert_int_eq(rg_scene_trace(scenes[s], rays, hits[s], RAYS), RG_OK);
    ck_assert_mem_eq(hits[0], hits[1], sizeof hits[0]);
    for (int i = 0; i < OBJECTS; i += 7) {
        rg_object_report report = {.size = sizeof report};
        MUST(rg_scene_lookup(scenes[1], ids[1][i], &report) == RG_OK);
        MUST(memcmp(report.pose.position, at[i], sizeof at[i]) == 0);
    }
}

/* Moves the object that a list names to the place beside it, in both scenes. */
static rg_result move_both(const int *which, double (*to)[3], int count) {
    static rg_object named[2 * OBJECTS];
    rg_pose_views poses = {.size = sizeof poses, .position = rg_input3_packed(to[0], sizeof *to, RG_F64)};
    const rg_input objects = {named, sizeof *named, RG_U64};
    rg_result results[2];
    for (int s = 0; s < 2; s++) {
        for (int i = 0; i < count; i++) named[i] = ids[s][which[i]];
        results[s] = rg_scene_move_many(scenes[s], &objects, &poses, (uint64_t)count);
    }
    ck_assert_int_eq(results[0], results[1]);
    for (int i = 0; i < count && !results[0]; i++) memcpy(at[which[i]], to[i], sizeof *to);
    return results[0];
}

static void any_moves(int *which, double (*to)[3], int count, double step) {
    for (int i = 0; i < count; i++) {
        which[i] = count < OBJECTS ? (int)(((unsigned)i * 7919u) % OBJECTS) : i;
        for (int a = 0; a < 3; a++) to[i][a] = at[which[i]][a] + step * (2 * unit_random() - 1);
    }
}

static int which[2 * OBJECTS];
static double to[2 * OBJECTS][3];

START_TEST(as_by_one_thread) {
    const double steps[] = {0.05, 1, 30};
    begin(2 + (uint32_t)_i / FORMS, forms[_i % FORMS]);
    for (int turn = 0; turn < TURNS; turn++) {
        int count = turn % 2 ? OBJECTS : 4200;
        any_moves(which, to, count, steps[turn % 3]);
        ck_assert_int_eq(move_both(which, to, count), RG_OK);
        check();
    }
    end();
}
END_TEST

/* One that is named twice ends at its last place. */
START_TEST(named_twice) {
    begin(3, forms[_i]);
    for (int turn = 0; turn < 6; turn++) {
        any_moves(which, to, OBJECTS, 1);
        for (int i = 0; i < OBJECTS; i++) {
            which[OBJECTS + i] = turn % 2 ? OBJECTS - 1 - i : i;
            for (int a = 0; a < 3; a++) to[OBJECTS + i][a] = to[i][a] + 0.25;
        }
        ck_assert_int_eq(move_both(which, to, turn < 3 ? OBJECTS + 1 : 2 * OBJECTS), RG_OK);
        check();
    }
    end();
}
END_TEST

/* One that can't be moved: none is. */
START_TEST(all_or_none) {
    begin(3, forms[_i]);
    any_moves(which, to, OBJECTS, 1);
    to[OBJECTS - 5][1] = NAN;
    ck_assert_int_eq(move_both(which, to, OBJECTS), RG_INVALID_VALUE);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "object 5195 of the call"));
    check();
    any_moves(which, to, OBJECTS, 1);
    for (int s = 0; s < 2; s++) {
        ck_assert_int_eq(rg_scene_remove(scenes[s], ids[s][4000]), RG_OK);
    }
    ck_assert_int_eq(move_both(which, to, OBJECTS), RG_INVALID_ID);
    for (int s = 0; s < 2; s++) {
        const rg_pose pose = rg_pose_at(at[4000][0], at[4000][1], at[4000][2]);
        ck_assert_int_eq(rg_scene_insert(scenes[s], shape, &pose, &ids[s][4000]), RG_OK);
    }
    check();
    ck_assert_int_eq(move_both(which, to, OBJECTS), RG_OK);
    check();
    end();
}
END_TEST

/* Not all of them plain balls: then it goes another way. */
START_TEST(mixed) {
    begin(3, forms[_i]);
    rg_pose pose = rg_pose_at(at[17][0], at[17][1], at[17][2]);
    pose.linear[1] = 0.5f;
    for (int s = 0; s < 2; s++) ck_assert_int_eq(rg_scene_move(scenes[s], ids[s][17], &pose), RG_OK);
    for (int turn = 0; turn < 4; turn++) {
        any_moves(which, to, OBJECTS, 1);
        ck_assert_int_eq(move_both(which, to, OBJECTS), RG_OK);
        check();
    }
    end();
}
END_TEST

/* Carried far away, so that loose grids are made anew meanwhile. */
START_TEST(through_rebuilds) {
    begin(2, forms[_i]);
    for (int turn = 0; turn < FAR_TURNS; turn++) {
        any_moves(which, to, OBJECTS, 1);
        for (int i = 0; i < OBJECTS; i++) to[i][0] += 100;
        ck_assert_int_eq(move_both(which, to, OBJECTS), RG_OK);
        if (turn % 4 == 0) check();
    }
    rg_grid_report report = {.size = sizeof report};
    ck_assert_int_eq(rg_grid_stats(scenes[0], RG_GRID_OF_SCENE, &report), RG_OK);
    ck_assert_uint_gt(report.rebuilds, 0);
    end();
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("scene_many");
    TCase *tests = tcase_create("scene_many");
    tcase_set_timeout(tests, 100);
    tcase_add_loop_test(tests, as_by_one_thread, 0, (MOST_WORKERS - 1) * FORMS);
    tcase_add_loop_test(tests, named_twice, 0, FORMS);
    tcase_add_loop_test(tests, all_or_none, 0, FORMS);
    tcase_add_loop_test(tests, mixed, 0, FORMS);
    tcase_add_loop_test(tests, through_rebuilds, 0, LOOSE_FORMS);
    suite_add_tcase(suite, tests);
    return suite;
}
