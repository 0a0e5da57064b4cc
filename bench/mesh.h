/* SPDX-License-Identifier: MIT */
/* mesh.h: the mesh that scenes hold instances of. */
#ifndef RAYGRID_BENCH_MESH_H
#define RAYGRID_BENCH_MESH_H

#include "scenes.h"

/** A closed sphere of 20 * 4^levels triangles, radius 1. */
struct bench_mesh *bench_icosphere(int levels);
/** A closed sphere with bumps in the unit cube, of 20 * 4^levels triangles: the power nearest to `triangles`. */
struct bench_mesh *bench_noisy_sphere(uint32_t triangles);

/** Triangles anywhere in the unit cube, no two of which share a vertex. */
struct bench_mesh *bench_soup(uint32_t triangles);

void bench_mesh_destroy(struct bench_mesh *mesh);

#endif
