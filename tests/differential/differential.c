/* SPDX-License-Identifier: MIT */
/*
 * differential: random changes and random queries, every answer compared with brute force.
 *
 *   differential [--steps N] [--seed S] [--grid NAME] [--population N] [--offset X]
 *
 * NAME is the beginning of a case's name, such as "uniform". A failure names the case, the seed and the step, and the
 * same three repeat it. Steps are per case.
 */
#include "world.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* What a grid's first box is in the cases that give one: much smaller than the world, so most objects leave it. */
#define SMALL_BOX .lo = {-8, -8, -8}, .hi = {8, 8, 8}
#define LONG_BOX .lo = {-8, -4, -1}, .hi = {8, 4, 1}

typedef struct grid_case {
    const char *name;
    rg_grid_config grid;
    int grids; /* how many besides the scene's own: see MORE */
    bool two_workers;
    bool one_decade_less; /* cells of a uniform grid that is never rebuilt list a large object very often */
    bool configures, balls, all_finite;
    int least_decade, most_decade; /* of the sizes; 0, as of what follows: the usual ones */
    uint32_t population, most_at_once, many_of_16;
    uint32_t steps_part; /* so much fewer steps */
} grid_case;

#define GRID(...)                                                                                                    \
    { .size = sizeof(rg_grid_config), __VA_ARGS__ }
#define UNIFORM .kind = RG_GRID_UNIFORM
#define HIERARCHICAL .kind = RG_GRID_HIERARCHICAL
#define LOOSE .kind = RG_GRID_LOOSE
#define NEVER .rebuild_factor = RG_REBUILD_NEVER

static const grid_case CASES[] = {
    {"uniform-auto", .grid = GRID(UNIFORM)},
    {"uniform-box", .grid = GRID(UNIFORM, SMALL_BOX, .rebuild_factor = 2)},
    {"uniform-never", .grid = GRID(UNIFORM, SMALL_BOX, NEVER, .resolution = 16), .one_decade_less = true},
    {"uniform-one-cell", .grid = GRID(UNIFORM, SMALL_BOX, NEVER, .resolution = 1)},
    {"uniform-fine", .grid = GRID(UNIFORM, .resolution = 50), .one_decade_less = true},
    {"hierarchical-auto", .grid = GRID(HIERARCHICAL)},
    {"hierarchical-box", .grid = GRID(HIERARCHICAL, SMALL_BOX, .rebuild_factor = 2)},
    {"hierarchical-never", .grid = GRID(HIERARCHICAL, SMALL_BOX, NEVER, .resolution = 64)},
    {"hierarchical-coarse", .grid = GRID(HIERARCHICAL, LONG_BOX, NEVER, .resolution = 5)},
    {"hierarchical-fine", .grid = GRID(HIERARCHICAL, .resolution = 200), .two_workers = true},
    {"two-grids", .grid = GRID(HIERARCHICAL), .grids = 1, .two_workers = true},
    {"loose", .grid = GRID(LOOSE)},
    {"loose-balls", .grid = GRID(LOOSE), .balls = true},
    {"loose-balls-crowd", .grid = GRID(LOOSE), .balls = true, .population = 3000, .most_at_once = 2000,
     .many_of_16 = 4, .steps_part = 8},
    {"loose-finite", .grid = GRID(LOOSE), .all_finite = true},
    {"loose-few", .grid = GRID(LOOSE), .population = 6},
    {"loose-decades", .grid = GRID(LOOSE), .least_decade = -8, .most_decade = 6, .steps_part = 3},
    {"loose-churn", .grid = GRID(LOOSE), .two_workers = true, .many_of_16 = 6},
    {"loose-crowd", .grid = GRID(LOOSE), .two_workers = true, .population = 3000, .most_at_once = 2000,
     .many_of_16 = 4, .steps_part = 40},
    {"grids-of-all-kinds", .grid = GRID(LOOSE), .grids = 3, .two_workers = true, .many_of_16 = 2},
    {"grids-configured", .grid = GRID(LOOSE), .grids = 2, .many_of_16 = 1, .configures = true},
};

typedef struct options {
    uint64_t steps, seed;
    const char *grid;
    uint32_t population;
    double offset; /* of the whole scene from the origin, along all axes */
} options;

/* Where the crowd goes: out of the box on one side after another, and home again each time. */
static void drift(world *w, uint64_t phase, double offset) {
    static const double SPREADS[] = {10, 60, 200};
    for (int i = 0; i < 3; i++) w->centre[i] = offset;
    w->spread = SPREADS[phase / 2 % 3];
    if (phase % 2 == 0) return;
    uint64_t side = phase / 2 % 6;
    w->centre[side / 2] += (side % 2 ? -1 : 1) * random_decade(&w->random, 1, 3);
}

static void run_step(world *w, const options *o, uint32_t population, uint64_t phase_length) {
    if (w->step % phase_length == 0) drift(w, w->step / phase_length, o->offset);
    world_step(w, population);
    if (w->step % 4 == 0) world_query_plain(w, 1 + random_below(&w->random, 4));
    if (w->step % 32 == 0) world_query_views(w, 1 + random_below(&w->random, WORLD_BATCH));
    if (w->step % 64 == 16) world_query_shadows(w, 1 + random_below(&w->random, WORLD_BATCH));
    if (w->step % 64 == 0) world_query_filtered(w, 1 + random_below(&w->random, WORLD_BATCH));
    if (w->step % 256 == 0) world_check_books(w);
}

static void report(const world *w, clock_t begin) {
    const world_counts *c = &w->counts;
    printf("%-20s %8" PRIu64 " steps %8" PRIu64 " rays %7" PRIu64 " hits %8" PRIu64 " occluded %6" PRIu64
           " reflected: 0 wrong, %" PRIu64 " within the bound; worst t %.3Lf of its bound, normal %.1Le; %.1f s\n",
           w->name, w->step, c->rays, c->hits, c->occluded, c->reflected, c->within_bound, c->worst_t,
           c->worst_normal, (double)(clock() - begin) / CLOCKS_PER_SEC);
    fflush(stdout);
}

static void run_case(const grid_case *what, const options *o) {
    static const rg_grid_config MORE[] = {GRID(UNIFORM, SMALL_BOX), GRID(LOOSE), GRID(HIERARCHICAL)};
    static world w; /* large */
    rg_grid_config grid = what->grid;
    bool given = grid.lo[0] != 0;
    for (int i = 0; i < 3; i++) grid.lo[i] += given ? o->offset : 0, grid.hi[i] += given ? o->offset : 0;
    rg_scene_config config = {.size = sizeof config, .workers = what->two_workers ? 2 : 1, .grid = &grid};
    clock_t begin = clock();
    /* The same seed must not mean the same steps in each case. */
    world_create(&w, what->name, o->seed + 1000 * (uint64_t)(what - CASES), &config, MORE, what->grids);
    w.seed = o->seed;
    if (what->most_decade) w.most_decade = what->most_decade;
    if (what->least_decade) w.least_decade = what->least_decade;
    w.no_cells_for_finite = what->least_decade < -4;
    w.most_decade -= what->one_decade_less;
    if (what->most_at_once) w.most_at_once = what->most_at_once;
    w.many_of_16 = what->many_of_16;
    w.configures = what->configures;
    w.balls = what->balls;
    w.all_finite = what->all_finite;
    uint64_t steps = what->steps_part ? o->steps / what->steps_part : o->steps;
    uint32_t population = what->population ? what->population : o->population;
    while (w.step < steps) run_step(&w, o, population, steps / 36 + 1);
    if (steps >= 10000 && w.counts.hits < w.counts.rays / 10) world_fail(&w, "hardly any ray hit: a poor test");
    /* Where sizes differ by many powers of ten, most rays start in something huge, or just touch it. */
    uint64_t mercy = w.counts.rays / (what->least_decade ? 10 : 50) + 10;
    if (w.counts.within_bound > mercy) world_fail(&w, "too many answers need the bound's mercy");
    report(&w, begin);
    world_destroy(&w);
}

static void usage(void) {
    fprintf(stderr, "usage: differential [--steps N] [--seed S] [--grid NAME] [--population N] [--offset X]\n");
    exit(2);
}

static options read_options(int argc, char **argv) {
    options o = {.steps = 40000, .seed = 20001, .grid = "", .population = 300};
    for (int i = 1; i < argc; i += 2) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (value && strcmp(argv[i], "--steps") == 0)
            o.steps = strtoull(value, NULL, 0);
        else if (value && strcmp(argv[i], "--seed") == 0)
            o.seed = strtoull(value, NULL, 0);
        else if (value && strcmp(argv[i], "--grid") == 0)
            o.grid = value;
        else if (value && strcmp(argv[i], "--population") == 0)
            o.population = (uint32_t)strtoul(value, NULL, 0);
        else if (value && strcmp(argv[i], "--offset") == 0)
            o.offset = strtod(value, NULL);
        else
            usage();
    }
    return o;
}

int main(int argc, char **argv) {
    options o = read_options(argc, argv);
    bool any = false;
    printf("seed %" PRIu64 "\n", o.seed);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        if (strncmp(CASES[i].name, o.grid, strlen(o.grid)) != 0) continue;
        any = true;
        run_case(&CASES[i], &o);
    }
    if (!any) fprintf(stderr, "no case begins with \"%s\"\n", o.grid);
    return any ? EXIT_SUCCESS : 2;
}
