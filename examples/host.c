/* SPDX-License-Identifier: MIT */
/*
 * host.c: raygrid inside a game that has its own jobs, its own memory and its own data.
 *
 * Some thousand agents run about between walls and turning ring gates. Each frame the game moves them all in one call
 * that reads its own array of structs, and asks in another whether each agent sees its target. A player shoots now
 * and then; who is hit starts anew elsewhere. The jobs are in host_jobs.c.
 *
 *     host [FRAMES]
 */
#define _POSIX_C_SOURCE 200809L
#include "host_jobs.h"

#include <raygrid/raygrid.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { AGENTS = 4000, WALLS = 60, GATES = 12 };
enum { MASK_AGENT = 1, MASK_SCENERY = 2 };

static const float ARENA = 200; /* metres a side, z up */
static const size_t MEMORY_BUDGET = (size_t)64 << 20;

/* Everything the game knows of an agent, in one struct, as games have it. raygrid reads and writes it in place. */
struct agent {
    float position[3];
    float velocity[3]; /* metres a second */
    float to_target[3];
    uint32_t target;
    rg_object object;
    uint8_t hidden; /* 1: something stands between this agent and its target */
};

/* ------------------------------------------------------------------------------------------ the game's memory */

struct memory {
    pthread_mutex_t lock;
    size_t used, peak;
};

/* Returns what is in use after the change. */
static size_t memory_count(struct memory *memory, size_t added, size_t removed) {
    pthread_mutex_lock(&memory->lock);
    size_t used = memory->used = memory->used + added - removed;
    if (used > memory->peak) memory->peak = used;
    pthread_mutex_unlock(&memory->lock);
    return used;
}

static void *memory_allocate(void *user, size_t size, size_t alignment) {
    struct memory *memory = user;
    void *block = NULL;
    if (alignment < sizeof(void *)) alignment = sizeof(void *);
    if (memory_count(memory, size, 0) > MEMORY_BUDGET || posix_memalign(&block, alignment, size) != 0) {
        memory_count(memory, 0, size);
        return NULL;
    }
    return block;
}

static void memory_release(void *user, void *block, size_t size, size_t alignment) {
    (void)alignment;
    memory_count(user, 0, size);
    free(block);
}

/* ---------------------------------------------------------------------------------- a shape of the game's own */

/* A flat ring around the local z axis. */
struct ring {
    double inner, outer;
};

static int32_t ring_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    const struct ring *ring = user;
    if (ray->direction[2] == 0) return 0;
    double t = -ray->origin[2] / ray->direction[2];
    double x = ray->origin[0] + t * ray->direction[0], y = ray->origin[1] + t * ray->direction[1];
    double distance = sqrt(x * x + y * y);
    if (t < ray->t_min || t > ray->t_max || distance < ring->inner || distance > ring->outer) return 0;
    *hit = (rg_local_hit){.t = t, .normal = {0, 0, 1}};
    return 1;
}

/* ------------------------------------------------------------------------------------------------- the game */

struct game {
    struct memory memory;
    struct jobs *jobs;
    struct ring ring;
    rg_scene *scene;
    rg_shape *ball, *block, *gate;
    rg_object gates[GATES];
    struct agent agents[AGENTS];
    uint32_t random;
    uint32_t shots_that_hit;
};

static void check(rg_result result) {
    if (result == RG_OK) return;
    fprintf(stderr, "%s: %s\n", rg_result_name(result), rg_error_message());
    exit(1);
}

/* In [lo, hi). */
static float random_between(struct game *game, float lo, float hi) {
    game->random = game->random * 1664525u + 1013904223u;
    return lo + (hi - lo) * (float)(game->random >> 8) / 16777216.0f;
}

static void agent_start(struct game *game, struct agent *agent) {
    for (int k = 0; k < 2; k++) {
        agent->position[k] = random_between(game, 1, ARENA - 1);
        agent->velocity[k] = random_between(game, -6, 6);
    }
    agent->position[2] = 1;
    agent->target = (uint32_t)random_between(game, 0, AGENTS);
}

static rg_pose gate_pose(int gate, double angle) {
    rg_pose pose = rg_pose_at(ARENA * (gate + 0.5) / GATES, ARENA / 2, 2);
    float c = (float)cos(angle), s = (float)sin(angle);
    /* Upright: the ring's axis, local z, lies in the world's plane and turns about the world's z. */
    float linear[9] = {-s, 0, c, c, 0, s, 0, 1, 0};
    for (int i = 0; i < 9; i++) pose.linear[i] = linear[i];
    return pose;
}

static void make_shapes(struct game *game, const rg_allocator *allocator) {
    rg_shape_config config;
    check(rg_shape_config_default(&config, sizeof config));
    config.allocator = *allocator;
    check(rg_shape_create_sphere(&config, 0.5, &game->ball));
    check(rg_shape_create_box(&config, (double[]){-1, -1, 0}, (double[]){1, 1, 1}, &game->block));

    game->ring = (struct ring){1.5, 2};
    rg_user_shape ring = {.size = sizeof ring, .user = &game->ring, .intersect = ring_intersect};
    for (int k = 0; k < 3; k++) ring.hi[k] = k < 2 ? game->ring.outer : 0;
    for (int k = 0; k < 3; k++) ring.lo[k] = -ring.hi[k];
    check(rg_shape_create_user(&config, &ring, &game->gate));
}

static void make_scene(struct game *game) {
    rg_scene_config config;
    check(rg_scene_config_default(&config, sizeof config));
    config.allocator = (rg_allocator){&game->memory, memory_allocate, memory_release};
    config.parallel_for = jobs_parallel_for;
    config.parallel_for_user = game->jobs;
    check(rg_scene_create(&config, &game->scene));
    make_shapes(game, &config.allocator);

    for (int i = 0; i < WALLS; i++) {
        rg_pose pose = rg_pose_at(random_between(game, 0, ARENA), random_between(game, 0, ARENA), 0);
        pose.linear[0] = random_between(game, 0.3f, 8);
        pose.linear[4] = random_between(game, 0.3f, 8);
        pose.linear[8] = 4;
        rg_object wall;
        check(rg_scene_insert(game->scene, game->block, &pose, &wall));
        check(rg_scene_set_mask(game->scene, wall, MASK_SCENERY));
    }
    for (int i = 0; i < GATES; i++) {
        rg_pose pose = gate_pose(i, 0);
        check(rg_scene_insert(game->scene, game->gate, &pose, &game->gates[i]));
        check(rg_scene_set_mask(game->scene, game->gates[i], MASK_SCENERY));
    }
}

/* Where the agents are, for raygrid to read. */
static rg_pose_views agent_poses(struct agent *agents) {
    rg_pose_views poses = {.size = sizeof poses};
    poses.position = rg_input3_packed(agents[0].position, sizeof *agents, RG_F32);
    return poses;
}

static void insert_agents(struct game *game, struct agent *agents, uint64_t count) {
    static const uint32_t mask = MASK_AGENT;
    rg_pose_views poses = agent_poses(agents);
    rg_insert_views views = {.size = sizeof views, .shapes = &game->ball, .poses = &poses};
    views.mask = (rg_input){&mask, 0, RG_U32}; /* stride 0: the same for all */
    check(rg_scene_insert_many(game->scene, &views, count, &(rg_output){&agents[0].object, sizeof *agents, RG_U64}));
}

static void move_everything(struct game *game, double now, float step) {
    for (int i = 0; i < AGENTS; i++) {
        struct agent *agent = &game->agents[i];
        for (int k = 0; k < 2; k++) {
            agent->position[k] += step * agent->velocity[k];
            if (agent->position[k] < 0) agent->velocity[k] = fabsf(agent->velocity[k]);
            if (agent->position[k] > ARENA) agent->velocity[k] = -fabsf(agent->velocity[k]);
        }
    }
    rg_input objects = {&game->agents[0].object, sizeof *game->agents, RG_U64};
    rg_pose_views poses = agent_poses(game->agents);
    check(rg_scene_move_many(game->scene, &objects, &poses, AGENTS));
    for (int i = 0; i < GATES; i++) {
        rg_pose pose = gate_pose(i, now + i);
        check(rg_scene_move(game->scene, game->gates[i], &pose));
    }
}

/* Sets `hidden` of each agent; returns how many see their target. Agents do not hide one another. */
static int look(struct game *game) {
    static const double t_max = 1; /* the direction is the whole way, so the target is at t = 1 */
    static const uint32_t mask = MASK_SCENERY;
    struct agent *agents = game->agents;
    ptrdiff_t stride = sizeof *agents;
    for (int i = 0; i < AGENTS; i++) {
        const struct agent *target = &agents[agents[i].target];
        for (int k = 0; k < 3; k++) agents[i].to_target[k] = target->position[k] - agents[i].position[k];
        if (target == &agents[i]) agents[i].to_target[2] = 1; /* up: a direction must not be zero */
    }
    rg_ray_views rays = {.size = sizeof rays};
    rays.origin = rg_input3_packed(agents[0].position, stride, RG_F32);
    rays.direction = rg_input3_packed(agents[0].to_target, stride, RG_F32);
    rays.t_max = (rg_input){&t_max, 0, RG_F64};
    rays.mask = (rg_input){&mask, 0, RG_U32};
    rg_output hidden = {&agents[0].hidden, stride, RG_U8};
    check(rg_scene_occluded_views(game->scene, NULL, &rays, &hidden, AGENTS));

    int seeing = 0;
    for (int i = 0; i < AGENTS; i++) seeing += !agents[i].hidden;
    return seeing;
}

/* One ray, from a tower in a corner. Whoever it hits is taken out and starts anew, as another object. */
static void shoot(struct game *game) {
    double from[3] = {-1, -1, 10};
    double at[3] = {random_between(game, 0, ARENA / 4), random_between(game, 0, ARENA / 4), 1};
    rg_ray ray = rg_ray_from(from, (double[]){at[0] - from[0], at[1] - from[1], at[2] - from[2]});
    rg_hit hit;
    check(rg_scene_trace(game->scene, &ray, &hit, 1));
    for (int i = 0; i < AGENTS; i++) {
        struct agent *agent = &game->agents[i];
        if (hit.object == RG_NO_OBJECT || agent->object != hit.object) continue;
        check(rg_scene_remove(game->scene, agent->object));
        agent_start(game, agent);
        insert_agents(game, agent, 1);
        game->shots_that_hit++;
    }
}

static double milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static void play(struct game *game, int frames) {
    const float step = 1.0f / 60;
    double moving = 0, looking = 0;
    for (int frame = 1; frame <= frames; frame++) {
        double start = milliseconds();
        move_everything(game, frame * step, step);
        double moved = milliseconds();
        int seeing = look(game);
        double end = milliseconds();
        for (int i = 0; i < 20; i++) shoot(game);
        moving += moved - start;
        looking += end - moved;
        if (frame % 20 == 0) {
            printf("frame %3d: moving %.2f ms, looking %.2f ms, %d of %d agents see their target\n", frame,
                   moved - start, end - moved, seeing, AGENTS);
        }
    }
    printf("on average: moving %.2f ms, looking %.2f ms, a frame; %u shots hit\n", moving / frames, looking / frames,
           game->shots_that_hit);
}

int main(int argc, char **argv) {
    static struct game game = {.memory = {.lock = PTHREAD_MUTEX_INITIALIZER}, .random = 1};
    int frames = argc > 1 ? atoi(argv[1]) : 100;
    if (frames < 1) frames = 1;
    game.jobs = jobs_start(3);
    make_scene(&game);
    for (int i = 0; i < AGENTS; i++) agent_start(&game, &game.agents[i]);
    insert_agents(&game, game.agents, AGENTS);

    play(&game, frames);

    rg_shape_release(&game.ball);
    rg_shape_release(&game.block);
    rg_shape_release(&game.gate);
    check(rg_scene_destroy(&game.scene));
    jobs_end(game.jobs);
    printf("memory: %zu bytes at most, %zu bytes not given back\n", game.memory.peak, game.memory.used);
    return game.memory.used == 0 ? 0 : 1;
}
