/* SPDX-License-Identifier: MIT */
/*
 * rounds.c: (a), (b) and (e): some entrants with the same scene, turn by turn, so that what disturbs the machine
 * disturbs all of them. First they trace the scene as it stands, then all bodies are moved along their paths.
 */
#include "entrant.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of an animation from time 0 to 1, for the updates. */
static const double STEP = 1.0 / 64;

struct round {
    struct evaluation *evaluation;
    struct animation *animation;
    uint32_t resolution; /* 0: the grids choose */
    struct entrant *entrants[ENTRANT_KINDS];
    int count;
    struct bench_rays *rays[2]; /* primary, shadow */
    json_t *judged[ENTRANT_KINDS][3];
    double cells[ENTRANT_KINDS], tests[ENTRANT_KINDS];
    rg_grid_report grids[ENTRANT_KINDS]; /* before anything moves */
};

/* What takes this long is not much disturbed, and once is enough. */
static const double LONG = 0.5;

static void take_turns(struct round *r, int which) {
    for (int turn = 0; turn < r->evaluation->effort.turns; turn++) {
        for (int i = 0; i < r->count; i++) {
            struct entrant *e = r->entrants[i];
            if (turn > 0 && e->seconds[which] > LONG) continue;
            e->seconds[which] = fmin(e->seconds[which], entrant_trace(e, r->rays[which], which));
        }
    }
}

/* All answers to the rays, `as` their place in the record. */
static void judge(struct round *r, int which, int as) {
    struct exact *exact = exact_create(r->animation->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, r->rays[which], r->evaluation->effort.checks);
    for (int e = 0; e < r->count; e++) r->judged[e][as] = entrant_judge(r->entrants[e], sample, which);
    exact_sample_destroy(sample);
    exact_destroy(exact);
}

static void stand_still(struct round *r) {
    take_turns(r, 0);
    judge(r, 0, 0);
    for (int e = 0; e < r->count; e++) {
        entrant_count(r->entrants[e], r->rays[0], &r->cells[e], &r->tests[e]);
        if (r->entrants[e]->own) r->grids[e] = own_grid_report(r->entrants[e]->own);
    }
    r->rays[1] = bench_shadow_rays(r->rays[0], r->entrants[0]->answers[0].t);
    take_turns(r, 1);
    judge(r, 1, 1);
}

static void move(struct round *r) {
    for (int turn = 1; turn <= r->evaluation->effort.turns; turn++) {
        animation_go(r->animation, turn * STEP);
        for (int e = 0; e < r->count; e++) entrant_move(r->entrants[e]);
    }
    for (int e = 0; e < r->count; e++) (void)entrant_trace(r->entrants[e], r->rays[0], 0);
    judge(r, 0, 2);
}

static void report(struct round *r, int which, json_t *records) {
    const struct entrant *e = r->entrants[which];
    const struct bench_scene *bodies = r->animation->bodies;
    json_t *record = json_pack("{s:s, s:I, s:s}", "scene", bodies->name, "objects", (json_int_t)bodies->count, "side",
                               ENTRANT_NAMES[e->kind]);
    const rg_grid_report *grid = &r->grids[which];
    json_object_set_new(record, "resolution", r->resolution ? json_integer(r->resolution) : json_null());
    json_object_set_new(record, "primary ms", json_real(1e3 * e->seconds[0]));
    json_object_set_new(record, "shadow ms", json_real(1e3 * e->seconds[1]));
    json_object_set_new(record, "frames a second", json_real(1 / (e->seconds[0] + e->seconds[1])));
    json_object_set_new(record, "cells a ray", evaluation_number(r->cells[which]));
    json_object_set_new(record, "tests a ray", evaluation_number(r->tests[which]));
    json_object_set_new(record, "updates a second", json_real(1 / e->update));
    json_object_set_new(record, "update ns", json_real(1e9 * e->update));
    json_object_set_new(record, "single update ns", json_real(1e9 * e->single));
    json_object_set_new(record, "tiles", json_integer((json_int_t)grid->tiles));
    json_object_set_new(record, "entries an object",
                        evaluation_number(e->own ? (double)grid->entries / bodies->count : NAN));
    json_object_set_new(record, "bytes an object",
                        json_real(e->own ? own_bytes_per_object(e->own) : peer_bytes_per_object(e->peer)));
    json_object_set_new(record, "primary", r->judged[which][0]);
    json_object_set_new(record, "shadow", r->judged[which][1]);
    json_object_set_new(record, "moved", r->judged[which][2]);
    fprintf(stderr, "%s, %u, %s, resolution %u: %.1f frames/s, %.0f ns an update\n", bodies->name, bodies->count,
            ENTRANT_NAMES[e->kind], r->resolution, 1 / (e->seconds[0] + e->seconds[1]), 1e9 * e->update);
    json_array_append_new(records, record);
}

static void run(struct round *r, const enum entrant_kind *kinds, int count, json_t *records) {
    animation_go(r->animation, 0);
    r->rays[0] = bench_primary_rays(r->animation->bodies, r->evaluation->effort.side, false);
    for (int i = 0; i < count; i++) {
        if (kinds[i] == ENTRANT_PEER && !r->evaluation->peer.api) continue;
        r->entrants[r->count++] =
            entrant_create(r->evaluation, kinds[i], r->animation, r->resolution, r->rays[0]->count);
    }
    stand_still(r);
    move(r);
    for (int e = 0; e < r->count; e++) report(r, e, records);
    for (int e = 0; e < r->count; e++) entrant_destroy(r->entrants[e]);
    for (int which = 0; which < 2; which++) bench_rays_destroy(r->rays[which]);
}

static void run_at_all_resolutions(struct evaluation *evaluation, const char *name, uint32_t count) {
    static const enum entrant_kind WITHOUT[] = {ENTRANT_LOOSE, ENTRANT_PEER},
                                   WITH[] = {ENTRANT_UNIFORM, ENTRANT_TILES, ENTRANT_EIGHT_TILES,
                                             ENTRANT_HIERARCHICAL};
    struct animation *animation = animation_create(name, count);
    json_t *records = evaluation_array(evaluation, "resolutions");
    if (!animation) return;
    struct round lines = {.evaluation = evaluation, .animation = animation};
    run(&lines, WITHOUT, 2, records);
    for (uint32_t resolution = 8; resolution <= evaluation->effort.finest; resolution *= 2) {
        struct round points = {.evaluation = evaluation, .animation = animation, .resolution = resolution};
        run(&points, WITH, 4, records);
    }
    animation_destroy(animation);
}

void evaluate_resolutions(struct evaluation *evaluation) {
    const struct evaluation_effort *effort = &evaluation->effort;
    run_at_all_resolutions(evaluation, "flake", effort->flake);
    run_at_all_resolutions(evaluation, "crowd", effort->crowd);
    run_at_all_resolutions(evaluation, "equal", effort->equal);
    run_at_all_resolutions(evaluation, "engine", 0);
}

void evaluate_counts(struct evaluation *evaluation) {
    static const enum entrant_kind ALL[] = {ENTRANT_UNIFORM, ENTRANT_HIERARCHICAL, ENTRANT_LOOSE, ENTRANT_PEER};
    static const char *const SCENES[] = {"flake", "crowd", "equal"};
    json_t *records = evaluation_array(evaluation, "counts");
    for (int s = 0; s < 3; s++) {
        bool meshes = strcmp(SCENES[s], "crowd") == 0;
        uint32_t most = meshes ? evaluation->effort.most_meshes : evaluation->effort.most;
        for (uint32_t count = 1000; count <= most; count *= 10) {
            struct round r = {.evaluation = evaluation, .animation = animation_create(SCENES[s], count)};
            run(&r, ALL, 4, records);
            animation_destroy(r.animation);
        }
    }
}
