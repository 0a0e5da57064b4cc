/* SPDX-License-Identifier: MIT */
/*
 * latency.c: how long every single change takes, and a trace of one ray, not on average but at worst: while a scene
 * is changed evenly, grows from nothing, has its grid rebuilt, and while another thread traces a long batch. Beside
 * it the peer's commit after one move. Ends with frames while a grid is rebuilt, and the memory that takes.
 */
#include "latency.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    TURNS = 3,         /* of the same calls, each in a scene of its own */
    LOOK_EVERY = 64,   /* calls: at the memory held, and at whether a rebuild is under way */
    PROBES = 4096,     /* rays that look at what has become of the scene */
    BATCH = 1000000,   /* rays, */
    LONGEST_CALLS = 50 /* calls an object, and no rebuild has come or has ended: something is wrong */
};

/* What is timed. */
enum call { INSERT, MOVE_SMALL, MOVE, JUMP, REMOVE, TRACE, CALLS };

static const char *const CALL_NAMES[CALLS] = {"insert",        "move by 0.1 r", "move by 1 r",
                                              "move anywhere", "remove",        "trace one ray"};

/* The calls of a scene's life, one after another, and their best times in all turns; UINT32_MAX: always disturbed. */
struct record {
    uint32_t count, room; /* calls of the first turn */
    uint32_t at;          /* calls of this one */
    bool differs;         /* not all turns have the same calls */
    uint8_t *calls;
    uint32_t *ns;
};

/* A scene that is changed and watched. */
struct life {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *own;
    struct bench_watch watch;
    struct bench_spread *spreads; /* of each kind of call */
    struct record *record;        /* NULL: none is kept */
    uint32_t present;             /* bodies below are in the scene */
    uint64_t turn;                /* of the steps */
    char what[64];
};

/* --------------------------------------------------------------------------------------------- timed calls */

static void note(struct record *record, enum call call, uint64_t ns, bool first) {
    uint32_t at = record->at++, time = ns < UINT32_MAX ? (uint32_t)ns : UINT32_MAX;
    if (at >= record->room) {
        record->differs = true;
    } else if (first) {
        record->calls[at] = (uint8_t)call;
        record->ns[at] = time;
    } else if (at >= record->count || record->calls[at] != call) {
        record->differs = true;
    } else if (time < record->ns[at]) {
        record->ns[at] = time;
    }
}

static void stop(struct life *life, uint64_t start, enum call call) {
    uint64_t ns = bench_watch_stop(&life->watch, start, &life->spreads[call]);
    if (life->record) note(life->record, call, ns, life->record->count == 0);
}

static void insert(struct life *life, uint32_t body) {
    struct own *own = life->own;
    rg_pose pose = bench_pose(life->bodies, body);
    rg_shape *shape = own_shape_of(own, body);
    uint64_t start = bench_watch_start(&life->watch);
    rg_result result = rg_scene_insert(own->scene, shape, &pose, &own->objects[body]);
    stop(life, start, INSERT);
    own_check(result);
    own_remember(own, body);
}

static void take_out(struct life *life, uint32_t body) {
    rg_object object = life->own->objects[body];
    uint64_t start = bench_watch_start(&life->watch);
    rg_result result = rg_scene_remove(life->own->scene, object);
    stop(life, start, REMOVE);
    own_check(result);
}

static void move_to(struct life *life, uint32_t body, const double to[3], enum call call) {
    memcpy(life->bodies->positions[body], to, sizeof *life->bodies->positions);
    rg_object object = life->own->objects[body];
    uint64_t start = bench_watch_start(&life->watch);
    rg_result result = rg_scene_move_to(life->own->scene, object, to);
    stop(life, start, call);
    own_check(result);
}

static uint32_t any_body(struct life *life) {
    return (uint32_t)(life->present * bench_random(&life->bodies->random));
}

/* Takes the place of another body: so the scene stays as dense as it is, wherever it is. */
static void jump(struct life *life, uint32_t body) {
    uint32_t other = any_body(life);
    memcpy(life->bodies->homes[body], life->bodies->homes[other], sizeof *life->bodies->homes);
    const double to[3] = {life->bodies->homes[body][0], life->bodies->homes[body][1], life->bodies->homes[body][2]};
    move_to(life, body, to, JUMP);
}

static void trace_one(struct life *life) {
    const double *origin = life->bodies->positions[any_body(life)];
    double direction[3];
    rg_hit hit;
    bench_random_direction(&life->bodies->random, direction);
    const rg_ray ray = rg_ray_from(origin, direction);
    uint64_t start = bench_watch_start(&life->watch);
    rg_result result = rg_scene_trace(life->own->scene, &ray, &hit, 1);
    stop(life, start, TRACE);
    own_check(result);
}

/* One or two calls, of each kind as often. */
static void step(struct life *life) {
    uint32_t body = any_body(life);
    double to[3];
    switch (life->turn++ % 5) {
    case 0:
        bench_step_near_home(life->bodies, body, 0.1, to);
        move_to(life, body, to, MOVE_SMALL);
        return;
    case 1:
        bench_step_near_home(life->bodies, body, 1, to);
        move_to(life, body, to, MOVE);
        return;
    case 2:
        jump(life, body);
        return;
    case 3:
        take_out(life, body);
        insert(life, body);
        return;
    default:
        trace_one(life);
    }
}

/* --------------------------------------------------------------------------------------------- its reports */

/* All bodies are in the scene: what rays see is held against brute force. */
static struct exact_error judge(struct life *life) {
    const struct bench_effort *effort = &life->run->options.effort;
    struct bench_rays *rays = bench_random_rays(life->bodies, PROBES, false, false);
    const double *far = life->bodies->homes[0];
    const double by[3] = {floor(far[0]), floor(far[1]), floor(far[2])};
    bench_shift_rays(rays, by);
    struct bench_answers answers = bench_answers_create(rays->count);
    struct exact *exact = exact_create(life->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, rays, effort->checks / 20);
    own_trace(life->own, rays, UINT32_MAX, &answers);
    struct exact_error error = bench_judge_own(life->run, sample, life->own, &answers);
    exact_sample_destroy(sample);
    exact_destroy(exact);
    bench_answers_destroy(&answers);
    bench_rays_destroy(rays);
    return error;
}

/* What is held against the goals. */
static enum bench_view view_of(const struct life *life) {
    return life->record && !life->record->differs ? SPREAD_BEST : SPREAD_QUIET;
}

/* A line for each kind of call, and one for the longest change of all. */
static void report(struct life *life) {
    const uint32_t count = life->bodies->count;
    struct exact_error error = judge(life);
    char what[96];
    double longest = 0;
    for (int call = 0; call < CALLS; call++) {
        const struct bench_spread *spread = &life->spreads[call];
        if (!spread->views[SPREAD_ALL].calls) continue;
        snprintf(what, sizeof what, "%s: %s", life->what, CALL_NAMES[call]);
        struct bench_line line = bench_line("latency", life->bodies->name, count, what);
        line.unit = "us";
        line.figure = bench_spread_at(spread, view_of(life), 0.9999);
        line.spread = spread;
        line.bytes = own_bytes_per_object(life->own);
        line.error = &error;
        if (call != TRACE) line.goal = bench_goal(GOAL_CHANGE_USUAL, count);
        if (call != TRACE) longest = fmax(longest, bench_spread_longest(spread, view_of(life)));
        bench_report_line(&life->run->report, &line);
    }
    snprintf(what, sizeof what, "%s: the longest change", life->what);
    struct bench_line line = bench_line("latency", life->bodies->name, count, what);
    line.unit = "us";
    line.figure = longest;
    line.bytes = own_bytes_per_object(life->own);
    line.goal = bench_goal(GOAL_CHANGE_LONGEST, count);
    line.error = &error;
    bench_report_line(&life->run->report, &line);
}

/* ------------------------------------------------------------------------------------------------ scenarios */

struct manner {
    rg_grid_kind kind;
    uint32_t workers;
};

/* What becomes of a scene. */
struct story {
    const char *name;
    void (*play)(struct life *life, rg_grid_kind kind);
    bool begins_empty;
};

static bool life_begin(struct life *life, struct bench_run *run, const char *scene, uint32_t count,
                       struct manner manner, bool empty) {
    life->bodies = bench_scene_of(run, scene, count);
    if (!life->bodies) return false;
    life->run = run;
    life->turn = 0;
    const rg_grid_config grid = {.size = sizeof grid, .kind = manner.kind};
    life->own = own_create_empty(life->bodies, manner.workers, &grid);
    life->present = 0;
    if (!empty) {
        own_fill(life->own);
        life->present = count;
    }
    return true;
}

static void life_end(struct life *life) {
    bench_watch_end(&life->watch);
    own_destroy(life->own);
    bench_scene_destroy(life->bodies);
}

static void name_life(struct life *life, struct manner manner, const char *what) {
    snprintf(life->what, sizeof life->what, "%s, %u worker%s, %s", own_kind_name(manner.kind), manner.workers,
             manner.workers > 1 ? "s" : "", what);
}

static void record_end_turn(struct record *record) {
    if (record->count && record->at != record->count) record->differs = true;
    record->count = record->at < record->room ? record->at : record->room;
    record->at = 0;
}

static void add_best_times(const struct record *record, struct bench_spread *spreads) {
    for (uint32_t i = 0; i < record->count && !record->differs; i++) {
        if (record->ns[i] != UINT32_MAX) bench_spread_add(&spreads[record->calls[i]], SPREAD_BEST, record->ns[i]);
    }
}

static void tell(struct bench_run *run, const char *scene, uint32_t count, struct manner manner,
                 const struct story *story) {
    struct record record = {.room = 2 * run->options.effort.calls + 8 * count};
    struct life life = {.record = &record};
    record.calls = bench_allocate(record.room, sizeof *record.calls);
    record.ns = bench_allocate(record.room, sizeof *record.ns);
    life.spreads = bench_allocate(CALLS, sizeof *life.spreads);
    name_life(&life, manner, story->name);
    for (int turn = 0; turn < TURNS; turn++) {
        if (!life_begin(&life, run, scene, count, manner, story->begins_empty)) break;
        bench_watch_begin(&life.watch);
        story->play(&life, manner.kind);
        record_end_turn(&record);
        if (turn == TURNS - 1) {
            add_best_times(&record, life.spreads);
            report(&life);
        }
        life_end(&life);
    }
    free(record.calls);
    free(record.ns);
    free(life.spreads);
}

static void churn(struct life *life, rg_grid_kind kind) {
    (void)kind;
    for (uint32_t i = 0; i < life->run->options.effort.calls; i++) step(life);
}

/* From nothing; with every fourth insert goes another call. */
static void grow(struct life *life, rg_grid_kind kind) {
    (void)kind;
    while (life->present < life->bodies->count) {
        insert(life, life->present++);
        if (life->present % 4 == 0) step(life);
    }
}

void bench_drift(struct bench_scene *bodies, uint32_t body, rg_grid_kind kind) {
    double *x[2] = {&bodies->homes[body][0], &bodies->positions[body][0]};
    for (int i = 0; i < 2; i++)
        *x[i] = kind == RG_GRID_LOOSE ? (float)(*x[i] + BENCH_DRIFT) : (float)(*x[i] * BENCH_SPREAD);
}

/* Takes the scene to where its grid must be rebuilt, and goes on until it has been. The drifting is timed, too: one
 * of its calls begins the rebuild. */
static void pass_through_rebuild(struct life *life, rg_grid_kind kind) {
    uint32_t count = life->bodies->count;
    uint64_t before = own_grid_report(life->own).rebuilds, most = (uint64_t)LONGEST_CALLS * count + 10000;
    for (uint32_t i = 0; i < count; i++) {
        double to[3];
        bench_drift(life->bodies, i, kind);
        memcpy(to, life->bodies->positions[i], sizeof to);
        move_to(life, i, to, JUMP);
    }
    for (uint64_t i = 0; i < most; i++) {
        step(life);
        if (i % LOOK_EVERY) continue;
        rg_grid_report report = own_grid_report(life->own);
        if (!report.rebuilding && report.rebuilds > before) break;
    }
    /* What was the grid is given back. */
    for (uint32_t i = 0; i < count / 8; i++) step(life);
    if (own_grid_report(life->own).rebuilds == before) fprintf(stderr, "%s: there was none\n", life->what);
}

static const struct story STORIES[] = {
    {"churn", churn, false}, {"growth", grow, true}, {"rebuild", pass_through_rebuild, false}};

/* ------------------------------------------------------------------------------------------ beside a batch */

/* A thread that traces batches until it is told to end. */
struct tracer {
    struct own *own;
    struct bench_rays *rays;
    struct bench_answers answers;
    bool ends; /* atomic */
    double seconds;
    int batches;
};

static void *trace_batches(void *argument) {
    struct tracer *tracer = argument;
    double before = bench_wall_seconds();
    do {
        own_trace(tracer->own, tracer->rays, UINT32_MAX, &tracer->answers);
        tracer->batches++;
    } while (!__atomic_load_n(&tracer->ends, __ATOMIC_RELAXED));
    tracer->seconds = (bench_wall_seconds() - before) / tracer->batches;
    return NULL;
}

/* What the batches lose to the changes: seconds of one, alone and beside them. */
static void report_batches(struct life *life, double alone, double beside) {
    char what[96];
    snprintf(what, sizeof what, "%s: the batch", life->what);
    struct bench_line line = bench_line("latency", life->bodies->name, life->bodies->count, what);
    line.unit = "ms";
    line.figure = 1e3 * beside;
    line.peer_figure = 1e3 * alone;
    line.ratio = alone / beside;
    line.peer_way = "itself, without the changes";
    line.bytes = own_bytes_per_object(life->own);
    bench_report_line(&life->run->report, &line);
}

static void beside_batch(struct bench_run *run, const char *scene, uint32_t count, struct manner manner) {
    struct life life = {.record = NULL};
    pthread_t thread;
    if (!life_begin(&life, run, scene, count, manner, false)) return;
    life.spreads = bench_allocate(CALLS, sizeof *life.spreads);
    name_life(&life, manner, "beside a batch");
    uint32_t rays = run->options.effort.incoherent < 65536 ? run->options.effort.incoherent : BATCH;
    struct tracer tracer = {.own = life.own, .rays = bench_random_rays(life.bodies, rays, false, false)};
    tracer.answers = bench_answers_create(rays);
    own_trace(life.own, tracer.rays, UINT32_MAX, &tracer.answers); /* warms up */
    double before = bench_wall_seconds();
    own_trace(life.own, tracer.rays, UINT32_MAX, &tracer.answers);
    double alone = bench_wall_seconds() - before;
    if (pthread_create(&thread, NULL, trace_batches, &tracer)) own_check(RG_OUT_OF_THREADS);
    bench_watch_begin(&life.watch);
    for (uint32_t i = 0; i < run->options.effort.calls / 4; i++) step(&life);
    __atomic_store_n(&tracer.ends, true, __ATOMIC_RELAXED);
    pthread_join(thread, NULL);
    report(&life);
    report_batches(&life, alone, tracer.seconds);
    bench_rays_destroy(tracer.rays);
    bench_answers_destroy(&tracer.answers);
    life_end(&life);
    free(life.spreads);
}

/* ---------------------------------------------------------------------------------- the peer, and the machine */

/* One body is moved, and seen at its new place. */
static void one_commit(struct peer *peer, struct bench_scene *bodies, struct bench_spread *spread) {
    uint32_t body = (uint32_t)(bodies->count * bench_random(&bodies->random));
    double to[1][3];
    bench_step_near_home(bodies, body, 1, to[0]);
    memcpy(bodies->positions[body], to[0], sizeof to[0]);
    bench_spread_add(spread, SPREAD_ALL, (uint64_t)(1e9 * peer_move(peer, &body, to, 1, 0)));
}

static void commits(struct bench_run *run, const char *scene, uint32_t count) {
    static const enum peer_build BUILDS[] = {PEER_LOW, PEER_USER_LOW, PEER_USER_REFIT};
    const struct peer_choice *choice = &run->options.peer;
    enum { COMMITS = 25 };
    for (size_t b = 0; b < sizeof BUILDS / sizeof *BUILDS && choice->api; b++) {
        struct bench_scene *bodies = bench_scene_of(run, scene, count);
        if (!bodies) return;
        struct bench_spread spread = {0};
        struct peer *peer = peer_create(choice, bodies, BUILDS[b]);
        char what[96];
        snprintf(what, sizeof what, "peer: commit after one move, %s", PEER_BUILD_NAMES[BUILDS[b]]);
        struct bench_line line = bench_line("latency", bodies->name, count, what);
        one_commit(peer, bodies, &(struct bench_spread){0});
        for (int i = 0; i < COMMITS; i++) one_commit(peer, bodies, &spread);
        line.unit = "us";
        line.figure = line.peer_figure = bench_spread_at(&spread, SPREAD_ALL, 0.5);
        line.spread = &spread;
        line.peer_way = PEER_BUILD_NAMES[BUILDS[b]];
        line.peer_bytes = peer_bytes_per_object(peer);
        bench_report_line(&run->report, &line);
        peer_destroy(peer);
        bench_scene_destroy(bodies);
    }
}

static void idle(struct bench_run *run, const char *scene, uint32_t count) {
    struct bench_watch watch;
    struct bench_spread spread = {0};
    struct bench_line line = bench_line("latency", scene, count, "the machine: 500 ns of nothing");
    bench_watch_begin(&watch);
    bench_watch_idle(&watch, &spread, run->options.effort.calls);
    bench_watch_end(&watch);
    line.unit = "us";
    line.figure = bench_spread_at(&spread, SPREAD_QUIET, 0.9999);
    line.spread = &spread;
    bench_report_line(&run->report, &line);
}

void bench_latency(struct bench_run *run, const char *scene, uint32_t count) {
    static const rg_grid_kind KINDS[] = {RG_GRID_LOOSE, RG_GRID_HIERARCHICAL, RG_GRID_UNIFORM};
    if (strcmp(scene, "uniform") != 0) return;
    idle(run, scene, count);
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
        for (uint32_t workers = 2; workers > 0 && bench_wanted(run->options.modes, own_kind_name(KINDS[k]));
             workers--) {
            const struct manner manner = {KINDS[k], workers};
            for (size_t s = 0; s < sizeof STORIES / sizeof *STORIES; s++)
                tell(run, scene, count, manner, &STORIES[s]);
            if (KINDS[k] == RG_GRID_LOOSE) beside_batch(run, scene, count, manner);
            bench_rebuild_frames(run, scene, count, KINDS[k], workers);
        }
    }
    commits(run, scene, count);
}
