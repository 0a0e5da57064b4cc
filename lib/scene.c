/* SPDX-License-Identifier: MIT */
#include "any_grid.h"

#include "error.h"
#include "frame.h"
#include "rebuild.h"
#include "record.h"
#include "struct_size.h"

#include <stddef.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    MAX_WORKERS = 1024,
    CONFIG_LEAST = offsetof(rg_scene_config, memory_limit),
    REPORT_LEAST = offsetof(rg_scene_report, isa)
};

/* ------------------------------------------------------------------------------------------------ the lock */

static __thread rgi_frame *innermost;

bool rgi_scene_inside(const rg_scene *scene) {
    for (const rgi_frame *f = innermost; f; f = f->outer) {
        if (f->scene == scene) return true;
    }
    return false;
}

static void push(rgi_frame *frame, const rg_scene *scene) {
    frame->scene = scene;
    frame->outer = innermost;
    frame->locked = false;
    innermost = frame;
}

static void pop(rgi_frame *frame) {
    innermost = frame->outer;
}

void rgi_scene_begin_read(rg_scene *scene, rgi_frame *frame) {
    bool inside = innermost && rgi_scene_inside(scene);
    if (!inside) rgi_lock_read(&scene->lock);
    push(frame, scene);
    frame->locked = !inside;
}

void rgi_scene_end_read(rg_scene *scene, rgi_frame *frame) {
    pop(frame);
    if (frame->locked) rgi_lock_leave_read(&scene->lock);
}

void rgi_scene_hold(rg_scene *scene, rgi_frame *frame) {
    rgi_lock_write(&scene->lock);
    push(frame, scene);
}

rg_result rgi_scene_begin_change(rg_scene *scene, rgi_frame *frame) {
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    if (innermost && rgi_scene_inside(scene))
        return rgi_fail(RG_BUSY, "a scene can't be changed from inside a callback of its own");
    if (scene->follows) return rgi_fail(RG_BUSY, "a frame of a scene is only changed by its updates");
    rgi_scene_hold(scene, frame);
    return RG_OK;
}

rg_result rgi_scene_end_change(rg_scene *scene, rgi_frame *frame, rg_result result) {
    pop(frame);
    rgi_lock_leave_write(&scene->lock);
    return result;
}

/* ------------------------------------------------------------------------------------------------ lifetime */

static const rg_scene_config default_config = {
    sizeof(rg_scene_config), 0, 0, {NULL, NULL, NULL}, NULL, NULL, NULL, NULL, NULL, 0};

rg_result rg_scene_config_default(rg_scene_config *config, size_t size) {
    return rgi_struct_default(&default_config, sizeof default_config, CONFIG_LEAST, config, size, "rg_scene_config");
}

rg_result rgi_scene_config_read(rg_scene_config *config, const rg_scene_config *given) {
    return rgi_struct_read(config, sizeof *config, CONFIG_LEAST, given, "rg_scene_config");
}

static uint32_t processors(void) {
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > MAX_WORKERS ? MAX_WORKERS : (uint32_t)n;
}

static void scene_free(rg_scene *scene) {
    rgi_follower_end(scene);
    rgi_pool_destroy(scene->pool);
    for (uint32_t i = 0; i < scene->objects.used; i++) rg_shape_release(&rgi_scene_object(scene, i)->shape);
    for (uint32_t i = 0; i < scene->grid_places; i++) rgi_scene_drop_grid(scene, i);
    rgi_slots_free(&scene->objects);
    rgi_slots_free(&scene->linears);
    rgi_lock_destroy(&scene->lock);
    rgi_memory memory = scene->memory;
    rgi_release(&memory, scene, 1, sizeof *scene);
}

static rg_result check_config(const rg_scene_config *config, rg_grid_config *grid) {
    if (config->workers > MAX_WORKERS)
        return rgi_fail(RG_INVALID_VALUE, "workers is %u, above %d", config->workers, MAX_WORKERS);
    if (config->reserved != 0)
        return rgi_fail(RG_INVALID_ARGUMENT, "rg_scene_config.reserved is %u, not 0", config->reserved);
    return rgi_grid_config_read(grid, config->grid);
}

rg_result rg_scene_create(const rg_scene_config *given, rg_scene **out) {
    rg_scene_config config;
    rg_grid_config grid;
    rgi_memory memory;
    rg_scene *scene;
    uint32_t index;
    if (!out) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL: nowhere to return it");
    rg_result result = rgi_scene_config_read(&config, given);
    if (!result) result = check_config(&config, &grid);
    if (!result) result = rgi_memory_init(&memory, &config.allocator);
    if (!result && config.memory_limit) memory.limit = config.memory_limit;
    if (!result) result = rgi_allocate(&memory, 1, sizeof *scene, "a scene", &scene);
    if (result) return result;
    memset(scene, 0, sizeof *scene);
    scene->memory = memory;
    scene->log = config.log;
    scene->log_user = config.log_user;
    scene->kernels = rgi_kernels_best();
    rgi_lock_init(&scene->lock);
    rgi_slots_init(&scene->objects, &scene->memory, sizeof(rgi_object), "objects");
    rgi_slots_init(&scene->linears, &scene->memory, sizeof(rgi_linear), "poses");
    result = rgi_scene_add_grid(scene, &grid, &index);
    if (!result)
        result = rgi_pool_create(&scene->memory, config.workers ? config.workers : processors(), config.parallel_for,
                                 config.parallel_for_user, &scene->pool);
    if (result) {
        scene_free(scene);
        return result;
    }
    rgi_pool_set_spare_work(scene->pool, rgi_rebuild_work, scene);
    *out = scene;
    return RG_OK;
}

/* Waits for calls that began before: those that wait for the lock, and traces between two groups of rays. Returns
 * whether there are no frames that still need the scene. */
static bool wait_for_calls(rg_scene *scene) {
    const struct timespec briefly = {0, 50000};
    rgi_lock_write(&scene->lock);
    while (rgi_lock_has_waiting(&scene->lock) || __atomic_load_n(&scene->running, __ATOMIC_ACQUIRE)) {
        rgi_lock_leave_write(&scene->lock);
        nanosleep(&briefly, NULL);
        rgi_lock_write(&scene->lock);
    }
    bool free = !scene->followers;
    rgi_lock_leave_write(&scene->lock);
    return free;
}

rg_result rg_scene_destroy(rg_scene **pointer) {
    if (!pointer || !*pointer) return RG_OK;
    if (rgi_scene_inside(*pointer))
        return rgi_fail(RG_BUSY, "a scene can't be destroyed from inside a callback of its own");
    rg_scene *scene = *pointer;
    if (!wait_for_calls(scene)) return rgi_fail(RG_BUSY, "a scene can't be destroyed before its frames");
    *pointer = NULL;
    rgi_fail_quietly(true);
    (void)rg_scene_record(scene, NULL);
    rgi_fail_quietly(false);
    scene_free(scene);
    return RG_OK;
}

static uint32_t left_out(const rg_scene *scene) {
    uint32_t with = 0, holding = 0;
    for (uint32_t i = 0; i < scene->grid_places; i++) {
        const rgi_any_grid *grid = scene->grids[i].grid;
        if (!grid || !grid->count) continue;
        holding++;
        with |= rgi_any_grid_uses(grid);
    }
    if (holding > 1) with |= RG_WITHOUT_GRIDS;
    if (scene->masked) with |= RG_WITHOUT_MASKS;
    if (rgi_pool_workers(scene->pool) != 1) with |= RG_WITHOUT_THREADS;
    return ~with & (2 * RG_WITHOUT_THREADS - 1);
}

rg_result rg_scene_stats(rg_scene *scene, rg_scene_report *report) {
    rg_scene_report r;
    rgi_frame frame;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    memset(&r, 0, sizeof r);
    rgi_scene_begin_read(scene, &frame);
    r.objects = scene->object_count;
    r.slots = scene->objects.used;
    r.bytes = __atomic_load_n(&scene->memory.bytes, __ATOMIC_RELAXED);
    r.invalid_rays = __atomic_load_n(&scene->invalid_rays, __ATOMIC_RELAXED);
    r.workers = rgi_pool_workers(scene->pool);
    r.grids = scene->grid_count;
    r.isa = scene->kernels->isa;
    r.left_out = left_out(scene);
    rgi_scene_end_read(scene, &frame);
    return rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_scene_report");
}
