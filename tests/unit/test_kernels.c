/* SPDX-License-Identifier: MIT */
/*
 * Every kernel that the machine can run, against arithmetic in long double: what a ray meets is asked, whatever the
 * sizes, the distances and the rays; what is called certain is; and what is asked besides is little.
 */
#include "batches.h"
#include "beam.h"
#include "crowd.h"
#include "machine.h"
#include "truth.h"

#include <stdio.h>
#include <string.h>

/* Builds with sanitizers take fewer. */
enum {
    OBJECTS = 1500,
    LONE_ROUNDS = SHORT_TESTS ? 10 : 20,
    BATCHES = SHORT_TESTS ? 40 : 60,
    MOST_RAYS = RGI_PACKETS * RGI_PACKET
};

/* ------------------------------------------------------------------------------------------------------ rays */

/*
 * The direction from an eye into an object, so near to its silhouette or to an edge that the last bits of a float
 * decide: where every error that is not accounted for shows.
 */
static bool no_mesh(rgi_packet *p, uint32_t rays, uint32_t slot) {
    (void)p, (void)rays, (void)slot;
    return false;
}

static void graze(const rgi_bound *b, const double eye[3], double d[3]) {
    double inside = pow(2, -8 - 28 * unit_random()), along[3], across[3], distance = 0, dot = 0, length = 0;
    for (int a = 0; a < 3; a++) {
        if (!b->ball) { /* a point near one or two faces */
            double depth = machine_below(3) ? inside : unit_random();
            double at = b->lo[a] + (machine_below(2) ? depth : 1 - depth) * (b->hi[a] - b->lo[a]);
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
    const rgi_bound *aim = &store.truth[machine_below(OBJECTS)];
    double origin[3], d[3], away = machine_pick(AWAY, 8) * c->spread, scale = machine_pick(SCALES, 6), t_min = 0,
                            t_max = INFINITY;
    double length = 0;
    do {
        length = 0;
        for (int a = 0; a < 3; a++) d[a] = 2 * unit_random() - 1, length += d[a] * d[a];
    } while (length > 1 || length < 1e-3);
    int axis = machine_below(12);
    if (axis < 6) d[axis % 3] = machine_pick(TINY, 6);
    if (axis < 2) d[(axis + 1) % 3] = machine_pick(TINY, 6);
    for (int a = 0; a < 3; a++) {
        double target = aim->lo[a] + (unit_random() * 1.4 - 0.2) * (aim->hi[a] - aim->lo[a]);
        if (machine_below(8) == 0) target = aim->centre[a];
        origin[a] = target - away * d[a];
    }
    if (machine_below(2)) graze(aim, origin, d);
    for (int a = 0; a < 3; a++) d[a] *= scale;
    if (machine_below(4) == 0) t_max = unit_random() * (away + c->spread) * 2 / scale;
    if (machine_below(6) == 0) t_min = unit_random() * fmin(t_max, (away + c->spread) / scale);
    if (machine_below(20) == 0) t_min = -INFINITY;
    return rgi_ray_init(ray, origin, d, t_min, t_max, UINT32_MAX);
}

static void fill_crowd(const crowd *c) {
    crowd_begin();
    for (uint32_t i = 0; i < OBJECTS; i++) {
        rgi_bound b = crowd_bound(c);
        if (c->balls < 1 && machine_below(10) == 0)
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
    if (truth_meets(&store.truth[slot], w->ray, &t) != MET || t > w->t || (t == w->t && slot > w->hit)) return false;
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
    uint64_t rays, met, asked, packets, several, certain;
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
        verdict v = truth_meets(&store.truth[slot], w->ray, &t);
        all->met += truth_overlaps(&store.truth[slot], w->ray);
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
    ck_assert_msg(truth.hit == RGI_NONE ||
                      fabsl(truth.t - w->t) <= truth_doubt(w->ray, &store.truth[truth.hit], w->t),
                  "%s: object %u at %Lg is the nearest, not %u at %Lg", isa, truth.hit, truth.t, w->hit, w->t);
}

static void trace_lone(const rgi_kernels *k, const crowd *c, bool nearest, tally *all) {
    static witness witnesses[RGI_PACKET];
    static rgi_ray rays[RGI_PACKET];
    static rgi_beam beams[RGI_PACKET];
    const rgi_middle middle = rgi_lattice_middle(&store.lattice);
    for (int round = 0; round < LONE_ROUNDS; round++) {
        uint32_t count = 1 + (uint32_t)machine_below(RGI_PACKET), used = 0;
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
    const rgi_kernels *k = machine_kernels[_i];
    for (int n = 0; n < CROWDS && machine_can_run(k); n++) {
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
    const rgi_kernels *k = machine_kernels[_i];
    const crowd c = {"nest", 0, 1, 0, 0, 1};
    tally all = {0};
    if (!machine_can_run(k)) return;
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
        if (truth_meets(&store.truth[slot], witnesses[i].ray, &t) == MISSED) {
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
        verdict v = truth_meets(&store.truth[slot], w->ray, &t);
        met |= v == MET;
        perhaps |= v != MISSED;
    }
    bool found = w->hit != RGI_NONE;
    if ((found || !met) && (!found || perhaps)) return;
    show_ray(w->ray);
    ck_abort_msg("%s: %s", isa, found ? "found something where nothing is" : "found nothing where something is");
}

/* Up to RGI_PACKET rays from the first on. Returns whether they can be in a packet. */
static bool make_packet(const rgi_kernels *k, const rgi_middle *middle, const rg_ray *rays, uint32_t count,
                        rgi_ray *ready, rgi_bundle *b, rgi_packet *p) {
    b->count = count;
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        const rg_ray *r = &rays[i < count ? i : 0];
        for (int a = 0; a < 3; a++) b->origin[a][i] = r->origin[a], b->direction[a][i] = r->direction[a];
        b->t_min[i] = r->t_min;
        b->t_max[i] = r->t_max;
        b->mask[i] = r->mask;
        if (!rgi_ray_init(&ready[i], r->origin, r->direction, r->t_min, r->t_max, r->mask)) return false;
    }
    if (!k->prepare(b)) return false;
    k->to_frame(b, &store.lattice, middle, p);
    p->ask = ask_packet;
    p->ask_mesh = no_mesh;
    p->bundle = b;
    p->found = 0;
    return true;
}

/* Takes rays through together, if they go the same way. mode 0: all are asked; 1: the nearest; 2: any. */
static void trace_batch(const rgi_kernels *k, const rg_ray *rays, uint32_t count, bool spread, int mode, tally *all) {
    static witness witnesses[MOST_RAYS];
    static rgi_ray ready[MOST_RAYS];
    static rgi_bundle bundles[RGI_PACKETS];
    static rgi_packet packets[RGI_PACKETS];
    rgi_middle middle = rgi_lattice_middle(&store.lattice);
    rgi_frustum f = {.count = (count + RGI_PACKET - 1) / RGI_PACKET, .patience = UINT32_MAX};
    middle.spacing = spread ? INFINITY : rgi_lattice_spacing(&store.lattice); /* as where the host says that they go the same way */
    for (uint32_t n = 0; n < f.count; n++) {
        uint32_t first = n * RGI_PACKET, left = count - first < RGI_PACKET ? count - first : RGI_PACKET;
        if (!make_packet(k, &middle, rays + first, left, ready + first, &bundles[n], &packets[n])) return;
        packets[n].any = mode == 2;
        packets[n].ask_all = mode == 0;
        packets[n].context = witnesses + first;
        f.packets[n] = &packets[n];
    }
    for (uint32_t i = 0; i < f.count * RGI_PACKET; i++) begin_witness(&witnesses[i], &ready[i], mode == 1);
    if (!k->bound(&f, &store.lattice, &middle)) return;
    k->trace_frustum(&store.lattice, &f);
    all->packets++;
    all->several += f.count > 1;
    for (uint32_t n = 0; n < f.count; n++)
        ask_certain(&packets[n], witnesses + n * RGI_PACKET, bundles[n].count, all, k->name);
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
        rg_ray rays[MOST_RAYS];
        uint32_t most = round % 5 ? RGI_PACKET : MOST_RAYS;
        const rgi_bound *aim = &store.truth[machine_below(OBJECTS)];
        batch_space space = {{c->centre, -0.7 * c->centre, c->centre}, c->spread};
        if (round % 2) { /* around one object */
            space.spread = aim->hi[0] - aim->lo[0];
            for (int a = 0; a < 3; a++) space.centre[a] = aim->centre[a];
        }
        batch_rays(&random, &space, rays, most);
        double away = pow(10, 3 * unit_random()) * (aim->hi[0] - aim->lo[0]), eye[3];
        for (int a = 0; a < 3; a++) eye[a] = aim->centre[a] + away * (2 * unit_random() - 1);
        for (uint32_t i = 0; i < most && round % 3 == 0; i++) {
            double d[3];
            graze(aim, eye, d);
            for (int a = 0; a < 3 && round % 4 == 0; a++)
                d[a] += 0.3 * (2 * unit_random() - 1) * fabs(d[(a + 1) % 3]);
            rays[i] = rg_ray_from(eye, d);
        }
        trace_batch(k, rays, most - (uint32_t)machine_below(13), round % 4 == 0, mode, all);
    }
}

START_TEST(packets) {
    const rgi_kernels *k = machine_kernels[_i];
    for (int n = 0; n < CROWDS && machine_can_run(k); n++) {
        tally all = {0}, nearest = {0}, any = {0};
        fill_crowd(&crowds[n]);
        trace_batches(k, &crowds[n], 0, &all);
        trace_batches(k, &crowds[n], 1, &nearest);
        trace_batches(k, &crowds[n], 2, &any);
        ck_assert_uint_gt(all.packets + nearest.packets + any.packets, BATCHES / 5);
        ck_assert_uint_gt(all.several + nearest.several + any.several, 3);
        if (n < 2) {
            ck_assert_uint_le(all.asked, all.met + all.met / 20 + all.rays / 10);
            ck_assert(crowds[n].balls < 1 || nearest.certain + any.certain > BATCHES);
        }
        crowd_end();
    }
}
END_TEST

START_TEST(packets_in_a_nest) {
    const rgi_kernels *k = machine_kernels[_i];
    const crowd c = {"nest", 0, 1, 0, 0, 1};
    tally all = {0};
    if (!machine_can_run(k)) return;
    fill_nest();
    for (int mode = 0; mode < 3; mode++) trace_batches(k, &c, mode, &all);
    ck_assert_uint_gt(all.packets, BATCHES / 5);
    crowd_end();
}
END_TEST

/* The variable RAYGRID_ISA caps what is chosen, in builds that know it. */
START_TEST(chosen_by_name) {
    const rgi_kernels *best = rgi_kernels_best();
    ck_assert(machine_can_run(best));
    printf("best: %s\n", best->name);
    for (int i = 0; i < MACHINE_KERNELS; i++) {
        bool runs = machine_can_run(machine_kernels[i]);
        ck_assert_int_eq(setenv("RAYGRID_ISA", machine_kernels[i]->name, 1), 0);
        const rgi_kernels *chosen = rgi_kernels_best();
        ck_assert_int_eq(unsetenv("RAYGRID_ISA"), 0);
        ck_assert_ptr_eq(chosen, ISA_VARIABLE && runs ? machine_kernels[i] : best);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("kernels");
    TCase *tests = tcase_create("kernels");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, chosen_by_name);
    tcase_add_loop_test(tests, lone_rays, 0, MACHINE_KERNELS);
    tcase_add_loop_test(tests, full_stacks, 0, MACHINE_KERNELS);
    tcase_add_loop_test(tests, packets, 0, MACHINE_KERNELS);
    tcase_add_loop_test(tests, packets_in_a_nest, 0, MACHINE_KERNELS);
    suite_add_tcase(suite, tests);
    return suite;
}
