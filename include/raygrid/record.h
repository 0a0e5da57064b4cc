/* SPDX-License-Identifier: MIT */
/*
 * raygrid/record.h: scenes as bytes.
 *
 * A snapshot is a scene as it is: its shapes, grids and objects with their ids, and which slots are free, in which
 * order. A scene loaded from it answers every ray with the same bits as the one that was saved, and every later call
 * gives the same ids. What it does not have: counts of rays and rebuilds, and how grids have stored what they hold,
 * of which no answer depends.
 *
 * A recording is a snapshot followed by every call that changed the scene, in the order in which they took effect.
 * Played, it gives the same ids and, in the end, a scene of the same bits: a user's bug report is a file. It is as
 * good as its last whole call: a process that dies leaves a recording that can be played up to there.
 *
 * Both are of one format, which docs/recording.md describes: little-endian on every machine (on those that are
 * big-endian the calls here return RG_INVALID_ARGUMENT), with a version and checksums. Bytes are checked while they
 * are read, by the checks that other calls make of what they are given: damaged or hostile ones give RG_INVALID_DATA.
 * Memory taken is in proportion to their number, except for the cells of the paper's grids, of which 100 bytes can
 * ask for 2^28, as can rg_grid_create; a host that reads what strangers send sets rg_scene_config.memory_limit.
 *
 * Thread rule: as raygrid/scene.h. A replay is to be used by one thread at a time.
 */
#ifndef RAYGRID_RECORD_H
#define RAYGRID_RECORD_H

#include <raygrid/base.h>
#include <raygrid/scene.h>
#include <raygrid/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The version of the format that this library writes. It reads that and those before it, from 1 on. */
#define RG_FORMAT_VERSION 2

/* --------------------------------------------------------------------------------------------- out and in */

/**
 * Takes the next bytes, all of them. 0: done; any other number is a failure, and the callback is not called again.
 * Called with the scene held: from inside it the scene may be traced and read; calls that would change it return
 * RG_BUSY.
 */
typedef int32_t (*rg_write)(void *user, const void *bytes, size_t size);

/**
 * Gives a user-defined shape a number by which rg_find_shape will know it. `shape_user` is the `user` of its
 * rg_user_shape. 0: *number is set; any other number: there is none, and the shape can't be written.
 */
typedef int32_t (*rg_number_shape)(void *user, const rg_shape *shape, void *shape_user, uint64_t *number);

/** Where bytes go. Zero it, set the size, then what is given. */
typedef struct rg_sink {
    size_t size;
    /** Handed to the callbacks. */
    void *user;
    /** Required. */
    rg_write write;
    /** NULL: user-defined shapes can't be written. */
    rg_number_shape number_shape;
} rg_sink;

/**
 * Gives the user-defined shape of a number; `lo` and `hi` are the local box that it had when it was written, which it
 * must have again. The library takes over one reference: rg_shape_create_user into `shape` does, and a host that
 * keeps the shape calls rg_shape_retain. 0: *shape is set; any other number is a failure.
 */
typedef int32_t (*rg_find_shape)(void *user, uint64_t number, const double lo[3], const double hi[3],
                                 rg_shape **shape);

/** Where bytes come from. Zero it, set the size, then what is given. */
typedef struct rg_source {
    size_t size;
    /** Required. At any address. They stay the host's, and must live as long as what reads them; so must `shapes`. */
    const void *bytes;
    uint64_t byte_count;
    /** Handed to find_shape. */
    void *user;
    /** NULL: bytes with user-defined shapes are refused. */
    rg_find_shape find_shape;
    /** How all other shapes are made. NULL: defaults. */
    const rg_shape_config *shapes;
} rg_source;

/* ---------------------------------------------------------------------------------------------- snapshots */

/**
 * Writes a snapshot of the scene as it is. Traces go on meanwhile; changes wait. The same scene gives the same bytes.
 * Of a frame (rg_scene_create_frame) too, without its scene waiting: loaded, that is a scene of its own, with the
 * same ids and answers, which uses free slots again from the lowest up. Errors: RG_INVALID_ARGUMENT (also for a
 * user-defined shape without a number; the message names an object that has it), RG_CALLBACK_FAILED (write failed),
 * RG_OUT_OF_MEMORY. After an error some bytes may have been written; loading them will be refused. Cost: linear; some
 * 40 bytes an object are written, and memory is taken for each different shape.
 */
RG_API rg_result rg_scene_save(rg_scene *scene, const rg_sink *sink);

/**
 * Makes a scene from a snapshot. `config` is as for rg_scene_create, but for its `grid`, which is ignored. The scene
 * holds the only references to its shapes.
 * Errors: as rg_scene_create; RG_INVALID_DATA (the message names the byte where something was wrong, and what);
 * RG_CALLBACK_FAILED (find_shape failed, or gave another shape). Cost: as inserting all its objects at once.
 */
RG_API rg_result rg_scene_load(const rg_scene_config *config, const rg_source *source, rg_scene **scene);

/* --------------------------------------------------------------------------------------------- recordings */

/**
 * Begins a recording: writes a snapshot, then hands each call that changes the scene to `write` before it returns,
 * mostly in one piece. Calls that fail change nothing and are not recorded. `sink` NULL ends the recording, if there
 * is one; so does rg_scene_destroy.
 *
 * When the recording can't go on (write failed, no memory, a user-defined shape without a number), it ends; the call
 * that was to be recorded succeeds all the same, what has been written is good up to there, the scene's log is told,
 * and the call that ends the recording returns why. A recording holds a reference to each shape that it has written:
 * of a mesh that is given new vertices again and again, to all of them.
 * Errors when it begins: as rg_scene_save; RG_BUSY (there is one, the scene is a frame, or from inside a callback).
 * When it ends: RG_CALLBACK_FAILED, RG_OUT_OF_MEMORY, RG_INVALID_ARGUMENT, if it could not be written to its end; it
 * is over all the same. RG_BUSY: from inside a callback.
 */
RG_API rg_result rg_scene_record(rg_scene *scene, const rg_sink *sink);

/** A recording that is being played. Opaque. */
typedef struct rg_replay rg_replay;

/** The calls that change a scene. */
typedef int32_t rg_call;

enum {
    RG_CALL_NONE = 0,
    RG_CALL_INSERT = 1,
    RG_CALL_INSERT_MANY = 2,
    RG_CALL_MOVE = 3,
    RG_CALL_MOVE_TO = 4,
    RG_CALL_MOVE_MANY = 5,
    RG_CALL_SET_MASK = 6,
    RG_CALL_REMOVE = 7,
    RG_CALL_REMOVE_MANY = 8,
    RG_CALL_GRID_CREATE = 9,
    RG_CALL_GRID_DESTROY = 10,
    RG_CALL_GRID_CONFIGURE = 11,
    RG_CALL_GRID_REBUILD = 12,
    RG_CALL_REPLACE_SHAPE = 13
};

/** The name of the function that makes a call, such as "rg_scene_insert"; "unknown" for a number that is none. */
RG_API const char *rg_call_name(rg_call call);

/**
 * Makes the scene with which a recording begins, and a replay that plays it on that scene. Takes a snapshot, too:
 * then there is nothing to play. The scene is the caller's, to be traced, saved and destroyed; a change of it between
 * two steps is found when other ids come out. The bytes of `source` must live as long as the replay.
 * Errors: as rg_scene_load.
 */
RG_API rg_result rg_replay_create(const rg_scene_config *config, const rg_source *source, rg_replay **replay,
                                  rg_scene **scene);

/** What was played. Set `size` before the call; the library fills what both sides know. */
typedef struct rg_replay_report {
    size_t size;
    uint64_t calls;   /* played so far, this one among them */
    uint64_t offset;  /* bytes of the recording up to here */
    uint64_t objects; /* that the call was about; of RG_CALL_REPLACE_SHAPE those that had the shape */
    rg_object object; /* the first of them, or RG_NO_OBJECT */
    rg_call call;     /* RG_CALL_NONE: there was no more call */
    rg_grid grid;     /* that the call was about, or into which objects were inserted; else 0 */
} rg_replay_report;

/**
 * Plays the next call. Behind the last one it does nothing, and says so. `report` NULL: not wanted.
 * Errors: RG_INVALID_DATA (the bytes are damaged or cut off; the call fails on this scene, or gives another id than
 * it gave when it was recorded): the scene is as after the call before, unless an id was another. RG_OUT_OF_MEMORY,
 * RG_BUSY, RG_CALLBACK_FAILED (find_shape): the step may be tried again.
 */
RG_API rg_result rg_replay_step(rg_replay *replay, rg_replay_report *report);

/** Ends a replay, not its scene, which may have been destroyed before; sets the pointer to NULL. NULL, or a pointer
 * to NULL, is ignored. */
RG_API void rg_replay_destroy(rg_replay **replay);

#ifdef __cplusplus
}
#endif
#endif
