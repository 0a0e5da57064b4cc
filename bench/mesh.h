/* SPDX-License-Identifier: MIT */
/* mesh.h: meshes that scenes consist of or hold instances of. */
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

/** A mesh in the unit cube that changes its form, all vertices at once. */
struct bench_bend {
    struct bench_mesh *mesh;
    float *home; /* the vertices as they were at first */
    int forms;   /* new ones so far */
};

struct bench_bend bench_bend_create(struct bench_mesh *mesh);

/** Gives the mesh its next form: waves of a hundredth of the cube wander through. */
void bench_bend_next(struct bench_bend *bend);

void bench_bend_destroy(struct bench_bend *bend);

#endif
