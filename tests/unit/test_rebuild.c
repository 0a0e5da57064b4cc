/* SPDX-License-Identifier: MIT */
/* Rebuilds beside the grid that serves: whatever changes meanwhile, every ray finds what is there, at every step. */
#include "unit.h"

#include <raygrid/raygrid.h>

#include <stdbool.h>
#include <string.h>

enum { MANY = 600, RAYS = 4 };

static const rg_grid_kind kinds[] = {RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL, RG_GRID_LOOSE};

/* Where the objects are taken one after another: each time so far that every kind of grid must be rebuilt. */
static const double places[] = {1e4, -2e4, 4e4, -8e4};

/* What the scene must hold. */
static struct {
    rg_scene *scene;
    rg_shape *forms[3]; /* that the objects have one after the other */
    int form;
    rg_object ids[MANY]; /* 0: none */
    double at[MANY][3];
    long blocks_left; /* that the allocator still gives; below 0: all */
    uint64_t bytes;
} w;

static void *allocate(void *user, size_t size, size_t alignment) {
    void *block;
    (void)user;
    if (w.blocks_left == 0 || posix_memalign(&block, alignment, size)) return NULL;
    __atomic_fetch_sub(&w.blocks_left, w.blocks_left > 0, __ATOMIC_RELAXED);
    __atomic_fetch_add(&w.bytes, size, __ATOMIC_RELAXED);
    return block;
}

static void release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)alignment;
    __atomic_fetch_sub(&w.bytes, size, __ATOMIC_RELAXED);
    free(block);
}

/* Half as wide along x as that: the last is the larger one. */
static double half_width(void) {
    return w.form == 2 ? 1.25 : 1;
}

static void make_forms(void) {
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &w.forms[0]), RG_OK);
    ck_assert_int_eq(rg_shape_create_box(NULL, (double[]){-1, -1, -1}, (double[]){1, 1, 1}, &w.forms[1]), RG_OK);
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1.25, &w.forms[2]), RG_OK);
}

/* All objects get another form at once. */
static rg_result reform(void) {
    rg_result result = rg_scene_replace_shape(w.scene, w.forms[w.form], w.forms[(w.form + 1) % 3]);
    if (!result) w.form = (w.form + 1) % 3;
    return result;
}

static void begin(rg_grid_kind kind, uint32_t workers) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {
        .size = sizeof config, .workers = workers, .grid = &grid, .allocator = {NULL, allocate, release}};
    memset(&w, 0, sizeof w);
    w.blocks_left = -1;
    make_forms();
    ck_assert_int_eq(rg_scene_create(&config, &w.scene), RG_OK);
}

static void end(void) {
    ck_assert_int_eq(rg_scene_destroy(&w.scene), RG_OK);
    for (int i = 0; i < 3; i++) rg_shape_release(&w.forms[i]);
    ck_assert_uint_eq(w.bytes, 0);
}

static rg_grid_report report(void) {
    rg_grid_report r = {.size = sizeof r};
    ck_assert_int_eq(rg_grid_stats(w.scene, RG_GRID_OF_SCENE, &r), RG_OK);
    return r;
}

/* Objects are at whole y and z times 3, so that no two are in each other's way; along x anywhere near `far`. */
static void place(int i, double far) {
    w.at[i][0] = far * (1 + 0.1 * unit_random());
    w.at[i][1] = 3 * (i % 25);
    w.at[i][2] = 3 * (i / 25);
}

static rg_result insert(int i, double far) {
    place(i, far);
    const rg_pose pose = rg_pose_at(w.at[i][0], w.at[i][1], w.at[i][2]);
    return rg_scene_insert(w.scene, w.forms[w.form], &pose, &w.ids[i]);
}

static rg_result move(int i, double far) {
    const double before[3] = {w.at[i][0], w.at[i][1], w.at[i][2]};
    place(i, far);
    rg_result result = rg_scene_move_to(w.scene, w.ids[i], w.at[i]);
    if (result) memcpy(w.at[i], before, sizeof before);
    return result;
}

static void take_away(int i) {
    ck_assert_int_eq(rg_scene_remove(w.scene, w.ids[i]), RG_OK);
    w.ids[i] = RG_NO_OBJECT;
}

/* From nearby, in any direction: no other ball reaches where that ray begins or passes. */
static void check_from_nearby(int i) {
    double way[3], from[3];
    for (int k = 0; k < 3; k++) way[k] = 0.01 + unit_random();
    if (unit_random() < 0.5) way[0] = -way[0];
    double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    for (int k = 0; k < 3; k++) from[k] = w.at[i][k] - 1.9 / length * way[k];
    const rg_ray ray = rg_ray_from(from, way);
    rg_hit hit;
    MUST(rg_scene_trace(w.scene, &ray, &hit, 1) == RG_OK);
    MUST(hit.object == w.ids[i]);
    MUST(fabs(hit.t * length - 0.9) <= 0x1p-30);
}

static void check(int i) {
    const rg_ray ray = rg_ray_from((double[]){-1e5, 3 * (i % 25), 3 * (i / 25)}, (double[]){1, 0, 0});
    rg_hit hit;
    MUST(rg_scene_trace(w.scene, &ray, &hit, 1) == RG_OK);
    MUST(hit.object == w.ids[i]);
    MUST(!w.ids[i] || fabs(hit.t - (w.at[i][0] - half_width() + 1e5)) <= 0x1p-30);
    if (w.ids[i] && w.form == 0) check_from_nearby(i);
}

static void check_some(void) {
    for (int k = 0; k < RAYS; k++) check((int)(unit_random() * MANY));
}

static void check_all(void) {
    uint64_t count = 0;
    for (int i = 0; i < MANY; i++) {
        check(i);
        count += w.ids[i] != RG_NO_OBJECT;
    }
    ck_assert_uint_eq(report().objects, count);
}

/* Something happens to an object. */
static rg_result change(int i, double far) {
    if (!w.ids[i]) return insert(i, far);
    if (unit_random() < 0.8) return move(i, far);
    take_away(i);
    return RG_OK;
}

/* Changes objects, one after another, until a rebuild is under way, or, with workers, has been made. */
static void until_rebuilding(double far) {
    uint64_t before = report().rebuilds;
    for (int n = 0; n < 100 * MANY; n++) {
        ck_assert_int_eq(change(n % MANY, far), RG_OK);
        check_some();
        if (report().rebuilding || report().rebuilds > before) return;
    }
    ck_abort_msg("no rebuild begins");
}

static void fill(double far) {
    for (int i = 0; i < MANY; i++) ck_assert_int_eq(insert(i, far), RG_OK);
    for (int n = 0; n < 100 * MANY && report().rebuilding; n++) ck_assert_int_eq(move(n % MANY, far), RG_OK);
    ck_assert_uint_eq(report().rebuilding, 0);
}

/* Without workers the changes make the steps. */
START_TEST(by_the_changes) {
    begin(kinds[_i], 1);
    fill(10);
    uint64_t before = report().rebuilds, during = 0;
    for (int turn = 0; turn < 4; turn++) {
        double far = places[turn];
        until_rebuilding(far);
        while (report().rebuilding) {
            ck_assert_int_eq(change((int)(unit_random() * MANY), far), RG_OK);
            check_some();
            during++;
            if (during % 16 == 9) {
                ck_assert_int_eq(reform(), RG_OK);
                check_all();
            }
        }
        check_all();
    }
    ck_assert_uint_ge(report().rebuilds, before + 4);
    ck_assert_uint_ge(during, 4 * 10);
    end();
}
END_TEST

/* A worker makes them while changes and rays go on. */
START_TEST(by_a_worker) {
    begin(kinds[_i], 2);
    fill(10);
    for (int turn = 0; turn < (SHORT_TESTS ? 4 : 12); turn++) {
        double far = places[turn % 4];
        uint64_t before = report().rebuilds;
        until_rebuilding(far);
        for (int n = 0; n < 100 * MANY && (report().rebuilding || report().rebuilds == before); n++) {
            ck_assert_int_eq(change((int)(unit_random() * MANY), far), RG_OK);
            check_some();
            if (n % 64 == 20) ck_assert_int_eq(reform(), RG_OK);
        }
        ck_assert_uint_gt(report().rebuilds, before);
        check_all();
    }
    end();
}
END_TEST

/* A worker ends it though nobody calls any more. */
START_TEST(by_a_worker_alone) {
    begin(kinds[_i], 2);
    fill(10);
    until_rebuilding(1e4);
    while (report().rebuilding) continue;
    /* When reports say so, the old grid's memory is free already. */
    uint64_t bytes = __atomic_load_n(&w.bytes, __ATOMIC_RELAXED);
    check_all();
    ck_assert_uint_eq(__atomic_load_n(&w.bytes, __ATOMIC_RELAXED), bytes);
    end();
}
END_TEST

/* The memory ends at each point of it: the grid serves on as it is, and no call fails because of the other one. */
START_TEST(without_memory) {
    for (long blocks = 0; blocks < 40; blocks += SHORT_TESTS ? 5 : 1) {
        begin(kinds[_i], 1);
        fill(10);
        until_rebuilding(1e4);
        w.blocks_left = blocks;
        for (int n = 0; n < 200; n++) {
            int i = (int)(unit_random() * MANY);
            if (w.ids[i]) (void)move(i, 1e4);
            if (n % 50 == 20) (void)reform();
            check_some();
        }
        w.blocks_left = -1;
        for (int n = 0; n < 100 * MANY && (report().rebuilding || n < 4 * MANY); n++)
            ck_assert_int_eq(change(n % MANY, 1e4), RG_OK);
        ck_assert_uint_eq(report().rebuilding, 0);
        check_all();
        end();
    }
}
END_TEST

/* Other calls put an end to it. */
START_TEST(dropped) {
    for (int how = 0; how < 4; how++) {
        const rg_grid_config other = {.size = sizeof other, .kind = kinds[(_i + how) % 3]};
        begin(kinds[_i], how % 2 ? 2 : 1);
        fill(10);
        until_rebuilding(1e4);
        if (how < 2) ck_assert_int_eq(rg_grid_configure(w.scene, RG_GRID_OF_SCENE, &other), RG_OK);
        if (how == 2) ck_assert_int_eq(rg_grid_rebuild(w.scene, RG_GRID_OF_SCENE), RG_OK);
        if (how < 3) {
            ck_assert_uint_eq(report().rebuilding, 0);
            check_all();
        }
        end();
    }
}
END_TEST

/* Calls on many, which go other ways. */
START_TEST(calls_on_many) {
    begin(kinds[_i], 1);
    fill(10);
    double far = 1e4;
    uint64_t before = report().rebuilds;
    for (int turn = 0; turn < 200; turn++) {
        rg_object ids[64];
        double at[64][3];
        const rg_input objects = {ids, sizeof *ids, RG_U64};
        rg_pose_views poses = {.size = sizeof poses, .position = rg_input3_packed(at[0], sizeof *at, RG_F64)};
        if (turn % 50 == 49) far *= -2;
        for (int k = 0; k < 64; k++) {
            int i = (turn * 64 + k) % MANY;
            place(i, far);
            ids[k] = w.ids[i];
            memcpy(at[k], w.at[i], sizeof at[k]);
        }
        ck_assert_int_eq(rg_scene_move_many(w.scene, &objects, &poses, 64), RG_OK);
        check_some();
    }
    check_all();
    ck_assert_uint_gt(report().rebuilds, before);
    end();
}
END_TEST

/* The one whose slot is lowest is taken away last, so that its slot is used again first. */
static void take_half_away(void) {
    rg_object gone[MANY / 2];
    uint64_t count = 0;
    for (int i = MANY - 1; i >= MANY / 2; i--) {
        if (w.ids[i]) gone[count++] = w.ids[i];
        w.ids[i] = RG_NO_OBJECT;
    }
    const rg_input objects = {gone, sizeof *gone, RG_U64};
    ck_assert_int_eq(rg_scene_remove_many(w.scene, &objects, count), RG_OK);
}

static void move_first(void) {
    for (int i = 0; i < MANY; i++) {
        if (!w.ids[i]) continue;
        ck_assert_int_eq(move(i, 1e4), RG_OK);
        return;
    }
}

/* Tries to insert many more, with memory for so few blocks that it ends on the way. */
static void insert_in_vain(long blocks) {
    enum { MORE = 3000 };
    static rg_shape *shapes[MORE];
    static double at[MORE][3];
    rg_pose_views poses = {.size = sizeof poses, .position = rg_input3_packed(at[0], sizeof *at, RG_F64)};
    const rg_insert_views views = {
        .size = sizeof views, .shapes = shapes, .shapes_stride = sizeof *shapes, .poses = &poses};
    for (int i = 0; i < MORE; i++) {
        shapes[i] = w.forms[w.form];
        for (int k = 0; k < 3; k++) at[i][k] = -1e5 * (1 + unit_random());
    }
    w.blocks_left = blocks;
    ck_assert_int_eq(rg_scene_insert_many(w.scene, &views, MORE, NULL), RG_OUT_OF_MEMORY);
    w.blocks_left = -1;
}

/* A call for which memory ends takes back slots that the rebuild has passed already: it ends nevertheless. */
START_TEST(slots_taken_back) {
    for (int passed = 0; passed < MANY / 4; passed += SHORT_TESTS ? 5 : 1) {
        begin(kinds[_i], 1);
        fill(10);
        for (int n = 0; !report().rebuilding; n++) ck_assert_int_eq(move(n % MANY, 1e4), RG_OK);
        for (int n = 0; n < passed; n++) ck_assert_int_eq(move(n, 1e4), RG_OK);
        take_half_away();
        insert_in_vain(passed % 7);
        for (int n = 0; n < MANY && report().rebuilding; n++) move_first();
        ck_assert_uint_eq(report().rebuilding, 0);
        check_all();
        end();
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("rebuild");
    TCase *tests = tcase_create("rebuild");
    tcase_set_timeout(tests, 100);
    tcase_add_loop_test(tests, by_the_changes, 0, 3);
    tcase_add_loop_test(tests, by_a_worker, 0, 3);
    tcase_add_loop_test(tests, by_a_worker_alone, 0, 3);
    tcase_add_loop_test(tests, without_memory, 0, 3);
    tcase_add_loop_test(tests, dropped, 0, 3);
    tcase_add_loop_test(tests, calls_on_many, 0, 3);
    tcase_add_loop_test(tests, slots_taken_back, 0, 3);
    suite_add_tcase(suite, tests);
    return suite;
}
