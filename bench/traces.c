/* SPDX-License-Identifier: MIT */
/* traces.c: rays into a scene that stands still. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How many rays a call has. */
struct mode {
    const char *name;
    uint32_t a_call;
};

static const struct mode MODES[] = {{"1", 1}, {"16", 16}, {"batch", UINT32_MAX}, {NULL, 0}};

enum { MOST_PEERS = 5 };

/* Both sides on one set of rays. */
struct contest {
    struct own *own;
    struct peer
        *peers[MOST_PEERS]; /* the same scene in each way in which the peer may have it; NULL from the end of */
    const struct bench_rays *rays;
    uint32_t a_call;
    struct peer *peer; /* NULL: there is none */
    struct peer_way way;
    struct bench_answers own_answers, peer_answers;
    int own_passes, peer_passes; /* a turn */
};

static double turn_of_own(void *context) {
    struct contest *contest = context;
    double before = bench_thread_seconds();
    for (int i = 0; i < contest->own_passes; i++) {
        own_trace(contest->own, contest->rays, contest->a_call, &contest->own_answers);
    }
    return (bench_thread_seconds() - before) / contest->own_passes;
}

static double turn_of_peer(void *context) {
    struct contest *contest = context;
    double before = bench_thread_seconds();
    for (int i = 0; i < contest->peer_passes; i++) {
        peer_trace(contest->peer, contest->rays, contest->way, &contest->peer_answers);
    }
    return (bench_thread_seconds() - before) / contest->peer_passes;
}

/* So many passes as a turn's least time takes. */
static int passes_for(bench_turn *turn, struct contest *contest, double turn_seconds) {
    return (int)fmin(fmax(ceil(turn_seconds / (turn(contest) + 1e-9)), 1), 1000);
}

static struct bench_duel fight(struct contest *contest, const struct bench_effort *effort) {
    contest->own_passes = contest->peer_passes = 1;
    contest->own_passes = passes_for(turn_of_own, contest, effort->turn_seconds);
    if (contest->peer) contest->peer_passes = passes_for(turn_of_peer, contest, effort->turn_seconds);
    return bench_duel((struct bench_side){turn_of_own, contest},
                      (struct bench_side){contest->peer ? turn_of_peer : NULL, contest}, effort->turns);
}

/* The peer and its way that serve these rays best. */
static void choose_peer(struct contest *contest, bool single) {
    double least = INFINITY;
    for (int p = 0; p < MOST_PEERS && contest->peers[p]; p++) {
        double seconds;
        struct peer_way way =
            peer_best_way(contest->peers[p], contest->rays, single, &contest->peer_answers, &seconds);
        if (seconds < least) {
            least = seconds;
            contest->peer = contest->peers[p];
            contest->way = way;
        }
    }
}

/* Goals of meshes are there for either mode of the peer. */
static struct bench_goal goal_of_mesh(const struct bench_rays *rays, const struct mode *mode, uint32_t triangles,
                                      bool robust) {
    bool batch = mode->a_call == UINT32_MAX, single = mode->a_call == 1;
    enum bench_aim aim = !rays->coherent ? GOAL_MESH_INCOHERENT : rays->any ? GOAL_MESH_SHADOW : GOAL_MESH_PRIMARY;
    if (single) aim = GOAL_MESH_SINGLE;
    return batch || single ? bench_goal(robust ? aim + 1 : aim, triangles) : bench_no_goal();
}

static struct bench_goal goal_of(const struct bench_rays *rays, const struct mode *mode,
                                 const struct bench_scene *bodies, bool robust) {
    bool batch = mode->a_call == UINT32_MAX, single = mode->a_call == 1;
    if (bench_is_one_mesh(bodies)) return goal_of_mesh(rays, mode, bodies->size, robust);
    if (batch && strcmp(bodies->name, "meshes") == 0)
        return bench_goal(rays->coherent ? GOAL_INSTANCES_COHERENT : GOAL_INSTANCES_INCOHERENT, bodies->count);
    if (!rays->coherent && batch) return bench_goal(GOAL_INCOHERENT, bodies->count);
    if (!rays->coherent && single) return bench_goal(GOAL_SINGLE, bodies->count);
    if (!batch || !bench_all_spheres(bodies)) return bench_no_goal();
    return bench_goal(bodies->has_aim ? GOAL_COHERENT_STADIUM : GOAL_COHERENT, bodies->count);
}

static void measure_mode(struct bench_run *run, struct contest *contest, const struct mode *mode,
                         struct exact_sample *sample) {
    const struct bench_scene *bodies = contest->own->bodies;
    const struct bench_rays *rays = contest->rays;
    char what[64];
    snprintf(what, sizeof what, "%s/%s", rays->name, mode->name);
    struct bench_line line = bench_line("traces", bodies->name, bodies->size, what);
    contest->a_call = mode->a_call;
    char way[64];
    choose_peer(contest, mode->a_call == 1);
    if (contest->peer) {
        snprintf(way, sizeof way, "%s, %s", PEER_BUILD_NAMES[peer_build_of(contest->peer)],
                 peer_way_name(contest->way));
        line.peer_way = way;
        line.peer_bytes = peer_bytes_per_object(contest->peer);
    }
    struct bench_duel duel = fight(contest, &run->options.effort);
    struct exact_error error = bench_judge_own(run, sample, contest->own, &contest->own_answers);
    struct exact_error peer_error = {0};
    if (contest->peer) {
        peer_error = verdict_of_peer(sample, contest->peer, &contest->peer_answers);
        line.peer_error = &peer_error;
    }
    line.unit = "Mrays/s";
    line.figure = 1e-6 * rays->count / duel.own;
    line.peer_figure = 1e-6 * rays->count / duel.peer;
    line.ratio = duel.ratio;
    line.goal = goal_of(rays, mode, bodies, run->options.peer.robust);
    line.error = &error;
    line.bytes = own_bytes_per_object(contest->own);
    bench_report_line(&run->report, &line);
}

static void measure_rays(struct bench_run *run, struct contest *contest, struct exact *exact,
                         struct bench_rays *rays) {
    if (rays->count > 0 && bench_wanted(run->options.rays, rays->name)) {
        struct exact_sample *sample = exact_sample_create(exact, rays, run->options.effort.checks);
        contest->rays = rays;
        for (const struct mode *mode = MODES; mode->name; mode++) {
            if (bench_wanted(run->options.modes, mode->name)) measure_mode(run, contest, mode, sample);
        }
        exact_sample_destroy(sample);
    }
    bench_rays_destroy(rays);
}

/* The shadow rays of a picture, from the places that raygrid finds. */
static struct bench_rays *shadows_of(struct contest *contest, const struct bench_rays *primary) {
    own_trace(contest->own, primary, UINT32_MAX, &contest->own_answers);
    return bench_shadow_rays(primary, contest->own_answers.t);
}

static bool as_mesh(const struct bench_options *options, enum peer_build build) {
    return bench_wanted(options->peer_mesh, PEER_BUILD_NAMES[build]);
}

/* Which ways of having the scene the peer may choose from. */
static void build_peers(struct contest *contest, const struct bench_options *options) {
    const struct bench_scene *bodies = contest->own->bodies;
    const bool points = strcmp(options->peer_spheres, "user") != 0,
               user = strcmp(options->peer_spheres, "points") != 0, one = bench_is_one_mesh(bodies);
    const struct {
        enum peer_build build;
        bool asked_for;
    } BUILDS[MOST_PEERS] = {
        {PEER_MEDIUM, one ? as_mesh(options, PEER_MEDIUM) : points || !bench_all_spheres(bodies)},
        {PEER_HIGH, one && as_mesh(options, PEER_HIGH)},
        {PEER_LOW, one && as_mesh(options, PEER_LOW)},
        {PEER_ARRAY, true},
        {PEER_USER, user},
    };
    int count = 0;
    for (int b = 0; options->peer.api && b < MOST_PEERS; b++) {
        if (!BUILDS[b].asked_for || !peer_can(&options->peer, bodies, BUILDS[b].build)) continue;
        contest->peers[count++] = peer_create(&options->peer, bodies, BUILDS[b].build);
    }
}

void bench_traces(struct bench_run *run, const char *scene, uint32_t count) {
    const struct bench_effort *effort = &run->options.effort;
    struct bench_scene *bodies = bench_scene_of(run, scene, count);
    if (!bodies) return;
    struct exact *exact = exact_create(bodies, NULL);
    struct contest contest = {.own = own_create(bodies, 1)};
    build_peers(&contest, &run->options);
    uint32_t pixels = (uint32_t)(effort->side * effort->side);
    uint32_t most = pixels > effort->incoherent ? pixels : effort->incoherent;
    contest.own_answers = bench_answers_create(most);
    contest.peer_answers = bench_answers_create(most);
    for (int aimed = 0; aimed <= bodies->has_aim; aimed++) {
        struct bench_rays *primary = bench_primary_rays(bodies, effort->side, aimed);
        struct bench_rays *shadows = shadows_of(&contest, primary);
        if (aimed) shadows->name = "aimed shadow";
        measure_rays(run, &contest, exact, primary);
        measure_rays(run, &contest, exact, shadows);
        measure_rays(run, &contest, exact, bench_random_rays(bodies, effort->incoherent, aimed, false));
        measure_rays(run, &contest, exact, bench_random_rays(bodies, effort->incoherent, aimed, true));
    }
    bench_answers_destroy(&contest.own_answers);
    bench_answers_destroy(&contest.peer_answers);
    for (int p = 0; p < MOST_PEERS; p++) peer_destroy(contest.peers[p]);
    own_destroy(contest.own);
    exact_destroy(exact);
    bench_scene_destroy(bodies);
}
