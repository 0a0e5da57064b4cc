/* SPDX-License-Identifier: MIT */
/*
 * The scene: who may read and change it when, and how its parts find one another. Entry points validate, take the
 * lock, and hand on.
 */
#ifndef RAYGRID_LIB_SCENE_H
#define RAYGRID_LIB_SCENE_H

#include "beam.h"
#include "grid.h"
#include "lock.h"
#include "memory.h"
#include "object.h"
#include "pool.h"

#include <raygrid/scene.h>

enum { RGI_GRIDS = 256 };

/** A place whose generations are used up is never used again. */
enum { RGI_GENERATIONS = 1 << 24 };

/** A place for a grid. Ids are generation * 256 + index; the scene's own grid is 0 of generation 0. */
typedef struct rgi_grid_place {
    struct rgi_any_grid *grid; /* NULL: free */
    uint32_t generation;
} rgi_grid_place;

struct rg_scene {
    rgi_memory memory;
    rgi_pool *pool;
    const rgi_kernels *kernels;
    rgi_lock lock;
    rg_log log;
    void *log_user;
    rgi_slots objects; /* rgi_object */
    rgi_slots linears; /* rgi_linear */
    uint64_t object_count;
    rgi_grid_place grids[RGI_GRIDS];
    uint32_t grid_places; /* all below were used */
    uint32_t grid_count;
    bool masked;                    /* there has been an object that some rays do not see */
    uint64_t invalid_rays;          /* atomic */
    uint32_t running;               /* atomic: traces under way that let changes in between their rays */
    struct rgi_follower *followers; /* frames of this scene */
    struct rgi_follower *follows;   /* this scene is a frame; or NULL */
    struct rgi_recorder *recorder;  /* NULL: nobody records */
};

/** Reads a configuration: NULL gives the defaults. RG_INVALID_ARGUMENT. */
rg_result rgi_scene_config_read(rg_scene_config *config, const rg_scene_config *given);

/* ------------------------------------------------------------------------------------------------ the lock */

/** That this thread is at work on a scene. Lies on the stack; frames of one thread are linked, so that calls from
 * inside a callback are known for what they are. */
typedef struct rgi_frame {
    const rg_scene *scene;
    struct rgi_frame *outer;
    bool locked;
} rgi_frame;

bool rgi_scene_inside(const rg_scene *scene);

/** Begins reading: waits for changes to end, unless this thread is inside a callback of the scene. */
void rgi_scene_begin_read(rg_scene *scene, rgi_frame *frame);
void rgi_scene_end_read(rg_scene *scene, rgi_frame *frame);

/** Begins a change: waits for all others. RG_INVALID_ARGUMENT: no scene. RG_BUSY: from inside a callback, or of a
 * frame.
 */
rg_result rgi_scene_begin_change(rg_scene *scene, rgi_frame *frame);

/** The same for the library's own changes, which nothing forbids. */
void rgi_scene_hold(rg_scene *scene, rgi_frame *frame);

/** Ends either; returns `result`. */
rg_result rgi_scene_end_change(rg_scene *scene, rgi_frame *frame, rg_result result);

/* ------------------------------------------------------------------------------------------------ its parts */

static inline rgi_object *rgi_scene_object(const rg_scene *scene, uint32_t slot) {
    return rgi_slots_at(&scene->objects, slot);
}

static inline rg_object rgi_object_id(const rgi_object *object, uint32_t slot) {
    return (rg_object)object->generation << 32 | slot;
}

static inline const rgi_linear *rgi_scene_linear(const rg_scene *scene, const rgi_object *object) {
    return object->linear == RGI_NONE ? NULL : rgi_slots_at(&scene->linears, object->linear);
}

/** RG_INVALID_ID if the id is not that of a grid; else *index is its place. */
rg_result rgi_scene_find_grid(const rg_scene *scene, rg_grid id, uint32_t *index);
rg_grid rgi_scene_grid_id(const rg_scene *scene, uint32_t index);

/** Puts a new grid at the first free place and returns its index. */
rg_result rgi_scene_add_grid(rg_scene *scene, const rg_grid_config *config, uint32_t *index);
void rgi_scene_drop_grid(rg_scene *scene, uint32_t index);

/** Puts a new grid at a free place. */
rg_result rgi_scene_put_grid(rg_scene *scene, const rg_grid_config *config, uint32_t index);

#endif
