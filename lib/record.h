/* SPDX-License-Identifier: MIT */
/*
 * Recording: each entry point that changes a scene notes what it has done, once it has succeeded, with the scene
 * still held. Nobody recording, that is one branch.
 */
#ifndef RAYGRID_LIB_RECORD_H
#define RAYGRID_LIB_RECORD_H

#include "scene.h"

#include <raygrid/record.h>

void rgi_record_insert(rg_scene *scene, rg_object object, const rg_pose *pose);
void rgi_record_insert_many(rg_scene *scene, const rg_insert_views *views, uint64_t count, const rg_object *objects);
void rgi_record_move(rg_scene *scene, rg_object object, const rg_pose *pose);
void rgi_record_move_to(rg_scene *scene, rg_object object, const double position[3]);
void rgi_record_move_many(rg_scene *scene, const rg_input *objects, const rg_pose_views *poses, uint64_t count);
void rgi_record_mask(rg_scene *scene, rg_object object, uint32_t mask);
void rgi_record_remove(rg_scene *scene, rg_object object);
void rgi_record_remove_many(rg_scene *scene, const rg_input *objects, uint64_t count);

/** RG_CALL_GRID_CREATE, _DESTROY, _CONFIGURE, _REBUILD; `config` for the first and third. */
void rgi_record_grid(rg_scene *scene, rg_call call, rg_grid grid, const rg_grid_config *config);

/** `from` in all `count` objects that had it, `object` the first of them. */
void rgi_record_replace(rg_scene *scene, rg_shape *from, rg_object object, uint64_t count);

/** In an entry point: `if (!result) RGI_RECORD(insert, scene, id, pose);` */
#define RGI_RECORD(what, scene, ...)                                                                                 \
    do {                                                                                                             \
        if (__builtin_expect((scene)->recorder != NULL, 0)) rgi_record_##what(scene, __VA_ARGS__);                   \
    } while (0)

#endif
