/* SPDX-License-Identifier: MIT */
/*
 * updates.c: what changes cost until the next ray sees them: for raygrid the call, for the peer the commit that makes
 * them seen. After each measurement both are held against brute force over the bodies as they then are.
 */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEAST_CHANGES = 4096, /* in a turn: fewer take no longer than reading the clock */
    PROBES = 4096         /* rays that look at what has changed */
};

/* A scene whose bodies change, on both sides. */
struct changes {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *own;
    struct peer *peer; /* NULL: there is none, or it takes no part in what is measured */
    struct bench_rays *probe;
    struct bench_answers answers;
    uint32_t *order; /* all bodies in random order */
    /* What a turn does: `passes` times `count` bodies, one list after the other. */
    uint32_t count, passes;
    uint32_t *which;
    rg_object *objects;
    double (*targets)[3];
    double step; /* radii */
    bool one_by_one, in_order;
    double inserting; /* seconds of a body, beside the removing that the turn returns */
};

static uint32_t room_for(uint32_t bodies) {
    return bodies > 2 * LEAST_CHANGES ? bodies : 2 * LEAST_CHANGES;
}

static struct changes *changes_create(struct bench_run *run, struct bench_scene *bodies) {
    struct changes *changes = bench_allocate(1, sizeof *changes);
    uint32_t count = bodies->count, room = room_for(count);
    changes->run = run;
    changes->bodies = bodies;
    changes->own = own_create(changes->bodies, 1);
    changes->probe = bench_random_rays(changes->bodies, PROBES, changes->bodies->has_aim, false);
    changes->answers = bench_answers_create(changes->probe->count);
    changes->order = bench_choose(changes->bodies, count);
    changes->which = bench_allocate(room, sizeof *changes->which);
    changes->objects = bench_allocate(room, sizeof *changes->objects);
    changes->targets = bench_allocate(room, sizeof *changes->targets);
    return changes;
}

static void changes_destroy(struct changes *changes) {
    own_destroy(changes->own);
    bench_rays_destroy(changes->probe);
    bench_answers_destroy(&changes->answers);
    free(changes->order);
    free(changes->which);
    free(changes->objects);
    free(changes->targets);
    bench_scene_destroy(changes->bodies);
    free(changes);
}

/* ------------------------------------------------------------------------------------------------- turns */

/* Chooses bodies, in random order or neighbours by number, and where they go, one pass after the other. */
static void choose(struct changes *changes) {
    struct bench_scene *bodies = changes->bodies;
    for (uint32_t pass = 0; pass < changes->passes; pass++) {
        uint32_t first = (uint32_t)((bodies->count - changes->count + 1) * bench_random(&bodies->random));
        for (uint32_t i = 0; i < changes->count; i++) {
            uint32_t at = pass * changes->count + i;
            uint32_t body = changes->in_order ? first + i : changes->order[first + i];
            changes->which[at] = body;
            changes->objects[at] = changes->own->objects[body];
            bench_step_near_home(bodies, body, changes->step, changes->targets[at]);
            memcpy(bodies->positions[body], changes->targets[at], sizeof *bodies->positions);
        }
    }
}

static double turn_of_moves(void *context) {
    struct changes *changes = context;
    uint32_t total = changes->passes * changes->count;
    choose(changes);
    double before = bench_thread_seconds();
    if (changes->one_by_one) {
        for (uint32_t i = 0; i < total; i++) {
            own_check(rg_scene_move_to(changes->own->scene, changes->objects[i], changes->targets[i]));
        }
    } else {
        for (uint32_t i = 0; i < total; i += changes->count) {
            own_move_many(changes->own, changes->objects + i, changes->targets + i, changes->count);
        }
    }
    return (bench_thread_seconds() - before) / total;
}

/* The peer is given what raygrid was given just before; the last pass is counted, which is one commit. */
static double turn_of_peer_moves(void *context) {
    struct changes *changes = context;
    uint32_t total = changes->passes * changes->count;
    return peer_move(changes->peer, changes->which, changes->targets, total, total - changes->count) / changes->count;
}

/* The same with one body moved since the commit before. */
static double turn_of_one_peer_move(void *context) {
    struct changes *changes = context;
    uint32_t total = changes->passes * changes->count;
    peer_move(changes->peer, changes->which, changes->targets, total - 1, total - 1);
    return peer_move(changes->peer, changes->which + total - 1, changes->targets + total - 1, 1, 0);
}

static double turn_of_exchange(void *context) {
    struct changes *changes = context;
    uint32_t total = changes->passes * changes->count;
    double removing = 0, inserting = 0;
    for (uint32_t done = 0; done < total; done += changes->count) {
        uint32_t first =
            (uint32_t)((changes->bodies->count - changes->count + 1) * bench_random(&changes->bodies->random));
        double start = bench_thread_seconds();
        for (uint32_t i = 0; i < changes->count; i++) own_remove(changes->own, changes->order[first + i]);
        double removed = bench_thread_seconds();
        for (uint32_t i = 0; i < changes->count; i++) own_insert(changes->own, changes->order[first + i]);
        inserting += bench_thread_seconds() - removed;
        removing += removed - start;
    }
    changes->inserting = inserting / total;
    return removing / total;
}

static double turn_of_peer_removal(void *context) {
    struct changes *changes = context;
    peer_keep(changes->peer, changes->bodies->count);
    return peer_keep(changes->peer, changes->bodies->count - 1);
}

static double turn_of_peer_insertion(void *context) {
    struct changes *changes = context;
    peer_keep(changes->peer, changes->bodies->count - 1);
    return peer_keep(changes->peer, changes->bodies->count);
}

static double turn_of_insertion(void *context) {
    struct changes *changes = context;
    turn_of_exchange(changes);
    return changes->inserting;
}

/* ------------------------------------------------------------------------------------------------ lines */

static struct bench_duel fight(struct changes *changes, bench_turn *own, bench_turn *peer) {
    return bench_duel((struct bench_side){own, changes}, (struct bench_side){changes->peer ? peer : NULL, changes},
                      changes->run->options.effort.turns);
}

/* What rays see after the changes, against where the bodies now are. */
static void report(struct changes *changes, const char *what, const struct bench_duel *duel, struct bench_goal goal) {
    struct bench_run *run = changes->run;
    struct bench_line line = bench_line("updates", changes->bodies->name, changes->bodies->count, what);
    struct exact *exact = exact_create(changes->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, changes->probe, run->options.effort.checks / 20);
    own_trace(changes->own, changes->probe, UINT32_MAX, &changes->answers);
    struct exact_error error = bench_judge_own(run, sample, changes->own, &changes->answers);
    struct exact_error peer_error = {0};
    if (changes->peer) {
        peer_trace(changes->peer, changes->probe, (struct peer_way){0, false}, &changes->answers);
        peer_error = verdict_of_peer(sample, changes->peer, &changes->answers);
        line.peer_error = &peer_error;
        line.peer_way = PEER_BUILD_NAMES[peer_build_of(changes->peer)];
        line.peer_bytes = peer_bytes_per_object(changes->peer);
    }
    line.unit = "ns";
    line.figure = 1e9 * duel->own;
    line.peer_figure = 1e9 * duel->peer;
    line.ratio = duel->ratio;
    line.goal = goal;
    line.error = &error;
    line.bytes = own_bytes_per_object(changes->own);
    bench_report_line(&run->report, &line);
    exact_sample_destroy(sample);
    exact_destroy(exact);
}

/* How many bodies a turn changes, and how often, so that it takes long enough to be measured. */
static void set_count(struct changes *changes, uint32_t count) {
    changes->count = count > 0 ? count : 1;
    changes->passes = 1 + (LEAST_CHANGES - 1) / changes->count;
}

static uint32_t touched(const struct changes *changes, uint32_t bodies) {
    uint32_t most = changes->run->options.effort.touched;
    return bodies < most ? bodies : most;
}

static void measure_single_moves(struct changes *changes) {
    static const double STEPS[] = {0.1, 1};
    uint32_t bodies = changes->bodies->count;
    changes->one_by_one = true;
    set_count(changes, touched(changes, bodies));
    for (int s = 0; s < 2; s++) {
        for (int random = 0; random < 2; random++) {
            char what[64];
            snprintf(what, sizeof what, "move one by %g r%s", STEPS[s], random ? ", random order" : "");
            changes->step = STEPS[s];
            changes->in_order = !random;
            struct bench_duel duel = fight(changes, turn_of_moves, turn_of_one_peer_move);
            bool counts = !random && bench_all_spheres(changes->bodies);
            report(changes, what, &duel,
                   counts ? bench_goal(s ? GOAL_MOVE_RADIUS : GOAL_MOVE_SMALL, bodies) : bench_no_goal());
        }
    }
}

static void measure_many_moves(struct changes *changes) {
    static const double STEPS[] = {0.1, 1}, SHARES[] = {0.001, 0.01, 0.1, 1};
    changes->one_by_one = false;
    changes->in_order = true;
    for (int s = 0; s < 2; s++) {
        for (int share = 0; share < 4; share++) {
            char what[64];
            snprintf(what, sizeof what, "move %g %% by %g r", 100 * SHARES[share], STEPS[s]);
            changes->step = STEPS[s];
            set_count(changes, (uint32_t)(SHARES[share] * changes->bodies->count));
            struct bench_duel duel = fight(changes, turn_of_moves, turn_of_peer_moves);
            bool counts = SHARES[share] == 0.01 && strcmp(changes->bodies->name, "meshes") == 0;
            report(changes, what, &duel,
                   counts ? bench_goal(GOAL_INSTANCES_MOVED, changes->bodies->count) : bench_no_goal());
        }
    }
}

static void measure_exchange(struct changes *changes) {
    uint32_t bodies = changes->bodies->count;
    bool spheres = bench_all_spheres(changes->bodies);
    set_count(changes, touched(changes, bodies / 10));
    struct bench_duel duel = fight(changes, turn_of_insertion, turn_of_peer_insertion);
    report(changes, "insert one", &duel, spheres ? bench_goal(GOAL_INSERT, bodies) : bench_no_goal());
    duel = fight(changes, turn_of_exchange, turn_of_peer_removal);
    if (changes->peer) peer_keep(changes->peer, bodies);
    report(changes, "remove one", &duel, spheres ? bench_goal(GOAL_REMOVE, bodies) : bench_no_goal());
}

/* Less than any right answer costs the peer, and wrong: how fast it could be, and why that does not count. */
static void measure_wrong_way(struct changes *changes) {
    const struct peer_choice *choice = &changes->run->options.peer;
    if (!choice->api || !peer_can(choice, changes->bodies, PEER_ARRAY_REFIT)) return;
    if (strcmp(changes->bodies->name, "meshes") != 0) return;
    changes->peer = peer_create(choice, changes->bodies, PEER_ARRAY_REFIT);
    changes->step = 1;
    set_count(changes, changes->bodies->count / 100);
    struct bench_duel duel = fight(changes, turn_of_moves, turn_of_peer_moves);
    report(changes, "move 1 % by 1 r, its wrong way", &duel, bench_no_goal());
    peer_destroy(changes->peer);
    changes->peer = NULL;
}

/* The way to move that costs the peer least. What its rays then cost is for frames.c to say. */
static enum peer_build quickest_build(struct changes *changes) {
    static const enum peer_build BUILDS[] = {PEER_LOW, PEER_ARRAY, PEER_REFIT, PEER_USER_LOW, PEER_USER_REFIT};
    const struct peer_choice *choice = &changes->run->options.peer;
    enum peer_build best = PEER_LOW;
    double least = INFINITY;
    changes->step = 1;
    set_count(changes, changes->bodies->count / 100);
    for (size_t b = 0; b < sizeof BUILDS / sizeof *BUILDS; b++) {
        if (!peer_can(choice, changes->bodies, BUILDS[b])) continue;
        changes->peer = peer_create(choice, changes->bodies, BUILDS[b]);
        for (int i = 0; i < 3; i++) {
            turn_of_moves(changes);
            double seconds = turn_of_peer_moves(changes);
            if (seconds < least) {
                least = seconds;
                best = BUILDS[b];
            }
        }
        peer_destroy(changes->peer);
        changes->peer = NULL;
    }
    return best;
}

void bench_updates(struct bench_run *run, const char *scene, uint32_t count) {
    struct bench_scene *bodies = bench_scene_of(run, scene, count);
    if (!bodies) return;
    struct changes *changes = changes_create(run, bodies);
    const struct peer_choice *choice = &run->options.peer;
    if (choice->api) {
        enum peer_build build = quickest_build(changes);
        changes->peer = peer_create(choice, changes->bodies, build);
    }
    measure_single_moves(changes);
    measure_many_moves(changes);
    peer_destroy(changes->peer);
    changes->peer = NULL;
    measure_wrong_way(changes);
    if (choice->api && bench_all_spheres(changes->bodies)) {
        changes->peer = peer_create(choice, changes->bodies, PEER_LOW);
    }
    measure_exchange(changes);
    peer_destroy(changes->peer);
    changes_destroy(changes);
}
