/* SPDX-License-Identifier: MIT */
/*
 * Insert, move and remove many objects. Each call goes over its input twice: once to check all and to add up what
 * memory it takes, then, when all of it is there, to do it. So it is done whole or not at all.
 */
#include "any_grid.h"
#include "error.h"
#include "frame.h"
#include "record.h"
#include "scene_objects.h"
#include "struct_size.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

enum {
    INSERT_LEAST = sizeof(rg_insert_views),
    POSES_LEAST = sizeof(rg_pose_views),
    BULK = 64 /* so many objects are built into an empty grid at once */
};

/* The i-th of views of poses. What is not given: as `object` has it, or as rg_pose_at if there is no object. */
static rg_result place_view(const rg_scene *scene, const rg_pose_views *views, uint64_t i, const rg_shape *shape,
                            const rgi_object *object, rgi_placing *p) {
    double position[3], scale = 1;
    float given[9];
    const float *matrix = rgi_identity;
    rgi_load3(&views->position, i, position);
    if (object) {
        if (!views->column[0].x && !views->scale.data) return rgi_place_at(scene, object, position, p);
        const rgi_linear *linear = rgi_scene_linear(scene, object);
        scale = rgi_object_scale(object, linear);
        if (linear) matrix = linear->matrix;
    }
    if (views->column[0].x) {
        rgi_load_columns(views->column, i, given);
        matrix = given;
    }
    return rgi_place(shape, position, matrix, rgi_load(&views->scale, i, scale), p);
}

rg_result rg_pose_views_of(rg_pose_views *views, size_t size, const rg_pose *poses, ptrdiff_t stride) {
    rg_pose_views v;
    if (!poses) return rgi_fail(RG_INVALID_ARGUMENT, "poses is NULL");
    memset(&v, 0, sizeof v);
    v.position = rg_input3_packed(poses->position, stride, RG_F64);
    for (int j = 0; j < 3; j++)
        v.column[j] = (rg_input3){poses->linear + j, poses->linear + 3 + j, poses->linear + 6 + j, stride, RG_F32};
    v.scale = (rg_input){&poses->scale, stride, RG_F64};
    return rgi_struct_default(&v, sizeof v, POSES_LEAST, views, size, "rg_pose_views");
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
    if (!result) result = rgi_check_view(views->scale.data, views->scale.type, RGI_FLOATS, 0, "poses.scale");
    return result;
}

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
    rgi_placing p;
    for (uint64_t i = 0; i < count && !result; i++) {
        rg_shape *shape = shape_at(views, i);
        result = shape ? place_view(scene, views->poses, i, shape, NULL, &p)
                       : rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL");
        if (result) {
            rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
            return result;
        }
        linears += p.is_linear;
        rgi_any_grid_need_insert(scene->grids[grid].grid, &p.bound, &need);
    }
    result = rgi_slots_reserve(&scene->objects, count);
    if (!result) result = rgi_slots_reserve(&scene->linears, linears);
    if (!result) result = rgi_any_grid_reserve(scene->grids[grid].grid, &need);
    return result;
}

static rg_result insert_nth(rg_scene *scene, const rg_insert_views *views, uint64_t i, uint32_t grid, rg_object *id) {
    rgi_placing p;
    rg_shape *shape = shape_at(views, i);
    rg_result result = place_view(scene, views->poses, i, shape, NULL, &p);
    uint32_t mask = (uint32_t)rgi_load_integer(&views->mask, i, UINT32_MAX);
    return result ? result : rgi_insert_one(scene, shape, &p, mask, grid, id);
}

/* Undoes the insert made last, so that the next one gets the same id. `stored`: in its grid, too. */
static void take_back(rg_scene *scene, uint32_t slot, bool stored) {
    rgi_object *object = rgi_scene_object(scene, slot);
    uint32_t generation = object->generation;
    rg_shape *shape = stored ? rgi_remove_one(scene, slot) : rgi_empty_object(scene, slot);
    object->generation = generation;
    rgi_slots_trim(&scene->objects);
    rg_shape_release(&shape);
}

/* One after another. What a lattice takes is not known before it is taken: where memory ends on the way, what was
 * inserted goes again. */
static rg_result insert_each(rg_scene *scene, const rg_insert_views *views, uint64_t count, uint32_t grid,
                             rg_object *ids) {
    for (uint64_t i = 0; i < count; i++) {
        rg_result result = insert_nth(scene, views, i, grid, &ids[i]);
        if (!result) continue;
        while (i > 0) take_back(scene, RG_OBJECT_SLOT(ids[--i]), true);
        return result;
    }
    return RG_OK;
}

/* All at once into an empty lattice. */
static rg_result insert_bulk(rg_scene *scene, const rg_insert_views *views, uint64_t count, uint32_t grid,
                             rg_object *ids) {
    uint32_t *slots;
    rg_result result = rgi_allocate(&scene->memory, count, sizeof *slots, "inserting many objects", &slots);
    if (result) return result;
    for (uint64_t i = 0; i < count; i++) {
        rgi_placing p;
        rg_shape *shape = shape_at(views, i);
        (void)place_view(scene, views->poses, i, shape, NULL, &p); /* checked before */
        slots[i] = rgi_slots_take(&scene->objects);
        rgi_fill_object(scene, slots[i], shape, &p, (uint32_t)rgi_load_integer(&views->mask, i, UINT32_MAX), grid);
        ids[i] = rgi_object_id(rgi_scene_object(scene, slots[i]), slots[i]);
    }
    result = rgi_any_grid_fill(scene->grids[grid].grid, scene, slots, count);
    if (result) rgi_any_grid_clear(scene->grids[grid].grid, scene);
    for (uint64_t i = count; i > 0 && result; i--) take_back(scene, slots[i - 1], false);
    rgi_release(&scene->memory, slots, count, sizeof *slots);
    return result;
}

static rg_result insert_all(rg_scene *scene, const rg_insert_views *views, uint64_t count, const rg_output *objects) {
    uint32_t grid;
    rg_object *ids = NULL;
    rg_result result = rgi_scene_find_grid(scene, views->grid, &grid);
    if (!result) result = prepare_insert(scene, views, count, grid);
    if (!result && count) result = rgi_allocate(&scene->memory, count, sizeof *ids, "inserting many objects", &ids);
    if (result) return result;
    const rgi_any_grid *store = scene->grids[grid].grid;
    bool bulk = rgi_any_grid_is_loose(store) && store->count == 0 && count >= BULK;
    result = bulk ? insert_bulk(scene, views, count, grid, ids) : insert_each(scene, views, count, grid, ids);
    if (!result) {
        RGI_RECORD(insert_many, scene, views, count, ids);
        for (uint64_t i = 0; i < count && objects; i++) rgi_store_integer(objects, i, ids[i]);
        rgi_any_grid_settle(scene->grids[grid].grid, scene, count);
    }
    rgi_release(&scene->memory, ids, count, sizeof *ids);
    return result;
}

rg_result rg_scene_insert_many(rg_scene *scene, const rg_insert_views *given, uint64_t count,
                               const rg_output *objects) {
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

void rgi_settle_touched(rg_scene *scene, const rgi_touched *t, uint64_t count) {
    for (uint32_t i = 0; i < scene->grid_places; i++) {
        if (rgi_is_touched(t, i)) rgi_any_grid_settle(scene->grids[i].grid, scene, count);
    }
}

/* See RGI_AHEAD. */
static void fetch_ahead(const rg_scene *scene, const rg_input *objects, uint64_t i, uint64_t count) {
    if (i + 2 * RGI_AHEAD < count) rgi_fetch_object(scene, rgi_load_integer(objects, i + 2 * RGI_AHEAD, 0));
    if (i + RGI_AHEAD < count) rgi_fetch_place(scene, rgi_load_integer(objects, i + RGI_AHEAD, 0));
}

static rg_result find_nth(const rg_scene *scene, const rg_input *objects, uint64_t i, uint32_t *slot) {
    rg_result result = rgi_find_object(scene, rgi_load_integer(objects, i, 0), slot);
    if (result) rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
    return result;
}

/** A move that was checked, for the second time over: what took time to find out. */
typedef struct checked_move {
    rgi_bound bound;
    double reach;
    uint32_t slot;
    bool whole;  /* a linear part is concerned, or the object is moved twice: to be done from the start */
    bool inside; /* it stays in its cells */
} checked_move;

/** What the moves of a call take. */
typedef struct move_need {
    rgi_grid_need grids[RGI_GRIDS];
    rgi_touched touched;
    uint64_t linears;
} move_need;

/* Notes in *again whether the object has been moved by this call before. */
static rg_result check_move(const rg_scene *scene, const rg_pose_views *poses, uint64_t i, checked_move *move,
                            move_need *need, bool *again) {
    rgi_placing p;
    rgi_object *object = rgi_scene_object(scene, move->slot);
    uint32_t grid = __atomic_load_n(&object->grid, __ATOMIC_RELAXED) & (RGI_MARK - 1);
    rg_result result = place_view(scene, poses, i, object->shape, object, &p);
    if (result) {
        rgi_fail_prefix("object %" PRIu64 " of the call: ", i);
        return result;
    }
    move->bound = p.bound;
    move->reach = p.reach;
    move->inside = rgi_any_grid_need_move(scene->grids[grid].grid, scene, move->slot, &p.bound, &need->grids[grid]);
    *again = __atomic_fetch_or(&object->grid, RGI_MARK, __ATOMIC_RELAXED) & RGI_MARK;
    move->whole = p.is_linear || object->linear != RGI_NONE || *again;
    need->linears += p.is_linear && object->linear == RGI_NONE;
    rgi_touch(&need->touched, grid);
    return RG_OK;
}

/* One after another. */
static rg_result check_moves(const rg_scene *scene, const rg_input *objects, const rg_pose_views *poses,
                             uint64_t count, checked_move *moves, move_need *need) {
    uint64_t marked = 0;
    rg_result result = RG_OK;
    bool again;
    for (; marked < count && !result; marked += !result) {
        fetch_ahead(scene, objects, marked, count);
        result = find_nth(scene, objects, marked, &moves[marked].slot);
        if (!result) result = check_move(scene, poses, marked, &moves[marked], need, &again);
    }
    rgi_unmark_all(scene, objects, marked);
    return result;
}

/** The same shared out among the workers. What one object of a call tells of another, that it is the same one or
 * which of two is refused, is left to the way in order. */
typedef struct shared_check {
    const rg_scene *scene;
    const rg_input *objects;
    const rg_pose_views *poses;
    uint64_t count;
    checked_move *moves;
    move_need *need;
    uint32_t failed; /* atomic */
} shared_check;

static void add_need(const rg_scene *scene, move_need *sum, const move_need *part) {
    for (uint32_t g = 0; g < scene->grid_places; g++) {
        if (!rgi_is_touched(&part->touched, g)) continue;
        __atomic_fetch_or(&sum->touched.bits[g / 32], 1u << g % 32, __ATOMIC_RELAXED);
        __atomic_fetch_add(&sum->grids[g].members, part->grids[g].members, __ATOMIC_RELAXED);
        __atomic_fetch_add(&sum->grids[g].entries, part->grids[g].entries, __ATOMIC_RELAXED);
        __atomic_fetch_add(&sum->grids[g].tiles, part->grids[g].tiles, __ATOMIC_RELAXED);
    }
    __atomic_fetch_add(&sum->linears, part->linears, __ATOMIC_RELAXED);
}

static void check_tile(void *context, uint64_t tile) {
    shared_check *c = context;
    uint64_t first = tile * RGI_TILE, end = c->count - first < RGI_TILE ? c->count : first + RGI_TILE;
    move_need need;
    memset(&need, 0, sizeof need);
    for (uint64_t i = first; i < end && !__atomic_load_n(&c->failed, __ATOMIC_RELAXED); i++) {
        bool again = false;
        fetch_ahead(c->scene, c->objects, i, end);
        rg_result result = find_nth(c->scene, c->objects, i, &c->moves[i].slot);
        if (!result) result = check_move(c->scene, c->poses, i, &c->moves[i], &need, &again);
        if (result || again) __atomic_store_n(&c->failed, 1, __ATOMIC_RELAXED);
    }
    add_need(c->scene, c->need, &need);
}

/* False: nothing is known. */
static bool check_shared(const rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count,
                         checked_move *moves, move_need *need) {
    shared_check c = {scene, objects, poses, count, moves, need, 0};
    if (count < RGI_WORTH_SHARING || !rgi_pool_has_threads(scene->pool)) return false;
    rgi_fail_quietly(true);
    rgi_pool_run(scene->pool, (count + RGI_TILE - 1) / RGI_TILE, check_tile, &c);
    rgi_fail_quietly(false);
    rgi_unmark_all(scene, objects, count);
    return !c.failed;
}

/* Checks all moves and makes room for them. */
static rg_result prepare_move(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count,
                              checked_move *moves, move_need *need) {
    rg_result result = RG_OK;
    memset(need, 0, sizeof *need);
    if (!check_shared(scene, objects, poses, count, moves, need)) {
        memset(need, 0, sizeof *need);
        result = check_moves(scene, objects, poses, count, moves, need);
    }
    if (!result) result = rgi_slots_reserve(&scene->linears, need->linears);
    for (uint32_t g = 0; g < scene->grid_places && !result; g++) {
        if (rgi_is_touched(&need->touched, g)) result = rgi_any_grid_reserve(scene->grids[g].grid, &need->grids[g]);
    }
    return result;
}

static rg_result make_move(rg_scene *scene, const rg_pose_views *poses, uint64_t i, const checked_move *move) {
    rgi_object *object = rgi_scene_object(scene, move->slot);
    rgi_any_grid *grid = scene->grids[object->grid].grid;
    rg_result result = RG_OK;
    if (move->whole) {
        rgi_placing p;
        result = place_view(scene, poses, i, object->shape, object, &p);
        return result ? result : rgi_move_one(scene, move->slot, &p);
    }
    if (move->inside)
        rgi_any_grid_move_inside(grid, scene, move->slot, &move->bound);
    else
        result = rgi_any_grid_move(grid, scene, move->slot, &move->bound);
    if (result) return result;
    object->reach = move->reach;
    rgi_copy(move->bound.centre, object->position);
    rgi_scene_changed(scene, move->slot);
    return result;
}

static rg_result move_all(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count) {
    move_need need;
    checked_move *moves = NULL;
    if (count == 0) return RG_OK;
    if (rgi_move_balls(scene, objects, poses, count)) return RG_OK;
    rg_result result = rgi_allocate(&scene->memory, count, sizeof *moves, "moving many objects", &moves);
    if (result) return result;
    result = prepare_move(scene, objects, poses, count, moves, &need);
    for (uint64_t i = 0; i < count && !result; i++) {
        fetch_ahead(scene, objects, i, count);
        result = make_move(scene, poses, i, &moves[i]);
    }
    rgi_release(&scene->memory, moves, count, sizeof *moves);
    if (!result) rgi_settle_touched(scene, &need.touched, count);
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
    result = move_all(scene, objects, &poses, count);
    if (!result) RGI_RECORD(move_many, scene, objects, &poses, count);
    return rgi_scene_end_change(scene, &frame, result);
}

static rg_result mark_all(rg_scene *scene, const rg_input *objects, uint64_t count, uint64_t *marked) {
    uint32_t slot;
    for (*marked = 0; *marked < count; ++*marked) {
        rg_result result = find_nth(scene, objects, *marked, &slot);
        if (result) return result;
        rgi_object *object = rgi_scene_object(scene, slot);
        if (object->grid & RGI_MARK)
            return rgi_fail(RG_INVALID_ID, "object %" PRIu64 " of the call: 0x%" PRIx64 " is given twice", *marked,
                            rgi_object_id(object, slot));
        object->grid |= RGI_MARK;
    }
    return RG_OK;
}

static rg_result remove_all(rg_scene *scene, const rg_input *objects, uint64_t count, rg_shape **gone) {
    uint64_t marked;
    rgi_touched grids;
    memset(&grids, 0, sizeof grids);
    rg_result result = mark_all(scene, objects, count, &marked);
    rgi_unmark_all(scene, objects, marked);
    if (result) return result;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t slot = RG_OBJECT_SLOT(rgi_load_integer(objects, i, 0));
        fetch_ahead(scene, objects, i, count);
        rgi_touch(&grids, rgi_scene_object(scene, slot)->grid);
        rgi_shape_put_aside(rgi_remove_one(scene, slot), gone);
    }
    rgi_settle_touched(scene, &grids, count);
    return RG_OK;
}

rg_result rg_scene_remove_many(rg_scene *scene, const rg_input *objects, uint64_t count) {
    rgi_frame frame;
    if (!objects) return rgi_fail(RG_INVALID_ARGUMENT, "objects is NULL");
    rg_result result = rgi_check_view(objects->data, objects->type, RGI_U64, count > 0, "objects");
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    rg_shape *gone = NULL;
    result = remove_all(scene, objects, count, &gone);
    if (!result) RGI_RECORD(remove_many, scene, objects, count);
    rgi_scene_end_change(scene, &frame, result);
    rgi_shapes_destroy(gone);
    return result;
}
