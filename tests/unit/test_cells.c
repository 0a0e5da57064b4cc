/* SPDX-License-Identifier: MIT */
#include "cells.h"
#include "unit.h"

#include <string.h>

static rgi_memory memory;

static void make(rgi_cells *cells, bool hierarchical, uint32_t n) {
    const double base[3] = {0, 0, 0}, extent[3] = {8, 8, 8};
    const uint32_t count[3] = {n, n, n};
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_cells_make(cells, &memory, hierarchical, base, extent, count), RG_OK);
    rgi_cells_clear(cells, 0, cells->cell_count);
}

static rgi_placement place(const rgi_cells *cells, double x, double y, double z, double size) {
    double lo[3] = {x, y, z}, hi[3] = {x + size, y + size, z + size};
    rgi_placement p;
    rgi_cells_place(cells, lo, hi, &p);
    return p;
}

static uint32_t insert(rgi_cells *cells, const rgi_placement *p, uint32_t object) {
    uint64_t entries = 0, tiles = 0;
    rgi_cells_need(cells, p, &entries, &tiles);
    ck_assert_int_eq(rgi_cells_reserve(cells, entries, tiles), RG_OK);
    uint64_t before = cells->entries.used - cells->entries.free_count;
    uint32_t first = rgi_cells_insert(cells, p, object);
    ck_assert_uint_eq(cells->entries.used - cells->entries.free_count, before + entries);
    return first;
}

START_TEST(levels_halve_up_to_one_cell) {
    rgi_cells cells;
    const double base[3] = {0, 0, 0}, extent[3] = {8, 4, 1};
    const uint32_t count[3] = {16, 8, 2};
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_cells_make(&cells, &memory, true, base, extent, count), RG_OK);
    rgi_cells_clear(&cells, 0, cells.cell_count);
    ck_assert_uint_eq(cells.level_count, 5);
    const uint32_t expected[5][3] = {{16, 8, 2}, {8, 4, 1}, {4, 2, 1}, {2, 1, 1}, {1, 1, 1}};
    for (int l = 0; l < 5; l++) ck_assert_mem_eq(cells.levels[l].count, expected[l], sizeof expected[l]);
    ck_assert_uint_eq(cells.cell_count, 16 * 8 * 2 + 8 * 4 + 4 * 2 + 2 + 1);
    rgi_cells_free(&cells);
    ck_assert_uint_eq(memory.bytes, 0);
}
END_TEST

/* An object is at the finest level whose cells are no smaller, and overlaps eight at the most. */
START_TEST(the_level_fits_the_size) {
    rgi_cells cells;
    make(&cells, true, 16);
    ck_assert_uint_eq(place(&cells, 1.1, 1.1, 1.1, 0.4).level, 0);
    ck_assert_uint_eq(place(&cells, 1.1, 1.1, 1.1, 0.6).level, 1);
    ck_assert_uint_eq(place(&cells, 1.1, 1.1, 1.1, 1.1).level, 2);
    ck_assert_uint_eq(place(&cells, 1.1, 1.1, 1.1, 7.9).level, 4);
    ck_assert_uint_eq(place(&cells, 1.1, 1.1, 1.1, 8.1).level, RGI_NONE);
    for (int i = 0; i < 100000; i++) {
        double size = pow(10, -4 + 4.9 * unit_random());
        rgi_placement p =
            place(&cells, unit_random_scale(-2, 3), unit_random_scale(-2, 3), unit_random_scale(-2, 3), size);
        if (size > 7.99) continue;
        uint64_t entries = 0, tiles = 0;
        ck_assert_uint_ne(p.level, RGI_NONE);
        rgi_cells_need(&cells, &p, &entries, &tiles);
        ck_assert_uint_le(entries, 8);
        ck_assert(cells.levels[p.level].size[0] >= size);
        ck_assert(p.level == 0 || cells.levels[p.level - 1].size[0] < size * (1 + 1e-9) + 1e-9);
    }
    rgi_cells_free(&cells);
}
END_TEST

/* The torus: the tile is the whole part and the cell the rest, on both sides of 0, and a box that touches a wall is
 * on both sides of it. */
START_TEST(tiles_and_cells_of_a_place) {
    rgi_cells cells;
    make(&cells, false, 8);
    for (int k = -3; k <= 3; k++) {
        rgi_placement p = place(&cells, 8 * k + 2.25, 5.25, 0.25, 0.5);
        ck_assert_int_eq(p.tile[0][0], k);
        ck_assert_int_eq(p.tile[1][0], k);
        ck_assert_uint_eq(p.cell[0][0], 2);
        ck_assert_uint_eq(p.cell[1][1], 5);
        p = place(&cells, 8 * k, 1.25, 1.25, 0.5);
        ck_assert_int_eq(p.tile[0][0], k - 1);
        ck_assert_uint_eq(p.cell[0][0], 7);
        ck_assert_int_eq(p.tile[1][0], k);
        ck_assert_uint_eq(p.cell[1][0], 0);
        p = place(&cells, 8 * k - 1, 1.25, 1.25, 1);
        ck_assert_int_eq(p.tile[1][0], k);
        ck_assert_uint_eq(p.cell[1][0], 0);
    }
    ck_assert_uint_eq(place(&cells, 8e9, 0, 0, 1).level, 0);
    ck_assert_uint_eq(place(&cells, 9e9, 0, 0, 1).level, RGI_NONE);
    ck_assert_uint_eq(place(&cells, -1e99, 0, 0, 1).level, RGI_NONE);
    rgi_cells_free(&cells);
}
END_TEST

/* Lists, tiles and counts agree with the placements of what is stored. */
static void check_lists(const rgi_cells *cells, uint32_t stored) {
    uint64_t entries = 0, tile_entries = 0;
    for (uint32_t c = 0; c <= cells->cell_count; c++) {
        uint32_t previous = RGI_NONE, e = c < cells->cell_count ? cells->heads[c] : cells->unbounded;
        while (e != RGI_NONE) {
            const rgi_entry *entry = rgi_slots_at(&cells->entries, e);
            ck_assert_uint_eq(entry->previous, previous);
            ck_assert_uint_eq(entry->cell, c < cells->cell_count ? c : RGI_UNBOUNDED);
            ck_assert_uint_lt(entry->object, stored);
            entries++;
            previous = e;
            e = entry->next;
        }
    }
    ck_assert_uint_eq(entries, cells->entries.used - cells->entries.free_count);
    uint32_t tiles = 0;
    for (uint32_t i = 0; i < cells->table_room; i++) {
        if (cells->table[i] == RGI_NONE) continue;
        const rgi_tile *tile = rgi_slots_at(&cells->tiles, cells->table[i]);
        uint32_t sum = 0;
        for (uint32_t l = 0; l < cells->level_count; l++) {
            sum += tile->level_entries[l];
            ck_assert_uint_eq(tile->level_entries[l] > 0, tile->levels_used >> l & 1);
        }
        ck_assert_uint_eq(sum, tile->entries);
        ck_assert_uint_gt(sum, 0);
        ck_assert_uint_eq(rgi_cells_table_place(cells, tile->at), i);
        tile_entries += sum;
        tiles++;
    }
    ck_assert_uint_eq(tiles, cells->tile_count);
    ck_assert_uint_eq(tile_entries + cells->unbounded_count, entries);
}

START_TEST(churn) {
    enum { OBJECTS = 300 };
    for (int kind = 0; kind < 2; kind++) {
        rgi_cells cells;
        uint32_t first[OBJECTS];
        make(&cells, kind, 8);
        for (uint32_t i = 0; i < OBJECTS; i++) first[i] = RGI_NONE;
        for (int step = 0; step < 30000; step++) {
            uint32_t i = (uint32_t)(unit_random() * OBJECTS);
            rgi_cells_remove(&cells, first[i]);
            first[i] = RGI_NONE;
            if (unit_random() < 0.7) {
                double far = unit_random() < 0.1 ? 1e11 : 40, size = pow(10, -3 + 4.2 * unit_random());
                rgi_placement p =
                    place(&cells, far * unit_random() - 20, 40 * unit_random() - 20, 10 * unit_random(), size);
                first[i] = insert(&cells, &p, i);
            }
            if (step % 3000 == 0) check_lists(&cells, OBJECTS);
        }
        for (uint32_t i = 0; i < OBJECTS; i++) rgi_cells_remove(&cells, first[i]);
        check_lists(&cells, 0);
        ck_assert_uint_eq(cells.tile_count, 0);
        ck_assert_uint_eq(cells.unbounded_count, 0);
        rgi_cells_free(&cells);
        ck_assert_uint_eq(memory.bytes, 0);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("cells");
    TCase *tests = tcase_create("cells");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, levels_halve_up_to_one_cell);
    tcase_add_test(tests, the_level_fits_the_size);
    tcase_add_test(tests, tiles_and_cells_of_a_place);
    tcase_add_test(tests, churn);
    suite_add_tcase(suite, tests);
    return suite;
}
