/* SPDX-License-Identifier: MIT */
/* gltf.h: a glTF file as a scene: each of its parts is a mesh, all in the unit cube. C++ includes it as C. */
#ifndef RAYGRID_BENCH_GLTF_H
#define RAYGRID_BENCH_GLTF_H

#include "scenes.h"

/** The file that the demo shows. */
const char *bench_gltf_usual(void);

/** At the start of its animation. NULL, and a message, if the file can't be read. */
struct bench_scene *bench_gltf_scene(const char *path);
#endif
