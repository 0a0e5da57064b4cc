/* SPDX-License-Identifier: MIT */
#include "cells.h"

#include "error.h"
#include "vec.h"

#include <inttypes.h>
#include <string.h>

/* Beyond this many tiles from home an object counts as unbounded: far inside what int32_t holds and double resolves.
 */
#define FARTHEST_TILE 1073741824.0

/* ---------------------------------------------------------------------------------------------- the levels */

void rgi_cells_init(rgi_cells *cells, rgi_memory *memory) {
    memset(cells, 0, sizeof *cells);
    cells->memory = memory;
    cells->unbounded = RGI_NONE;
    rgi_slots_init(&cells->entries, memory, sizeof(rgi_entry), "entries of a grid");
    rgi_slots_init(&cells->tiles, memory, sizeof(rgi_tile), "tiles of a grid");
}

void rgi_cells_free(rgi_cells *cells) {
    rgi_release(cells->memory, cells->heads, cells->cell_count, sizeof *cells->heads);
    rgi_release(cells->memory, cells->table, cells->table_room, sizeof *cells->table);
    rgi_slots_free(&cells->entries);
    rgi_slots_free(&cells->tiles);
    rgi_cells_init(cells, cells->memory);
}

/* Appends a level; returns false when it is the coarsest. */
static bool add_level(rgi_cells *cells, uint64_t *cell_count, const uint32_t count[3]) {
    rgi_level *level = &cells->levels[cells->level_count++];
    uint64_t all = 1;
    bool more = false;
    level->first = (uint32_t)*cell_count;
    for (int a = 0; a < 3; a++) {
        level->count[a] = count[a];
        level->size[a] = cells->extent[a] / count[a];
        level->per_unit[a] = count[a] / cells->extent[a];
        all *= count[a];
        more |= count[a] > 1;
    }
    *cell_count += all;
    return more && cells->hierarchical;
}

rg_result rgi_cells_make(rgi_cells *cells, rgi_memory *memory, bool hierarchical, const double base[3],
                         const double extent[3], const uint32_t count[3]) {
    uint64_t cell_count = 0;
    uint32_t n[3] = {count[0], count[1], count[2]};
    rgi_cells_init(cells, memory);
    cells->hierarchical = hierarchical;
    rgi_copy(base, cells->base);
    rgi_copy(extent, cells->extent);
    cells->pad = 0x1p-36 * rgi_max_magnitude(extent);
    while (add_level(cells, &cell_count, n)) {
        for (int a = 0; a < 3; a++) n[a] = n[a] > 1 ? n[a] / 2 : 1;
    }
    rg_result result = rgi_allocate(memory, cell_count, sizeof *cells->heads, "the cells of a grid", &cells->heads);
    if (result) {
        rgi_cells_init(cells, memory);
        return result;
    }
    cells->cell_count = (uint32_t)cell_count;
    return RG_OK;
}

void rgi_cells_clear(rgi_cells *cells, uint32_t first, uint32_t count) {
    if (count) memset(cells->heads + first, 0xff, (size_t)count * sizeof *cells->heads);
}

/* --------------------------------------------------------------------------------------------- placements */

/* The tile and the cell of a coordinate; false if it is too far away. Cells are counted inside the tile. */
static bool locate(const rgi_cells *cells, const rgi_level *level, int axis, double x, int32_t *tile,
                   uint32_t *cell) {
    double inside = x - cells->base[axis];
    *tile = 0;
    if (!(inside >= 0 && inside < cells->extent[axis])) {
        double k = inside / cells->extent[axis];
        if (!(fabs(k) < FARTHEST_TILE)) return false;
        k = rgi_floor(k);
        *tile = (int32_t)k;
        inside = rgi_max(0, x - rgi_tile_base(cells, axis, k));
    }
    *cell = (uint32_t)rgi_min(inside * level->per_unit[axis], level->count[axis] - 1);
    return true;
}

/* The finest level whose cells are no smaller than the box: it then overlaps two at most along each axis. */
static uint32_t fitting_level(const rgi_cells *cells, const double lo[3], const double hi[3]) {
    if (!cells->hierarchical) return 0;
    for (uint32_t l = 0; l < cells->level_count; l++) {
        const double *size = cells->levels[l].size;
        if (hi[0] - lo[0] <= size[0] && hi[1] - lo[1] <= size[1] && hi[2] - lo[2] <= size[2]) return l;
    }
    return RGI_NONE;
}

static uint64_t tile_span(const rgi_placement *p, int axis) {
    return (uint64_t)((int64_t)p->tile[1][axis] - p->tile[0][axis] + 1);
}

/* Cells along an axis, over all tiles. */
static uint64_t cell_span(const rgi_cells *cells, const rgi_placement *p, int axis) {
    return (tile_span(p, axis) - 1) * cells->levels[p->level].count[axis] + p->cell[1][axis] - p->cell[0][axis] + 1;
}

/*
 * Boxes are widened by 2^-36 of the physical box and 2^-49 of their coordinates. The first covers what a walk inside
 * a tile rounds (some 2^-50 of the tile, lib/walk.c), the second what base + k * extent rounds; so a ray that meets
 * an object looks into a cell in which it is listed, on whichever side of a wall rounding puts the two.
 */
void rgi_cells_place(const rgi_cells *cells, const double lo[3], const double hi[3], rgi_placement *p) {
    double from[3], to[3];
    memset(p, 0, sizeof *p);
    p->level = RGI_NONE;
    if (!cells->level_count) return;
    for (int a = 0; a < 3; a++) {
        double pad = cells->pad + 0x1p-49 * rgi_max(fabs(lo[a]), fabs(hi[a]));
        from[a] = lo[a] - pad;
        to[a] = hi[a] + pad;
    }
    uint32_t level = fitting_level(cells, from, to);
    if (level == RGI_NONE) return;
    for (int a = 0; a < 3; a++) {
        const rgi_level *l = &cells->levels[level];
        if (!locate(cells, l, a, from[a], &p->tile[0][a], &p->cell[0][a])) return;
        if (!locate(cells, l, a, to[a], &p->tile[1][a], &p->cell[1][a])) return;
    }
    p->level = level;
    /* More cells than the box has, in all its tiles: larger than the box, so testing it for every ray costs less. */
    double overlapped = 1;
    for (int a = 0; a < 3; a++) overlapped *= (double)cell_span(cells, p, a);
    if (!cells->hierarchical && overlapped > rgi_max(cells->cell_count, 8)) p->level = RGI_NONE;
}

bool rgi_placement_equal(const rgi_placement *a, const rgi_placement *b) {
    if (a->level != b->level) return false;
    if (a->level == RGI_NONE) return true;
    return memcmp(a->tile, b->tile, sizeof a->tile) == 0 && memcmp(a->cell, b->cell, sizeof a->cell) == 0;
}

/* ---------------------------------------------------------------------------------------------- the tiles */

static uint32_t hash(const int32_t at[3]) {
    uint64_t h = (uint32_t)at[0] * 0x9e3779b97f4a7c15u;
    h = (h ^ (uint32_t)at[1]) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 29) ^ (uint32_t)at[2]) * 0x94d049bb133111ebu;
    return (uint32_t)(h >> 32);
}

uint32_t rgi_cells_table_place(const rgi_cells *cells, const int32_t at[3]) {
    uint32_t mask = cells->table_room - 1, place = hash(at) & mask;
    while (cells->table[place] != RGI_NONE) {
        const rgi_tile *tile = rgi_slots_at(&cells->tiles, cells->table[place]);
        if (memcmp(tile->at, at, sizeof tile->at) == 0) break;
        place = (place + 1) & mask;
    }
    return place;
}

static bool is_empty(const rgi_cells *cells, const int32_t at[3]) {
    return !cells->table_room || cells->table[rgi_cells_table_place(cells, at)] == RGI_NONE;
}

static uint32_t tile_index(rgi_cells *cells, const int32_t at[3]) {
    uint32_t place = rgi_cells_table_place(cells, at);
    if (cells->table[place] != RGI_NONE) return cells->table[place];
    uint32_t index = rgi_slots_take(&cells->tiles);
    rgi_tile *tile = rgi_slots_at(&cells->tiles, index);
    memset(tile, 0, sizeof *tile);
    memcpy(tile->at, at, sizeof tile->at);
    cells->table[place] = index;
    cells->tile_count++;
    return index;
}

/* Deletion without tombstones: what follows in the run moves up unless it would pass its own first place. D. E.
 * Knuth, TAOCP vol. 3, section 6.4, algorithm R. */
static void drop_tile(rgi_cells *cells, uint32_t index) {
    const rgi_tile *tile = rgi_slots_at(&cells->tiles, index);
    uint32_t mask = cells->table_room - 1, hole = rgi_cells_table_place(cells, tile->at), place = hole;
    for (;;) {
        place = (place + 1) & mask;
        if (cells->table[place] == RGI_NONE) break;
        const rgi_tile *other = rgi_slots_at(&cells->tiles, cells->table[place]);
        uint32_t home = hash(other->at) & mask;
        if (((place - home) & mask) < ((place - hole) & mask)) continue;
        cells->table[hole] = cells->table[place];
        hole = place;
    }
    cells->table[hole] = RGI_NONE;
    rgi_slots_give(&cells->tiles, index);
    cells->tile_count--;
}

void rgi_cells_need(const rgi_cells *cells, const rgi_placement *p, uint64_t *entries, uint64_t *tiles) {
    if (p->level == RGI_NONE) {
        *entries += 1;
        return;
    }
    *entries += cell_span(cells, p, 0) * cell_span(cells, p, 1) * cell_span(cells, p, 2);
    int32_t at[3];
    for (at[0] = p->tile[0][0]; at[0] <= p->tile[1][0]; at[0]++)
        for (at[1] = p->tile[0][1]; at[1] <= p->tile[1][1]; at[1]++)
            for (at[2] = p->tile[0][2]; at[2] <= p->tile[1][2]; at[2]++) *tiles += is_empty(cells, at);
}

static rg_result reserve_table(rgi_cells *cells, uint64_t tiles) {
    uint64_t room = cells->table_room ? cells->table_room : 8;
    while (room < 2 * tiles) room *= 2;
    if (room == cells->table_room) return RG_OK;
    if (room > 1u << 31) return rgi_fail(RG_LIMIT_EXCEEDED, "%" PRIu64 " tiles are too many", tiles);
    uint32_t *old = cells->table, old_room = cells->table_room;
    uint32_t *table;
    rg_result result = rgi_allocate(cells->memory, room, sizeof *table, "the table of tiles", &table);
    if (result) return result;
    memset(table, 0xff, (size_t)room * sizeof *table);
    cells->table = table;
    cells->table_room = (uint32_t)room;
    for (uint32_t i = 0; i < old_room; i++) {
        if (old[i] == RGI_NONE) continue;
        const rgi_tile *tile = rgi_slots_at(&cells->tiles, old[i]);
        table[rgi_cells_table_place(cells, tile->at)] = old[i];
    }
    rgi_release(cells->memory, old, old_room, sizeof *old);
    return RG_OK;
}

rg_result rgi_cells_reserve(rgi_cells *cells, uint64_t entries, uint64_t tiles) {
    rg_result result = rgi_slots_reserve(&cells->entries, entries);
    if (!result && tiles) result = rgi_slots_reserve(&cells->tiles, tiles);
    if (!result && tiles) result = reserve_table(cells, cells->tile_count + tiles);
    return result;
}

void rgi_cells_touch(rgi_cells *cells, const rgi_placement *p) {
    int32_t at[3];
    for (at[0] = p->tile[0][0]; at[0] <= p->tile[1][0]; at[0]++)
        for (at[1] = p->tile[0][1]; at[1] <= p->tile[1][1]; at[1]++)
            for (at[2] = p->tile[0][2]; at[2] <= p->tile[1][2]; at[2]++) tile_index(cells, at);
}

/* -------------------------------------------------------------------------------------------- the entries */

static uint32_t *head_of(rgi_cells *cells, uint32_t cell) {
    return cell == RGI_UNBOUNDED ? &cells->unbounded : &cells->heads[cell];
}

static uint32_t add_entry(rgi_cells *cells, uint32_t object, uint32_t tile, uint32_t cell, uint32_t sibling) {
    uint32_t index = rgi_slots_take(&cells->entries);
    uint32_t *head = head_of(cells, cell);
    rgi_entry *entry = rgi_slots_at(&cells->entries, index);
    *entry = (rgi_entry){*head, RGI_NONE, object, tile, cell, sibling};
    if (*head != RGI_NONE) ((rgi_entry *)rgi_slots_at(&cells->entries, *head))->previous = index;
    *head = index;
    return index;
}

static uint32_t insert_in_tile(rgi_cells *cells, const rgi_placement *p, const int32_t at[3], uint32_t object,
                               uint32_t sibling) {
    const rgi_level *level = &cells->levels[p->level];
    uint32_t index = tile_index(cells, at), from[3], to[3], c[3];
    rgi_tile *tile = rgi_slots_at(&cells->tiles, index);
    uint32_t added = 1;
    for (int a = 0; a < 3; a++) {
        from[a] = at[a] == p->tile[0][a] ? p->cell[0][a] : 0;
        to[a] = at[a] == p->tile[1][a] ? p->cell[1][a] : level->count[a] - 1;
        added *= to[a] - from[a] + 1;
    }
    for (c[2] = from[2]; c[2] <= to[2]; c[2]++)
        for (c[1] = from[1]; c[1] <= to[1]; c[1]++)
            for (c[0] = from[0]; c[0] <= to[0]; c[0]++) {
                uint32_t cell = level->first + (c[2] * level->count[1] + c[1]) * level->count[0] + c[0];
                sibling = add_entry(cells, object, index, cell, sibling);
            }
    tile->entries += added;
    tile->level_entries[p->level] += added;
    tile->levels_used |= 1u << p->level;
    return sibling;
}

uint32_t rgi_cells_insert(rgi_cells *cells, const rgi_placement *p, uint32_t object) {
    if (p->level == RGI_NONE) {
        cells->unbounded_count++;
        return add_entry(cells, object, RGI_NONE, RGI_UNBOUNDED, RGI_NONE);
    }
    uint32_t first = RGI_NONE;
    int32_t at[3];
    for (at[0] = p->tile[0][0]; at[0] <= p->tile[1][0]; at[0]++)
        for (at[1] = p->tile[0][1]; at[1] <= p->tile[1][1]; at[1]++)
            for (at[2] = p->tile[0][2]; at[2] <= p->tile[1][2]; at[2]++)
                first = insert_in_tile(cells, p, at, object, first);
    return first;
}

static void forget_in_tile(rgi_cells *cells, const rgi_entry *entry) {
    rgi_tile *tile = rgi_slots_at(&cells->tiles, entry->tile);
    uint32_t level = cells->level_count - 1;
    while (entry->cell < cells->levels[level].first) level--;
    if (--tile->level_entries[level] == 0) tile->levels_used &= ~(1u << level);
    if (--tile->entries == 0) drop_tile(cells, entry->tile);
}

void rgi_cells_remove(rgi_cells *cells, uint32_t first) {
    while (first != RGI_NONE) {
        uint32_t index = first;
        rgi_entry *entry = rgi_slots_at(&cells->entries, index);
        if (entry->previous == RGI_NONE)
            *head_of(cells, entry->cell) = entry->next;
        else
            ((rgi_entry *)rgi_slots_at(&cells->entries, entry->previous))->next = entry->next;
        if (entry->next != RGI_NONE)
            ((rgi_entry *)rgi_slots_at(&cells->entries, entry->next))->previous = entry->previous;
        if (entry->cell == RGI_UNBOUNDED)
            cells->unbounded_count--;
        else
            forget_in_tile(cells, entry);
        first = entry->sibling;
        rgi_slots_give(&cells->entries, index);
    }
}
