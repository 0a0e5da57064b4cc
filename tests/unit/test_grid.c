/* SPDX-License-Identifier: MIT */
#include "grid.h"
#include "unit.h"
#include "vec.h"

#include <string.h>

static rgi_memory memory;
static int told;

static void tell(void *user, const char *message) {
    (void)user;
    told += message[0] == 'g';
}

static void make(rgi_grid *grid, rg_grid_kind kind, uint32_t resolution, bool box, double factor) {
    rg_grid_config config, given;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rg_grid_config_default(&given, sizeof given), RG_OK);
    given.kind = kind;
    given.resolution = resolution;
    given.rebuild_factor = factor;
    for (int a = 0; a < 3 && box; a++) given.hi[a] = 8;
    ck_assert_int_eq(rgi_grid_config_read(&config, &given), RG_OK);
    ck_assert_int_eq(rgi_grid_init(grid, &memory, &config, tell, NULL), RG_OK);
}

static uint32_t insert(rgi_grid *grid, double x, double y, double z, double size) {
    double lo[3] = {x, y, z}, hi[3] = {x + size, y + size, z + size};
    uint32_t member;
    ck_assert_int_eq(rgi_grid_insert(grid, 0, lo, hi, &member), RG_OK);
    rgi_grid_settle(grid);
    return member;
}

static void move(rgi_grid *grid, uint32_t member, double x, double size) {
    double lo[3] = {x, 1, 1}, hi[3] = {x + size, 1 + size, 1 + size};
    ck_assert_int_eq(rgi_grid_move(grid, member, lo, hi), RG_OK);
    rgi_grid_settle(grid);
}

static void done(rgi_grid *grid) {
    rgi_grid_free(grid);
    ck_assert_uint_eq(memory.bytes, 0);
}

START_TEST(rebuilt_when_the_diagonal_exceeds_the_factor) {
    const double factors[] = {1.5, 2, 3, RG_REBUILD_NEVER};
    for (int f = 0; f < 4; f++) {
        rgi_grid grid;
        make(&grid, RG_GRID_UNIFORM, 8, true, factors[f]);
        insert(&grid, 0, 0, 0, 1);
        insert(&grid, 7, 7, 7, 1);
        uint32_t out = insert(&grid, 4, 1, 1, 1);
        int expected = 0;
        for (int x = 8; x < 60; x++) {
            move(&grid, out, x, 1);
            double logical = sqrt((x + 1.0) * (x + 1) + 128), physical = sqrt(192);
            if (expected == 0 && factors[f] > 0 && logical > factors[f] * physical) expected = 1;
            if (expected) break;
            ck_assert_uint_eq(grid.rebuilds, 0);
            ck_assert(grid.hi[0] >= x + 1 && grid.cells.extent[0] == 8);
        }
        ck_assert_uint_eq(grid.rebuilds, (uint64_t)expected);
        if (expected) ck_assert(grid.cells.tile_count == 1 && grid.cells.extent[0] > 16);
        if (!expected) ck_assert_uint_gt(grid.cells.tile_count, 1);
        done(&grid);
    }
}
END_TEST

START_TEST(few_objects_have_no_cells) {
    rgi_grid grid;
    make(&grid, RG_GRID_HIERARCHICAL, 0, false, 2);
    for (int i = 0; i < 8; i++) {
        ck_assert_uint_eq(grid.cells.level_count, 0);
        insert(&grid, i, i, i, 0.5);
    }
    ck_assert_uint_eq(grid.cells.unbounded_count, 8);
    insert(&grid, 8, 8, 8, 0.5);
    ck_assert_uint_gt(grid.cells.level_count, 0);
    ck_assert_uint_eq(grid.cells.unbounded_count, 0);
    ck_assert_uint_eq(grid.cells.tile_count, 1);
    ck_assert_uint_eq(grid.rebuilds, 0);
    ck_assert_int_eq(rgi_grid_rebuild(&grid), RG_OK);
    ck_assert_uint_eq(grid.rebuilds, 1);
    done(&grid);
}
END_TEST

/* An automatic resolution follows the number of members both ways, at a cost that a growing number of them shares. */
START_TEST(resolution_follows_the_number) {
    enum { MANY = 20000 };
    static uint32_t members[MANY];
    rgi_grid grid;
    make(&grid, RG_GRID_HIERARCHICAL, 0, false, 2);
    told = 0;
    for (int i = 0; i < MANY; i++)
        members[i] = insert(&grid, 100 * unit_random(), 100 * unit_random(), 100 * unit_random(), 0.1);
    double cells =
        grid.cells.levels[0].count[0] * (double)grid.cells.levels[0].count[1] * grid.cells.levels[0].count[2];
    ck_assert(cells > MANY / 4 && cells < 32 * MANY);
    ck_assert_uint_le(grid.rebuilds, 10);
    ck_assert_int_eq(told, (int)grid.rebuilds + 1);
    for (int i = 0; i < MANY - 20; i++) {
        rgi_grid_remove(&grid, members[i]);
        rgi_grid_settle(&grid);
    }
    ck_assert_uint_lt(grid.cells.cell_count, 20000);
    ck_assert_uint_eq(grid.member_count, 20);
    done(&grid);
}
END_TEST

/* The logical box only grows while objects move, but is made exact again after as many changes as it would cost; when
 * the objects have drawn together, so is the physical one. */
START_TEST(boxes_shrink_again) {
    enum { MANY = 200 };
    static uint32_t members[MANY];
    rgi_grid grid;
    make(&grid, RG_GRID_UNIFORM, 16, false, 2);
    for (int i = 0; i < MANY; i++) members[i] = insert(&grid, 1000 * unit_random(), 1, 1, 1);
    ck_assert(grid.cells.extent[0] > 900);
    for (int turn = 0; turn < 10; turn++) {
        for (int i = 0; i < MANY; i++) move(&grid, members[i], 10 * unit_random(), 1);
    }
    ck_assert(grid.hi[0] <= 11 && grid.cells.extent[0] < 12);
    done(&grid);
}
END_TEST

/* A uniform grid of automatic resolution does not list large objects in all of many cells. */
START_TEST(large_objects_keep_cells_few) {
    rgi_grid grid;
    make(&grid, RG_GRID_UNIFORM, 0, false, 2);
    for (int i = 0; i < 3000; i++) insert(&grid, unit_random(), unit_random(), unit_random(), 10);
    ck_assert_int_eq(rgi_grid_rebuild(&grid), RG_OK);
    ck_assert_uint_le(grid.cells.entries.used - grid.cells.entries.free_count, 3000 * 64);
    done(&grid);
}
END_TEST

static int blocks_left;

static void *scarce_allocate(void *user, size_t size, size_t alignment) {
    void *block = NULL;
    (void)user;
    return blocks_left-- > 0 && posix_memalign(&block, alignment, size) == 0 ? block : NULL;
}

static void scarce_release(void *user, void *block, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(block);
}

/* A rebuild that finds no memory fails nobody: the call that would have liked it succeeds and leaves no message;
 * later it is tried again. */
START_TEST(rebuilds_wait_for_memory) {
    rg_grid_config config;
    rgi_grid grid;
    const rg_allocator scarce = {NULL, scarce_allocate, scarce_release};
    char before[400];
    blocks_left = 1000;
    rgi_memory_init(&memory, &scarce);
    ck_assert_int_eq(rgi_grid_config_read(&config, NULL), RG_OK);
    ck_assert_int_eq(rgi_grid_init(&grid, &memory, &config, tell, NULL), RG_OK);
    for (int i = 0; i < 8; i++) insert(&grid, i, i, i, 0.5);
    strcpy(before, rg_error_message());
    blocks_left = 0;
    insert(&grid, 8, 8, 8, 0.5);
    ck_assert_uint_eq(grid.cells.level_count, 0);
    ck_assert_uint_eq(grid.member_count, 9);
    ck_assert_str_eq(rg_error_message(), before);
    blocks_left = 1000;
    for (int i = 0; i < 40; i++) insert(&grid, i, 0, 0, 0.5);
    ck_assert_uint_gt(grid.cells.level_count, 0);
    done(&grid);
}
END_TEST

START_TEST(flat_thin_and_single) {
    const double extents[][3] = {{100, 100, 0}, {100, 0, 0}, {0, 0, 0}, {1e-30, 1, 1e30}};
    for (int kind = RG_GRID_UNIFORM; kind <= RG_GRID_HIERARCHICAL; kind++) {
        for (int e = 0; e < 4; e++) {
            rgi_grid grid;
            make(&grid, kind, 0, false, 2);
            for (int i = 0; i < 500; i++) {
                double lo[3];
                uint32_t member;
                for (int a = 0; a < 3; a++) lo[a] = extents[e][a] * unit_random();
                ck_assert_int_eq(rgi_grid_insert(&grid, 0, lo, lo, &member), RG_OK);
                rgi_grid_settle(&grid);
            }
            ck_assert_uint_eq(grid.cells.unbounded_count, 0);
            ck_assert_uint_le(grid.cells.cell_count, 500 * 64);
            done(&grid);
        }
    }
}
END_TEST

START_TEST(infinite_members_leave_the_box_alone) {
    rgi_grid grid;
    make(&grid, RG_GRID_HIERARCHICAL, 0, false, 2);
    double lo[3] = {-INFINITY, -1, -INFINITY}, hi[3] = {INFINITY, 0, INFINITY};
    uint32_t plane;
    for (int i = 0; i < 20; i++) {
        ck_assert_int_eq(rgi_grid_insert(&grid, 0, lo, hi, &plane), RG_OK);
        rgi_grid_settle(&grid);
    }
    ck_assert_uint_eq(grid.cells.level_count, 0);
    ck_assert(grid.lo[0] > grid.hi[0]);
    for (int i = 0; i < 20; i++) insert(&grid, i, 1, 1, 0.5);
    ck_assert_uint_eq(grid.cells.unbounded_count, 20);
    ck_assert(grid.lo[1] == 1 && grid.hi[0] == 19.5);
    done(&grid);
}
END_TEST

START_TEST(configurations) {
    rg_grid_config config, given;
    ck_assert_int_eq(rgi_grid_config_read(&config, NULL), RG_OK);
    ck_assert(config.kind == RG_GRID_LOOSE && config.rebuild_factor == 2);
#define REFUSED(field, value, code)                                                                                  \
    do {                                                                                                             \
        ck_assert_int_eq(rg_grid_config_default(&given, sizeof given), RG_OK);                                       \
        given.field = (value);                                                                                       \
        ck_assert_int_eq(rgi_grid_config_read(&config, &given), code);                                               \
    } while (0)
    REFUSED(kind, 4, RG_INVALID_ARGUMENT);
    REFUSED(kind, -1, RG_INVALID_ARGUMENT);
    REFUSED(resolution, (1u << 20) + 1, RG_INVALID_VALUE);
    REFUSED(rebuild_factor, 0.5, RG_INVALID_VALUE);
    REFUSED(rebuild_factor, -2, RG_INVALID_VALUE);
    REFUSED(rebuild_factor, NAN, RG_INVALID_VALUE);
    REFUSED(rebuild_factor, INFINITY, RG_INVALID_VALUE);
    REFUSED(lo[1], -1, RG_INVALID_VALUE);
    REFUSED(hi[2], NAN, RG_INVALID_VALUE);
    REFUSED(size, 8, RG_INVALID_ARGUMENT);
#undef REFUSED
    ck_assert_int_eq(rg_grid_config_default(&given, sizeof given), RG_OK);
    for (int a = 0; a < 3; a++) given.hi[a] = 1;
    given.resolution = 1024;
    ck_assert_int_eq(rgi_grid_config_read(&config, &given), RG_LIMIT_EXCEEDED);
    given.resolution = 512;
    ck_assert_int_eq(rgi_grid_config_read(&config, &given), RG_OK);
    given.lo[1] = -5e-324;
    given.hi[1] = 0;
    ck_assert_int_eq(rgi_grid_config_read(&config, &given), RG_INVALID_VALUE);
}
END_TEST

/* However thin a given box is, an automatic resolution has no more cells than it should. */
START_TEST(thin_boxes) {
    const double thin[] = {1e-99, 1e-50, 1e-20, 1e-10, 1e-3};
    for (int i = 0; i < 25; i++) {
        rg_grid_config config, given;
        rgi_grid grid;
        rgi_memory_init(&memory, NULL);
        ck_assert_int_eq(rg_grid_config_default(&given, sizeof given), RG_OK);
        given.kind = 1 + i % 2;
        given.hi[0] = 11.25;
        given.hi[1] = thin[i / 5];
        given.hi[2] = thin[i % 5];
        ck_assert_int_eq(rgi_grid_config_read(&config, &given), RG_OK);
        ck_assert_int_eq(rgi_grid_init(&grid, &memory, &config, tell, NULL), RG_OK);
        for (int k = 0; k < 1000; k++) insert(&grid, unit_random(), 0, 0, 1e-3);
        ck_assert_uint_le(grid.cells.cell_count, 100000);
        done(&grid);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("grid");
    TCase *tests = tcase_create("grid");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, rebuilt_when_the_diagonal_exceeds_the_factor);
    tcase_add_test(tests, few_objects_have_no_cells);
    tcase_add_test(tests, resolution_follows_the_number);
    tcase_add_test(tests, boxes_shrink_again);
    tcase_add_test(tests, large_objects_keep_cells_few);
    tcase_add_test(tests, rebuilds_wait_for_memory);
    tcase_add_test(tests, flat_thin_and_single);
    tcase_add_test(tests, infinite_members_leave_the_box_alone);
    tcase_add_test(tests, configurations);
    tcase_add_test(tests, thin_boxes);
    suite_add_tcase(suite, tests);
    return suite;
}
