/* SPDX-License-Identifier: MIT */
#include "any_grid.h"

#include "error.h"
#include "rebuild.h"
#include "vec.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

rg_result rgi_any_grid_init(rgi_any_grid *grid, rg_scene *scene, uint32_t index, const rg_grid_config *config,
                            rgi_slots *places) {
    memset(grid, 0, sizeof *grid);
    grid->index = index;
    grid->config = *config;
    grid->log = scene->log;
    grid->log_user = scene->log_user;
    grid->places = places;
    if (rgi_any_grid_is_loose(grid)) {
        rgi_lattice_init(&grid->lattice, &scene->memory, &scene->objects, offsetof(rgi_object, place), places,
                         scene->kernels);
        return RG_OK;
    }
    return rgi_grid_init(&grid->cells, &scene->memory, config, scene->log, scene->log_user);
}

void rgi_any_grid_free(rgi_any_grid *grid, rg_scene *scene) {
    rgi_rebuild_drop(grid, scene);
    if (rgi_any_grid_is_loose(grid))
        rgi_lattice_free(&grid->lattice);
    else
        rgi_grid_free(&grid->cells);
    if (grid->places) rgi_slots_free(grid->places);
    rgi_release(&scene->memory, grid->places, 1, sizeof *grid->places);
    grid->places = NULL;
}

bool rgi_any_grid_free_some(rgi_any_grid *grid, rg_scene *scene) {
    rgi_cells *cells = &grid->cells.cells;
    rgi_chunks *const chunks[] = {&grid->lattice.arena.chunks, &cells->entries.chunks, &cells->tiles.chunks,
                                  &grid->cells.members.chunks, grid->places ? &grid->places->chunks : NULL};
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++) {
        if (chunks[i] && rgi_chunks_free_some(chunks[i], 1)) return true;
    }
    rgi_any_grid_free(grid, scene);
    return false;
}

/* ------------------------------------------------------------------------------------------------- objects */

static uint32_t *member_of(const rgi_any_grid *grid, const rg_scene *scene, uint32_t slot) {
    return &rgi_any_grid_place(grid, scene, slot)->block;
}

rg_result rgi_any_grid_insert(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rg_result result = grid->places ? rgi_slots_cover(grid->places, slot) : RG_OK;
    if (result) return result;
    result = rgi_any_grid_is_loose(grid)
                 ? rgi_lattice_insert(&grid->lattice, slot, bound)
                 : rgi_grid_insert(&grid->cells, slot, bound->lo, bound->hi, member_of(grid, scene, slot));
    if (result) return result;
    grid->count++;
    if (grid->rebuild) rgi_rebuild_insert(grid, scene, slot, bound);
    return RG_OK;
}

rg_result rgi_any_grid_move(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rg_result result = rgi_any_grid_is_loose(grid)
                           ? rgi_lattice_move(&grid->lattice, slot, bound)
                           : rgi_grid_move(&grid->cells, *member_of(grid, scene, slot), bound->lo, bound->hi);
    if (!result && grid->rebuild) rgi_rebuild_move(grid, scene, slot, bound);
    return result;
}

void rgi_any_grid_move_inside(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rgi_grid_move_inside(&grid->cells, *member_of(grid, scene, slot), bound->lo, bound->hi);
    if (grid->rebuild) rgi_rebuild_move(grid, scene, slot, bound);
}

bool rgi_any_grid_step(rgi_any_grid *grid, rg_scene *scene, uint32_t slot, const double position[3], double radius) {
    if (!rgi_lattice_step(&grid->lattice, rgi_any_grid_place(grid, scene, slot), position, radius)) return false;
    if (grid->rebuild) {
        rgi_bound bound = {.ball = true, .radius = radius};
        rgi_copy(position, bound.centre);
        (void)rgi_ball_bounds(radius, position, bound.lo, bound.hi); /* was checked before */
        rgi_rebuild_move(grid, scene, slot, &bound);
    }
    return true;
}

void rgi_any_grid_remove(rgi_any_grid *grid, rg_scene *scene, uint32_t slot) {
    grid->count--;
    if (grid->rebuild) rgi_rebuild_remove(grid, scene, slot);
    if (rgi_any_grid_is_loose(grid))
        rgi_lattice_remove(&grid->lattice, slot);
    else
        rgi_grid_remove(&grid->cells, *member_of(grid, scene, slot));
}

void rgi_any_grid_need_insert(const rgi_any_grid *grid, const rgi_bound *bound, rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(grid)) rgi_grid_need_insert(&grid->cells, bound->lo, bound->hi, need);
}

bool rgi_any_grid_need_move(const rgi_any_grid *grid, const rg_scene *scene, uint32_t slot, const rgi_bound *bound,
                            rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(grid))
        return rgi_grid_need_move(&grid->cells, *member_of(grid, scene, slot), bound->lo, bound->hi, need);
    need->members += !rgi_lattice_has_cell(&grid->lattice, rgi_any_grid_place(grid, scene, slot), bound);
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

void rgi_bound_of_slot(const rg_scene *scene, uint32_t slot, rgi_bound *bound) {
    const rgi_object *object = rgi_scene_object(scene, slot);
    rgi_placing p;
    (void)rgi_place_at(scene, object, object->position, &p);
    *bound = p.bound;
}

/** Objects by their slots. */
typedef struct slots_of_scene {
    const rg_scene *scene;
    const uint32_t *slots;
} slots_of_scene;

static void nth_bound(const void *context, uint64_t i, uint32_t *slot, rgi_bound *bound) {
    const slots_of_scene *s = context;
    *slot = s->slots[i];
    rgi_bound_of_slot(s->scene, *slot, bound);
}

rg_result rgi_any_grid_fill(rgi_any_grid *grid, rg_scene *scene, const uint32_t *slots, uint64_t count) {
    const slots_of_scene source = {scene, slots};
    rg_result result = RG_OK;
    rgi_rebuild_drop(grid, scene);
    if (grid->places && count) result = rgi_slots_cover(grid->places, scene->objects.used - 1);
    if (result) return result;
    if (rgi_any_grid_is_loose(grid)) {
        result = rgi_lattice_build(&grid->lattice, nth_bound, &source, count);
        grid->count = result ? 0 : count;
        return result;
    }
    for (uint64_t i = 0; i < count && !result; i++) {
        rgi_bound bound;
        uint32_t slot;
        nth_bound(&source, i, &slot, &bound);
        result = rgi_any_grid_insert(grid, scene, slot, &bound);
    }
    return result;
}

void rgi_any_grid_clear(rgi_any_grid *grid, rg_scene *scene) {
    const rg_grid_config config = grid->config;
    uint64_t rebuilds = grid->rebuilds;
    rgi_any_grid_free(grid, scene);
    (void)rgi_any_grid_init(grid, scene, grid->index, &config, NULL); /* of an empty lattice can't fail */
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

/* Makes a grid anew at once, beside the old one. `why` for the log. */
static rg_result make_anew(rgi_any_grid *grid, rg_scene *scene, const rg_grid_config *config, const char *why) {
    rgi_any_grid new;
    old_places old;
    rgi_rebuild_drop(grid, scene);
    rg_result result = note_places(scene, grid->index, grid->count, &old);
    if (result) return result;
    result = rgi_any_grid_init(&new, scene, grid->index, config, NULL);
    if (!result) {
        result = rgi_any_grid_fill(&new, scene, old.slots, old.count);
        if (!result && !rgi_any_grid_is_loose(&new)) result = rgi_grid_rebuild(&new.cells);
        if (result) rgi_any_grid_free(&new, scene);
    }
    for (uint64_t i = 0; i < old.count && result; i++) rgi_scene_object(scene, old.slots[i])->place = old.places[i];
    free_places(scene, &old);
    if (result) return result;
    new.rebuilds = new.cells.rebuilds = rebuilds_of(grid) + 1;
    new.unbounded_at = new.lattice.unbounded_count;
    rgi_any_grid_free(grid, scene);
    *grid = new;
    if (rgi_any_grid_is_loose(grid)) tell(grid, why);
    return RG_OK;
}

rg_result rgi_any_grid_configure(rgi_any_grid *grid, rg_scene *scene, const rg_grid_config *config) {
    if (rgi_any_grid_is_loose(grid) || config->kind == RG_GRID_LOOSE)
        return make_anew(grid, scene, config, "configured");
    rgi_rebuild_drop(grid, scene);
    rg_result result = rgi_grid_configure(&grid->cells, config);
    if (!result) grid->config = *config;
    return result;
}

rg_result rgi_any_grid_rebuild(rgi_any_grid *grid, rg_scene *scene) {
    const rg_grid_config config = grid->config;
    if (rgi_any_grid_is_loose(grid)) return make_anew(grid, scene, &config, "asked for");
    rgi_rebuild_drop(grid, scene);
    return rgi_grid_rebuild(&grid->cells);
}

/* The source of choose_frame: bounds of slots from a place on until one is the grid's; else none. */
typedef struct near_slots {
    const rg_scene *scene;
    uint32_t index;
} near_slots;

static void bound_near(const void *context, uint64_t i, uint32_t *slot, rgi_bound *bound) {
    enum { LOOKED_AT = 16 };
    const near_slots *s = context;
    const rgi_bound none = {.lo = {-INFINITY, -INFINITY, -INFINITY}, .hi = {INFINITY, INFINITY, INFINITY}};
    *bound = none;
    for (uint32_t n = 0; n < LOOKED_AT && i + n < s->scene->objects.used; n++) {
        *slot = (uint32_t)i + n;
        const rgi_object *object = rgi_scene_object(s->scene, *slot);
        if (!object->shape || object->grid != s->index) continue;
        rgi_bound_of_slot(s->scene, *slot, bound);
        return;
    }
}

void rgi_any_grid_frame(rgi_any_grid *next, const rgi_any_grid *grid, const rg_scene *scene) {
    const near_slots source = {scene, grid->index};
    rgi_lattice_choose_frame(&next->lattice, bound_near, &source, scene->objects.used, &grid->lattice);
}

/*
 * A lattice is made anew only when its frame fits no more: when floats lose the objects' bits because all have
 * drifted so many radii away from its origin, or when too many are out of its reach. Either takes as many changes as
 * there are objects, or twice the number that there was.
 */
enum { LOOK_AFTER = 256, MANY_UNBOUNDED = 16, FAR_AWAY = 4 };

/* So few objects, or slots of the scene to look through, are rebuilt at once: it takes some ten microseconds. */
enum { AT_ONCE = 128 };

static const char *why_new_frame(const rgi_any_grid *grid) {
    const rgi_middle middle = rgi_lattice_middle(&grid->lattice);
    uint64_t unbounded = grid->lattice.unbounded_count;
    if (unbounded > MANY_UNBOUNDED && unbounded > 2 * grid->unbounded_at) return "many objects were out of its reach";
    if (grid->lattice.root && rgi_max_magnitude(middle.centre) > FAR_AWAY * middle.radius)
        return "the objects have gone far from its origin";
    return NULL;
}

void rgi_any_grid_built(rgi_any_grid *grid, const rgi_any_grid *old, const rgi_grid_rule *rule) {
    if (!rgi_any_grid_is_loose(grid)) {
        rgi_grid_built(&grid->cells, &old->cells, rule);
        return;
    }
    grid->rebuilds = old->rebuilds + 1;
    grid->next_look = LOOK_AFTER + grid->count;
    grid->unbounded_at = grid->lattice.unbounded_count;
    tell(grid, rule->why);
}

void rgi_any_grid_put_off(rgi_any_grid *grid, const char *why) {
    grid->next_look = LOOK_AFTER + grid->count;
    if (!rgi_any_grid_is_loose(grid)) rgi_grid_put_off(&grid->cells, why);
}

static void settle_lattice(rgi_any_grid *grid, rg_scene *scene, uint64_t changes) {
    if (grid->next_look > changes) {
        grid->next_look -= changes;
        return;
    }
    grid->next_look = LOOK_AFTER;
    const rgi_grid_rule rule = {why_new_frame(grid), false, false};
    if (!rule.why) return;
    if (scene->objects.used > AT_ONCE) {
        rgi_rebuild_begin(grid, scene, &rule);
        return;
    }
    const rg_grid_config config = grid->config;
    rgi_fail_quietly(true);
    (void)make_anew(grid, scene, &config, rule.why);
    rgi_fail_quietly(false);
    /* Without memory it goes on as it is; a new frame that fits no better is not asked for soon again. */
    grid->next_look = LOOK_AFTER + grid->count;
}

/* At once also if the call has inserted a good part of what the grid holds. */
static void settle_cells(rgi_any_grid *grid, rg_scene *scene, uint64_t changes) {
    const rgi_grid_rule rule = rgi_grid_ask(&grid->cells);
    if (!rule.why) return;
    if (grid->count > AT_ONCE && (rule.outgrown || grid->count > 4 * changes))
        rgi_rebuild_begin(grid, scene, &rule);
    else
        rgi_grid_obey(&grid->cells, &rule);
}

/* What the changes themselves do of a rebuild, in inserts: a few, and for calls on many a small part of their cost.
 */
static uint64_t share(uint64_t changes) {
    return 4 + changes / 32;
}

void rgi_any_grid_settle(rgi_any_grid *grid, rg_scene *scene, uint64_t changes) {
    if (grid->rebuild) {
        if (!rgi_pool_has_threads(scene->pool)) rgi_rebuild_go_on(grid, scene, share(changes));
    } else if (rgi_any_grid_is_loose(grid)) {
        settle_lattice(grid, scene, changes);
    } else {
        settle_cells(grid, scene, changes);
    }
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
        report->rebuilding = grid->rebuild != NULL;
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
    report->rebuilding = grid->rebuild != NULL;
}
