/* SPDX-License-Identifier: MIT */
/*
 * Cells: the storage of a grid. Levels of cells over one physical box, addressed modulo the box, with linked lists of
 * entries. E. Reinhard, B. Smits, C. Hansen, "Dynamic Acceleration Structures for Interactive Ray Tracing" (2000).
 * The uniform kind is the hierarchical one with one level.
 *
 * Space is tiled by copies of the physical box; tile k (three integers) starts at base + k * extent. Inside a tile,
 * places count from its corner and cells from 0, so nothing that is computed there knows how far away from the origin
 * the tile is. An entry says: this object overlaps this cell in this tile.
 *
 * Cells know boxes and indices. They do not know shapes, objects or the rules of a grid.
 */
#ifndef RAYGRID_LIB_CELLS_H
#define RAYGRID_LIB_CELLS_H

#include "slots.h"

#include <stdbool.h>

enum { RGI_LEVELS = 21 };

/** The `cell` of entries that no cell can hold: they are in one list that every ray tests. */
#define RGI_UNBOUNDED RGI_NONE

typedef struct rgi_level {
    uint32_t count[3]; /* cells along each axis */
    double size[3];    /* of a cell */
    double per_unit[3];
    uint32_t first; /* its first cell in `heads` */
} rgi_level;

/** That an object overlaps a cell. */
typedef struct rgi_entry {
    uint32_t next, previous; /* in the cell; next links the free ones */
    uint32_t object;
    uint32_t tile;
    uint32_t cell;    /* index into heads, or RGI_UNBOUNDED */
    uint32_t sibling; /* the next entry of the same object */
} rgi_entry;

/** A tile that holds something. */
typedef struct rgi_tile {
    uint32_t link;
    int32_t at[3];
    uint32_t entries;
    uint32_t levels_used; /* bit l: level l holds something here */
    uint32_t level_entries[RGI_LEVELS];
} rgi_tile;

typedef struct rgi_cells {
    rgi_memory *memory;
    bool hierarchical;
    double base[3], extent[3]; /* the physical box */
    double pad;                /* by which boxes are widened against the rounding of walks, see rgi_cells_place */
    uint32_t level_count;      /* 0: no cells, every object is in the list of the unbounded */
    rgi_level levels[RGI_LEVELS];
    uint32_t cell_count;
    uint32_t *heads; /* first entry of each cell */
    uint32_t unbounded;
    uint64_t unbounded_count;
    rgi_slots entries;
    rgi_slots tiles;
    uint32_t tile_count;
    uint32_t table_room; /* a power of two, at least twice the tiles */
    uint32_t *table;     /* tile indices by hash of `at`, open addressing; RGI_NONE: free */
} rgi_cells;

/** Where an object is stored: a level, and from which cell of which tile to which. */
typedef struct rgi_placement {
    uint32_t level; /* RGI_NONE: unbounded */
    int32_t tile[2][3];
    uint32_t cell[2][3];
} rgi_placement;

/** The corner of a tile along an axis. Rounded, but the same wherever it is asked for: places in the tile count from
 * it. */
static inline double rgi_tile_base(const rgi_cells *cells, int axis, double tile) {
    return cells->base[axis] + tile * cells->extent[axis];
}

/** No cells: everything is unbounded. */
void rgi_cells_init(rgi_cells *cells, rgi_memory *memory);

/**
 * Cells, not cleared, over the box from base, `count` of them along each axis at the finest level (for the
 * hierarchical kind powers of two, and coarser levels up to one cell). RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED; *cells is
 * then as after rgi_cells_init.
 */
rg_result rgi_cells_make(rgi_cells *cells, rgi_memory *memory, bool hierarchical, const double base[3],
                         const double extent[3], const uint32_t count[3]);

/** Makes cells empty: all of them, once, before anything is stored. */
void rgi_cells_clear(rgi_cells *cells, uint32_t first, uint32_t count);
void rgi_cells_free(rgi_cells *cells);

/** Where a box belongs. */
void rgi_cells_place(const rgi_cells *cells, const double lo[3], const double hi[3], rgi_placement *placement);

bool rgi_placement_equal(const rgi_placement *a, const rgi_placement *b);

/** Adds what an insert at a placement takes to *entries and *tiles (tiles that two inserts share count twice). */
void rgi_cells_need(const rgi_cells *cells, const rgi_placement *placement, uint64_t *entries, uint64_t *tiles);

/** Makes sure that inserts that need this much succeed. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED: nothing has changed. */
rg_result rgi_cells_reserve(rgi_cells *cells, uint64_t entries, uint64_t tiles);

/** Makes the tiles of a placement that is about to be inserted, so that rgi_cells_need counts them no more. */
void rgi_cells_touch(rgi_cells *cells, const rgi_placement *placement);

/** Stores an object; returns its first entry. What it needs must have been reserved. Cost: its cells. */
uint32_t rgi_cells_insert(rgi_cells *cells, const rgi_placement *placement, uint32_t object);

/** Removes the object whose first entry is given. Cost: its cells. */
void rgi_cells_remove(rgi_cells *cells, uint32_t first);

/** Where the table has the tile at these coordinates, or the free place where it would be. Needs table_room > 0. */
uint32_t rgi_cells_table_place(const rgi_cells *cells, const int32_t at[3]);

#endif
