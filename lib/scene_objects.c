/* SPDX-License-Identifier: MIT */
/* Insert, move, remove and look up one object. */
#include "scene_objects.h"

#include "any_grid.h"
#include "error.h"
#include "frame.h"
#include "record.h"
#include "struct_size.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

enum { REPORT_LEAST = sizeof(rg_object_report) };

/* The distance from the position to the farthest corner of the world box. */
static double reach_of(const rgi_placing *p) {
    double far[3];
    for (int a = 0; a < 3; a++)
        far[a] = rgi_max(fabs(p->bound.lo[a] - p->bound.centre[a]), fabs(p->bound.hi[a] - p->bound.centre[a]));
    double largest = rgi_max_magnitude(far);
    return largest < INFINITY ? sqrt(rgi_dot(far, far)) : INFINITY;
}

static rg_result derive(const rg_shape *shape, rgi_placing *p) {
    rg_result result = rgi_check_position(p->bound.centre);
    if (result) return result;
    p->bound.ball = shape->kind == RG_SHAPE_SPHERE && !p->is_linear;
    if (p->bound.ball) {
        p->reach = p->bound.radius;
        return rgi_ball_bounds(p->bound.radius, p->bound.centre, p->bound.lo, p->bound.hi);
    }
    result = rgi_shape_bounds(shape, p->bound.centre, p->is_linear ? p->linear.product : NULL, p->bound.lo,
                              p->bound.hi, &p->reach);
    if (!result) p->reach = rgi_min(p->reach, reach_of(p));
    return result;
}

/*
 * Whether the object needs no record of its linear part: a shape that is only moved, or a sphere that has also been
 * given a size, from which the scale can be told again to the last bit.
 */
static bool is_plain(const rg_shape *shape, const float matrix[9], double scale, double radius) {
    if (!rgi_is_identity(matrix)) return false;
    return scale == 1 || (shape->kind == RG_SHAPE_SPHERE && radius / shape->of.radius == scale);
}

rg_result rgi_place(const rg_shape *shape, const double position[3], const float matrix[9], double scale,
                    rgi_placing *p) {
    rg_result result = scale == 0 ? RG_OK : rgi_check_scale(scale);
    if (result) return result;
    if (scale == 0) scale = 1;
    rgi_copy(position, p->bound.centre);
    p->bound.radius = shape->kind == RG_SHAPE_SPHERE ? shape->of.radius * scale : 0;
    p->is_linear = !is_plain(shape, matrix, scale, p->bound.radius);
    if (p->is_linear) result = rgi_linear_init(&p->linear, matrix, scale);
    return result ? result : derive(shape, p);
}

rg_result rgi_place_with(const rgi_object *object, const rgi_linear *linear, const double position[3],
                         rgi_placing *p) {
    rgi_copy(position, p->bound.centre);
    p->bound.radius = object->reach;
    p->is_linear = linear != NULL;
    if (linear) p->linear = *linear;
    return derive(object->shape, p);
}

rg_result rgi_place_at(const rg_scene *scene, const rgi_object *object, const double position[3], rgi_placing *p) {
    return rgi_place_with(object, rgi_scene_linear(scene, object), position, p);
}

double rgi_object_scale(const rgi_object *object, const rgi_linear *linear) {
    if (linear) return linear->scale;
    return object->shape->kind == RG_SHAPE_SPHERE ? object->reach / object->shape->of.radius : 1;
}

/* ----------------------------------------------------------------------------------------- one object */

void rgi_unmark_all(const rg_scene *scene, const rg_input *objects, uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        uint32_t slot = RG_OBJECT_SLOT(rgi_load_integer(objects, i, 0));
        if (slot < scene->objects.used) rgi_scene_object(scene, slot)->grid &= RGI_MARK - 1;
    }
}

void rgi_fetch_object(const rg_scene *scene, rg_object id) {
    uint32_t slot = RG_OBJECT_SLOT(id);
    if (slot < scene->objects.used) __builtin_prefetch(rgi_scene_object(scene, slot), 1);
}

void rgi_fetch_place(const rg_scene *scene, rg_object id) {
    uint32_t slot = RG_OBJECT_SLOT(id);
    if (slot >= scene->objects.used || !rgi_scene_object(scene, slot)->shape) return;
    uint32_t number = __atomic_load_n(&rgi_scene_object(scene, slot)->grid, __ATOMIC_RELAXED) & (RGI_MARK - 1);
    const rgi_any_grid *grid = scene->grids[number].grid;
    if (!rgi_any_grid_is_loose(grid)) return;
    const rgi_location *place = rgi_any_grid_place(grid, scene, slot);
    if (place->block != RGI_NONE) rgi_lattice_fetch(&grid->lattice, place);
}

rg_result rgi_find_object(const rg_scene *scene, rg_object id, uint32_t *slot) {
    *slot = RG_OBJECT_SLOT(id);
    if (*slot < scene->objects.used) {
        const rgi_object *object = rgi_scene_object(scene, *slot);
        if (object->shape && object->generation == id >> 32) return RG_OK;
    }
    return rgi_fail(RG_INVALID_ID, "object 0x%" PRIx64 " is %s", id,
                    id ? "stale or none of this scene's" : "no object");
}

/* Stores the linear part: takes a record when there is one for the first time, gives it back when it is the identity
 * again. A record must have been reserved. */
static void set_linear(rg_scene *scene, rgi_object *object, const rgi_placing *p) {
    if (p->is_linear) {
        if (object->linear == RGI_NONE) object->linear = rgi_slots_take(&scene->linears);
        *(rgi_linear *)rgi_slots_at(&scene->linears, object->linear) = p->linear;
    } else if (object->linear != RGI_NONE) {
        rgi_slots_give(&scene->linears, object->linear);
        object->linear = RGI_NONE;
    }
}

void rgi_set_pose(rg_scene *scene, uint32_t slot, const rgi_placing *p) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rgi_scene_changed(scene, slot);
    object->reach = p->reach;
    rgi_copy(p->bound.centre, object->position);
    set_linear(scene, object, p);
}

void rgi_fill_object(rg_scene *scene, uint32_t slot, rg_shape *shape, const rgi_placing *p, uint32_t mask,
                     uint32_t grid) {
    rgi_object *object = rgi_scene_object(scene, slot);
    if (object->generation == 0) object->generation = 1;
    rg_shape_retain(shape);
    object->shape = shape;
    object->linear = RGI_NONE;
    object->mask = mask;
    scene->masked |= mask != UINT32_MAX;
    object->grid = grid;
    rgi_set_pose(scene, slot, p);
    scene->object_count++;
}

rg_shape *rgi_clear_object(rg_scene *scene, uint32_t slot) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rg_shape *shape = object->shape;
    rgi_scene_changed(scene, slot);
    if (object->linear != RGI_NONE) rgi_slots_give(&scene->linears, object->linear);
    object->shape = NULL;
    scene->object_count--;
    return shape;
}

rg_shape *rgi_empty_object(rg_scene *scene, uint32_t slot) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rg_shape *shape = rgi_clear_object(scene, slot);
    if (object->generation < UINT32_MAX) {
        object->generation++;
        rgi_slots_give(&scene->objects, slot);
    }
    return shape;
}

rg_result rgi_insert_one(rg_scene *scene, rg_shape *shape, const rgi_placing *p, uint32_t mask, uint32_t grid,
                         rg_object *id) {
    rg_result result = rgi_slots_reserve(&scene->objects, 1);
    if (!result && p->is_linear) result = rgi_slots_reserve(&scene->linears, 1);
    if (result) return result;
    /* The record is taken last, when nothing can fail any more; taking it clears what the grid noted there. */
    uint32_t slot = rgi_slots_next(&scene->objects);
    rgi_object *object = rgi_scene_object(scene, slot);
    result = rgi_any_grid_insert(scene->grids[grid].grid, scene, slot, &p->bound);
    if (result) return result;
    const rgi_location place = object->place;
    (void)rgi_slots_take(&scene->objects);
    object->place = place;
    rgi_fill_object(scene, slot, shape, p, mask, grid);
    *id = rgi_object_id(object, slot);
    return RG_OK;
}

rg_result rgi_move_one(rg_scene *scene, uint32_t slot, const rgi_placing *p) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rg_result result = RG_OK;
    if (p->is_linear && object->linear == RGI_NONE) result = rgi_slots_reserve(&scene->linears, 1);
    if (!result) result = rgi_any_grid_move(scene->grids[object->grid].grid, scene, slot, &p->bound);
    if (!result) rgi_set_pose(scene, slot, p);
    return result;
}

rg_shape *rgi_remove_one(rg_scene *scene, uint32_t slot) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rgi_any_grid_remove(scene->grids[object->grid].grid, scene, slot);
    return rgi_empty_object(scene, slot);
}

rg_result rg_scene_insert(rg_scene *scene, rg_shape *shape, const rg_pose *pose, rg_object *out) {
    const rg_pose at = pose ? *pose : rg_pose_at(0, 0, 0);
    rgi_placing p;
    rgi_frame frame;
    rg_object id;
    if (!shape) return rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL");
    rg_result result = rgi_place(shape, at.position, at.linear, at.scale, &p);
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_insert_one(scene, shape, &p, UINT32_MAX, 0, &id);
    if (!result) rgi_any_grid_settle(scene->grids[0].grid, scene, 1);
    if (!result) RGI_RECORD(insert, scene, id, pose);
    if (!result && out) *out = id;
    return rgi_scene_end_change(scene, &frame, result);
}

static rg_result move_by_id(rg_scene *scene, rg_object id, const double position[3], const rg_pose *pose) {
    rgi_placing p;
    uint32_t slot;
    rg_result result = rgi_find_object(scene, id, &slot);
    if (result) return result;
    rgi_object *object = rgi_scene_object(scene, slot);
    if (!pose && rgi_is_quick(scene, slot, position) && rgi_step(scene, slot, position)) {
        if (scene->grids[object->grid].grid->rebuild) rgi_any_grid_settle(scene->grids[object->grid].grid, scene, 1);
        return RG_OK;
    }
    result = pose ? rgi_place(object->shape, position, pose->linear, pose->scale, &p)
                  : rgi_place_at(scene, object, position, &p);
    if (!result) result = rgi_move_one(scene, slot, &p);
    if (!result) rgi_any_grid_settle(scene->grids[object->grid].grid, scene, 1);
    return result;
}

rg_result rg_scene_move(rg_scene *scene, rg_object id, const rg_pose *pose) {
    rgi_frame frame;
    if (!pose) return rgi_fail(RG_INVALID_ARGUMENT, "pose is NULL");
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = move_by_id(scene, id, pose->position, pose);
    if (!result) RGI_RECORD(move, scene, id, pose);
    return rgi_scene_end_change(scene, &frame, result);
}

bool rgi_is_quick(const rg_scene *scene, uint32_t slot, const double position[3]) {
    const rgi_object *object = rgi_scene_object(scene, slot);
    /* Another thread may be marking it, see rgi_move_balls. */
    uint32_t index = __atomic_load_n(&object->grid, __ATOMIC_RELAXED) & (RGI_MARK - 1);
    const rgi_any_grid *grid = scene->grids[index].grid;
    for (int a = 0; a < 3; a++) {
        if (!(fabs(position[a]) <= RG_COORDINATE_MAX)) return false;
    }
    return object->linear == RGI_NONE && object->shape->kind == RG_SHAPE_SPHERE && rgi_any_grid_is_loose(grid) &&
           rgi_any_grid_place(grid, scene, slot)->block != RGI_NONE &&
           rgi_lattice_reaches(&grid->lattice, position, object->reach);
}

bool rgi_step(rg_scene *scene, uint32_t slot, const double position[3]) {
    rgi_object *object = rgi_scene_object(scene, slot);
    if (!rgi_any_grid_step(scene->grids[object->grid].grid, scene, slot, position, object->reach)) return false;
    rgi_copy(position, object->position);
    rgi_scene_changed(scene, slot);
    return true;
}

rg_result rg_scene_move_to(rg_scene *scene, rg_object id, const double position[3]) {
    rgi_frame frame;
    if (!position) return rgi_fail(RG_INVALID_ARGUMENT, "position is NULL");
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = move_by_id(scene, id, position, NULL);
    if (!result) RGI_RECORD(move_to, scene, id, position);
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_scene_set_mask(rg_scene *scene, rg_object id, uint32_t mask) {
    rgi_frame frame;
    uint32_t slot;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_find_object(scene, id, &slot);
    if (!result) {
        rgi_scene_object(scene, slot)->mask = mask;
        rgi_scene_changed(scene, slot);
        scene->masked |= mask != UINT32_MAX;
        RGI_RECORD(mask, scene, id, mask);
    }
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_scene_remove(rg_scene *scene, rg_object id) {
    rgi_frame frame;
    uint32_t slot;
    rg_shape *gone = NULL;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_find_object(scene, id, &slot);
    if (!result) {
        uint32_t grid = rgi_scene_object(scene, slot)->grid;
        rgi_shape_put_aside(rgi_remove_one(scene, slot), &gone);
        rgi_any_grid_settle(scene->grids[grid].grid, scene, 1);
        RGI_RECORD(remove, scene, id);
    }
    rgi_scene_end_change(scene, &frame, result);
    rgi_shapes_destroy(gone);
    return result;
}

/* -------------------------------------------------------------------------------------------------- lookup */

static void report_object(const rg_scene *scene, const rgi_object *object, rg_object_report *r) {
    const rgi_linear *linear = rgi_scene_linear(scene, object);
    rgi_placing p;
    (void)rgi_place_at(scene, object, object->position, &p);
    memset(r, 0, sizeof *r);
    rgi_copy(object->position, r->pose.position);
    memcpy(r->pose.linear, linear ? linear->matrix : rgi_identity, sizeof r->pose.linear);
    r->pose.scale = rgi_object_scale(object, linear);
    r->shape = object->shape;
    r->mask = object->mask;
    r->grid = rgi_scene_grid_id(scene, object->grid);
    rgi_copy(p.bound.lo, r->lo);
    rgi_copy(p.bound.hi, r->hi);
}

rg_result rg_scene_shape_of(rg_scene *scene, rg_object id, rg_shape **shape) {
    rgi_frame frame;
    uint32_t slot;
    if (!scene || !shape) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", scene ? "shape" : "scene");
    rgi_scene_begin_read(scene, &frame);
    rg_result result = rgi_find_object(scene, id, &slot);
    if (!result) {
        *shape = rgi_scene_object(scene, slot)->shape;
        rg_shape_retain(*shape);
    }
    rgi_scene_end_read(scene, &frame);
    return result;
}

rg_result rg_scene_lookup(rg_scene *scene, rg_object id, rg_object_report *report) {
    rg_object_report r;
    rgi_frame frame;
    uint32_t slot;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    rgi_scene_begin_read(scene, &frame);
    rg_result result = rgi_find_object(scene, id, &slot);
    if (!result) report_object(scene, rgi_scene_object(scene, slot), &r);
    rgi_scene_end_read(scene, &frame);
    return result ? result : rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_object_report");
}
