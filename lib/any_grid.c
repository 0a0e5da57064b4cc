/* SPDX-License-Identifier: MIT */
#include "any_grid.h"

#include "vec.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

rg_result rgi_any_grid_init(rgi_any_grid *store, rg_scene *scene, const rg_grid_config *config) {
    memset(store, 0, sizeof *store);
    store->config = *config;
    store->log = scene->log;
    store->log_user = scene->log_user;
    if (rgi_any_grid_is_loose(store)) {
        rgi_lattice_init(&store->lattice, &scene->memory, &scene->objects, offsetof(rgi_object, place));
        return RG_OK;
    }
    return rgi_grid_init(&store->cells, &scene->memory, config, scene->log, scene->log_user);
}

void rgi_any_grid_free(rgi_any_grid *store) {
    if (rgi_any_grid_is_loose(store))
        rgi_lattice_free(&store->lattice);
    else
        rgi_grid_free(&store->cells);
}

/* ------------------------------------------------------------------------------------------------- objects */

rg_result rgi_any_grid_insert(rgi_any_grid *store, rg_scene *scene, uint32_t slot, const rgi_bound *bound) {
    rg_result result;
    if (rgi_any_grid_is_loose(store))
        result = rgi_lattice_insert(&store->lattice, slot, bound);
    else
        result =
            rgi_grid_insert(&store->cells, slot, bound->lo, bound->hi, &rgi_scene_object(scene, slot)->place.block);
    store->count += !result;
    return result;
}

rg_result rgi_any_grid_move(rgi_any_grid *store, rgi_object *object, uint32_t slot, const rgi_bound *bound) {
    if (!rgi_any_grid_is_loose(store)) return rgi_grid_move(&store->cells, object->place.block, bound->lo, bound->hi);
    return rgi_lattice_move(&store->lattice, slot, bound);
}

void rgi_any_grid_remove(rgi_any_grid *store, rgi_object *object, uint32_t slot) {
    store->count--;
    if (rgi_any_grid_is_loose(store))
        rgi_lattice_remove(&store->lattice, slot);
    else
        rgi_grid_remove(&store->cells, object->place.block);
}

void rgi_any_grid_need_insert(const rgi_any_grid *store, const rgi_bound *bound, rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(store)) rgi_grid_need_insert(&store->cells, bound->lo, bound->hi, need);
}

bool rgi_any_grid_need_move(const rgi_any_grid *store, const rgi_object *object, const rgi_bound *bound,
                            rgi_grid_need *need) {
    if (!rgi_any_grid_is_loose(store))
        return rgi_grid_need_move(&store->cells, object->place.block, bound->lo, bound->hi, need);
    need->members += !rgi_lattice_has_cell(&store->lattice, bound);
    return false;
}

rg_result rgi_any_grid_reserve(rgi_any_grid *store, const rgi_grid_need *need) {
    return rgi_any_grid_is_loose(store) ? rgi_lattice_reserve(&store->lattice, need->members)
                                        : rgi_grid_reserve(&store->cells, need);
}

/* ---------------------------------------------------------------------------------------------- rebuilding */

static void tell(const rgi_any_grid *store, const char *why) {
    char line[160];
    if (!store->log) return;
    snprintf(line, sizeof line, "grid rebuilt (%s): %" PRIu64 " objects, %" PRIu32 " nodes", why, store->count,
             rgi_lattice_nodes(&store->lattice));
    store->log(store->log_user, line);
}

/* Stores all objects of the grid `index` in `to`; their old places are overwritten. */
static rg_result fill(rgi_any_grid *to, rg_scene *scene, uint32_t index) {
    rg_result result = RG_OK;
    for (uint32_t slot = 0; slot < scene->objects.used && !result; slot++) {
        rgi_object *object = rgi_scene_object(scene, slot);
        rgi_placing p;
        if (!object->shape || object->grid != index) continue;
        result = rgi_place_at(scene, object, object->position, &p);
        if (!result) result = rgi_any_grid_insert(to, scene, slot, &p.bound);
    }
    return result;
}

/* Notes where objects are stored, or puts that back. */
static void keep_places(rg_scene *scene, uint32_t index, rgi_location *places, bool back) {
    for (uint32_t slot = 0; slot < scene->objects.used; slot++) {
        rgi_object *object = rgi_scene_object(scene, slot);
        if (!object->shape || object->grid != index) continue;
        if (back)
            object->place = places[slot];
        else
            places[slot] = object->place;
    }
}

rg_result rgi_any_grid_configure(rgi_any_grid *store, rg_scene *scene, uint32_t index, const rg_grid_config *config) {
    if (!rgi_any_grid_is_loose(store) && config->kind != RG_GRID_LOOSE) {
        rg_result result = rgi_grid_configure(&store->cells, config);
        if (!result) store->config = *config;
        return result;
    }
    rgi_any_grid new;
    rgi_location *places = NULL;
    rg_result result = rgi_any_grid_init(&new, scene, config);
    if (result) return result;
    uint32_t slots = scene->objects.used;
    if (slots) result = rgi_allocate(&scene->memory, slots, sizeof *places, "rebuilding a grid", &places);
    if (!result) {
        keep_places(scene, index, places, false);
        result = fill(&new, scene, index);
        if (result) keep_places(scene, index, places, true);
    }
    rgi_release(&scene->memory, places, slots, sizeof *places);
    if (result) {
        rgi_any_grid_free(&new);
        return result;
    }
    if (!rgi_any_grid_is_loose(&new)) {
        new.cells.rebuilds = (rgi_any_grid_is_loose(store) ? store->rebuilds : store->cells.rebuilds);
        result = rgi_grid_rebuild(&new.cells);
    }
    new.rebuilds = (rgi_any_grid_is_loose(store) ? store->rebuilds : store->cells.rebuilds) + 1;
    rgi_any_grid_free(store);
    *store = new;
    if (rgi_any_grid_is_loose(store)) tell(store, "asked for");
    return RG_OK;
}

rg_result rgi_any_grid_rebuild(rgi_any_grid *store, rg_scene *scene, uint32_t index) {
    if (!rgi_any_grid_is_loose(store)) return rgi_grid_rebuild(&store->cells);
    const rg_grid_config config = store->config;
    return rgi_any_grid_configure(store, scene, index, &config);
}

void rgi_any_grid_settle(rgi_any_grid *store, rg_scene *scene) {
    (void)scene;
    if (!rgi_any_grid_is_loose(store)) rgi_grid_settle(&store->cells);
}

void rgi_any_grid_report(const rgi_any_grid *store, rg_grid_report *report) {
    if (!rgi_any_grid_is_loose(store)) {
        rgi_grid_report(&store->cells, report);
        return;
    }
    memset(report, 0, sizeof *report);
    report->kind = RG_GRID_LOOSE;
    rgi_lattice_box(&store->lattice, report->logical_lo, report->logical_hi);
    report->objects = store->count;
    report->entries = store->lattice.count;
    report->unbounded = store->lattice.unbounded_count;
    report->levels = rgi_lattice_levels(&store->lattice);
    report->rebuilds = store->rebuilds;
}
