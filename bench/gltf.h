/* SPDX-License-Identifier: MIT */
/* gltf.h: a glTF file as a scene in the unit cube, at the start of its animation. C++ includes it as C. */
#ifndef RAYGRID_BENCH_GLTF_H
#define RAYGRID_BENCH_GLTF_H

#include "scenes.h"

/** The file that the demo shows. */
const char *bench_gltf_usual(void);

/** Each of its parts is a mesh. NULL, and a message, if the file can't be read. */
struct bench_scene *bench_gltf_scene(const char *path);

/** All its parts are one mesh, of a scene of that name. NULL, and a message, if the file can't be read. */
struct bench_scene *bench_gltf_mesh(const char *path, const char *name);

#endif
