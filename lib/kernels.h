/* SPDX-License-Identifier: MIT */
/*
 * The kernels, written once: each file kernels_*.c names an instruction set in RGI_ISA and includes this.
 */
#include "beam.h"
#include "simd.h"

#define RGI_PASTE2(a, b) a##b
#define RGI_PASTE(a, b) RGI_PASTE2(a, b)
#define RGI_TEXT2(a) #a
#define RGI_TEXT(a) RGI_TEXT2(a)

/* What rounding can make of the place where a ball is met, relative to its radius: see lattice.c, PAD. */
#define BALL_PAD 0x1p-19f

/* ----------------------------------------------------------------------------------------- the two tests */

/* Octants of a node that the ray may meet, as bits; t: where. */
RGI_INLINE uint32_t meet_octants(const rgi_node *n, const rgi_beam *b, float t[RGI_OCTANTS]) {
    f8 first = f8_set(b->t_min), last = f8_set(b->t_max);
    for (int a = 0; a < 3; a++) {
        bool down = b->negative >> a & 1;
        f8 inverse = f8_set(b->inverse[a]);
        first = f8_max(f8_fma(f8_load(down ? n->hi[a] : n->lo[a]), inverse, f8_set(b->near[a])), first);
        last = f8_min(f8_fma(f8_load(down ? n->lo[a] : n->hi[a]), inverse, f8_set(b->far[a])), last);
    }
    f8_store(t, first);
    return f8_le(first, last);
}

RGI_INLINE uint32_t meet_boxes(const float *f, uint32_t room, const rgi_beam *b, float t[RGI_BLOCK]) {
    f16 first = f16_set(b->t_min), last = f16_set(b->t_max);
    for (uint32_t a = 0; a < 3; a++) {
        bool down = b->negative >> a & 1;
        const float *lo = f + a * room, *hi = f + (a + 3) * room;
        f16 inverse = f16_set(b->inverse[a]);
        first = f16_max(f16_fma(f16_load(down ? hi : lo), inverse, f16_set(b->near[a])), first);
        last = f16_min(f16_fma(f16_load(down ? lo : hi), inverse, f16_set(b->far[a])), last);
    }
    f16_store(t, first);
    return f16_le(first, last);
}

/* By the foot of the perpendicular from the centre: see lib/sphere.c. */
RGI_INLINE uint32_t meet_balls(const float *f, uint32_t room, const rgi_beam *b, float t[RGI_BLOCK]) {
    f16 to[3], along = f16_set(0), square = f16_set(0);
    for (uint32_t a = 0; a < 3; a++) {
        to[a] = f16_sub(f16_load(f + a * room), f16_set(b->origin[a]));
        along = f16_fma(to[a], f16_set(b->direction[a]), along);
    }
    for (int a = 0; a < 3; a++) {
        f16 foot = f16_fma(along, f16_set(-b->direction[a]), to[a]);
        square = f16_fma(foot, foot, square);
    }
    f16 radius = f16_add(f16_load(f + 3 * room), f16_set(b->pad));
    f16 inside = f16_sub(f16_mul(radius, radius), square);
    uint32_t met = f16_le(f16_set(0), inside);
    if (!met) return 0;
    f16 half = f16_fma(radius, f16_set(BALL_PAD), f16_sqrt(f16_max(inside, f16_set(0))));
    f16 first = f16_sub(along, half);
    f16_store(t, first);
    return met & f16_le(first, f16_set(b->t_max)) & f16_le(f16_set(b->t_min), f16_add(along, half));
}

RGI_INLINE uint32_t meet_block(const rgi_block *block, uint32_t kind, const rgi_beam *b, float t[RGI_BLOCK]) {
    uint32_t room = rgi_block_room(kind), used = (1u << block->count) - 1;
    if (kind < RGI_REF_BOXES) return used & meet_balls(block->lanes, room, b, t);
    return used & meet_boxes(block->lanes, room, b, t);
}

/* ------------------------------------------------------------------------------------------------ one ray */

/* Bit i of the result is bit i ^ flip of `bits`: octants in the order in which a ray comes to them. */
RGI_INLINE uint32_t flip_order(uint32_t bits, uint32_t flip) {
    if (flip & 1) bits = (bits & 0x55) << 1 | (bits >> 1 & 0x55);
    if (flip & 2) bits = (bits & 0x33) << 2 | (bits >> 2 & 0x33);
    if (flip & 4) bits = (bits & 0x0F) << 4 | bits >> 4;
    return bits;
}

/* Asks the objects that wait, the nearest first. Returns true if the walk is to end. */
RGI_INLINE bool ask_waiting(const rgi_lattice *lattice, rgi_beam *b) {
    rgi_block *block = rgi_block_at(lattice, b->block);
    const uint32_t *slots = rgi_block_slots(block, rgi_ref_kind(b->block));
    uint32_t waiting = b->waiting;
    b->waiting = 0;
    while (waiting) {
        uint32_t next = (uint32_t)__builtin_ctz(waiting);
        for (uint32_t rest = waiting & (waiting - 1); rest; rest &= rest - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(rest);
            if (b->t[i] < b->t[next]) next = i;
        }
        if (b->t[next] > b->t_max) return false;
        if (b->ask(b, slots[next])) return true;
        waiting &= ~(1u << next);
    }
    return false;
}

static bool walk_below(const rgi_lattice *lattice, rgi_beam *b, rgi_ref ref);

/* By recursion: where the stack is full. Nodes are at most so many levels deep as there are sizes of cells. */
static bool walk_node_below(const rgi_lattice *lattice, rgi_beam *b, const rgi_node *n) {
    float t[RGI_OCTANTS];
    b->nodes++;
    if (n->own && walk_below(lattice, b, n->own)) return true;
    uint32_t met = flip_order(meet_octants(n, b, t), b->negative);
    for (; met; met &= met - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(met) ^ b->negative;
        if (t[lane] <= b->t_max && walk_below(lattice, b, n->child[lane])) return true;
    }
    return false;
}

static bool walk_below(const rgi_lattice *lattice, rgi_beam *b, rgi_ref ref) {
    if (rgi_ref_kind(ref) == RGI_REF_NODE)
        return walk_node_below(lattice, b, rgi_node_at(lattice, rgi_ref_index(ref)));
    for (; ref; ref = rgi_block_at(lattice, ref)->next) {
        b->nodes++;
        b->block = ref;
        b->waiting = meet_block(rgi_block_at(lattice, ref), rgi_ref_kind(ref), b, b->t);
        if (ask_waiting(lattice, b)) return true;
    }
    return false;
}

RGI_INLINE void push(rgi_beam *b, rgi_ref ref, float t) {
    b->stack[b->depth].ref = ref;
    b->stack[b->depth++].t = t;
}

RGI_INLINE void fetch_ahead(const rgi_lattice *lattice, rgi_ref ref) {
    const char *at = rgi_ref_kind(ref) == RGI_REF_NODE ? (const char *)rgi_node_at(lattice, rgi_ref_index(ref))
                                                       : (const char *)rgi_block_at(lattice, ref);
    for (int i = 0; i < 4; i++) __builtin_prefetch(at + 64 * i);
}

/* Returns true if the walk is to end. */
RGI_INLINE bool visit_node(const rgi_lattice *lattice, rgi_beam *b, const rgi_node *n, float from) {
    float t[RGI_OCTANTS];
    if (b->depth + RGI_OCTANTS + 1 > RGI_STACK) return walk_node_below(lattice, b, n);
    uint32_t met = flip_order(meet_octants(n, b, t), b->negative);
    while (met) {
        uint32_t i = 31 - (uint32_t)__builtin_clz(met), lane = i ^ b->negative;
        push(b, n->child[lane], t[lane]);
        met ^= 1u << i;
    }
    if (n->own) push(b, n->own, from);
    return false;
}

/* One step on the way of a ray: asks what waits, or looks into the next node or block. Returns false at the end. */
RGI_INLINE bool step(const rgi_lattice *lattice, rgi_beam *b, bool ahead) {
    if (b->waiting && ask_waiting(lattice, b)) return false;
    rgi_visit_later next;
    do {
        if (b->depth == 0) return false;
        next = b->stack[--b->depth];
    } while (next.t > b->t_max);
    b->nodes++;
    if (rgi_ref_kind(next.ref) == RGI_REF_NODE) {
        if (visit_node(lattice, b, rgi_node_at(lattice, rgi_ref_index(next.ref)), next.t)) return false;
    } else {
        rgi_block *block = rgi_block_at(lattice, next.ref);
        uint32_t kind = rgi_ref_kind(next.ref);
        if (block->next) push(b, block->next, next.t);
        b->waiting = meet_block(block, kind, b, b->t);
        b->block = next.ref;
        if (!ahead) return true;
        const uint32_t *slots = rgi_block_slots(block, kind);
        for (uint32_t rest = b->waiting; rest; rest &= rest - 1)
            __builtin_prefetch(rgi_slots_at(lattice->objects, slots[__builtin_ctz(rest)]));
    }
    if (ahead && b->depth) fetch_ahead(lattice, b->stack[b->depth - 1].ref);
    return true;
}

static void trace_one(const rgi_lattice *lattice, rgi_beam *b) {
    while (step(lattice, b, false)) continue;
}

static void trace_some(const rgi_lattice *lattice, rgi_beam *beams, uint32_t count) {
    rgi_beam *active[RGI_PACKET];
    for (uint32_t i = 0; i < count; i++) active[i] = &beams[i];
    while (count) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < count; i++) {
            if (step(lattice, active[i], true)) active[kept++] = active[i];
        }
        count = kept;
    }
}

const rgi_kernels RGI_PASTE(rgi_kernels_, RGI_NAME) = {RGI_TEXT(RGI_NAME), trace_one, trace_some};
