/* SPDX-License-Identifier: MIT */
/* builds.c: what it takes to have a scene: time and memory an object. */
#include "bench.h"

#include <stdlib.h>

struct builds {
    struct bench_scene *bodies;
    struct peer *peer;
    uint32_t *all; /* the numbers of all bodies */
};

/* All bodies in one call, into an empty scene. */
static double turn_of_own(void *context) {
    struct builds *builds = context;
    struct own *own = own_create(builds->bodies, 1);
    double seconds = own->filling;
    own_destroy(own);
    return seconds;
}

/* The tree is made anew. */
static double turn_of_peer(void *context) {
    struct builds *builds = context;
    return peer_move(builds->peer, builds->all, builds->bodies->positions, builds->bodies->count, 0);
}

void bench_builds(struct bench_run *run, const char *scene, uint32_t count) {
    struct builds builds = {bench_scene_of(run, scene, count), NULL, NULL};
    if (!builds.bodies) return;
    const struct peer_choice *choice = &run->options.peer;
    bool spheres = bench_all_spheres(builds.bodies);
    count = builds.bodies->count;
    builds.all = bench_allocate(count, sizeof *builds.all);
    for (uint32_t i = 0; i < count; i++) builds.all[i] = i;
    struct bench_line line = bench_line("builds", scene, count, "insert all at once");
    if (choice->api) {
        builds.peer = peer_create(choice, builds.bodies, PEER_MEDIUM);
        line.peer_way = PEER_BUILD_NAMES[PEER_MEDIUM];
        line.peer_bytes = peer_bytes_per_object(builds.peer);
    }
    struct bench_duel duel =
        bench_duel((struct bench_side){turn_of_own, &builds},
                   (struct bench_side){builds.peer ? turn_of_peer : NULL, &builds}, run->options.effort.turns);
    struct own *own = own_create(builds.bodies, 1);
    line.unit = "ns";
    line.figure = 1e9 * duel.own / count;
    line.peer_figure = 1e9 * duel.peer / count;
    line.ratio = duel.ratio;
    line.bytes = own_bytes_per_object(own);
    bench_report_line(&run->report, &line);
    struct bench_line memory = bench_line("builds", scene, count, "memory an object");
    memory.unit = "bytes";
    memory.figure = memory.bytes = line.bytes;
    memory.peer_figure = memory.peer_bytes = line.peer_bytes;
    memory.ratio = line.peer_bytes / line.bytes;
    memory.peer_way = line.peer_way;
    memory.goal = spheres ? bench_goal(GOAL_BYTES, count) : bench_no_goal();
    bench_report_line(&run->report, &memory);
    own_destroy(own);
    peer_destroy(builds.peer);
    free(builds.all);
    bench_scene_destroy(builds.bodies);
}
