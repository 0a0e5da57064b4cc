/* SPDX-License-Identifier: MIT */
/* mesh.h: the mesh that scenes hold instances of. */
#ifndef RAYGRID_BENCH_MESH_H
#define RAYGRID_BENCH_MESH_H

#include "scenes.h"

/** A closed sphere of 20 * 4^levels triangles, radius 1. */
struct bench_mesh *bench_icosphere(int levels);
void bench_mesh_destroy(struct bench_mesh *mesh);

#endif
