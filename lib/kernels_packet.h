/* SPDX-License-Identifier: MIT */
/* The part of the kernels for rays that go the same way; included by kernels.h alone, after what it builds on. */

/*
 * Nodes are at most some 103 levels deep: one for each width of cells from 2^-40 to 2^63. Each leaves 8 entries at
 * the most when the next is looked into.
 */
enum { FRUSTUM_STACK = 1024 };

/* With so few rays a packet left that have hit nothing, boxes are tested for each ray before they are entered. */
enum { THIN = 8 };

typedef struct frustum_stack {
    uint32_t depth;
    float most; /* of t_hi: what is farther concerns no ray any more */
    bool thin;  /* few rays have not hit anything yet */
    float ts[FRUSTUM_STACK];
    rgi_ref refs[FRUSTUM_STACK];
} frustum_stack;

/* A box's planes are six arrays, lo[3] and hi[3], `room` floats apart: this is the number of one. */
RGI_INLINE uint32_t end_of(uint32_t axis, bool hi) {
    return hi ? axis + 3 : axis;
}

/* Boxes that some ray may meet, as bits; *t: a bound from below of where. */
#define MEET_TOGETHER(wide, lanes)                                                                                   \
    RGI_INLINE uint32_t meet_together_##wide(const float *planes, uint32_t room, const rgi_frustum *f, float most,   \
                                             wide *t) {                                                              \
        uint32_t met = (uint32_t)((1ull << (lanes)) - 1);                                                            \
        for (int i = 0; i < 2; i++) {                                                                                \
            wide below = wide##_fma(wide##_set(-f->slope_hi[i]), wide##_load(planes + f->far_of_hi[i] * room),       \
                                    wide##_load(planes + f->across[i] * room));                                      \
            wide above = wide##_fma(wide##_set(-f->slope_lo[i]), wide##_load(planes + f->far_of_lo[i] * room),       \
                                    wide##_load(planes + (f->across[i] + 3) * room));                                \
            met &= wide##_le(below, wide##_set(f->hi[i])) & wide##_le(wide##_set(f->lo[i]), above);                  \
        }                                                                                                            \
        wide sense = wide##_set(f->sense), back = wide##_mul(wide##_load(planes + f->back * room), sense);           \
        *t = wide##_fma(wide##_load(planes + f->front * room), sense, wide##_set(-f->start_last));                   \
        return met & wide##_le(*t, wide##_set(most)) & wide##_le(wide##_set(f->start_first), back);                  \
    }

MEET_TOGETHER(f8, 8)
MEET_TOGETHER(f16, 16)

/* The same for balls. */
RGI_INLINE uint32_t meet_balls_together(const float *lanes, uint32_t room, const rgi_frustum *f, float most) {
    uint32_t met = 0xFFFF;
    f16 along = f16_load(lanes + f->axis * room),
        radius = f16_add(f16_load(lanes + 3 * room), f16_set(4 * f->pad_most));
    for (int i = 0; i < 2; i++) {
        f16 across = f16_load(lanes + f->across[i] * room);
        f16 below = f16_sub(f16_fma(f16_set(-f->slope_hi[i]), along, across), f16_set(f->hi[i]));
        f16 above = f16_sub(f16_set(f->lo[i]), f16_fma(f16_set(-f->slope_lo[i]), along, across));
        met &= f16_le(below, f16_mul(radius, f16_set(f->norm_hi[i])));
        met &= f16_le(above, f16_mul(radius, f16_set(f->norm_lo[i])));
    }
    along = f16_mul(along, f16_set(f->sense));
    met &= f16_le(f16_sub(f16_sub(along, radius), f16_set(f->start_last)), f16_set(most));
    return met & f16_le(f16_set(f->start_first), f16_add(along, radius));
}

/* Asks about one object for one ray, after the one that was certain so far. */
static void settle(rgi_packet *p, uint32_t ray, uint32_t slot) {
    uint32_t bit = 1u << ray, best;
    bool end = false;
    if (p->certain & bit) {
        memcpy(&best, &p->best[ray], sizeof best);
        p->certain &= ~bit;
        end = p->ask(p, ray, best);
    }
    if (!end) end = p->ask(p, ray, slot);
    if (end) p->active &= ~bit;
}

static void settle_all(rgi_packet *p, uint32_t rays, uint32_t slot) {
    for (; rays; rays &= rays - 1) settle(p, (uint32_t)__builtin_ctz(rays), slot);
}

/*
 * The same for a ball that some rays may meet and are not certain of, as those that begin on its surface: it is met
 * with all at once. Rays that have met nothing so far need no more; others compare.
 */
static void settle_ball(const rgi_lattice *lattice, rgi_packet *p, uint32_t rays, uint32_t slot) {
    rgi_meeting m;
    float bits;
    if (p->ask_all || !(rays & (rays - 1))) {
        settle_all(p, rays, slot);
        return;
    }
    const rgi_object *object = rgi_slots_at(lattice->objects, slot);
    for (int a = 0; a < 3; a++) LANES(i) m.centre[a][i] = object->position[a];
    LANES(i) m.radius[i] = object->reach;
    m.wants_normals = false;
    meet(p->bundle, &m);
    uint32_t met = rays & m.met, compare = met & (p->certain | p->found);
    p->certain |= met & ~compare;
    if (p->any) {
        p->certain |= met;
        p->active &= ~met;
        return;
    }
    settle_all(p, compare, slot);
    memcpy(&bits, &slot, sizeof bits);
    for (met &= ~compare; met; met &= met - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(met);
        const rgi_beam_scale scale = {p->shift[i], p->length[i]};
        p->best[i] = bits;
        p->t_lo[i] = rgi_beam_below(&scale, p->pad[i], m.scaled_t[i]);
        p->t_hi[i] = rgi_beam_above(&scale, p->pad[i], m.scaled_t[i]);
    }
}

/* Slopes against the axis may differ by so many times the spacing of objects (measured: from 10^3 to 10^6 spheres
 * best near 0.4, 0.15, 0.08 and 0.04; of several packets, whose rays are to meet mostly the same objects, less), and
 * the rays begin, or end, so far apart, in radii of all that is stored: beyond it what is passed over for one ray
 * hardly ever is for all. */
#define SLOPES 4
#define SLOPES_OF_SEVERAL 1
#define APART 0.1f

/* Slopes are widened by what rounding a direction and its inverse can change of them. */
#define SLOPE_PAD 0x1p-20f

/* What many numbers lie between. */
typedef struct span {
    f16 least, most;
} span;

RGI_INLINE span span_of_none(void) {
    span s = {f16_set(INFINITY), f16_set(-INFINITY)};
    return s;
}

RGI_INLINE void span_add(span *s, f16 numbers) {
    s->least = f16_min(s->least, numbers);
    s->most = f16_max(s->most, numbers);
}

RGI_INLINE float span_width(const span *s) {
    return f16_most(s->most) - f16_least(s->least);
}

/*
 * The two planes across one axis. They go through the ends of the rays that lie closer together: where they begin, as
 * those from a camera, or where they end, as those to a light; and open towards the other ends.
 */
RGI_INLINE bool bound_slopes(rgi_frustum *f, uint32_t which, float radius, float spacing) {
    const uint32_t a = f->across[which], k = f->axis;
    span slopes = span_of_none(), begins = span_of_none(), ends = span_of_none();
    for (uint32_t n = 0; n < f->count; n++) {
        const rgi_packet *p = f->packets[n];
        /* Per length of way along the axis, whichever its sense. */
        f16 per_way = f16_mul(f16_load(p->inverse[k]), f16_set(f->sense));
        span_add(&slopes, f16_mul(f16_load(p->direction[a]), per_way));
    }
    float least = f16_least(slopes.least), most = f16_most(slopes.most);
    if (!(most - least <= (float)(f->count > 1 ? SLOPES_OF_SEVERAL : SLOPES) * spacing)) return false;
    /* How far apart they are across the way that they go; where they end, as far as that is known: rays to a sun that
     * end nowhere seem to meet there. */
    f16 slope = f16_set(-0.5f * f->sense * (least + most));
    for (uint32_t n = 0; n < f->count; n++) {
        const rgi_packet *p = f->packets[n];
        f16 t = f16_load(p->t_hi), o = f16_load(p->origin[a]), along = f16_load(p->origin[k]);
        f16 end = f16_fma(t, f16_load(p->direction[a]), o), lost = f16_mul(t, f16_set(0x1p-20f));
        span_add(&begins, f16_fma(slope, along, o));
        end = f16_fma(slope, f16_fma(t, f16_load(p->direction[k]), along), end);
        span_add(&ends, f16_sub(end, lost));
        span_add(&ends, f16_add(end, lost));
    }
    least -= SLOPE_PAD * (1 + fabsf(least));
    most += SLOPE_PAD * (1 + fabsf(most));
    float begin_apart = span_width(&begins), end_apart = span_width(&ends);
    bool backward = end_apart < begin_apart;
    if (!((backward ? end_apart : begin_apart) <= APART * radius)) return false;
    f->slope_lo[which] = f->sense * (backward ? most : least);
    f->slope_hi[which] = f->sense * (backward ? least : most);
    f->far_of_hi[which] = end_of(k, f->slope_hi[which] >= 0);
    f->far_of_lo[which] = end_of(k, f->slope_lo[which] < 0);
    f16 lo = f16_set(INFINITY), hi = f16_set(-INFINITY);
    for (uint32_t n = 0; n < f->count; n++) {
        const rgi_packet *p = f->packets[n];
        f16 o = f16_load(p->origin[a]), along = f16_load(p->origin[k]), pad = f16_mul(f16_load(p->pad), f16_set(4));
        if (backward) {
            f16 t = f16_load(p->t_hi);
            o = f16_fma(t, f16_load(p->direction[a]), o);
            along = f16_fma(t, f16_load(p->direction[k]), along);
            pad = f16_fma(t, f16_set(0x1p-20f), pad);
        }
        lo = f16_min(lo, f16_sub(f16_fma(f16_set(-f->slope_lo[which]), along, o), pad));
        hi = f16_max(hi, f16_add(f16_fma(f16_set(-f->slope_hi[which]), along, o), pad));
    }
    f->lo[which] = f16_least(lo);
    f->hi[which] = f16_most(hi);
    f->norm_lo[which] = (1 + 0x1p-20f) * sqrtf(1 + f->slope_lo[which] * f->slope_lo[which]);
    f->norm_hi[which] = (1 + 0x1p-20f) * sqrtf(1 + f->slope_hi[which] * f->slope_hi[which]);
    return true;
}

/* The axis along which the rays run, by the first of them. */
static void choose_axis(rgi_frustum *f) {
    const rgi_packet *p = f->packets[0];
    float d[3] = {fabsf(p->direction[0][0]), fabsf(p->direction[1][0]), fabsf(p->direction[2][0])};
    f->axis = d[1] > d[0] ? 1 : 0;
    if (d[2] > d[f->axis]) f->axis = 2;
    f->across[0] = (f->axis + 1) % 3;
    f->across[1] = (f->axis + 2) % 3;
    bool down = p->inverse[f->axis][0] < 0;
    f->sense = down ? -1.0f : 1.0f;
    f->front = end_of(f->axis, down);
    f->back = end_of(f->axis, !down);
    f->negative = 0;
    for (uint32_t a = 0; a < 3; a++) f->negative |= (uint32_t)(p->inverse[a][0] < 0) << a;
}

/* Whether all run in one sense, not too steeply across it, and none has anything before it to look at: what lies
 * behind an origin is out of the planes. Then: where they begin along the axis. */
static bool bound_starts(rgi_frustum *f, const rgi_middle *middle) {
    f16 least_way = f16_set(INFINITY), first = least_way, last = f16_set(-INFINITY), most_pad = f16_set(0);
    uint32_t looks_back = 0;
    for (uint32_t n = 0; n < f->count; n++) {
        const rgi_packet *p = f->packets[n];
        f16 sense = f16_set(f->sense), start = f16_mul(f16_load(p->origin[f->axis]), sense);
        f16 pad = f16_mul(f16_load(p->pad), f16_set(4));
        f16 behind = f16_sub(f16_set(0), f16_fma(pad, f16_set(4), f16_set(0x1p-60f)));
        least_way = f16_min(least_way, f16_mul(f16_load(p->direction[f->axis]), sense));
        looks_back |= f16_le(f16_load(p->t_first), behind);
        first = f16_min(first, f16_sub(start, pad));
        last = f16_max(last, f16_add(start, pad));
        most_pad = f16_max(most_pad, f16_load(p->pad));
    }
    if (looks_back || f16_least(least_way) < 0.25f) return false;
    f->start_first = f16_least(first);
    /* A t is at least the way along the axis, but for what rounding makes of directions. */
    f->start_last = f16_most(last);
    f->start_last += 0x1p-18f * (fabsf(f->start_last) + (float)middle->extent);
    f->pad_most = f16_most(most_pad);
    return true;
}

static bool bound_in(rgi_frustum *f, double scale, const rgi_middle *middle) {
    float radius = (float)(middle->radius * scale);
    f->visits = 0;
    choose_axis(f);
    return bound_starts(f, middle) && bound_slopes(f, 0, radius, middle->spacing) &&
           bound_slopes(f, 1, radius, middle->spacing);
}

static bool bound(rgi_frustum *f, const rgi_lattice *lattice, const rgi_middle *middle) {
    return bound_in(f, lattice->scale, middle);
}

/* One ball, all rays. Returns whether t_hi of some ray may have changed. */
RGI_INLINE bool meet_ball(const rgi_lattice *lattice, rgi_packet *p, const float centre[3], float r, uint32_t slot) {
    f16 to[3], along = f16_set(0), square = f16_set(0), pad = f16_load(p->pad);
    for (int a = 0; a < 3; a++) {
        to[a] = f16_sub(f16_set(centre[a]), f16_load(p->origin[a]));
        along = f16_fma(to[a], f16_load(p->direction[a]), along);
    }
    for (int a = 0; a < 3; a++) {
        f16 foot = f16_sub(to[a], f16_mul(along, f16_load(p->direction[a])));
        square = f16_fma(foot, foot, square);
    }
    f16 radius = f16_add(f16_set(r), pad), zero = f16_set(0);
    f16 inside = f16_sub(f16_mul(radius, radius), square);
    uint32_t met = f16_le(zero, inside) & p->active;
    if (!met) return false;
    f16 half = f16_fma(radius, f16_set(BALL_PAD), f16_sqrt(f16_max(inside, zero)));
    f16 first = f16_sub(along, half), t_hi = f16_load(p->t_hi);
    met &= f16_le(first, t_hi) & f16_le(f16_load(p->t_first), f16_add(along, half));
    if (!met) return false;
    uint32_t certain = 0;
    if (!p->ask_all) {
        f16 way = f16_add(radius, f16_max(along, f16_sub(zero, along)));
        f16 least = least_radius(radius, along, pad);
        /* The latest t at which it can be met. */
        f16 within = f16_sub(f16_mul(least, least), square);
        f16 latest = f16_sub(along, f16_sqrt(f16_max(within, zero)));
        latest = f16_add(f16_fma(way, f16_set(0x1p-18f), latest), f16_mul(pad, f16_set(4)));
        f16 t_lo = f16_load(p->t_lo);
        certain = met & f16_le(zero, within) & f16_le(f16_set(SMALLEST), least) & f16_le(f16_load(p->t_min), first);
        certain &= ~f16_le(t_lo, latest);
        if (certain) __builtin_prefetch(rgi_slots_at(lattice->objects, slot));
        if (p->any) {
            p->certain |= certain;
            p->active &= ~certain;
        } else {
            float bits;
            memcpy(&bits, &slot, sizeof bits);
            f16_store(p->t_lo, f16_pick(certain, first, t_lo));
            f16_store(p->t_hi, f16_pick(certain, latest, t_hi));
            f16_store(p->best, f16_pick(certain, f16_set(bits), f16_load(p->best)));
            p->certain |= certain;
        }
    }
    if (met & ~certain) settle_ball(lattice, p, met & ~certain, slot);
    return true;
}

RGI_INLINE bool meet_box(rgi_packet *p, const float *lo, const float *hi, uint32_t room, uint32_t slot) {
    f16 first = f16_load(p->t_first), last = f16_load(p->t_hi);
    for (uint32_t a = 0; a < 3; a++) {
        f16 inverse = f16_load(p->inverse[a]);
        f16 one = f16_mul(f16_set(lo[a * room]), inverse), other = f16_mul(f16_set(hi[a * room]), inverse);
        first = f16_max(f16_add(f16_min(one, other), f16_load(p->near[a])), first);
        last = f16_min(f16_add(f16_max(one, other), f16_load(p->far[a])), last);
    }
    uint32_t met = f16_le(first, last) & p->active;
    if (!(met & (met - 1)) || !p->ask_mesh(p, met, slot)) settle_all(p, met, slot);
    return met != 0;
}

RGI_INLINE uint32_t meet_planes(const rgi_packet *p, const float *planes) {
    f16 first = f16_load(p->t_first), last = f16_load(p->t_hi);
    for (uint32_t a = 0; a < 3; a++) {
        f16 inverse = f16_load(p->inverse[a]);
        f16 one = f16_mul(f16_set(planes[a * RGI_OCTANTS]), inverse);
        f16 other = f16_mul(f16_set(planes[(a + 3) * RGI_OCTANTS]), inverse);
        first = f16_max(f16_add(f16_min(one, other), f16_load(p->near[a])), first);
        last = f16_min(f16_add(f16_max(one, other), f16_load(p->far[a])), last);
    }
    return f16_le(first, last) & p->active;
}

/* Whether any ray still on its way meets the box that a node keeps of its child: rays that have hit something nearer
 * no more do, which the planes around all of them can't tell. */
RGI_INLINE bool meet_child(const rgi_lattice *lattice, const rgi_frustum *f, uint32_t parent) {
    if (parent == RGI_ROOT || (parent & 15) == RGI_OWN) return true;
    const float *planes = rgi_node_at(lattice, parent >> 4)->lo[0] + (parent & 15);
    for (uint32_t n = 0; n < f->count; n++) {
        if (f->packets[n]->active && meet_planes(f->packets[n], planes)) return true;
    }
    return false;
}

/* How far the rays that are still on their way go. */
RGI_INLINE f16 reaches(const rgi_packet *p) {
    return f16_pick(p->active, f16_load(p->t_hi), f16_set(-INFINITY));
}

/* Looks anew at how far the rays go. Returns whether any is still on its way. */
RGI_INLINE bool look_ahead(const rgi_frustum *f, frustum_stack *s) {
    f16 most = f16_set(-INFINITY);
    uint32_t active = 0;
    int open = 0;
    for (uint32_t n = 0; n < f->count; n++) {
        const rgi_packet *p = f->packets[n];
        most = f16_max(most, reaches(p));
        active |= p->active;
        open += __builtin_popcount(p->active & ~p->certain);
    }
    s->most = f16_most(most);
    s->thin = open <= THIN * (int)f->count;
    return active != 0;
}

RGI_INLINE void visit_block(const rgi_lattice *lattice, rgi_frustum *f, frustum_stack *s, const rgi_block *block) {
    uint32_t room = rgi_block_room(block->kind), met;
    const float *lanes = rgi_block_lanes(block, room);
    bool boxes = block->kind & RGI_BOXES, changed = false;
    f16 t;
    if (boxes)
        met = meet_together_f16(lanes, room, f, s->most, &t);
    else
        met = meet_balls_together(lanes, room, f, s->most);
    for (met &= used_lanes(block); met; met &= met - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(met);
        const float centre[3] = {lanes[i], lanes[room + i], lanes[2 * room + i]};
        for (uint32_t n = 0; n < f->count; n++) {
            if (boxes)
                changed |= meet_box(f->packets[n], lanes + i, lanes + 3 * room + i, room, block->slots[i]);
            else
                changed |= meet_ball(lattice, f->packets[n], centre, lanes[3 * room + i], block->slots[i]);
        }
    }
    if (changed && !look_ahead(f, s)) s->depth = 0;
}

static void begin_frustum(const rgi_lattice *lattice, const rgi_frustum *f, frustum_stack *s) {
    s->refs[0] = lattice->root;
    s->ts[0] = -INFINITY;
    s->depth = look_ahead(f, s);
    s->thin = false;
}

/* Looks into the next node or block on the way. Returns false at the end. */
RGI_INLINE bool step_frustum(const rgi_lattice *lattice, rgi_frustum *f, frustum_stack *s) {
    if (!s->depth || f->visits > f->patience) return false;
    float t = s->ts[--s->depth];
    rgi_ref ref = s->refs[s->depth];
    if (t > s->most) return true;
    f->visits++;
    if (rgi_is_block(ref)) {
        const rgi_block *block = rgi_block_at(lattice, ref);
        if (s->thin && !meet_child(lattice, f, block->parent)) return true;
        if (block->next) {
            s->refs[s->depth] = block->next;
            s->ts[s->depth++] = t;
        }
        visit_block(lattice, f, s, block);
        return true;
    }
    const rgi_node *n = rgi_arena_at(&lattice->arena, ref);
    f8 ts;
    if (s->thin && !meet_child(lattice, f, n->parent)) return true;
    uint32_t met = meet_together_f8(n->lo[0], RGI_OCTANTS, f, s->most, &ts), before = s->depth;
    s->depth += f8_keep(met, orders[f->negative], ts, n->child, s->ts + s->depth, s->refs + s->depth);
    for (uint32_t i = before; i < s->depth; i++) fetch_ahead(lattice, s->refs[i]);
    if (n->own) {
        s->refs[s->depth] = n->own;
        s->ts[s->depth++] = t;
    }
    return true;
}

static void trace_frustum(const rgi_lattice *lattice, rgi_frustum *f) {
    frustum_stack s;
    begin_frustum(lattice, f, &s);
    while (step_frustum(lattice, f, &s)) continue;
}

/* Each step waits for the one before: two in turn fill each other's waits. */
static void trace_frusta(const rgi_lattice *lattice, rgi_frustum *one, rgi_frustum *other) {
    frustum_stack s1, s2;
    begin_frustum(lattice, one, &s1);
    begin_frustum(lattice, other, &s2);
    bool more1 = true, more2 = true;
    while (more1 && more2) {
        more1 = step_frustum(lattice, one, &s1);
        more2 = step_frustum(lattice, other, &s2);
    }
    while (more1) more1 = step_frustum(lattice, one, &s1);
    while (more2) more2 = step_frustum(lattice, other, &s2);
}
