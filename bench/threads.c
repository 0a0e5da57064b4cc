/* SPDX-License-Identifier: MIT */
/* threads.c: what a second thread gives, by the clock on the wall: the same calls on a scene with two workers and on
 * one with a single one. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>

enum { WORKERS = 2 };

/* The same bodies in two scenes. */
struct team {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *alone, *together;
    const struct bench_rays *rays; /* NULL: bodies are moved */
    struct bench_answers answers;
    double (*targets)[3];
    int passes;
};

static double work(struct team *team, struct own *own) {
    double before = bench_wall_seconds();
    for (int i = 0; i < team->passes; i++) {
        if (team->rays) {
            own_trace(own, team->rays, UINT32_MAX, &team->answers);
        } else {
            own_move_many(own, own->objects, team->targets, team->bodies->count);
        }
    }
    return (bench_wall_seconds() - before) / team->passes;
}

/* Moves go back and forth: whoever is first in a turn chooses where to. */
static double turn_of_two(void *context) {
    struct team *team = context;
    for (uint32_t i = 0; !team->rays && i < team->bodies->count; i++) {
        bench_step_near_home(team->bodies, i, 1, team->targets[i]);
    }
    return work(team, team->together);
}

static double turn_of_one(void *context) {
    return work(context, ((struct team *)context)->alone);
}

static void measure(struct team *team, const char *what, struct exact *exact) {
    struct bench_run *run = team->run;
    double amount = team->rays ? team->rays->count : team->bodies->count;
    struct bench_line line = bench_line("threads", team->bodies->name, team->bodies->count, what);
    team->passes = 1;
    team->passes = (int)fmin(fmax(ceil(run->options.effort.turn_seconds / (turn_of_two(team) + 1e-9)), 1), 1000);
    struct bench_duel duel = bench_duel((struct bench_side){turn_of_two, team},
                                        (struct bench_side){turn_of_one, team}, run->options.effort.turns);
    struct exact_error error;
    if (team->rays) {
        struct exact_sample *sample = exact_sample_create(exact, team->rays, run->options.effort.checks / 4);
        own_trace(team->together, team->rays, UINT32_MAX, &team->answers);
        error = bench_judge_own(run, sample, team->together, &team->answers);
        line.error = &error;
        exact_sample_destroy(sample);
    }
    line.unit = team->rays ? "Mrays/s" : "ns";
    line.figure = team->rays ? 1e-6 * amount / duel.own : 1e9 * duel.own / amount;
    line.peer_figure = team->rays ? 1e-6 * amount / duel.peer : 1e9 * duel.peer / amount;
    line.ratio = duel.ratio;
    line.peer_way = "itself, one thread";
    line.goal = bench_goal(GOAL_TWO_THREADS, team->bodies->count);
    line.threads = WORKERS;
    line.bytes = own_bytes_per_object(team->together);
    bench_report_line(&run->report, &line);
}

void bench_threads(struct bench_run *run, const char *scene, uint32_t count) {
    struct bench_scene *bodies = bench_scene_of(run, scene, count);
    if (!bodies) return;
    const struct bench_effort *effort = &run->options.effort;
    struct team team = {.run = run, .bodies = bodies};
    struct exact *exact = exact_create(bodies, NULL);
    struct bench_rays *sets[] = {bench_primary_rays(bodies, effort->side, false),
                                 bench_random_rays(bodies, effort->incoherent, bodies->has_aim, false)};
    team.alone = own_create(bodies, 1);
    team.together = own_create(bodies, WORKERS);
    team.targets = bench_allocate(bodies->count, sizeof *team.targets);
    for (int i = 0; i < 2; i++) {
        team.rays = sets[i];
        team.answers = bench_answers_create(sets[i]->count);
        measure(&team, sets[i]->name, exact);
        bench_answers_destroy(&team.answers);
        bench_rays_destroy(sets[i]);
    }
    team.rays = NULL;
    measure(&team, "move 100 % by 1 r", exact);
    free(team.targets);
    own_destroy(team.alone);
    own_destroy(team.together);
    exact_destroy(exact);
    bench_scene_destroy(bodies);
}
