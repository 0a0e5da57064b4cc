/* SPDX-License-Identifier: MIT */
/*
 * same_bits: the same objects and the same rays give the same bits, whatever the kind of grid, the size of the calls,
 * what is asked for, the number of workers, the order of insertion, and what else came and went before; with whatever
 * instructions; and on every machine: the bits have a hash that is part of the source.
 *
 *   same_bits [--short | --hash] [--isa NAME ...]
 *
 * --short: only the variants with threads. --hash: only the hash of each set, by one variant. --isa: the same with
 * the instructions capped at each of the names; takes a build in which RAYGRID_ISA is read.
 */
#include "golden.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OTHERS = 100, ALL_AT_ONCE = GOLDEN_RAYS };

static golden_data data;
static uint64_t jobs_run;

typedef struct variant {
    const char *name;
    rg_grid_kind kind;
    uint32_t resolution, workers;
    uint64_t at_once;
    rg_coherence coherence; /* told, true or not */
    bool reorders;          /* ids are others: not for sets with ties */
    bool backward, many, churned, drifted, host_jobs, configured;
} variant;

static const variant VARIANTS[] = {
    {"the default", .kind = RG_GRID_DEFAULT, .workers = 1, .at_once = ALL_AT_ONCE},
    {"two workers", .kind = RG_GRID_LOOSE, .workers = 2, .at_once = ALL_AT_ONCE},
    {"four workers", .kind = RG_GRID_LOOSE, .workers = 4, .at_once = ALL_AT_ONCE},
    {"one ray at once", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = 1},
    {"5 rays at once", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = 5},
    {"16 rays at once", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = 16},
    {"a thousand at once, four workers", .kind = RG_GRID_LOOSE, .workers = 4, .at_once = 1000},
    {"the host's jobs", .kind = RG_GRID_LOOSE, .at_once = ALL_AT_ONCE, .host_jobs = true},
    {"inserted in one call", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = 100, .many = true},
    {"inserted backward", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = ALL_AT_ONCE, .reorders = true,
     .backward = true},
    {"after others came and went", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = ALL_AT_ONCE, .reorders = true,
     .churned = true},
    {"after a drift", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = ALL_AT_ONCE, .drifted = true},
    {"told to be coherent", .kind = RG_GRID_LOOSE, .workers = 2, .at_once = ALL_AT_ONCE,
     .coherence = RG_COHERENCE_HIGH},
    {"told to be incoherent", .kind = RG_GRID_LOOSE, .workers = 1, .at_once = ALL_AT_ONCE,
     .coherence = RG_COHERENCE_LOW},
    {"hierarchical", .kind = RG_GRID_HIERARCHICAL, .workers = 1, .at_once = ALL_AT_ONCE},
    {"hierarchical, one ray at once", .kind = RG_GRID_HIERARCHICAL, .workers = 1, .at_once = 1},
    {"hierarchical, 16 at once, churned", .kind = RG_GRID_HIERARCHICAL, .workers = 2, .at_once = 16, .reorders = true,
     .churned = true},
    {"hierarchical, fine", .kind = RG_GRID_HIERARCHICAL, .resolution = 128, .workers = 1, .at_once = ALL_AT_ONCE},
    {"uniform", .kind = RG_GRID_UNIFORM, .workers = 1, .at_once = ALL_AT_ONCE},
    {"uniform, backward", .kind = RG_GRID_UNIFORM, .workers = 2, .at_once = 1000, .reorders = true, .backward = true},
    {"uniform, then the default", .kind = RG_GRID_UNIFORM, .workers = 1, .at_once = ALL_AT_ONCE, .configured = true},
};

/* ------------------------------------------------------------------------------------------------- scenes */

static void insert(rg_scene *scene, int i, const rg_pose *pose, rg_object *id) {
    golden_demand(rg_scene_insert(scene, data.shapes[data.shape_of[i]], pose, id), "insert");
    if (data.masks[i] != UINT32_MAX) golden_demand(rg_scene_set_mask(scene, *id, data.masks[i]), "set_mask");
}

static void insert_many(rg_scene *scene, rg_object *ids) {
    static rg_shape *shapes[GOLDEN_OBJECTS];
    rg_insert_views views = {.size = sizeof views, .shapes = shapes, .shapes_stride = sizeof *shapes};
    rg_pose_views poses;
    const rg_output out = {ids, sizeof *ids, RG_U64};
    for (int i = 0; i < data.objects; i++) shapes[i] = data.shapes[data.shape_of[i]];
    golden_demand(rg_pose_views_of(&poses, sizeof poses, data.poses, sizeof *data.poses), "views");
    views.poses = &poses;
    views.mask = (rg_input){data.masks, sizeof *data.masks, RG_U32};
    golden_demand(rg_scene_insert_many(scene, &views, (uint64_t)data.objects, &out), "insert_many");
}

/* Others come, what is wanted comes elsewhere and moves home, the others go. */
static void insert_churned(rg_scene *scene, rg_object *ids) {
    rg_object others[OTHERS];
    double reach = 20 * data.set->space.spread;
    for (int i = 0; i < OTHERS; i++) {
        rg_pose pose = data.poses[(7 * i) % data.objects];
        pose.position[i % 3] += reach;
        insert(scene, (7 * i) % data.objects, &pose, &others[i]);
    }
    for (int i = 0; i < data.objects; i++) {
        rg_pose pose = data.poses[i];
        pose.position[0] -= 0.5 * reach;
        insert(scene, i, &pose, &ids[i]);
    }
    for (int i = 0; i < OTHERS; i++) golden_demand(rg_scene_remove(scene, others[i]), "remove");
    for (int i = 0; i < data.objects; i++) golden_demand(rg_scene_move(scene, ids[i], &data.poses[i]), "move");
}

/* All are carried away in small steps and come home in one. */
static void drift(rg_scene *scene, const rg_object *ids) {
    static double positions[GOLDEN_OBJECTS][3];
    rg_pose_views views = {.size = sizeof views, .position = rg_input3_packed(positions, 24, RG_F64)};
    const rg_input in = {ids, sizeof *ids, RG_U64};
    for (int step = 24; step >= 0; step--) {
        double by = step == 24 ? 0 : step * 0.15 * data.set->space.spread;
        for (int i = 0; i < data.objects; i++) {
            for (int k = 0; k < 3; k++) positions[i][k] = data.poses[i].position[k] + (k == i % 3 ? by : 0);
        }
        golden_demand(rg_scene_move_many(scene, &in, &views, (uint64_t)data.objects), "move_many");
    }
}

/* A host that runs its jobs from the last to the first. */
static void run_jobs(void *user, uint64_t count, void (*body)(void *context, uint64_t index), void *context) {
    *(uint64_t *)user += count;
    while (count-- > 0) body(context, count);
}

static rg_scene *make_scene(const variant *v, rg_object *ids) {
    rg_grid_config grid = {.size = sizeof grid, .kind = v->kind, .resolution = v->resolution};
    rg_scene_config config = {.size = sizeof config, .workers = v->workers, .grid = &grid};
    if (v->host_jobs) config.parallel_for = run_jobs, config.parallel_for_user = &jobs_run;
    rg_scene *scene = NULL;
    golden_demand(rg_scene_create(&config, &scene), "create");
    if (v->many) {
        insert_many(scene, ids);
    } else if (v->churned) {
        insert_churned(scene, ids);
    } else {
        for (int n = 0; n < data.objects; n++) {
            int i = v->backward ? data.objects - 1 - n : n;
            insert(scene, i, &data.poses[i], &ids[i]);
        }
    }
    if (v->drifted) drift(scene, ids);
    grid.kind = RG_GRID_DEFAULT;
    if (v->configured) golden_demand(rg_grid_configure(scene, RG_GRID_OF_SCENE, &grid), "configure");
    return scene;
}

/* ------------------------------------------------------------------------------------------------- tracing */

/* Ids differ between variants; what they stand for may not. */
static void name_objects(rg_hit *hits, const rg_object *ids) {
    static int index_of_slot[GOLDEN_OBJECTS + OTHERS];
    memset(index_of_slot, 0, sizeof index_of_slot);
    for (int i = 0; i < data.objects; i++) index_of_slot[RG_OBJECT_SLOT(ids[i])] = i + 1;
    for (int i = 0; i < data.rays; i++) {
        if (hits[i].object == RG_NO_OBJECT) continue;
        int index = index_of_slot[RG_OBJECT_SLOT(hits[i].object)];
        if (index == 0 || ids[index - 1] != hits[i].object) {
            fprintf(stderr, "FAILED: ray %d hit an object that does not exist\n", i);
            exit(EXIT_FAILURE);
        }
        hits[i].object = (rg_object)index;
    }
}

static rg_hit_views views_of(rg_hit *hits, bool all) {
    const ptrdiff_t stride = sizeof *hits;
    rg_hit_views views = {.size = sizeof views};
    views.t = (rg_output){&hits->t, stride, RG_F64};
    views.object = (rg_output){&hits->object, stride, RG_U64};
    views.primitive = (rg_output){&hits->primitive, stride, RG_U32};
    views.normal = rg_output3_packed(hits->normal, stride, RG_F32);
    if (!all) return views;
    views.position = rg_output3_packed(hits->position, stride, RG_F64);
    views.offset = (rg_output){&hits->offset, stride, RG_F32};
    views.u = (rg_output){&hits->u, stride, RG_F32};
    views.v = (rg_output){&hits->v, stride, RG_F32};
    return views;
}

/* By views; what is not asked for stays as it is in `hits`. */
static void trace_views(rg_scene *scene, const variant *v, rg_hit *hits, bool all, uint8_t *occluded) {
    const ptrdiff_t ray = sizeof *data.ray;
    const rg_trace_config config = {.size = sizeof config, .coherence = v->coherence};
    for (uint64_t i = 0; i < (uint64_t)data.rays; i += v->at_once) {
        uint64_t left = (uint64_t)data.rays - i, count = left < v->at_once ? left : v->at_once;
        rg_hit_views out = views_of(hits + i, all);
        rg_output flags = {occluded + i, 1, RG_U8};
        rg_ray_views in = {.size = sizeof in};
        in.origin = rg_input3_packed(data.ray[i].origin, ray, RG_F64);
        in.direction = rg_input3_packed(data.ray[i].direction, ray, RG_F64);
        in.t_min = (rg_input){&data.ray[i].t_min, ray, RG_F64};
        in.t_max = (rg_input){&data.ray[i].t_max, ray, RG_F64};
        in.mask = (rg_input){&data.ray[i].mask, ray, RG_U32};
        golden_demand(rg_scene_trace_views(scene, &config, &in, &out, count), "trace_views");
        if (all) golden_demand(rg_scene_occluded_views(scene, &config, &in, &flags, count), "occluded_views");
    }
}

static void trace_plain(rg_scene *scene, const variant *v, rg_hit *hits, uint8_t *occluded) {
    for (uint64_t i = 0; i < (uint64_t)data.rays; i += v->at_once) {
        uint64_t left = (uint64_t)data.rays - i, count = left < v->at_once ? left : v->at_once;
        golden_demand(rg_scene_trace(scene, data.ray + i, hits + i, count), "trace");
        golden_demand(rg_scene_occluded(scene, data.ray + i, occluded + i, count), "occluded");
    }
}

static void trace_variant(const variant *v, rg_hit *hits, rg_hit *little, uint8_t *occluded) {
    static rg_object ids[GOLDEN_OBJECTS];
    rg_scene *scene = make_scene(v, ids);
    memset(hits, 0, (size_t)data.rays * sizeof *hits);
    if (v->coherence)
        trace_views(scene, v, hits, true, occluded);
    else
        trace_plain(scene, v, hits, occluded);
    memcpy(little, hits, (size_t)data.rays * sizeof *hits);
    trace_views(scene, v, little, false, occluded);
    name_objects(hits, ids);
    name_objects(little, ids);
    golden_demand(rg_scene_destroy(&scene), "destroy");
}

/* -------------------------------------------------------------------------------------------------- judging */

static void show(const char *name, const rg_hit *h, uint8_t occluded) {
    fprintf(stderr, "  %s: t %a object %d primitive %" PRIu32 " occluded %d\n", name, h->t, (int)h->object,
            h->primitive, occluded);
}

static int compare(const char *name, const rg_hit *first, const uint8_t *first_occluded, const rg_hit *hits,
                   const uint8_t *occluded) {
    int different = 0;
    for (int i = 0; i < data.rays; i++) {
        if (memcmp(&hits[i], &first[i], sizeof first[i]) == 0 && occluded[i] == first_occluded[i]) continue;
        if (different++) continue;
        const rg_ray *r = &data.ray[i];
        fprintf(stderr,
                "FAILED: %s, ray %d: origin {%a, %a, %a} direction {%a, %a, %a} t %a to %a mask %" PRIx32 "\n",
                data.set->name, i, r->origin[0], r->origin[1], r->origin[2], r->direction[0], r->direction[1],
                r->direction[2], r->t_min, r->t_max, r->mask);
        show("the first", &first[i], first_occluded[i]);
        show(name, &hits[i], occluded[i]);
    }
    return different;
}

static rg_hit first[GOLDEN_RAYS], hits[GOLDEN_RAYS], little[GOLDEN_RAYS];
static uint8_t first_occluded[GOLDEN_RAYS], occluded[GOLDEN_RAYS];

typedef enum extent { ALL_VARIANTS, WITH_THREADS, HASH_ONLY } extent;

/* Returns how many rays differ in some variant. */
static int run_variants(extent which) {
    int failures = compare("little asked for", first, first_occluded, little, first_occluded);
    for (size_t k = 1; k < sizeof VARIANTS / sizeof *VARIANTS; k++) {
        if (data.set->ties && VARIANTS[k].reorders) continue;
        if (which == HASH_ONLY || (which == WITH_THREADS && VARIANTS[k].workers == 1)) continue;
        trace_variant(&VARIANTS[k], hits, little, occluded);
        int different = compare(VARIANTS[k].name, first, first_occluded, hits, occluded);
        different += compare("little asked for", first, first_occluded, little, occluded);
        if (different)
            printf("%s, %s: %d of %d rays differ\n", data.set->name, VARIANTS[k].name, different, data.rays);
        failures += different;
    }
    return failures;
}

static void demand_hits(void) {
    int found = 0;
    for (int i = 0; i < data.rays; i++) found += first[i].object != RG_NO_OBJECT;
    if (found >= data.rays / 10) return;
    fprintf(stderr, "FAILED: %s: hardly any ray hit: a poor test\n", data.set->name);
    exit(EXIT_FAILURE);
}

/* Returns whether the set is as it must be. */
static bool run_set(const golden_set *set, extent which) {
    golden_make(&data, set);
    trace_variant(&VARIANTS[0], first, little, first_occluded);
    demand_hits();
    uint64_t hash = golden_hash(first, first_occluded, data.rays);
    int different = run_variants(which);
    printf("%-8s %016" PRIx64 "%s\n", set->name, hash, hash == set->hash ? "" : " IS NOT THE HASH IN golden.c");
    fflush(stdout);
    golden_release(&data);
    return different == 0 && hash == set->hash;
}

static bool run_sets(extent which) {
    bool good = true;
    for (int i = 0; i < GOLDEN_SET_COUNT; i++) good = run_set(&GOLDEN_SETS[i], which) && good;
    return good;
}

int main(int argc, char **argv) {
    extent which = ALL_VARIANTS;
    bool good = true, capped = false;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--hash") == 0) {
            which = HASH_ONLY;
        } else if (strcmp(argv[i], "--short") == 0) {
            which = WITH_THREADS;
        } else if (strcmp(argv[i], "--isa") == 0 && i + 1 < argc) {
            capped = true;
            printf("RAYGRID_ISA=%s\n", argv[++i]);
            if (setenv("RAYGRID_ISA", argv[i], 1) != 0) return EXIT_FAILURE;
            good = run_sets(HASH_ONLY) && good;
        } else {
            fprintf(stderr, "usage: same_bits [--short | --hash] [--isa NAME ...]\n");
            return 2;
        }
    }
    if (!capped) good = run_sets(which);
    if (!capped && which != HASH_ONLY && jobs_run < 2) {
        fprintf(stderr, "FAILED: the host's jobs were not used\n");
        good = false;
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
