/* SPDX-License-Identifier: MIT */
/*
 * A recording, played: each record of a call is made that call again, by the functions that hosts use, with views of
 * the record's own words. What was written in record.c is read here.
 */
#include "error.h"
#include "scene_shapes.h"
#include "snapshot.h"
#include "struct_size.h"

#include <inttypes.h>

/* Calls that version 1 of the format knows have lower numbers. */
enum { CALLS_OF_VERSION_1 = RG_CALL_REPLACE_SHAPE };

enum { REPORT_LEAST = sizeof(rg_replay_report) };

struct rg_replay {
    rgi_loader loader;
    uint64_t calls; /* played */
    bool done;
};

/* --------------------------------------------------------------------------------------------------- records */

static rg_result wrong(const rgi_stream_record *record, const char *what) {
    return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": %s", record->offset, what);
}

static rg_result other_id(const rgi_stream_record *record, const char *what, uint64_t got, uint64_t recorded) {
    return rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": %s 0x%" PRIx64 " came out, 0x%" PRIx64 " was recorded",
                    record->offset, what, got, recorded);
}

/* The flags of a pose in word i; RG_INVALID_DATA unless the record has `before` words and that pose. */
static rg_result pose_flags(const rgi_stream_record *record, uint64_t before, uint64_t i, uint32_t shift,
                            uint32_t *flags) {
    *flags = 0;
    if (record->count < before) return rgi_stream_demand(record, before);
    *flags = (uint32_t)(rgi_word(record, i) >> shift);
    if (*flags > (RGI_HAS_LINEAR | RGI_HAS_SCALE)) return wrong(record, "a pose with unknown parts");
    return rgi_stream_demand(record, before + rgi_pose_words(*flags));
}

/* Views of `poses` from word i on, `words` from each to the next. */
static rg_pose_views pose_views(const rgi_stream_record *record, uint64_t i, uint64_t words, uint32_t flags) {
    const unsigned char *at = record->words + i * RGI_WORD;
    const ptrdiff_t stride = (ptrdiff_t)words * RGI_WORD;
    rg_pose_views views;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.position = rg_input3_packed(at, stride, RG_F64);
    at += RGI_POSITION_WORDS * RGI_WORD;
    for (int j = 0; flags & RGI_HAS_LINEAR && j < 3; j++) {
        const unsigned char *top = at + (size_t)j * sizeof(float);
        views.column[j] = (rg_input3){top, top + 3 * sizeof(float), top + 6 * sizeof(float), stride, RG_F32};
    }
    if (flags & RGI_HAS_LINEAR) at += RGI_LINEAR_WORDS * RGI_WORD;
    if (flags & RGI_HAS_SCALE) views.scale = (rg_input){at, stride, RG_F64};
    return views;
}

/* ------------------------------------------------------------------------------------------------- one object */

static rg_result play_insert(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_shape *shape;
    rg_object object;
    rg_pose pose;
    uint32_t flags;
    rg_result result = pose_flags(record, 2, 1, 32, &flags);
    if (!result) result = rgi_find_shape(&replay->loader, record, (uint32_t)rgi_word(record, 1), &shape);
    if (result) return result;
    rgi_get_pose(record, 2, flags, &pose);
    r->object = rgi_word(record, 0);
    r->objects = 1;
    result = rg_scene_insert(replay->loader.scene, shape, &pose, &object);
    return result || object == r->object ? result : other_id(record, "object", object, r->object);
}

static rg_result play_move(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_pose pose;
    uint32_t flags;
    rg_result result = pose_flags(record, 2, 1, 0, &flags);
    if (result) return result;
    rgi_get_pose(record, 2, flags, &pose);
    r->object = rgi_word(record, 0);
    r->objects = 1;
    return rg_scene_move(replay->loader.scene, r->object, &pose);
}

static rg_result play_move_to(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    double position[3];
    rg_result result = rgi_stream_demand(record, 1 + RGI_POSITION_WORDS);
    if (result) return result;
    rgi_get_doubles(record, 1, position, 3);
    r->object = rgi_word(record, 0);
    r->objects = 1;
    return rg_scene_move_to(replay->loader.scene, r->object, position);
}

static rg_result play_set_mask(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_result result = rgi_stream_demand(record, 2);
    if (result) return result;
    r->object = rgi_word(record, 0);
    r->objects = 1;
    return rg_scene_set_mask(replay->loader.scene, r->object, (uint32_t)rgi_word(record, 1));
}

static rg_result play_remove(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_result result = rgi_stream_demand(record, 1);
    if (result) return result;
    r->object = rgi_word(record, 0);
    r->objects = 1;
    return rg_scene_remove(replay->loader.scene, r->object);
}

/* ----------------------------------------------------------------------------------------------- many objects */

/* The flags of many poses in word 1, and how many words from each to the next, `before` of them before the pose. */
static rg_result many_flags(const rgi_stream_record *record, uint64_t before, uint32_t shift, uint32_t *flags,
                            uint64_t *words) {
    *flags = 0;
    *words = 0;
    if (record->count < 2 || rgi_word(record, 0) > record->count) return wrong(record, "more objects than words");
    *flags = (uint32_t)(rgi_word(record, 1) >> shift);
    if (*flags > (RGI_HAS_LINEAR | RGI_HAS_SCALE)) return wrong(record, "poses with unknown parts");
    *words = before + rgi_pose_words(*flags);
    return rgi_stream_demand(record, 2 + rgi_word(record, 0) * *words);
}

/** An object to be inserted: its shape, then its id. */
typedef struct inserted {
    rg_shape *shape;
    rg_object object;
} inserted;

static rg_result insert_many(const rg_replay *replay, const rgi_stream_record *record, uint32_t flags, uint64_t words,
                             inserted *objects) {
    uint64_t count = rgi_word(record, 0);
    const ptrdiff_t stride = (ptrdiff_t)words * RGI_WORD;
    const rg_pose_views poses = pose_views(record, 4, words, flags);
    const rg_output out = {&objects->object, sizeof *objects, RG_U64};
    rg_insert_views views;
    rg_result result = RG_OK;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.shapes = &objects->shape;
    views.shapes_stride = sizeof *objects;
    views.poses = &poses;
    views.mask = (rg_input){record->words + 3 * RGI_WORD + sizeof(uint32_t), stride, RG_U32};
    views.grid = (rg_grid)(uint32_t)rgi_word(record, 1);
    for (uint64_t i = 0; i < count && !result; i++)
        result =
            rgi_find_shape(&replay->loader, record, (uint32_t)rgi_word(record, 3 + i * words), &objects[i].shape);
    if (!result) result = rg_scene_insert_many(replay->loader.scene, &views, count, &out);
    for (uint64_t i = 0; i < count && !result; i++) {
        uint64_t recorded = rgi_word(record, 2 + i * words);
        if (objects[i].object != recorded) result = other_id(record, "object", objects[i].object, recorded);
    }
    return result;
}

static rg_result play_insert_many(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rgi_memory *memory = &replay->loader.memory;
    inserted *objects;
    uint32_t flags;
    uint64_t words;
    rg_result result = many_flags(record, 2, 32, &flags, &words);
    if (result) return result;
    r->objects = rgi_word(record, 0);
    r->object = r->objects ? rgi_word(record, 2) : RG_NO_OBJECT;
    r->grid = (rg_grid)(uint32_t)rgi_word(record, 1);
    /* One more, so that there is always memory to view. */
    result = rgi_allocate(memory, r->objects + 1, sizeof *objects, "playing an insert of many", &objects);
    if (result) return result;
    result = insert_many(replay, record, flags, words, objects);
    rgi_release(memory, objects, r->objects + 1, sizeof *objects);
    return result;
}

static rg_result play_move_many(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    uint32_t flags;
    uint64_t words;
    rg_result result = many_flags(record, 1, 0, &flags, &words);
    if (result) return result;
    const rg_pose_views poses = pose_views(record, 3, words, flags);
    const rg_input objects = {record->words + 2 * RGI_WORD, (ptrdiff_t)words * RGI_WORD, RG_U64};
    r->objects = rgi_word(record, 0);
    r->object = r->objects ? rgi_word(record, 2) : RG_NO_OBJECT;
    return rg_scene_move_many(replay->loader.scene, &objects, &poses, r->objects);
}

static rg_result play_remove_many(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    const rg_input objects = {record->words, RGI_WORD, RG_U64};
    r->objects = record->count;
    r->object = r->objects ? rgi_word(record, 0) : RG_NO_OBJECT;
    return rg_scene_remove_many(replay->loader.scene, &objects, r->objects);
}

/* The public call would not tell whom it was about. */
static rg_result play_replace(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_shape *from, *to;
    rgi_replaced what;
    rg_result result = rgi_stream_demand(record, 3);
    if (result) return result;
    r->object = rgi_word(record, 0);
    r->objects = rgi_word(record, 1);
    result = rgi_find_shape(&replay->loader, record, (uint32_t)rgi_word(record, 2), &from);
    if (!result) result = rgi_find_shape(&replay->loader, record, (uint32_t)(rgi_word(record, 2) >> 32), &to);
    if (!result) result = rgi_replace_shape(replay->loader.scene, from, to, &what);
    if (result) return result;
    if (what.first != r->object) return other_id(record, "object", what.first, r->object);
    return what.count == r->objects ? RG_OK : wrong(record, "the number of objects that had the shape is another");
}

/* ------------------------------------------------------------------------------------------------------ grids */

static rg_result play_grid(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    rg_scene *scene = replay->loader.scene;
    bool configured = record->kind == RG_CALL_GRID_CREATE || record->kind == RG_CALL_GRID_CONFIGURE;
    rg_grid_config config;
    rg_grid made;
    rg_result result = rgi_stream_demand(record, 1 + (configured ? RGI_CONFIG_WORDS : 0));
    if (!result && configured) result = rgi_get_config(record, 1, &config);
    if (result) return result;
    r->grid = (rg_grid)(uint32_t)rgi_word(record, 0);
    switch (record->kind) {
    case RG_CALL_GRID_CREATE:
        result = rg_grid_create(scene, &config, &made);
        return result || made == r->grid ? result : other_id(record, "grid", made, r->grid);
    case RG_CALL_GRID_DESTROY:
        result = rg_grid_destroy(scene, r->grid);
        /* Of a record that is right it can't be in use. */
        return result == RG_BUSY ? wrong(record, "a grid is destroyed that is in use") : result;
    case RG_CALL_GRID_CONFIGURE:
        return rg_grid_configure(scene, r->grid, &config);
    default:
        return rg_grid_rebuild(scene, r->grid);
    }
}

/* ------------------------------------------------------------------------------------------------- the replay */

static rg_result play(rg_replay *replay, const rgi_stream_record *record, rg_replay_report *r) {
    typedef rg_result player(rg_replay * replay, const rgi_stream_record *record, rg_replay_report *r);
    static player *const players[] = {NULL,           play_insert,   play_insert_many, play_move,        play_move_to,
                                      play_move_many, play_set_mask, play_remove,      play_remove_many, play_grid,
                                      play_grid,      play_grid,     play_grid,        play_replace};
    const uint32_t calls =
        replay->loader.reader.version == 1 ? CALLS_OF_VERSION_1 : (uint32_t)(sizeof players / sizeof *players);
    if (record->kind == RG_CALL_NONE || record->kind >= calls) return wrong(record, "a record of no known kind");
    r->call = (rg_call)record->kind;
    rg_result result = players[record->kind](replay, record, r);
    if (!result) replay->calls++;
    return rgi_stream_blame(record, result);
}

static rg_result finish(rg_replay *replay, const rgi_stream_record *record) {
    rg_result result = rgi_stream_demand(record, 1);
    if (!result && rgi_word(record, 0) != replay->calls)
        result = rgi_fail(RG_INVALID_DATA, "byte %" PRIu64 ": the end of %" PRIu64 " calls, but there were %" PRIu64,
                          record->offset, rgi_word(record, 0), replay->calls);
    if (!result && !rgi_reader_done(&replay->loader.reader)) result = wrong(record, "bytes follow the end");
    replay->done = !result;
    return result;
}

/* Reads on to the next call and plays it, or to the end. On failure the reader stands before the record. */
static rg_result step(rg_replay *replay, rg_replay_report *r) {
    rgi_reader *reader = &replay->loader.reader, before;
    rgi_stream_record record;
    rg_result result;
    do {
        before = *reader;
        result = rgi_reader_next(reader, &record);
        if (!result && record.kind == RGI_RECORD_SHAPE) result = rgi_read_shape(&replay->loader, &record);
    } while (!result && record.kind == RGI_RECORD_SHAPE);
    if (!result) result = record.kind == RGI_RECORD_END ? finish(replay, &record) : play(replay, &record, r);
    if (result) *reader = before;
    return result;
}

static void fill_report(const rg_replay *replay, rg_replay_report *r) {
    r->calls = replay->calls;
    r->offset = replay->loader.reader.at;
}

rg_result rg_replay_step(rg_replay *replay, rg_replay_report *report) {
    rg_replay_report r;
    if (!replay) return rgi_fail(RG_INVALID_ARGUMENT, "replay is NULL");
    memset(&r, 0, sizeof r);
    fill_report(replay, &r);
    rg_result result = report ? rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_replay_report") : RG_OK;
    if (result || replay->done) return result;
    result = step(replay, &r);
    fill_report(replay, &r);
    if (report) (void)rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_replay_report");
    return result;
}

static rg_result make_replay(rgi_loader *loader, rg_replay **out) {
    rg_replay *replay;
    bool done = loader->reader.what == RGI_SNAPSHOT;
    rg_result result = done ? rgi_snapshot_end(loader) : RG_OK;
    if (!result) result = rgi_allocate(&loader->memory, 1, sizeof *replay, "a replay", &replay);
    if (result) return result;
    replay->loader = *loader;
    replay->calls = 0;
    replay->done = done;
    *out = replay;
    return RG_OK;
}

rg_result rg_replay_create(const rg_scene_config *config, const rg_source *source, rg_replay **replay,
                           rg_scene **scene) {
    rgi_loader loader;
    if (!replay || !scene)
        return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL: nowhere to return it", replay ? "scene" : "replay");
    rg_result result = rgi_snapshot_read(&loader, config, source);
    if (!result) result = make_replay(&loader, replay);
    if (!result) {
        *scene = loader.scene;
        return RG_OK;
    }
    (void)rg_scene_destroy(&loader.scene);
    rgi_loader_free(&loader);
    return result;
}

void rg_replay_destroy(rg_replay **pointer) {
    if (!pointer || !*pointer) return;
    rg_replay *replay = *pointer;
    *pointer = NULL;
    rgi_loader_free(&replay->loader);
    rgi_memory memory = replay->loader.memory;
    rgi_release(&memory, replay, 1, sizeof *replay);
}
