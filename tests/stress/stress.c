/* SPDX-License-Identifier: MIT */
/*
 * stress: threads that insert, move, hide and remove objects at random while others trace them, one ray or hundreds a
 * call, in grids of all kinds that have to be rebuilt again and again meanwhile, in scenes with 1, 2 and 4 workers;
 * and one that traces a frame of the scene and brings it up to date. Every answer is judged: see lanes.h.
 *
 * stress [--seconds N] [--rounds N] [--seed N]: so many rounds of changes of each lane in each scene; with seconds,
 * scene after scene with other seeds until they are over.
 */
#define _POSIX_C_SOURCE 200809L
#include "lanes.h"

#include "../reference/random.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    WRITERS = 2,
    TRACERS = 2,
    THREADS = WRITERS + TRACERS + 1,
    MOST_RAYS = 1500,
    REBUILD_EVERY = 20 /* rounds: by a call */
};

static const uint32_t WORKERS[] = {1, 2, 4};

struct run {
    struct lanes lanes;
    uint64_t seed;
    int rounds;
    pthread_barrier_t barrier; /* of the writers: all lanes are in nearly the same state */
    int writing;               /* atomic: writers that are not done */
    uint64_t rays;             /* atomic: judged */
    int failures;              /* atomic */
};

struct worker {
    struct run *run;
    int number;
};

/* ------------------------------------------------------------------------------------------------- writers */

/* Each has every second block of lanes. */
enum { BLOCK = 32 };

static void change_block(struct run *run, random_source *random, int first) {
    for (int i = 0; i < BLOCK;) {
        int together = random_once_in(random, 4) ? 1 + (int)random_below(random, (uint32_t)(BLOCK - i)) : 0;
        int moved = together ? lanes_move_together(&run->lanes, first + i, together) : 0;
        if (moved == 0) {
            lane_advance(&run->lanes, first + i);
            moved = 1;
        }
        i += moved;
    }
}

static void *write_lanes(void *argument) {
    const struct worker *worker = argument;
    struct run *run = worker->run;
    random_source random = {run->seed + (uint64_t)worker->number};
    for (int round = 0; round < run->rounds; round++) {
        for (int first = STILL + BLOCK * worker->number; first < LANES; first += BLOCK * WRITERS)
            change_block(run, &random, first);
        if (worker->number == 0 && round % REBUILD_EVERY == REBUILD_EVERY - 1)
            MUST(rg_grid_rebuild(run->lanes.scene, RG_GRID_OF_SCENE));
        pthread_barrier_wait(&run->barrier);
    }
    __atomic_fetch_sub(&run->writing, 1, __ATOMIC_SEQ_CST);
    return NULL;
}

/* ------------------------------------------------------------------------------------------------- tracers */

struct rays {
    rg_ray rays[MOST_RAYS];
    rg_hit hits[MOST_RAYS];
    uint8_t occluded[MOST_RAYS];
    struct lane_look looks[MOST_RAYS];
    struct lane_span spans[MOST_RAYS];
    int count;
};

/* In any order, or lane by lane, so that they go together. */
static void choose(struct rays *r, random_source *random) {
    static const int counts[] = {1, 1, 16, 100, 600, MOST_RAYS};
    int first = (int)random_below(random, LANES);
    bool in_order = random_once_in(random, 2);
    r->count = counts[random_below(random, sizeof counts / sizeof *counts)];
    for (int i = 0; i < r->count; i++) {
        r->looks[i].lane = in_order ? (first + i) % LANES : (int)random_below(random, LANES);
        r->looks[i].way =
            in_order ? (enum lane_way)(first % LANE_WAYS) : (enum lane_way)random_below(random, LANE_WAYS);
    }
}

static void look_before(const struct run *run, struct rays *r) {
    for (int i = 0; i < r->count; i++) {
        struct lane_look *look = &r->looks[i];
        r->spans[i].from = look->aim = lane_done(&run->lanes, look->lane);
        r->rays[i] = lane_ray(&run->lanes, look);
    }
}

static void look_after(const struct run *run, struct rays *r) {
    for (int i = 0; i < r->count; i++) r->spans[i].to = lane_begun(&run->lanes, r->looks[i].lane);
}

static void complain(struct run *run, const struct rays *r, int i, const char *why) {
    if (__atomic_add_fetch(&run->failures, 1, __ATOMIC_SEQ_CST) > 10) return;
    fprintf(stderr,
            "FAILED: seed %" PRIu64 ", ray %d of %d, lane %d, way %d, states %" PRIu64 " to %" PRIu64
            ": t = %a, %s\n",
            run->seed, i, r->count, r->looks[i].lane, (int)r->looks[i].way, r->spans[i].from, r->spans[i].to,
            r->hits[i].t, why);
}

static void judge(struct run *run, struct rays *r) {
    const char *why;
    for (int i = 0; i < r->count; i++) {
        if (!lane_judge(&run->lanes, &r->looks[i], r->spans[i], &r->hits[i], &why)) complain(run, r, i, why);
    }
    __atomic_fetch_add(&run->rays, (uint64_t)r->count, __ATOMIC_RELAXED);
}

static void trace_closest(struct run *run, struct rays *r) {
    look_before(run, r);
    MUST(rg_scene_trace(run->lanes.scene, r->rays, r->hits, (uint64_t)r->count));
    look_after(run, r);
    judge(run, r);
}

static void trace_any(struct run *run, struct rays *r) {
    look_before(run, r);
    MUST(rg_scene_occluded(run->lanes.scene, r->rays, r->occluded, (uint64_t)r->count));
    look_after(run, r);
    for (int i = 0; i < r->count; i++) {
        if (!lane_judge_occluded(&run->lanes, &r->looks[i], r->spans[i], r->occluded[i]))
            complain(run, r, i, r->occluded[i] ? "occluded by nothing" : "not occluded");
    }
    __atomic_fetch_add(&run->rays, (uint64_t)r->count, __ATOMIC_RELAXED);
}

static void *trace_lanes(void *argument) {
    const struct worker *worker = argument;
    struct run *run = worker->run;
    random_source random = {~(run->seed + (uint64_t)worker->number)};
    struct rays *r = calloc(1, sizeof *r);
    if (!r) exit(EXIT_FAILURE);
    do {
        choose(r, &random);
        if (random_once_in(&random, 3)) {
            trace_any(run, r);
        } else {
            trace_closest(run, r);
        }
    } while (__atomic_load_n(&run->writing, __ATOMIC_SEQ_CST));
    free(r);
    return NULL;
}

/* A frame shows what was there at one instant of its update, and goes on to show it. */
static void trace_updates(struct run *run, rg_scene *frame, struct rays *r, rg_hit *again) {
    look_before(run, r);
    MUST(rg_scene_update_frame(frame));
    look_after(run, r);
    MUST(rg_scene_trace(frame, r->rays, r->hits, (uint64_t)r->count));
    judge(run, r);
    MUST(rg_scene_trace(frame, r->rays, again, (uint64_t)r->count));
    if (memcmp(r->hits, again, (size_t)r->count * sizeof *again) != 0) complain(run, r, 0, "a frame has changed");
}

static void *trace_frame(void *argument) {
    const struct worker *worker = argument;
    struct run *run = worker->run;
    random_source random = {run->seed + (uint64_t)worker->number};
    struct books books = {0};
    const rg_scene_config config = {
        .size = sizeof config, .workers = 1 + (uint32_t)(run->seed % 2), .allocator = books_hooks(&books)};
    rg_scene *frame = NULL;
    struct rays *r = calloc(1, sizeof *r);
    rg_hit *again = calloc(MOST_RAYS, sizeof *again);
    if (!r || !again) exit(EXIT_FAILURE);
    MUST(rg_scene_create_frame(run->lanes.scene, &config, &frame));
    do {
        choose(r, &random);
        trace_updates(run, frame, r, again);
    } while (__atomic_load_n(&run->writing, __ATOMIC_SEQ_CST));
    destroy_scene(&books, &frame);
    free(r);
    free(again);
    return NULL;
}

/* --------------------------------------------------------------------------------------------------- a run */

/* With nobody changing anything, each ray has one right answer. */
static void judge_at_rest(struct run *run) {
    const struct lanes *lanes = &run->lanes;
    rg_scene_report report = {.size = sizeof report};
    for (int i = 0; i < LANES; i++) {
        const char *why;
        const struct lane_span now = {lane_done(lanes, i), lane_done(lanes, i)};
        const struct lane_look look = {i, LANE_ACROSS, now.from};
        const rg_ray ray = lane_ray(lanes, &look);
        rg_hit hit;
        MUST(rg_scene_trace(lanes->scene, &ray, &hit, 1));
        demand(lane_judge(lanes, &look, now, &hit, &why), "at rest every object is where it is");
    }
    MUST(rg_scene_stats(lanes->scene, &report));
    demand(report.objects == lanes_count(lanes), "at rest there are as many objects as were left");
}

static void start_all(struct run *run) {
    pthread_t threads[THREADS];
    struct worker workers[THREADS];
    run->writing = WRITERS;
    if (pthread_barrier_init(&run->barrier, NULL, WRITERS)) exit(EXIT_FAILURE);
    for (int i = 0; i < THREADS; i++) {
        workers[i] = (struct worker){run, i};
        void *(*work)(void *) = i < WRITERS ? write_lanes : i < WRITERS + TRACERS ? trace_lanes : trace_frame;
        if (pthread_create(&threads[i], NULL, work, &workers[i])) exit(EXIT_FAILURE);
    }
    for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
    pthread_barrier_destroy(&run->barrier);
}

static void run_scene(rg_grid_kind kind, uint32_t workers, int rounds, uint64_t seed) {
    struct books books = {0};
    struct run *run = calloc(1, sizeof *run);
    if (!run) exit(EXIT_FAILURE);
    run->seed = seed;
    run->rounds = rounds;
    rg_scene *scene = create_scene(&books, kind, workers);
    lanes_begin(&run->lanes, scene, seed % 2, seed);
    start_all(run);
    judge_at_rest(run);
    rg_grid_report report = report_grid(scene);
    printf("%s, %" PRIu32 " workers, seed %" PRIu64 ": %" PRIu64 " rays, %" PRIu64 " rebuilds, %d failures\n",
           kind_name(kind), workers, seed, run->rays, report.rebuilds, run->failures);
    fflush(stdout);
    demand(report.rebuilds > (uint64_t)(rounds / REBUILD_EVERY), "the grid was rebuilt beside what serves");
    demand(!run->failures, "every ray saw what was there");
    destroy_scene(&books, &scene);
    lanes_end(&run->lanes);
    free(run);
}

int main(int argc, char **argv) {
    time_t seconds = (time_t)option(argc, argv, "--seconds", 0), begin = time(NULL);
    uint64_t seed = option(argc, argv, "--seed", 1);
    int rounds = (int)option(argc, argv, "--rounds", 100);
    do {
        for (int k = 0; k < 3; k++) {
            for (int w = 0; w < 3; w++) run_scene(KINDS[k], WORKERS[w], rounds, seed + (uint64_t)(3 * k + w));
        }
        seed += 9;
    } while (time(NULL) - begin < seconds);
    return EXIT_SUCCESS;
}
