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
    rgi_grid cells;              /* the paper's kinds */
    rgi_lattice lattice;         /* RG_GRID_LOOSE */
    rgi_slots *places;           /* rgi_location: where its objects are stored, by slot; NULL: in their records */
    struct rgi_rebuild *rebuild; /* under way beside it, or NULL */
    uint32_t index;              /* of the grid in the scene */
    uint64_t count;
    uint64_t rebuilds;     /* of the lattice */
    uint64_t next_look;    /* changes until its frame is looked at again */
    uint64_t unbounded_at; /* objects without a cell when it was last made */
} rgi_any_grid;

/** An empty one for a configuration that was read; takes `places` over, which may be NULL. RG_OUT_OF_MEMORY: `places`
 * is the caller's still. */
rg_result rgi_any_grid_init(rgi_any_grid *grid, rg_scene *scene, uint32_t index, const rg_grid_config *config,
                            rgi_slots *places);
void rgi_any_grid_free(rgi_any_grid *grid, rg_scene *scene);

/** Gives some of its memory back; nothing else may be done with it from the first time on. Returns whether there is
 * more. Cost: bounded. */
bool rgi_any_grid_free_some(rgi_any_grid *grid, rg_scene *scene);

/** Whether it is a lattice. */
static inline bool rgi_any_grid_is_loose(const rgi_any_grid *grid) {
    return grid->config.kind == RG_GRID_LOOSE;
}

/** Where an object of the grid is stored. */
static inline rgi_location *rgi_any_grid_place(const rgi_any_grid *grid, const rg_scene *scene, uint32_t slot) {
    return grid->places ? rgi_slots_at(grid->places, slot) : &rgi_scene_object(scene, slot)->place;
}

/*
 * What follows is also done in the grid that is being made beside it, if there is one. It never fails because of
 * that: the rebuild is given up.
 */

/** Stores an object; its place is noted. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_any_grid_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);
rg_result rgi_any_grid_move(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);
void rgi_any_grid_remove(rgi_any_grid *grid, rg_scene *scene, uint32_t slot);

/** The same as a move, of an object of the paper's kinds that is known to stay in its cells. */
void rgi_any_grid_move_inside(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);

/** The quick way to move a ball in a lattice that reaches its new position: if it stays in its cell. False: nothing
 * has been done. */
bool rgi_any_grid_step(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const double position[3], double radius);

/** The bounds of an object by its slot. */
void rgi_bound_of_slot(const rg_scene *scene, uint32_t slot, rgi_bound *bound);

/** Stores objects whose records are filled in an empty grid. On failure the grid is to be freed or cleared. */
rg_result rgi_any_grid_fill(rgi_any_grid *grid, rg_scene *scene, const uint32_t *slots, uint64_t count);

/** Makes a loose grid empty. */
void rgi_any_grid_clear(rgi_any_grid *grid, rg_scene *scene);

/** What changes to come will take, as rgi_grid_need. */
void rgi_any_grid_need_insert(const rgi_any_grid *grid, const rgi_bound *bound, rgi_grid_need *need);
bool rgi_any_grid_need_move(const rgi_any_grid *grid, const rg_scene *scene, uint32_t slot, const rgi_bound *bound,
                            rgi_grid_need *need);

/** After it moves can't fail. Inserts into a lattice still may: their sum is not known before. */
rg_result rgi_any_grid_reserve(rgi_any_grid *grid, const rgi_grid_need *need);

/** After so many changes: applies the rules by which it is rebuilt. Cost: constant, and a part of the cost of the
 * changes; see lib/rebuild.h. */
void rgi_any_grid_settle(rgi_any_grid *grid, rg_scene *scene, uint64_t changes);

/** What a rebuild of the grid beside it ends with: it was taken over, or it was not made; `why` it would have been,
 * if there was no memory for it. */
void rgi_any_grid_built(rgi_any_grid *grid, const rgi_any_grid *old, const rgi_grid_rule *rule);
void rgi_any_grid_put_off(rgi_any_grid *grid, const char *why);

/** For an empty lattice beside `grid`: the frame that suits the objects of that. */
void rgi_any_grid_frame(rgi_any_grid *next, const rgi_any_grid *grid, const rg_scene *scene);

/** At once. RG_OUT_OF_MEMORY: nothing has changed. */
rg_result rgi_any_grid_rebuild(rgi_any_grid *grid, rg_scene *scene);
rg_result rgi_any_grid_configure(rgi_any_grid *grid, rg_scene *scene, const rg_grid_config *config);

/** Bits of RG_WITHOUT_* of what rays in this grid can't do without. */
uint32_t rgi_any_grid_uses(const rgi_any_grid *grid);

void rgi_any_grid_report(const rgi_any_grid *grid, const rg_scene *scene, rg_grid_report *report);

#endif
