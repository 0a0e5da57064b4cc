/* SPDX-License-Identifier: MIT */
/*
 * same_bits: the same objects and the same rays give the same bits, whatever the number of workers, the size of the
 * calls, the kind of grid, the order of insertion, and what else came and went before.
 */
#include "world.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 400, RAYS = 20000, BEFORE = 100 };

/* The scene as plain data, from which it is made anew for each variant. */
static world_shape *shapes;
static int shape_of[OBJECTS];
static rg_pose poses[OBJECTS];
static rg_ray rays[RAYS];
static uint64_t jobs_run;

typedef struct variant {
    const char *name;
    uint32_t workers;
    rg_grid_kind kind;
    uint32_t resolution;
    uint64_t at_once;
    bool backward, churned, host_jobs;
} variant;

static const variant VARIANTS[] = {
    {"the first", 1, RG_GRID_HIERARCHICAL, 0, RAYS, false, false, false},
    {"two workers", 2, RG_GRID_HIERARCHICAL, 0, RAYS, false, false, false},
    {"four workers", 4, RG_GRID_HIERARCHICAL, 0, RAYS, false, false, false},
    {"one ray at once", 1, RG_GRID_HIERARCHICAL, 0, 1, false, false, false},
    {"16 rays at once", 1, RG_GRID_HIERARCHICAL, 0, 16, false, false, false},
    {"a thousand at once, four workers", 4, RG_GRID_HIERARCHICAL, 0, 1000, false, false, false},
    {"the host's jobs", 0, RG_GRID_HIERARCHICAL, 0, RAYS, false, false, true},
    {"uniform", 1, RG_GRID_UNIFORM, 0, RAYS, false, false, false},
    {"uniform, one cell", 2, RG_GRID_UNIFORM, 1, RAYS, false, false, false},
    {"hierarchical, fine", 1, RG_GRID_HIERARCHICAL, 128, RAYS, false, false, false},
    {"inserted backward", 1, RG_GRID_HIERARCHICAL, 0, RAYS, true, false, false},
    {"after others came and went", 1, RG_GRID_HIERARCHICAL, 0, RAYS, false, true, false},
    {"uniform, after others came and went", 2, RG_GRID_UNIFORM, 0, 16, true, true, false},
};

static void demand(rg_result result, const char *call) {
    if (result == RG_OK) return;
    fprintf(stderr, "FAILED: %s: %s: %s\n", call, rg_result_name(result), rg_error_message());
    exit(EXIT_FAILURE);
}

/* Others come, what is wanted comes elsewhere and moves home, the others go. */
static void insert_churned(rg_scene *scene, const int order[OBJECTS], rg_object ids[OBJECTS]) {
    rg_object others[BEFORE];
    for (int i = 0; i < BEFORE; i++) {
        rg_pose pose = poses[(7 * i) % OBJECTS];
        pose.position[i % 3] += 700;
        demand(rg_scene_insert(scene, shapes[shape_of[(7 * i) % OBJECTS]].shape, &pose, &others[i]), "insert");
    }
    for (int i = 0; i < OBJECTS; i++) {
        rg_pose pose = poses[order[i]];
        pose.position[0] -= 300;
        demand(rg_scene_insert(scene, shapes[shape_of[order[i]]].shape, &pose, &ids[order[i]]), "insert");
        if (i < BEFORE) demand(rg_scene_remove(scene, others[i]), "remove");
    }
    for (int i = 0; i < OBJECTS; i++) demand(rg_scene_move(scene, ids[i], &poses[i]), "move");
}

/* A host that runs its jobs from the last to the first. */
static void run_jobs(void *user, uint64_t count, void (*body)(void *context, uint64_t index), void *context) {
    *(uint64_t *)user += count;
    while (count-- > 0) body(context, count);
}

static rg_scene *make_scene(const variant *v, rg_object ids[OBJECTS]) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = v->kind, .resolution = v->resolution};
    rg_scene_config config = {.size = sizeof config, .workers = v->workers, .grid = &grid};
    if (v->host_jobs) config.parallel_for = run_jobs, config.parallel_for_user = &jobs_run;
    rg_scene *scene = NULL;
    int order[OBJECTS];
    for (int i = 0; i < OBJECTS; i++) order[i] = v->backward ? OBJECTS - 1 - i : i;
    demand(rg_scene_create(&config, &scene), "create");
    if (v->churned) insert_churned(scene, order, ids);
    for (int i = 0; i < OBJECTS && !v->churned; i++) {
        demand(rg_scene_insert(scene, shapes[shape_of[order[i]]].shape, &poses[order[i]], &ids[order[i]]), "insert");
    }
    return scene;
}

/* Ids differ between variants; what they stand for may not. */
static void name_objects(rg_hit *hits, const rg_object ids[OBJECTS]) {
    int index_of_slot[OBJECTS + BEFORE] = {0};
    for (int i = 0; i < OBJECTS; i++) index_of_slot[RG_OBJECT_SLOT(ids[i])] = i + 1;
    for (int i = 0; i < RAYS; i++) {
        if (hits[i].object == RG_NO_OBJECT) continue;
        int index = index_of_slot[RG_OBJECT_SLOT(hits[i].object)];
        if (index == 0 || ids[index - 1] != hits[i].object) {
            fprintf(stderr, "FAILED: ray %d hit an object that does not exist\n", i);
            exit(EXIT_FAILURE);
        }
        hits[i].object = (rg_object)index;
    }
}

static void trace_variant(const variant *v, rg_hit *hits, uint8_t *occluded) {
    rg_object ids[OBJECTS];
    rg_scene *scene = make_scene(v, ids);
    for (uint64_t i = 0; i < RAYS; i += v->at_once) {
        uint64_t count = RAYS - i < v->at_once ? RAYS - i : v->at_once;
        demand(rg_scene_trace(scene, rays + i, hits + i, count), "trace");
        demand(rg_scene_occluded(scene, rays + i, occluded + i, count), "occluded");
    }
    name_objects(hits, ids);
    demand(rg_scene_destroy(&scene), "destroy");
}

static int count_hits(const rg_hit *hits) {
    int count = 0;
    for (int i = 0; i < RAYS; i++) count += hits[i].object != RG_NO_OBJECT;
    return count;
}

/* Objects and rays of the random world, which serves as their store only. */
static void make_data(world *w, uint64_t seed) {
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    world_create(w, "same_bits", seed, &config, NULL);
    w->spread = 30;
    shapes = w->shapes;
    for (int i = 0; i < OBJECTS; i++) {
        do {
            shape_of[i] = (int)random_below(&w->random, (uint32_t)w->shape_count);
        } while (shapes[shape_of[i]].rare);
        rg_object id;
        poses[i] = world_pose(w, &shapes[shape_of[i]]);
        /* No two surfaces in one plane: at equal t the lower id wins, and ids differ between variants. */
        for (int k = 0; k < 3; k++) poses[i].position[k] += random_between(&w->random, -0.01, 0.01);
        demand(rg_scene_insert(w->scene, shapes[shape_of[i]].shape, &poses[i], &id), "insert");
        reference_insert(w->reference, id, shapes[shape_of[i]].reference, &poses[i], UINT32_MAX);
    }
    for (int i = 0; i < RAYS; i++) rays[i] = world_ray(w);
}

int main(int argc, char **argv) {
    static rg_hit first[RAYS], hits[RAYS];
    static uint8_t first_occluded[RAYS], occluded[RAYS];
    static world w;
    uint64_t seed = argc > 1 ? strtoull(argv[1], NULL, 0) : 20003;
    int failures = 0;
    printf("seed %" PRIu64 "\n", seed);
    make_data(&w, seed);
    for (size_t k = 0; k < sizeof VARIANTS / sizeof *VARIANTS; k++) {
        trace_variant(&VARIANTS[k], k ? hits : first, k ? occluded : first_occluded);
        int different = 0;
        for (int i = 0; k > 0 && i < RAYS; i++) {
            if (memcmp(&hits[i], &first[i], sizeof first[i]) == 0 && occluded[i] == first_occluded[i]) continue;
            if (different++ == 0) {
                world_dump_ray(&rays[i]);
                fprintf(stderr, "  first: t %a object %d occluded %d; %s: t %a object %d occluded %d\n", first[i].t,
                        (int)first[i].object, first_occluded[i], VARIANTS[k].name, hits[i].t, (int)hits[i].object,
                        occluded[i]);
            }
        }
        printf("%-36s %d of %d rays differ\n", VARIANTS[k].name, different, RAYS);
        failures += different;
    }
    if (jobs_run < 2) world_fail(&w, "the host's jobs were not used");
    if (count_hits(first) < RAYS / 10) world_fail(&w, "hardly any ray hit: a poor test");
    world_destroy(&w);
    return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
