/* SPDX-License-Identifier: MIT */
/*
 * lasting.c: what is left of a scene's speed after a long life: as many changes as the run allows, or a journey of a
 * hundred times the scene's width, compared with a scene made afresh from the same bodies.
 */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BOXES = 100,
    STEPS = 200,          /* of the journey; */
    MOST_MOVES = 20000000 /* fewer and longer ones where there are many bodies */
};

struct life {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *old, *fresh;
    const struct bench_rays *rays;
    struct bench_answers answers;
    int passes;
};

static double trace(struct life *life, struct own *own) {
    double before = bench_thread_seconds();
    for (int i = 0; i < life->passes; i++) own_trace(own, life->rays, UINT32_MAX, &life->answers);
    return (bench_thread_seconds() - before) / life->passes;
}

static double turn_of_fresh(void *context) {
    return trace(context, ((struct life *)context)->fresh);
}

static double turn_of_old(void *context) {
    return trace(context, ((struct life *)context)->old);
}

static void compare(struct life *life, struct exact *exact, const char *what, struct bench_rays *rays) {
    struct bench_run *run = life->run;
    char name[64];
    snprintf(name, sizeof name, "%s, %s", what, rays->name);
    struct bench_line line = bench_line("lasting", life->bodies->name, life->bodies->count, name);
    life->rays = rays;
    life->answers = bench_answers_create(rays->count);
    life->passes = 1;
    life->passes = (int)fmin(ceil(run->options.effort.turn_seconds / (turn_of_old(life) + 1e-9)), 1000);
    if (life->passes < 1) life->passes = 1;
    /* The fresh scene goes first: what is judged is what the old one answers. */
    struct bench_duel duel = bench_duel((struct bench_side){turn_of_fresh, life},
                                        (struct bench_side){turn_of_old, life}, run->options.effort.turns);
    struct exact_sample *sample = exact_sample_create(exact, rays, run->options.effort.checks / 4);
    struct exact_error error = bench_judge_own(run, sample, life->old, &life->answers);
    line.unit = "Mrays/s";
    line.figure = 1e-6 * rays->count / duel.peer;
    line.peer_figure = 1e-6 * rays->count / duel.own;
    line.ratio = 1 / duel.ratio;
    line.peer_way = "itself, fresh";
    line.goal = bench_goal(GOAL_LASTING, life->bodies->count);
    line.error = &error;
    line.bytes = own_bytes_per_object(life->old);
    line.peer_bytes = own_bytes_per_object(life->fresh);
    bench_report_line(&run->report, &line);
    exact_sample_destroy(sample);
    bench_answers_destroy(&life->answers);
}

/* Whether the speed of a scene after its life, which was `what`, is that of a fresh one. */
static void compare_all(struct life *life, const char *what, const double by[3]) {
    const struct bench_effort *effort = &life->run->options.effort;
    struct exact *exact = exact_create(life->bodies, NULL);
    struct bench_rays *rays[] = {bench_primary_rays(life->bodies, effort->side, false),
                                 bench_random_rays(life->bodies, effort->incoherent, life->bodies->has_aim, false)};
    life->fresh = own_create(life->bodies, 1);
    for (int i = 0; i < 2; i++) {
        bench_shift_rays(rays[i], by);
        compare(life, exact, what, rays[i]);
        bench_rays_destroy(rays[i]);
    }
    own_destroy(life->fresh);
    exact_destroy(exact);
}

/* Removes, inserts and moves bodies. */
static void churn(struct life *life) {
    struct bench_scene *bodies = life->bodies;
    for (uint32_t done = 0; done < life->run->options.effort.churn;) {
        uint32_t body = (uint32_t)(bodies->count * bench_random(&bodies->random));
        double present[3];
        bench_step_near_home(bodies, body, bench_random(&bodies->random), present);
        memcpy(bodies->positions[body], present, sizeof present);
        if (bench_random(&bodies->random) < 0.5) {
            own_check(rg_scene_move_to(life->old->scene, life->old->objects[body], present));
            done += 1;
        } else {
            own_remove(life->old, body);
            own_insert(life->old, body);
            done += 2;
        }
    }
}

/* Takes all bodies along in steps; `by` is where they have got. */
static void drift(struct life *life, double by[3]) {
    struct bench_scene *bodies = life->bodies;
    int steps = bodies->count <= MOST_MOVES / STEPS ? STEPS : MOST_MOVES / (int)bodies->count;
    const double direction[3] = {0.8, -0.48, 0.36}; /* of length 1 */
    double step[3];
    for (int k = 0; k < 3; k++) step[k] = direction[k] * BOXES / steps;
    for (int s = 0; s < steps; s++) {
        for (uint32_t i = 0; i < bodies->count; i++) {
            for (int k = 0; k < 3; k++) bodies->positions[i][k] += step[k];
        }
        own_move_many(life->old, life->old->objects, bodies->positions, bodies->count);
    }
    for (int k = 0; k < 3; k++) by[k] = steps * step[k];
}

void bench_lasting(struct bench_run *run, const char *scene, uint32_t count) {
    for (int drifting = 0; drifting < 2; drifting++) {
        struct bench_scene *bodies = bench_scene_of(run, scene, count);
        if (!bodies) return;
        struct life life = {.run = run, .bodies = bodies, .old = own_create(bodies, 1)};
        double by[3] = {0, 0, 0};
        if (drifting) {
            drift(&life, by);
        } else {
            churn(&life);
        }
        compare_all(&life, drifting ? "drifted" : "churned", by);
        own_destroy(life.old);
        bench_scene_destroy(bodies);
    }
}
