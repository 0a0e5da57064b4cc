/* SPDX-License-Identifier: MIT */
/*
 * The state of a scene, read. The bytes may say anything: each number is checked, by the checks that the public calls
 * make or by ones here, before anything relies on it, and memory is taken only for what the bytes that are there can
 * fill.
 */
#include "any_grid.h"
#include "error.h"
#include "snapshot.h"
#include "struct_size.h"

#include <inttypes.h>

enum { SOURCE_LEAST = sizeof(rg_source) };

/* ---------------------------------------------------------------------------------------------------- grids */

/* The first place is that of the scene's own grid: with it the scene is made. */
static rg_result make_scene(rgi_loader *loader, const rg_scene_config *given, const rg_grid_config *grid) {
    rg_scene_config config = *given;
    config.size = sizeof config;
    config.grid = grid;
    return rg_scene_create(&config, &loader->scene);
}

/* A place's generation, and whether a grid is there. */
static rg_result check_place(const rgi_loader *loader, const rgi_stream_record *record, uint64_t word) {
    uint32_t generation = (uint32_t)word;
    bool present = word >> 32 & 1, own = !loader->scene;
    uint32_t last = RGI_GENERATIONS - (present ? 1 : 0);
    bool right = own ? present && generation == 0 : generation > 0 && generation <= last;
    if (right && word >> 33 == 0 && (own || loader->scene->grid_places < RGI_GRIDS)) return RG_OK;
    return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": 0x%" PRIx64 " is no place for a grid", record->offset, word);
}

/* Places come in their order; in some there is no grid now. */
static rg_result read_grid(rgi_loader *loader, const rg_scene_config *config, const rgi_stream_record *record) {
    rg_grid_config grid;
    uint64_t word = record->count ? rgi_word(record, 0) : 0;
    bool present = word >> 32 & 1;
    rg_result result = rgi_stream_demand(record, 1 + (present ? RGI_CONFIG_WORDS : 0));
    if (!result) result = check_place(loader, record, word);
    if (!result && present) result = rgi_get_config(record, 1, &grid);
    if (result) return result;
    if (!loader->scene) return make_scene(loader, config, &grid);
    uint32_t index = loader->scene->grid_places;
    if (present) result = rgi_stream_blame(record, rgi_scene_put_grid(loader->scene, &grid, index));
    if (result) return result;
    loader->scene->grid_places = index + 1;
    loader->scene->grids[index].generation = (uint32_t)word;
    return RG_OK;
}

/* -------------------------------------------------------------------------------------------------- objects */

/* The slot that begins at word i of a record; `here` is that place, for messages. */
static rg_result read_live(const rgi_loader *loader, const rgi_stream_record *here, uint64_t i) {
    rg_scene *scene = loader->scene;
    uint64_t word = rgi_word(here, i), more = rgi_word(here, i + 1);
    uint32_t flags = word >> 32 & 0xFF, grid = (uint32_t)(word >> 40);
    rg_shape *shape;
    rgi_placing placing;
    rg_pose pose;
    if (grid >= scene->grid_places || !scene->grids[grid].grid)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": an object in place %" PRIu32 ", where there is no grid",
                        here->offset, grid);
    rgi_get_pose(here, i + 2, flags, &pose);
    rg_result result = rgi_find_shape(loader, here, (uint32_t)more, &shape);
    if (!result) result = rgi_place(shape, pose.position, pose.linear, pose.scale, &placing);
    if (!result) result = rgi_slots_reserve(&scene->objects, 1);
    if (!result && placing.is_linear) result = rgi_slots_reserve(&scene->linears, 1);
    if (result) return rgi_stream_blame(here, result);
    uint32_t slot = rgi_slots_take(&scene->objects);
    rgi_scene_object(scene, slot)->generation = (uint32_t)word;
    rgi_fill_object(scene, slot, shape, &placing, (uint32_t)(more >> 32), grid);
    return RG_OK;
}

static rg_result read_dead(const rgi_loader *loader, const rgi_stream_record *here, uint32_t generation) {
    rgi_slots *slots = &loader->scene->objects;
    rg_result result = rgi_slots_reserve(slots, 1);
    if (result) return rgi_stream_blame(here, result);
    rgi_scene_object(loader->scene, rgi_slots_take(slots))->generation = generation;
    return RG_OK;
}

static rg_result read_slots(const rgi_loader *loader, const rgi_stream_record *record) {
    rgi_stream_record here = *record;
    rg_result result = RG_OK;
    for (uint64_t i = 0, words; i < record->count && !result; i += words) {
        uint64_t word = rgi_word(record, i);
        uint32_t flags = word >> 32 & 0xFF;
        bool live = flags & RGI_IS_LIVE, right = live ? flags <= RGI_SLOT_FLAGS : word >> 32 == 0;
        here.offset = record->offset + (1 + i) * RGI_WORD;
        words = live ? 2 + rgi_pose_words(flags) : 1;
        if (!right || (uint32_t)word == 0 || words > record->count - i)
            return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": no slot begins with 0x%" PRIx64, here.offset, word);
        result = live ? read_live(loader, &here, i) : read_dead(loader, &here, (uint32_t)word);
    }
    return result;
}

/*
 * The list is made by giving the slots back, the last one first. Which are in it is noted in their masks, which mean
 * nothing while they are free.
 */
static rg_result read_free(const rgi_loader *loader, const rgi_stream_record *record) {
    rgi_slots *slots = &loader->scene->objects;
    for (uint64_t i = record->count; i > 0; i--) {
        uint64_t slot = rgi_word(record, i - 1);
        rgi_object *object = slot < slots->used ? rgi_scene_object(loader->scene, (uint32_t)slot) : NULL;
        if (!object || object->shape || object->mask)
            return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": slot %" PRIu64 " is not free, or free twice",
                            record->offset + i * RGI_WORD, slot);
        object->mask = 1;
        rgi_slots_give(slots, (uint32_t)slot);
    }
    return RG_OK;
}

/* ------------------------------------------------------------------------------------------------- the whole */

static rg_result check_counts(const rgi_loader *loader, const rgi_stream_record *record) {
    const rg_scene *scene = loader->scene;
    const uint64_t counts[4] = {scene->grid_places, loader->shape_count, scene->objects.used, scene->object_count};
    static const char *const names[4] = {"places for grids", "shapes", "slots", "objects"};
    rg_result result = rgi_stream_demand(record, 4);
    for (int i = 0; i < 4 && !result; i++) {
        if (rgi_word(record, (uint64_t)i) != counts[i])
            result = rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": %" PRIu64 " %s, but there were %" PRIu64,
                              record->offset, rgi_word(record, (uint64_t)i), names[i], counts[i]);
    }
    for (uint32_t slot = 0; slot < scene->objects.used && !result; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        /* What is neither live nor free has been retired, with its last generation. */
        if (!object->shape && !object->mask && object->generation != UINT32_MAX)
            result = rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": slot %" PRIu32 " is neither live, free nor retired",
                              record->offset, slot);
    }
    return result;
}

/* Stores the objects of a grid, as if all had come at once. `slots` has room for all. */
static rg_result fill_grid(rg_scene *scene, uint32_t index, uint32_t *slots) {
    rgi_any_grid *grid = scene->grids[index].grid;
    uint64_t count = 0;
    for (uint32_t slot = 0; grid && slot < scene->objects.used; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        if (object->shape && object->grid == index) slots[count++] = slot;
    }
    if (!count) return RG_OK;
    rg_result result = rgi_any_grid_fill(grid, scene, slots, count);
    if (!result) rgi_any_grid_settle(grid, scene, count);
    return result;
}

static rg_result fill_grids(rgi_loader *loader) {
    rg_scene *scene = loader->scene;
    uint64_t count = scene->object_count;
    uint32_t *slots;
    rgi_frame frame;
    if (!count) return RG_OK;
    rg_result result = rgi_allocate(&loader->memory, count, sizeof *slots, "the objects of a file", &slots);
    if (result) return result;
    (void)rgi_scene_begin_change(scene, &frame); /* once there are objects, a worker may rebuild their grids */
    for (uint32_t i = 0; i < scene->grid_places && !result; i++) result = fill_grid(scene, i, slots);
    (void)rgi_scene_end_change(scene, &frame, result);
    rgi_release(&loader->memory, slots, count, sizeof *slots);
    return result;
}

static rg_result read_part(rgi_loader *loader, const rg_scene_config *config, const rgi_stream_record *record) {
    if (!loader->scene && record->kind != RGI_RECORD_GRID)
        return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": the first record is not that of a grid", record->offset);
    switch (record->kind) {
    case RGI_RECORD_GRID:
        return read_grid(loader, config, record);
    case RGI_RECORD_SHAPE:
        return rgi_read_shape(loader, record);
    case RGI_RECORD_SLOTS:
        return read_slots(loader, record);
    case RGI_RECORD_FREE:
        return read_free(loader, record);
    default:
        return check_counts(loader, record);
    }
}

static rg_result read_state(rgi_loader *loader, const rg_scene_config *config) {
    rgi_stream_record record = {NULL, 0, 0, RGI_RECORD_GRID};
    rg_result result = RG_OK;
    while (!result && record.kind != RGI_RECORD_STATE) {
        uint32_t before = record.kind;
        result = rgi_reader_next(&loader->reader, &record);
        /* Parts come in the order of their kinds; of the free there is one. */
        if (!result && (record.kind < before || record.kind > RGI_RECORD_STATE ||
                        (record.kind == before && before == RGI_RECORD_FREE)))
            result = rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": a record of kind %" PRIu32 " is out of place",
                              record.offset, record.kind);
        if (!result) result = read_part(loader, config, &record);
    }
    return result;
}

static rg_result read_source(rgi_loader *loader, const rg_source *given) {
    if (!given) return rgi_fail(RG_INVALID_ARGUMENT, "source is NULL");
    rg_result result = rgi_struct_read(&loader->source, sizeof loader->source, SOURCE_LEAST, given, "rg_source");
    if (!result && !loader->source.bytes) result = rgi_fail(RG_INVALID_ARGUMENT, "rg_source.bytes is NULL");
    if (!result) result = rgi_stream_check_machine();
    return result;
}

rg_result rgi_snapshot_read(rgi_loader *loader, const rg_scene_config *given, const rg_source *source) {
    rg_scene_config config;
    memset(loader, 0, sizeof *loader);
    rg_result result = rgi_scene_config_read(&config, given);
    if (!result) result = rgi_memory_init(&loader->memory, &config.allocator);
    if (!result) result = read_source(loader, source);
    if (!result) result = rgi_reader_begin(&loader->reader, loader->source.bytes, loader->source.byte_count);
    if (!result) result = read_state(loader, &config);
    if (!result) result = fill_grids(loader);
    if (result) (void)rg_scene_destroy(&loader->scene);
    return result;
}

void rgi_loader_free(rgi_loader *loader) {
    for (uint64_t i = 0; i < loader->shape_count; i++) rg_shape_release(&loader->shapes[i]);
    rgi_release(&loader->memory, loader->shapes, loader->shape_room, sizeof(rg_shape *));
    loader->shapes = NULL;
    loader->shape_count = loader->shape_room = 0;
}

rg_result rgi_snapshot_end(const rgi_loader *loader) {
    if (loader->reader.what != RGI_SNAPSHOT)
        return rgi_fail(RG_INVALID_DATA, "byte 12: this is a recording, to be played, not a snapshot");
    if (rgi_reader_done(&loader->reader)) return RG_OK;
    return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": %" PRIu64 " bytes follow the snapshot", loader->reader.at,
                    loader->reader.size - loader->reader.at);
}

rg_result rg_scene_load(const rg_scene_config *config, const rg_source *source, rg_scene **scene) {
    rgi_loader loader;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL: nowhere to return it");
    rg_result result = rgi_snapshot_read(&loader, config, source);
    if (!result) result = rgi_snapshot_end(&loader);
    if (result)
        (void)rg_scene_destroy(&loader.scene);
    else
        *scene = loader.scene;
    rgi_loader_free(&loader);
    return result;
}
