/* SPDX-License-Identifier: MIT */
#include "frame.h"

#include "any_grid.h"
#include "error.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------ noting changes */

/* Room for the marks of slots up to one, and for one slot more in the list. */
static rg_result make_room(rgi_follower *f, uint32_t slot) {
    uint64_t marks = f->marks_room, room = f->room;
    while (marks <= slot / 8) marks = marks ? 2 * marks : 1024;
    if (marks != f->marks_room) {
        uint8_t *grown;
        rg_result result = rgi_allocate(f->memory, marks, 1, "the changes since a frame", &grown);
        if (result) return result;
        memset(grown, 0, marks);
        if (f->marks) memcpy(grown, f->marks, f->marks_room);
        rgi_release(f->memory, f->marks, f->marks_room, 1);
        f->marks = grown;
        f->marks_room = marks;
    }
    if (f->count < room) return RG_OK;
    uint32_t *list;
    room = room ? 2 * room : 1024;
    rg_result result = rgi_allocate(f->memory, room, sizeof *list, "the changes since a frame", &list);
    if (result) return result;
    if (f->count) memcpy(list, f->changed, f->count * sizeof *list);
    rgi_release(f->memory, f->changed, f->room, sizeof *list);
    f->changed = list;
    f->room = room;
    return RG_OK;
}

static void note(rgi_follower *f, uint32_t slot) {
    if (f->all) return;
    if (slot / 8 < f->marks_room && (f->marks[slot / 8] >> slot % 8 & 1)) return;
    rgi_fail_quietly(true);
    f->all = make_room(f, slot) != RG_OK;
    rgi_fail_quietly(false);
    if (f->all) return;
    f->marks[slot / 8] |= (uint8_t)(1u << slot % 8);
    f->changed[f->count++] = slot;
}

void rgi_followers_note(rg_scene *scene, uint32_t slot) {
    for (rgi_follower *f = scene->followers; f; f = f->next) note(f, slot);
}

void rgi_followers_note_grids(rg_scene *scene) {
    for (rgi_follower *f = scene->followers; f; f = f->next) f->grids = true;
}

static void forget_changes(rgi_follower *f) {
    if (f->all && f->marks) memset(f->marks, 0, f->marks_room);
    for (uint64_t i = 0; i < f->count; i++) f->marks[f->changed[i] / 8] = 0;
    f->count = 0;
    f->all = f->grids = false;
}

/* ------------------------------------------------------------------------------------ what an update takes over */

/** A slot as it is in the leader. */
typedef struct copy {
    uint32_t slot;
    uint32_t linear;   /* number of its linear part among those copied, or RGI_NONE */
    rgi_object object; /* with a reference to its shape */
} copy;

typedef struct grid_copy {
    rg_grid_config config; /* size 0: no grid */
    uint32_t generation;
} grid_copy;

typedef struct update {
    copy *objects;
    rgi_linear *linears;
    uint64_t count, linear_count;
    uint32_t used; /* slots of the leader */
    bool grids_changed, masked;
    uint32_t grid_places;
    grid_copy grids[RGI_GRIDS];
} update;

static void free_update(rg_scene *frame, update *u) {
    rg_shape *gone = NULL;
    for (uint64_t i = 0; i < u->count; i++) {
        if (u->objects[i].object.shape) rgi_shape_put_aside(u->objects[i].object.shape, &gone);
    }
    rgi_shapes_destroy(gone);
    rgi_release(&frame->memory, u->objects, u->count, sizeof *u->objects);
    rgi_release(&frame->memory, u->linears, u->linear_count, sizeof *u->linears);
}

static uint32_t nth_changed(const rgi_follower *f, uint64_t i) {
    return f->all ? (uint32_t)i : f->changed[i];
}

static rg_result allocate_update(rg_scene *frame, const rg_scene *leader, const rgi_follower *f, update *u) {
    uint64_t count = f->all ? leader->objects.used : f->count, linears = 0;
    for (uint64_t i = 0; i < count; i++) {
        const rgi_object *object = rgi_scene_object(leader, nth_changed(f, i));
        linears += object->shape && object->linear != RGI_NONE;
    }
    rg_result result = RG_OK;
    if (count) result = rgi_allocate(&frame->memory, count, sizeof *u->objects, "updating a frame", &u->objects);
    if (result) return result;
    if (linears) result = rgi_allocate(&frame->memory, linears, sizeof *u->linears, "updating a frame", &u->linears);
    if (result) {
        rgi_release(&frame->memory, u->objects, count, sizeof *u->objects);
        u->objects = NULL;
        return result;
    }
    u->count = count;
    u->linear_count = linears;
    return RG_OK;
}

/* All but its place: that is the leader's, whose rebuild may be writing it. */
static void copy_object(const rgi_object *from, rgi_object *to) {
    memset(to, 0, sizeof *to);
    to->linear = from->linear;
    to->generation = from->generation;
    to->shape = from->shape;
    memcpy(to->position, from->position, sizeof to->position);
    to->reach = from->reach;
    to->mask = from->mask;
    to->grid = from->grid;
}

static void copy_objects(const rg_scene *leader, const rgi_follower *f, update *u) {
    uint32_t linears = 0;
    for (uint64_t i = 0; i < u->count; i++) {
        copy *c = &u->objects[i];
        c->slot = nth_changed(f, i);
        copy_object(rgi_scene_object(leader, c->slot), &c->object);
        c->linear = RGI_NONE;
        if (!c->object.shape) continue;
        rg_shape_retain(c->object.shape);
        if (c->object.linear == RGI_NONE) continue;
        c->linear = linears++;
        u->linears[c->linear] = *rgi_scene_linear(leader, &c->object);
    }
}

static void copy_grids(const rg_scene *leader, update *u) {
    u->grid_places = leader->grid_places;
    for (uint32_t i = 0; i < leader->grid_places; i++) {
        const rgi_grid_place *place = &leader->grids[i];
        u->grids[i].generation = place->generation;
        if (place->grid) u->grids[i].config = place->grid->config;
    }
}

/* The instant that the frame will show: with the leader held as a trace holds it, so that its traces go on. */
static rg_result take(rg_scene *frame, update *u) {
    rgi_follower *f = frame->follows;
    rg_scene *leader = f->leader;
    rgi_frame held;
    memset(u, 0, sizeof *u);
    rgi_scene_begin_read(leader, &held);
    rg_result result = allocate_update(frame, leader, f, u);
    if (!result) {
        copy_objects(leader, f, u);
        u->used = leader->objects.used;
        u->masked = leader->masked;
        u->grids_changed = f->grids;
        if (f->grids) copy_grids(leader, u);
        forget_changes(f);
    }
    rgi_scene_end_read(leader, &held);
    return result;
}

/* ------------------------------------------------------------------------------------------ bringing it in */

static rg_result cover(rg_scene *frame, uint32_t used) {
    rgi_slots *objects = &frame->objects;
    rg_result result = used ? rgi_slots_cover(objects, used - 1) : RG_OK;
    if (result) return result;
    for (; objects->used < used; objects->used++)
        memset(rgi_scene_object(frame, objects->used), 0, sizeof(rgi_object));
    return RG_OK;
}

static bool is_same_object(const rgi_object *a, const rgi_object *b) {
    return a->shape && a->shape == b->shape && a->generation == b->generation && a->grid == b->grid;
}

/* What is not there any more, or is another object now, goes first: grids can only be dropped empty. */
static void remove_gone(rg_scene *frame, const update *u, rg_shape **gone) {
    for (uint64_t i = 0; i < u->count; i++) {
        const copy *c = &u->objects[i];
        if (c->slot >= frame->objects.used) continue;
        rgi_object *mine = rgi_scene_object(frame, c->slot);
        if (!mine->shape || is_same_object(mine, &c->object)) continue;
        rgi_any_grid_remove(frame->grids[mine->grid].grid, frame, c->slot);
        rgi_shape_put_aside(rgi_clear_object(frame, c->slot), gone);
    }
}

static rg_result follow_grid(rg_scene *frame, const grid_copy *g, uint32_t i) {
    rgi_grid_place *place = &frame->grids[i];
    rg_result result = RG_OK;
    bool wanted = g->config.size != 0;
    if (place->grid && (!wanted || place->generation != g->generation)) rgi_scene_drop_grid(frame, i);
    if (wanted && !place->grid)
        result = rgi_scene_put_grid(frame, &g->config, i);
    else if (wanted && memcmp(&place->grid->config, &g->config, sizeof g->config) != 0)
        result = rgi_any_grid_configure(place->grid, frame, &g->config);
    if (!result) place->generation = g->generation;
    return result;
}

static rg_result follow_grids(rg_scene *frame, const update *u) {
    rg_result result = RG_OK;
    if (!u->grids_changed) return RG_OK;
    rgi_followers_note_grids(frame);
    for (uint32_t i = 0; i < u->grid_places && !result; i++) {
        if (i >= frame->grid_places) memset(&frame->grids[i], 0, sizeof frame->grids[i]);
        if (i >= frame->grid_places) frame->grid_places = i + 1;
        result = follow_grid(frame, &u->grids[i], i);
    }
    return result;
}

static rg_result bring_in(rg_scene *frame, const update *u, const copy *c) {
    const rgi_linear *linear = c->linear == RGI_NONE ? NULL : &u->linears[c->linear];
    rgi_object *mine = rgi_scene_object(frame, c->slot);
    const uint32_t grid = c->object.grid;
    rgi_placing p;
    if (!c->object.shape) {
        mine->generation = c->object.generation;
        return RG_OK;
    }
    rg_result result = rgi_place_with(&c->object, linear, c->object.position, &p);
    if (!result && p.is_linear && (!mine->shape || mine->linear == RGI_NONE))
        result = rgi_slots_reserve(&frame->linears, 1);
    if (result) return result;
    if (mine->shape) {
        result = rgi_any_grid_move(frame->grids[grid].grid, frame, c->slot, &p.bound);
        if (!result) rgi_set_pose(frame, c->slot, &p);
    } else {
        result = rgi_any_grid_insert(frame->grids[grid].grid, frame, c->slot, &p.bound);
        if (!result) {
            mine->generation = c->object.generation;
            rgi_fill_object(frame, c->slot, c->object.shape, &p, c->object.mask, grid);
        }
    }
    if (!result) mine->mask = c->object.mask;
    return result;
}

static rg_result bring_all_in(rg_scene *frame, const update *u) {
    uint64_t changes[RGI_GRIDS] = {0};
    rg_result result = RG_OK;
    for (uint64_t i = 0; i < u->count && !result; i++) {
        result = bring_in(frame, u, &u->objects[i]);
        if (u->objects[i].object.shape) changes[u->objects[i].object.grid]++;
    }
    for (uint32_t i = 0; i < frame->grid_places; i++) {
        if (changes[i]) rgi_any_grid_settle(frame->grids[i].grid, frame, changes[i]);
    }
    return result;
}

/* The objects of one grid at once, their records being filled; `slots` is room for all. */
static rg_result build_grid(rg_scene *frame, const update *u, uint32_t grid, uint32_t *slots) {
    uint64_t count = 0;
    for (uint64_t i = 0; i < u->count; i++) {
        const rgi_object *object = &u->objects[i].object;
        if (object->shape && object->grid == grid) slots[count++] = u->objects[i].slot;
    }
    return count ? rgi_any_grid_fill(frame->grids[grid].grid, frame, slots, count) : RG_OK;
}

/* Into a frame that holds nothing: on failure it is to be freed. */
static rg_result build_all(rg_scene *frame, const update *u) {
    uint32_t *slots;
    rg_result result = rgi_slots_reserve(&frame->linears, u->linear_count);
    if (result || !u->count) return result;
    result = rgi_allocate(&frame->memory, u->count, sizeof *slots, "a frame", &slots);
    if (result) return result;
    for (uint64_t i = 0; i < u->count; i++) {
        const copy *c = &u->objects[i];
        rgi_placing p;
        rgi_scene_object(frame, c->slot)->generation = c->object.generation;
        if (!c->object.shape) continue;
        (void)rgi_place_with(&c->object, c->linear == RGI_NONE ? NULL : &u->linears[c->linear], c->object.position,
                             &p); /* was checked when it came to be there */
        rgi_fill_object(frame, c->slot, c->object.shape, &p, c->object.mask, c->object.grid);
    }
    for (uint32_t i = 0; i < frame->grid_places && !result; i++) {
        if (frame->grids[i].grid) result = build_grid(frame, u, i, slots);
    }
    rgi_release(&frame->memory, slots, u->count, sizeof *slots);
    return result;
}

/* What could not be brought in is taken anew the next time, with all else. */
static void take_all_next_time(rgi_follower *f) {
    rgi_frame held;
    rgi_scene_begin_read(f->leader, &held);
    f->all = f->grids = true;
    rgi_scene_end_read(f->leader, &held);
}

/* `first`: into a frame that holds nothing. */
static rg_result bring_up_to_date(rg_scene *frame, bool first) {
    rg_shape *gone = NULL;
    rgi_frame held;
    update *u;
    rg_result result = rgi_allocate(&frame->memory, 1, sizeof *u, "updating a frame", &u);
    if (result) return result;
    result = take(frame, u);
    if (!result) {
        rgi_scene_hold(frame, &held);
        remove_gone(frame, u, &gone);
        result = follow_grids(frame, u);
        if (!result) result = cover(frame, u->used);
        frame->masked |= u->masked;
        if (!result) result = first ? build_all(frame, u) : bring_all_in(frame, u);
        (void)rgi_scene_end_change(frame, &held, result);
        if (result) take_all_next_time(frame->follows);
        rgi_shapes_destroy(gone);
        free_update(frame, u);
    }
    rgi_release(&frame->memory, u, 1, sizeof *u);
    return result;
}

/* ------------------------------------------------------------------------------------------------ lifetime */

static rg_result begin_to_follow(rg_scene *frame, rg_scene *leader) {
    rgi_follower *f;
    rgi_frame held;
    rg_result result = rgi_allocate(&frame->memory, 1, sizeof *f, "a frame", &f);
    if (result) return result;
    memset(f, 0, sizeof *f);
    f->leader = leader;
    f->memory = &frame->memory;
    f->all = f->grids = true;
    pthread_mutex_init(&f->updating, NULL);
    rgi_scene_hold(leader, &held);
    f->next = leader->followers;
    leader->followers = f;
    (void)rgi_scene_end_change(leader, &held, RG_OK);
    frame->follows = f;
    return RG_OK;
}

void rgi_follower_end(rg_scene *frame) {
    rgi_follower *f = frame->follows;
    rgi_frame held;
    if (!f) return;
    rgi_scene_hold(f->leader, &held);
    rgi_follower **link = &f->leader->followers;
    while (*link != f) link = &(*link)->next;
    *link = f->next;
    (void)rgi_scene_end_change(f->leader, &held, RG_OK);
    pthread_mutex_destroy(&f->updating);
    rgi_release(&frame->memory, f->changed, f->room, sizeof *f->changed);
    rgi_release(&frame->memory, f->marks, f->marks_room, 1);
    rgi_release(&frame->memory, f, 1, sizeof *f);
    frame->follows = NULL;
}

rg_result rg_scene_create_frame(rg_scene *scene, const rg_scene_config *config, rg_scene **out) {
    rg_scene *frame;
    if (!scene || !out) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", scene ? "frame" : "scene");
    if (rgi_scene_inside(scene))
        return rgi_fail(RG_BUSY, "a frame can't be made from inside a callback of its scene");
    rg_result result = rg_scene_create(config, &frame);
    if (result) return result;
    result = begin_to_follow(frame, scene);
    if (!result) result = bring_up_to_date(frame, true);
    if (result) {
        (void)rg_scene_destroy(&frame);
        return result;
    }
    *out = frame;
    return RG_OK;
}

rg_result rg_scene_update_frame(rg_scene *frame) {
    if (!frame) return rgi_fail(RG_INVALID_ARGUMENT, "frame is NULL");
    if (!frame->follows) return rgi_fail(RG_INVALID_ARGUMENT, "the scene is no frame of another");
    if (rgi_scene_inside(frame))
        return rgi_fail(RG_BUSY, "a frame can't be updated from inside a callback of its own");
    pthread_mutex_lock(&frame->follows->updating);
    rg_result result = bring_up_to_date(frame, false);
    pthread_mutex_unlock(&frame->follows->updating);
    return result;
}
