/* SPDX-License-Identifier: MIT */
/*
 * Triangle meshes. Inside a mesh is a tree of boxes with up to 8 children a node; its leaves hold up to 16 triangles
 * over up to 16 vertices, each stored once a leaf. All of it is in floats, in a frame of the mesh, and only passes
 * over triangles that can't be met: which is met where is decided in double, on the vertices as they were given.
 *
 * Where the caller's vertices are floats of common size they are the frame's to the last bit, and nothing else is
 * kept of them. Else the frame holds (vertex - origin) * scale rounded to float, and the vertices are kept in double,
 * or read where the caller has them, if the mesh may borrow them. Leaves know the caller's numbers of their vertices,
 * so that a mesh can be written down and get new vertices.
 */
#ifndef RAYGRID_LIB_MESH_H
#define RAYGRID_LIB_MESH_H

#include "intersect.h"
#include "memory.h"
#include "middle.h"
#include "support.h"
#include "views.h"

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
    uint32_t number;              /* of this leaf in rgi_mesh.numbers */
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
    uint32_t levels; /* nodes and a leaf on the longest way from the root */
    rgi_mesh_ref root;
    uint32_t triangle_count, vertex_count;
    bool soup;                     /* leaves are rgi_soup_leaf */
    bool exact;                    /* the frame's vertices are the caller's to the last bit */
    rg_input3 vertices;            /* else: as they were given, kept or borrowed */
    double (*kept_vertices)[3];    /* those of `vertices`; NULL if they are borrowed, or the frame's are exact */
    uint32_t (*corners)[3];        /* of each triangle of a soup; NULL if borrowed, or triangle i has 3i to 3i+2 */
    rg_input3 lent_corners;        /* those that are borrowed; else not given */
    uint32_t (*numbers)[RGI_LEAF]; /* of the vertices of each leaf; of a soup NULL */
    uint32_t leaf_count;           /* of a soup 0 */
    double lo[3], hi[3];           /* of the triangles: vertices that none uses do not count */
    double origin[3], scale;       /* of the frame; a power of two */
    float pad;                     /* around boxes, in the frame */
    float rounding;                /* what tests in double may be wrong by, in the frame */
    rgi_middle middle;
    rgi_support support; /* of the triangles; the same however the tree was made */
    double cost;         /* of rays in the tree as it was built: see rgi_mesh_fit */
} rgi_mesh;

/** The caller's number of a triangle of a leaf. */
static inline uint32_t rgi_mesh_primitive(const rgi_mesh *mesh, const void *leaf, uint32_t triangle) {
    return mesh->soup ? ((const rgi_soup_leaf *)leaf)->primitive[triangle]
                      : ((const rgi_mesh_leaf *)leaf)->primitive[triangle];
}

/** A corner of a triangle of a soup. Hosts may break the rule that what they lend does not change: nothing beyond the
 * vertices is read all the same. */
static inline uint32_t rgi_mesh_corner(const rgi_mesh *mesh, uint32_t triangle, uint32_t corner) {
    const rg_input3 *lent = &mesh->lent_corners;
    const void *const columns[3] = {lent->x, lent->y, lent->z};
    if (mesh->corners) return mesh->corners[triangle][corner];
    if (!lent->x) return 3 * triangle + corner;
    uint64_t vertex = rgi_read_integer(rgi_record(columns[corner], lent->stride, triangle), lent->type);
    return vertex < mesh->vertex_count ? (uint32_t)vertex : 0;
}

/** The caller's number of a corner of a triangle of a leaf. */
static inline uint32_t rgi_mesh_vertex(const rgi_mesh *mesh, const void *leaf, uint32_t triangle, uint32_t corner) {
    if (!mesh->soup) {
        const rgi_mesh_leaf *l = (const rgi_mesh_leaf *)leaf;
        return mesh->numbers[l->number][l->corner[corner][triangle]];
    }
    return rgi_mesh_corner(mesh, rgi_mesh_primitive(mesh, leaf, triangle), corner);
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

/**
 * Copies the triangles of views of checked types and builds the tree; how NULL: as well as can be, alone. `like`
 * NULL; or a mesh whose triangles are taken in place of those of the views, of which then only the vertices are read.
 * If the views have a `released`, which is not called here, what would be kept is borrowed. On failure all is given
 * back.
 */
rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, const rgi_mesh_making *how,
                          const rgi_mesh *like, rgi_mesh **mesh);

/** New vertices for a mesh that stays as it is: its tree is taken over, unless it has worn out. Of the views the
 * vertices are read, and borrowed as by rgi_mesh_create. The new mesh borrows nothing that the old one has. */
rg_result rgi_mesh_deform(rgi_memory *memory, const rgi_mesh *old, const rgi_mesh_making *how,
                          const rg_mesh_views *views, rgi_mesh **mesh);
void rgi_mesh_destroy(rgi_mesh *mesh);

/** Sets how far the mesh reaches, by what its leaves had of it. */
void rgi_mesh_set_support(rgi_mesh *mesh, const rgi_reaches *reaches);

/** Whether the mesh reads the memory of its caller. */
static inline bool rgi_mesh_borrows(const rgi_mesh *mesh) {
    return mesh->vertices.x != mesh->kept_vertices || mesh->lent_corners.x;
}

/** Copies the vertices, as they were given but for those that no triangle uses and that may be 0 now. */
void rgi_mesh_read_vertices(const rgi_mesh *mesh, double (*vertices)[3]);

/** Copies the vertices' numbers of all triangles in the caller's order. */
void rgi_mesh_read_triangles(const rgi_mesh *mesh, uint32_t (*triangles)[3]);

bool rgi_mesh_intersect(const rgi_mesh *mesh, const rgi_local_ray *ray, rgi_candidate *candidate);

#endif
