/* SPDX-License-Identifier: MIT */
/*
 * Insert, move, remove. Each call on many goes over its input twice: once to check all and to add up what memory it takes,
 * then, when all of it is there, to do it. So it is done whole or not at all.
 */
#include "error.h"
#include "scene.h"
#include "struct_size.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

enum {
    INSERT_LEAST = sizeof(rg_insert_views),
    POSES_LEAST = sizeof(rg_pose_views),
    REPORT_LEAST = sizeof(rg_object_report)
};

/** Where an object is to be: checked, with all that is derived from it. */
typedef struct placing {
    double position[3];
    bool is_linear; /* has a linear part other than the identity */
    rgi_linear linear;
    double lo[3], hi[3];
    double reach;
} placing;

/* The distance from the position to the farthest corner of the world box; a sphere's own radius is less. */
static double reach_of(const rg_shape *shape, const placing *p) {
    if (shape->kind == RG_SHAPE_SPHERE && !p->is_linear) return shape->of.radius;
    double far[3];
    for (int a = 0; a < 3; a++) far[a] = rgi_max(fabs(p->lo[a] - p->position[a]), fabs(p->hi[a] - p->position[a]));
    double largest = rgi_max_magnitude(far);
    return largest < INFINITY ? sqrt(rgi_dot(far, far)) : INFINITY;
}

static rg_result derive(const rg_shape *shape, placing *p) {
    rg_result result = rgi_check_position(p->position);
    if (!result)
        result = rgi_shape_bounds(shape, p->position, p->is_linear ? p->linear.matrix : NULL, p->lo, p->hi);
    if (!result) p->reach = reach_of(shape, p);
    return result;
}

static rg_result place(const rg_shape *shape, const double position[3], const float matrix[9], placing *p) {
    rgi_copy(position, p->position);
    p->is_linear = !rgi_is_identity(matrix);
    if (p->is_linear) {
        rg_result result = rgi_linear_init(&p->linear, matrix);
        if (result) return result;
    }
    return derive(shape, p);
}

/* A new position for an object that keeps its linear part. */
static rg_result place_at(const rg_scene *scene, const rgi_object *object, const double position[3], placing *p) {
    const rgi_linear *linear = rgi_scene_linear(scene, object);
    rgi_copy(position, p->position);
    p->is_linear = linear != NULL;
    if (linear) p->linear = *linear;
    return derive(object->shape, p);
}

/* The i-th of views of poses. Without columns: `object`'s linear part, or the identity if there is no object. */
static rg_result place_view(const rg_scene *scene, const rg_pose_views *views, uint64_t i, const rg_shape *shape,
                            const rgi_object *object, placing *p) {
    double position[3], column[3];
    float matrix[9];
    rgi_load3(&views->position, i, position);
    if (!views->column[0].x)
        return object ? place_at(scene, object, position, p) : place(shape, position, rgi_identity, p);
    for (int j = 0; j < 3; j++) {
        rgi_load3(&views->column[j], i, column);
        for (int r = 0; r < 3; r++) matrix[3 * r + j] = (float)column[r];
    }
    return place(shape, position, matrix, p);
}

static rg_result check_poses(const rg_pose_views *views) {
    const rg_input3 *v = &views->position;
    rg_result result = rgi_check_view3(v->x, v->y, v->z, v->type, RGI_FLOATS, 1, "poses.position");
    for (int j = 0; j < 3 && !result; j++) {
        v = &views->column[j];
        result = rgi_check_view3(v->x, v->y, v->z, v->type, RGI_FLOATS, 0, "poses.column");
        if (!result && !v->x != !views->column[0].x)
            result = rgi_fail(RG_INVALID_ARGUMENT, "poses.column: some of the three columns are given, not all");
    }
    return result;
}

/* ----------------------------------------------------------------------------------------- one object */

static rg_result find(const rg_scene *scene, rg_object id, uint32_t *slot) {
    *slot = RG_OBJECT_SLOT(id);
    if (*slot < scene->objects.used) {
        const rgi_object *object = rgi_scene_object(scene, *slot);
        if (object->shape && object->generation == id >> 32) return RG_OK;
    }
    return rgi_fail(RG_INVALID_ID, "object 0x%" PRIx64 " is %s", id, id ? "stale or none of this scene's" : "no object");
}

/* Stores the linear part: takes a record when there is one for the first time, gives it back when it is the identity
 * again. A record must have been reserved. */
static void set_linear(rg_scene *scene, rgi_object *object, const placing *p) {
    if (p->is_linear) {
        if (object->linear == RGI_NONE) object->linear = rgi_slots_take(&scene->linears);
        *(rgi_linear *)rgi_slots_at(&scene->linears, object->linear) = p->linear;
    } else if (object->linear != RGI_NONE) {
        rgi_slots_give(&scene->linears, object->linear);
        object->linear = RGI_NONE;
    }
}

static rg_result insert_one(rg_scene *scene, rg_shape *shape, const placing *p, uint32_t mask, uint32_t grid,
                            rg_object *id) {
    rg_result result = rgi_slots_reserve(&scene->objects, 1);
    if (!result && p->is_linear) result = rgi_slots_reserve(&scene->linears, 1);
    if (result) return result;
    uint32_t slot = rgi_slots_next(&scene->objects), member;
    result = rgi_grid_insert(scene->grids[grid].grid, slot, p->lo, p->hi, &member);
    if (result) return result;
    rgi_object *object = rgi_scene_object(scene, rgi_slots_take(&scene->objects));
    if (object->generation == 0) object->generation = 1;
    rg_shape_retain(shape);
    object->shape = shape;
    object->linear = RGI_NONE;
    object->mask = mask;
    object->grid = grid;
    object->member = member;
    object->reach = p->reach;
    rgi_copy(p->position, object->position);
    set_linear(scene, object, p);
    scene->object_count++;
    *id = rgi_object_id(object, slot);
    return RG_OK;
}

static rg_result move_one(rg_scene *scene, rgi_object *object, const placing *p) {
    rg_result result = RG_OK;
    if (p->is_linear && object->linear == RGI_NONE) result = rgi_slots_reserve(&scene->linears, 1);
    if (!result) result = rgi_grid_move(scene->grids[object->grid].grid, object->member, p->lo, p->hi);
    if (result) return result;
    object->reach = p->reach;
    rgi_copy(p->position, object->position);
    set_linear(scene, object, p);
    return RG_OK;
}

/* The shape is returned for the caller to release last: its destroy callback must find a scene that is in order. */
static rg_shape *remove_one(rg_scene *scene, uint32_t slot) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rg_shape *shape = object->shape;
    rgi_grid_remove(scene->grids[object->grid].grid, object->member);
    if (object->linear != RGI_NONE) rgi_slots_give(&scene->linears, object->linear);
    object->shape = NULL;
    scene->object_count--;
    if (object->generation < UINT32_MAX) {
        object->generation++;
        rgi_slots_give(&scene->objects, slot);
    }
    return shape;
}

rg_result rg_scene_insert(rg_scene *scene, rg_shape *shape, const rg_pose *pose, rg_object *out) {
    static const double origin[3] = {0, 0, 0};
    placing p;
    rgi_frame frame;
    rg_object id;
    if (!shape) return rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL");
    rg_result result = place(shape, pose ? pose->position : origin, pose ? pose->linear : rgi_identity, &p);
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = insert_one(scene, shape, &p, UINT32_MAX, 0, &id);
    if (!result) rgi_grid_settle(scene->grids[0].grid);
    if (!result && out) *out = id;
    return rgi_scene_end_change(scene, &frame, result);
}

static rg_result move_by_id(rg_scene *scene, rg_object id, const double position[3], const float *matrix) {
    placing p;
    uint32_t slot;
    rg_result result = find(scene, id, &slot);
    if (result) return result;
    rgi_object *object = rgi_scene_object(scene, slot);
    result = matrix ? place(object->shape, position, matrix, &p) : place_at(scene, object, position, &p);
    if (!result) result = move_one(scene, object, &p);
    if (!result) rgi_grid_settle(scene->grids[object->grid].grid);
    return result;
}

rg_result rg_scene_move(rg_scene *scene, rg_object id, const rg_pose *pose) {
    rgi_frame frame;
    if (!pose) return rgi_fail(RG_INVALID_ARGUMENT, "pose is NULL");
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    return rgi_scene_end_change(scene, &frame, move_by_id(scene, id, pose->position, pose->linear));
}

rg_result rg_scene_move_to(rg_scene *scene, rg_object id, const double position[3]) {
    rgi_frame frame;
    if (!position) return rgi_fail(RG_INVALID_ARGUMENT, "position is NULL");
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    return rgi_scene_end_change(scene, &frame, move_by_id(scene, id, position, NULL));
}

rg_result rg_scene_set_mask(rg_scene *scene, rg_object id, uint32_t mask) {
    rgi_frame frame;
    uint32_t slot;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = find(scene, id, &slot);
    if (!result) rgi_scene_object(scene, slot)->mask = mask;
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_scene_remove(rg_scene *scene, rg_object id) {
    rgi_frame frame;
    uint32_t slot;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = find(scene, id, &slot);
    if (!result) {
        uint32_t grid = rgi_scene_object(scene, slot)->grid;
        rg_shape *shape = remove_one(scene, slot);
        rgi_grid_settle(scene->grids[grid].grid);
        rg_shape_release(&shape);
    }
    return rgi_scene_end_change(scene, &frame, result);
}

/* ---------------------------------------------------------------------------------------- many objects */

static rg_result check_count(uint64_t count) {
    if (count < UINT32_MAX) return RG_OK;
    return rgi_fail(RG_LIMIT_EXCEEDED, "count is %" PRIu64 ", more than a scene can hold", count);
}

static rg_shape *shape_at(const rg_insert_views *views, uint64_t i) {
    rg_shape *shape;
    memcpy(&shape, rgi_record(views->shapes, views->shapes_stride, i), sizeof shape);
    return shape;
}

/* Checks all that is to be inserted and makes room for it. */
static rg_result prepare_insert(rg_scene *scene, const rg_insert_views *views, uint64_t count, uint32_t grid) {
    rgi_grid_need need = {0, 0, 0};
    uint64_t linears = 0;
    rg_result result = RG_OK;
    placing p;
    for (uint64_t i = 0; i < count && !result; i++) {
        rg_shape *shape = shape_at(views, i);
        result = shape ? place_view(scene, views->poses, i, shape, NULL, &p)
                       : rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL");
        if (result) {
            rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
            return result;
        }
        linears += p.is_linear;
        rgi_grid_need_insert(scene->grids[grid].grid, p.lo, p.hi, &need);
    }
    result = rgi_slots_reserve(&scene->objects, count);
    if (!result) result = rgi_slots_reserve(&scene->linears, linears);
    if (!result) result = rgi_grid_reserve(scene->grids[grid].grid, &need);
    return result;
}

static rg_result insert_all(rg_scene *scene, const rg_insert_views *views, uint64_t count, const rg_output *objects) {
    uint32_t grid;
    rg_result result = rgi_scene_find_grid(scene, views->grid, &grid);
    if (!result) result = prepare_insert(scene, views, count, grid);
    for (uint64_t i = 0; i < count && !result; i++) {
        placing p;
        rg_object id;
        rg_shape *shape = shape_at(views, i);
        result = place_view(scene, views->poses, i, shape, NULL, &p);
        uint32_t mask = (uint32_t)rgi_load_integer(&views->mask, i, UINT32_MAX);
        if (!result) result = insert_one(scene, shape, &p, mask, grid, &id);
        if (!result && objects) rgi_store_integer(objects, i, id);
    }
    if (!result) rgi_grid_settle(scene->grids[grid].grid);
    return result;
}

rg_result rg_scene_insert_many(rg_scene *scene, const rg_insert_views *given, uint64_t count, const rg_output *objects) {
    rg_insert_views views;
    rg_pose_views poses;
    rgi_frame frame;
    if (!given || !given->poses) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", given ? "poses" : "views");
    rg_result result = rgi_struct_read(&views, sizeof views, INSERT_LEAST, given, "rg_insert_views");
    if (!result) result = rgi_struct_read(&poses, sizeof poses, POSES_LEAST, given->poses, "rg_pose_views");
    views.poses = &poses;
    if (!result) result = check_count(count);
    if (!result && views.reserved)
        result = rgi_fail(RG_INVALID_ARGUMENT, "rg_insert_views.reserved is %u, not 0", views.reserved);
    if (!result && count && !views.shapes) result = rgi_fail(RG_INVALID_ARGUMENT, "shapes is NULL");
    if (!result && count) result = check_poses(&poses);
    if (!result) result = rgi_check_view(views.mask.data, views.mask.type, RGI_U32, 0, "mask");
    if (!result && objects) result = rgi_check_view(objects->data, objects->type, RGI_U64, 0, "objects");
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    return rgi_scene_end_change(scene, &frame, insert_all(scene, &views, count, objects));
}

/* Bits of the grids that a call on many has touched: their rules are applied once, at its end. */
typedef struct touched {
    uint32_t bits[RGI_GRIDS / 32];
} touched;

static void touch(touched *t, uint32_t grid) { t->bits[grid / 32] |= 1u << grid % 32; }

static void settle(rg_scene *scene, const touched *t) {
    for (uint32_t i = 0; i < scene->grid_places; i++) {
        if (t->bits[i / 32] >> i % 32 & 1) rgi_grid_settle(scene->grids[i].grid);
    }
}

static rg_result find_nth(const rg_scene *scene, const rg_input *objects, uint64_t i, uint32_t *slot) {
    rg_result result = find(scene, rgi_load_integer(objects, i, 0), slot);
    if (result) rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
    return result;
}

/* Checks all moves and makes room for them, one grid after the other. */
static rg_result prepare_move(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count,
                              uint32_t grid, touched *grids) {
    rgi_grid_need need = {0, 0, 0};
    uint64_t linears = 0;
    uint32_t slot;
    for (uint64_t i = 0; i < count; i++) {
        placing p;
        rg_result result = find_nth(scene, objects, i, &slot);
        if (result) return result;
        rgi_object *object = rgi_scene_object(scene, slot);
        touch(grids, object->grid);
        if (object->grid != grid) continue;
        result = place_view(scene, poses, i, object->shape, object, &p);
        if (result) {
            rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
            return result;
        }
        linears += p.is_linear && object->linear == RGI_NONE;
        rgi_grid_need_move(scene->grids[grid].grid, object->member, p.lo, p.hi, &need);
    }
    rg_result result = rgi_slots_reserve(&scene->linears, linears);
    return result ? result : rgi_grid_reserve(scene->grids[grid].grid, &need);
}

static rg_result move_all(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count) {
    touched grids;
    uint32_t slot;
    memset(&grids, 0, sizeof grids);
    rg_result result = prepare_move(scene, objects, poses, count, 0, &grids);
    for (uint32_t g = 1; g < scene->grid_places && !result; g++) {
        if (grids.bits[g / 32] >> g % 32 & 1) result = prepare_move(scene, objects, poses, count, g, &grids);
    }
    for (uint64_t i = 0; i < count && !result; i++) {
        placing p;
        result = find(scene, rgi_load_integer(objects, i, 0), &slot);
        if (result) break;
        rgi_object *object = rgi_scene_object(scene, slot);
        result = place_view(scene, poses, i, object->shape, object, &p);
        if (!result) result = move_one(scene, object, &p);
    }
    settle(scene, &grids);
    return result;
}

rg_result rg_scene_move_many(rg_scene *scene, const rg_input *objects, const rg_pose_views *given, uint64_t count) {
    rg_pose_views poses;
    rgi_frame frame;
    if (!objects || !given) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", objects ? "poses" : "objects");
    rg_result result = rgi_struct_read(&poses, sizeof poses, POSES_LEAST, given, "rg_pose_views");
    if (!result && count) result = check_poses(&poses);
    if (!result) result = rgi_check_view(objects->data, objects->type, RGI_U64, count > 0, "objects");
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    return rgi_scene_end_change(scene, &frame, move_all(scene, objects, &poses, count));
}

/*
 * Objects are marked by a free grid number while they are checked, so that an id given twice is found without memory;
 * the marks are taken off again whatever comes out.
 */
enum { MARK = RGI_GRIDS };

static rg_result mark_all(rg_scene *scene, const rg_input *objects, uint64_t count, uint64_t *marked) {
    uint32_t slot;
    for (*marked = 0; *marked < count; ++*marked) {
        rg_result result = find_nth(scene, objects, *marked, &slot);
        if (result) return result;
        rgi_object *object = rgi_scene_object(scene, slot);
        if (object->grid & MARK)
            return rgi_fail(RG_INVALID_ID, "object %" PRIu64 " of the call: 0x%" PRIx64 " is given twice", *marked,
                            rgi_object_id(object, slot));
        object->grid |= MARK;
    }
    return RG_OK;
}

static rg_result remove_all(rg_scene *scene, const rg_input *objects, uint64_t count) {
    uint64_t marked;
    touched grids;
    memset(&grids, 0, sizeof grids);
    rg_result result = mark_all(scene, objects, count, &marked);
    for (uint64_t i = 0; i < marked; i++)
        rgi_scene_object(scene, RG_OBJECT_SLOT(rgi_load_integer(objects, i, 0)))->grid &= ~(uint32_t)MARK;
    if (result) return result;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t slot = RG_OBJECT_SLOT(rgi_load_integer(objects, i, 0));
        touch(&grids, rgi_scene_object(scene, slot)->grid);
        rg_shape *shape = remove_one(scene, slot);
        rg_shape_release(&shape);
    }
    settle(scene, &grids);
    return RG_OK;
}

rg_result rg_scene_remove_many(rg_scene *scene, const rg_input *objects, uint64_t count) {
    rgi_frame frame;
    if (!objects) return rgi_fail(RG_INVALID_ARGUMENT, "objects is NULL");
    rg_result result = rgi_check_view(objects->data, objects->type, RGI_U64, count > 0, "objects");
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    return rgi_scene_end_change(scene, &frame, remove_all(scene, objects, count));
}

/* -------------------------------------------------------------------------------------------------- lookup */

static void report_object(const rg_scene *scene, const rgi_object *object, rg_object_report *r) {
    const rgi_linear *linear = rgi_scene_linear(scene, object);
    const rgi_member *member = rgi_grid_member(scene->grids[object->grid].grid, object->member);
    memset(r, 0, sizeof *r);
    rgi_copy(object->position, r->pose.position);
    memcpy(r->pose.linear, linear ? linear->matrix : rgi_identity, sizeof r->pose.linear);
    r->shape = object->shape;
    r->mask = object->mask;
    r->grid = rgi_scene_grid_id(scene, object->grid);
    rgi_copy(member->lo, r->lo);
    rgi_copy(member->hi, r->hi);
}

rg_result rg_scene_lookup(rg_scene *scene, rg_object id, rg_object_report *report) {
    rg_object_report r;
    rgi_frame frame;
    uint32_t slot;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    rgi_scene_begin_read(scene, &frame);
    rg_result result = find(scene, id, &slot);
    if (!result) report_object(scene, rgi_scene_object(scene, slot), &r);
    rgi_scene_end_read(scene, &frame);
    return result ? result : rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_object_report");
}
