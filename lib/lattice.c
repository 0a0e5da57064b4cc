/* SPDX-License-Identifier: MIT */
#include "lattice_parts.h"

#include "error.h"
#include "vec.h"

#include <raygrid/shape.h>

#include <string.h>

enum {
    /* A node whose objects, all in leaves, have become so few is made a leaf again. */
    FEW = 8,
    /* Chains of more blocks are not looked through any more to be parted. */
    LONG_TO_PART = 64
};

/* Puts a node between `parent` and the node there, with a cell that also covers the entry. False: it can't be. */
static bool wrap(rgi_lattice *lattice, uint32_t parent, const rgi_entry *e) {
    rgi_ref inner = *rgi_lattice_holder(lattice, parent);
    rgi_node *in = rgi_node_at(lattice, rgi_node_number(inner));
    rgi_cell cell;
    uint32_t index;
    float lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = in->centre[a] < e->centre[a] ? in->centre[a] : e->centre[a];
        hi[a] = in->centre[a] > e->centre[a] ? in->centre[a] : e->centre[a];
    }
    float narrowest = 2 * in->half > 0.5f * e->least ? 2 * in->half : 0.5f * e->least;
    if (!rgi_cell_around(lo, hi, narrowest, rgi_lattice_widest(lattice, parent), &cell)) return false;
    if (!rgi_lattice_make_node(lattice, &cell, &index)) return false;
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = rgi_node_octant(n, in->centre);
    rgi_lattice_get_box(lattice, parent, lo, hi);
    *rgi_lattice_holder(lattice, parent) = index << 2;
    n->parent = parent;
    n->child[lane] = inner;
    n->nodes = 1;
    in->parent = index << 4 | lane;
    rgi_lattice_set_box(lattice, in->parent, lo, hi);
    return true;
}

/* How many objects of a chain may go down into the octants of a cell. */
static uint32_t count_movable(const rgi_lattice *lattice, rgi_ref chain, float half) {
    uint32_t movable = 0;
    rgi_entry e;
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(lattice, ref)->next) {
        rgi_block *b = rgi_block_at(lattice, ref);
        for (uint32_t i = 0; i < b->count; i++) {
            rgi_entry_read(b, i, &e);
            movable += e.least <= half;
        }
    }
    return movable;
}

/* The cell in which the chain at `parent`, with one entry more, is to be parted; false if it is better left whole. */
static bool cell_for_parting(const rgi_lattice *lattice, uint32_t parent, rgi_ref chain, const rgi_entry *more,
                             rgi_cell *cell) {
    rgi_survey s;
    rgi_entry e;
    rgi_survey_begin(&s);
    rgi_survey_add(&s, more);
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(lattice, ref)->next) {
        const rgi_block *b = rgi_block_at(lattice, ref);
        for (uint32_t i = 0; i < b->count; i++) {
            rgi_entry_read(b, i, &e);
            rgi_survey_add(&s, &e);
        }
    }
    return rgi_lattice_parting_cell(lattice, parent, &s, cell) &&
           count_movable(lattice, chain, cell->half) >= RGI_WORTH_PARTING;
}

static void put(rgi_lattice *lattice, uint32_t index, const rgi_entry *e) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = e->least > n->half ? RGI_OWN : rgi_node_octant(n, e->centre);
    (void)rgi_lattice_add(lattice, index << 4 | lane, e);
    rgi_lattice_grow(lattice, index << 4 | lane, e->lo, e->hi);
}

/* Makes the chain at `parent`, which one rgi_entry more would make longer, a node with its objects. */
static bool part(rgi_lattice *lattice, uint32_t parent, const rgi_entry *more) {
    rgi_ref chain = *rgi_lattice_holder(lattice, parent), next;
    rgi_cell cell;
    uint32_t index, length = rgi_block_at(lattice, chain)->length, moved = 0;
    if (length > LONG_TO_PART || (length & (length - 1)) != 0) return false;
    if (!cell_for_parting(lattice, parent, chain, more, &cell)) return false;
    /* At most 9 chains, each going through the sizes of blocks; and one more for the entry itself. */
    if (!rgi_lattice_reserve_blocks(lattice, RGI_OCTANTS + 2 + length) ||
        !rgi_lattice_make_node(lattice, &cell, &index))
        return false;
    *rgi_lattice_holder(lattice, parent) = index << 2;
    rgi_node_at(lattice, index)->parent = parent;
    for (rgi_ref ref = chain; ref; ref = next) {
        rgi_block *b = rgi_block_at(lattice, ref);
        rgi_entry e;
        next = b->next;
        moved += b->count;
        for (uint32_t i = 0; i < b->count; i++) {
            rgi_entry_read(b, i, &e);
            put(lattice, index, &e);
        }
        rgi_lattice_give(lattice, b->kind, ref);
    }
    if (parent != RGI_ROOT) {
        rgi_node_at(lattice, parent >> 4)->nodes++;
        rgi_lattice_count_members(lattice, parent, -(int)moved);
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------- insert */

/* The chain where an entry belongs, as `parent`; makes nodes on the way where that pays. */
static uint32_t find_chain(rgi_lattice *lattice, const rgi_entry *e) {
    uint32_t parent = RGI_ROOT;
    for (;;) {
        rgi_ref ref = *rgi_lattice_holder(lattice, parent);
        if (!rgi_is_node(ref)) {
            if (!ref || rgi_block_at(lattice, ref)->count < RGI_BLOCK || !part(lattice, parent, e)) return parent;
            continue;
        }
        uint32_t index = rgi_node_number(ref);
        const rgi_node *n = rgi_node_at(lattice, index);
        bool covered = rgi_cell_holds(n->centre, n->half, e->centre) && 2 * n->half >= e->least;
        if (!covered && wrap(lattice, parent, e)) continue;
        if (e->least > n->half) return index << 4 | RGI_OWN;
        parent = index << 4 | rgi_node_octant(n, e->centre);
    }
}

/* The first object decides where the frame is and what its unit is: some power of two near its size. */
void rgi_lattice_make_frame(rgi_lattice *lattice, const rgi_bound *bound) {
    double size = 0, far = rgi_max_magnitude(bound->centre);
    for (int a = 0; a < 3; a++) {
        double middle = bound->centre[a];
        lattice->origin[a] = fabs(middle) <= 4 * RG_COORDINATE_MAX ? middle : 0;
        double extent = bound->hi[a] - bound->lo[a];
        if (extent < INFINITY) size = rgi_max(size, extent);
    }
    if (!(far < INFINITY)) far = 1;
    size = rgi_max(size, rgi_max(far * 0x1p-40, 1e-120));
    lattice->unit = rgi_power_of_two_near(size);
    lattice->scale = 1 / lattice->unit;
}

rg_result rgi_lattice_reserve(rgi_lattice *lattice, uint64_t unbounded) {
    uint64_t needed = lattice->unbounded_count + unbounded;
    if (needed <= lattice->unbounded_room) return RG_OK;
    uint64_t room = needed + lattice->unbounded_room + 4;
    uint32_t *list;
    rg_result result = rgi_allocate(lattice->memory, room, sizeof *list, "the list of unbounded objects", &list);
    if (result) return result;
    if (lattice->unbounded_count) memcpy(list, lattice->unbounded, lattice->unbounded_count * sizeof *list);
    rgi_release(lattice->memory, lattice->unbounded, lattice->unbounded_room, sizeof *list);
    lattice->unbounded = list;
    lattice->unbounded_room = room;
    return RG_OK;
}

rg_result rgi_lattice_insert_unbounded(rgi_lattice *lattice, uint32_t slot) {
    rg_result result = rgi_lattice_reserve(lattice, 1);
    if (result) return result;
    rgi_location *place = rgi_lattice_place(lattice, slot);
    place->block = RGI_NONE;
    place->lane = lattice->unbounded_count;
    lattice->unbounded[lattice->unbounded_count++] = slot;
    return RG_OK;
}

static rg_result insert_entry(rgi_lattice *lattice, const rgi_entry *e) {
    uint32_t parent = find_chain(lattice, e);
    if (!rgi_lattice_add(lattice, parent, e))
        return rgi_fail(RG_OUT_OF_MEMORY, "no memory for one object more in the grid, which holds %llu",
                        (unsigned long long)lattice->count);
    rgi_lattice_grow(lattice, parent, e->lo, e->hi);
    lattice->count++;
    return RG_OK;
}

rg_result rgi_lattice_insert(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound) {
    rgi_entry e;
    if (!lattice->root && !lattice->framed) rgi_lattice_make_frame(lattice, bound);
    lattice->framed = false;
    lattice->boxes |= !bound->ball;
    if (!rgi_entry_make(lattice, slot, bound, &e)) return rgi_lattice_insert_unbounded(lattice, slot);
    return insert_entry(lattice, &e);
}

/* -------------------------------------------------------------------------------------------------- remove */

/* Gathers what a node without nodes below it holds, and gives the blocks back. */
static uint32_t gather(rgi_lattice *lattice, uint32_t index, rgi_entry entries[FEW]) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t count = 0;
    for (uint32_t lane = 0; lane <= RGI_OWN; lane++) {
        rgi_ref next;
        for (rgi_ref ref = lane == RGI_OWN ? n->own : n->child[lane]; ref; ref = next) {
            rgi_block *b = rgi_block_at(lattice, ref);
            for (uint32_t i = 0; i < b->count; i++) rgi_entry_read(b, i, &entries[count++]);
            next = b->next;
            rgi_lattice_give(lattice, b->kind, ref);
        }
    }
    return count;
}

/* Makes a node that holds few objects a leaf. False: no memory for it. */
static bool merge(rgi_lattice *lattice, uint32_t index) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t parent = n->parent;
    rgi_entry entries[FEW];
    float lo[3], hi[3];
    bool ball = true;
    if (!rgi_lattice_reserve_blocks(lattice, 1)) return false;
    uint32_t count = gather(lattice, index, entries);
    rgi_lattice_give(lattice, RGI_NODES, index << 2);
    *rgi_lattice_holder(lattice, parent) = 0;
    if (parent != RGI_ROOT) rgi_node_at(lattice, parent >> 4)->nodes--;
    rgi_bounds_empty(lo, hi);
    for (uint32_t i = 0; i < count; i++) {
        rgi_bounds_unite(lo, hi, entries[i].lo, entries[i].hi);
        ball &= entries[i].ball;
    }
    if (count) {
        rgi_ref ref =
            rgi_lattice_take(lattice, rgi_block_kind(count > RGI_SMALLEST ? 2 * RGI_SMALLEST : RGI_SMALLEST, ball));
        rgi_lattice_link(lattice, parent, ref);
    }
    for (uint32_t i = 0; i < count; i++) (void)rgi_lattice_add(lattice, parent, &entries[i]);
    rgi_lattice_set_box(lattice, parent, lo, hi);
    return true;
}

/* A node that has nothing but another node is left out. */
static void skip(rgi_lattice *lattice, uint32_t index) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = 0, parent = n->parent;
    float lo[3], hi[3];
    while (!n->child[lane]) lane++;
    rgi_ref inner = n->child[lane];
    rgi_lattice_get_box(lattice, index << 4 | lane, lo, hi);
    *rgi_lattice_holder(lattice, parent) = inner;
    rgi_node_at(lattice, rgi_node_number(inner))->parent = parent;
    rgi_lattice_set_box(lattice, parent, lo, hi);
    rgi_lattice_give(lattice, RGI_NODES, index << 2);
}

/* Leaves out nodes, from `parent` up, that hold too little now. */
static void clean(rgi_lattice *lattice, uint32_t parent) {
    while (parent != RGI_ROOT) {
        uint32_t index = parent >> 4;
        rgi_node *n = rgi_node_at(lattice, index);
        parent = n->parent;
        if (n->nodes == 1 && n->members == 0) {
            skip(lattice, index);
            return;
        }
        if (n->nodes || n->members > FEW || !merge(lattice, index)) return;
    }
}

static void remove_bounded(rgi_lattice *lattice, const rgi_location *place) {
    rgi_ref ref = place->block;
    rgi_block *b = rgi_block_at(lattice, ref);
    uint32_t lane = place->lane, parent = b->parent;
    if (lane != --b->count) {
        rgi_entry last;
        rgi_entry_read(b, b->count, &last);
        rgi_entry_write(lattice, ref, lane, &last);
    }
    lattice->count--;
    rgi_lattice_count_members(lattice, parent, -1);
    if (b->count == 0) {
        rgi_lattice_unlink(lattice, ref);
        rgi_lattice_give(lattice, b->kind, ref);
    } else if (b->previous && b->count == rgi_block_room(b->kind) - 1u) {
        /* A block with room comes to the head, where it is filled again. */
        rgi_lattice_unlink(lattice, ref);
        rgi_lattice_link(lattice, parent, ref);
    }
    rgi_ref head = *rgi_lattice_holder(lattice, parent);
    if (head)
        rgi_lattice_loosened(lattice, parent, rgi_block_at(lattice, head), true);
    else if ((parent & 15) != RGI_OWN || parent == RGI_ROOT)
        rgi_lattice_clear_box(lattice, parent);
    clean(lattice, parent);
}

void rgi_lattice_remove(rgi_lattice *lattice, uint32_t slot) {
    const rgi_location place = *rgi_lattice_place(lattice, slot);
    if (place.block != RGI_NONE) {
        remove_bounded(lattice, &place);
        return;
    }
    uint32_t last = lattice->unbounded[--lattice->unbounded_count];
    lattice->unbounded[place.lane] = last;
    rgi_lattice_place(lattice, last)->lane = place.lane;
}

/* ---------------------------------------------------------------------------------------------------- move */

/* A tenth beyond the wall an object still stays: on the wall it would else change cells with every step. */
#define STAYS 1.1f

static bool may_stay(const rgi_block *b, const rgi_entry *e) {
    if (rgi_is_ball_block(b->kind) && !e->ball) return false;
    if (2 * b->half < e->least) return false;
    return rgi_cell_holds(b->centre, STAYS * b->half, e->centre);
}

static void stay(rgi_lattice *lattice, const rgi_location *place, const rgi_entry *e) {
    rgi_block *b = rgi_block_at(lattice, place->block);
    uint32_t parent = b->parent;
    rgi_entry_write_bounds(b, place->lane, e);
    rgi_lattice_grow(lattice, parent, e->lo, e->hi);
    if (b->previous) b = rgi_block_at(lattice, *rgi_lattice_holder(lattice, parent));
    rgi_lattice_loosened(lattice, parent, b, false);
}

bool rgi_lattice_reaches(const rgi_lattice *lattice, const double position[3], double radius) {
    for (int a = 0; a < 3; a++) {
        if (!(fabs((position[a] - lattice->origin[a]) * lattice->scale) <= 0.5 * RGI_COORDINATE_MOST)) return false;
    }
    return radius * lattice->scale <= 0.25 * RGI_COORDINATE_MOST;
}

void rgi_lattice_fetch(const rgi_lattice *lattice, const rgi_location *place) {
    const char *at = rgi_arena_at(&lattice->arena, place->block);
    for (int i = 0; i < 4; i++) __builtin_prefetch(at + (ptrdiff_t)i * RGI_LINE, 1);
}

/* The entry of a ball at a new centre; false if it does not stay in its cell. */
static bool entry_of_step(const rgi_lattice *lattice, const rgi_block *b, const double centre[3], double radius,
                          rgi_entry *e) {
    for (int a = 0; a < 3; a++) e->centre[a] = (float)((centre[a] - lattice->origin[a]) * lattice->scale);
    if (!rgi_is_ball_block(b->kind) || !rgi_cell_holds(b->centre, STAYS * b->half, e->centre)) return false;
    e->radius = rgi_entry_radius(e->centre, radius * lattice->scale);
    for (int a = 0; a < 3; a++) {
        e->lo[a] = e->centre[a] - e->radius;
        e->hi[a] = e->centre[a] + e->radius;
    }
    return true;
}

bool rgi_lattice_step(rgi_lattice *lattice, const rgi_location *place, const double centre[3], double radius) {
    rgi_entry e;
    if (!entry_of_step(lattice, rgi_block_at(lattice, place->block), centre, radius, &e)) return false;
    stay(lattice, place, &e);
    return true;
}

rgi_stepped rgi_lattice_step_shared(rgi_lattice *lattice, const rgi_location *place, const double centre[3],
                                    double radius) {
    rgi_block *b = rgi_block_at(lattice, place->block);
    rgi_entry e;
    if (!entry_of_step(lattice, b, centre, radius, &e)) return RGI_LEFT;
    rgi_entry_write_bounds(b, place->lane, &e);
    rgi_lattice_grow_shared(lattice, b->parent, e.lo, e.hi);
    if (b->previous) b = rgi_block_at(lattice, *rgi_lattice_holder(lattice, b->parent));
    return rgi_lattice_loosened_shared(b) ? RGI_LOOSENED : RGI_MOVED;
}

void rgi_lattice_tighten(rgi_lattice *lattice, const rgi_location *place) {
    const rgi_block *b = rgi_block_at(lattice, place->block);
    rgi_block *first = rgi_block_at(lattice, *rgi_lattice_holder(lattice, b->parent));
    rgi_lattice_loosened(lattice, b->parent, first, true);
}

/* What no cell can hold, or no block has the kind for, is as right in the list of the unbounded. */
static rg_result to_unbounded(rgi_lattice *lattice, uint32_t slot, const rgi_location *old) {
    rg_result result = rgi_lattice_insert_unbounded(lattice, slot);
    if (!result) remove_bounded(lattice, old);
    return result;
}

rg_result rgi_lattice_move(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound) {
    const rgi_location place = *rgi_lattice_place(lattice, slot);
    rgi_entry e;
    bool bounded = rgi_entry_make(lattice, slot, bound, &e);
    lattice->boxes |= !bound->ball;
    if (place.block == RGI_NONE) {
        if (!bounded) return RG_OK;
        /* The list keeps its memory: what is taken from it can go back, and is as right there. */
        rgi_lattice_remove(lattice, slot);
        rgi_fail_quietly(true);
        if (rgi_lattice_insert(lattice, slot, bound)) (void)rgi_lattice_insert_unbounded(lattice, slot);
        rgi_fail_quietly(false);
        return RG_OK;
    }
    if (!bounded) return to_unbounded(lattice, slot, &place);
    const rgi_block *b = rgi_block_at(lattice, place.block);
    /* One block for the insert, one for leaves that the remove makes one. */
    bool stays = may_stay(b, &e), room = stays || rgi_lattice_reserve_blocks(lattice, 2);
    if (stays || (!room && rgi_is_ball_block(b->kind) <= e.ball)) {
        stay(lattice, &place, &e);
        return RG_OK;
    }
    if (!room) return to_unbounded(lattice, slot, &place);
    remove_bounded(lattice, &place);
    return insert_entry(lattice, &e);
}

/* ------------------------------------------------------------------------------------------------ reports */

bool rgi_lattice_has_cell(const rgi_lattice *lattice, const rgi_location *place, const rgi_bound *bound) {
    rgi_entry e;
    if (place->block != RGI_NONE && rgi_is_ball_block(rgi_block_at(lattice, place->block)->kind) && !bound->ball)
        return false;
    return rgi_entry_make(lattice, 0, bound, &e);
}

/* To some 4 %, which is enough here: a third of the exponent and the bits after it, taken from that of 1. */
static float inverse_cube_root(float x) {
    uint32_t bits;
    float root;
    memcpy(&bits, &x, sizeof bits);
    bits = 0x54A2FA8Cu - bits / 3;
    memcpy(&root, &bits, sizeof root);
    return root;
}

rgi_middle rgi_lattice_middle(const rgi_lattice *lattice) {
    rgi_middle m;
    double half[3], unit = lattice->unit;
    m.extent = 0;
    for (int a = 0; a < 3; a++) {
        m.centre[a] = 0.5 * ((double)lattice->lo[a] + lattice->hi[a]) * unit;
        half[a] = 0.5 * ((double)lattice->hi[a] - lattice->lo[a]) * unit;
        m.extent += rgi_max(fabs((double)lattice->lo[a]), fabs((double)lattice->hi[a]));
    }
    m.radius = sqrt(rgi_dot(half, half));
    m.spacing = 0;
    return m;
}

float rgi_lattice_spacing(const rgi_lattice *lattice) {
    return inverse_cube_root((float)(lattice->count + 1));
}

/* Adds the slots below to those that are there; returns how many there are then. */
static uint32_t gather_slots(const rgi_lattice *lattice, rgi_ref ref, uint32_t *slots, uint32_t count) {
    if (rgi_is_node(ref)) {
        const rgi_node *n = rgi_arena_at(&lattice->arena, ref);
        for (int i = 0; i < RGI_OCTANTS; i++) count = gather_slots(lattice, n->child[i], slots, count);
        ref = n->own;
    }
    while (ref) {
        const rgi_block *block = rgi_block_at(lattice, ref);
        for (uint32_t i = 0; i < block->count; i++) slots[count++] = block->slots[i];
        ref = block->next;
    }
    return count;
}

uint32_t rgi_lattice_few(const rgi_lattice *lattice, uint32_t *slots, uint32_t most) {
    return lattice->count <= most ? gather_slots(lattice, lattice->root, slots, 0) : 0;
}

void rgi_lattice_box(const rgi_lattice *lattice, double lo[3], double hi[3]) {
    for (int a = 0; a < 3; a++) {
        lo[a] = lattice->origin[a] + (double)lattice->lo[a] * lattice->unit;
        hi[a] = lattice->origin[a] + (double)lattice->hi[a] * lattice->unit;
    }
}

uint32_t rgi_lattice_nodes(const rgi_lattice *lattice) {
    return lattice->arena.kinds[RGI_NODES].used;
}

/* By recursion: there are no more levels than sizes of cells, some 100. */
static uint32_t levels_below(const rgi_lattice *lattice, rgi_ref ref) {
    uint32_t deepest = 0;
    if (!rgi_is_node(ref)) return 0;
    const rgi_node *n = rgi_node_at(lattice, rgi_node_number(ref));
    for (int i = 0; i < RGI_OCTANTS; i++) {
        uint32_t levels = levels_below(lattice, n->child[i]);
        if (levels > deepest) deepest = levels;
    }
    return deepest + 1;
}

uint32_t rgi_lattice_levels(const rgi_lattice *lattice) {
    return levels_below(lattice, lattice->root);
}

/* ------------------------------------------------------------------------------------------------ lifetime */

void rgi_lattice_init(rgi_lattice *lattice, rgi_memory *memory, rgi_slots *objects, size_t place_offset,
                      rgi_slots *places, const struct rgi_kernels *kernels) {
    memset(lattice, 0, sizeof *lattice);
    lattice->kernels = kernels;
    lattice->memory = memory;
    lattice->objects = objects;
    lattice->places = places ? places : objects;
    lattice->place_offset = places ? 0 : place_offset;
    rgi_arena_init(&lattice->arena, memory);
    rgi_bounds_empty(lattice->lo, lattice->hi);
    lattice->scale = lattice->unit = 1;
}

void rgi_lattice_free(rgi_lattice *lattice) {
    rgi_arena_free(&lattice->arena);
    rgi_release(lattice->memory, lattice->unbounded, lattice->unbounded_room, sizeof *lattice->unbounded);
    lattice->unbounded = NULL;
    lattice->unbounded_count = 0;
    lattice->unbounded_room = 0;
}
