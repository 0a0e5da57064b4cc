/* SPDX-License-Identifier: MIT */
/*
 * sizes.c: (d): visitors of one size come to a scene of equal spheres and go again, one call each; from a fraction of
 * a cell to half of the scene. While they are there, a picture is held against brute force.
 */
#include "evaluation.h"
#include "vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    RESOLUTION = 64,
    SMALLEST = 512,      /* the smallest visitor's diameter: a 512th of the scene */
    MOST = 256,          /* visitors at once */
    CALLS = 4096,        /* of each kind in a turn, unless that takes too long */
    MOST_CELLS = 1 << 20 /* that a uniform grid lists all visitors in */
};

static const double ENOUGH = 0.05; /* seconds of a turn */

/* The same spheres, and visitors behind them in number. */
static struct bench_scene *create_bodies(uint32_t residents, uint32_t visitors, double radius) {
    struct bench_scene *bodies = bench_scene_create("uniform", residents + visitors);
    for (uint32_t i = residents; i < bodies->count; i++) {
        bodies->scales[i] = rounded(radius);
        for (int k = 0; k < 3; k++) {
            bodies->positions[i][k] = rounded(radius + (1 - 2 * radius) * bench_random(&bodies->random));
        }
    }
    return bodies;
}

static struct own *create_own(const struct bench_scene *bodies, rg_grid_kind kind) {
    const rg_grid_config grid = {
        .size = sizeof grid, .kind = kind, .resolution = RESOLUTION, .rebuild_factor = RG_REBUILD_NEVER};
    struct own *own = own_create_empty(bodies, 1, &grid);
    own_fill(own);
    return own;
}

static json_t *judge(struct evaluation *evaluation, struct own *own) {
    struct bench_rays *rays = bench_primary_rays(own->bodies, evaluation->effort.side, false);
    struct bench_answers answers = bench_answers_create(rays->count);
    own_trace(own, rays, UINT32_MAX, &answers);
    json_t *verdict = evaluation_check_own(evaluation, own, rays, &answers, 0.25);
    bench_answers_destroy(&answers);
    bench_rays_destroy(rays);
    return verdict;
}

/* All visitors go and come back, again and again; the least seconds of a call of each kind. */
static void come_and_go(struct own *own, uint32_t residents, int turns, double *insert, double *removal) {
    uint32_t count = own->bodies->count - residents;
    *insert = *removal = INFINITY;
    for (int turn = 0; turn < turns; turn++) {
        double removing = 0, inserting = 0;
        uint32_t calls = 0;
        for (; calls < CALLS && removing + inserting < ENOUGH; calls += count) {
            double start = bench_thread_seconds();
            for (uint32_t i = residents; i < own->bodies->count; i++) own_remove(own, i);
            double removed = bench_thread_seconds();
            for (uint32_t i = residents; i < own->bodies->count; i++) own_insert(own, i);
            inserting += bench_thread_seconds() - removed;
            removing += removed - start;
        }
        *insert = fmin(*insert, inserting / calls);
        *removal = fmin(*removal, removing / calls);
    }
}

static uint32_t visitors_of(double size) {
    double cells = pow(size * RESOLUTION + 1, 3);
    return (uint32_t)fmax(4, fmin(MOST, MOST_CELLS / cells));
}

void evaluate_sizes(struct evaluation *evaluation) {
    static const rg_grid_kind KINDS[] = {RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL, RG_GRID_LOOSE};
    json_t *records = evaluation_array(evaluation, "sizes");
    uint32_t residents = evaluation->effort.equal;
    for (int parts = SMALLEST; parts >= 2; parts /= 2) {
        double size = 1.0 / parts, insert, removal;
        struct bench_scene *bodies = create_bodies(residents, visitors_of(size), size / 2);
        for (int k = 0; k < 3; k++) {
            struct own *own = create_own(bodies, KINDS[k]);
            json_t *verdict = judge(evaluation, own);
            come_and_go(own, residents, evaluation->effort.turns, &insert, &removal);
            fprintf(stderr, "size 1/%d, %s: insert %.0f ns, remove %.0f ns\n", parts, own_kind_name(KINDS[k]),
                    1e9 * insert, 1e9 * removal);
            json_array_append_new(records, json_pack("{s:s, s:i, s:s, s:I, s:f, s:f, s:f, s:o}", "scene", "equal",
                                                     "objects", (int)residents, "kind", own_kind_name(KINDS[k]),
                                                     "resolution", (json_int_t)RESOLUTION, "size", size, "insert ns",
                                                     1e9 * insert, "remove ns", 1e9 * removal, "judged", verdict));
            own_destroy(own);
        }
        bench_scene_destroy(bodies);
    }
}
