/* SPDX-License-Identifier: MIT */
/* How the tree of a mesh is made: first a binary one, then wide nodes and leaves out of it. */
#ifndef RAYGRID_LIB_MESH_BUILD_H
#define RAYGRID_LIB_MESH_BUILD_H

#include "mesh.h"
#include "pool.h"

#include <math.h>
#include <string.h>

/** Eight floats: lo[3], a number, -hi[3], another. So one minimum each grows a box. */
typedef struct rgi_wrap {
    float least[8];
} rgi_wrap;

/** A triangle or leaf while the tree is built: its box, and in least[3], as bits, its number. */
typedef rgi_wrap rgi_item;

/**
 * A binary node over `count` items from `first` on.
 *
 * cost[i - 1]: what it costs at the least to hang the subtree in i places of a wide node or fewer, relative to one
 * wide node tested for each ray (the surface area heuristic); places[i - 1]: how many of them the left child then
 * gets, 0: as with one place fewer. With one place it becomes a wide node, whose 8 are shared as `opened` says, or if
 * that is 0 a leaf.
 */
typedef struct rgi_branch {
    rgi_wrap box;
    uint32_t first, count;
    uint32_t children; /* the number of the left one, the right one follows; 0: has none and is a leaf */
    float cost[RGI_CHILDREN - 1];
    uint8_t places[RGI_CHILDREN - 1];
    uint8_t opened;
} rgi_branch;

enum { RGI_BINS = 16, RGI_FEW_ITEMS = 64 };

/** Where items are parted. */
typedef struct rgi_cut {
    int axis; /* -1: nowhere */
    int bin;  /* the first of the right side */
    float cost;
} rgi_cut;

static inline int rgi_bin_of(float c, float lo, float scale) {
    return (int)((c - lo) * scale);
}

/** Triangles that are one leaf; of a soup only which they are. */
typedef struct rgi_run {
    uint32_t first, count, vertices;
    uint32_t numbers[RGI_LEAF];
    uint8_t corner[3][RGI_LEAF];
} rgi_run;

/** What a tree is made from, and on the way. */
typedef struct rgi_making {
    rgi_mesh *mesh;
    uint32_t (*triangles)[3]; /* vertices by the caller's numbers */
    bool in_order;            /* of a soup: triangle i has the vertices 3i to 3i+2 */
    float (*at)[4];           /* vertices in the frame, and a 0 */
    rgi_item *items;
    rgi_item *spare; /* room for as many */
    uint32_t item_count;
    rgi_branch *branches; /* room for 2 an item: what is not used is never touched */
    uint32_t used;        /* atomic: branches */
    uint32_t fill;        /* triangles that a leaf holds as a rule */
    bool fast;            /* built in a hurry: items are whole leaves, see mesh_runs.c */
    uint32_t *order;      /* then: the triangles along a curve, */
    rgi_run *runs;        /* and what each leaf has of it */
    uint32_t run_room;
    rgi_pool *pool; /* who helps */
} rgi_making;

/** A corner of a triangle, in the frame. */
static inline const float *rgi_corner(const rgi_making *m, uint32_t triangle, uint32_t corner) {
    return m->at[m->in_order ? 3 * triangle + corner : m->triangles[triangle][corner]];
}

/** Asks for the vertices of a run, so that they are there when they are read. */
static inline void rgi_run_fetch(const rgi_making *m, const rgi_run *run) {
    for (uint32_t k = 0; k < run->count && m->mesh->soup; k++)
        __builtin_prefetch(rgi_corner(m, m->order[run->first + k], 0));
    for (uint32_t k = 0; k < run->vertices; k++) __builtin_prefetch(m->at[run->numbers[k]]);
}

/** RG_INVALID_VALUE if a vertex is not finite or too large; *floats: whether all are floats, of whatever type. */
rg_result rgi_mesh_check(const rg_mesh_views *views, bool *floats);

/** Whether the frame can be that of the vertices, if they are floats: by the box of the mesh. */
bool rgi_mesh_fits_floats(const rgi_mesh *mesh);

/** The triangles, those of `like` if it is not NULL, and the box around them. RG_INVALID_VALUE, RG_OUT_OF_MEMORY. */
rg_result rgi_triangles_copy(rgi_making *making, const rg_mesh_views *views, const rgi_mesh *like);

/** Room for the vertices in double, or where the caller has them if they are borrowed. RG_OUT_OF_MEMORY. */
rg_result rgi_vertices_keep(rgi_mesh *mesh, const rg_mesh_views *views);

/** The vertices, into the frame and, if they are kept, into the mesh. */
void rgi_vertices_copy(rgi_making *making, const rg_mesh_views *views);

/**
 * Numbers the vertices of the triangles of items from 0 on, in the order in which they come, and says which are whose
 * corners. Returns their number, numbers[] being theirs; more than a leaf holds: it has been ended there.
 */
uint32_t rgi_corners_number(const rgi_making *making, const rgi_item *items, uint32_t count,
                            uint32_t numbers[RGI_LEAF], uint8_t corner[3][RGI_LEAF]);

/** Sets origin, scale, pads and middle of the frame for the box of the mesh. */
void rgi_mesh_set_frame(rgi_mesh *mesh);

/** Makes an item of each triangle. RG_OUT_OF_MEMORY, as those that follow. */
rg_result rgi_items_make(rgi_making *making);

/** In a hurry: makes leaves at once, and an item of each. */
rg_result rgi_runs_make(rgi_making *making);
void rgi_runs_free(rgi_making *making);

/** Makes branches over the items. */
rg_result rgi_branches_make(rgi_making *making);

/** Makes lines, leaves, their numbers and root out of the branches. */
rg_result rgi_lines_make(const rgi_making *making);

/** The number of an item. */
static inline uint32_t rgi_item_number(const rgi_item *item) {
    uint32_t number;
    memcpy(&number, &item->least[3], sizeof number);
    return number;
}

static inline void rgi_wrap_empty(rgi_wrap *w) {
    for (int i = 0; i < 8; i++) w->least[i] = (float)INFINITY;
}

static inline void rgi_wrap_grow(rgi_wrap *w, const rgi_wrap *other) {
    for (int i = 0; i < 8; i++) w->least[i] = other->least[i] < w->least[i] ? other->least[i] : w->least[i];
}

static inline float rgi_wrap_half_area(const rgi_wrap *w) {
    float x = -w->least[4] - w->least[0], y = -w->least[5] - w->least[1], z = -w->least[6] - w->least[2];
    return x * y + y * z + z * x;
}

#endif
