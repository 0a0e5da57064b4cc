/* SPDX-License-Identifier: MIT */
#include "lattice_parts.h"

#include "beam.h"
#include "error.h"
#include "vec.h"

#include <string.h>

enum {
    /* Chains of more blocks are not looked through to make their box tight. */
    LONG_TO_TIGHTEN = 4,
    /* Changes after which a box around a chain, or around a node, is made tight. */
    STALE_LEAF = 16,
    STALE_NODE = 8
};

/* ------------------------------------------------------------------------------------------------- entries */

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

static void complete_entry(rgi_entry *e) {
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

float rgi_entry_radius(const float centre[3], double radius) {
    float r = (float)radius;
    return r + PAD * (r + fabsf(centre[0]) + fabsf(centre[1]) + fabsf(centre[2])) + LEAST;
}

bool rgi_entry_make(const rgi_lattice *lattice, uint32_t slot, const rgi_bound *bound, rgi_entry *e) {
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
    if (e->ball) e->radius = rgi_entry_radius(e->centre, bound->radius * lattice->scale);
    complete_entry(e);
    return true;
}

bool rgi_is_ball_block(uint32_t kind) {
    return !(kind & RGI_BOXES);
}

void rgi_entry_read(const rgi_block *b, uint32_t lane, rgi_entry *e) {
    uint32_t room = rgi_block_room(b->kind);
    const float *f = rgi_block_lanes(b, room) + lane;
    e->ball = rgi_is_ball_block(b->kind);
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

void rgi_entry_write_bounds(rgi_block *b, uint32_t lane, const rgi_entry *e) {
    uint32_t room = rgi_block_room(b->kind);
    float *f = rgi_block_lanes(b, room) + lane;
    if (rgi_is_ball_block(b->kind)) {
        for (int a = 0; a < 3; a++) f[a * room] = e->centre[a];
        f[3 * room] = e->radius;
    } else {
        for (int a = 0; a < 3; a++) {
            f[a * room] = e->lo[a];
            f[(a + 3) * room] = e->hi[a];
        }
    }
}

rgi_location *rgi_lattice_place(const rgi_lattice *lattice, uint32_t slot) {
    return (rgi_location *)((char *)rgi_slots_at(lattice->places, slot) + lattice->place_offset);
}

void rgi_entry_write(const rgi_lattice *lattice, rgi_ref ref, uint32_t lane, const rgi_entry *e) {
    rgi_block *b = rgi_block_at(lattice, ref);
    rgi_location *place = rgi_lattice_place(lattice, e->slot);
    rgi_entry_write_bounds(b, lane, e);
    b->slots[lane] = e->slot;
    place->block = ref;
    place->lane = lane;
}

/* ---------------------------------------------------------------------------------------- nodes and boxes */

uint32_t rgi_node_number(rgi_ref ref) {
    return ref >> 2;
}

/* A record, or 0 without memory. */
rgi_ref rgi_lattice_take(rgi_lattice *lattice, uint32_t kind) {
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

void rgi_lattice_give(rgi_lattice *lattice, uint32_t kind, rgi_ref ref) {
    rgi_arena_give(&lattice->arena, kind, ref);
}

/* Where the reference to a child, a chain, or the root is. */
rgi_ref *rgi_lattice_holder(rgi_lattice *lattice, uint32_t parent) {
    if (parent == RGI_ROOT) return &lattice->root;
    rgi_node *n = rgi_node_at(lattice, parent >> 4);
    return (parent & 15) == RGI_OWN ? &n->own : &n->child[parent & 15];
}

void rgi_lattice_set_box(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]) {
    rgi_node *n = parent == RGI_ROOT ? NULL : rgi_node_at(lattice, parent >> 4);
    for (int a = 0; a < 3; a++) {
        *(n ? &n->lo[a][parent & 15] : &lattice->lo[a]) = lo[a];
        *(n ? &n->hi[a][parent & 15] : &lattice->hi[a]) = hi[a];
    }
}

void rgi_lattice_clear_box(rgi_lattice *lattice, uint32_t parent) {
    const float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    rgi_lattice_set_box(lattice, parent, lo, hi);
}

void rgi_lattice_get_box(const rgi_lattice *lattice, uint32_t parent, float lo[3], float hi[3]) {
    const rgi_node *n = parent == RGI_ROOT ? NULL : rgi_node_at(lattice, parent >> 4);
    for (int a = 0; a < 3; a++) {
        lo[a] = n ? n->lo[a][parent & 15] : lattice->lo[a];
        hi[a] = n ? n->hi[a][parent & 15] : lattice->hi[a];
    }
}

void rgi_bounds_unite(float lo[3], float hi[3], const float lo2[3], const float hi2[3]) {
    for (int a = 0; a < 3; a++) {
        if (lo2[a] < lo[a]) lo[a] = lo2[a];
        if (hi2[a] > hi[a]) hi[a] = hi2[a];
    }
}

/* Branches, not flags: nearly always all six go the same way. */
static bool is_inside(const rgi_node *n, uint32_t lane, const float lo[3], const float hi[3]) {
    for (int a = 0; a < 3; a++) {
        if (lo[a] < n->lo[a][lane] || hi[a] > n->hi[a][lane]) return false;
    }
    return true;
}

/* Boxes from `parent` up to the root take a box in, as far as they must. */
void rgi_lattice_grow(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]) {
    while (parent != RGI_ROOT) {
        rgi_node *n = rgi_node_at(lattice, parent >> 4);
        uint32_t lane = parent & 15;
        parent = n->parent;
        if (lane == RGI_OWN) continue;
        if (is_inside(n, lane, lo, hi)) return;
        for (int a = 0; a < 3; a++) {
            if (lo[a] < n->lo[a][lane]) n->lo[a][lane] = lo[a];
            if (hi[a] > n->hi[a][lane]) n->hi[a][lane] = hi[a];
        }
    }
    rgi_bounds_unite(lattice->lo, lattice->hi, lo, hi);
}

/* Returns whether it had to. */
static bool lower(float *bound, float to) {
    float old;
    __atomic_load(bound, &old, __ATOMIC_RELAXED);
    bool must = to < old;
    while (to < old) {
        if (__atomic_compare_exchange(bound, &old, &to, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) break;
    }
    return must;
}

static bool raise(float *bound, float to) {
    float old;
    __atomic_load(bound, &old, __ATOMIC_RELAXED);
    bool must = to > old;
    while (to > old) {
        if (__atomic_compare_exchange(bound, &old, &to, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) break;
    }
    return must;
}

/*
 * Whoever finds a box large enough may stop although another thread that has made it so may not have come to the
 * boxes above yet: that one will, and on each side they are then as large as this box is there.
 */
void rgi_lattice_grow_shared(rgi_lattice *lattice, uint32_t parent, const float lo[3], const float hi[3]) {
    bool grows = true;
    while (parent != RGI_ROOT && grows) {
        rgi_node *n = rgi_node_at(lattice, parent >> 4);
        uint32_t lane = parent & 15;
        parent = n->parent;
        if (lane == RGI_OWN) continue;
        grows = false;
        for (int a = 0; a < 3; a++) {
            grows |= lower(&n->lo[a][lane], lo[a]);
            grows |= raise(&n->hi[a][lane], hi[a]);
        }
    }
    for (int a = 0; a < 3 && grows; a++) {
        (void)lower(&lattice->lo[a], lo[a]);
        (void)raise(&lattice->hi[a], hi[a]);
    }
}

bool rgi_lattice_loosened_shared(rgi_block *first) {
    return __atomic_add_fetch(&first->stale, 1, __ATOMIC_RELAXED) == STALE_LEAF;
}

/* Takes the box around a chain in; false if it is too long to look at. */
static bool unite_chain(const rgi_lattice *lattice, rgi_ref chain, float lo[3], float hi[3]) {
    if (chain && rgi_block_at(lattice, chain)->length > LONG_TO_TIGHTEN) return false;
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(lattice, ref)->next)
        lattice->kernels->unite_block(rgi_block_at(lattice, ref), lo, hi);
    return true;
}

void rgi_bounds_empty(float lo[3], float hi[3]) {
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
        rgi_bounds_empty(lo, hi);
        for (int a = 0; a < 3; a++) {
            for (int i = 0; i < RGI_OCTANTS; i++) {
                lo[a] = n->lo[a][i] < lo[a] ? n->lo[a][i] : lo[a];
                hi[a] = n->hi[a][i] > hi[a] ? n->hi[a][i] : hi[a];
            }
        }
        if (!unite_chain(lattice, n->own, lo, hi)) return;
        rgi_lattice_set_box(lattice, n->parent, lo, hi);
        parent = n->parent;
    }
}

void rgi_lattice_loosened(rgi_lattice *lattice, uint32_t parent, rgi_block *first, bool gone) {
    float lo[3], hi[3];
    if (++first->stale < STALE_LEAF && !gone) return;
    first->stale = 0;
    if ((parent & 15) != RGI_OWN || parent == RGI_ROOT) {
        rgi_bounds_empty(lo, hi);
        if (!unite_chain(lattice, *rgi_lattice_holder(lattice, parent), lo, hi)) return;
        rgi_lattice_set_box(lattice, parent, lo, hi);
    }
    tighten_above(lattice, parent);
}

/* -------------------------------------------------------------------------------------------------- chains */

void rgi_lattice_count_members(rgi_lattice *lattice, uint32_t parent, int change) {
    if (parent != RGI_ROOT) rgi_node_at(lattice, parent >> 4)->members += (uint32_t)change;
}

/* The cell of a chain or child: that of its octant, of its node, or all space. */
void rgi_lattice_cell_of(const rgi_lattice *lattice, uint32_t parent, float centre[3], float *half) {
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
void rgi_lattice_link(rgi_lattice *lattice, uint32_t parent, rgi_ref ref) {
    rgi_ref *head = rgi_lattice_holder(lattice, parent);
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
    rgi_lattice_cell_of(lattice, parent, b->centre, &b->half);
}

void rgi_lattice_unlink(rgi_lattice *lattice, rgi_ref ref) {
    rgi_block *b = rgi_block_at(lattice, ref);
    rgi_ref *head = rgi_lattice_holder(lattice, b->parent);
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

uint32_t rgi_block_kind(uint32_t room, bool ball) {
    return room | (ball ? 0 : RGI_BOXES);
}

/* A block with what `old`, the first of its chain, holds, of another kind, in its place. False: no memory. */
static bool replace_block(rgi_lattice *lattice, rgi_ref old, uint32_t kind) {
    rgi_ref new = rgi_lattice_take(lattice, kind);
    if (!new) return false;
    rgi_block *from = rgi_block_at(lattice, old), *to = rgi_block_at(lattice, new);
    uint32_t parent = from->parent;
    memcpy(to, from, sizeof *to);
    to->kind = (uint8_t)kind;
    for (uint32_t i = 0; i < from->count; i++) {
        rgi_entry e;
        rgi_entry_read(from, i, &e);
        rgi_entry_write(lattice, new, i, &e);
    }
    if (to->next) rgi_block_at(lattice, to->next)->previous = new;
    *rgi_lattice_holder(lattice, parent) = new;
    rgi_lattice_give(lattice, from->kind, old);
    return true;
}

/* Makes the first block of a chain one that has room for the entry. False: no memory, and nothing has changed. */
static bool make_room(rgi_lattice *lattice, uint32_t parent, const rgi_entry *e) {
    rgi_ref head = *rgi_lattice_holder(lattice, parent);
    if (head) {
        const rgi_block *b = rgi_block_at(lattice, head);
        uint32_t kind = b->kind, room = rgi_block_room(kind);
        bool turn = rgi_is_ball_block(kind) && !e->ball;
        if (b->count < room && !turn) return true;
        if (b->count < RGI_BLOCK) {
            uint32_t larger = b->count == room ? 2 * room : room;
            return replace_block(lattice, head, rgi_block_kind(larger, e->ball && rgi_is_ball_block(kind)));
        }
    }
    rgi_ref new = rgi_lattice_take(lattice, rgi_block_kind(head ? RGI_BLOCK : RGI_SMALLEST, e->ball));
    if (!new) return false;
    rgi_lattice_link(lattice, parent, new);
    return true;
}

bool rgi_lattice_add(rgi_lattice *lattice, uint32_t parent, const rgi_entry *e) {
    if (!make_room(lattice, parent, e)) return false;
    rgi_ref head = *rgi_lattice_holder(lattice, parent);
    rgi_entry_write(lattice, head, rgi_block_at(lattice, head)->count++, e);
    rgi_lattice_count_members(lattice, parent, 1);
    return true;
}

/* ------------------------------------------------------------------------------------------- making nodes */

/* A node with an empty box for each octant; *index is its number. False: no memory. */
bool rgi_lattice_make_node(rgi_lattice *lattice, const rgi_cell *cell, uint32_t *index) {
    rgi_ref ref = rgi_lattice_take(lattice, RGI_NODES);
    if (!ref) return false;
    *index = rgi_node_number(ref);
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

uint32_t rgi_node_octant(const rgi_node *n, const float point[3]) {
    return (uint32_t)(point[0] >= n->centre[0]) | (uint32_t)(point[1] >= n->centre[1]) << 1 |
           (uint32_t)(point[2] >= n->centre[2]) << 2;
}

/* The largest cell that a child at `parent` may have: half the width of its node's. */
float rgi_lattice_widest(const rgi_lattice *lattice, uint32_t parent) {
    return parent == RGI_ROOT ? RGI_CELL_MOST : 0.5f * rgi_node_at(lattice, parent >> 4)->half;
}

/* Makes sure that so many blocks of each kind can be taken. False: no memory. */
bool rgi_lattice_reserve_blocks(rgi_lattice *lattice, uint32_t count) {
    rg_result result = RG_OK;
    rgi_fail_quietly(true);
    for (uint32_t room = RGI_SMALLEST; room <= RGI_BLOCK && !result; room *= 2) {
        result = rgi_arena_reserve(&lattice->arena, room, count);
        if (!result && lattice->boxes) result = rgi_arena_reserve(&lattice->arena, room | RGI_BOXES, count);
    }
    rgi_fail_quietly(false);
    return result == RG_OK;
}

/* ------------------------------------------------------------------------------------------------- parting */

void rgi_survey_begin(rgi_survey *s) {
    rgi_bounds_empty(s->lo, s->hi);
    s->largest = 0;
}

void rgi_survey_add(rgi_survey *s, const rgi_entry *e) {
    rgi_bounds_unite(s->lo, s->hi, e->centre, e->centre);
    if (e->least > s->largest) s->largest = e->least;
}

bool rgi_lattice_parting_cell(const rgi_lattice *lattice, uint32_t parent, const rgi_survey *s, rgi_cell *cell) {
    if (!rgi_cell_around(s->lo, s->hi, 0.5f * s->largest, rgi_lattice_widest(lattice, parent), cell)) {
        if (parent == RGI_ROOT) return false;
        rgi_lattice_cell_of(lattice, parent, cell->centre, &cell->half);
    }
    return rgi_cell_is_precise(cell);
}
