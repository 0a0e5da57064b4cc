/* SPDX-License-Identifier: MIT */
#include "unit.h"
#include "vec.h"
#include "walk.h"

#include <string.h>

enum { OBJECTS = 400 };

static rgi_memory memory;
static double lo[OBJECTS][3], hi[OBJECTS][3], all_lo[3], all_hi[3];
static uint32_t seen[OBJECTS];

static bool see(void *context, uint32_t object) {
    (void)context;
    seen[object]++;
    return false;
}

static bool stop(void *context, uint32_t object) {
    *(uint32_t *)context = object;
    return true;
}

/* Cells over a box at `offset`, and objects in and around it, `spread` boxes away. */
static void make(rgi_cells *cells, bool hierarchical, double offset, double spread) {
    const double base[3] = {offset, offset, offset}, extent[3] = {8, 8, 4};
    const uint32_t count[3] = {16, 16, 8};
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_cells_make(cells, &memory, hierarchical, base, extent, count), RG_OK);
    rgi_cells_clear(cells, 0, cells->cell_count);
    rgi_empty_box(all_lo, all_hi);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        double size = pow(10, -3 + 3.5 * unit_random());
        uint64_t entries = 0, tiles = 0;
        rgi_placement p;
        for (int a = 0; a < 3; a++) {
            lo[i][a] = offset + (2 * unit_random() - 0.5) * extent[a] * spread;
            hi[i][a] = lo[i][a] + size * (0.2 + unit_random());
        }
        rgi_grow(all_lo, all_hi, lo[i], hi[i]);
        rgi_cells_place(cells, lo[i], hi[i], &p);
        rgi_cells_need(cells, &p, &entries, &tiles);
        ck_assert_int_eq(rgi_cells_reserve(cells, entries, tiles), RG_OK);
        rgi_cells_insert(cells, &p, i);
    }
}

/* Where a line is inside a box in long double, as the walk must find it; false if nowhere. */
static bool crosses(const double origin[3], const double d[3], const double l[3], const double h[3], double t_min,
                    double t_max) {
    long double from = t_min, to = t_max;
    for (int a = 0; a < 3; a++) {
        if (d[a] == 0) {
            if (origin[a] < l[a] || origin[a] > h[a]) return false;
            continue;
        }
        long double t0 = ((long double)l[a] - origin[a]) / d[a], t1 = ((long double)h[a] - origin[a]) / d[a];
        from = fmaxl(from, fminl(t0, t1));
        to = fminl(to, fmaxl(t0, t1));
    }
    return from <= to;
}

/* A direction with its largest component in [1, 2), some of the others zero or tiny. */
static void random_direction(double d[3]) {
    int axis = (int)(3 * unit_random());
    for (int a = 0; a < 3; a++) {
        double kind = unit_random();
        d[a] = kind < 0.1 ? 0 : kind < 0.2 ? -0.0 : kind < 0.3 ? unit_random_scale(-300, 0) : 2 * unit_random() - 1;
    }
    d[axis] = (1 + unit_random()) * (unit_random() < 0.5 ? -1 : 1);
}

/* No walk passes over a box that the ray crosses, whatever the offset, the spread, and how far away the ray starts.
 */
START_TEST(nothing_is_passed_over) {
    const double offsets[] = {0, 1e3 + 0.56, -1e6 - 0.37, 1e9 + 0.56}, spreads[] = {0.5, 3, 3000};
    uint64_t crossed = 0;
    for (int set = 0; set < 24; set++) {
        rgi_cells cells;
        make(&cells, set % 2, offsets[set / 2 % 4], spreads[set / 8]);
        for (int i = 0; i < 400; i++) {
            double origin[3], d[3], distance = pow(10, i % 8), before = distance * unit_random();
            uint32_t target = (uint32_t)(unit_random() * OBJECTS);
            random_direction(d);
            /* Through a point of some object, at times its corner, at times along a wall of the cells. */
            for (int a = 0; a < 3; a++) {
                double along = i % 3 ? unit_random() : unit_random() < 0.5 ? 0 : 1;
                double point = lo[target][a] + along * (hi[target][a] - lo[target][a]);
                if (i % 5 == 0) point = cells.base[a] + floor((point - cells.base[a]) * 2) / 2;
                origin[a] = point - before * d[a];
            }
            rgi_walk walk;
            double t_min = i % 4 ? 0 : -INFINITY, t_max = i % 7 ? INFINITY : distance;
            memset(seen, 0, sizeof seen);
            rgi_walk_init(&walk, origin, d, t_min, t_max);
            walk.visit = see;
            ck_assert(!rgi_cells_walk(&cells, all_lo, all_hi, &walk));
            for (uint32_t o = 0; o < OBJECTS; o++) {
                if (!crosses(origin, d, lo[o], hi[o], t_min, t_max)) continue;
                crossed++;
                ck_assert_msg(seen[o] > 0, "set %d ray %d passes over %u: from %a %a %a along %a %a %a", set, i, o,
                              origin[0], origin[1], origin[2], d[0], d[1], d[2]);
            }
        }
        rgi_cells_free(&cells);
    }
    ck_assert_uint_gt(crossed, 10000);
}
END_TEST

/* In a level whose cells are no smaller than the object, a ray meets it in its eight cells at the most; in all tiles.
 */
START_TEST(nothing_is_tested_more_often_than_it_has_cells) {
    for (int kind = 0; kind < 2; kind++) {
        rgi_cells cells;
        make(&cells, kind, 0, 3);
        for (int i = 0; i < 2000; i++) {
            double origin[3], d[3];
            rgi_walk walk;
            random_direction(d);
            for (int a = 0; a < 3; a++) origin[a] = 40 * unit_random() - 20;
            memset(seen, 0, sizeof seen);
            rgi_walk_init(&walk, origin, d, 0, INFINITY);
            walk.visit = see;
            rgi_cells_walk(&cells, all_lo, all_hi, &walk);
            for (uint32_t o = 0; o < OBJECTS && kind; o++) ck_assert_uint_le(seen[o], 8);
            /* 3 tiles of 16 + 16 + 8 cells on each level at the most, and what the last steps leave: */
            ck_assert_uint_le(walk.cells, kind ? 5 * 5 * (16 + 16 + 8) * 2 : 5 * (16 + 16 + 8));
        }
        rgi_cells_free(&cells);
    }
}
END_TEST

START_TEST(visit_ends_the_walk) {
    rgi_cells cells;
    rgi_walk walk;
    uint32_t object = RGI_NONE;
    make(&cells, true, 0, 1);
    const double d[3] = {1, 0, 0};
    double origin[3] = {lo[7][0] - 1e-3, (lo[7][1] + hi[7][1]) / 2, (lo[7][2] + hi[7][2]) / 2};
    rgi_walk_init(&walk, origin, d, 0, INFINITY);
    walk.visit = stop;
    walk.context = &object;
    ck_assert(rgi_cells_walk(&cells, all_lo, all_hi, &walk));
    ck_assert_uint_lt(object, OBJECTS);
    rgi_cells_free(&cells);
}
END_TEST

/* A million cells along one axis: t is never added up, so the last wall is as right as the first. */
START_TEST(a_million_cells) {
    rgi_cells cells;
    const double base[3] = {0, 0, 0}, extent[3] = {1 << 20, 1, 1}, small_lo[3] = {(1 << 20) - 0.25, 0.25, 0.25};
    const double small_hi[3] = {(1 << 20) - 0.125, 0.5, 0.5};
    const uint32_t count[3] = {1 << 20, 1, 1};
    uint64_t entries = 0, tiles = 0;
    rgi_placement p;
    rgi_walk walk;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_cells_make(&cells, &memory, false, base, extent, count), RG_OK);
    rgi_cells_clear(&cells, 0, cells.cell_count);
    rgi_cells_place(&cells, small_lo, small_hi, &p);
    rgi_cells_need(&cells, &p, &entries, &tiles);
    ck_assert_uint_eq(entries, 1);
    ck_assert_int_eq(rgi_cells_reserve(&cells, entries, tiles), RG_OK);
    rgi_cells_insert(&cells, &p, 0);
    memset(seen, 0, sizeof seen);
    const double origin[3] = {0.5, 0.375, 0.375}, d[3] = {1, 0x1p-24, -0x1p-24}, world_lo[3] = {0, 0, 0};
    rgi_walk_init(&walk, origin, d, 0, INFINITY);
    walk.visit = see;
    rgi_cells_walk(&cells, world_lo, extent, &walk);
    ck_assert_uint_eq(seen[0], 1);
    ck_assert_uint_eq(walk.cells, 1 << 20);
    rgi_cells_free(&cells);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("walk");
    TCase *tests = tcase_create("walk");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, nothing_is_passed_over);
    tcase_add_test(tests, nothing_is_tested_more_often_than_it_has_cells);
    tcase_add_test(tests, visit_ends_the_walk);
    tcase_add_test(tests, a_million_cells);
    suite_add_tcase(suite, tests);
    return suite;
}
