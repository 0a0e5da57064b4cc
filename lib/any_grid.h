/* SPDX-License-Identifier: MIT */
/* A grid of a scene, of whichever kind: where its objects are stored. Called with the scene held for a change. */
#ifndef RAYGRID_LIB_ANY_GRID_H
#define RAYGRID_LIB_ANY_GRID_H

#include "grid.h"
#include "lattice.h"
#include "scene_objects.h"

typedef struct rgi_any_grid {
    rg_grid_config config; /* checked; kind is never RG_GRID_DEFAULT */
    rg_log log;
    void *log_user;
    rgi_grid cells;      /* the paper's kinds */
    rgi_lattice lattice; /* RG_GRID_LOOSE */
    uint64_t count;
    uint64_t rebuilds;     /* of the lattice */
    uint64_t next_look;    /* changes until its frame is looked at again */
    uint64_t unbounded_at; /* objects without a cell when it was last made */
} rgi_any_grid;

/** An empty one for a configuration that was read. RG_OUT_OF_MEMORY. */
rg_result rgi_any_grid_init(rgi_any_grid *grid, rg_scene *scene, const rg_grid_config *config);
void rgi_any_grid_free(rgi_any_grid *grid);

/** Whether it is a lattice. */
static inline bool rgi_any_grid_is_loose(const rgi_any_grid *grid) {
    return grid->config.kind == RG_GRID_LOOSE;
}

/** Stores the object of a slot that has been taken; its record learns its place. RG_OUT_OF_MEMORY: nothing has
 *  changed. */
rg_result rgi_any_grid_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);
rg_result rgi_any_grid_move(rgi_any_grid *grid, rgi_object *object, uint32_t slot, const rgi_bound *bound);
/** Stores objects whose records are filled in an empty grid. On failure the grid is to be freed or cleared. */
rg_result rgi_any_grid_fill(rgi_any_grid *grid, rg_scene *scene, const uint32_t *slots, uint64_t count);

/** Makes a loose grid empty. */
void rgi_any_grid_clear(rgi_any_grid *grid, rg_scene *scene);
void rgi_any_grid_remove(rgi_any_grid *grid, rgi_object *object, uint32_t slot);

/** What changes to come will take, as rgi_grid_need. */
void rgi_any_grid_need_insert(const rgi_any_grid *grid, const rgi_bound *bound, rgi_grid_need *need);
bool rgi_any_grid_need_move(const rgi_any_grid *grid, const rgi_object *object, const rgi_bound *bound,
                            rgi_grid_need *need);

/** After it moves can't fail. Inserts into a lattice still may: their sum is not known before. */
rg_result rgi_any_grid_reserve(rgi_any_grid *grid, const rgi_grid_need *need);

/** After so many changes: applies the rules by which it is rebuilt. */
void rgi_any_grid_settle(rgi_any_grid *grid, rg_scene *scene, uint64_t changes);

/** RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_any_grid_rebuild(rgi_any_grid *grid, rg_scene *scene, uint32_t index);
rg_result rgi_any_grid_configure(rgi_any_grid *grid, rg_scene *scene, uint32_t index, const rg_grid_config *config);

/** Bits of RG_WITHOUT_* of what rays in this grid can't do without. */
uint32_t rgi_any_grid_uses(const rgi_any_grid *grid);

void rgi_any_grid_report(const rgi_any_grid *grid, const rg_scene *scene, rg_grid_report *report);

#endif
