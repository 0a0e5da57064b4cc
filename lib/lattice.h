/* SPDX-License-Identifier: MIT */
/*
 * The loose hierarchical grid: a lattice of cells, each half as wide as the one above it, decides where an object is
 * stored, by its centre and its size; tight boxes around what is stored decide what a ray looks into.
 *
 * All coordinates inside are floats in the frame of the lattice: (world - origin) * scale. What is stored is wider
 * than the truth by more than rounding can make of it, here and in the kernels (lattice_bound says by how much), so
 * rays never pass over what they meet; and whatever a ray meets here is asked in double afterwards. So where an
 * object is stored is a matter of speed only, and no answer depends on it.
 *
 * Nodes have up to 8 children, one an octant of their cell, and keep the children's boxes. A child is a node or a
 * leaf; levels of cells in which nothing parts are skipped. A leaf is a chain of blocks of up to 16 objects, mostly
 * one. An object that is too large for the octants of its node is in a chain of the node's own.
 */
#ifndef RAYGRID_LIB_LATTICE_H
#define RAYGRID_LIB_LATTICE_H

#include "slots.h"

#include <stdbool.h>

/** A reference to a node or a block: 0 is none, else a kind in the upper 3 bits and the index of a record. */
typedef uint32_t rgi_ref;

enum {
    RGI_REF_BITS = 29,
    RGI_REF_NODE = 1,
    RGI_REF_BALLS = 2, /* blocks with room for 4, 8 and 16 balls: kinds 2, 3 and 4 */
    RGI_REF_BOXES = 5, /* and for boxes: kinds 5, 6 and 7 */
    RGI_POOLS = 8,
    RGI_BLOCK = 16, /* objects of the largest block */
    RGI_OCTANTS = 8
};

static inline uint32_t rgi_ref_kind(rgi_ref ref) {
    return ref >> RGI_REF_BITS;
}
static inline uint32_t rgi_ref_index(rgi_ref ref) {
    return ref & ((1u << RGI_REF_BITS) - 1);
}

/** A node. Its children's boxes; an octant without a child has lo = +infinity, hi = -infinity. */
typedef struct rgi_node {
    float lo[3][RGI_OCTANTS], hi[3][RGI_OCTANTS];
    rgi_ref child[RGI_OCTANTS];
    float centre[3], half; /* its cell: so far to each side of the centre */
    rgi_ref own;           /* chain of what is too large for its octants */
    uint32_t parent;       /* its node * 16 + its octant there, or RGI_ROOT */
    uint32_t members;      /* objects in its own chain and in children that are leaves */
    uint8_t nodes;         /* children that are nodes */
    uint8_t stale;         /* changes of children's boxes since its own was made tight */
    uint16_t spare;
} rgi_node;

/** A block: this head, then for each of `room` objects the floats x, y, z, r or lo[3], hi[3], each as an array, and
 *  the slots of the objects. The first `count` are in use. */
typedef struct rgi_block {
    rgi_ref next, previous; /* of the chain */
    uint32_t parent;        /* node * 16 + octant, RGI_OWN for its own chain; or RGI_ROOT */
    uint8_t count;
    uint8_t stale;         /* first of a chain: changes since the box around it was made tight */
    uint16_t length;       /* first of a chain: its blocks, RGI_LONG for that many and more */
    float centre[3], half; /* the cell; half is infinite for the root */
    float lanes[];
} rgi_block;

enum { RGI_LONG = UINT16_MAX };

#define RGI_ROOT UINT32_MAX
enum { RGI_OWN = 8 };

/** Where an object is stored. Records that are stored in a lattice start with it. */
typedef struct rgi_location {
    rgi_ref block; /* or RGI_NONE: in the list of the unbounded, at `lane` */
    uint32_t lane;
} rgi_location;

/** What is known of an object here. */
typedef struct rgi_bound {
    bool ball; /* a sphere; else a box */
    double centre[3], radius;
    double lo[3], hi[3];
} rgi_bound;

typedef struct rgi_lattice {
    rgi_memory *memory;
    rgi_slots *objects;  /* records that start with an rgi_location */
    size_t place_offset; /* of the place in such a record */
    rgi_slots pools[RGI_POOLS];
    rgi_ref root;
    float lo[3], hi[3]; /* holds all that is below the root */
    double origin[3], scale;
    uint64_t count;      /* objects below the root */
    uint32_t *unbounded; /* slots of what no float can hold */
    uint32_t unbounded_count;
    uint64_t unbounded_room;
} rgi_lattice;

void rgi_lattice_init(rgi_lattice *lattice, rgi_memory *memory, rgi_slots *objects, size_t place_offset);
void rgi_lattice_free(rgi_lattice *lattice);

/** Stores an object. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED: nothing has changed. Cost: constant, but for the depth. */
rg_result rgi_lattice_insert(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound);

/**
 * Gives an object new bounds. It can't fail: without memory for a better place it stays where it is stored, and boxes
 * grow around it. (Only from and to the unbounded it may: RG_OUT_OF_MEMORY, nothing has changed.)
 */
rg_result rgi_lattice_move(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound);

void rgi_lattice_remove(rgi_lattice *lattice, uint32_t slot);

/** Whether what has these bounds would be stored in a cell. */
bool rgi_lattice_has_cell(const rgi_lattice *lattice, const rgi_bound *bound);

/** Makes room for so many more that have no cell. */
rg_result rgi_lattice_reserve(rgi_lattice *lattice, uint64_t unbounded);

/** A world box around all that has a cell; lo > hi if there is nothing. */
void rgi_lattice_box(const rgi_lattice *lattice, double lo[3], double hi[3]);

/** Levels of nodes from the root down to the deepest. Cost: linear. */
uint32_t rgi_lattice_levels(const rgi_lattice *lattice);
uint32_t rgi_lattice_nodes(const rgi_lattice *lattice);

static inline rgi_node *rgi_node_at(const rgi_lattice *lattice, uint32_t index) {
    return rgi_slots_at(&lattice->pools[RGI_REF_NODE], index);
}

static inline rgi_block *rgi_block_at(const rgi_lattice *lattice, rgi_ref ref) {
    return rgi_slots_at(&lattice->pools[rgi_ref_kind(ref)], rgi_ref_index(ref));
}

/** Objects that a block of this kind has room for: 4, 8 or 16. */
static inline uint32_t rgi_block_room(uint32_t kind) {
    return 4u << (kind - (kind >= RGI_REF_BOXES ? RGI_REF_BOXES : RGI_REF_BALLS));
}

static inline uint32_t *rgi_block_slots(rgi_block *block, uint32_t kind) {
    return (uint32_t *)(block->lanes + (kind >= RGI_REF_BOXES ? 6 : 4) * rgi_block_room(kind));
}

#endif
