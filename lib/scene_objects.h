/* SPDX-License-Identifier: MIT */
/* What calls on one object and calls on many share. All of it with the scene held for a change. */
#ifndef RAYGRID_LIB_SCENE_OBJECTS_H
#define RAYGRID_LIB_SCENE_OBJECTS_H

#include "lattice.h"
#include "scene.h"

/** Where an object is to be: checked, with all that is derived from it. */
typedef struct rgi_placing {
    rgi_bound bound; /* its centre is the position; a ball is a sphere that is not linear */
    bool is_linear;  /* has a record of its linear part and scale */
    rgi_linear linear;
    double reach;
} rgi_placing;

/** Checks a pose for a shape and derives the rest. RG_INVALID_VALUE. */
rg_result rgi_place(const rg_shape *shape, const double position[3], const float matrix[9], double scale,
                    rgi_placing *placing);

/** The same for a new position of an object that keeps its linear part and scale. */
rg_result rgi_place_at(const rg_scene *scene, const rgi_object *object, const double position[3],
                       rgi_placing *placing);

/** The same for an object whose linear part, or NULL, is not that of a scene. */
rg_result rgi_place_with(const rgi_object *object, const rgi_linear *linear, const double position[3],
                         rgi_placing *placing);

/** The scale of its pose. */
double rgi_object_scale(const rgi_object *object, const rgi_linear *linear);

/** RG_INVALID_ID if the id is stale or was never given out; else *slot is its slot. */
rg_result rgi_find_object(const rg_scene *scene, rg_object id, uint32_t *slot);

/** These change one object whole or not at all; the rules of its grid are to be applied afterwards (rgi_grid_settle).
 */
rg_result rgi_insert_one(rg_scene *scene, rg_shape *shape, const rgi_placing *placing, uint32_t mask, uint32_t grid,
                         rg_object *id);

/*
 * While a call on many checks its objects, a free bit of their grid's number marks those it has met: so an id given
 * twice is known without memory for it. The marks are taken off again whatever comes out.
 */
enum { RGI_MARK = RGI_GRIDS };

/** Bits of the grids that a call on many has touched: their rules are applied once, at its end. */
typedef struct rgi_touched {
    uint32_t bits[RGI_GRIDS / 32];
} rgi_touched;

static inline void rgi_touch(rgi_touched *t, uint32_t grid) {
    t->bits[grid / 32] |= 1u << grid % 32;
}

static inline bool rgi_is_touched(const rgi_touched *t, uint32_t grid) {
    return t->bits[grid / 32] >> grid % 32 & 1;
}

/** A call on many asks for what it will need of an object, so many objects before it comes to it: for the object's
 * record, and as many later, when that is there, for where it is stored. An id that names none is passed over. */
enum { RGI_AHEAD = 16 };
void rgi_fetch_object(const rg_scene *scene, rg_object id);
void rgi_fetch_place(const rg_scene *scene, rg_object id);

/** Takes the marks off all objects that ids name, some of which may name none. */
void rgi_unmark_all(const rg_scene *scene, const rg_input *objects, uint64_t count);

/** Calls on so many and more are shared out among the workers, in tiles: for fewer waking them costs more than they
 * save. */
enum { RGI_TILE = 1024, RGI_WORTH_SHARING = 4 * RGI_TILE };

void rgi_settle_touched(rg_scene *scene, const rgi_touched *t, uint64_t count);

/** Moves balls of lattices whose moves can't fail. False: not all are, and nothing has been done. */
bool rgi_move_balls(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count);

/** Whether an object is a ball in a lattice, and can be moved to a position without fail. */
bool rgi_is_quick(const rg_scene *scene, uint32_t slot, const double position[3]);

/** The quick way to move such a one: if it stays in its cell. False: nothing has been done. */
bool rgi_step(rg_scene *scene, uint32_t slot, const double position[3]);
rg_result rgi_move_one(rg_scene *scene, uint32_t slot, const rgi_placing *placing);

/** The part of an insert, and of a remove, that does not concern the grid. */
void rgi_fill_object(rg_scene *scene, uint32_t slot, rg_shape *shape, const rgi_placing *placing, uint32_t mask,
                     uint32_t grid);
rg_shape *rgi_empty_object(rg_scene *scene, uint32_t slot);

/** Empties a slot that is not to be taken again. */
rg_shape *rgi_clear_object(rg_scene *scene, uint32_t slot);

/** The part of a move that does not concern the grid. A record for a new linear part must have been reserved. */
void rgi_set_pose(rg_scene *scene, uint32_t slot, const rgi_placing *placing);

/** Returns the shape, for the caller to release last: its destroy callback must find a scene that is in order. */
rg_shape *rgi_remove_one(rg_scene *scene, uint32_t slot);

#endif
