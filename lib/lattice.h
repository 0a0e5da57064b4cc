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

#include "chunks.h"
#include "middle.h"
#include "slots.h"

#include <stdbool.h>

/** A reference to a node or a block in the arena: 0 is none; the highest bit is set for blocks. See rgi_arena. */
typedef uint32_t rgi_ref;

enum {
    /* Kinds of records: nodes, whose references alone have not the highest bit; blocks with room for 4, 8 and 16
     * balls: 4, 8 and 16; and for boxes: 5, 9 and 17. */
    RGI_NODES = 0,
    RGI_SMALLEST = 4,
    RGI_BOXES = 1,
    RGI_KINDS = 18,
    RGI_BLOCK = 16, /* objects of the largest block */
    RGI_OCTANTS = 8
};

static inline bool rgi_is_block(rgi_ref ref) {
    return ref >> 31;
}
static inline bool rgi_is_node(rgi_ref ref) {
    return ref && !rgi_is_block(ref);
}

/** A node. Its children's boxes; an octant without a child has lo = +infinity, hi = -infinity. */
typedef struct rgi_node {
    float lo[3][RGI_OCTANTS], hi[3][RGI_OCTANTS];
    rgi_ref child[RGI_OCTANTS];
    float centre[3], half; /* its cell: so far to each side of the centre */
    rgi_ref own;           /* chain of what is too large for its octants */
    uint32_t parent;       /* the number of its node * 16 + its octant there, or RGI_ROOT */
    uint32_t members;      /* objects in its own chain and in children that are leaves */
    uint8_t nodes;         /* children that are nodes */
    uint8_t stale;         /* changes of children's boxes since its own was made tight */
    uint16_t spare;
} rgi_node;

/**
 * A block: this head, the slots of up to `room` objects, and from rgi_block_lanes on x, y, z, r or lo[3], hi[3] of
 * each, every one an array. The first `count` are in use. All is so aligned that no vector lies across cache lines.
 */
typedef struct rgi_block {
    rgi_ref next, previous; /* of the chain */
    uint32_t parent;        /* node number * 16 + octant, RGI_OWN for its own chain; or RGI_ROOT */
    uint8_t kind;
    uint8_t count;
    uint8_t stale;         /* first of a chain: changes since the box around it was made tight */
    uint8_t length;        /* first of a chain: its blocks, RGI_LONG for that many and more */
    float centre[3], half; /* the cell; half is infinite for the root */
    uint32_t slots[];
} rgi_block;

enum { RGI_LONG = UINT8_MAX };

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

/**
 * Records of several sizes in chunks that never move. A reference has the number of a chunk and the cache line in
 * it. Nodes take 4 lines, so the last two bits of theirs are 0: what is left is the node's number.
 */
typedef struct rgi_arena {
    rgi_chunks chunks;
    struct {
        rgi_ref first;  /* of the list of free records */
        uint32_t count; /* of free records */
        uint32_t used;
    } kinds[RGI_KINDS];
} rgi_arena;

enum { RGI_LINE = 64, RGI_LINE_BITS = 8, RGI_CHUNK_NUMBER_BITS = 21 };

static inline void *rgi_arena_at(const rgi_arena *arena, rgi_ref ref) {
    return arena->chunks.at[ref >> RGI_LINE_BITS & ((1u << RGI_CHUNK_NUMBER_BITS) - 1)] +
           (size_t)(ref & ((1u << RGI_LINE_BITS) - 1)) * RGI_LINE;
}

void rgi_arena_init(rgi_arena *arena, rgi_memory *memory);
void rgi_arena_free(rgi_arena *arena);

/** Makes sure that the next `count` records of a kind can be taken. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED. */
rg_result rgi_arena_reserve(rgi_arena *arena, uint32_t kind, uint32_t count);

/** Takes a record that was reserved, not cleared; gives one back: its first 4 bytes are the list's then. */
rgi_ref rgi_arena_take(rgi_arena *arena, uint32_t kind);
void rgi_arena_give(rgi_arena *arena, uint32_t kind, rgi_ref ref);

typedef struct rgi_lattice {
    rgi_memory *memory;
    const struct rgi_kernels *kernels;
    const rgi_slots *objects; /* rgi_object, by slot: for kernels */
    rgi_slots *places;        /* records that have an rgi_location, by slot */
    size_t place_offset;      /* where such a record has it */
    rgi_arena arena;
    rgi_ref root;
    float lo[3], hi[3];            /* holds all that is below the root */
    double origin[3], scale, unit; /* powers of two: scale * unit = 1 */
    uint64_t count;                /* objects below the root */
    bool boxes;                    /* there have been others than balls */
    bool framed;                   /* the frame was chosen: the first object does not make it */
    uint32_t *unbounded;           /* slots of what no float can hold */
    uint32_t unbounded_count;
    uint64_t unbounded_room;
} rgi_lattice;

/** An empty one. `places` is where each object's place is noted, an rgi_location a slot; NULL: in the objects'
 * records, at an offset. */
void rgi_lattice_init(rgi_lattice *lattice, rgi_memory *memory, rgi_slots *objects, size_t place_offset,
                      rgi_slots *places, const struct rgi_kernels *kernels);
void rgi_lattice_free(rgi_lattice *lattice);

/** Stores an object. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED: nothing has changed. Cost: constant, but for the depth. */
rg_result rgi_lattice_insert(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound);

/** Gives the slot and the bounds of the i-th of many objects. */
typedef void (*rgi_bound_source)(const void *context, uint64_t i, uint32_t *slot, rgi_bound *bound);

/**
 * Chooses the frame of an empty lattice by a sample of bounds, as rgi_lattice_build does. `old`, or NULL: a lattice
 * that holds the objects; then the frame stays for those that are inserted.
 */
void rgi_lattice_choose_frame(rgi_lattice *lattice, rgi_bound_source source, const void *context, uint64_t count,
                              const rgi_lattice *old);

/**
 * Stores many objects in an empty lattice. On failure it is to be freed. RG_OUT_OF_MEMORY, RG_LIMIT_EXCEEDED. Cost:
 * linear, for each object some 100 bytes while it runs.
 */
rg_result rgi_lattice_build(rgi_lattice *lattice, rgi_bound_source source, const void *context, uint64_t count);

/**
 * Gives an object new bounds. Without memory for a better place it stays where it is stored, and boxes grow around
 * it. Only where no cell or block of its can hold it any more it may fail: RG_OUT_OF_MEMORY, nothing has changed.
 */
rg_result rgi_lattice_move(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound);

/** Whether a ball at a world position would be stored in a cell. */
bool rgi_lattice_reaches(const rgi_lattice *lattice, const double position[3], double radius);

/** Asks for the block of an object ahead of a move. */
void rgi_lattice_fetch(const rgi_lattice *lattice, const rgi_location *place);

/**
 * The quick way of a move: gives a ball that has a cell, and keeps its radius, a new centre that the lattice reaches,
 * if it stays in its cell. False: nothing has been done, and rgi_lattice_move is to be called.
 */
bool rgi_lattice_step(rgi_lattice *lattice, const rgi_location *place, const double centre[3], double radius);

/** What rgi_lattice_step_shared did. */
typedef enum rgi_stepped {
    RGI_LEFT,    /* nothing: the object leaves its cell */
    RGI_MOVED,   /* moved it */
    RGI_LOOSENED /* moved it, and rgi_lattice_tighten is to be called for its place when all are done */
} rgi_stepped;

/**
 * As rgi_lattice_step, for several threads at once, each with objects of its own. Boxes only grow meanwhile; nobody
 * else may look at the lattice.
 */
rgi_stepped rgi_lattice_step_shared(rgi_lattice *lattice, const rgi_location *place, const double centre[3],
                                    double radius);
void rgi_lattice_tighten(rgi_lattice *lattice, const rgi_location *place);

void rgi_lattice_remove(rgi_lattice *lattice, uint32_t slot);

/** Whether an object can get these bounds and keep a cell even without memory: others may join the unbounded. */
bool rgi_lattice_has_cell(const rgi_lattice *lattice, const rgi_location *place, const rgi_bound *bound);

/** Makes room for so many more that have no cell. */
rg_result rgi_lattice_reserve(rgi_lattice *lattice, uint64_t unbounded);

/** The middle of what has a cell, but for the spacing. */
rgi_middle rgi_lattice_middle(const rgi_lattice *lattice);

/** The slots of what has a cell, if there are at most so many: how many; else 0. */
uint32_t rgi_lattice_few(const rgi_lattice *lattice, uint32_t *slots, uint32_t most);

/** See rgi_middle: only rays that go together need it. */
float rgi_lattice_spacing(const rgi_lattice *lattice);

/** A world box around all that has a cell; lo > hi if there is nothing. */
void rgi_lattice_box(const rgi_lattice *lattice, double lo[3], double hi[3]);

/** Levels of nodes from the root down to the deepest. Cost: linear. */
uint32_t rgi_lattice_levels(const rgi_lattice *lattice);
uint32_t rgi_lattice_nodes(const rgi_lattice *lattice);

/** A node by its number. */
static inline rgi_node *rgi_node_at(const rgi_lattice *lattice, uint32_t number) {
    return rgi_arena_at(&lattice->arena, number << 2);
}

static inline rgi_block *rgi_block_at(const rgi_lattice *lattice, rgi_ref ref) {
    return rgi_arena_at(&lattice->arena, ref);
}

/** Objects that a block of this kind has room for: 4, 8 or 16. */
static inline uint32_t rgi_block_room(uint32_t kind) {
    return kind & ~(uint32_t)RGI_BOXES;
}

/** Where the arrays begin: at the first line that the slots leave free. */
static inline float *rgi_block_lanes(const rgi_block *block, uint32_t room) {
    return (float *)((char *)block + RGI_LINE + (room / RGI_BLOCK) * RGI_LINE);
}

#endif
