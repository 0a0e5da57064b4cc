/* SPDX-License-Identifier: MIT */
/*
 * Every kernel that the machine can run, against arithmetic in long double: what a ray meets is asked, whatever the
 * sizes, the distances and the rays; what is called certain is; and what is asked besides is little. The parts in
 * double give the bits that the code for one ray gives.
 */
#include "batches.h"
#include "beam.h"
#include "crowd.h"
#include "vec.h"

#include <stdio.h>
#include <string.h>

/* Builds with sanitizers take fewer. */
enum { OBJECTS = 1500, LONE_ROUNDS = SHORT_TESTS ? 12 : 25, BATCHES = SHORT_TESTS ? 50 : 90 };

static const rgi_kernels *const ALL[] = {
#if defined(__x86_64__)
    &rgi_kernels_avx512, &rgi_kernels_avx2, &rgi_kernels_sse2,
#elif defined(__aarch64__)
    &rgi_kernels_neon,
#endif
    &rgi_kernels_portable};
enum { KERNELS = sizeof ALL / sizeof *ALL };

/* The best is the first that the machine can run; it can run all that follow. */
static bool can_run(const rgi_kernels *k) {
    int i = 0;
    while (ALL[i] != rgi_kernels_best()) i++;
    for (; i < KERNELS; i++) {
        if (ALL[i] == k) return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------- the truth */

typedef enum verdict { MISSED, MET, UNSURE } verdict;

typedef struct crossing {
    long double first, last;
} crossing;

/* Where the line enters and leaves. MISSED and MET are beyond doubt: more than some ulp of double. */
static verdict cross_ball(const rgi_bound *b, const rgi_ray *r, crossing *c) {
    long double to[3], along = 0, square = 0, distance = 0;
    for (int a = 0; a < 3; a++) {
        to[a] = (long double)r->origin[a] - b->centre[a];
        along -= to[a] * r->direction[a];
        distance += to[a] * to[a];
    }
    along /= r->dd;
    for (int a = 0; a < 3; a++) {
        long double foot = to[a] + along * r->direction[a];
        square += foot * foot;
    }
    long double foot = sqrtl(square), unsure = 0x1p-40L * b->radius + 0x1p-50L * sqrtl(distance);
    if (foot > b->radius + unsure) return MISSED;
    if (foot >= b->radius - unsure) return UNSURE;
    long double half = sqrtl((b->radius * (long double)b->radius - square) / r->dd);
    c->first = along - half;
    c->last = along + half;
    return MET;
}

static verdict cross_box(const rgi_bound *b, const rgi_ray *r, crossing *c) {
    long double from[3], to[3];
    verdict all = MET;
    c->first = -INFINITY;
    c->last = INFINITY;
    for (int a = 0; a < 3; a++) {
        from[a] = -INFINITY;
        to[a] = INFINITY;
        if (r->direction[a] == 0) {
            if (r->origin[a] < b->lo[a] || r->origin[a] > b->hi[a]) return MISSED;
            continue;
        }
        long double one = (b->lo[a] - (long double)r->origin[a]) / r->direction[a];
        long double other = (b->hi[a] - (long double)r->origin[a]) / r->direction[a];
        from[a] = fminl(one, other);
        to[a] = fmaxl(one, other);
        c->first = fmaxl(c->first, from[a]);
        c->last = fminl(c->last, to[a]);
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            long double unsure = 0x1p-50L * (fabsl(from[i]) + fabsl(to[k]));
            if (i == k || !(unsure < INFINITY)) continue;
            if (from[i] > to[k] + unsure) return MISSED;
            if (from[i] >= to[k] - unsure) all = UNSURE;
        }
    }
    return all;
}

static long double doubt(const rgi_ray *r, const rgi_bound *b, long double t) {
    long double size = 0;
    for (int a = 0; a < 3; a++) {
        size += fabsl((long double)r->origin[a] - b->centre[a]) * 0x1p-48L;
        size += 0x1p-38L * ((long double)b->hi[a] - b->lo[a]);
    }
    return size / sqrtl(r->dd) + 0x1p-48L * fabsl(t);
}

/* Whether the ray meets the surface, and where at first. */
static verdict meets(const rgi_bound *b, const rgi_ray *r, long double *t) {
    crossing c;
    verdict line = b->ball ? cross_ball(b, r, &c) : cross_box(b, r, &c);
    if (line != MET) return line;
    for (int end = 0; end < 2; end++) {
        *t = end ? c.last : c.first;
        long double unsure = doubt(r, b, *t);
        if (*t > r->t_max + unsure) return MISSED;
        if (*t > r->t_max - unsure) return UNSURE;
        if (*t >= r->t_min + unsure) return MET;
        if (*t > r->t_min - unsure) return UNSURE;
    }
    return MISSED;
}

/* Whether the range and the object, taken as solid, have a point in common, or nearly: the most that float can be
 * expected to tell. */
static bool overlaps(const rgi_bound *b, const rgi_ray *r) {
    crossing c;
    verdict line = b->ball ? cross_ball(b, r, &c) : cross_box(b, r, &c);
    return line == UNSURE || (line == MET && c.first <= r->t_max && c.last >= r->t_min);
}

/* ------------------------------------------------------------------------------------------------------ rays */

static double pick(const double *from, int count) {
    return from[(int)(unit_random() * count)];
}

static int below(int n) {
    return (int)(unit_random() * n);
}

/*
 * The direction from an eye into an object, so near to its silhouette or to an edge that the last bits of a float
 * decide: where every error that is not accounted for shows.
 */
static void graze(const rgi_bound *b, const double eye[3], double d[3]) {
    double inside = pow(2, -8 - 28 * unit_random()), along[3], across[3], distance = 0, dot = 0, length = 0;
    for (int a = 0; a < 3; a++) {
        if (!b->ball) { /* a point near one or two faces */
            double depth = below(3) ? inside : unit_random();
            double at = b->lo[a] + (below(2) ? depth : 1 - depth) * (b->hi[a] - b->lo[a]);
            d[a] = at - eye[a];
        }
        along[a] = b->centre[a] - eye[a];
        across[a] = 2 * unit_random() - 1;
        distance += along[a] * along[a];
    }
    if (!b->ball) return;
    distance = sqrt(distance);
    for (int a = 0; a < 3; a++) dot += along[a] / distance * across[a];
    for (int a = 0; a < 3; a++) across[a] -= dot * along[a] / distance, length += across[a] * across[a];
    double sine = b->radius * (1 - inside) / distance;
    for (int a = 0; a < 3; a++) {
        d[a] = 2 * unit_random() - 1;
        if (sine < 1 && length > 1e-3)
            d[a] = along[a] / distance * sqrt(1 - sine * sine) + across[a] / sqrt(length) * sine;
    }
}

/* Aimed at some object or just past it, from near or far; at times along axes, or nearly, or in a short range. */
static bool lone_ray(const crowd *c, rgi_ray *ray) {
    static const double TINY[] = {0, -0.0, 1e-300, -1e-40, 1e-18, 1e-9}, SCALES[] = {1, 1, 1, 1e-9, 1e30, 1e-200};
    static const double AWAY[] = {0, 1e-3, 1, 3, 3, 1e3, 1e7, 1e12};
    const rgi_bound *aim = &store.truth[below(OBJECTS)];
    double origin[3], d[3], away = pick(AWAY, 8) * c->spread, scale = pick(SCALES, 6), t_min = 0, t_max = INFINITY;
    double length = 0;
    do {
        length = 0;
        for (int a = 0; a < 3; a++) d[a] = 2 * unit_random() - 1, length += d[a] * d[a];
    } while (length > 1 || length < 1e-3);
    int axis = below(12);
    if (axis < 6) d[axis % 3] = pick(TINY, 6);
    if (axis < 2) d[(axis + 1) % 3] = pick(TINY, 6);
    for (int a = 0; a < 3; a++) {
        double target = aim->lo[a] + (unit_random() * 1.4 - 0.2) * (aim->hi[a] - aim->lo[a]);
        if (below(8) == 0) target = aim->centre[a];
        origin[a] = target - away * d[a];
    }
    if (below(2)) graze(aim, origin, d);
    for (int a = 0; a < 3; a++) d[a] *= scale;
    if (below(4) == 0) t_max = unit_random() * (away + c->spread) * 2 / scale;
    if (below(6) == 0) t_min = unit_random() * fmin(t_max, (away + c->spread) / scale);
    if (below(20) == 0) t_min = -INFINITY;
    return rgi_ray_init(ray, origin, d, t_min, t_max, UINT32_MAX);
}

static void fill_crowd(const crowd *c) {
    crowd_begin();
    for (uint32_t i = 0; i < OBJECTS; i++) {
        rgi_bound b = crowd_bound(c);
        if (c->balls < 1 && below(10) == 0)
            b.lo[i % 3] = b.hi[i % 3] = b.centre[i % 3], b.ball = false; /* no thickness */
        crowd_insert(i, &b);
    }
    ck_assert_uint_eq(store.lattice.unbounded_count, 0);
}

/* Level within level, all of whose octants overlap: rays meet them all, so their stacks run full. */
static void fill_nest(void) {
    crowd_begin();
    for (uint32_t i = 0; i < OBJECTS; i++) {
        double size = ldexp(1, -(int)(i / 30));
        rgi_bound b = ball_at(size * (2 * unit_random() - 1), size * (2 * unit_random() - 1),
                              size * (2 * unit_random() - 1), size);
        crowd_insert(i, &b);
    }
}

/* ---------------------------------------------------------------------------------------------- lone rays */

/* What is known of a ray on its way. */
typedef struct witness {
    const rgi_ray *ray;
    bool nearest;   /* only what is nearer than all before it is wanted */
    long double t;  /* of the nearest */
    uint32_t hit;   /* its slot */
    uint32_t count; /* that were asked */
    uint8_t asked[OBJECTS];
} witness;

static void begin_witness(witness *w, const rgi_ray *ray, bool nearest) {
    memset(w, 0, sizeof *w);
    w->ray = ray;
    w->nearest = nearest;
    w->t = INFINITY;
    w->hit = RGI_NONE;
}

/* Of two at the same t the lower slot, as in the library. Returns whether it is the nearest now. */
static bool note(witness *w, uint32_t slot) {
    long double t;
    MUST(slot < OBJECTS);
    w->asked[slot] = 1;
    w->count++;
    if (meets(&store.truth[slot], w->ray, &t) != MET || t > w->t || (t == w->t && slot > w->hit)) return false;
    w->t = t;
    w->hit = slot;
    return true;
}

static bool ask_beam(rgi_beam *beam, uint32_t slot) {
    witness *w = beam->query;
    if (note(w, slot) && w->nearest) beam->t_max = rgi_beam_above(&beam->scale, beam->pad, (double)w->t);
    return false;
}

typedef struct tally {
    uint64_t rays, met, asked, packets, certain;
} tally;

static void show_ray(const rgi_ray *r) {
    printf("ray from (%a, %a, %a) along (%a, %a, %a), t %a to %a\n", r->origin[0], r->origin[1], r->origin[2],
           r->direction[0], r->direction[1], r->direction[2], r->t_min, r->t_max);
}

/* All that the ray meets was asked; or what it meets first. */
static void judge(const witness *w, tally *all, const char *isa) {
    witness truth;
    begin_witness(&truth, w->ray, false);
    for (uint32_t slot = 0; slot < OBJECTS; slot++) {
        long double t;
        verdict v = meets(&store.truth[slot], w->ray, &t);
        all->met += overlaps(&store.truth[slot], w->ray);
        if (v == MET) {
            note(&truth, slot);
            if (w->nearest || w->asked[slot]) continue;
            show_ray(w->ray);
            ck_abort_msg("%s: object %u was passed over", isa, slot);
        }
    }
    all->rays++;
    all->asked += w->count;
    if (!w->nearest || truth.hit == w->hit) return;
    show_ray(w->ray);
    ck_assert_msg(truth.hit == RGI_NONE || fabsl(truth.t - w->t) <= doubt(w->ray, &store.truth[truth.hit], w->t),
                  "%s: object %u at %Lg is the nearest, not %u at %Lg", isa, truth.hit, truth.t, w->hit, w->t);
}

static void trace_lone(const rgi_kernels *k, const crowd *c, bool nearest, tally *all) {
    static witness witnesses[RGI_PACKET];
    static rgi_ray rays[RGI_PACKET];
    static rgi_beam beams[RGI_PACKET];
    const rgi_middle middle = rgi_lattice_middle(&store.lattice);
    for (int round = 0; round < LONE_ROUNDS; round++) {
        uint32_t count = 1 + (uint32_t)below(RGI_PACKET), used = 0;
        bool one = round % 4 == 0;
        for (uint32_t i = 0; i < count; i++) {
            if (!lone_ray(c, &rays[i])) rays[i] = rays[i ? i - 1 : 0];
            begin_witness(&witnesses[i], &rays[i], nearest);
            if (!rgi_beam_init(&beams[used], &store.lattice, &middle, &rays[i], rays[i].t_max)) continue;
            beams[used].ask = ask_beam;
            beams[used].query = &witnesses[i];
            if (one) k->trace_one(&store.lattice, &beams[used]);
            used += !one;
        }
        if (used) k->trace_some(&store.lattice, beams, used);
        for (uint32_t i = 0; i < count; i++) judge(&witnesses[i], all, k->name);
    }
}

START_TEST(lone_rays) {
    const rgi_kernels *k = ALL[_i];
    for (int n = 0; n < CROWDS && can_run(k); n++) {
        tally all = {0}, nearest = {0};
        fill_crowd(&crowds[n]);
        trace_lone(k, &crowds[n], false, &all);
        trace_lone(k, &crowds[n], true, &nearest);
        if (n == 3) ck_assert_uint_lt(nearest.asked, all.asked / 2);
        /* Some rays graze. Balls that are stored among boxes, as boxes, are asked more often. */
        if (n < 2) ck_assert_uint_le(all.asked, all.met + all.met / 20 + all.rays / 10);
        ck_assert_uint_gt(all.met, all.rays / 4);
        crowd_end();
    }
}
END_TEST

START_TEST(full_stacks) {
    const rgi_kernels *k = ALL[_i];
    const crowd c = {"nest", 0, 1, 0, 0, 1};
    tally all = {0};
    if (!can_run(k)) return;
    fill_nest();
    trace_lone(k, &c, false, &all);
    trace_lone(k, &c, true, &all);
    crowd_end();
}
END_TEST

/* ------------------------------------------------------------------------------------------------ packets */

static bool ask_packet(rgi_packet *p, uint32_t ray, uint32_t slot) {
    witness *w = (witness *)p->context + ray;
    const rgi_beam_scale scale = {p->shift[ray], p->length[ray]};
    bool first = note(w, slot);
    if (w->hit != RGI_NONE) p->found |= 1u << ray;
    if (w->hit != RGI_NONE && w->nearest) {
        p->t_hi[ray] = rgi_beam_above(&scale, p->pad[ray], (double)w->t);
        p->t_lo[ray] = rgi_beam_below(&scale, p->pad[ray], (double)w->t);
    }
    return first && p->any;
}

/* What was certain was not asked; it must be met, beyond doubt or nearly. */
static void ask_certain(rgi_packet *p, witness *witnesses, uint32_t count, tally *all, const char *isa) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot;
        long double t;
        if (!(p->certain >> i & 1)) continue;
        all->certain++;
        if (p->any) {
            witnesses[i].hit = 0; /* which one it is, is not said */
            continue;
        }
        memcpy(&slot, &p->best[i], sizeof slot);
        MUST(slot < OBJECTS);
        if (meets(&store.truth[slot], witnesses[i].ray, &t) == MISSED) {
            show_ray(witnesses[i].ray);
            ck_abort_msg("%s: object %u is certain, but missed", isa, slot);
        }
        (void)ask_packet(p, i, slot);
    }
}

static void judge_any(const witness *w, const char *isa) {
    bool met = false, perhaps = false;
    long double t;
    for (uint32_t slot = 0; slot < OBJECTS; slot++) {
        verdict v = meets(&store.truth[slot], w->ray, &t);
        met |= v == MET;
        perhaps |= v != MISSED;
    }
    bool found = w->hit != RGI_NONE;
    if ((found || !met) && (!found || perhaps)) return;
    show_ray(w->ray);
    ck_abort_msg("%s: %s", isa, found ? "found something where nothing is" : "found nothing where something is");
}

/* Takes rays through as a packet, if they go the same way. mode 0: all are asked; 1: the nearest; 2: any. */
static void trace_batch(const rgi_kernels *k, const rg_ray *rays, uint32_t count, int mode, tally *all) {
    static witness witnesses[RGI_PACKET];
    static rgi_ray ready[RGI_PACKET];
    const rgi_middle middle = rgi_lattice_middle(&store.lattice);
    rgi_bundle b = {.count = count};
    rgi_packet p;
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        const rg_ray *r = &rays[i < count ? i : 0];
        for (int a = 0; a < 3; a++) b.origin[a][i] = r->origin[a], b.direction[a][i] = r->direction[a];
        b.t_min[i] = r->t_min;
        b.t_max[i] = r->t_max;
        b.mask[i] = r->mask;
        bool valid = rgi_ray_init(&ready[i], r->origin, r->direction, r->t_min, r->t_max, r->mask);
        begin_witness(&witnesses[i], &ready[i], mode == 1);
        if (!valid) return;
    }
    if (!k->prepare(&b)) return;
    k->to_frame(&b, &store.lattice, &middle, &p);
    if (!k->bound(&p, &store.lattice, &middle)) return;
    p.any = mode == 2;
    p.ask_all = mode == 0;
    p.ask = ask_packet;
    p.context = witnesses;
    p.bundle = &b;
    p.found = 0;
    k->trace_packet(&store.lattice, &p);
    all->packets++;
    ask_certain(&p, witnesses, count, all, k->name);
    for (uint32_t i = 0; i < count; i++) {
        if (mode == 2)
            judge_any(&witnesses[i], k->name);
        else
            judge(&witnesses[i], all, k->name);
    }
}

static void trace_batches(const rgi_kernels *k, const crowd *c, int mode, tally *all) {
    random_source random = {(uint64_t)(unit_random() * 0x1p53)};
    for (int round = 0; round < BATCHES; round++) {
        rg_ray rays[RGI_PACKET];
        const rgi_bound *aim = &store.truth[below(OBJECTS)];
        batch_space space = {{c->centre, -0.7 * c->centre, c->centre}, c->spread};
        if (round % 2) { /* around one object */
            space.spread = aim->hi[0] - aim->lo[0];
            for (int a = 0; a < 3; a++) space.centre[a] = aim->centre[a];
        }
        batch_rays(&random, &space, rays, RGI_PACKET);
        double away = pow(10, 3 * unit_random()) * (aim->hi[0] - aim->lo[0]), eye[3];
        for (int a = 0; a < 3; a++) eye[a] = aim->centre[a] + away * (2 * unit_random() - 1);
        for (int i = 0; i < RGI_PACKET && round % 3 == 0; i++) {
            double d[3];
            graze(aim, eye, d);
            rays[i] = rg_ray_from(eye, d);
        }
        trace_batch(k, rays, 4 + (uint32_t)below(13), mode, all);
    }
}

START_TEST(packets) {
    const rgi_kernels *k = ALL[_i];
    for (int n = 0; n < CROWDS && can_run(k); n++) {
        tally all = {0}, nearest = {0}, any = {0};
        fill_crowd(&crowds[n]);
        trace_batches(k, &crowds[n], 0, &all);
        trace_batches(k, &crowds[n], 1, &nearest);
        trace_batches(k, &crowds[n], 2, &any);
        ck_assert_uint_gt(all.packets + nearest.packets + any.packets, BATCHES / 5);
        if (n < 2) {
            ck_assert_uint_le(all.asked, all.met + all.met / 20 + all.rays / 10);
            ck_assert(crowds[n].balls < 1 || nearest.certain + any.certain > BATCHES);
        }
        crowd_end();
    }
}
END_TEST

START_TEST(packets_in_a_nest) {
    const rgi_kernels *k = ALL[_i];
    const crowd c = {"nest", 0, 1, 0, 0, 1};
    tally all = {0};
    if (!can_run(k)) return;
    fill_nest();
    for (int mode = 0; mode < 3; mode++) trace_batches(k, &c, mode, &all);
    ck_assert_uint_gt(all.packets, BATCHES / 5);
    crowd_end();
}
END_TEST

/* ---------------------------------------------------------------------------------------- the part in double */

static bool same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static double extreme(void) {
    static const double VALUES[] = {0,         -0.0, 1,      -1,     1e100, -1e100,  1.1e100,   INFINITY,
                                    -INFINITY, NAN,  1e-300, 5e-324, 1e300, 0x1p400, 0x1.8p-400};
    return below(3) ? unit_random_scale(-30, 30) : pick(VALUES, 15);
}

/* Rays as good as any, but for a few numbers. */
static void pick_bundle(rgi_bundle *b) {
    double far = pow(10, 24 * unit_random() - 12);
    bool wild = below(2);
    b->count = RGI_PACKET;
    for (int i = 0; i < RGI_PACKET; i++) {
        for (int a = 0; a < 3; a++) {
            b->origin[a][i] = far * unit_random_scale(-1, 0);
            b->direction[a][i] = unit_random_scale(-3, 0) * (below(20) ? 1 : 0);
        }
        b->t_min[i] = below(3) ? 0 : unit_random_scale(-2, 3) * far;
        b->t_max[i] = below(3) ? INFINITY : fabs(unit_random_scale(-2, 3)) * far + rgi_max(b->t_min[i], 0);
    }
    if (!wild) return;
    int lane = below(RGI_PACKET), what = below(8);
    *(what < 3   ? &b->origin[what][lane]
      : what < 6 ? &b->direction[what - 3][lane]
      : what < 7 ? &b->t_min[lane]
                 : &b->t_max[lane]) = extreme();
}

/* prepare gives the bits of rgi_ray_init, or false where one of the rays is invalid or extreme. */
START_TEST(prepared_alike) {
    const rgi_kernels *k = ALL[_i];
    int good = 0, refused = 0;
    for (int round = 0; round < 20000 && can_run(k); round++) {
        rgi_bundle b, given;
        pick_bundle(&b);
        given = b;
        bool ready = k->prepare(&b);
        good += ready;
        refused += !ready;
        for (int i = 0; i < RGI_PACKET && ready; i++) {
            const double o[3] = {given.origin[0][i], given.origin[1][i], given.origin[2][i]};
            const double d[3] = {given.direction[0][i], given.direction[1][i], given.direction[2][i]};
            rgi_ray r;
            MUST(rgi_ray_init(&r, o, d, given.t_min[i], given.t_max[i], 1));
            for (int a = 0; a < 3; a++) {
                MUST(same_bits(r.origin[a], b.origin[a][i]));
                MUST(same_bits(r.direction[a], b.direction[a][i]));
            }
            MUST(same_bits(r.t_min, b.t_min[i]) && same_bits(r.t_max, b.t_max[i]));
            MUST(same_bits(r.dd, b.dd[i]));
            MUST(same_bits(r.to_world, b.to_world[i]) && same_bits(r.to_world2, b.to_world2[i]));
        }
    }
    if (can_run(k)) ck_assert(good > 5000 && refused > 500);
}
END_TEST

/* Where a ray meets a ball: the bits of rgi_object_intersect. */
START_TEST(balls_met_alike) {
    const rgi_kernels *k = ALL[_i];
    rg_shape *shape = NULL;
    uint64_t hits = 0;
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &shape), RG_OK);
    for (int round = 0; round < 20000 && can_run(k); round++) {
        rgi_bundle b;
        rgi_meeting m;
        pick_bundle(&b);
        if (!k->prepare(&b)) continue;
        for (int i = 0; i < RGI_PACKET; i++) {
            double away = below(4) ? 10 * unit_random() : pow(10, 12 * unit_random());
            m.radius[i] = pow(10, 6 * unit_random() - 3) * (fabs(b.origin[0][i]) + 1e-9);
            double beside = m.radius[i] * (below(4) ? unit_random() : 1 - pow(2, -50 * unit_random()));
            for (int a = 0; a < 3; a++)
                m.centre[a][i] = b.origin[a][i] + away * m.radius[i] * b.direction[a][i] + (a == round % 3) * beside;
        }
        k->meet(&b, &m);
        for (int i = 0; i < RGI_PACKET; i++) {
            rgi_object o = {.shape = shape, .linear = RGI_NONE, .reach = m.radius[i], .mask = 1};
            rgi_ray r = {.t_min = b.t_min[i],
                         .t_max = b.t_max[i],
                         .dd = b.dd[i],
                         .to_world = b.to_world[i],
                         .to_world2 = b.to_world2[i],
                         .mask = 1};
            rgi_local_ray local = {.t_min = r.t_min, .t_max = r.t_max, .sides = RGI_FRONT | RGI_BACK};
            rgi_candidate found;
            for (int a = 0; a < 3; a++) {
                o.position[a] = m.centre[a][i];
                r.origin[a] = b.origin[a][i];
                r.direction[a] = b.direction[a][i];
            }
            bool hit = rgi_object_intersect(&o, NULL, &r, &local, &found);
            hits += hit;
            MUST((m.met >> i & 1) == hit);
            if (hit) MUST(same_bits(m.scaled_t[i], found.t) && same_bits(m.t[i], rgi_world_t(&r, found.t)));
        }
    }
    if (can_run(k)) ck_assert_uint_gt(hits, 10000);
    rg_shape_release(&shape);
}
END_TEST

/* The variable RAYGRID_ISA caps what is chosen, in builds that know it. */
START_TEST(chosen_by_name) {
    const rgi_kernels *best = rgi_kernels_best();
    ck_assert(can_run(best));
    printf("best: %s\n", best->name);
    for (int i = 0; i < KERNELS; i++) {
        bool runs = can_run(ALL[i]);
        ck_assert_int_eq(setenv("RAYGRID_ISA", ALL[i]->name, 1), 0);
        const rgi_kernels *chosen = rgi_kernels_best();
        ck_assert_int_eq(unsetenv("RAYGRID_ISA"), 0);
        ck_assert_ptr_eq(chosen, ISA_VARIABLE && runs ? ALL[i] : best);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("kernels");
    TCase *tests = tcase_create("kernels");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, chosen_by_name);
    tcase_add_loop_test(tests, lone_rays, 0, KERNELS);
    tcase_add_loop_test(tests, full_stacks, 0, KERNELS);
    tcase_add_loop_test(tests, packets, 0, KERNELS);
    tcase_add_loop_test(tests, packets_in_a_nest, 0, KERNELS);
    tcase_add_loop_test(tests, prepared_alike, 0, KERNELS);
    tcase_add_loop_test(tests, balls_met_alike, 0, KERNELS);
    suite_add_tcase(suite, tests);
    return suite;
}
