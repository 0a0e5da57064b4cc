/* SPDX-License-Identifier: MIT */
/*
 * omissions.c: what it is worth that raygrid leaves out what a scene or a call does not need. The same rays into the
 * same bodies, once as they are ("figure") and once with one thing more that has to be considered ("peer"); the ratio
 * is what doing without it gains. A line is judged twice: the figures of the bare scene as all others, those of the
 * other one by whether it gives the same answers, rays that meet the thing itself excepted.
 */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST = 10000, FEW = 64 }; /* bodies, if no sizes are asked for; rays of a small call */

/* A scene, and how it is traced. */
struct manner {
    struct own *own;
    rg_object added;        /* what the bodies of the scene do not have; RG_NO_OBJECT: nothing */
    rg_trace_config config; /* as the library has it, unless a filter is set */
    rg_hit_views hits;      /* wanted besides t and object */
    uint32_t a_call;
    struct bench_answers answers;
};

struct trial {
    const struct bench_rays *rays;
    struct manner without, with;
    rg_output columns; /* room for what hits may be wanted of: ROOM floats a ray, one array each */
    bool wall;         /* threads: the clock on the wall counts */
    int passes;
};

enum { ROOM = 10 };

/* ------------------------------------------------------------------------------------- what is considered */

static rg_object add(struct own *own, rg_shape *shape, const rg_pose *pose) {
    rg_object object;
    own_check(rg_scene_insert(own->scene, shape, pose, &object));
    rg_shape_release(&shape);
    return object;
}

static rg_shape *box(const double lo[3], const double hi[3]) {
    rg_shape *shape;
    own_check(rg_shape_create_box(NULL, lo, hi, &shape));
    return shape;
}

static void nothing(struct trial *trial) {
    (void)trial;
}

/* Every ray sees the body nevertheless: rays have all bits set. */
static void mask(struct trial *trial) {
    own_check(rg_scene_set_mask(trial->with.own->scene, trial->with.own->objects[0], 1));
}

static void unbounded(struct trial *trial) {
    const double lo[3] = {-INFINITY, -1, -INFINITY}, hi[3] = {INFINITY, -0.5, INFINITY};
    trial->with.added = add(trial->with.own, box(lo, hi), NULL);
}

static void far_box(struct trial *trial) {
    const double lo[3] = {-0.01, -0.01, -0.01}, hi[3] = {0.01, 0.01, 0.01};
    rg_pose pose = rg_pose_at(4, 0.5, 0.5);
    trial->with.added = add(trial->with.own, box(lo, hi), &pose);
}

static rg_shape *small_ball(void) {
    rg_shape *ball;
    own_check(rg_shape_create_sphere(NULL, 0.01, &ball));
    return ball;
}

static void second_grid(struct trial *trial) {
    rg_scene *scene = trial->with.own->scene;
    rg_shape *ball = small_ball();
    rg_pose pose = rg_pose_at(4, 0.5, 0.5);
    rg_pose_views poses;
    rg_insert_views views = {.size = sizeof views, .shapes = &ball, .poses = &poses};
    own_check(rg_pose_views_of(&poses, sizeof poses, &pose, 0));
    own_check(rg_grid_create(scene, NULL, &views.grid));
    own_check(rg_scene_insert_many(scene, &views, 1, &(rg_output){&trial->with.added, 0, RG_U64}));
    rg_shape_release(&ball);
}

static void make_hierarchical(struct own *own) {
    rg_grid_config config;
    own_check(rg_grid_config_default(&config, sizeof config));
    config.kind = RG_GRID_HIERARCHICAL;
    config.rebuild_factor = RG_REBUILD_NEVER;
    own_check(rg_grid_configure(own->scene, RG_GRID_OF_SCENE, &config));
}

/* Behind the box, seen from the camera; it is not rebuilt around it. */
static void outside_box(struct trial *trial) {
    rg_pose pose = rg_pose_at(0.5, 0.5, 1.2);
    make_hierarchical(trial->without.own);
    make_hierarchical(trial->with.own);
    trial->with.added = add(trial->with.own, small_ball(), &pose);
}

static rg_output column(const struct trial *trial, int which) {
    return (rg_output){(float *)trial->columns.data + (size_t)which * trial->rays->count, sizeof(float), RG_F32};
}

static rg_output3 columns(const struct trial *trial, int first) {
    return (rg_output3){column(trial, first).data, column(trial, first + 1).data, column(trial, first + 2).data,
                        sizeof(float), RG_F32};
}

static void outputs(struct trial *trial) {
    rg_hit_views *hits = &trial->with.hits;
    hits->normal = columns(trial, 0);
    hits->position = columns(trial, 3);
    hits->u = column(trial, 6);
    hits->v = column(trial, 7);
    hits->offset = column(trial, 8);
    hits->primitive = column(trial, 9);
    hits->primitive.type = RG_U32;
}

static void counts(struct trial *trial) {
    rg_hit_views *hits = &trial->with.hits;
    hits->cells = column(trial, 0);
    hits->tests = column(trial, 1);
    hits->cells.type = hits->tests.type = RG_U32;
}

static int32_t accept(void *user, uint64_t index, const rg_hit *candidate) {
    (void)user, (void)index, (void)candidate;
    return 1;
}

static void filter(struct trial *trial) {
    trial->with.config.filter = accept;
}

static void worker(struct trial *trial) {
    const struct bench_scene *bodies = trial->with.own->bodies;
    own_destroy(trial->with.own);
    trial->with.own = own_create(bodies, 2);
    trial->with.a_call = trial->without.a_call = FEW;
    trial->wall = true;
}

static const struct omission {
    const char *name, *with; /* of the figure; how the other scene or call is */
    void (*prepare)(struct trial *trial);
} OMISSIONS[] = {
    {"as it is", "the same again: what the measurement is worth", nothing},
    {"no masks", "one object has a mask that hides it from no ray", mask},
    {"all in cells", "an infinite box below", unbounded},
    {"spheres only", "a small box far aside", far_box},
    {"one grid", "a second one with a sphere far aside", second_grid},
    {"t and object", "every field of the hits is wanted", outputs},
    {"no counts", "cells and tests are wanted", counts},
    {"no filter", "one that accepts all", filter},
    {"1 worker, 64 rays a call", "2 workers", worker},
    {"hierarchical, no tiles", "a sphere outside of the physical box", outside_box},
};

/* ----------------------------------------------------------------------------------------------- measured */

static void trace(struct manner *manner, const struct bench_rays *rays) {
    rg_ray_views views = own_ray_views(rays);
    if (manner->a_call < rays->count) {
        own_trace(manner->own, rays, manner->a_call, &manner->answers);
        return;
    }
    own_check(rg_scene_trace_views(manner->own->scene, &manner->config, &views, &manner->hits, rays->count));
}

static double turn(struct trial *trial, struct manner *manner) {
    double before = trial->wall ? bench_wall_seconds() : bench_thread_seconds();
    for (int i = 0; i < trial->passes; i++) trace(manner, trial->rays);
    return ((trial->wall ? bench_wall_seconds() : bench_thread_seconds()) - before) / trial->passes;
}

static double turn_without(void *context) {
    return turn(context, &((struct trial *)context)->without);
}

static double turn_with(void *context) {
    return turn(context, &((struct trial *)context)->with);
}

/* Rays to which the two give different answers, but for those that meet what was added. */
static int differing(const struct trial *trial) {
    const struct bench_answers *a = &trial->without.answers, *b = &trial->with.answers;
    int different = 0;
    for (uint32_t i = 0; i < trial->rays->count; i++) {
        bool added = trial->with.added != RG_NO_OBJECT && b->id[i] == trial->with.added && b->t[i] <= a->t[i];
        different += !added && (a->id[i] != b->id[i] || a->t[i] != b->t[i]);
    }
    return different;
}

static void manner_init(struct manner *manner, const struct bench_scene *bodies, uint32_t rays) {
    manner->own = own_create(bodies, 1);
    own_check(rg_trace_config_default(&manner->config, sizeof manner->config));
    manner->a_call = UINT32_MAX;
    manner->answers = bench_answers_create(rays);
    manner->hits.size = sizeof manner->hits;
    manner->hits.t = (rg_output){manner->answers.t, sizeof(float), RG_F32};
    manner->hits.object = (rg_output){manner->answers.id, sizeof(uint64_t), RG_U64};
}

static void manner_end(struct manner *manner) {
    own_destroy(manner->own);
    bench_answers_destroy(&manner->answers);
}

static void measure(struct bench_run *run, struct trial *trial, const struct omission *omission,
                    struct exact_sample *sample) {
    const struct bench_effort *effort = &run->options.effort;
    const struct bench_scene *bodies = trial->without.own->bodies;
    const double rays = trial->rays->count;
    char what[80];
    snprintf(what, sizeof what, "%s/%s", trial->rays->name, omission->name);
    struct bench_line line = bench_line("omissions", bodies->name, bodies->count, what);
    trial->passes = 1;
    trial->passes = (int)fmin(fmax(ceil(effort->turn_seconds / (turn_without(trial) + 1e-9)), 1), 1000);
    struct bench_duel duel =
        bench_duel((struct bench_side){turn_without, trial}, (struct bench_side){turn_with, trial}, effort->turns);
    struct exact_error same = {.checked = (int)trial->rays->count, .wrong = differing(trial)};
    struct exact_error error = bench_judge_own(run, sample, trial->without.own, &trial->without.answers);
    line.unit = "Mrays/s";
    line.figure = 1e-6 * rays / duel.own;
    line.peer_figure = 1e-6 * rays / duel.peer;
    line.ratio = duel.ratio;
    line.peer_way = omission->with;
    line.error = &error;
    line.peer_error = &same;
    line.bytes = own_bytes_per_object(trial->without.own);
    line.peer_bytes = own_bytes_per_object(trial->with.own);
    bench_report_line(&run->report, &line);
}

static void measure_rays(struct bench_run *run, const struct bench_scene *bodies, struct exact *exact,
                         struct bench_rays *rays) {
    struct exact_sample *sample = exact_sample_create(exact, rays, run->options.effort.checks / 4);
    for (size_t i = 0; i < sizeof OMISSIONS / sizeof *OMISSIONS; i++) {
        struct trial trial = {.rays = rays};
        trial.columns.data = bench_allocate((size_t)ROOM * rays->count, sizeof(float));
        manner_init(&trial.without, bodies, rays->count);
        manner_init(&trial.with, bodies, rays->count);
        OMISSIONS[i].prepare(&trial);
        measure(run, &trial, &OMISSIONS[i], sample);
        manner_end(&trial.without);
        manner_end(&trial.with);
        free(trial.columns.data);
    }
    exact_sample_destroy(sample);
    bench_rays_destroy(rays);
}

void bench_omissions(struct bench_run *run, const char *scene, uint32_t count) {
    const struct bench_effort *effort = &run->options.effort;
    if (strcmp(scene, "uniform") != 0 || (!run->options.sizes && count > LARGEST)) return;
    struct bench_scene *bodies = bench_scene_of(run, scene, count);
    if (!bodies) return;
    struct exact *exact = exact_create(bodies, NULL);
    measure_rays(run, bodies, exact, bench_primary_rays(bodies, effort->side, false));
    measure_rays(run, bodies, exact, bench_random_rays(bodies, effort->incoherent, false, false));
    exact_destroy(exact);
    bench_scene_destroy(bodies);
}
