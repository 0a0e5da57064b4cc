/* SPDX-License-Identifier: MIT */
/*
 * goal.c: frames of a crowded scene by the clock on the wall: a tenth of all spheres moves by a radius, then a
 * picture and its shadows are traced. What the host has to do for that, making the shadow rays, is timed, too.
 */
#include "evaluation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 10, FRAMES = 50, WARM_UP = 5, MOST_THREADS = 2 };

struct goal {
    struct bench_scene *bodies;
    struct own *own;
    struct bench_rays *primary, *shadows;
    struct bench_answers answers, occlusion;
};

/* Bodies that are neighbours by number move. */
static void play_frame(struct goal *goal, uint32_t number) {
    struct bench_scene *bodies = goal->bodies;
    uint32_t moved = bodies->count / PARTS, first = number % PARTS * moved;
    for (uint32_t i = first; i < first + moved; i++) {
        double to[3];
        bench_step_near_home(bodies, i, 1, to);
        memcpy(bodies->positions[i], to, sizeof to);
    }
    own_move_many(goal->own, goal->own->objects + first, bodies->positions + first, moved);
    own_trace(goal->own, goal->primary, UINT32_MAX, &goal->answers);
    bench_refill_shadow_rays(goal->shadows, goal->primary, goal->answers.t);
    own_trace(goal->own, goal->shadows, UINT32_MAX, &goal->occlusion);
}

static void run(struct evaluation *evaluation, uint32_t threads, json_t *records) {
    double seconds[FRAMES], used[FRAMES];
    struct goal goal = {.bodies = bench_scene_create("uniform", evaluation->effort.goal)};
    goal.own = own_create(goal.bodies, threads);
    goal.primary = bench_primary_rays(goal.bodies, evaluation->effort.side, false);
    goal.answers = bench_answers_create(goal.primary->count);
    goal.occlusion = bench_answers_create(goal.primary->count);
    goal.shadows = bench_shadow_rays(goal.primary, goal.answers.t);
    for (uint32_t i = 0; i < WARM_UP; i++) play_frame(&goal, i);
    for (uint32_t i = 0; i < FRAMES; i++) {
        double start = bench_wall_seconds(), used_before = bench_process_seconds();
        play_frame(&goal, i + WARM_UP);
        seconds[i] = bench_wall_seconds() - start;
        used[i] = bench_process_seconds() - used_before;
    }
    double median = bench_median(seconds, FRAMES);
    fprintf(stderr, "%u spheres, a tenth moved, %u threads: %.1f frames/s\n", goal.bodies->count, threads,
            1 / median);
    json_t *primary = evaluation_check_own(evaluation, goal.own, goal.primary, &goal.answers, 1);
    json_t *shadow = evaluation_check_own(evaluation, goal.own, goal.shadows, &goal.occlusion, 1);
    json_array_append_new(records,
                          json_pack("{s:s, s:I, s:I, s:i, s:f, s:f, s:f, s:f, s:o, s:o}", "scene", "equal", "objects",
                                    (json_int_t)goal.bodies->count, "threads", (json_int_t)threads, "frames", FRAMES,
                                    "median ms", 1e3 * median, "best ms", 1e3 * seconds[0], "processor ms",
                                    1e3 * bench_median(used, FRAMES), "frames a second", 1 / median, "primary",
                                    primary, "shadow", shadow));
    own_destroy(goal.own);
    bench_rays_destroy(goal.primary);
    bench_rays_destroy(goal.shadows);
    bench_answers_destroy(&goal.answers);
    bench_answers_destroy(&goal.occlusion);
    bench_scene_destroy(goal.bodies);
}

void evaluate_goal(struct evaluation *evaluation) {
    json_t *records = evaluation_array(evaluation, "goal");
    for (uint32_t threads = 1; threads <= MOST_THREADS; threads++) run(evaluation, threads, records);
}
