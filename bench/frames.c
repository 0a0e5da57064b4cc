/* SPDX-License-Identifier: MIT */
/*
 * frames.c: what a moving scene costs a frame: bodies are moved by their radius in one call, or a scene's one mesh
 * gets new vertices; then a picture and its shadows are traced, each in the side's best way. All that was left to
 * decay has decayed over many frames before.
 */
#include "bench.h"
#include "mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct film {
    struct bench_run *run;
    struct bench_scene *bodies;
    struct own *own;
    struct peer *peer;
    struct bench_rays *primary, *shadows;
    struct bench_answers own_answers, peer_answers;
    struct peer_way primary_way, shadow_way;
    uint32_t *order; /* all bodies in random order, of which each frame moves the next few */
    uint32_t next, moved;
    rg_object *objects; /* of those that move now */
    uint32_t *which;
    double (*targets)[3];
    struct bench_bend bend; /* of the one mesh, where that is all: then no body moves */
};

/* What is to be seen next. */
static void choose(struct film *film) {
    struct bench_scene *bodies = film->bodies;
    if (film->bend.mesh) bench_bend_next(&film->bend);
    for (uint32_t i = 0; i < film->moved; i++) {
        uint32_t body = film->order[film->next];
        film->next = (film->next + 1) % bodies->count;
        film->which[i] = body;
        film->objects[i] = film->own->objects[body];
        bench_step(bodies, body, 1, film->targets[i]);
        memcpy(bodies->positions[body], film->targets[i], sizeof *bodies->positions);
    }
}

/* Few rays are asked of a form before the next: should its tree be made anew, then in a hurry. */
static double change_own(struct film *film) {
    if (film->bend.mesh) return own_deform(film->own, 0, RG_MESH_FAST);
    double start = bench_thread_seconds();
    own_move_many(film->own, film->objects, film->targets, film->moved);
    return bench_thread_seconds() - start;
}

/* Where the shadow rays start is the host's to work out, the same for both sides, and is not counted. */
static double turn_of_own(void *context) {
    struct film *film = context;
    choose(film);
    double seconds = change_own(film);
    double start = bench_thread_seconds();
    own_trace(film->own, film->primary, UINT32_MAX, &film->own_answers);
    seconds += bench_thread_seconds() - start;
    bench_refill_shadow_rays(film->shadows, film->primary, film->own_answers.t);
    start = bench_thread_seconds();
    own_trace(film->own, film->shadows, UINT32_MAX, &film->own_answers);
    return seconds + bench_thread_seconds() - start;
}

/* Moves what raygrid has just moved; the vertices of one mesh are read where they are. */
static double turn_of_peer(void *context) {
    struct film *film = context;
    double seconds = peer_move(film->peer, film->which, film->targets, film->moved, 0);
    double start = bench_thread_seconds();
    peer_trace(film->peer, film->primary, film->primary_way, &film->peer_answers);
    seconds += bench_thread_seconds() - start;
    bench_refill_shadow_rays(film->shadows, film->primary, film->peer_answers.t);
    start = bench_thread_seconds();
    peer_trace(film->peer, film->shadows, film->shadow_way, &film->peer_answers);
    return seconds + bench_thread_seconds() - start;
}

static void find_ways(struct film *film) {
    film->primary_way = peer_best_way(film->peer, film->primary, false, &film->peer_answers, NULL);
    peer_trace(film->peer, film->primary, film->primary_way, &film->peer_answers);
    bench_refill_shadow_rays(film->shadows, film->primary, film->peer_answers.t);
    film->shadow_way = peer_best_way(film->peer, film->shadows, false, &film->peer_answers, NULL);
}

/* What changes goes through the frames that are not measured; with a peer that keeps its tree, the peer too. */
static void let_decay(struct film *film, struct peer *refitted) {
    for (int i = 0; i < film->run->options.effort.frames; i++) {
        choose(film);
        change_own(film);
        if (refitted) peer_move(refitted, film->which, film->targets, film->moved, 0);
    }
}

/* Leaves the peer whose frame is the shortest. A tree built anew each frame needs no frames before. */
static void choose_peer(struct film *film, struct peer *refitted) {
    static const enum peer_build BUILDS[] = {PEER_LOW,  PEER_MEDIUM,   PEER_ARRAY,     PEER_REFIT,
                                             PEER_USER, PEER_USER_LOW, PEER_USER_REFIT};
    const struct peer_choice *choice = &film->run->options.peer;
    struct peer *best = NULL;
    double least = INFINITY;
    for (size_t b = 0; b < sizeof BUILDS / sizeof *BUILDS; b++) {
        if (!peer_can(choice, film->bodies, BUILDS[b])) continue;
        bool is_refitted = refitted && BUILDS[b] == peer_build_of(refitted);
        film->peer = is_refitted ? refitted : peer_create(choice, film->bodies, BUILDS[b]);
        find_ways(film);
        double seconds = turn_of_peer(film);
        if (seconds < least) {
            least = seconds;
            peer_destroy(best);
            best = film->peer;
        } else {
            peer_destroy(film->peer);
        }
    }
    film->peer = best;
    find_ways(film);
}

/* The pictures that were traced last, against where the bodies are. */
static void report(struct film *film, const char *what, const struct bench_duel *duel) {
    struct bench_run *run = film->run;
    struct bench_line line = bench_line("frames", film->bodies->name, film->bodies->size, what);
    struct exact *exact = exact_create(film->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, film->primary, run->options.effort.checks / 4);
    struct exact_error error = bench_judge_own(run, sample, film->own, &film->own_answers), peer_error = {0};
    char way[64];
    if (film->peer) {
        peer_error = verdict_of_peer(sample, film->peer, &film->peer_answers);
        snprintf(way, sizeof way, "%s, %s", PEER_BUILD_NAMES[peer_build_of(film->peer)],
                 peer_way_name(film->primary_way));
        line.peer_error = &peer_error;
        line.peer_way = way;
        line.peer_bytes = peer_bytes_per_object(film->peer);
    }
    line.unit = "ms";
    line.figure = 1e3 * duel->own;
    line.peer_figure = 1e3 * duel->peer;
    line.ratio = duel->ratio;
    line.goal = film->bend.mesh ? bench_no_goal() : bench_goal(GOAL_FRAME, film->bodies->count);
    line.error = &error;
    line.bytes = own_bytes_per_object(film->own);
    bench_report_line(&run->report, &line);
    exact_sample_destroy(sample);
    exact_destroy(exact);
}

static void measure(struct film *film, double share) {
    const struct peer_choice *choice = &film->run->options.peer;
    char what[64] = "new vertices";
    if (bench_is_one_mesh(film->bodies)) {
        film->bend = bench_bend_create(film->bodies->shapes[0].mesh);
    } else {
        snprintf(what, sizeof what, "%g %% moved", 100 * share);
        film->moved = (uint32_t)fmax(share * film->bodies->count, 1);
    }
    film->own = own_create(film->bodies, 1);
    struct peer *refitted = NULL;
    enum peer_build refit = bench_all_spheres(film->bodies) ? PEER_USER_REFIT : PEER_REFIT;
    if (choice->api && peer_can(choice, film->bodies, refit)) refitted = peer_create(choice, film->bodies, refit);
    let_decay(film, refitted);
    if (choice->api) choose_peer(film, refitted);
    struct bench_duel duel =
        bench_duel((struct bench_side){turn_of_own, film},
                   (struct bench_side){film->peer ? turn_of_peer : NULL, film}, film->run->options.effort.turns);
    report(film, what, &duel);
    peer_destroy(film->peer);
    film->peer = NULL;
    own_destroy(film->own);
    bench_bend_destroy(&film->bend);
}

/* How many shares of the bodies move in turn. */
static int shares_of(const struct bench_run *run, const struct bench_scene *bodies) {
    /* Of the largest scenes only the first two shares, for the time that all those frames take. */
    bool large = bodies->count >= 1000000 || (bodies->count >= 100000 && strcmp(bodies->name, "meshes") == 0);
    if (bench_is_one_mesh(bodies)) return 1;
    return large && run->options.effort.shares > 2 ? 2 : run->options.effort.shares;
}

void bench_frames(struct bench_run *run, const char *scene, uint32_t count) {
    static const double SHARES[] = {1, 0.01, 0.1, 0.001};
    for (int i = 0, shares = 1; i < shares; i++) {
        struct bench_scene *bodies = bench_scene_of(run, scene, count);
        if (!bodies) return;
        shares = shares_of(run, bodies);
        struct film film = {.run = run, .bodies = bodies};
        film.primary = bench_primary_rays(bodies, run->options.effort.side, false);
        film.own_answers = bench_answers_create(film.primary->count);
        film.peer_answers = bench_answers_create(film.primary->count);
        film.shadows = bench_shadow_rays(film.primary, film.own_answers.t);
        film.order = bench_choose(bodies, bodies->count);
        film.objects = bench_allocate(bodies->count, sizeof *film.objects);
        film.which = bench_allocate(bodies->count, sizeof *film.which);
        film.targets = bench_allocate(bodies->count, sizeof *film.targets);
        measure(&film, SHARES[i]);
        bench_rays_destroy(film.primary);
        bench_rays_destroy(film.shadows);
        bench_answers_destroy(&film.own_answers);
        bench_answers_destroy(&film.peer_answers);
        free(film.order);
        free(film.objects);
        free(film.which);
        free(film.targets);
        bench_scene_destroy(bodies);
    }
}
