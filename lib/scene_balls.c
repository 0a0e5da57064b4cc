/* SPDX-License-Identifier: MIT */
/*
 * Moving many balls of lattices, the most common of all changes: what can't fail needs no memory and no second look.
 * Large calls are shared out among the workers: each moves the balls that stay in their cells, whose lanes are
 * theirs, and boxes grow by atomic operations; the few that leave their cells follow one by one.
 */
#include "any_grid.h"
#include "error.h"
#include "frame.h"
#include "scene_objects.h"
#include "vec.h"
#include "views.h"

#include <string.h>

/** A call. */
typedef struct moves {
    rg_scene *scene;
    const rg_input *objects;
    const rg_pose_views *poses;
    uint64_t count;
    rgi_touched touched;
    /* While it is shared out: */
    uint32_t failed; /* atomic: an object is not quick to move, or given twice */
    uint16_t
        *left; /* of each tile, RGI_TILE numbers of its moves: those that leave their cells from the front on, and */
    uint16_t *counts; /* those whose boxes are loose from the back on; how many of each */
} moves;

static uint32_t slot_of(const moves *m, uint64_t i) {
    return RG_OBJECT_SLOT(rgi_load_integer(m->objects, i, 0));
}

/* Whether a move can't fail. An id that is none of the scene's says no, too: the long way finds it again and names
 * it. */
static bool is_quick(const moves *m, uint64_t i) {
    const rg_scene *scene = m->scene;
    rg_object id = rgi_load_integer(m->objects, i, 0);
    uint32_t slot = RG_OBJECT_SLOT(id);
    double position[3];
    if (slot >= scene->objects.used) return false;
    const rgi_object *object = rgi_scene_object(scene, slot);
    rgi_load3(&m->poses->position, i, position);
    return object->shape && object->generation == id >> 32 && rgi_is_quick(scene, slot, position);
}

static void fetch_object(const moves *m, uint64_t i) {
    if (i < m->count) rgi_fetch_object(m->scene, rgi_load_integer(m->objects, i, 0));
}

static void fetch_place(const moves *m, uint64_t i) {
    if (i < m->count) rgi_fetch_place(m->scene, rgi_load_integer(m->objects, i, 0));
}

/* Out of its cell. */
static void move_far(const moves *m, uint64_t i) {
    uint32_t slot = slot_of(m, i);
    double position[3];
    rgi_placing p;
    rgi_load3(&m->poses->position, i, position);
    (void)rgi_place_at(m->scene, rgi_scene_object(m->scene, slot), position, &p);
    (void)rgi_move_one(m->scene, slot, &p);
}

/* ---------------------------------------------------------------------------------------------- one by one */

static bool are_quick(const moves *m) {
    for (uint64_t i = 0; i < m->count; i++) {
        fetch_object(m, i + RGI_AHEAD);
        if (!is_quick(m, i)) return false;
    }
    return true;
}

static void move_in_order(moves *m) {
    for (uint64_t i = 0; i < m->count; i++) {
        uint32_t slot = slot_of(m, i);
        double position[3];
        fetch_object(m, i + 2 * RGI_AHEAD);
        fetch_place(m, i + RGI_AHEAD);
        rgi_load3(&m->poses->position, i, position);
        rgi_touch(&m->touched, rgi_scene_object(m->scene, slot)->grid);
        if (!rgi_step(m->scene, slot, position)) move_far(m, i);
    }
}

/* ------------------------------------------------------------------------------------------------ shared out */

static uint64_t end_of_tile(const moves *m, uint64_t tile) {
    uint64_t end = (tile + 1) * RGI_TILE;
    return end < m->count ? end : m->count;
}

/* Marks the objects: one that is marked already is given twice, and would be moved by two threads. */
static void check_tile(void *context, uint64_t tile) {
    moves *m = context;
    for (uint64_t i = tile * RGI_TILE, end = end_of_tile(m, tile); i < end; i++) {
        fetch_object(m, i + RGI_AHEAD);
        bool quick = is_quick(m, i);
        if (quick) {
            uint32_t *grid = &rgi_scene_object(m->scene, slot_of(m, i))->grid;
            quick = !(__atomic_fetch_or(grid, RGI_MARK, __ATOMIC_RELAXED) & RGI_MARK);
        }
        if (!quick) __atomic_store_n(&m->failed, 1, __ATOMIC_RELAXED);
        if (__atomic_load_n(&m->failed, __ATOMIC_RELAXED)) return;
    }
}

static void move_tile(void *context, uint64_t tile) {
    moves *m = context;
    uint16_t *left = m->left + tile * RGI_TILE;
    uint32_t leaving = 0, loose = 0;
    for (uint64_t first = tile * RGI_TILE, i = first, end = end_of_tile(m, tile); i < end; i++) {
        uint32_t slot = slot_of(m, i);
        rgi_object *object = rgi_scene_object(m->scene, slot);
        double position[3];
        if (i + RGI_AHEAD < end) fetch_place(m, i + RGI_AHEAD);
        object->grid &= RGI_MARK - 1;
        rgi_any_grid *grid = m->scene->grids[object->grid].grid;
        rgi_load3(&m->poses->position, i, position);
        rgi_stepped step = rgi_lattice_step_shared(&grid->lattice, rgi_any_grid_place(grid, m->scene, slot), position,
                                                   object->reach);
        if (step != RGI_LEFT) rgi_copy(position, object->position);
        if (step == RGI_LEFT) left[leaving++] = (uint16_t)(i - first);
        if (step == RGI_LOOSENED) left[RGI_TILE - ++loose] = (uint16_t)(i - first);
    }
    m->counts[2 * tile] = (uint16_t)leaving;
    m->counts[2 * tile + 1] = (uint16_t)loose;
}

/* What the tiles have left over. */
static void finish_tile(moves *m, uint64_t tile) {
    const uint16_t *left = m->left + tile * RGI_TILE;
    for (uint32_t n = 1; n <= m->counts[2 * tile + 1]; n++) {
        uint32_t slot = slot_of(m, tile * RGI_TILE + left[RGI_TILE - n]);
        rgi_any_grid *grid = m->scene->grids[rgi_scene_object(m->scene, slot)->grid].grid;
        rgi_lattice_tighten(&grid->lattice, rgi_any_grid_place(grid, m->scene, slot));
    }
    for (uint32_t n = 0; n < m->counts[2 * tile]; n++) move_far(m, tile * RGI_TILE + left[n]);
}

/* Which objects have moved is noted, and of which grids. */
static void note_all(moves *m) {
    for (uint32_t i = 0; i < m->scene->grid_places; i++) {
        if (m->scene->grids[i].grid && m->scene->grids[i].grid->count) rgi_touch(&m->touched, i);
    }
    for (uint64_t i = 0; i < m->count && m->scene->followers; i++) rgi_scene_changed(m->scene, slot_of(m, i));
}

/* False: nothing has been done. */
static bool move_shared(moves *m) {
    rgi_memory *memory = &m->scene->memory;
    rgi_pool *pool = m->scene->pool;
    uint64_t tiles = (m->count + RGI_TILE - 1) / RGI_TILE;
    rg_result result = rgi_allocate(memory, tiles * RGI_TILE, sizeof *m->left, "moving many objects", &m->left);
    if (result) return false;
    result = rgi_allocate(memory, 2 * tiles, sizeof *m->counts, "moving many objects", &m->counts);
    if (!result) {
        rgi_pool_run(pool, tiles, check_tile, m);
        if (m->failed) {
            rgi_unmark_all(m->scene, m->objects, m->count);
        } else {
            rgi_pool_run(pool, tiles, move_tile, m);
            for (uint64_t tile = 0; tile < tiles; tile++) finish_tile(m, tile);
            note_all(m);
        }
        rgi_release(memory, m->counts, 2 * tiles, sizeof *m->counts);
    }
    rgi_release(memory, m->left, tiles * RGI_TILE, sizeof *m->left);
    return !result && !m->failed;
}

/* Not by the host's own jobs: they may all be waiting for this change to end. */
static bool is_worth_sharing(const moves *m) {
    if (m->count < RGI_WORTH_SHARING || !rgi_pool_has_threads(m->scene->pool)) return false;
    for (uint32_t i = 0; i < m->scene->grid_places; i++) {
        if (m->scene->grids[i].grid && m->scene->grids[i].grid->rebuild) return false;
    }
    return true;
}

bool rgi_move_balls(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count) {
    moves m;
    memset(&m, 0, sizeof m);
    m.scene = scene;
    m.objects = objects;
    m.poses = poses;
    m.count = count;
    if (poses->column[0].x || poses->scale.data) return false;
    rgi_fail_quietly(true);
    bool moved = is_worth_sharing(&m) && move_shared(&m);
    rgi_fail_quietly(false);
    if (!moved) {
        if (!are_quick(&m)) return false;
        move_in_order(&m);
    }
    rgi_settle_touched(scene, &m.touched, count);
    return true;
}
