/* SPDX-License-Identifier: MIT */
/*
 * Rebuilding a grid beside itself: a second one is made from the scene's objects in slot order, a few at a time,
 * while the first goes on to serve traces and changes; then it takes its place. Objects below a slot, the cursor, are
 * in both grids, and changes of them are made in both: so nothing has to be caught up with when it is done.
 *
 * The steps are made by a worker of the pool, in a fifth of its time or more, holding the scene as traces do and
 * letting changes go first; without workers, by the changes themselves, each a little. If there is no memory for it,
 * the rebuild is given up and the grid serves on as it is.
 */
#ifndef RAYGRID_LIB_REBUILD_H
#define RAYGRID_LIB_REBUILD_H

#include "any_grid.h"

/** Begins one, if none is under way and there is memory for it. `rule`: of the paper's kinds, else only `why`. With
 * the scene held for a change, as for all that follows but rgi_rebuild_work. */
void rgi_rebuild_begin(rgi_any_grid *grid, rg_scene *scene, const rgi_grid_rule *rule);

/** Gives it up at once. */
void rgi_rebuild_drop(rgi_any_grid *grid, rg_scene *scene);

/** A part of it: about as long as so many inserts take. */
void rgi_rebuild_go_on(rgi_any_grid *grid, rg_scene *scene, uint64_t inserts);

/** What the grid has done with an object is done in the new one, too. */
void rgi_rebuild_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);
void rgi_rebuild_move(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound);
void rgi_rebuild_remove(rgi_any_grid *grid, rg_scene *scene, uint32_t slot);

/** What a worker does beside its jobs: a part of some rebuild of the scene. Returns whether there is
 * more. */
bool rgi_rebuild_work(void *scene);

#endif
