/* SPDX-License-Identifier: MIT */
/*
 * A grid: the boxes of its members stored in cells, the logical box, and the rules by which the cells are made anew.
 * A grid knows boxes and indices; what an index means is the scene's business.
 */
#ifndef RAYGRID_LIB_GRID_H
#define RAYGRID_LIB_GRID_H

#include "cells.h"
#include "walk.h"

#include <raygrid/grid.h>

/** An object as the grid sees it. */
typedef struct rgi_member {
    uint32_t link;
    uint32_t object;
    double lo[3], hi[3];
    uint32_t entries; /* first entry in the cells */
    uint32_t alive;   /* 0: the record is free */
} rgi_member;

typedef struct rgi_grid {
    rgi_memory *memory;
    rg_grid_config config; /* checked; kind is never RG_GRID_DEFAULT */
    rg_log log;
    void *log_user;
    rgi_cells cells;
    rgi_slots members;
    uint64_t member_count;
    double lo[3], hi[3];  /* the logical box: holds all members but the infinite */
    uint64_t built_count; /* members when the cells were made */
    uint64_t changes;     /* inserts, moves and removes since the logical box was last made exact */
    double physical;      /* diagonal of the physical box */
    bool box_given;       /* the physical box is that of the configuration */
    bool grown;           /* the logical box has grown since the rules were last applied */
    uint64_t retry_in;    /* changes until a rebuild that found no memory is tried again */
    uint64_t rebuilds;
} rgi_grid;

/** Reads a configuration: NULL gives the defaults. RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_LIMIT_EXCEEDED. */
rg_result rgi_grid_config_read(rg_grid_config *config, const rg_grid_config *given);

/** An empty grid for a configuration that was read. RG_OUT_OF_MEMORY. */
rg_result rgi_grid_init(rgi_grid *grid, rgi_memory *memory, const rg_grid_config *config, rg_log log, void *log_user);
void rgi_grid_free(rgi_grid *grid);

/**
 * Adds a member; *member is its record. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED: nothing has changed. Cost: the cells
 * that the box overlaps.
 */
rg_result rgi_grid_insert(rgi_grid *grid, uint32_t object, const double lo[3], const double hi[3], uint32_t *member);

/** Gives a member a new box. If it stays in its cells, only its record changes. Errors as for insert. */
rg_result rgi_grid_move(rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3]);

/** What changes to come will take. Start with all zeros, add each, reserve the sum; then none of them can fail. */
typedef struct rgi_grid_need {
    uint64_t members, entries, tiles;
} rgi_grid_need;

void rgi_grid_need_insert(const rgi_grid *grid, const double lo[3], const double hi[3], rgi_grid_need *need);

/** Returns whether the member would stay in its cells, which needs nothing. */
bool rgi_grid_need_move(const rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3],
                        rgi_grid_need *need);
rg_result rgi_grid_reserve(rgi_grid *grid, const rgi_grid_need *need);

/** rgi_grid_move for a member that is known to stay in its cells. */
void rgi_grid_move_inside(rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3]);

void rgi_grid_remove(rgi_grid *grid, uint32_t member);

/** After changes: rebuilds if the rules ask for it. Without memory the old cells stay and serve; later it is tried
 * again. */
void rgi_grid_settle(rgi_grid *grid);

/** Rebuilds now, with a box that fits. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_grid_rebuild(rgi_grid *grid);

/** Takes a new configuration that was read and rebuilds. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_grid_configure(rgi_grid *grid, const rg_grid_config *config);

void rgi_grid_report(const rgi_grid *grid, rg_grid_report *report);

static inline const rgi_member *rgi_grid_member(const rgi_grid *grid, uint32_t member) {
    return rgi_slots_at(&grid->members, member);
}

/** See rgi_cells_walk. */
static inline bool rgi_grid_walk(const rgi_grid *grid, rgi_walk *walk) {
    return rgi_cells_walk(&grid->cells, grid->lo, grid->hi, walk);
}

#endif
