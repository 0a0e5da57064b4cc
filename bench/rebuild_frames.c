/* SPDX-License-Identifier: MIT */
/*
 * rebuild_frames.c: whether a rebuild is felt in frames: one per cent of the bodies is moved in one call, then a
 * picture is traced, by the clock on the wall; while the grid is rebuilt, and afterwards. And the memory that the
 * rebuild takes at its peak.
 */
#include "latency.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FRAMES = 256,
    /* of each kind, at most */ QUIET = 15,
    PARTS = 50 /* that the scene drifts in, one after another */
};

struct show {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *own;
    rg_grid_kind kind;
    uint32_t moved, next; /* a frame; the first of the next frame */
    double (*targets)[3];
    struct bench_rays *rays;
    struct bench_answers answers;
    double bytes, peak; /* before, and at most */
    double during[FRAMES], quiet[FRAMES];
    int during_count, quiet_count;
};

static void look_at_memory(struct show *show) {
    rg_scene_report report = {.size = sizeof report};
    own_check(rg_scene_stats(show->own->scene, &report));
    show->peak = fmax(show->peak, (double)report.bytes);
}

/* Those from `first` on are moved to where the bench has them. */
static void move_some(struct show *show, uint32_t first, uint32_t count) {
    memcpy(show->targets, show->bodies->positions[first], count * sizeof *show->targets);
    own_move_many(show->own, show->own->objects + first, show->targets, count);
}

/* Seconds of one. */
static double frame(struct show *show) {
    struct bench_scene *bodies = show->bodies;
    if (show->next + show->moved > bodies->count) show->next = 0;
    for (uint32_t i = show->next; i < show->next + show->moved; i++) {
        double to[3];
        bench_step_near_home(bodies, i, 1, to);
        memcpy(bodies->positions[i], to, sizeof to);
    }
    double before = bench_wall_seconds();
    move_some(show, show->next, show->moved);
    own_trace(show->own, show->rays, UINT32_MAX, &show->answers);
    double seconds = bench_wall_seconds() - before;
    show->next += show->moved;
    look_at_memory(show);
    return seconds;
}

/* Takes all bodies along, until the grid is being rebuilt and all have arrived. */
static void drift(struct show *show) {
    uint32_t part = show->bodies->count / PARTS;
    const double by[3] = {show->kind == RG_GRID_LOOSE ? BENCH_DRIFT : BENCH_SPREAD / 2, 0, 0};
    for (uint32_t first = 0; first < show->bodies->count; first += part) {
        uint32_t left = show->bodies->count - first, count = left < part ? left : part;
        for (uint32_t i = first; i < first + count; i++) bench_drift(show->bodies, i, show->kind);
        move_some(show, first, count);
        look_at_memory(show);
    }
    bench_shift_rays(show->rays, by);
}

static void film(struct show *show) {
    uint64_t before = own_grid_report(show->own).rebuilds;
    look_at_memory(show);
    show->bytes = show->peak;
    drift(show);
    for (int i = 0; i < FRAMES && show->during_count < FRAMES; i++) {
        bool began = own_grid_report(show->own).rebuilding;
        double seconds = frame(show);
        rg_grid_report after = own_grid_report(show->own);
        if (began && after.rebuilding) show->during[show->during_count++] = seconds;
        if (!after.rebuilding && after.rebuilds > before) break;
    }
    /* The old grid is given back before it is quiet. */
    for (int i = 0; i < QUIET / 3; i++) (void)frame(show);
    while (show->quiet_count < QUIET) show->quiet[show->quiet_count++] = frame(show);
}

static void report(struct show *show, const char *what) {
    struct bench_run *run = show->run;
    uint32_t count = show->bodies->count;
    char name[96];
    struct exact *exact = exact_create(show->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, show->rays, run->options.effort.checks / 20);
    struct exact_error error = bench_judge_own(run, sample, show->own, &show->answers);
    snprintf(name, sizeof name, "%s: a frame", what);
    struct bench_line line = bench_line("latency", show->bodies->name, count, name);
    line.unit = "ms";
    line.figure = 1e3 * bench_median(show->during, show->during_count);
    line.peer_figure = 1e3 * bench_median(show->quiet, show->quiet_count);
    line.ratio = line.peer_figure / line.figure;
    line.peer_way = "itself, quiet";
    line.bytes = own_bytes_per_object(show->own);
    line.goal = bench_goal(GOAL_REBUILD_FRAME, count);
    line.error = &error;
    if (show->during_count) bench_report_line(&run->report, &line);
    snprintf(name, sizeof name, "%s: memory at its peak", what);
    line = bench_line("latency", show->bodies->name, count, name);
    line.unit = "times";
    line.figure = show->peak / show->bytes;
    line.goal = bench_goal(GOAL_REBUILD_MEMORY, count);
    line.bytes = show->peak / count;
    line.error = &error;
    bench_report_line(&run->report, &line);
    exact_sample_destroy(sample);
    exact_destroy(exact);
}

void bench_rebuild_frames(struct bench_run *run, const char *scene, uint32_t count, rg_grid_kind kind,
                          uint32_t workers) {
    char what[64];
    struct bench_scene *bodies = bench_scene_of(run, scene, count);
    if (!bodies) return;
    struct show *show = bench_allocate(1, sizeof *show);
    show->run = run;
    show->bodies = bodies;
    show->kind = kind;
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    show->own = own_create_empty(bodies, workers, &grid);
    own_fill(show->own);
    show->moved = count / 100;
    show->targets = bench_allocate(count, sizeof *show->targets);
    show->rays = bench_primary_rays(bodies, run->options.effort.side, false);
    show->answers = bench_answers_create(show->rays->count);
    film(show);
    snprintf(what, sizeof what, "%s, %u worker%s, while it is rebuilt", own_kind_name(kind), workers,
             workers > 1 ? "s" : "");
    report(show, what);
    own_destroy(show->own);
    bench_rays_destroy(show->rays);
    bench_answers_destroy(&show->answers);
    free(show->targets);
    free(show);
    bench_scene_destroy(bodies);
}
