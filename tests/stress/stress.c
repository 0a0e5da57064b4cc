/* SPDX-License-Identifier: MIT */
/*
 * stress: threads that insert, move, hide and remove objects at random while others trace them, one ray or hundreds a
 * call, in grids of all kinds that have to be rebuilt again and again meanwhile, in scenes with 1, 2 and 4 workers.
 * Every answer is judged: see lanes.h.
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
#include <time.h>

enum { WRITERS = 2, TRACERS = 2, MOST_RAYS = 1500, REBUILD_EVERY = 20 /* rounds: by a call */ };

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
    int lanes[MOST_RAYS];
    bool backward[MOST_RAYS];
    uint64_t from[MOST_RAYS];
    int count;
};

/* In any order, or lane by lane, so that they go together. */
static void choose(const struct run *run, struct rays *r, random_source *random) {
    static const int counts[] = {1, 1, 16, 100, 600, MOST_RAYS};
    int first = (int)random_below(random, LANES);
    bool in_order = random_once_in(random, 2);
    r->count = counts[random_below(random, sizeof counts / sizeof *counts)];
    for (int i = 0; i < r->count; i++) {
        r->lanes[i] = in_order ? (first + i) % LANES : (int)random_below(random, LANES);
        r->backward[i] = in_order ? first % 2 : random_once_in(random, 2);
        r->rays[i] = lane_ray(r->lanes[i], r->backward[i]);
    }
    for (int i = 0; i < r->count; i++)
        r->from[i] = __atomic_load_n(&run->lanes.all[r->lanes[i]].done, __ATOMIC_SEQ_CST);
}

static void complain(struct run *run, const struct rays *r, int i, const char *why) {
    if (__atomic_add_fetch(&run->failures, 1, __ATOMIC_SEQ_CST) > 10) return;
    const struct lane *lane = &run->lanes.all[r->lanes[i]];
    fprintf(stderr, "FAILED: ray %d of %d, lane %d, states from %" PRIu64 " to %" PRIu64 " or before: t = %a, %s\n",
            i, r->count, r->lanes[i], r->from[i], __atomic_load_n(&lane->begun, __ATOMIC_SEQ_CST), r->hits[i].t, why);
}

static void trace_closest(struct run *run, struct rays *r) {
    const char *why;
    MUST(rg_scene_trace(run->lanes.scene, r->rays, r->hits, (uint64_t)r->count));
    for (int i = 0; i < r->count; i++) {
        if (!lane_judge(&run->lanes, r->lanes[i], r->from[i], r->backward[i], &r->hits[i], &why))
            complain(run, r, i, why);
    }
}

static void trace_any(struct run *run, struct rays *r) {
    MUST(rg_scene_occluded(run->lanes.scene, r->rays, r->occluded, (uint64_t)r->count));
    for (int i = 0; i < r->count; i++) {
        if (!lane_judge_occluded(&run->lanes, r->lanes[i], r->from[i], r->occluded[i]))
            complain(run, r, i, r->occluded[i] ? "occluded by nothing" : "not occluded");
    }
}

static void *trace_lanes(void *argument) {
    const struct worker *worker = argument;
    struct run *run = worker->run;
    random_source random = {~(run->seed + (uint64_t)worker->number)};
    struct rays *r = calloc(1, sizeof *r);
    if (!r) exit(EXIT_FAILURE);
    do {
        choose(run, r, &random);
        if (random_once_in(&random, 3)) {
            trace_any(run, r);
        } else {
            trace_closest(run, r);
        }
        __atomic_fetch_add(&run->rays, (uint64_t)r->count, __ATOMIC_RELAXED);
    } while (__atomic_load_n(&run->writing, __ATOMIC_SEQ_CST));
    free(r);
    return NULL;
}

/* --------------------------------------------------------------------------------------------------- a run */

/* With nobody changing anything, each ray has one right answer. */
static void judge_at_rest(struct run *run) {
    const struct lanes *lanes = &run->lanes;
    rg_scene_report report = {.size = sizeof report};
    for (int i = 0; i < LANES; i++) {
        const char *why;
        const rg_ray ray = lane_ray(i, false);
        rg_hit hit;
        MUST(rg_scene_trace(lanes->scene, &ray, &hit, 1));
        demand(lane_judge(lanes, i, lanes->all[i].done, false, &hit, &why), "at rest every object is where it is");
    }
    MUST(rg_scene_stats(lanes->scene, &report));
    demand(report.objects == lanes_count(lanes), "at rest there are as many objects as were left");
}

static void start_all(struct run *run) {
    pthread_t threads[WRITERS + TRACERS];
    struct worker workers[WRITERS + TRACERS];
    run->writing = WRITERS;
    if (pthread_barrier_init(&run->barrier, NULL, WRITERS)) exit(EXIT_FAILURE);
    for (int i = 0; i < WRITERS + TRACERS; i++) {
        workers[i] = (struct worker){run, i};
        if (pthread_create(&threads[i], NULL, i < WRITERS ? write_lanes : trace_lanes, &workers[i]))
            exit(EXIT_FAILURE);
    }
    for (int i = 0; i < WRITERS + TRACERS; i++) pthread_join(threads[i], NULL);
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
