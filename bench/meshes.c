/* SPDX-License-Identifier: MIT */
/*
 * meshes.c: what it takes to have one large mesh: building it, giving it new vertices, its memory. The peer reads the
 * vertices where the host has them; raygrid copies them, and that is counted.
 */
#include "bench.h"
#include "mesh.h"

struct smithy {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *own;
    struct peer *peer;
    struct bench_rays *rays;
    struct bench_answers answers;
    struct bench_bend bend;
    rg_mesh_quality quality;
};

static struct bench_mesh *mesh_of(const struct smithy *s) {
    return s->bodies->shapes[0].mesh;
}

/* Scenes are named by the size that was asked for; a sphere comes in powers of four. */
static double a_triangle(const struct smithy *s, double of_size) {
    return of_size * s->bodies->size / mesh_of(s)->triangle_count;
}

static double turn_of_own_build(void *context) {
    struct smithy *s = context;
    const rg_mesh_views views = own_mesh_views(mesh_of(s));
    const rg_shape_config config = own_mesh_config(s->quality);
    rg_shape *shape;
    double before = bench_thread_seconds();
    own_check(rg_shape_create_mesh(&config, &views, &shape));
    double seconds = bench_thread_seconds() - before;
    rg_shape_release(&shape);
    return seconds;
}

/* The tree is made anew. */
static double turn_of_peer_build(void *context) {
    struct smithy *s = context;
    return peer_move(s->peer, NULL, NULL, 0, 0);
}

static double turn_of_own_refit(void *context) {
    struct smithy *s = context;
    bench_bend_next(&s->bend);
    return own_deform(s->own, 0, s->quality);
}

/* Of the form that raygrid has just got, whose vertices it reads where they are. */
static double turn_of_peer_refit(void *context) {
    return turn_of_peer_build(context);
}

/* What rays see of the mesh as it is now. */
static void judge(struct smithy *s, struct bench_line *line, struct exact_error errors[2]) {
    struct exact *exact = exact_create(s->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, s->rays, s->run->options.effort.checks / 4);
    own_trace(s->own, s->rays, UINT32_MAX, &s->answers);
    errors[0] = bench_judge_own(s->run, sample, s->own, &s->answers);
    line->error = &errors[0];
    if (s->peer) {
        peer_trace(s->peer, s->rays, (struct peer_way){0, false}, &s->answers);
        errors[1] = verdict_of_peer(sample, s->peer, &s->answers);
        line->peer_error = &errors[1];
    }
    exact_sample_destroy(sample);
    exact_destroy(exact);
}

static void measure(struct smithy *s, const char *what, enum peer_build build, enum bench_aim aim, bool refit) {
    const struct peer_choice *choice = &s->run->options.peer;
    struct bench_line line = bench_line("meshes", s->bodies->name, s->bodies->size, what);
    struct exact_error errors[2] = {{0}};
    if (choice->api) {
        s->peer = peer_create(choice, s->bodies, build);
        line.peer_way = PEER_BUILD_NAMES[build];
        line.peer_bytes = a_triangle(s, peer_bytes_per_object(s->peer));
    }
    bench_turn *own = refit ? turn_of_own_refit : turn_of_own_build;
    bench_turn *peer = refit ? turn_of_peer_refit : turn_of_peer_build;
    struct bench_duel duel = bench_duel((struct bench_side){own, s}, (struct bench_side){s->peer ? peer : NULL, s},
                                        s->run->options.effort.turns);
    line.unit = "ns";
    line.figure = 1e9 * duel.own / mesh_of(s)->triangle_count;
    line.peer_figure = 1e9 * duel.peer / mesh_of(s)->triangle_count;
    line.ratio = duel.ratio;
    line.goal = build == PEER_HIGH ? bench_no_goal() : bench_goal(aim, s->bodies->size);
    line.bytes = a_triangle(s, own_bytes_per_object(s->own));
    if (refit) judge(s, &line, errors);
    bench_report_line(&s->run->report, &line);
    peer_destroy(s->peer);
    s->peer = NULL;
}

static void measure_memory(struct smithy *s) {
    const struct peer_choice *choice = &s->run->options.peer;
    bool soup = mesh_of(s)->vertex_count > mesh_of(s)->triangle_count;
    struct bench_line line = bench_line("meshes", s->bodies->name, s->bodies->size, "memory a triangle");
    line.unit = "bytes";
    line.figure = line.bytes = a_triangle(s, own_bytes_per_object(s->own));
    if (choice->api) {
        struct peer *peer = peer_create(choice, s->bodies, PEER_MEDIUM);
        line.peer_way = PEER_BUILD_NAMES[PEER_MEDIUM];
        line.peer_figure = line.peer_bytes = a_triangle(s, peer_bytes_per_object(peer));
        line.ratio = line.peer_bytes / line.bytes;
        peer_destroy(peer);
    }
    line.goal = bench_goal(soup ? GOAL_MESH_BYTES_SOUP : GOAL_MESH_BYTES, s->bodies->size);
    bench_report_line(&s->run->report, &line);
}

void bench_meshes(struct bench_run *run, const char *scene, uint32_t count) {
    struct smithy s = {.run = run, .bodies = bench_scene_of(run, scene, count)};
    if (!s.bodies) return;
    s.bend = bench_bend_create(mesh_of(&s));
    s.own = own_create(s.bodies, 1);
    s.rays = bench_random_rays(s.bodies, run->options.effort.incoherent, false, false);
    s.answers = bench_answers_create(s.rays->count);
    s.quality = RG_MESH_BEST;
    measure(&s, "build, best", PEER_MEDIUM, GOAL_MESH_BEST, false);
    measure(&s, "build, best, against its best", PEER_HIGH, GOAL_MESH_BEST, false);
    s.quality = RG_MESH_FAST;
    measure(&s, "build, fast", PEER_LOW, GOAL_MESH_FAST, false);
    measure(&s, "new vertices", PEER_REFIT, GOAL_MESH_REFIT, true);
    measure_memory(&s);
    bench_rays_destroy(s.rays);
    bench_answers_destroy(&s.answers);
    bench_bend_destroy(&s.bend);
    own_destroy(s.own);
    bench_scene_destroy(s.bodies);
}
