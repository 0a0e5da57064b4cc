/* SPDX-License-Identifier: MIT */
/* saved_scene.h: a scene with some of everything, for the tests of snapshots and recordings. A call that fails ends
 * the process. */
#ifndef RAYGRID_TESTS_SAVED_SCENE_H
#define RAYGRID_TESTS_SAVED_SCENE_H

#include "byte_sink.h"

#include <stdbool.h>

enum { SAVED_SHAPES = 9, SAVED_OBJECTS = 60, SAVED_RAYS = 400 };

typedef struct saved_scene {
    rg_scene *scene;
    rg_shape *shapes[SAVED_SHAPES]; /* all kinds; the last two are user-defined, of numbers 0 and 1 */
    rg_shape *forms[2];             /* the mesh with its triangles shared, as it is now and as it will be next */
    rg_grid grid;                   /* a second one, behind a place that is free */
    rg_object objects[SAVED_OBJECTS];
} saved_scene;

/** Shapes, grids, a crowd of objects, some of them gone again. */
void saved_scene_make(saved_scene *s, rg_grid_kind kind, uint32_t workers);
void saved_scene_end(saved_scene *s);

/** Changes of every kind: the same each time it is called for the same `turn`. Returns the number of calls. */
uint64_t saved_scene_change(saved_scene *s, uint32_t turn);

/** Writes a snapshot of any scene with these shapes into an empty sink. */
void saved_scene_save(rg_scene *scene, byte_sink *sink);

/** With callbacks for the user-defined shapes. */
rg_sink saved_scene_sink(byte_sink *sink);
rg_source saved_scene_source(const byte_sink *sink);

/** Some rays' hits. */
void saved_scene_trace(rg_scene *scene, rg_hit hits[SAVED_RAYS]);

#endif
