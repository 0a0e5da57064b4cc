/* SPDX-License-Identifier: MIT */
/*
 * Many rays, each against brute force: all worlds, at the origin and far from it, every kind of grid and every way to
 * trace. Ends with status 1 if one answer is wrong by what raygrid/trace.h promises.
 *
 * A job is a new world of some hundred objects and some thousand rays, of which some go the same way in groups of 16.
 * The answer of the loose kind is held against brute force; those of the other kinds, of one ray a call and of
 * any-hit queries must be the same to the last bit.
 */
#include "judge.h"
#include "own.h"
#include "worlds.h"

#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 150, CHUNK = 4096, CHUNKS = 8, KINDS = 3, GROUP = 16, MOST_THREADS = 256, WORST_SHOWN = 10 };

static const double OFFSETS[] = {0, 1e3, 1e6, 1e9, 1e12};

struct tally {
    uint64_t rays, hits, within, wrong;
    double worst_t; /* in parts of its bound */
};

struct run {
    pthread_mutex_t mutex;  /* guards what follows */
    uint64_t wanted, given; /* rays */
    uint64_t job;
    uint64_t seed;
    bool spoil;
    struct tally tally[16][sizeof OFFSETS / sizeof *OFFSETS]; /* of each world and offset */
};

struct job {
    int world;
    size_t offset;
    uint64_t seed;
};

/* One world, set up in all ways. */
struct stage {
    struct job job;
    struct world *world;
    struct own *own[KINDS];
    struct judge *judge;
    rg_ray rays[CHUNK];
    rg_hit hits[CHUNK], others[CHUNK];
    uint8_t occluded[CHUNK];
};

static int world_count(void) {
    int count = 0;
    while (WORLDS[count]) count++;
    return count;
}

static struct stage *stage_create(const struct job *job) {
    static const rg_grid_kind OF[KINDS] = {RG_GRID_LOOSE, RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL};
    struct stage *stage = bench_allocate(1, sizeof *stage);
    stage->job = *job;
    stage->world = world_create(WORLDS[job->world], OBJECTS, OFFSETS[job->offset], job->seed);
    for (int k = 0; k < KINDS; k++) {
        const rg_grid_config grid = {.size = sizeof grid, .kind = OF[k]};
        stage->own[k] = own_create(stage->world->bodies, 1);
        own_check(rg_grid_configure(stage->own[k]->scene, RG_GRID_OF_SCENE, &grid));
    }
    stage->judge = judge_create(stage->world->bodies, stage->own[0]->objects, NULL);
    return stage;
}

static void stage_destroy(struct stage *stage) {
    judge_destroy(stage->judge);
    for (int k = 0; k < KINDS; k++) own_destroy(stage->own[k]);
    world_destroy(stage->world);
    free(stage);
}

/* Half of the groups are neighbours of one ray; one in eight ends somewhere among the objects. */
static void make_rays(struct stage *stage, uint64_t *random) {
    for (int i = 0; i < CHUNK; i++) {
        rg_ray *ray = &stage->rays[i];
        bool first = i % GROUP == 0;
        *ray = world_ray(stage->world, random);
        if (!first && i / GROUP % 2) {
            const rg_ray *of = &stage->rays[i - i % GROUP];
            double spread = pow(10, -2 - i / GROUP % 5) *
                            sqrt(of->direction[0] * of->direction[0] + of->direction[1] * of->direction[1] +
                                 of->direction[2] * of->direction[2]);
            *ray = *of;
            for (int k = 0; k < 3; k++) ray->direction[k] += spread * (bench_random(random) - 0.5);
        }
        if (bench_random(random) < 0.125) {
            ray->t_min = 0.1 * bench_random(random);
            ray->t_max = ray->t_min + bench_random(random);
        }
    }
}

static void show(const struct stage *stage, int ray, const char *what) {
    const rg_ray *r = &stage->rays[ray];
    const rg_hit *h = &stage->hits[ray];
    printf("wrong: %s\n  world_create(\"%s\", %d, %g, %" PRIu64 ")\n", what, stage->world->name, OBJECTS,
           OFFSETS[stage->job.offset], stage->job.seed);
    printf("  origin %a %a %a direction %a %a %a t %a to %a\n  object %" PRIx64 " primitive %" PRIu32 " t %a\n",
           r->origin[0], r->origin[1], r->origin[2], r->direction[0], r->direction[1], r->direction[2], r->t_min,
           r->t_max, h->object, h->primitive, h->t);
}

/* The number of answers that differ from those of the loose kind, traced in one call. */
static uint64_t compare_ways(struct stage *stage, uint64_t chunk) {
    uint64_t different = 0;
    for (int k = 1; k < KINDS; k++) {
        own_check(rg_scene_trace(stage->own[k]->scene, stage->rays, stage->others, CHUNK));
        for (int i = 0; i < CHUNK; i++) {
            if (memcmp(&stage->hits[i], &stage->others[i], sizeof(rg_hit)) == 0) continue;
            if (different++ < WORST_SHOWN) show(stage, i, "another kind of grid says otherwise");
        }
    }
    int kind = (int)(chunk % KINDS);
    own_check(rg_scene_occluded(stage->own[kind]->scene, stage->rays, stage->occluded, CHUNK));
    for (int i = 0; i < CHUNK; i++) {
        if (stage->occluded[i] == (stage->hits[i].object != RG_NO_OBJECT)) continue;
        if (different++ < WORST_SHOWN) show(stage, i, "any hit says otherwise");
    }
    for (int i = (int)(chunk % 8); i < CHUNK; i += 8) {
        own_check(rg_scene_trace(stage->own[0]->scene, &stage->rays[i], &stage->others[i], 1));
        if (memcmp(&stage->hits[i], &stage->others[i], sizeof(rg_hit)) == 0) continue;
        if (different++ < WORST_SHOWN) show(stage, i, "alone it is otherwise");
    }
    return different;
}

/* In turn a miss for a hit, another object, a t off by more than any bound here allows. */
static void spoil(struct stage *stage) {
    for (int i = 0; i < CHUNK; i++) {
        rg_hit *hit = &stage->hits[i];
        if (i % 3 == 0 || hit->object == RG_NO_OBJECT) {
            *hit = (rg_hit){.t = INFINITY, .primitive = RG_NO_PRIMITIVE};
        } else if (i % 3 == 1) {
            hit->object = stage->own[0]->objects[(RG_OBJECT_SLOT(hit->object) + 1) % stage->world->bodies->count];
        } else {
            hit->t = hit->t * 1.125 + 1e-3;
        }
    }
}

static void judge_all(struct stage *stage, struct tally *tally) {
    for (int i = 0; i < CHUNK; i++) {
        const rg_ray *ray = &stage->rays[i];
        const reference_scene *near = judge_near(stage->judge, ray);
        reference_error error;
        reference_verdict verdict = reference_compare(near, ray, RG_CULL_NONE, &stage->hits[i], &error);
        if (stage->hits[i].object != RG_NO_OBJECT) tally->hits++;
        if (verdict == REFERENCE_WITHIN_BOUND) tally->within++;
        if (verdict == REFERENCE_EQUAL && error.t_bound > 0) {
            tally->worst_t = fmax(tally->worst_t, (double)(error.t / error.t_bound));
        }
        if (verdict == REFERENCE_WRONG && tally->wrong++ < WORST_SHOWN) show(stage, i, error.what);
    }
    tally->rays += CHUNK;
}

static bool next_job(struct run *run, struct job *job) {
    const size_t offsets = sizeof OFFSETS / sizeof *OFFSETS;
    pthread_mutex_lock(&run->mutex);
    bool more = run->given < run->wanted;
    uint64_t number = run->job++;
    run->given += (uint64_t)CHUNK * CHUNKS;
    pthread_mutex_unlock(&run->mutex);
    int worlds = world_count();
    *job = (struct job){(int)(number % (uint64_t)worlds), number / (uint64_t)worlds % offsets,
                        run->seed + 0x9E3779B97F4A7C15u * number};
    return more;
}

static void add(struct run *run, const struct job *job, const struct tally *tally) {
    pthread_mutex_lock(&run->mutex);
    struct tally *sum = &run->tally[job->world][job->offset];
    sum->rays += tally->rays;
    sum->hits += tally->hits;
    sum->within += tally->within;
    sum->wrong += tally->wrong;
    sum->worst_t = fmax(sum->worst_t, tally->worst_t);
    pthread_mutex_unlock(&run->mutex);
}

static void *work(void *context) {
    struct run *run = context;
    struct job job;
    while (next_job(run, &job)) {
        struct stage *stage = stage_create(&job);
        struct tally tally = {0};
        uint64_t random = ~job.seed;
        for (uint64_t chunk = 0; chunk < CHUNKS; chunk++) {
            make_rays(stage, &random);
            own_check(rg_scene_trace(stage->own[0]->scene, stage->rays, stage->hits, CHUNK));
            if (run->spoil) {
                spoil(stage);
            } else {
                tally.wrong += compare_ways(stage, chunk);
            }
            judge_all(stage, &tally);
        }
        add(run, &job, &tally);
        stage_destroy(stage);
    }
    return NULL;
}

static struct tally print(const struct run *run) {
    struct tally all = {0};
    printf("%-18s %8s %14s %14s %10s %6s %12s\n", "scene", "offset", "rays", "hits", "in doubt", "wrong", "worst t");
    for (int w = 0; w < world_count(); w++) {
        for (size_t o = 0; o < sizeof OFFSETS / sizeof *OFFSETS; o++) {
            const struct tally *t = &run->tally[w][o];
            if (!t->rays) continue;
            printf("%-18s %8g %14" PRIu64 " %14" PRIu64 " %10" PRIu64 " %6" PRIu64 " %12.3f\n", WORLDS[w], OFFSETS[o],
                   t->rays, t->hits, t->within, t->wrong, t->worst_t);
            all.rays += t->rays;
            all.hits += t->hits;
            all.within += t->within;
            all.wrong += t->wrong;
            all.worst_t = fmax(all.worst_t, t->worst_t);
        }
    }
    return all;
}

static bool read_options(struct run *run, int *threads, int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (strcmp(name, "--spoil") == 0) {
            run->spoil = true;
            continue;
        }
        if (!value) return false;
        i++;
        if (strcmp(name, "--rays") == 0) {
            run->wanted = strtoull(value, NULL, 10);
        } else if (strcmp(name, "--threads") == 0) {
            *threads = atoi(value);
        } else if (strcmp(name, "--seed") == 0) {
            run->seed = strtoull(value, NULL, 10);
        } else {
            return false;
        }
    }
    return run->wanted > 0 && *threads > 0 && *threads <= MOST_THREADS;
}

int main(int argc, char **argv) {
    static struct run run = {.mutex = PTHREAD_MUTEX_INITIALIZER, .wanted = 1000000, .seed = 7};
    pthread_t others[MOST_THREADS];
    int threads = 1;
    if (!read_options(&run, &threads, argc, argv)) {
        fputs("usage: rays [--rays N] [--threads N] [--seed N] [--spoil]\n", stderr);
        return 2;
    }
    double before = bench_wall_seconds();
    for (int i = 1; i < threads; i++) {
        if (pthread_create(&others[i], NULL, work, &run)) threads = i;
    }
    work(&run);
    for (int i = 1; i < threads; i++) pthread_join(others[i], NULL);
    struct tally all = print(&run);
    printf(
        "%" PRIu64 " rays, %" PRIu64 " hits: %" PRIu64 " wrong; %" PRIu64
        " so close to a silhouette or a tie that either answer is allowed; worst t error %.3f of its bound; %.0f s\n",
        all.rays, all.hits, all.wrong, all.within, all.worst_t, bench_wall_seconds() - before);
    return all.wrong ? 1 : 0;
}
