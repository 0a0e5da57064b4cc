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
    /* The logical box only grows. A sweep over the members, a few a change, makes another one that takes their
     * changes in, too; at its end that is the logical box, and a new sweep begins. */
    uint32_t sweep; /* members below have been looked at */
    double sweep_lo[3], sweep_hi[3];
    bool swept;        /* a sweep has ended since the rules were last applied */
    double physical;   /* diagonal of the physical box */
    bool box_given;    /* the physical box is that of the configuration */
    bool grown;        /* the logical box has grown since the rules were last applied */
    uint64_t retry_in; /* changes until a rebuild that found no memory is tried again */
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

/** That the rules ask for a rebuild. */
typedef struct rgi_grid_rule {
    const char *why; /* NULL: they do not */
    bool given;      /* with the box of the configuration */
    bool outgrown;   /* because of a logical box that may not be exact: with the exact one the rule may not hold */
} rgi_grid_rule;

/** After changes: what the rules ask for. Cost: constant. */
rgi_grid_rule rgi_grid_ask(rgi_grid *grid);

/** Rebuilds at once as a rule asks, if it still does. Without memory the old cells stay and serve; later it is tried
 * again. */
void rgi_grid_obey(rgi_grid *grid, const rgi_grid_rule *rule);

/** That a rebuild was not made; `why` it would have been, if there was no memory for it. The rules hold their peace
 * for as many changes as half the members. */
void rgi_grid_put_off(rgi_grid *grid, const char *why);

/** Asks and obeys. */
void rgi_grid_settle(rgi_grid *grid);

/*
 * The same in steps, each of bounded cost, into a new grid beside the old one, which stays as it is and may change in
 * between. First the survey: a box around the members, a few at a time; then the plan; then the new cells are
 * cleared, a few at a time; then the scene inserts its objects; last, rgi_grid_built.
 */

/** Takes members from *member on, up to `count` of them, into a box. Returns whether all have been. */
bool rgi_grid_survey(const rgi_grid *grid, uint32_t *member, uint32_t count, double lo[3], double hi[3]);

/** Whether a rule still holds for the exact logical box. */
bool rgi_grid_holds(const rgi_grid *grid, const rgi_grid_rule *rule, const double lo[3], const double hi[3]);

/** An empty grid, for the members of the old one, whose box is given; its cells are not cleared yet.
 * RG_OUT_OF_MEMORY. */
rg_result rgi_grid_plan(rgi_grid *grid, const rgi_grid *old, const rgi_grid_rule *rule, const double lo[3],
                        const double hi[3]);

/** That the new grid holds all members now and takes the place of the old one. */
void rgi_grid_built(rgi_grid *grid, const rgi_grid *old, const rgi_grid_rule *rule);

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
