/* SPDX-License-Identifier: MIT */
/* What a lattice is made of, for those that change it: entries, boxes, chains and nodes. */
#ifndef RAYGRID_LIB_LATTICE_PARTS_H
#define RAYGRID_LIB_LATTICE_PARTS_H

#include "lattice.h"
#include "lattice_cell.h"

/** What is stored of an object, and what decides where. */
typedef struct rgi_entry {
    float lo[3], hi[3];
    float centre[3], radius; /* the ball, or the middle of the box */
    float least;             /* width of the smallest cell that it may go down to */
    uint32_t slot;
    bool ball;
} rgi_entry;

/** What is to be stored of an object with these bounds. False: no float can hold them. */
bool rgi_entry_make(const rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound, rgi_entry *e);

/** These read and write a lane of a block; the last one also notes the place in the record of the object. */
void rgi_entry_read(const rgi_block *b, uint32_t lane, rgi_entry *e);
void rgi_entry_write_bounds(rgi_block *b, uint32_t lane, const rgi_entry *e);
void rgi_entry_write(const rgi_lattice *lattice, rgi_ref ref, uint32_t lane, const rgi_entry *e);

/** The radius of a ball as it is stored: wider than the truth, see PAD in lattice_parts.c. */
float rgi_entry_radius(const float centre[3], double radius);
rgi_location *rgi_lattice_place(const rgi_lattice *lattice, uint32_t slot);

/** A record of a kind, or 0 without memory; a block is empty then. */
rgi_ref rgi_lattice_take(rgi_lattice *lattice, uint32_t kind);
void rgi_lattice_give(rgi_lattice *lattice, uint32_t kind, rgi_ref ref);

/** Where the reference to a child, a chain, or the root is. */
rgi_ref *rgi_lattice_holder(rgi_lattice *lattice, uint32_t parent);

/** The box that a node keeps of a child, or that around everything. */
void rgi_lattice_set_box(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]);
void rgi_lattice_clear_box(rgi_lattice *lattice, uint32_t parent);
void rgi_lattice_get_box(const rgi_lattice *lattice, uint32_t parent, float lo[3], float hi[3]);

/** Boxes from `parent` up to the root take a box in, as far as they must. */
void rgi_lattice_grow(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]);

/** The same while other threads do it, too. */
void rgi_lattice_grow_shared(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]);

/** Counts, while other threads do, too, that an object of the chain has moved. Returns whether its box is to be made
 * tight; of many calls one is told so. */
bool rgi_lattice_loosened_shared(rgi_block *first);

/** Boxes of floats. */
void rgi_bounds_unite(float lo[3], float hi[3], const float lo2[3], const float hi2[3]);
void rgi_bounds_empty(float lo[3], float hi[3]);

/** An object of the chain at `parent` has moved within its cell, or is `gone`; `first` is the first block. Makes
 * boxes tight: what is gone leaves more room than what has moved, so it counts for more. */
void rgi_lattice_loosened(rgi_lattice *lattice, uint32_t parent, rgi_block *first, bool gone);

/** Changes the number of objects that the node of `parent` holds itself. */
void rgi_lattice_count_members(rgi_lattice *lattice, uint32_t parent, int change);

/** The cell of a chain or child: that of its octant, of its node, or all space. */
void rgi_lattice_cell_of(const rgi_lattice *lattice, uint32_t parent, float centre[3], float *half);

/** Puts a block at the head of a chain; takes it out. */
void rgi_lattice_link(rgi_lattice *lattice, uint32_t parent, rgi_ref ref);
void rgi_lattice_unlink(rgi_lattice *lattice, rgi_ref ref);

/** The kind of a block. */
uint32_t rgi_block_kind(uint32_t room, bool ball);

/** Adds to a chain. False: no memory, and nothing has changed. */
bool rgi_lattice_add(rgi_lattice *lattice, uint32_t parent, const rgi_entry *e);

/** A node with an empty box for each octant; *index is its number. False: no memory. */
bool rgi_lattice_make_node(rgi_lattice *lattice, const rgi_cell *cell, uint32_t *index);

/** The octant of a node that a point is in. */
uint32_t rgi_node_octant(const rgi_node *n, const float point[3]);

/** Half the width of the largest cell that a child at `parent` may have. */
float rgi_lattice_widest(const rgi_lattice *lattice, uint32_t parent);

/** Makes sure that so many blocks of each kind that is in use can be taken. False: no memory. */
bool rgi_lattice_reserve_blocks(rgi_lattice *lattice, uint32_t count);
bool rgi_is_ball_block(uint32_t kind);
uint32_t rgi_node_number(rgi_ref ref);

/** A chain is parted only if so many of its objects may go down. */
enum { RGI_WORTH_PARTING = 4 };

/** What a chain that may be parted holds. */
typedef struct rgi_survey {
    float lo[3], hi[3]; /* of the centres */
    float largest;      /* of the least cells */
} rgi_survey;

void rgi_survey_begin(rgi_survey *survey);
void rgi_survey_add(rgi_survey *survey, const rgi_entry *entry);

/** The cell in which a chain at `parent` is to be parted; false if it is better left whole. */
bool rgi_lattice_parting_cell(const rgi_lattice *lattice, uint32_t parent, const rgi_survey *survey, rgi_cell *cell);

/** An empty lattice gets its origin at the middle of these bounds, and as unit a power of two near their size. */
void rgi_lattice_make_frame(rgi_lattice *lattice, const rgi_bound *bound);

/** Stores an object in the list of those that no cell holds. RG_OUT_OF_MEMORY. */
rg_result rgi_lattice_insert_unbounded(rgi_lattice *lattice, uint32_t slot);

#endif
