/* SPDX-License-Identifier: MIT */
#include "scene_shapes.h"

#include "any_grid.h"
#include "error.h"
#include "frame.h"
#include "record.h"
#include "scene_objects.h"

#include <inttypes.h>
#include <string.h>

/* What a replacement takes: known before anything has changed. */
typedef struct replace_need {
    rgi_grid_need grids[RGI_GRIDS];
    uint64_t objects[RGI_GRIDS]; /* concerned, in each grid */
    uint64_t linears;
} replace_need;

/* An object as it is, but with another shape. */
static rg_result place_with(const rg_scene *scene, const rgi_object *object, const rg_shape *shape, rgi_placing *p) {
    const rgi_linear *linear = rgi_scene_linear(scene, object);
    return rgi_place(shape, object->position, linear ? linear->matrix : rgi_identity,
                     rgi_object_scale(object, linear), p);
}

static rg_result check_each(const rg_scene *scene, const rg_shape *from, const rg_shape *to, replace_need *need) {
    memset(need, 0, sizeof *need);
    for (uint32_t slot = 0; slot < scene->objects.used; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        rgi_placing p;
        if (object->shape != from) continue;
        rg_result result = place_with(scene, object, to, &p);
        if (result) {
            rgi_fail_prefix("object 0x%" PRIx64 ": ", rgi_object_id(object, slot));
            return result;
        }
        (void)rgi_any_grid_need_move(scene->grids[object->grid].grid, scene, slot, &p.bound,
                                     &need->grids[object->grid]);
        need->objects[object->grid]++;
        need->linears += p.is_linear && object->linear == RGI_NONE;
    }
    return RG_OK;
}

static rg_result make_room(rg_scene *scene, const replace_need *need) {
    rg_result result = rgi_slots_reserve(&scene->linears, need->linears);
    for (uint32_t g = 0; g < scene->grid_places && !result; g++) {
        if (need->objects[g]) result = rgi_any_grid_reserve(scene->grids[g].grid, &need->grids[g]);
    }
    return result;
}

/* Gives one object its new shape. Room has been made for it. */
static rg_result replace_one(rg_scene *scene, uint32_t slot, rg_shape *to, rg_shape **gone) {
    rgi_object *object = rgi_scene_object(scene, slot);
    rgi_placing p;
    (void)place_with(scene, object, to, &p); /* was checked before */
    rg_result result = rgi_move_one(scene, slot, &p);
    if (result) return result;
    rg_shape_retain(to);
    rgi_shape_put_aside(object->shape, gone);
    object->shape = to;
    return RG_OK;
}

static rg_result replace(rg_scene *scene, const rg_shape *from, rg_shape *to, rg_shape **gone, rgi_replaced *what) {
    replace_need need;
    rg_result result = check_each(scene, from, to, &need);
    if (!result) result = make_room(scene, &need);
    for (uint32_t slot = 0; slot < scene->objects.used && !result; slot++) {
        const rgi_object *object = rgi_scene_object(scene, slot);
        if (object->shape != from) continue;
        result = replace_one(scene, slot, to, gone);
        if (what->count++ == 0) what->first = rgi_object_id(object, slot);
    }
    for (uint32_t g = 0; g < scene->grid_places && !result; g++) {
        if (need.objects[g]) rgi_any_grid_settle(scene->grids[g].grid, scene, need.objects[g]);
    }
    return result;
}

rg_result rgi_replace_shape(rg_scene *scene, rg_shape *from, rg_shape *to, rgi_replaced *what) {
    rgi_frame frame;
    rg_shape *gone = NULL;
    if (!from || !to) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", from ? "to" : "from");
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    *what = (rgi_replaced){RG_NO_OBJECT, 0};
    if (from != to) result = replace(scene, from, to, &gone, what);
    /* Where no object had the shape nothing has changed. */
    if (!result && what->count) RGI_RECORD(replace, scene, from, what->first, what->count);
    result = rgi_scene_end_change(scene, &frame, result);
    rgi_shapes_destroy(gone);
    return result;
}

rg_result rg_scene_replace_shape(rg_scene *scene, rg_shape *from, rg_shape *to) {
    rgi_replaced what;
    return rgi_replace_shape(scene, from, to, &what);
}
