/* SPDX-License-Identifier: MIT */
#include "any_grid.h"

#include "error.h"
#include "vec.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

rg_result rgi_any_grid_init(rgi_any_grid *grid, rg_scene *scene, const rg_grid_config *config) {
    memset(grid, 0, sizeof *grid);
    grid->config = *config;
    grid->log = scene->log;
    grid->log_user = scene->log_user;
    if (rgi_any_grid_is_loose(grid)) {
        rgi_lattice_init(&grid->lattice, &scene->memory, &scene->objects, offsetof(rgi_object, place),
                         scene->kernels);
        return RG_OK;
    }
    return rgi_grid_init(&grid->cells, &scene->memory, config, scene->log, scene->log_user);
}

void rgi_any_grid_free(rgi_any_grid *grid) {
    if (rgi_any_grid_is_loose(grid))
        rgi_lattice_free(&grid->lattice);
    else
        rgi_grid_free(&grid->cells);
}

/* ------------------------------------------------------------------------------------------------- objects */

rg_result rgi_any_grid_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rg_result result;
    if (rgi_any_grid_is_loose(grid))
        result = rgi_lattice_insert(&grid->lattice, slot, bound);
    else
        result =
            rgi_grid_insert(&grid->cells, slot, bound->lo, bound->hi, &rgi_scene_object(scene, slot)->place.block);
    grid->count += !result;
    return result;
}

rg_result rgi_any_grid_move(rgi_any_grid *grid, rgi_object *object, uint32_t slot, const rgi_bound *bound) {
    if (!rgi_any_grid_is_loose(grid)) return rgi_grid_move(&grid->cells, object->place.block, bound->lo, bound->hi);
    return rgi_lattice_move(&grid->lattice, slot, bound);
}

void rgi_any_grid_remove(rgi_any_grid *grid, rgi_object *object, uint32_t slot) {
    grid->count--;
    if (rgi_any_grid_is_loose(grid))
        rgi_lattice_remove(&grid->lattice, slot);
    else
        rgi_grid_remove(&grid->cells, object->place.block);
}

void rgi_any_grid_need_insert(const rgi_any_grid *grid, const rgi_bound *bound, rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(grid)) rgi_grid_need_insert(&grid->cells, bound->lo, bound->hi, need);
}

bool rgi_any_grid_need_move(const rgi_any_grid *grid, const rgi_object *object, const rgi_bound *bound,
                            rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(grid))
        return rgi_grid_need_move(&grid->cells, object->place.block, bound->lo, bound->hi, need);
    need->members += !rgi_lattice_has_cell(&grid->lattice, &object->place, bound);
    return false;
}

rg_result rgi_any_grid_reserve(rgi_any_grid *grid, const rgi_grid_need *need) {
    return rgi_any_grid_is_loose(grid) ? rgi_lattice_reserve(&grid->lattice, need->members)
                                       : rgi_grid_reserve(&grid->cells, need);
}

/* ---------------------------------------------------------------------------------------------- rebuilding */

static void tell(const rgi_any_grid *grid, const char *why) {
    char line[160];
    if (!grid->log) return;
    snprintf(line, sizeof line, "grid rebuilt (%s): %" PRIu64 " objects, %" PRIu32 " nodes", why, grid->count,
             rgi_lattice_nodes(&grid->lattice));
    grid->log(grid->log_user, line);
}

/** Objects by their slots. */
typedef struct slots_of_scene {
    const rg_scene *scene;
    const uint32_t *slots;
} slots_of_scene;

static void bound_of_slot(const void *context, uint64_t i, uint32_t *slot, rgi_bound *bound) {
    const slots_of_scene *s = context;
    const rgi_object *object = rgi_scene_object(s->scene, s->slots[i]);
    rgi_placing p;
    (void)rgi_place_at(s->scene, object, object->position, &p);
    *slot = s->slots[i];
    *bound = p.bound;
}

rg_result rgi_any_grid_fill(rgi_any_grid *grid, rg_scene *scene, const uint32_t *slots, uint64_t count) {
    const slots_of_scene source = {scene, slots};
    rg_result result = RG_OK;
    if (rgi_any_grid_is_loose(grid)) {
        result = rgi_lattice_build(&grid->lattice, bound_of_slot, &source, count);
        grid->count = result ? 0 : count;
        return result;
    }
    for (uint64_t i = 0; i < count && !result; i++) {
        rgi_bound bound;
        uint32_t slot;
        bound_of_slot(&source, i, &slot, &bound);
        result = rgi_any_grid_insert(grid, scene, slot, &bound);
    }
    return result;
}

void rgi_any_grid_clear(rgi_any_grid *grid, rg_scene *scene) {
    const rg_grid_config config = grid->config;
    uint64_t rebuilds = grid->rebuilds;
    rgi_any_grid_free(grid);
    (void)rgi_any_grid_init(grid, scene, &config); /* of an empty lattice can't fail */
    grid->rebuilds = rebuilds;
}

/* A grid as it is while another is made beside it. */
typedef struct old_places {
    uint32_t *slots;
    rgi_location *places;
    uint64_t count;
} old_places;

static void free_places(rg_scene *scene, old_places *old) {
    rgi_release(&scene->memory, old->slots, old->count, sizeof *old->slots);
    rgi_release(&scene->memory, old->places, old->count, sizeof *old->places);
}

/* Notes the objects of grid `index` and where they are stored. */
static rg_result note_places(rg_scene *scene, uint32_t index, uint64_t count, old_places *old) {
    uint64_t at = 0;
    memset(old, 0, sizeof *old);
    if (count == 0) return RG_OK;
    rg_result result = rgi_allocate(&scene->memory, count, sizeof *old->slots, "rebuilding a grid", &old->slots);
    if (result) return result;
    result = rgi_allocate(&scene->memory, count, sizeof *old->places, "rebuilding a grid", &old->places);
    if (result) {
        rgi_release(&scene->memory, old->slots, count, sizeof *old->slots);
        return result;
    }
    old->count = count;
    for (uint32_t slot = 0; slot < scene->objects.used; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        if (!object->shape || object->grid != index) continue;
        old->slots[at] = slot;
        old->places[at++] = object->place;
    }
    return RG_OK;
}

static uint64_t rebuilds_of(const rgi_any_grid *grid) {
    return rgi_any_grid_is_loose(grid) ? grid->rebuilds : grid->cells.rebuilds;
}

/* Makes a grid anew, beside the old one. `why` for the log. */
static rg_result make_anew(rgi_any_grid *grid, rg_scene *scene, uint32_t index, const rg_grid_config *config,
                           const char *why) {
    rgi_any_grid new;
    old_places old;
    rg_result result = note_places(scene, index, grid->count, &old);
    if (result) return result;
    result = rgi_any_grid_init(&new, scene, config);
    if (!result) {
        result = rgi_any_grid_fill(&new, scene, old.slots, old.count);
        if (!result && !rgi_any_grid_is_loose(&new)) result = rgi_grid_rebuild(&new.cells);
        if (result) rgi_any_grid_free(&new);
    }
    for (uint64_t i = 0; i < old.count && result; i++) rgi_scene_object(scene, old.slots[i])->place = old.places[i];
    free_places(scene, &old);
    if (result) return result;
    new.rebuilds = new.cells.rebuilds = rebuilds_of(grid) + 1;
    rgi_any_grid_free(grid);
    *grid = new;
    if (rgi_any_grid_is_loose(grid)) tell(grid, why);
    return RG_OK;
}

rg_result rgi_any_grid_configure(rgi_any_grid *grid, rg_scene *scene, uint32_t index, const rg_grid_config *config) {
    if (rgi_any_grid_is_loose(grid) || config->kind == RG_GRID_LOOSE)
        return make_anew(grid, scene, index, config, "configured");
    rg_result result = rgi_grid_configure(&grid->cells, config);
    if (!result) grid->config = *config;
    return result;
}

rg_result rgi_any_grid_rebuild(rgi_any_grid *grid, rg_scene *scene, uint32_t index) {
    if (!rgi_any_grid_is_loose(grid)) return rgi_grid_rebuild(&grid->cells);
    const rg_grid_config config = grid->config;
    rg_result result = make_anew(grid, scene, index, &config, "asked for");
    if (!result) grid->unbounded_at = grid->lattice.unbounded_count;
    return result;
}

/*
 * A lattice is made anew only when its frame fits no more: when floats lose the objects' bits because all have
 * drifted so many radii away from its origin, or when too many are out of its reach. Either takes as many changes as
 * there are objects, or twice the number that there was.
 */
enum { LOOK_AFTER = 256, MANY_UNBOUNDED = 16, FAR_AWAY = 4 };

static const char *why_new_frame(const rgi_any_grid *grid) {
    const rgi_middle middle = rgi_lattice_middle(&grid->lattice);
    uint64_t unbounded = grid->lattice.unbounded_count;
    if (unbounded > MANY_UNBOUNDED && unbounded > 2 * grid->unbounded_at) return "many objects were out of its reach";
    if (grid->lattice.root && rgi_max_magnitude(middle.centre) > FAR_AWAY * middle.radius)
        return "the objects have gone far from its origin";
    return NULL;
}

static uint32_t index_of(const rg_scene *scene, const rgi_any_grid *grid) {
    uint32_t i = 0;
    while (scene->grids[i].grid != grid) i++;
    return i;
}

void rgi_any_grid_settle(rgi_any_grid *grid, rg_scene *scene, uint64_t changes) {
    if (!rgi_any_grid_is_loose(grid)) {
        rgi_grid_settle(&grid->cells);
        return;
    }
    if (grid->next_look > changes) {
        grid->next_look -= changes;
        return;
    }
    grid->next_look = LOOK_AFTER;
    const char *why = why_new_frame(grid);
    if (!why) return;
    const rg_grid_config config = grid->config;
    rgi_fail_quietly(true);
    rg_result result = make_anew(grid, scene, index_of(scene, grid), &config, why);
    rgi_fail_quietly(false);
    /* Without memory it goes on as it is; a new frame that fits no better is not asked for soon again. */
    grid->next_look = LOOK_AFTER + grid->count;
    if (!result) grid->unbounded_at = grid->lattice.unbounded_count;
}

uint32_t rgi_any_grid_uses(const rgi_any_grid *grid) {
    uint32_t uses = 0;
    if (rgi_any_grid_is_loose(grid)) {
        if (grid->lattice.boxes) uses |= RG_WITHOUT_BOXES;
        if (grid->lattice.unbounded_count) uses |= RG_WITHOUT_UNBOUNDED;
        return uses;
    }
    rg_grid_report report;
    rgi_grid_report(&grid->cells, &report);
    uses |= RG_WITHOUT_BOXES;
    if (report.unbounded) uses |= RG_WITHOUT_UNBOUNDED;
    if (report.tiles > 1) uses |= RG_WITHOUT_TILES;
    if (report.levels && report.levels_used == (uint32_t)((1ull << report.levels) - 1)) uses |= RG_WITHOUT_LEVELS;
    return uses;
}

/* Those without a cell, but for the infinite, are in the logical box too. */
static void hold_unbounded(const rgi_any_grid *grid, const rg_scene *scene, double lo[3], double hi[3]) {
    for (uint32_t i = 0; i < grid->lattice.unbounded_count; i++) {
        const rgi_object *object = rgi_scene_object(scene, grid->lattice.unbounded[i]);
        rgi_placing p;
        (void)rgi_place_at(scene, object, object->position, &p);
        if (rgi_max(rgi_max_magnitude(p.bound.lo), rgi_max_magnitude(p.bound.hi)) < INFINITY)
            rgi_grow(lo, hi, p.bound.lo, p.bound.hi);
    }
}

void rgi_any_grid_report(const rgi_any_grid *grid, const rg_scene *scene, rg_grid_report *report) {
    if (!rgi_any_grid_is_loose(grid)) {
        rgi_grid_report(&grid->cells, report);
        return;
    }
    memset(report, 0, sizeof *report);
    report->kind = RG_GRID_LOOSE;
    rgi_lattice_box(&grid->lattice, report->logical_lo, report->logical_hi);
    hold_unbounded(grid, scene, report->logical_lo, report->logical_hi);
    report->objects = grid->count;
    report->entries = grid->lattice.count;
    report->unbounded = grid->lattice.unbounded_count;
    report->levels = rgi_lattice_levels(&grid->lattice);
    report->rebuilds = grid->rebuilds;
}
