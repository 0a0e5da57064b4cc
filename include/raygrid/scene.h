/* SPDX-License-Identifier: MIT */
/*
 * raygrid/scene.h: scenes, their objects and their grids.
 *
 * Thread rule: a scene may be used by any number of threads at once. Changes are seen whole or not at all; a trace
 * that starts after such a call returned sees its effect. There is no commit and no step. A change does not wait for
 * a trace to end, only for the rays under way on each thread, at most 64: so of a trace that overlaps with changes, rays
 * 16 * k to 16 * k + 15 see the scene at one instant, later ones maybe at a later one; a call of up to 16 rays sees
 * one. From inside a callback (user-defined shape or filter) the scene being traced may be traced and read; calls
 * that would change it return RG_BUSY. A callback may trace other scenes too, as long as no callback of those traces
 * this one: rays hold their scene against changes while they are under way.
 */
#ifndef RAYGRID_SCENE_H
#define RAYGRID_SCENE_H

#include <raygrid/base.h>
#include <raygrid/grid.h>
#include <raygrid/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A scene: owns its objects, its grids and its workers. Opaque. */
typedef struct rg_scene rg_scene;

/**
 * An object of a scene, by value. The low 32 bits are its slot, a small number that is used again after a remove and
 * so fits as index into arrays of the host; the high 32 bits count the uses of that slot from 1 up. A slot whose
 * count is used up is retired, so an id never comes back.
 */
typedef uint64_t rg_object;

/** No object. */
#define RG_NO_OBJECT ((rg_object)0)

/** The slot of an object: an index smaller than the largest number of objects that the scene ever held. */
#define RG_OBJECT_SLOT(object) ((uint32_t)(object))

/** How a scene is made. NULL in place of it means all defaults. */
typedef struct rg_scene_config {
    size_t size;
    /**
     * Threads that trace large calls together, the calling one among them: 0 for one a processor, 1 for the calling
     * thread alone (no thread is made), at most 1024. Ignored with parallel_for. A library that was built without
     * threads takes any as 1.
     */
    uint32_t workers;
    uint32_t reserved; /* 0 */
    /** Where the scene's memory comes from; both functions NULL: malloc. Copied. */
    rg_allocator allocator;
    /** The host's job system in place of workers; then no thread is made. NULL: workers. */
    rg_parallel_for parallel_for;
    void *parallel_for_user;
    /**
     * Told when a grid is rebuilt, or could not be for want of memory. NULL: nobody. Called by whichever thread does
     * it, also a worker, in the midst of it: it must not use the scene.
     */
    rg_log log;
    void *log_user;
    /** How RG_GRID_OF_SCENE is made. NULL: defaults. Read during the call only. */
    const rg_grid_config *grid;
    /** Bytes that the scene may hold from its allocator (rg_scene_report.bytes); 0: no limit. What would need more
     * gives RG_OUT_OF_MEMORY, as if the allocator had none. Shapes are not counted. */
    uint64_t memory_limit;
} rg_scene_config;

/**
 * Fills `config` with the defaults. `size` is sizeof(rg_scene_config) at the caller's.
 * RG_INVALID_ARGUMENT: config is NULL or the size unknown.
 */
RG_API rg_result rg_scene_config_default(rg_scene_config *config, size_t size);

/**
 * Makes an empty scene. The caller owns it and ends it with rg_scene_destroy.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_OUT_OF_MEMORY, RG_OUT_OF_THREADS.
 */
RG_API rg_result rg_scene_create(const rg_scene_config *config, rg_scene **scene);

/**
 * Ends the scene, its workers, and its objects' references to their shapes; sets the pointer to NULL. Waits for calls
 * that other threads have begun on it; none may follow. NULL, or a pointer to NULL, is ignored and RG_OK.
 * RG_BUSY: called from inside a callback of this scene, or it has frames; the scene lives on.
 */
RG_API rg_result rg_scene_destroy(rg_scene **scene);

/* ------------------------------------------------------------------------------------------------ objects */

/**
 * Where an object is: world = position + scale * linear * local. Any invertible linear part: rotation, scale, mirror,
 * shear. `linear` is stored by rows. The library computes with exactly the numbers given, the product of scale and
 * linear rounded to double. The posed shape must not reach beyond 4 * RG_COORDINATE_MAX, infinite boxes excepted.
 * Spheres of any radius need one shape only: a scale each. A sphere without a linear part of its own takes least
 * memory and time; its radius times the scale must be in [RG_RADIUS_MIN, RG_COORDINATE_MAX].
 */
typedef struct rg_pose {
    double position[3]; /* finite, at most RG_COORDINATE_MAX in magnitude */
    float linear[9];    /* finite; |determinant| > 2^-40 times the product of the lengths of the rows */
    double scale;       /* in [RG_RADIUS_MIN, RG_COORDINATE_MAX]; 0: 1 */
} rg_pose;

/** The pose that only moves: identity as linear part, scale 1. */
RG_API rg_pose rg_pose_at(double x, double y, double z);

/** Poses of many objects, for calls on many. Zero it, set the size, then what is given. */
typedef struct rg_pose_views {
    size_t size;
    rg_input3 position; /* RG_F64 or RG_F32. Required. */
    /**
     * The linear parts by columns: column[j] views the world image of the local unit vector j. RG_F64 (rounded to
     * float) or RG_F32. Give all three or none; none: insert takes the identity, move keeps what each object has.
     */
    rg_input3 column[3];
    /** RG_F64 or RG_F32. Not given: insert takes 1, move keeps what each object has. */
    rg_input scale;
} rg_pose_views;

/**
 * Fills `views`, of `size` bytes at the caller's, with the views of an array of rg_pose: the first at `poses`, each
 * `stride` bytes after the last; 0: all the same. RG_INVALID_ARGUMENT: a NULL pointer or an unknown size.
 */
RG_API rg_result rg_pose_views_of(rg_pose_views *views, size_t size, const rg_pose *poses, ptrdiff_t stride);

/** What rg_scene_insert_many inserts. Zero it, set the size, then what is given. */
typedef struct rg_insert_views {
    size_t size;
    const void *shapes;         /* the first of the rg_shape pointers. Required. */
    ptrdiff_t shapes_stride;    /* bytes from one rg_shape pointer to the next; 0: all objects have the same shape */
    const rg_pose_views *poses; /* Required. */
    rg_input mask;              /* RG_U32; not given: all bits set */
    rg_grid grid;               /* where they are stored; 0: the scene's own grid */
    uint32_t reserved;          /* 0 */
} rg_insert_views;

/**
 * Inserts an object into the scene's own grid; its mask has all bits set. The next trace sees it. The object holds a
 * reference to the shape. `pose` NULL: at the origin. `object` NULL: the id is not wanted.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE (pose), RG_LIMIT_EXCEEDED (2^32 - 1 slots used), RG_OUT_OF_MEMORY,
 * RG_BUSY. Cost: constant; rebuilds of the grid are spread over many calls on average, see raygrid/grid.h.
 */
RG_API rg_result rg_scene_insert(rg_scene *scene, rg_shape *shape, const rg_pose *pose, rg_object *object);

/**
 * Inserts `count` objects at once: all, or on any error none. `objects` receives their ids, RG_U64, or is not given.
 * Errors: as rg_scene_insert; RG_INVALID_ID (grid). The message names the index of the first bad one.
 */
RG_API rg_result rg_scene_insert_many(rg_scene *scene, const rg_insert_views *views, uint64_t count,
                                      const rg_output *objects);

/**
 * Gives an object a new pose. The next trace sees it. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID, RG_INVALID_VALUE,
 * RG_OUT_OF_MEMORY, RG_BUSY; the object then keeps its pose. Cost: constant; least while it stays in its cells.
 */
RG_API rg_result rg_scene_move(rg_scene *scene, rg_object object, const rg_pose *pose);

/** Gives an object a new position and keeps its linear part and scale. Otherwise as rg_scene_move. */
RG_API rg_result rg_scene_move_to(rg_scene *scene, rg_object object, const double position[3]);

/**
 * Moves `count` objects at once: all, or on any error none. `objects` views their ids, RG_U64. An object named twice
 * ends at its last pose. Errors: as rg_scene_move; the message names the index of the first bad one. Takes some 90
 * bytes an object from the scene's allocator while it runs.
 */
RG_API rg_result rg_scene_move_many(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses,
                                    uint64_t count);

/** Changes which rays see an object: those with (ray mask & mask) != 0. Errors: RG_INVALID_ID, RG_BUSY. */
RG_API rg_result rg_scene_set_mask(rg_scene *scene, rg_object object, uint32_t mask);

/** Removes an object; its id is stale from now on. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID, RG_BUSY. Cost:
 * constant. */
RG_API rg_result rg_scene_remove(rg_scene *scene, rg_object object);

/**
 * Removes `count` objects at once: all, or on any error (an id that is stale or given twice) none. `objects` views
 * their ids, RG_U64. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID (the message names the index), RG_BUSY.
 */
RG_API rg_result rg_scene_remove_many(rg_scene *scene, const rg_input *objects, uint64_t count);

/**
 * Gives every object of this scene that has the shape `from` the shape `to`: as for a mesh that has changed its form,
 * see rg_shape_create_deformed. Their ids, poses and masks stay. All at once, or on any error none: each ray sees all
 * with the one or all with the other. Objects of other scenes keep `from`.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE (an object with `to` would reach too far; the message names it),
 * RG_OUT_OF_MEMORY, RG_BUSY. Cost: looks at each object of the scene, some nanoseconds each; moves those concerned.
 */
RG_API rg_result rg_scene_replace_shape(rg_scene *scene, rg_shape *from, rg_shape *to);

/** What is known of an object. Set `size` before the call; the library fills what both sides know. */
typedef struct rg_object_report {
    size_t size;
    rg_pose pose;
    rg_shape *shape; /* not retained for the caller; valid as long as the object or another reference lives. Where
                        another thread may remove the object: rg_scene_shape_of. */
    uint32_t mask;
    rg_grid grid;
    double lo[3], hi[3]; /* the world box that holds it */
} rg_object_report;

/** Looks an object up. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID. Cost: constant. */
RG_API rg_result rg_scene_lookup(rg_scene *scene, rg_object object, rg_object_report *report);

/** The shape of an object, with a reference for the caller. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID. Cost:
 * constant.
 */
RG_API rg_result rg_scene_shape_of(rg_scene *scene, rg_object object, rg_shape **shape);

/** The instructions that the kernels of a scene use: the best that were built and that the processor has. */
typedef int32_t rg_isa;

enum { RG_ISA_PORTABLE = 0, RG_ISA_SSE2 = 1, RG_ISA_AVX2 = 2, RG_ISA_AVX512 = 3, RG_ISA_NEON = 4 };

/** What traces of a scene do without, because it holds nothing that needs it. Bits, as the scene is now. */
enum {
    RG_WITHOUT_BOXES = 1,     /* spheres only, in grids of the loose kind: no boxes are tested in leaves */
    RG_WITHOUT_MASKS = 2,     /* no object was ever given a mask that hides it from some rays */
    RG_WITHOUT_UNBOUNDED = 4, /* every object has cells: none is tested for every ray */
    RG_WITHOUT_TILES = 8,     /* nothing has left the physical boxes of grids of the paper's kinds */
    RG_WITHOUT_LEVELS = 16,   /* grids of the hierarchical kind: levels that hold nothing are passed over */
    RG_WITHOUT_GRIDS = 32,    /* at most one grid holds objects: rays do not go from grid to grid */
    RG_WITHOUT_THREADS = 64   /* the calling thread traces alone */
};

/** What is known of a scene. Set `size` before the call; the library fills what both sides know. */
typedef struct rg_scene_report {
    size_t size;
    uint64_t objects;
    uint64_t slots;        /* the largest number of objects it held at once */
    uint64_t bytes;        /* memory it holds from its allocator, shapes not counted */
    uint64_t invalid_rays; /* rays refused as invalid by all traces so far */
    uint32_t workers;      /* threads that trace together, the calling one among them; 0 with a host's parallel_for */
    uint32_t grids;
    rg_isa isa;
    uint32_t left_out; /* bits of RG_WITHOUT_* */
} rg_scene_report;

/** Fills `report`. Errors: RG_INVALID_ARGUMENT. */
RG_API rg_result rg_scene_stats(rg_scene *scene, rg_scene_report *report);

/* ------------------------------------------------------------------------------------------------- frames */

/**
 * Makes a frame of a scene: a scene that holds what `scene` held at one instant, under the same ids, and stays like
 * that while `scene` goes on to change; until rg_scene_update_frame. It is traced, read and destroyed like any scene.
 * All that would change it gives RG_BUSY. Its shapes are those of the scene; what the scene's grids are its grids
 * are, and `config->grid` is not used. `scene` can't be destroyed before its frames. Errors: as rg_scene_create;
 * RG_BUSY (from inside a callback of the scene). Cost: linear in the objects, and their memory once more; each change
 * of the scene takes a few ns more then.
 */
RG_API rg_result rg_scene_create_frame(rg_scene *scene, const rg_scene_config *config, rg_scene **frame);

/**
 * Takes over what has changed in the scene since the last update: all of one instant. Traces of the frame see it
 * whole or not at all, as a change; the scene is held only while its changes are copied, and as by a trace. Errors:
 * RG_INVALID_ARGUMENT (it is no frame), RG_BUSY (from inside a callback of the frame), RG_OUT_OF_MEMORY: then each
 * object is where it was at the last or at this update, and the next one makes up for it. Cost: that of moving what
 * has changed, each object once.
 */
RG_API rg_result rg_scene_update_frame(rg_scene *frame);

/* -------------------------------------------------------------------------------------------------- grids */

/**
 * Adds an empty grid. Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_LIMIT_EXCEEDED (more than 256 grids with the
 * scene's own, or more than 2^28 cells), RG_OUT_OF_MEMORY, RG_BUSY.
 */
RG_API rg_result rg_grid_create(rg_scene *scene, const rg_grid_config *config, rg_grid *grid);

/** Destroys an empty grid. Errors: RG_INVALID_ID, RG_BUSY (it holds objects, is the scene's own, or in a callback).
 */
RG_API rg_result rg_grid_destroy(rg_scene *scene, rg_grid grid);

/**
 * Changes kind, resolution, box or factor of a grid that may hold objects, and rebuilds it. Errors: as
 * rg_grid_create, RG_INVALID_ID; the grid is then as it was. Cost: linear in its objects.
 */
RG_API rg_result rg_grid_configure(rg_scene *scene, rg_grid grid, const rg_grid_config *config);

/**
 * Rebuilds a grid now, with a physical box and resolution that fit its objects, whatever its rebuild_factor.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID, RG_OUT_OF_MEMORY (the grid is then as it was), RG_BUSY.
 * Cost: linear in its objects.
 */
RG_API rg_result rg_grid_rebuild(rg_scene *scene, rg_grid grid);

/** Fills `report`. Errors: RG_INVALID_ARGUMENT, RG_INVALID_ID. */
RG_API rg_result rg_grid_stats(rg_scene *scene, rg_grid grid, rg_grid_report *report);

#ifdef __cplusplus
}
#endif
#endif
