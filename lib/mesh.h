/* SPDX-License-Identifier: MIT */
/*
 * Triangle meshes. Inside a mesh is a tree of boxes with up to 8 children a node; its leaves hold up to 16 triangles
 * over up to 16 vertices, each stored once a leaf. All of it is in floats, in a frame of the mesh, and only passes
 * over triangles that can't be met: which is met where is decided in double, on the vertices as they were given.
 *
 * Where the caller's vertices are floats of common size they are the frame's to the last bit, and nothing else is
 * kept of them. Else the frame holds (vertex - origin) * scale rounded to float, and the vertices are kept in double.
 */
#ifndef RAYGRID_LIB_MESH_H
#define RAYGRID_LIB_MESH_H

#include "intersect.h"
#include "memory.h"
#include "middle.h"

struct rgi_kernels;

enum { RGI_CHILDREN = 8, RGI_LEAF = 16, RGI_SOUP_LEAF = 8, RGI_MESH_LINE = 64 };

/** A node or a leaf by the cache line where it begins; leaves have the highest bit set. */
typedef uint32_t rgi_mesh_ref;
#define RGI_MESH_LEAF 0x80000000u

/** Children's boxes, with a pad around them; where there is none lo = +infinity, hi = -infinity. A child's number is,
 * as far as that goes, its octant of the node: bit a is set for the upper side along axis a. */
typedef struct rgi_mesh_node {
    float lo[3][RGI_CHILDREN], hi[3][RGI_CHILDREN];
    rgi_mesh_ref child[RGI_CHILDREN];
    uint32_t spare[8];
} rgi_mesh_node;

/** Lanes that are not used repeat the first vertex, so triangles of them have no area. */
typedef struct rgi_mesh_leaf {
    float at[3][RGI_LEAF];        /* vertices, in the frame */
    uint8_t corner[3][RGI_LEAF];  /* of each triangle */
    uint32_t primitive[RGI_LEAF]; /* the caller's number of each */
    uint32_t number;              /* of this leaf among all */
    float longest;                /* no triangle's corners are farther apart along an axis */
    uint16_t triangles, vertices;
    uint32_t spare;
} rgi_mesh_leaf;

/** The leaf of a soup, a mesh whose triangles share hardly any vertices. What is not used is NaN, with the number
 * RGI_NO_TRIANGLE. */
typedef struct rgi_soup_leaf {
    float at[3][3][RGI_SOUP_LEAF]; /* corner, axis, triangle */
    uint32_t primitive[RGI_SOUP_LEAF];
} rgi_soup_leaf;

#define RGI_NO_TRIANGLE UINT32_MAX

typedef struct rgi_mesh {
    rgi_memory *memory;
    const struct rgi_kernels *kernels;
    char *lines; /* all nodes and leaves */
    uint32_t line_count;
    rgi_mesh_ref root;
    uint32_t triangle_count, vertex_count;
    bool soup;               /* leaves are rgi_soup_leaf */
    double (*vertices)[3];   /* in double; NULL where the frame's are exact */
    uint32_t (*corners)[3];  /* of each triangle, where the vertices are kept */
    double lo[3], hi[3];     /* of the triangles: vertices that none uses do not count */
    double origin[3], scale; /* of the frame; a power of two */
    float pad;               /* around boxes, in the frame */
    float rounding;          /* what tests in double may be wrong by, in the frame */
    rgi_middle middle;
    double cost; /* of rays in the tree as it was built: see rgi_mesh_fit */
} rgi_mesh;

/** The caller's number of a triangle of a leaf. */
static inline uint32_t rgi_mesh_primitive(const rgi_mesh *mesh, const void *leaf, uint32_t triangle) {
    return mesh->soup ? ((const rgi_soup_leaf *)leaf)->primitive[triangle]
                      : ((const rgi_mesh_leaf *)leaf)->primitive[triangle];
}

static inline void *rgi_mesh_at(const rgi_mesh *mesh, rgi_mesh_ref ref) {
    return mesh->lines + (size_t)(ref & ~RGI_MESH_LEAF) * RGI_MESH_LINE;
}

/** How a mesh is made. */
typedef struct rgi_mesh_making {
    bool fast;
    uint32_t workers; /* 0: one */
    rg_parallel_for parallel_for;
    void *parallel_for_user;
} rgi_mesh_making;

/** Copies the triangles of views of checked types and builds the tree; how NULL: as well as can be, alone. On failure
 * all is given back. */
rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, const rgi_mesh_making *how,
                          rgi_mesh **mesh);

/** The same for new vertices of a mesh that stays as it is: its tree is taken over, unless it has worn out. */
rg_result rgi_mesh_deform(rgi_memory *memory, const rgi_mesh *old, const rgi_mesh_making *how,
                          const rg_mesh_views *views, rgi_mesh **mesh);
void rgi_mesh_destroy(rgi_mesh *mesh);

/**
 * Copies the mesh: its vertices, rgi_mesh_read_vertices of them, and the vertices of all triangles in the caller's
 * order. Of a mesh that keeps no vertices each triangle gets three of its own: what rays meet is the same.
 */
void rgi_mesh_read(const rgi_mesh *mesh, double (*vertices)[3], uint32_t (*triangles)[3]);
uint64_t rgi_mesh_read_vertices(const rgi_mesh *mesh);

bool rgi_mesh_intersect(const rgi_mesh *mesh, const rgi_local_ray *ray, rgi_candidate *candidate);

#endif
