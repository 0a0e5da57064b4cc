/* SPDX-License-Identifier: MIT */
/*
 * far: the scene of the differential test, but far from the world's origin. Positions are rounded to what doubles
 * there are; that rounded scene is what both sides must agree on, to the same bounds as at home.
 */
#include "world.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 4000, POPULATION = 150 };

static void run_at(double offset, rg_grid_kind kind, uint64_t seed) {
    static world w; /* large */
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {.size = sizeof config, .workers = 1, .grid = &grid};
    static const char *const NAMES[] = {"far", "far, uniform", "far, hierarchical", "far, loose"};
    world_create(&w, NAMES[kind], seed, &config, NULL, 0);
    w.spread = 40;
    /* Not the same on all axes: a grid must not find its walls by symmetry. */
    w.centre[0] = offset;
    w.centre[1] = -0.71 * offset;
    w.centre[2] = 0.13 * offset;
    while (w.step < STEPS) {
        world_step(&w, POPULATION);
        if (w.step % 4 == 0) world_query_plain(&w, 4);
        if (w.step % 32 == 0) world_query_views(&w, WORLD_BATCH);
        if (w.step % 64 == 16) world_query_shadows(&w, WORLD_BATCH);
        if (w.step % 256 == 0) world_check_books(&w);
    }
    const world_counts *c = &w.counts;
    printf("%s at %g: %" PRIu64 " rays, %" PRIu64 " hits: 0 wrong, %" PRIu64 " within the bound, worst t %.3Lf\n",
           w.name, offset, c->rays, c->hits, c->within_bound, c->worst_t);
    if (c->hits < c->rays / 10) world_fail(&w, "hardly any ray hit: a poor test");
    world_destroy(&w);
}

int main(int argc, char **argv) {
    static const double OFFSETS[] = {1e3, 1e6 + 0.56, 1e9 + 0.37, 1e12};
    uint64_t seed = argc > 1 ? strtoull(argv[1], NULL, 0) : 20002;
    printf("seed %" PRIu64 "\n", seed);
    for (size_t i = 0; i < sizeof OFFSETS / sizeof *OFFSETS; i++) {
        for (rg_grid_kind kind = RG_GRID_UNIFORM; kind <= RG_GRID_LOOSE; kind++) run_at(OFFSETS[i], kind, seed);
    }
    return EXIT_SUCCESS;
}
