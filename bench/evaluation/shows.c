/* SPDX-License-Identifier: MIT */
/*
 * shows.c: (c): animations that far outgrow their first box, shown frame by frame, by the clock on the wall, two
 * threads. A frame takes all bodies along their paths in one call, aims the camera, and traces its primary rays; the
 * next follows at once. The whole of it is timed, what a host has to do as well: a rebuild in the background gets no
 * time that is not counted. Beside it stands the processor time of all threads, a rebuild's among them: on a machine
 * that others use, that is what can be compared.
 *
 * Each show is given several times, in turn with the others, and the median time of each frame is reported: what the
 * library does comes again in the same frame, what the machine does seldom. Some frames' answers are put aside, and
 * judged when the show is over.
 */
#include "evaluation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORKERS = 2, MOST_RUNS = 5, JUDGED = 5 };

/* What is done when the scene has outgrown its grid. */
enum manner { REBUILD_IN_FRAME, REBUILD_NEVER, REBUILD_BESIDE, MANNERS };

static const char *const MANNER_NAMES[MANNERS] = {"rebuild in the frame", "never rebuilt", "rebuild in background"};

/* The paper's factor, and the library's default. */
static const double FACTOR = 2;

/* A frame in all runs. */
struct frame {
    double ms[MOST_RUNS], update_ms[MOST_RUNS], processor_ms[MOST_RUNS];
    bool rebuilding, rebuilt; /* in any run: one was under way or was made in it */
    uint64_t tiles;
};

struct show {
    struct evaluation *evaluation;
    struct animation *animation;
    rg_grid_kind kind;
    enum manner manner;
    int runs; /* that are over */
    struct frame *frames;
    struct bench_rays *cube, *rays;
    struct bench_answers answers, aside[JUDGED]; /* aside: of the last run */
    json_t *judged;
};

static double time_of(const struct show *show, int frame) {
    return (double)frame / (show->evaluation->effort.frames - 1);
}

static int judged_frame(const struct show *show, int which) {
    return which * (show->evaluation->effort.frames - 1) / (JUDGED - 1);
}

static struct own *create_own(const struct show *show) {
    const rg_grid_config grid = {.size = sizeof grid,
                                 .kind = show->kind,
                                 .rebuild_factor = show->manner == REBUILD_BESIDE ? FACTOR : RG_REBUILD_NEVER};
    struct own *own = own_create_empty(show->animation->bodies, WORKERS, &grid);
    own_fill(own);
    return own;
}

static double diagonal(const double lo[3], const double hi[3]) {
    return sqrt(pow(hi[0] - lo[0], 2) + pow(hi[1] - lo[1], 2) + pow(hi[2] - lo[2], 2));
}

static bool outgrown(const rg_grid_report *report) {
    return diagonal(report->logical_lo, report->logical_hi) >
           FACTOR * diagonal(report->physical_lo, report->physical_hi);
}

static void update(struct show *show, struct own *own) {
    own_move_many(own, own->objects, show->animation->bodies->positions, show->animation->moving);
    if (show->manner != REBUILD_IN_FRAME) return;
    rg_grid_report report = own_grid_report(own);
    if (outgrown(&report)) own_check(rg_grid_rebuild(own->scene, RG_GRID_OF_SCENE));
}

static void play_frame(struct show *show, struct own *own, int number) {
    struct frame *frame = &show->frames[number];
    rg_grid_report before = own_grid_report(own);
    double start = bench_wall_seconds(), used = bench_process_seconds();
    animation_go(show->animation, time_of(show, number));
    animation_look(show->animation, time_of(show, number), show->cube, show->rays);
    double ready = bench_wall_seconds();
    update(show, own);
    double updated = bench_wall_seconds();
    own_trace(own, show->rays, UINT32_MAX, &show->answers);
    frame->ms[show->runs] = 1e3 * (bench_wall_seconds() - start);
    frame->processor_ms[show->runs] = 1e3 * (bench_process_seconds() - used);
    frame->update_ms[show->runs] = 1e3 * (updated - ready);
    rg_grid_report after = own_grid_report(own);
    frame->rebuilding |= before.rebuilding || after.rebuilding;
    frame->rebuilt |= after.rebuilds > before.rebuilds;
    frame->tiles = after.tiles;
}

static void put_aside(struct show *show, int number) {
    uint32_t count = show->rays->count;
    for (int i = 0; i < JUDGED; i++) {
        if (judged_frame(show, i) != number) continue;
        memcpy(show->aside[i].t, show->answers.t, count * sizeof *show->answers.t);
        memcpy(show->aside[i].id, show->answers.id, count * sizeof *show->answers.id);
    }
}

/* The sums of checked and wrong answers of the frames that were put aside. */
static void judge(struct show *show, const struct own *own) {
    json_int_t checked = 0, wrong = 0;
    for (int i = 0; i < JUDGED; i++) {
        double time = time_of(show, judged_frame(show, i));
        animation_go(show->animation, time);
        animation_look(show->animation, time, show->cube, show->rays);
        json_t *verdict = evaluation_check_own(show->evaluation, own, show->rays, &show->aside[i], 1.0 / JUDGED);
        checked += json_integer_value(json_object_get(verdict, "checked"));
        wrong += json_integer_value(json_object_get(verdict, "wrong"));
        json_decref(verdict);
    }
    show->judged = json_pack("{s:I, s:I}", "checked", checked, "wrong", wrong);
}

/* One run; the last is judged. */
static void play(struct show *show) {
    animation_go(show->animation, 0);
    struct own *own = create_own(show);
    for (int i = 0; i < show->evaluation->effort.frames; i++) {
        play_frame(show, own, i);
        put_aside(show, i);
    }
    bool last = show->manner == REBUILD_NEVER || show->runs + 1 == show->evaluation->effort.runs;
    show->runs++;
    if (last) judge(show, own);
    own_destroy(own);
}

static struct show *show_create(struct evaluation *evaluation, struct animation *animation, rg_grid_kind kind,
                                enum manner manner) {
    struct show *show = bench_allocate(1, sizeof *show);
    show->evaluation = evaluation;
    show->animation = animation;
    show->kind = kind;
    show->manner = manner;
    show->frames = bench_allocate((size_t)evaluation->effort.frames, sizeof *show->frames);
    show->cube = bench_primary_rays(animation->bodies, evaluation->effort.side, false);
    show->rays = bench_primary_rays(animation->bodies, evaluation->effort.side, false);
    show->answers = bench_answers_create(show->rays->count);
    for (int i = 0; i < JUDGED; i++) show->aside[i] = bench_answers_create(show->rays->count);
    return show;
}

static void show_destroy(struct show *show) {
    free(show->frames);
    bench_rays_destroy(show->cube);
    bench_rays_destroy(show->rays);
    bench_answers_destroy(&show->answers);
    for (int i = 0; i < JUDGED; i++) bench_answers_destroy(&show->aside[i]);
    free(show);
}

static void report(const struct show *show, json_t *records) {
    json_t *ms = json_array(), *updates = json_array(), *processor = json_array(), *rebuilding = json_array(),
           *rebuilt = json_array(), *tiles = json_array();
    for (int i = 0; i < show->evaluation->effort.frames; i++) {
        struct frame *frame = &show->frames[i];
        json_array_append_new(ms, json_real(bench_median(frame->ms, show->runs)));
        json_array_append_new(updates, json_real(bench_median(frame->update_ms, show->runs)));
        json_array_append_new(processor, json_real(bench_median(frame->processor_ms, show->runs)));
        json_array_append_new(rebuilding, json_boolean(frame->rebuilding));
        json_array_append_new(rebuilt, json_boolean(frame->rebuilt));
        json_array_append_new(tiles, json_integer((json_int_t)frame->tiles));
    }
    const struct bench_scene *bodies = show->animation->bodies;
    json_array_append_new(records, json_pack("{s:s, s:I, s:s, s:s, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
                                             "scene", bodies->name, "objects", (json_int_t)bodies->count, "kind",
                                             own_kind_name(show->kind), "manner", MANNER_NAMES[show->manner],
                                             "threads", WORKERS, "runs", show->runs, "ms", ms, "update ms", updates,
                                             "processor ms", processor, "rebuilding", rebuilding, "rebuilt", rebuilt,
                                             "tiles", tiles, "judged", show->judged));
}

/* All shows of one scene, in turn. */
static void play_all(struct evaluation *evaluation, const char *scene, uint32_t count, rg_grid_kind kind) {
    enum { SHOWS = MANNERS + 1 };
    json_t *records = evaluation_array(evaluation, "shows");
    struct animation *animation = animation_create(scene, count);
    struct show *shows[SHOWS];
    for (int i = 0; i < MANNERS; i++) shows[i] = show_create(evaluation, animation, kind, (enum manner)i);
    shows[MANNERS] = show_create(evaluation, animation, RG_GRID_LOOSE, REBUILD_BESIDE);
    for (int run = 0; run < evaluation->effort.runs; run++) {
        for (int i = 0; i < SHOWS; i++) {
            /* It takes long, and is not about single frames. */
            if (shows[i]->manner == REBUILD_NEVER && run > 0) continue;
            double start = bench_wall_seconds();
            play(shows[i]);
            fprintf(stderr, "%s, %s, %s: %.1f s\n", scene, own_kind_name(shows[i]->kind),
                    MANNER_NAMES[shows[i]->manner], bench_wall_seconds() - start);
        }
    }
    for (int i = 0; i < SHOWS; i++) {
        report(shows[i], records);
        show_destroy(shows[i]);
    }
    animation_destroy(animation);
}

void evaluate_shows(struct evaluation *evaluation) {
    const struct evaluation_effort *effort = &evaluation->effort;
    play_all(evaluation, "flake", effort->shown_flake, RG_GRID_HIERARCHICAL);
    play_all(evaluation, "crowd", effort->shown_crowd, RG_GRID_HIERARCHICAL);
    play_all(evaluation, "escape", effort->shown_escape, RG_GRID_UNIFORM);
}
