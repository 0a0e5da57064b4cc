/* SPDX-License-Identifier: MIT */
/*
 * The lattice after whatever was done to it: every object is where it says, what is stored holds the truth, every box
 * on the way to it holds it, and all counts are right. Time is measured by the processor's clock, with much to spare.
 */
#include "crowd.h"

#include <string.h>
#include <time.h>

enum { MOST = CROWD_MOST };

/* ------------------------------------------------------------------------------------------------ checking */

typedef struct tally {
    uint64_t objects, nodes, needless, blocks[RGI_KINDS];
} tally;

typedef struct span {
    float lo[3], hi[3];
} span;

static double in_frame(double world, int a) {
    return (world - store.lattice.origin[a]) * store.lattice.scale;
}

/* What is stored holds the truth, and the boxes above hold both. */
static void check_entry(const rgi_block *b, uint32_t lane, const span *within) {
    uint32_t room = rgi_block_room(b->kind), slot = b->slots[lane];
    const float *f = rgi_block_lanes(b, room) + lane;
    const rgi_bound *t = &store.truth[slot];
    bool ball = !(b->kind & RGI_BOXES);
    double apart = 0;
    MUST(store.stored[slot]);
    MUST(t->ball || !ball);
    for (uint32_t a = 0; a < 3; a++) {
        double lo = in_frame(t->lo[a], (int)a), hi = in_frame(t->hi[a], (int)a);
        if (t->ball) { /* its box was rounded */
            lo = in_frame(t->centre[a], (int)a) - t->radius * store.lattice.scale;
            hi = in_frame(t->centre[a], (int)a) + t->radius * store.lattice.scale;
        }
        double kept_lo = ball ? (double)f[a * room] - f[3 * room] : f[a * room];
        double kept_hi = ball ? (double)f[a * room] + f[3 * room] : f[(a + 3) * room];
        double d = f[a * room] - in_frame(t->centre[a], (int)a);
        apart += d * d;
        MUST(kept_lo <= lo && hi <= kept_hi);
        MUST(within->lo[a] <= lo && hi <= within->hi[a]);
    }
    if (ball) MUST(sqrt(apart) + t->radius * store.lattice.scale <= f[3 * room]);
}

static uint64_t check_chain(rgi_ref chain, uint32_t parent, const span *within, tally *all) {
    uint64_t objects = 0;
    uint32_t length = 0;
    rgi_ref previous = 0;
    for (rgi_ref ref = chain; ref; ref = rgi_block_at(&store.lattice, ref)->next) {
        const rgi_block *b = rgi_block_at(&store.lattice, ref);
        MUST(rgi_is_block(ref));
        MUST(b->parent == parent);
        MUST(b->previous == previous);
        MUST(b->count >= 1);
        MUST(b->count <= rgi_block_room(b->kind));
        for (uint32_t i = 0; i < b->count; i++) {
            const rgi_location *place = crowd_place(b->slots[i]);
            MUST(place->block == ref);
            MUST(place->lane == i);
            check_entry(b, i, within);
        }
        objects += b->count;
        all->blocks[b->kind]++;
        previous = ref;
        length++;
    }
    if (chain) {
        uint32_t said = rgi_block_at(&store.lattice, chain)->length;
        MUST(said == RGI_LONG ? length >= RGI_LONG / 2 : said == length);
    }
    all->objects += objects;
    return objects;
}

static void check_node(rgi_ref ref, uint32_t parent, const span *within, tally *all) {
    const rgi_node *n = rgi_arena_at(&store.lattice.arena, ref);
    uint32_t number = ref >> 2, nodes = 0;
    uint64_t members = 0;
    MUST(n == rgi_node_at(&store.lattice, number));
    MUST(n->parent == parent);
    all->nodes++;
    for (uint32_t lane = 0; lane < RGI_OCTANTS; lane++) {
        span inner = *within;
        for (int a = 0; a < 3; a++) {
            if (!n->child[lane]) MUST(n->lo[a][lane] == INFINITY && n->hi[a][lane] == -INFINITY);
            inner.lo[a] = fmaxf(inner.lo[a], n->lo[a][lane]);
            inner.hi[a] = fminf(inner.hi[a], n->hi[a][lane]);
        }
        if (rgi_is_node(n->child[lane])) {
            nodes++;
            MUST(((const rgi_node *)rgi_arena_at(&store.lattice.arena, n->child[lane]))->half <= 0.5f * n->half);
            check_node(n->child[lane], number << 4 | lane, &inner, all);
        } else {
            members += check_chain(n->child[lane], number << 4 | lane, &inner, all);
        }
    }
    members += check_chain(n->own, number << 4 | RGI_OWN, within, all);
    MUST(n->nodes == nodes);
    MUST(n->members == members);
    /* What holds nothing is no node; what holds nothing but one other node hardly ever. */
    MUST(members + nodes > 0);
    all->needless += members == 0 && nodes == 1;
}

static void check(void) {
    tally all = {0};
    span everything;
    uint64_t expected = 0, unbounded = 0;
    memcpy(everything.lo, store.lattice.lo, sizeof store.lattice.lo);
    memcpy(everything.hi, store.lattice.hi, sizeof store.lattice.hi);
    if (rgi_is_node(store.lattice.root))
        check_node(store.lattice.root, RGI_ROOT, &everything, &all);
    else
        check_chain(store.lattice.root, RGI_ROOT, &everything, &all);
    for (uint32_t i = 0; i < MOST; i++) {
        const rgi_location *place = crowd_place(i);
        if (!store.stored[i]) continue;
        expected++;
        if (place->block != RGI_NONE) continue;
        unbounded++;
        MUST(place->lane < store.lattice.unbounded_count);
        MUST(store.lattice.unbounded[place->lane] == i);
    }
    MUST(all.objects + unbounded == expected);
    MUST(store.lattice.count == all.objects);
    MUST(store.lattice.unbounded_count == unbounded);
    MUST(rgi_lattice_nodes(&store.lattice) == all.nodes);
    MUST(all.needless <= 4 + all.nodes / 8);
    for (int kind = RGI_SMALLEST; kind < RGI_KINDS; kind++)
        MUST(store.lattice.arena.kinds[kind].used == all.blocks[kind]);
    if (!all.objects) MUST(store.lattice.root == 0);
}

/* ------------------------------------------------------------------------------------------------- changes */

static void move(uint32_t slot, const rgi_bound *b) {
    store.truth[slot] = *b;
    MUST(rgi_lattice_move(&store.lattice, slot, b) == RG_OK);
}

/* The quick way where it goes, as the library does. */
static void step(uint32_t slot, const rgi_bound *b) {
    const rgi_location *place = crowd_place(slot);
    bool may = b->ball && store.truth[slot].ball && place->block != RGI_NONE &&
               rgi_lattice_reaches(&store.lattice, b->centre, b->radius);
    if (may && rgi_lattice_step(&store.lattice, place, b->centre, b->radius))
        store.truth[slot] = *b;
    else
        move(slot, b);
}

static void take_out(uint32_t slot) {
    rgi_lattice_remove(&store.lattice, slot);
    store.stored[slot] = false;
}

static void take_all_out(uint32_t count) {
    /* In an order that is neither that of insertion nor its reverse. */
    for (uint32_t n = 0; n < count; n++) {
        uint32_t slot = (uint32_t)((uint64_t)n * 7919 % count);
        if (store.stored[slot]) take_out(slot);
    }
    for (uint32_t slot = 0; slot < count; slot++) {
        if (store.stored[slot]) take_out(slot);
    }
    check();
    MUST(store.lattice.count == 0);
}

static void change_one(const crowd *c, uint32_t most) {
    uint32_t slot = (uint32_t)(unit_random() * most);
    rgi_bound next = crowd_bound(c);
    if (!store.stored[slot]) {
        crowd_insert(slot, &next);
        return;
    }
    double what = unit_random(), size = store.truth[slot].hi[0] - store.truth[slot].lo[0];
    if (what < 0.35) {
        take_out(slot);
    } else if (what < 0.5) {
        move(slot, &next);
    } else if (what < 0.6) {
        next = shifted(&store.truth[slot], c->spread * 0.1);
        move(slot, &next);
    } else {
        next = shifted(&store.truth[slot], size * 0.3);
        step(slot, &next);
    }
}

START_TEST(random_changes) {
    enum { OBJECTS = 1500, CHANGES = 30000 };
    const crowd *c = &crowds[_i];
    crowd_begin();
    for (int i = 0; i < CHANGES; i++) {
        change_one(c, i < CHANGES / 2 ? OBJECTS : OBJECTS / 10);
        if (i % 1000 == 0) check();
    }
    take_all_out(OBJECTS);
    crowd_end();
}
END_TEST

/* All in one call; then changes go on. */
START_TEST(built) {
    static uint32_t slots[CROWD_MOST];
    const uint32_t counts[] = {1, 2, 5, 16, 17, 100, 5000};
    for (int n = 0; n < 7; n++) {
        crowd_begin();
        for (uint32_t i = 0; i < counts[n]; i++) {
            slots[i] = 3 * i + 1;
            store.truth[slots[i]] = crowd_bound(&crowds[_i]);
            /* Some in the very same place. */
            if (i % 5 == 4) store.truth[slots[i]] = store.truth[slots[i - 1]];
        }
        ck_assert_int_eq(crowd_build(slots, counts[n]), RG_OK);
        check();
        for (uint32_t i = 0; i < 3000; i++) change_one(&crowds[_i], 1500);
        check();
        take_all_out(MOST);
        crowd_end();
    }
}
END_TEST

/* Without memory on the way nothing is left behind. */
START_TEST(built_without_memory) {
    static uint32_t slots[CROWD_MOST];
    int failed = 0;
    rg_result result = RG_OUT_OF_MEMORY;
    for (int left = 0; result != RG_OK; left++) {
        crowd_begin();
        for (uint32_t i = 0; i < 3000; i++) {
            slots[i] = i;
            store.truth[i] = crowd_bound(&crowds[4]);
        }
        store.blocks_left = left;
        result = crowd_build(slots, 3000);
        ck_assert(result == RG_OK || result == RG_OUT_OF_MEMORY);
        failed += result != RG_OK;
        if (!result) check();
        crowd_end();
    }
    ck_assert_int_gt(failed, 3);
}
END_TEST

/* All at once of all crowds: the frame fits none but the first. */
START_TEST(mixed_crowds) {
    enum { OBJECTS = 1000 };
    crowd_begin();
    for (int i = 0; i < 20000; i++) {
        change_one(&crowds[(size_t)(unit_random() * 8)], OBJECTS);
        if (i % 1000 == 0) check();
    }
    take_all_out(OBJECTS);
    crowd_end();
}
END_TEST

/* ---------------------------------------------------------------------------------------------------- time */

static double seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Inserts so many in one place, moves each a little and takes all out. Returns the time it took. */
static double crowd_in_one_place(uint32_t count, bool boxes) {
    crowd_begin();
    double start = seconds();
    for (uint32_t i = 0; i < count; i++) {
        rgi_bound b = boxes ? box_at(1, 2, 3, 0.5) : ball_at(1, 2, 3, 0.5);
        crowd_insert(i, &b);
    }
    for (uint32_t i = 0; i < count; i++) {
        rgi_bound b = shifted(&store.truth[i], 1e-3);
        move(i, &b);
    }
    double took = seconds() - start;
    check();
    start = seconds();
    for (uint32_t n = 0; n < count; n++) take_out((uint32_t)((uint64_t)n * 7919 % count));
    took += seconds() - start;
    check();
    ck_assert_uint_eq(store.lattice.root, 0);
    crowd_end();
    return took;
}

/* Duplicates can't be parted: their chain is long. 8 times as many take at most 24 times as long: 8 would be linear,
 * 64 quadratic. */
START_TEST(many_in_one_place) {
    for (int boxes = 0; boxes < 2; boxes++) {
        double few = crowd_in_one_place(MOST / 8, boxes), many = crowd_in_one_place(MOST, boxes);
        ck_assert_msg(many < 24 * few + 0.1, "%u took %g s, %u took %g s", MOST / 8, few, MOST, many);
    }
}
END_TEST

/* In one small place of a large world, and of sizes from tiny to large, so that chains of all lengths come about. */
START_TEST(many_in_a_small_place) {
    const crowd dense = {"", 5, 1e-3, -4, 1, 0.5};
    crowd_begin();
    rgi_bound far = ball_at(-1e6, 1e6, 0, 1);
    crowd_insert(MOST - 1, &far);
    double start = seconds();
    for (uint32_t i = 0; i < 20000; i++) {
        rgi_bound b = crowd_bound(&dense);
        crowd_insert(i, &b);
    }
    ck_assert_msg(seconds() - start < 5, "inserts took %g s", seconds() - start);
    check();
    start = seconds();
    for (uint32_t i = 0; i < 20000; i++) {
        rgi_bound b = crowd_bound(&dense);
        move(i * 7919 % 20000, &b);
    }
    ck_assert_msg(seconds() - start < 5, "moves took %g s", seconds() - start);
    check();
    take_all_out(MOST);
    crowd_end();
}
END_TEST

/* Each farther out than all before: the root grows, and shrinks again when they go. */
START_TEST(the_root_grows) {
    crowd_begin();
    for (uint32_t i = 0; i < 56; i++) {
        double at = ldexp(i % 2 ? 1 : -1, (int)i);
        rgi_bound b = ball_at(at, i % 3 ? at : -at, 0.3 * at, 1);
        crowd_insert(2 * i, &b);
        b = box_at(-at, at, at, 0.25 * fabs(at));
        crowd_insert(2 * i + 1, &b);
        check();
    }
    ck_assert_uint_le(rgi_lattice_levels(&store.lattice), 60);
    for (uint32_t i = 112; i-- > 4;) {
        take_out(i);
        check();
    }
    ck_assert_uint_le(rgi_lattice_levels(&store.lattice), 1);
    take_all_out(4);
    crowd_end();
}
END_TEST

/* --------------------------------------------------------------------------------------------- where it fits */

/* What no float can hold has no cell; moves lead in and out. */
START_TEST(cells_and_none) {
    crowd_begin();
    rgi_bound unit = ball_at(1, 1, 1, 1), endless = box_at(0, 0, 0, 1);
    endless.lo[0] = -INFINITY;
    endless.hi[0] = INFINITY;
    crowd_insert(0, &unit);
    for (uint32_t i = 1; i < 20; i++) crowd_insert(i, i % 2 ? &endless : &unit);
    check();
    ck_assert_uint_eq(store.lattice.unbounded_count, 10);
    for (uint32_t i = 0; i < 20; i++) move(i, i % 2 ? &unit : &endless);
    check();
    ck_assert_uint_eq(store.lattice.unbounded_count, 10);
    rgi_bound far = ball_at(1e60, 0, 0, 1);
    ck_assert(!rgi_lattice_has_cell(&store.lattice, crowd_place(0), &far));
    ck_assert(rgi_lattice_has_cell(&store.lattice, crowd_place(0), &unit));
    ck_assert(!rgi_lattice_reaches(&store.lattice, far.centre, 1));
    ck_assert(rgi_lattice_reaches(&store.lattice, unit.centre, 1));
    move(1, &far);
    ck_assert_uint_eq(store.lattice.unbounded_count, 11);
    check();
    take_all_out(20);
    crowd_end();
}
END_TEST

/* Balls and boxes, in blocks of their own, here and far off. */
START_TEST(a_few_are_listed) {
    enum { FEW = 5 };
    uint32_t slots[FEW], seen = 0;
    crowd_begin();
    ck_assert_uint_eq(rgi_lattice_few(&store.lattice, slots, FEW), 0);
    for (uint32_t i = 0; i <= FEW; i++) {
        const rgi_bound bound = i % 2 ? ball_at(i, -1.0 * i, 100.0 * (i / 3), 0.1) : box_at(i, 2, 3, 0.1 + i);
        crowd_insert(i, &bound);
        uint32_t count = rgi_lattice_few(&store.lattice, slots, FEW);
        ck_assert_uint_eq(count, i < FEW ? i + 1 : 0);
        seen = 0;
        for (uint32_t k = 0; k < count; k++) seen |= 1u << slots[k];
        ck_assert_uint_eq(seen, (1u << count) - 1);
    }
    take_all_out(FEW + 1);
    crowd_end();
}
END_TEST

/* The first object makes the frame; when all have gone the next first one makes it anew. */
START_TEST(each_first_object_makes_the_frame) {
    crowd_begin();
    for (int e = -95; e <= 95; e += 5) {
        double size = pow(10, e), at = 3 * size;
        for (uint32_t i = 0; i < 100; i++) {
            rgi_bound b = ball_at(at * unit_random(), at * unit_random(), at * unit_random(), size);
            crowd_insert(i, &b);
        }
        ck_assert_uint_eq(store.lattice.unbounded_count, 0);
        check();
        take_all_out(100);
    }
    crowd_end();
}
END_TEST

/* A crowd that is carried far away in small steps leaves no boxes behind it. */
START_TEST(boxes_follow_a_drift) {
    enum { COUNT = 2000, STEPS = 400 };
    crowd_begin();
    for (uint32_t i = 0; i < COUNT; i++) {
        rgi_bound b = ball_at(20 * unit_random(), 20 * unit_random(), 20 * unit_random(), 0.3);
        crowd_insert(i, &b);
    }
    for (int step = 0; step < STEPS; step++) {
        for (uint32_t i = 0; i < COUNT; i++) {
            const double *c = store.truth[i].centre;
            rgi_bound b = ball_at(c[0] + 5, c[1] + 2, c[2] - 1, 0.3);
            move(i, &b);
        }
    }
    check();
    double lo[3], hi[3];
    rgi_lattice_box(&store.lattice, lo, hi);
    for (int a = 0; a < 3; a++) ck_assert_msg(hi[a] - lo[a] < 160, "axis %d: %g to %g", a, lo[a], hi[a]);
    take_all_out(COUNT);
    crowd_end();
}
END_TEST

/* --------------------------------------------------------------------------------------------- without memory */

/* A move can't fail, but that what was a ball may find no place as a box. */
static void move_if_it_can(uint32_t slot, const rgi_bound *b) {
    bool turns = store.truth[slot].ball && !b->ball;
    rg_result result = rgi_lattice_move(&store.lattice, slot, b);
    ck_assert(result == RG_OK || (turns && result == RG_OUT_OF_MEMORY));
    if (result == RG_OK) store.truth[slot] = *b;
}

/* Inserts fail and have changed nothing; moves do without, and are right. */
START_TEST(no_memory) {
    enum { COUNT = 600 };
    const crowd c = {"", 0, 40, -1, 0.5, 0.8};
    crowd_begin();
    for (uint32_t i = 0; i < COUNT; i++) {
        rgi_bound b = crowd_bound(&c);
        crowd_insert(i, &b);
    }
    uint32_t more = COUNT, failed = 0;
    store.blocks_left = 0;
    for (int round = 0; round < 20000; round++) {
        if (round % 100 == 0) store.blocks_left = (int)(round % 1000 == 0);
        rgi_bound b = crowd_bound(&c);
        uint32_t slot = (uint32_t)(unit_random() * COUNT);
        if (round % 8 == 0 && more < MOST) {
            rg_result result = rgi_lattice_insert(&store.lattice, more, &b);
            ck_assert(result == RG_OK || result == RG_OUT_OF_MEMORY);
            failed += result != RG_OK;
            store.truth[more] = b;
            store.stored[more] = result == RG_OK;
            more += result == RG_OK;
        } else {
            b = round % 2 ? shifted(&store.truth[slot], 0.2) : b;
            move_if_it_can(slot, &b);
        }
        if (round % 500 == 0) check();
    }
    store.blocks_left = 0;
    while (failed == 0 && more < MOST) {
        rgi_bound b = crowd_bound(&c);
        failed += rgi_lattice_insert(&store.lattice, more, &b) != RG_OK;
        store.truth[more] = b;
        store.stored[more++] = failed == 0;
    }
    check();
    ck_assert_uint_gt(failed, 0);
    store.blocks_left = -1;
    take_all_out(MOST);
    crowd_end();
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("lattice");
    TCase *tests = tcase_create("lattice");
    tcase_set_timeout(tests, 120);
    tcase_add_loop_test(tests, random_changes, 0, CROWDS);
    tcase_add_loop_test(tests, built, 0, CROWDS);
    tcase_add_test(tests, built_without_memory);
    tcase_add_test(tests, mixed_crowds);
    tcase_add_test(tests, many_in_one_place);
    tcase_add_test(tests, many_in_a_small_place);
    tcase_add_test(tests, the_root_grows);
    tcase_add_test(tests, cells_and_none);
    tcase_add_test(tests, a_few_are_listed);
    tcase_add_test(tests, each_first_object_makes_the_frame);
    tcase_add_test(tests, boxes_follow_a_drift);
    tcase_add_test(tests, no_memory);
    suite_add_tcase(suite, tests);
    return suite;
}
