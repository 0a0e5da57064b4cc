/* SPDX-License-Identifier: MIT */
/* A recording, written: its beginning, the calls, its end. The records are read by replay.c. */
#include "record.h"

#include "error.h"
#include "snapshot.h"
#include "views.h"

#include <inttypes.h>
#include <stdio.h>

/* Longest line about the end of a recording. */
enum { LINE = 160 };

typedef struct rgi_recorder {
    rgi_writer writer;
    rgi_shape_numbers shapes;
    uint64_t calls;
    rg_object object; /* the one at which it ended */
    rg_result ended;  /* why nothing more is recorded; RG_OK: it goes on */
} rgi_recorder;

const char *rg_call_name(rg_call call) {
    static const char *const names[] = {
        "none",
        "rg_scene_insert",
        "rg_scene_insert_many",
        "rg_scene_move",
        "rg_scene_move_to",
        "rg_scene_move_many",
        "rg_scene_set_mask",
        "rg_scene_remove",
        "rg_scene_remove_many",
        "rg_grid_create",
        "rg_grid_destroy",
        "rg_grid_configure",
        "rg_grid_rebuild",
        "rg_scene_replace_shape",
    };
    return call >= 0 && call < (rg_call)(sizeof names / sizeof *names) ? names[call] : "unknown";
}

/* ------------------------------------------------------------------------------------------ beginning and end */

static rg_result begin(rg_scene *scene, const rg_sink *sink) {
    rgi_recorder *recorder;
    if (scene->recorder) return rgi_fail(RG_BUSY, "the scene is being recorded already");
    rg_result result = rgi_allocate(&scene->memory, 1, sizeof *recorder, "a recording", &recorder);
    if (result) return result;
    memset(recorder, 0, sizeof *recorder);
    rgi_shape_numbers_init(&recorder->shapes, &scene->memory);
    result = rgi_writer_begin(&recorder->writer, sink, RGI_RECORDING);
    if (!result) result = rgi_snapshot_write(scene, &recorder->writer, &recorder->shapes);
    if (!result) {
        scene->recorder = recorder;
        return RG_OK;
    }
    rgi_shape_numbers_free(&recorder->shapes); /* the objects hold them all */
    rgi_release(&scene->memory, recorder, 1, sizeof *recorder);
    return result;
}

/* Why a recording has ended. Calls that were to be recorded have succeeded: so they leave rg_error_message alone. */
static void explain(const rgi_recorder *recorder, char *line, size_t size) {
    char object[32] = "";
    if (recorder->object) snprintf(object, sizeof object, " at object 0x%" PRIx64, recorder->object);
    snprintf(line, size, "the recording ended after %" PRIu64 " calls%s: %s", recorder->calls, object,
             recorder->ended == RG_CALLBACK_FAILED ? "write failed"
             : recorder->ended == RG_OUT_OF_MEMORY ? "there was no memory for one more shape"
                                                   : "its shape is user-defined and has no number");
}

static void write_end(rgi_recorder *recorder) {
    if (recorder->ended) return;
    rgi_put_head(&recorder->writer, RGI_RECORD_END, 1);
    rgi_put(&recorder->writer, recorder->calls);
    rgi_put_end(&recorder->writer);
    if (!rgi_writer_flush(&recorder->writer)) recorder->ended = RG_CALLBACK_FAILED;
}

rg_result rg_scene_record(rg_scene *scene, const rg_sink *sink) {
    char line[LINE];
    rgi_frame frame;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    if (sink) return rgi_scene_end_change(scene, &frame, begin(scene, sink));
    rgi_recorder *recorder = scene->recorder;
    if (recorder) write_end(recorder);
    scene->recorder = NULL;
    rgi_scene_end_change(scene, &frame, RG_OK);
    if (!recorder) return RG_OK;
    explain(recorder, line, sizeof line);
    result = recorder->ended ? rgi_fail(recorder->ended, "%s", line) : RG_OK;
    /* With the scene free again: what the last references destroy may call it. */
    rgi_shape_numbers_free(&recorder->shapes);
    rgi_release(&scene->memory, recorder, 1, sizeof *recorder);
    return result;
}

/* --------------------------------------------------------------------------------------------------- records */

/* Ends the recording, not the call: its caller has been served. */
static void give_up(rg_scene *scene, rg_result why, rg_object object) {
    rgi_recorder *recorder = scene->recorder;
    recorder->ended = why;
    recorder->object = object;
    if (!scene->log) return;
    char line[LINE];
    explain(recorder, line, sizeof line);
    scene->log(scene->log_user, line);
}

/* Each call's records are handed on before it returns. */
static void finish(rg_scene *scene) {
    rgi_recorder *recorder = scene->recorder;
    rgi_put_end(&recorder->writer);
    if (rgi_writer_flush(&recorder->writer))
        recorder->calls++;
    else
        give_up(scene, RG_CALLBACK_FAILED, RG_NO_OBJECT);
}

/* Where to write the record of a call; NULL: nowhere any more. */
static rgi_writer *record_of(rg_scene *scene, rg_call call, uint64_t words) {
    rgi_recorder *recorder = scene->recorder;
    if (recorder->ended) return NULL;
    rgi_put_head(&recorder->writer, (uint32_t)call, words);
    return &recorder->writer;
}

/* Writes the shape that an object has got, if it is a new one. */
static bool write_shape(rg_scene *scene, rg_object object, uint32_t *number) {
    rgi_recorder *recorder = scene->recorder;
    rg_shape *shape = rgi_scene_object(scene, RG_OBJECT_SLOT(object))->shape;
    if (recorder->ended) return false;
    rgi_fail_quietly(true);
    rg_result result = rgi_write_shape(&recorder->writer, &recorder->shapes, shape, number);
    rgi_fail_quietly(false);
    if (result) give_up(scene, result, object);
    return !result;
}

void rgi_record_insert(rg_scene *scene, rg_object object, const rg_pose *pose) {
    const rg_pose at = pose ? *pose : rg_pose_at(0, 0, 0);
    uint32_t number, flags = rgi_pose_flags(at.linear, at.scale);
    if (!write_shape(scene, object, &number)) return;
    rgi_writer *w = record_of(scene, RG_CALL_INSERT, 2 + rgi_pose_words(flags));
    rgi_put(w, object);
    rgi_put_pair(w, number, flags);
    rgi_put_pose(w, flags, at.position, at.linear, at.scale);
    finish(scene);
}

void rgi_record_move(rg_scene *scene, rg_object object, const rg_pose *pose) {
    uint32_t flags = rgi_pose_flags(pose->linear, pose->scale);
    rgi_writer *w = record_of(scene, RG_CALL_MOVE, 2 + rgi_pose_words(flags));
    if (!w) return;
    rgi_put(w, object);
    rgi_put(w, flags);
    rgi_put_pose(w, flags, pose->position, pose->linear, pose->scale);
    finish(scene);
}

void rgi_record_move_to(rg_scene *scene, rg_object object, const double position[3]) {
    rgi_writer *w = record_of(scene, RG_CALL_MOVE_TO, 1 + RGI_POSITION_WORDS);
    if (!w) return;
    rgi_put(w, object);
    rgi_put_doubles(w, position, 3);
    finish(scene);
}

void rgi_record_mask(rg_scene *scene, rg_object object, uint32_t mask) {
    rgi_writer *w = record_of(scene, RG_CALL_SET_MASK, 2);
    if (!w) return;
    rgi_put(w, object);
    rgi_put(w, mask);
    finish(scene);
}

void rgi_record_remove(rg_scene *scene, rg_object object) {
    rgi_writer *w = record_of(scene, RG_CALL_REMOVE, 1);
    if (!w) return;
    rgi_put(w, object);
    finish(scene);
}

void rgi_record_grid(rg_scene *scene, rg_call call, rg_grid grid, const rg_grid_config *config) {
    rgi_writer *w = record_of(scene, call, 1 + (config ? RGI_CONFIG_WORDS : 0));
    if (!w) return;
    rgi_put(w, grid);
    if (config) rgi_put_config(w, config);
    finish(scene);
}

/* ------------------------------------------------------------------------------------------------------ many */

static uint32_t flags_of_views(const rg_pose_views *views) {
    return (views->column[0].x ? RGI_HAS_LINEAR : 0) | (views->scale.data ? RGI_HAS_SCALE : 0);
}

static void put_nth_pose(rgi_writer *w, uint32_t flags, const rg_pose_views *views, uint64_t i) {
    double position[3];
    float linear[9] = {0};
    rgi_load3(&views->position, i, position);
    if (flags & RGI_HAS_LINEAR) rgi_load_columns(views->column, i, linear);
    rgi_put_pose(w, flags, position, linear, rgi_load(&views->scale, i, 1));
}

void rgi_record_insert_many(rg_scene *scene, const rg_insert_views *views, uint64_t count, const rg_object *objects) {
    uint32_t number, flags = flags_of_views(views->poses);
    for (uint64_t i = 0; i < count; i++) {
        if (!write_shape(scene, objects[i], &number)) return;
    }
    rgi_writer *w = record_of(scene, RG_CALL_INSERT_MANY, 2 + count * (2 + rgi_pose_words(flags)));
    if (!w) return;
    rgi_put(w, count);
    rgi_put_pair(w, views->grid, flags);
    for (uint64_t i = 0; i < count; i++) {
        (void)write_shape(scene, objects[i], &number); /* has its number */
        rgi_put(w, objects[i]);
        rgi_put_pair(w, number, (uint32_t)rgi_load_integer(&views->mask, i, UINT32_MAX));
        put_nth_pose(w, flags, views->poses, i);
    }
    finish(scene);
}

void rgi_record_move_many(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count) {
    uint32_t flags = count ? flags_of_views(poses) : 0;
    rgi_writer *w = record_of(scene, RG_CALL_MOVE_MANY, 2 + count * (1 + rgi_pose_words(flags)));
    if (!w) return;
    rgi_put(w, count);
    rgi_put(w, flags);
    for (uint64_t i = 0; i < count; i++) {
        rgi_put(w, rgi_load_integer(objects, i, 0));
        put_nth_pose(w, flags, poses, i);
    }
    finish(scene);
}

void rgi_record_remove_many(rg_scene *scene, const rg_input *objects, uint64_t count) {
    rgi_writer *w = record_of(scene, RG_CALL_REMOVE_MANY, count);
    if (!w) return;
    for (uint64_t i = 0; i < count; i++) rgi_put(w, rgi_load_integer(objects, i, 0));
    finish(scene);
}

void rgi_record_replace(rg_scene *scene, rg_shape *from, rg_object object, uint64_t count) {
    uint32_t old, new;
    /* An object has had it, so it was written, and has its number still. */
    if (!write_shape(scene, object, &new) || !rgi_shape_numbers_find(&scene->recorder->shapes, from, &old)) return;
    rgi_writer *w = record_of(scene, RG_CALL_REPLACE_SHAPE, 3);
    rgi_put(w, object);
    rgi_put(w, count);
    rgi_put_pair(w, old, new);
    finish(scene);
}
