/* SPDX-License-Identifier: MIT */
/*
 * The kernels, written once: each file kernels_*.c names an instruction set in RGI_ISA and includes this.
 *
 * Everything here passes over what can't be met, and asks for the rest. Bounds are explained in lattice.c (PAD) and
 * beam.c; constants below name their share.
 */
#include "mesh_ray.h"
#include "simd.h"

#include <float.h>
#include <raygrid/shape.h>

#include "kernels_bundle.h"

#define RGI_PASTE2(a, b) a##b
#define RGI_PASTE(a, b) RGI_PASTE2(a, b)
#define RGI_TEXT2(a) #a
#define RGI_TEXT(a) RGI_TEXT2(a)

/* What rounding can make of the place where a ball is met, relative to its radius: see lattice.c, PAD. */
#define BALL_PAD 0x1p-19f

/* Which octant comes last, last but one, ..., first for rays that run down along the axes named by bits. */
static const uint32_t orders[8][8] __attribute__((aligned(32))) = {
    {7, 6, 5, 4, 3, 2, 1, 0}, {6, 7, 4, 5, 2, 3, 0, 1}, {5, 4, 7, 6, 1, 0, 3, 2}, {4, 5, 6, 7, 0, 1, 2, 3},
    {3, 2, 1, 0, 7, 6, 5, 4}, {2, 3, 0, 1, 6, 7, 4, 5}, {1, 0, 3, 2, 5, 4, 7, 6}, {0, 1, 2, 3, 4, 5, 6, 7}};

/* --------------------------------------------------------------------------------- one ray, 8 or 16 bounds */

/* Of 8 boxes, those that the ray may meet, as bits; *t: where. */
RGI_INLINE uint32_t meet_octants(const float *planes, const rgi_beam *b, f8 *t) {
    f8 first = f8_set(b->t_min), last = f8_set(b->t_max);
    for (int a = 0; a < 3; a++) {
        f8 inverse = f8_set(b->inverse[a]);
        first = f8_max(f8_fma(f8_load(planes + b->towards[a]), inverse, f8_set(b->near[a])), first);
        last = f8_min(f8_fma(f8_load(planes + b->away[a]), inverse, f8_set(b->far[a])), last);
    }
    *t = first;
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

/* Squares of less underflow: balls as small are always asked. */
#define SMALLEST 0x1p-50f

/* The smallest ball that the real one can be, which is `radius` large at the most, for rays that come `along` so far.
 */
RGI_INLINE f16 least_radius(f16 radius, f16 along, f16 pad) {
    f16 way = f16_add(radius, f16_max(along, f16_sub(f16_set(0), along)));
    return f16_sub(f16_sub(radius, f16_mul(way, f16_set(0x1p-16f))), f16_mul(pad, f16_set(8)));
}

/* By the foot of the perpendicular from the centre: see lib/sphere.c. *certain: bits of those that are met for sure,
 * in range; only where any hit will do. */
RGI_INLINE uint32_t meet_balls(const float *f, uint32_t room, const rgi_beam *b, float t[RGI_BLOCK],
                               uint32_t *certain) {
    f16 to[3], along = f16_set(0), square = f16_set(0), pad = f16_set(b->pad), zero = f16_set(0);
    for (uint32_t a = 0; a < 3; a++) {
        to[a] = f16_sub(f16_load(f + a * room), f16_set(b->origin[a]));
        along = f16_fma(to[a], f16_set(b->direction[a]), along);
    }
    for (int a = 0; a < 3; a++) {
        f16 foot = f16_fma(along, f16_set(-b->direction[a]), to[a]);
        square = f16_fma(foot, foot, square);
    }
    f16 radius = f16_add(f16_load(f + 3 * room), pad);
    f16 inside = f16_sub(f16_mul(radius, radius), square);
    uint32_t met = f16_le(zero, inside);
    if (!met) return 0;
    f16 half = f16_fma(radius, f16_set(BALL_PAD), f16_sqrt(f16_max(inside, zero)));
    f16 first = f16_sub(along, half);
    f16_store(t, first);
    met &= f16_le(first, f16_set(b->t_max)) & f16_le(f16_set(b->t_min), f16_add(along, half));
    if (b->any && met) {
        /* What is met at all is met before its middle. */
        f16 least = least_radius(radius, along, pad);
        *certain = met & f16_le(square, f16_mul(least, least)) & f16_le(f16_set(SMALLEST), least) &
                   f16_le(f16_set(b->t_after), first) & f16_le(along, f16_set(b->t_before));
    }
    return met;
}

RGI_INLINE uint32_t used_lanes(const rgi_block *block) {
    return (1u << block->count) - 1;
}

/* Objects of a block that the ray may meet. Where any hit will do and one is certain, the ray has it and none is
 * left. */
RGI_INLINE uint32_t meet_block(const rgi_block *block, rgi_beam *b) {
    uint32_t room = rgi_block_room(block->kind), certain = 0, used = used_lanes(block);
    const float *lanes = rgi_block_lanes(block, room);
    if (block->kind & RGI_BOXES) return used & meet_boxes(lanes, room, b, b->t);
    uint32_t met = used & meet_balls(lanes, room, b, b->t, &certain);
    if (!(certain & used)) return met;
    b->hit = true;
    b->depth = 0;
    return 0;
}

static void unite_block(const rgi_block *block, float lo[3], float hi[3]) {
    uint32_t room = rgi_block_room(block->kind), used = used_lanes(block);
    const float *lanes = rgi_block_lanes(block, room);
    bool boxes = block->kind & RGI_BOXES;
    for (int a = 0; a < 3; a++) {
        f16 at = f16_load(lanes + (uint32_t)a * room), other = f16_load(lanes + (boxes ? a + 3u : 3u) * room);
        f16 least = boxes ? at : f16_sub(at, other), most = boxes ? other : f16_add(at, other);
        float low = f16_least(f16_pick(used, least, f16_set(INFINITY)));
        float high = f16_most(f16_pick(used, most, f16_set(-INFINITY)));
        if (low < lo[a]) lo[a] = low;
        if (high > hi[a]) hi[a] = high;
    }
}

/* ------------------------------------------------------------------------------------------- rays on their own */

/* Bit i of the result is bit i ^ flip of `bits`: octants in the order in which a ray comes to them. */
RGI_INLINE uint32_t flip_order(uint32_t bits, uint32_t flip) {
    if (flip & 1) bits = (bits & 0x55) << 1 | (bits >> 1 & 0x55);
    if (flip & 2) bits = (bits & 0x33) << 2 | (bits >> 2 & 0x33);
    if (flip & 4) bits = (bits & 0x0F) << 4 | bits >> 4;
    return bits;
}

#if !defined(RGI_NO_MESH)
#include "kernels_mesh.h"
#endif

/* Asks about one object. Returns true if the walk is to end, or is at the door of a mesh. */
RGI_INLINE bool ask_one(rgi_beam *b, uint32_t slot) {
    rgi_entered entered = b->lanes ? b->enter(b, slot) : RGI_NO_MESH_THERE;
    return entered == RGI_NO_MESH_THERE ? b->ask(b, slot) : entered == RGI_AT_DOOR;
}

/* Asks the objects that wait, the nearest first. Returns true if the walk is to end, or is at the door of a
 * mesh. */
RGI_INLINE bool ask_waiting(const rgi_lattice *lattice, rgi_beam *b) {
    const uint32_t *slots = rgi_block_at(lattice, b->block)->slots;
    uint32_t waiting = b->waiting;
    b->waiting = 0;
    while (waiting) {
        uint32_t next = (uint32_t)__builtin_ctz(waiting);
        for (uint32_t rest = waiting & (waiting - 1); rest; rest &= rest - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(rest);
            if (b->t[i] < b->t[next]) next = i;
        }
        if (b->t[next] > b->t_max) return false;
        waiting &= ~(1u << next);
        if (ask_one(b, slots[next])) {
            b->waiting = waiting;
            return true;
        }
    }
    return false;
}

static bool walk_below(const rgi_lattice *lattice, rgi_beam *b, rgi_ref ref);

/* By recursion: where the stack is full. Nodes are at most so many levels deep as there are sizes of cells. From
 * there no ray can stop at a door: meshes are asked at once. */
static bool walk_node_below(const rgi_lattice *lattice, rgi_beam *b, const rgi_node *n) {
    float t[RGI_OCTANTS];
    f8 first;
    if (n->own && walk_below(lattice, b, n->own)) return true;
    uint32_t met = meet_octants(n->lo[0], b, &first);
    f8_store(t, first);
    for (uint32_t i = RGI_OCTANTS; i-- > 0;) {
        uint32_t octant = orders[b->negative][i];
        if (!(met >> octant & 1) || t[octant] > b->t_max) continue;
        if (walk_below(lattice, b, n->child[octant])) return true;
    }
    return false;
}

static bool walk_below(const rgi_lattice *lattice, rgi_beam *b, rgi_ref ref) {
    if (!rgi_is_block(ref)) {
        b->nodes++;
        return walk_node_below(lattice, b, rgi_arena_at(&lattice->arena, ref));
    }
    for (; ref; ref = rgi_block_at(lattice, ref)->next) {
        b->nodes++;
        b->block = ref;
        b->waiting = meet_block(rgi_block_at(lattice, ref), b);
        if (b->hit) return true;
        if (ask_waiting(lattice, b)) return true;
    }
    return false;
}

RGI_INLINE void push(rgi_beam *b, rgi_ref ref, float t) {
    b->refs[b->depth] = ref;
    b->ts[b->depth++] = t;
}

RGI_INLINE void fetch_ahead(const rgi_lattice *lattice, rgi_ref ref) {
    const char *at = rgi_arena_at(&lattice->arena, ref);
    for (int i = 0; i < 4; i++) __builtin_prefetch(at + RGI_LINE * i);
}

/* Returns true if the walk is to end. */
RGI_INLINE bool visit_node(const rgi_lattice *lattice, rgi_beam *b, const rgi_node *n, float from) {
    f8 t;
    /* Room for 8 children, 8 more that are written and not kept, and its own chain. */
    if (b->depth + 2 * RGI_OCTANTS + 1 > RGI_STACK) {
        struct rgi_mesh_lanes *lanes = b->lanes;
        b->lanes = NULL;
        bool ends = walk_node_below(lattice, b, n);
        b->lanes = lanes;
        return ends;
    }
    uint32_t met = meet_octants(n->lo[0], b, &t);
    b->depth += f8_keep(met, orders[b->negative], t, n->child, b->ts + b->depth, b->refs + b->depth);
    if (n->own) push(b, n->own, from);
    return false;
}

/* One step on the way of a ray: asks what waits, or looks into the next node or block. Returns false at the end, and
 * at the door of a mesh. */
RGI_INLINE bool step(const rgi_lattice *lattice, rgi_beam *b, bool ahead) {
    if (b->waiting && ask_waiting(lattice, b)) return false;
    rgi_ref ref;
    float t;
    do {
        if (b->depth == 0) return false;
        t = b->ts[--b->depth];
    } while (t > b->t_max);
    ref = b->refs[b->depth];
    b->nodes++;
    if (!rgi_is_block(ref)) {
        if (visit_node(lattice, b, rgi_arena_at(&lattice->arena, ref), t)) return false;
    } else {
        const rgi_block *block = rgi_block_at(lattice, ref);
        if (block->next) push(b, block->next, t);
        b->waiting = meet_block(block, b);
        b->block = ref;
        if (!ahead) return true;
        for (uint32_t rest = b->waiting; rest; rest &= rest - 1)
            __builtin_prefetch(rgi_slots_at(lattice->objects, block->slots[__builtin_ctz(rest)]));
    }
    if (ahead && b->depth) fetch_ahead(lattice, b->refs[b->depth - 1]);
    return true;
}

/*
 * Alone, a ray waits for each result: so the nearest octant is gone into at once, without a way over the stack, and
 * only the others are put there.
 */
static void trace_one(const rgi_lattice *lattice, rgi_beam *b) {
    for (;;) {
        float t;
        do {
            if (b->depth == 0) return;
            t = b->ts[--b->depth];
        } while (t > b->t_max);
        rgi_ref ref = b->refs[b->depth];
        while (!rgi_is_block(ref)) {
            const rgi_node *n = rgi_arena_at(&lattice->arena, ref);
            f8 ts;
            b->nodes++;
            if (b->depth + 2 * RGI_OCTANTS + 1 > RGI_STACK) {
                if (walk_node_below(lattice, b, n)) return;
                ref = 0;
                break;
            }
            uint32_t met = meet_octants(n->lo[0], b, &ts);
            if (n->own || !met) {
                b->depth += f8_keep(met, orders[b->negative], ts, n->child, b->ts + b->depth, b->refs + b->depth);
                ref = n->own;
                break;
            }
            uint32_t nearest = (uint32_t)__builtin_ctz(flip_order(met, b->negative)) ^ b->negative;
            ref = n->child[nearest];
            met &= ~(1u << nearest);
            if (met)
                b->depth += f8_keep(met, orders[b->negative], ts, n->child, b->ts + b->depth, b->refs + b->depth);
        }
        for (; ref; ref = rgi_block_at(lattice, ref)->next) {
            b->nodes++;
            b->block = ref;
            b->waiting = meet_block(rgi_block_at(lattice, ref), b);
            if (b->waiting && ask_waiting(lattice, b)) return;
            if (b->hit) return;
        }
    }
}

#include "kernels_packet.h"

#if !defined(RGI_NO_MESH)
#include "kernels_build.h"
#include "kernels_mesh_enter.h"
#include "kernels_mesh_triangles.h"

#include "kernels_mesh_lanes.h"
#include "kernels_mesh_packet.h"
#else
#define mesh_side_by_side(lanes) ((void)(lanes))
#endif

/* Takes the rays that are at doors through the meshes. Lists those that go on; returns how many. */
RGI_INLINE uint32_t go_through_meshes(rgi_mesh_lanes *l, rgi_beam *active[RGI_SIDE_BY_SIDE]) {
    uint32_t kept = 0;
    mesh_side_by_side(l);
    for (uint32_t i = 0; i < l->count; i++) {
        if (!l->beams[i]->leave(l->beams[i], i)) active[kept++] = l->beams[i];
    }
    l->count = 0;
    return kept;
}

static void trace_some(const rgi_lattice *lattice, rgi_beam *beams, uint32_t count) {
    rgi_beam *active[RGI_SIDE_BY_SIDE];
    rgi_mesh_lanes *lanes = beams[0].lanes;
    for (uint32_t i = 0; i < count; i++) active[i] = &beams[i];
    while (count) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < count; i++) {
            if (step(lattice, active[i], true)) active[kept++] = active[i];
        }
        count = kept || !lanes || !lanes->count ? kept : go_through_meshes(lanes, active);
    }
}

#if defined(RGI_NO_MESH)
#define mesh_one NULL
#define mesh_enter NULL
#define mesh_packet NULL
#define mesh_apart NULL
#define find_split NULL
#define measure_leaf NULL
#define wrap_items NULL
#define part_items NULL
#define part_few NULL
#endif

const rgi_kernels RGI_PASTE(rgi_kernels_, RGI_NAME) = {
    RGI_TEXT(RGI_NAME), RGI_ISA,    unite_block,   prepare,      to_frame,   bound,       meet,
    trace_one,          trace_some, trace_frustum, trace_frusta, mesh_one,   mesh_enter,  mesh_packet,
    mesh_apart,         find_split, part_items,    part_few,     wrap_items, measure_leaf};
