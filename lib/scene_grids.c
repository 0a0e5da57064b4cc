/* SPDX-License-Identifier: MIT */
#include "any_grid.h"
#include "error.h"
#include "frame.h"
#include "record.h"
#include "struct_size.h"

#include <stddef.h>

enum { REPORT_LEAST = offsetof(rg_grid_report, rebuilding) };

rg_grid rgi_scene_grid_id(const rg_scene *scene, uint32_t index) {
    return scene->grids[index].generation << 8 | index;
}

rg_result rgi_scene_find_grid(const rg_scene *scene, rg_grid id, uint32_t *index) {
    *index = id & (RGI_GRIDS - 1);
    if (*index < scene->grid_places && scene->grids[*index].grid && scene->grids[*index].generation == id >> 8)
        return RG_OK;
    return rgi_fail(RG_INVALID_ID, "grid 0x%x is none of this scene's", id);
}

/* The first place that is free and whose generations are not used up, or RGI_GRIDS. */
static uint32_t free_place(const rg_scene *scene) {
    uint32_t i = 0;
    while (i < scene->grid_places && (scene->grids[i].grid || scene->grids[i].generation == RGI_GENERATIONS)) i++;
    return i;
}

rg_result rgi_scene_put_grid(rg_scene *scene, const rg_grid_config *config, uint32_t index) {
    rgi_any_grid *grid;
    rg_result result = rgi_allocate(&scene->memory, 1, sizeof *grid, "a grid", &grid);
    if (result) return result;
    result = rgi_any_grid_init(grid, scene, index, config, NULL);
    if (result) {
        rgi_release(&scene->memory, grid, 1, sizeof *grid);
        return result;
    }
    if (index == scene->grid_places) scene->grids[scene->grid_places++].generation = index ? 1 : 0;
    scene->grids[index].grid = grid;
    scene->grid_count++;
    return RG_OK;
}

rg_result rgi_scene_add_grid(rg_scene *scene, const rg_grid_config *config, uint32_t *index) {
    *index = free_place(scene);
    if (*index == RGI_GRIDS) return rgi_fail(RG_LIMIT_EXCEEDED, "a scene has %d grids at the most", RGI_GRIDS);
    return rgi_scene_put_grid(scene, config, *index);
}

void rgi_scene_drop_grid(rg_scene *scene, uint32_t index) {
    rgi_any_grid *grid = scene->grids[index].grid;
    if (!grid) return;
    rgi_any_grid_free(grid, scene);
    rgi_release(&scene->memory, grid, 1, sizeof *grid);
    scene->grids[index].grid = NULL;
    scene->grids[index].generation++;
    scene->grid_count--;
}

rg_result rg_grid_create(rg_scene *scene, const rg_grid_config *given, rg_grid *out) {
    rg_grid_config config;
    rgi_frame frame;
    uint32_t index;
    if (!out) return rgi_fail(RG_INVALID_ARGUMENT, "grid is NULL: nowhere to return it");
    rg_result result = rgi_grid_config_read(&config, given);
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_scene_add_grid(scene, &config, &index);
    if (!result) {
        *out = rgi_scene_grid_id(scene, index);
        rgi_followers_note_grids(scene);
        RGI_RECORD(grid, scene, RG_CALL_GRID_CREATE, *out, &config);
    }
    return rgi_scene_end_change(scene, &frame, result);
}

static rg_result destroy(rg_scene *scene, rg_grid id) {
    uint32_t index;
    rg_result result = rgi_scene_find_grid(scene, id, &index);
    if (result) return result;
    if (index == 0) return rgi_fail(RG_BUSY, "the scene's own grid can't be destroyed");
    if (scene->grids[index].grid->count)
        return rgi_fail(RG_BUSY, "grid 0x%x still holds %llu objects", id,
                        (unsigned long long)scene->grids[index].grid->count);
    rgi_scene_drop_grid(scene, index);
    return RG_OK;
}

rg_result rg_grid_destroy(rg_scene *scene, rg_grid id) {
    rgi_frame frame;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = destroy(scene, id);
    if (!result) rgi_followers_note_grids(scene);
    if (!result) RGI_RECORD(grid, scene, RG_CALL_GRID_DESTROY, id, NULL);
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_grid_configure(rg_scene *scene, rg_grid id, const rg_grid_config *given) {
    rg_grid_config config;
    rgi_frame frame;
    uint32_t index;
    rg_result result = rgi_grid_config_read(&config, given);
    if (!result) result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_scene_find_grid(scene, id, &index);
    if (!result) result = rgi_any_grid_configure(scene->grids[index].grid, scene, &config);
    if (!result) rgi_followers_note_grids(scene);
    if (!result) RGI_RECORD(grid, scene, RG_CALL_GRID_CONFIGURE, id, &config);
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_grid_rebuild(rg_scene *scene, rg_grid id) {
    rgi_frame frame;
    uint32_t index;
    rg_result result = rgi_scene_begin_change(scene, &frame);
    if (result) return result;
    result = rgi_scene_find_grid(scene, id, &index);
    if (!result) result = rgi_any_grid_rebuild(scene->grids[index].grid, scene);
    if (!result) RGI_RECORD(grid, scene, RG_CALL_GRID_REBUILD, id, NULL);
    return rgi_scene_end_change(scene, &frame, result);
}

rg_result rg_grid_stats(rg_scene *scene, rg_grid id, rg_grid_report *report) {
    rg_grid_report r;
    rgi_frame frame;
    uint32_t index;
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    rgi_scene_begin_read(scene, &frame);
    rg_result result = rgi_scene_find_grid(scene, id, &index);
    if (!result) rgi_any_grid_report(scene->grids[index].grid, scene, &r);
    rgi_scene_end_read(scene, &frame);
    return result ? result : rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_grid_report");
}
