/* SPDX-License-Identifier: MIT */
/* Triangle meshes: their data, and the tree of boxes that finds the triangles a ray may meet. */
#ifndef RAYGRID_LIB_MESH_H
#define RAYGRID_LIB_MESH_H

#include "intersect.h"
#include "memory.h"

/* A node of the tree. Children of an inner node lie side by side. */
typedef struct rgi_mesh_node {
    double lo[3], hi[3]; /* padded, see rgi_mesh_build */
    uint32_t first;      /* leaf: its first triangle; inner: its first child */
    uint32_t count;      /* leaf: its triangles; inner: 0 */
} rgi_mesh_node;

/** Longest way from the root to a leaf. */
enum { RGI_MESH_DEPTH = 80 };

typedef struct rgi_mesh {
    rgi_memory *memory;
    double (*vertices)[3];
    uint32_t vertex_count;
    uint32_t triangle_count;
    uint32_t (*triangles)[3]; /* vertex indices, in the order of the leaves */
    uint32_t *primitives;     /* the caller's number of each */
    rgi_mesh_node *nodes;
    uint32_t node_count;
    uint32_t node_room;
    double lo[3], hi[3];
} rgi_mesh;

/** Copies the triangles of checked views and builds the tree. On failure all is given back. */
rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, rgi_mesh **mesh);
void rgi_mesh_destroy(rgi_mesh *mesh);

/** Makes nodes, triangles and primitives for the vertices and triangles given in the caller's order. */
rg_result rgi_mesh_build(rgi_mesh *mesh);

/** Copies the mesh as it was given: all vertices, and the vertices of all triangles, in the caller's order. */
void rgi_mesh_read(const rgi_mesh *mesh, double (*vertices)[3], uint32_t (*triangles)[3]);

bool rgi_mesh_intersect(const rgi_mesh *mesh, const rgi_local_ray *ray, rgi_candidate *candidate);

#endif
