/* SPDX-License-Identifier: MIT */
/* One shape in place of another: what there is to it besides raygrid/scene.h. */
#ifndef RAYGRID_LIB_SCENE_SHAPES_H
#define RAYGRID_LIB_SCENE_SHAPES_H

#include <raygrid/scene.h>

/** The objects that a replacement was about. */
typedef struct rgi_replaced {
    rg_object first; /* of the lowest slot; RG_NO_OBJECT: none had the shape */
    uint64_t count;
} rgi_replaced;

/** rg_scene_replace_shape, which also tells whom it was about. */
rg_result rgi_replace_shape(rg_scene *scene, rg_shape *from, rg_shape *to, rgi_replaced *what);

#endif
