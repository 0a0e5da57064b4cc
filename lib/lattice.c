/* SPDX-License-Identifier: MIT */
#include "lattice.h"

#include "lattice_cell.h"

#include "error.h"
#include "vec.h"

#include <raygrid/shape.h>

#include <string.h>

enum {
    /* A node whose objects, all in leaves, have become so few is made a leaf again. */
    FEW = 8,
    /* A chain is parted only if so many of its objects may go down. */
    WORTH_PARTING = 4,
    /* Chains of more blocks are not looked through any more to be parted, nor to make their box tight. */
    LONG_TO_PART = 64,
    LONG_TO_TIGHTEN = 4,
    /* Changes after which a box around a chain, or around a node, is made tight. */
    STALE_LEAF = 8,
    STALE_NODE = 8
};

/* ------------------------------------------------------------------------------------------------- entries */

/** What is stored of an object, and what decides where. */
typedef struct entry {
    float lo[3], hi[3];
    float centre[3], radius; /* the ball, or the middle of the box */
    float least;             /* width of the smallest cell that it may go down to */
    uint32_t slot;
    bool ball;
} entry;

/*
 * Down to cells of 1/4 to 1/2 of its size: the size rounded down to a power of two, halved. Larger cells have looser
 * boxes, smaller ones were no gain.
 */
static float least_cell(float size) {
    uint32_t bits;
    float power;
    memcpy(&bits, &size, sizeof bits);
    bits &= 0x7F800000;
    memcpy(&power, &bits, sizeof power);
    return power * 0.5f > RGI_CELL_LEAST ? power * 0.5f : RGI_CELL_LEAST;
}

static void complete_entry(entry *e) {
    float size = 0;
    for (int a = 0; a < 3; a++) {
        if (e->ball) {
            e->lo[a] = e->centre[a] - e->radius;
            e->hi[a] = e->centre[a] + e->radius;
        } else {
            e->centre[a] = 0.5f * (e->lo[a] + e->hi[a]);
        }
        if (e->hi[a] - e->lo[a] > size) size = e->hi[a] - e->lo[a];
    }
    e->least = least_cell(size);
}

/*
 * The relative pad of what is stored. A plane p of a box takes part in the slab test with an error of at most 2^-22
 * |p|: half an ulp of its own rounding, one of that of the product, two of that of the inverse direction; a centre c
 * of a ball with 2^-21 (|c| + r). With 2^-20 there is a factor to spare; the ray's part of the error is the kernel's
 * business.
 */
#define PAD 0x1p-20f

/* Added to all extents, so that what float underflows to nothing still has some. */
#define LEAST 0x1p-100f

static bool make_entry(const rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound, entry *e) {
    double largest = 0;
    e->slot = slot;
    e->ball = bound->ball;
    for (int a = 0; a < 3; a++) {
        double at = (bound->centre[a] - lattice->origin[a]) * lattice->scale;
        double lo = (bound->lo[a] - lattice->origin[a]) * lattice->scale;
        double hi = (bound->hi[a] - lattice->origin[a]) * lattice->scale;
        largest = rgi_max(largest, rgi_max(fabs(lo), fabs(hi)));
        if (!(largest <= RGI_COORDINATE_MOST)) return false;
        e->centre[a] = (float)at;
        e->lo[a] = (float)lo - (float)fabs(lo) * PAD - LEAST;
        e->hi[a] = (float)hi + (float)fabs(hi) * PAD + LEAST;
    }
    if (e->ball) {
        float r = (float)(bound->radius * lattice->scale);
        e->radius = r + PAD * (r + fabsf(e->centre[0]) + fabsf(e->centre[1]) + fabsf(e->centre[2])) + LEAST;
    }
    complete_entry(e);
    return true;
}

static bool is_ball_block(uint32_t kind) {
    return !(kind & RGI_BOXES);
}

static void read_entry(const rgi_block *b, uint32_t lane, entry *e) {
    uint32_t room = rgi_block_room(b->kind);
    const float *f = rgi_block_lanes(b, room) + lane;
    e->ball = is_ball_block(b->kind);
    e->slot = b->slots[lane];
    for (int a = 0; a < 3; a++) {
        if (e->ball) {
            e->centre[a] = f[a * room];
        } else {
            e->lo[a] = f[a * room];
            e->hi[a] = f[(a + 3) * room];
        }
    }
    if (e->ball) e->radius = f[3 * room];
    complete_entry(e);
}

static void write_bounds(rgi_block *b, uint32_t lane, const entry *e) {
    uint32_t room = rgi_block_room(b->kind);
    float *f = rgi_block_lanes(b, room) + lane;
    if (is_ball_block(b->kind)) {
        for (int a = 0; a < 3; a++) f[a * room] = e->centre[a];
        f[3 * room] = e->radius;
    } else {
        for (int a = 0; a < 3; a++) {
            f[a * room] = e->lo[a];
            f[(a + 3) * room] = e->hi[a];
        }
    }
}

static rgi_location *place_of(const rgi_lattice *lattice, uint32_t slot) {
    return (rgi_location *)((char *)rgi_slots_at(lattice->objects, slot) + lattice->place_offset);
}

static void write_entry(const rgi_lattice *lattice, rgi_ref ref, uint32_t lane, const entry *e) {
    rgi_block *b = rgi_block_at(lattice, ref);
    rgi_location *place = place_of(lattice, e->slot);
    write_bounds(b, lane, e);
    b->slots[lane] = e->slot;
    place->block = ref;
    place->lane = lane;
}

/* ---------------------------------------------------------------------------------------- nodes and boxes */

static uint32_t node_number(rgi_ref ref) {
    return ref >> 2;
}

/* A record, or 0 without memory. */
static rgi_ref take(rgi_lattice *lattice, uint32_t kind) {
    rgi_fail_quietly(true);
    rg_result result = rgi_arena_reserve(&lattice->arena, kind, 1);
    rgi_fail_quietly(false);
    if (result) return 0;
    rgi_ref ref = rgi_arena_take(&lattice->arena, kind);
    if (kind == RGI_NODES) return ref;
    rgi_block *b = rgi_block_at(lattice, ref);
    b->kind = (uint8_t)kind;
    b->count = 0;
    return ref;
}

static void give(rgi_lattice *lattice, uint32_t kind, rgi_ref ref) {
    rgi_arena_give(&lattice->arena, kind, ref);
}

/* Where the reference to a child, a chain, or the root is. */
static rgi_ref *holder(rgi_lattice *lattice, uint32_t parent) {
    if (parent == RGI_ROOT) return &lattice->root;
    rgi_node *n = rgi_node_at(lattice, parent >> 4);
    return (parent & 15) == RGI_OWN ? &n->own : &n->child[parent & 15];
}

static void set_box(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]) {
    rgi_node *n = parent == RGI_ROOT ? NULL : rgi_node_at(lattice, parent >> 4);
    for (int a = 0; a < 3; a++) {
        *(n ? &n->lo[a][parent & 15] : &lattice->lo[a]) = lo[a];
        *(n ? &n->hi[a][parent & 15] : &lattice->hi[a]) = hi[a];
    }
}

static void clear_box(rgi_lattice *lattice, uint32_t parent) {
    const float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    set_box(lattice, parent, lo, hi);
}

static void get_box(const rgi_lattice *lattice, uint32_t parent, float lo[3], float hi[3]) {
    const rgi_node *n = parent == RGI_ROOT ? NULL : rgi_node_at(lattice, parent >> 4);
    for (int a = 0; a < 3; a++) {
        lo[a] = n ? n->lo[a][parent & 15] : lattice->lo[a];
        hi[a] = n ? n->hi[a][parent & 15] : lattice->hi[a];
    }
}

/* Boxes from `parent` up to the root take a box in, as far as they must. */
static void grow(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]) {
    while (parent != RGI_ROOT) {
        rgi_node *n = rgi_node_at(lattice, parent >> 4);
        uint32_t lane = parent & 15;
        parent = n->parent;
        if (lane == RGI_OWN) continue;
        bool inside = true;
        for (int a = 0; a < 3; a++) inside &= lo[a] >= n->lo[a][lane] && hi[a] <= n->hi[a][lane];
        if (inside) return;
        for (int a = 0; a < 3; a++) {
            if (lo[a] < n->lo[a][lane]) n->lo[a][lane] = lo[a];
            if (hi[a] > n->hi[a][lane]) n->hi[a][lane] = hi[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        if (lo[a] < lattice->lo[a]) lattice->lo[a] = lo[a];
        if (hi[a] > lattice->hi[a]) lattice->hi[a] = hi[a];
    }
}

static void unite(float lo[3], float hi[3], const float lo2[3], const float hi2[3]) {
    for (int a = 0; a < 3; a++) {
        if (lo2[a] < lo[a]) lo[a] = lo2[a];
        if (hi2[a] > hi[a]) hi[a] = hi2[a];
    }
}

/* Takes the box around a chain in; false if it is too long to look at. */
static bool unite_chain(const rgi_lattice *lattice, rgi_ref chain, float lo[3], float hi[3]) {
    if (chain && rgi_block_at(lattice, chain)->length > LONG_TO_TIGHTEN) return false;
    for (rgi_ref ref = chain; ref;) {
        rgi_block *b = rgi_block_at(lattice, ref);
        uint32_t room = rgi_block_room(b->kind);
        const float *lanes = rgi_block_lanes(b, room);
        bool ball = is_ball_block(b->kind);
        for (int a = 0; a < 3; a++) {
            const float *at = lanes + (size_t)a * room,
                        *far = lanes + (size_t)3 * room + (ball ? 0 : (size_t)a * room);
            for (uint32_t i = 0; i < b->count; i++) {
                float l = ball ? at[i] - far[i] : at[i], h = ball ? at[i] + far[i] : far[i];
                if (l < lo[a]) lo[a] = l;
                if (h > hi[a]) hi[a] = h;
            }
        }
        ref = b->next;
    }
    return true;
}

static void empty(float lo[3], float hi[3]) {
    for (int a = 0; a < 3; a++) {
        lo[a] = INFINITY;
        hi[a] = -INFINITY;
    }
}

/* A box below a node has been made tight: now and then so is the node's own, and so on upwards. */
static void tighten_above(rgi_lattice *lattice, uint32_t parent) {
    while (parent != RGI_ROOT) {
        uint32_t index = parent >> 4;
        rgi_node *n = rgi_node_at(lattice, index);
        float lo[3], hi[3];
        if (++n->stale < STALE_NODE) return;
        n->stale = 0;
        empty(lo, hi);
        for (int a = 0; a < 3; a++) {
            for (int i = 0; i < RGI_OCTANTS; i++) {
                lo[a] = n->lo[a][i] < lo[a] ? n->lo[a][i] : lo[a];
                hi[a] = n->hi[a][i] > hi[a] ? n->hi[a][i] : hi[a];
            }
        }
        if (!unite_chain(lattice, n->own, lo, hi)) return;
        set_box(lattice, n->parent, lo, hi);
        parent = n->parent;
    }
}

/* An object of the chain at `parent` has moved or gone. */
static void loosened(rgi_lattice *lattice, uint32_t parent, rgi_block *first) {
    float lo[3], hi[3];
    if (++first->stale < STALE_LEAF) return;
    first->stale = 0;
    if ((parent & 15) != RGI_OWN || parent == RGI_ROOT) {
        empty(lo, hi);
        if (!unite_chain(lattice, *holder(lattice, parent), lo, hi)) return;
        set_box(lattice, parent, lo, hi);
    }
    tighten_above(lattice, parent);
}

/* -------------------------------------------------------------------------------------------------- chains */

static void count_members(rgi_lattice *lattice, uint32_t parent, int change) {
    if (parent != RGI_ROOT) rgi_node_at(lattice, parent >> 4)->members += (uint32_t)change;
}

/* The cell of a chain or child: that of its octant, of its node, or all space. */
static void cell_of(const rgi_lattice *lattice, uint32_t parent, float centre[3], float *half) {
    for (int a = 0; a < 3; a++) centre[a] = 0;
    *half = INFINITY;
    if (parent == RGI_ROOT) return;
    const rgi_node *n = rgi_node_at(lattice, parent >> 4);
    bool own = (parent & 15) == RGI_OWN;
    *half = own ? n->half : 0.5f * n->half;
    for (int a = 0; a < 3; a++) {
        float shift = own ? 0 : (parent & 15) >> a & 1 ? *half : -*half;
        centre[a] = n->centre[a] + shift;
    }
}

/* Puts a block at the head of a chain. */
static void link_block(rgi_lattice *lattice, uint32_t parent, rgi_ref ref) {
    rgi_ref *head = holder(lattice, parent);
    rgi_block *b = rgi_block_at(lattice, ref);
    b->next = *head;
    b->previous = 0;
    b->parent = parent;
    b->stale = 0;
    b->length = 1;
    if (*head) {
        rgi_block *old = rgi_block_at(lattice, *head);
        old->previous = ref;
        b->stale = old->stale;
        b->length = (uint8_t)(old->length < RGI_LONG ? old->length + 1 : RGI_LONG);
    }
    *head = ref;
    cell_of(lattice, parent, b->centre, &b->half);
}

static void unlink_block(rgi_lattice *lattice, rgi_ref ref) {
    rgi_block *b = rgi_block_at(lattice, ref);
    rgi_ref *head = holder(lattice, b->parent);
    rgi_block *first = rgi_block_at(lattice, *head);
    uint8_t length = first->length;
    uint8_t stale = first->stale;
    if (b->previous) rgi_block_at(lattice, b->previous)->next = b->next;
    if (b->next) rgi_block_at(lattice, b->next)->previous = b->previous;
    if (*head == ref) *head = b->next;
    if (!*head) return;
    first = rgi_block_at(lattice, *head);
    first->length = (uint8_t)(length < RGI_LONG ? length - 1 : RGI_LONG);
    first->stale = stale;
}

static uint32_t kind_for(uint32_t room, bool ball) {
    return room | (ball ? 0 : RGI_BOXES);
}

/* A block with what `old`, the first of its chain, holds, of another kind, in its place. False: no memory. */
static bool replace_block(rgi_lattice *lattice, rgi_ref old, uint32_t kind) {
    rgi_ref new = take(lattice, kind);
    if (!new) return false;
    rgi_block *from = rgi_block_at(lattice, old), *to = rgi_block_at(lattice, new);
    uint32_t parent = from->parent;
    memcpy(to, from, sizeof *to);
    to->kind = (uint8_t)kind;
    for (uint32_t i = 0; i < from->count; i++) {
        entry e;
        read_entry(from, i, &e);
        write_entry(lattice, new, i, &e);
    }
    if (to->next) rgi_block_at(lattice, to->next)->previous = new;
    *holder(lattice, parent) = new;
    give(lattice, from->kind, old);
    return true;
}

/* Makes the first block of a chain one that has room for the entry. False: no memory, and nothing has changed. */
static bool make_room(rgi_lattice *lattice, uint32_t parent, const entry *e) {
    rgi_ref head = *holder(lattice, parent);
    if (head) {
        const rgi_block *b = rgi_block_at(lattice, head);
        uint32_t kind = b->kind, room = rgi_block_room(kind);
        bool turn = is_ball_block(kind) && !e->ball;
        if (b->count < room && !turn) return true;
        if (b->count < RGI_BLOCK) {
            uint32_t larger = b->count == room ? 2 * room : room;
            return replace_block(lattice, head, kind_for(larger, e->ball && is_ball_block(kind)));
        }
    }
    rgi_ref new = take(lattice, kind_for(head ? RGI_BLOCK : RGI_SMALLEST, e->ball));
    if (!new) return false;
    link_block(lattice, parent, new);
    return true;
}

static bool add_to_chain(rgi_lattice *lattice, uint32_t parent, const entry *e) {
    if (!make_room(lattice, parent, e)) return false;
    rgi_ref head = *holder(lattice, parent);
    write_entry(lattice, head, rgi_block_at(lattice, head)->count++, e);
    count_members(lattice, parent, 1);
    return true;
}

/* ------------------------------------------------------------------------------------------- making nodes */

/* A node with an empty box for each octant; *index is its number. False: no memory. */
static bool make_node(rgi_lattice *lattice, const rgi_cell *cell, uint32_t *index) {
    rgi_ref ref = take(lattice, RGI_NODES);
    if (!ref) return false;
    *index = node_number(ref);
    rgi_node *n = rgi_node_at(lattice, *index);
    memset(n, 0, sizeof *n);
    for (int a = 0; a < 3; a++) {
        n->centre[a] = cell->centre[a];
        for (int i = 0; i < RGI_OCTANTS; i++) {
            n->lo[a][i] = INFINITY;
            n->hi[a][i] = -INFINITY;
        }
    }
    n->half = cell->half;
    return true;
}

static uint32_t octant(const rgi_node *n, const float point[3]) {
    return (uint32_t)(point[0] >= n->centre[0]) | (uint32_t)(point[1] >= n->centre[1]) << 1 |
           (uint32_t)(point[2] >= n->centre[2]) << 2;
}

/* The largest cell that a child at `parent` may have: half the width of its node's. */
static float widest(const rgi_lattice *lattice, uint32_t parent) {
    return parent == RGI_ROOT ? RGI_CELL_MOST : 0.5f * rgi_node_at(lattice, parent >> 4)->half;
}

/* Puts a node between `parent` and the node there, with a cell that also covers the entry. False: it can't be. */
static bool wrap(rgi_lattice *lattice, uint32_t parent, const entry *e) {
    rgi_ref inner = *holder(lattice, parent);
    rgi_node *in = rgi_node_at(lattice, node_number(inner));
    rgi_cell cell;
    uint32_t index;
    float lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = in->centre[a] < e->centre[a] ? in->centre[a] : e->centre[a];
        hi[a] = in->centre[a] > e->centre[a] ? in->centre[a] : e->centre[a];
    }
    float narrowest = 2 * in->half > 0.5f * e->least ? 2 * in->half : 0.5f * e->least;
    if (!rgi_cell_around(lo, hi, narrowest, widest(lattice, parent), &cell)) return false;
    if (!make_node(lattice, &cell, &index)) return false;
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = octant(n, in->centre);
    get_box(lattice, parent, lo, hi);
    *holder(lattice, parent) = index << 2;
    n->parent = parent;
    n->child[lane] = inner;
    n->nodes = 1;
    in->parent = index << 4 | lane;
    set_box(lattice, in->parent, lo, hi);
    return true;
}

/** What a chain that may be parted holds. */
typedef struct survey {
    float lo[3], hi[3]; /* of the centres */
    float largest;      /* of the least cells */
} survey;

static void look_at(survey *s, const entry *e) {
    unite(s->lo, s->hi, e->centre, e->centre);
    if (e->least > s->largest) s->largest = e->least;
}

/* How many objects of a chain may go down into the octants of a cell. */
static uint32_t count_movable(const rgi_lattice *lattice, rgi_ref chain, float half) {
    uint32_t movable = 0;
    entry e;
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(lattice, ref)->next) {
        rgi_block *b = rgi_block_at(lattice, ref);
        for (uint32_t i = 0; i < b->count; i++) {
            read_entry(b, i, &e);
            movable += e.least <= half;
        }
    }
    return movable;
}

/* The cell in which the chain at `parent`, with one entry more, is to be parted; false if it is better left whole. */
static bool parting_cell(const rgi_lattice *lattice, uint32_t parent, rgi_ref chain, const entry *more,
                         rgi_cell *cell) {
    survey s = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    entry e;
    look_at(&s, more);
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(lattice, ref)->next) {
        rgi_block *b = rgi_block_at(lattice, ref);
        for (uint32_t i = 0; i < b->count; i++) {
            read_entry(b, i, &e);
            look_at(&s, &e);
        }
    }
    float widest_half = widest(lattice, parent);
    if (!rgi_cell_around(s.lo, s.hi, 0.5f * s.largest, widest_half, cell)) {
        if (parent == RGI_ROOT) return false;
        cell_of(lattice, parent, cell->centre, &cell->half);
    }
    return rgi_cell_is_precise(cell) && count_movable(lattice, chain, cell->half) >= WORTH_PARTING;
}

/* Makes sure that so many blocks of each kind can be taken. False: no memory. */
static bool reserve_blocks(rgi_lattice *lattice, uint32_t count) {
    rg_result result = RG_OK;
    rgi_fail_quietly(true);
    for (uint32_t room = RGI_SMALLEST; room <= RGI_BLOCK && !result; room *= 2) {
        result = rgi_arena_reserve(&lattice->arena, room, count);
        if (!result && lattice->boxes) result = rgi_arena_reserve(&lattice->arena, room | RGI_BOXES, count);
    }
    rgi_fail_quietly(false);
    return result == RG_OK;
}

static void put(rgi_lattice *lattice, uint32_t index, const entry *e) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = e->least > n->half ? RGI_OWN : octant(n, e->centre);
    (void)add_to_chain(lattice, index << 4 | lane, e);
    grow(lattice, index << 4 | lane, e->lo, e->hi);
}

/* Makes the chain at `parent`, which one entry more would make longer, a node with its objects. */
static bool part(rgi_lattice *lattice, uint32_t parent, const entry *more) {
    rgi_ref chain = *holder(lattice, parent), next;
    rgi_cell cell;
    uint32_t index, length = rgi_block_at(lattice, chain)->length, moved = 0;
    if (length > LONG_TO_PART || (length & (length - 1)) != 0) return false;
    if (!parting_cell(lattice, parent, chain, more, &cell)) return false;
    /* At most 9 chains, each going through the sizes of blocks. */
    if (!reserve_blocks(lattice, RGI_OCTANTS + 1 + length) || !make_node(lattice, &cell, &index)) return false;
    *holder(lattice, parent) = index << 2;
    rgi_node_at(lattice, index)->parent = parent;
    for (rgi_ref ref = chain; ref; ref = next) {
        rgi_block *b = rgi_block_at(lattice, ref);
        entry e;
        next = b->next;
        moved += b->count;
        for (uint32_t i = 0; i < b->count; i++) {
            read_entry(b, i, &e);
            put(lattice, index, &e);
        }
        give(lattice, b->kind, ref);
    }
    if (parent != RGI_ROOT) {
        rgi_node_at(lattice, parent >> 4)->nodes++;
        count_members(lattice, parent, -(int)moved);
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------- insert */

/* The chain where an entry belongs, as `parent`; makes nodes on the way where that pays. */
static uint32_t find_chain(rgi_lattice *lattice, const entry *e) {
    uint32_t parent = RGI_ROOT;
    for (;;) {
        rgi_ref ref = *holder(lattice, parent);
        if (!rgi_is_node(ref)) {
            if (!ref || rgi_block_at(lattice, ref)->count < RGI_BLOCK || !part(lattice, parent, e)) return parent;
            continue;
        }
        uint32_t index = node_number(ref);
        const rgi_node *n = rgi_node_at(lattice, index);
        bool covered = rgi_cell_holds(n->centre, n->half, e->centre) && 2 * n->half >= e->least;
        if (!covered && wrap(lattice, parent, e)) continue;
        if (e->least > n->half) return index << 4 | RGI_OWN;
        parent = index << 4 | octant(n, e->centre);
    }
}

/* The first object decides where the frame is and what its unit is: some power of two near its size. */
static void make_frame(rgi_lattice *lattice, const rgi_bound *bound) {
    double size = 0, far = rgi_max_magnitude(bound->centre);
    for (int a = 0; a < 3; a++) {
        double middle = bound->centre[a];
        lattice->origin[a] = fabs(middle) <= 4 * RG_COORDINATE_MAX ? middle : 0;
        double extent = bound->hi[a] - bound->lo[a];
        if (extent < INFINITY) size = rgi_max(size, extent);
    }
    if (!(far < INFINITY)) far = 1;
    size = rgi_max(size, rgi_max(far * 0x1p-40, 1e-120));
    lattice->scale = 1 / rgi_power_of_two_near(size);
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

static rg_result insert_unbounded(rgi_lattice *lattice, uint32_t slot) {
    rg_result result = rgi_lattice_reserve(lattice, 1);
    if (result) return result;
    rgi_location *place = place_of(lattice, slot);
    place->block = RGI_NONE;
    place->lane = lattice->unbounded_count;
    lattice->unbounded[lattice->unbounded_count++] = slot;
    return RG_OK;
}

static rg_result insert_entry(rgi_lattice *lattice, const entry *e) {
    uint32_t parent = find_chain(lattice, e);
    if (!add_to_chain(lattice, parent, e))
        return rgi_fail(RG_OUT_OF_MEMORY, "no memory for one object more in the grid, which holds %llu",
                        (unsigned long long)lattice->count);
    grow(lattice, parent, e->lo, e->hi);
    lattice->count++;
    return RG_OK;
}

rg_result rgi_lattice_insert(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound) {
    entry e;
    if (!lattice->root) make_frame(lattice, bound);
    lattice->boxes |= !bound->ball;
    if (!make_entry(lattice, slot, bound, &e)) return insert_unbounded(lattice, slot);
    return insert_entry(lattice, &e);
}

/* -------------------------------------------------------------------------------------------------- remove */

/* Gathers what a node without nodes below it holds, and gives the blocks back. */
static uint32_t gather(rgi_lattice *lattice, uint32_t index, entry entries[FEW]) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t count = 0;
    for (uint32_t lane = 0; lane <= RGI_OWN; lane++) {
        rgi_ref next;
        for (rgi_ref ref = lane == RGI_OWN ? n->own : n->child[lane]; ref; ref = next) {
            rgi_block *b = rgi_block_at(lattice, ref);
            for (uint32_t i = 0; i < b->count; i++) read_entry(b, i, &entries[count++]);
            next = b->next;
            give(lattice, b->kind, ref);
        }
    }
    return count;
}

/* Makes a node that holds few objects a leaf. False: no memory for it. */
static bool merge(rgi_lattice *lattice, uint32_t index) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t parent = n->parent;
    entry entries[FEW];
    float lo[3], hi[3];
    bool ball = true;
    if (!reserve_blocks(lattice, 1)) return false;
    uint32_t count = gather(lattice, index, entries);
    give(lattice, RGI_NODES, index << 2);
    *holder(lattice, parent) = 0;
    if (parent != RGI_ROOT) rgi_node_at(lattice, parent >> 4)->nodes--;
    empty(lo, hi);
    for (uint32_t i = 0; i < count; i++) {
        unite(lo, hi, entries[i].lo, entries[i].hi);
        ball &= entries[i].ball;
    }
    if (count) {
        rgi_ref ref = take(lattice, kind_for(count > RGI_SMALLEST ? 2 * RGI_SMALLEST : RGI_SMALLEST, ball));
        link_block(lattice, parent, ref);
    }
    for (uint32_t i = 0; i < count; i++) (void)add_to_chain(lattice, parent, &entries[i]);
    set_box(lattice, parent, lo, hi);
    return true;
}

/* A node that has nothing but another node is left out. */
static void skip(rgi_lattice *lattice, uint32_t index) {
    rgi_node *n = rgi_node_at(lattice, index);
    uint32_t lane = 0, parent = n->parent;
    float lo[3], hi[3];
    while (!n->child[lane]) lane++;
    rgi_ref inner = n->child[lane];
    get_box(lattice, index << 4 | lane, lo, hi);
    *holder(lattice, parent) = inner;
    rgi_node_at(lattice, node_number(inner))->parent = parent;
    set_box(lattice, parent, lo, hi);
    give(lattice, RGI_NODES, index << 2);
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
        entry last;
        read_entry(b, b->count, &last);
        write_entry(lattice, ref, lane, &last);
    }
    lattice->count--;
    count_members(lattice, parent, -1);
    if (b->count == 0) {
        unlink_block(lattice, ref);
        give(lattice, b->kind, ref);
    } else if (b->previous && b->count == rgi_block_room(b->kind) - 1u) {
        /* A block with room comes to the head, where it is filled again. */
        unlink_block(lattice, ref);
        link_block(lattice, parent, ref);
    }
    rgi_ref head = *holder(lattice, parent);
    if (head)
        loosened(lattice, parent, rgi_block_at(lattice, head));
    else if ((parent & 15) != RGI_OWN || parent == RGI_ROOT)
        clear_box(lattice, parent);
    clean(lattice, parent);
}

void rgi_lattice_remove(rgi_lattice *lattice, uint32_t slot) {
    const rgi_location place = *place_of(lattice, slot);
    if (place.block != RGI_NONE) {
        remove_bounded(lattice, &place);
        return;
    }
    uint32_t last = lattice->unbounded[--lattice->unbounded_count];
    lattice->unbounded[place.lane] = last;
    place_of(lattice, last)->lane = place.lane;
}

/* ---------------------------------------------------------------------------------------------------- move */

/* A tenth beyond the wall an object still stays: on the wall it would else change cells with every step. */
#define STAYS 1.1f

static bool may_stay(const rgi_block *b, const entry *e) {
    if (is_ball_block(b->kind) && !e->ball) return false;
    if (2 * b->half < e->least) return false;
    return rgi_cell_holds(b->centre, STAYS * b->half, e->centre);
}

static void stay(rgi_lattice *lattice, const rgi_location *place, const entry *e) {
    rgi_block *b = rgi_block_at(lattice, place->block);
    uint32_t parent = b->parent;
    write_bounds(b, place->lane, e);
    grow(lattice, parent, e->lo, e->hi);
    if (b->previous) b = rgi_block_at(lattice, *holder(lattice, parent));
    loosened(lattice, parent, b);
}

rg_result rgi_lattice_move(rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound) {
    const rgi_location place = *place_of(lattice, slot);
    entry e;
    bool bounded = make_entry(lattice, slot, bound, &e);
    lattice->boxes |= !bound->ball;
    if (place.block == RGI_NONE) {
        if (!bounded) return RG_OK;
        /* The list keeps its memory: what is taken from it can go back, and is as right there. */
        rgi_lattice_remove(lattice, slot);
        rgi_fail_quietly(true);
        if (rgi_lattice_insert(lattice, slot, bound)) (void)insert_unbounded(lattice, slot);
        rgi_fail_quietly(false);
        return RG_OK;
    }
    if (!bounded) {
        rg_result result = insert_unbounded(lattice, slot);
        if (!result) remove_bounded(lattice, &place);
        return result;
    }
    const rgi_block *b = rgi_block_at(lattice, place.block);
    if (may_stay(b, &e) || !reserve_blocks(lattice, 1)) {
        stay(lattice, &place, &e);
        return RG_OK;
    }
    remove_bounded(lattice, &place);
    return insert_entry(lattice, &e);
}

/* ------------------------------------------------------------------------------------------------ reports */

bool rgi_lattice_has_cell(const rgi_lattice *lattice, const rgi_bound *bound) {
    entry e;
    return make_entry(lattice, 0, bound, &e);
}

rgi_middle rgi_lattice_middle(const rgi_lattice *lattice) {
    rgi_middle m;
    double half[3];
    m.extent = 0;
    for (int a = 0; a < 3; a++) {
        m.centre[a] = 0.5 * ((double)lattice->lo[a] + lattice->hi[a]) / lattice->scale;
        half[a] = 0.5 * ((double)lattice->hi[a] - lattice->lo[a]) / lattice->scale;
        m.extent += rgi_max(fabs((double)lattice->lo[a]), fabs((double)lattice->hi[a]));
    }
    m.radius = sqrt(rgi_dot(half, half));
    return m;
}

void rgi_lattice_box(const rgi_lattice *lattice, double lo[3], double hi[3]) {
    for (int a = 0; a < 3; a++) {
        lo[a] = lattice->origin[a] + (double)lattice->lo[a] / lattice->scale;
        hi[a] = lattice->origin[a] + (double)lattice->hi[a] / lattice->scale;
    }
}

uint32_t rgi_lattice_nodes(const rgi_lattice *lattice) {
    return lattice->arena.kinds[RGI_NODES].used;
}

/* By recursion: there are no more levels than sizes of cells, some 100. */
static uint32_t levels_below(const rgi_lattice *lattice, rgi_ref ref) {
    uint32_t deepest = 0;
    if (!rgi_is_node(ref)) return 0;
    const rgi_node *n = rgi_node_at(lattice, node_number(ref));
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

void rgi_lattice_init(rgi_lattice *lattice, rgi_memory *memory, rgi_slots *objects, size_t place_offset) {
    memset(lattice, 0, sizeof *lattice);
    lattice->memory = memory;
    lattice->objects = objects;
    lattice->place_offset = place_offset;
    rgi_arena_init(&lattice->arena, memory);
    empty(lattice->lo, lattice->hi);
    lattice->scale = 1;
}

void rgi_lattice_free(rgi_lattice *lattice) {
    rgi_arena_free(&lattice->arena);
    rgi_release(lattice->memory, lattice->unbounded, lattice->unbounded_room, sizeof *lattice->unbounded);
}
