/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE
#include "rebuild.h"

#include "error.h"
#include "vec.h"

#include <string.h>
#include <time.h>

enum {
    QUANTUM = 256, /* objects that a worker takes before it looks for other work */
    AT_LEAST = 6,  /* and before it lets a change in that waits: some 10 us if none of them is in the caches */
    /* In units of an insert: */
    MEMBERS_SURVEYED = 16,
    CELLS_CLEARED = 2048
};

typedef enum stage {
    SURVEYING, /* the paper's kinds: a box around the members */
    PLANNING,
    CLEARING, /* the new cells, up to the cursor */
    FILLING,  /* objects of slots below the cursor are in `next` */
    FILLED,
    RELEASING, /* `next` is what is not needed any more: the old grid, or one that was given up */
    RELEASED
} stage;

typedef struct rgi_rebuild {
    rgi_any_grid next;
    rgi_grid_rule rule;
    stage stage;
    bool given_up; /* for want of memory, or */
    bool needless; /* because its rule did not hold */
    uint32_t cursor;
    double lo[3], hi[3]; /* of the survey */
} rgi_rebuild;

/* ------------------------------------------------------------------------------------------ begin and end */

static void give_up(rgi_rebuild *r) {
    r->given_up = true;
    r->stage = RELEASING;
}

/* The new grid notes places where the old one does not. */
static rg_result make_places(rgi_rebuild *r, const rgi_any_grid *grid, rg_scene *scene) {
    if (grid->places) return RG_OK;
    rg_result result = rgi_allocate(&scene->memory, 1, sizeof *r->next.places, "rebuilding a grid", &r->next.places);
    if (!result) rgi_slots_init(r->next.places, &scene->memory, sizeof(rgi_location), "rebuilding a grid");
    return result;
}

static rg_result begin(rgi_any_grid *grid, rg_scene *scene, const rgi_grid_rule *rule) {
    rgi_rebuild *r;
    rg_result result = rgi_allocate(&scene->memory, 1, sizeof *r, "rebuilding a grid", &r);
    if (result) return result;
    memset(r, 0, sizeof *r);
    r->rule = *rule;
    r->stage = rgi_any_grid_is_loose(grid) ? PLANNING : SURVEYING;
    rgi_empty_box(r->lo, r->hi);
    result = make_places(r, grid, scene);
    if (result) {
        rgi_release(&scene->memory, r, 1, sizeof *r);
        return result;
    }
    r->next.config = grid->config;
    r->next.index = grid->index;
    r->next.log = grid->log;
    r->next.log_user = grid->log_user;
    grid->rebuild = r;
    return RG_OK;
}

void rgi_rebuild_begin(rgi_any_grid *grid, rg_scene *scene, const rgi_grid_rule *rule) {
    if (grid->rebuild) return;
    rgi_fail_quietly(true);
    rg_result result = begin(grid, scene, rule);
    rgi_fail_quietly(false);
    if (result)
        rgi_any_grid_put_off(grid, rule->why);
    else
        rgi_pool_wake(scene->pool);
}

void rgi_rebuild_drop(rgi_any_grid *grid, rg_scene *scene) {
    rgi_rebuild *r = grid->rebuild;
    if (!r) return;
    rgi_any_grid_free(&r->next, scene);
    rgi_release(&scene->memory, r, 1, sizeof *r);
    grid->rebuild = NULL;
}

/* ------------------------------------------------------------------------------------------------ the steps */

/* The rule is asked again with the exact box. */
static void survey(rgi_rebuild *r, const rgi_any_grid *grid) {
    if (!rgi_grid_survey(&grid->cells, &r->cursor, MEMBERS_SURVEYED, r->lo, r->hi)) return;
    r->needless = !rgi_grid_holds(&grid->cells, &r->rule, r->lo, r->hi);
    r->stage = r->needless ? RELEASING : PLANNING;
}

static void plan(rgi_rebuild *r, const rgi_any_grid *grid, rg_scene *scene) {
    rg_result result = RG_OK;
    rgi_slots *places = r->next.places;
    r->cursor = 0;
    if (rgi_any_grid_is_loose(grid)) {
        result = rgi_any_grid_init(&r->next, scene, grid->index, &grid->config, places);
        rgi_any_grid_frame(&r->next, grid, scene);
        r->stage = FILLING;
    } else {
        result = rgi_grid_plan(&r->next.cells, &grid->cells, &r->rule, r->lo, r->hi);
        r->stage = CLEARING;
    }
    if (result) give_up(r);
}

static void clear(rgi_rebuild *r) {
    rgi_cells *cells = &r->next.cells.cells;
    uint32_t left = cells->cell_count - r->cursor, count = left < CELLS_CLEARED ? left : CELLS_CLEARED;
    rgi_cells_clear(cells, r->cursor, count);
    r->cursor += count;
    if (count < left) return;
    r->cursor = 0;
    r->stage = FILLING;
}

static void store(rgi_rebuild *r, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rgi_fail_quietly(true);
    if (rgi_any_grid_insert(&r->next, scene, slot, bound)) give_up(r);
    rgi_fail_quietly(false);
}

static void fill(rgi_rebuild *r, rg_scene *scene) {
    /* A call on many that found no memory has taken slots back: there may be fewer than there were. */
    if (r->cursor >= scene->objects.used) {
        r->stage = FILLED;
        return;
    }
    uint32_t slot = r->cursor++;
    const rgi_object *object = rgi_scene_object(scene, slot);
    if (!object->shape || object->grid != r->next.index) return;
    rgi_bound bound;
    rgi_bound_of_slot(scene, slot, &bound);
    store(r, scene, slot, &bound);
}

/* With the scene held in whatever way: nobody else looks at what is changed here. */
static void step(rgi_rebuild *r, const rgi_any_grid *grid, rg_scene *scene) {
    switch (r->stage) {
    case SURVEYING:
        survey(r, grid);
        return;
    case PLANNING:
        plan(r, grid, scene);
        return;
    case CLEARING:
        clear(r);
        return;
    case FILLING:
        fill(r, scene);
        return;
    case RELEASING:
        if (!rgi_any_grid_free_some(&r->next, scene)) r->stage = RELEASED;
        return;
    case FILLED:
    case RELEASED:
        return;
    }
}

static void take_over(rgi_rebuild *r, rgi_any_grid *grid) {
    rgi_any_grid old = *grid;
    old.rebuild = NULL;
    *grid = r->next;
    grid->rebuild = r;
    rgi_any_grid_built(grid, &old, &r->rule);
    r->next = old;
    r->stage = RELEASING;
}

/* What only a change may do. */
static void finish(rgi_any_grid *grid, rg_scene *scene) {
    rgi_rebuild *r = grid->rebuild;
    if (r->stage == FILLED) {
        /* Others may have come while the lock was changed. */
        if (r->cursor < scene->objects.used)
            r->stage = FILLING;
        else
            take_over(r, grid);
    } else if (r->stage == RELEASED) {
        if (r->given_up || r->needless) rgi_any_grid_put_off(grid, r->given_up ? r->rule.why : NULL);
        rgi_rebuild_drop(grid, scene);
    }
}

static bool waits_for_change(const rgi_rebuild *r) {
    return r->stage == FILLED || r->stage == RELEASED;
}

void rgi_rebuild_go_on(rgi_any_grid *grid, rg_scene *scene, uint64_t inserts) {
    for (; inserts && grid->rebuild; inserts--) {
        step(grid->rebuild, grid, scene);
        if (waits_for_change(grid->rebuild)) finish(grid, scene);
    }
}

/* ------------------------------------------------------------------------------------- changes meanwhile */

/* Whether the object is in the new grid already. */
static bool has(const rgi_rebuild *r, uint32_t slot) {
    return (r->stage == FILLING || r->stage == FILLED) && slot < r->cursor;
}

/* The box of the survey holds those, too, that it has passed. */
static void note(rgi_rebuild *r, const rgi_bound *bound) {
    if (r->stage == SURVEYING && rgi_max(rgi_max_magnitude(bound->lo), rgi_max_magnitude(bound->hi)) < INFINITY)
        rgi_grow(r->lo, r->hi, bound->lo, bound->hi);
}

void rgi_rebuild_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    note(grid->rebuild, bound);
    if (has(grid->rebuild, slot)) store(grid->rebuild, scene, slot, bound);
}

void rgi_rebuild_move(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rgi_rebuild *r = grid->rebuild;
    note(r, bound);
    if (!has(r, slot)) return;
    rgi_fail_quietly(true);
    if (rgi_any_grid_move(&r->next, scene, slot, bound)) give_up(r);
    rgi_fail_quietly(false);
}

void rgi_rebuild_remove(rgi_any_grid *grid, rg_scene *scene, uint32_t slot) {
    if (has(grid->rebuild, slot)) rgi_any_grid_remove(&grid->rebuild->next, scene, slot);
}

/* ------------------------------------------------------------------------------------------ on a worker */

static rgi_any_grid *grid_to_rebuild(const rg_scene *scene) {
    for (uint32_t i = 0; i < scene->grid_places; i++) {
        if (scene->grids[i].grid && scene->grids[i].grid->rebuild) return scene->grids[i].grid;
    }
    return NULL;
}

/* Returns whether it was asked to let a change in. Giving memory back takes the system longer than a step does else.
 */
static bool make_steps(rgi_any_grid *grid, rg_scene *scene) {
    rgi_rebuild *r = grid->rebuild;
    for (int i = 0; i < QUANTUM && !waits_for_change(r); i++) {
        if ((i >= AT_LEAST || r->stage == RELEASING) && i > 0 && rgi_lock_is_wanted(&scene->lock)) return true;
        step(r, grid, scene);
    }
    return false;
}

bool rgi_rebuild_work(void *context) {
    const struct timespec briefly = {0, 20000};
    rg_scene *scene = context;
    rgi_frame frame;
    bool wanted = false, finishes = false;
    rgi_scene_begin_read(scene, &frame);
    rgi_any_grid *grid = grid_to_rebuild(scene);
    bool more = grid;
    if (grid) {
        wanted = make_steps(grid, scene);
        finishes = waits_for_change(grid->rebuild);
    }
    rgi_scene_end_read(scene, &frame);
    if (finishes) {
        /* Another may have been made or dropped in between. */
        rgi_scene_hold(scene, &frame);
        grid = grid_to_rebuild(scene);
        if (grid && waits_for_change(grid->rebuild)) finish(grid, scene);
        /* When reports say that nothing is being rebuilt, the worker does not look into the scene again. */
        more = grid_to_rebuild(scene);
        (void)rgi_scene_end_change(scene, &frame, RG_OK);
    }
    /* Many changes in a row are not to wait for a part of the rebuild each. */
    if (wanted) nanosleep(&briefly, NULL);
    return more;
}
