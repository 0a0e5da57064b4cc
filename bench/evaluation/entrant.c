/* SPDX-License-Identifier: MIT */
#include "entrant.h"

#include <math.h>
#include <stdlib.h>

const char *const ENTRANT_NAMES[ENTRANT_KINDS] = {
    "uniform", "uniform, tiles", "uniform, eight tiles", "hierarchical", "loose", "peer",
};

/* Below, left of and before all bodies: no ray of the camera or to the light comes there. */
static void insert_outside(struct own *own) {
    rg_grid_report report = own_grid_report(own);
    double side = 0, at[3];
    rg_shape *shape;
    for (int k = 0; k < 3; k++) side = fmax(side, report.physical_hi[k] - report.physical_lo[k]);
    for (int k = 0; k < 3; k++) at[k] = report.physical_lo[k] - 0.05 * side;
    rg_pose pose = rg_pose_at(at[0], at[1], at[2]);
    own_check(rg_shape_create_sphere(NULL, 0.005 * side, &shape));
    own_check(rg_scene_insert(own->scene, shape, &pose, NULL));
    rg_shape_release(&shape);
}

/* The box is halved, and with it the number of cells along it. */
static void halve_box(struct own *own, rg_grid_config grid) {
    rg_grid_report report = own_grid_report(own);
    grid.resolution /= 2;
    for (int k = 0; k < 3; k++) {
        grid.lo[k] = report.physical_lo[k];
        grid.hi[k] = 0.5 * (report.physical_lo[k] + report.physical_hi[k]);
    }
    own_check(rg_grid_configure(own->scene, RG_GRID_OF_SCENE, &grid));
}

static struct own *create_own(enum entrant_kind kind, const struct bench_scene *bodies, uint32_t resolution) {
    static const rg_grid_kind KINDS[] = {RG_GRID_UNIFORM, RG_GRID_UNIFORM, RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL,
                                         RG_GRID_LOOSE};
    const rg_grid_config grid = {
        .size = sizeof grid, .kind = KINDS[kind], .resolution = resolution, .rebuild_factor = RG_REBUILD_NEVER};
    struct own *own = own_create_empty(bodies, 1, &grid);
    own_fill(own);
    if (kind == ENTRANT_TILES) insert_outside(own);
    if (kind == ENTRANT_EIGHT_TILES) halve_box(own, grid);
    return own;
}

struct entrant *entrant_create(struct evaluation *evaluation, enum entrant_kind kind, struct animation *animation,
                               uint32_t resolution, uint32_t rays) {
    struct entrant *e = bench_allocate(1, sizeof *e);
    e->kind = kind;
    e->evaluation = evaluation;
    e->animation = animation;
    for (int which = 0; which < 2; which++) {
        e->answers[which] = bench_answers_create(rays);
        e->seconds[which] = INFINITY;
    }
    e->update = e->single = INFINITY;
    if (kind == ENTRANT_PEER) {
        e->peer = peer_create(&evaluation->peer, animation->bodies, PEER_MEDIUM);
    } else {
        e->own = create_own(kind, animation->bodies, resolution);
    }
    return e;
}

void entrant_destroy(struct entrant *entrant) {
    if (!entrant) return;
    own_destroy(entrant->own);
    peer_destroy(entrant->peer);
    for (int which = 0; which < 2; which++) bench_answers_destroy(&entrant->answers[which]);
    free(entrant);
}

double entrant_trace(struct entrant *e, const struct bench_rays *rays, int which) {
    if (e->peer && isinf(e->seconds[which])) {
        e->ways[which] = peer_best_way(e->peer, rays, false, &e->answers[which], NULL);
    }
    double before = bench_thread_seconds();
    if (e->own) {
        own_trace(e->own, rays, UINT32_MAX, &e->answers[which]);
    } else {
        peer_trace(e->peer, rays, e->ways[which], &e->answers[which]);
    }
    return bench_thread_seconds() - before;
}

static void move_own(struct entrant *e) {
    const struct bench_scene *bodies = e->animation->bodies;
    double before = bench_thread_seconds();
    for (uint32_t i = 0; i < bodies->count; i++) {
        own_check(rg_scene_move_to(e->own->scene, e->own->objects[i], bodies->positions[i]));
    }
    e->update = fmin(e->update, (bench_thread_seconds() - before) / bodies->count);
    e->single = e->update;
}

/* A peer that was built to be traced gives way to one that is built to be changed. */
static void move_peer(struct entrant *e) {
    struct bench_scene *bodies = e->animation->bodies;
    if (peer_build_of(e->peer) != PEER_LOW) {
        peer_destroy(e->peer);
        e->peer = peer_create(&e->evaluation->peer, bodies, PEER_LOW);
    }
    uint32_t *which = bench_allocate(bodies->count, sizeof *which);
    for (uint32_t i = 0; i < bodies->count; i++) which[i] = i;
    double all = peer_move(e->peer, which, bodies->positions, bodies->count, 0);
    double one = peer_move(e->peer, which, bodies->positions, 1, 0);
    e->update = fmin(e->update, all / bodies->count);
    e->single = fmin(e->single, one);
    free(which);
}

void entrant_move(struct entrant *entrant) {
    (entrant->own ? move_own : move_peer)(entrant);
}

json_t *entrant_judge(struct entrant *e, struct exact_sample *sample, int which) {
    if (e->own) return evaluation_judge_own(e->evaluation, sample, e->own, &e->answers[which]);
    return evaluation_judge_peer(sample, e->peer, &e->answers[which]);
}

void entrant_count(const struct entrant *entrant, const struct bench_rays *rays, double *cells, double *tests) {
    *cells = *tests = NAN;
    if (!entrant->own) return;
    uint32_t *counts = bench_allocate(2 * (size_t)rays->count, sizeof *counts);
    rg_ray_views views = own_ray_views(rays);
    rg_hit_views hits = {.size = sizeof hits};
    hits.cells = (rg_output){counts, sizeof *counts, RG_U32};
    hits.tests = (rg_output){counts + rays->count, sizeof *counts, RG_U32};
    own_check(rg_scene_trace_views(entrant->own->scene, NULL, &views, &hits, rays->count));
    double sums[2] = {0, 0};
    for (uint32_t i = 0; i < rays->count; i++) {
        sums[0] += counts[i];
        sums[1] += counts[rays->count + i];
    }
    *cells = sums[0] / rays->count;
    *tests = sums[1] / rays->count;
    free(counts);
}
