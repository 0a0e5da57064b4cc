/* SPDX-License-Identifier: MIT */
#include "sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The same bodies around another origin: positions are differences in double, as a careful host has them. */
static struct bench_scene *moved(const struct bench_scene *bodies, const double origin[3]) {
    struct bench_scene *copy = bench_allocate(1, sizeof *copy);
    *copy = *bodies;
    copy->positions = bench_allocate(bodies->count, sizeof *copy->positions);
    for (uint32_t i = 0; i < bodies->count; i++) {
        for (int k = 0; k < 3; k++) copy->positions[i][k] = bodies->positions[i][k] - origin[k];
    }
    return copy;
}

static struct bench_rays *in_floats(const rg_ray *rays, uint32_t count, const double origin[3]) {
    struct bench_rays *floats = bench_rays_create("rays", count, false, false);
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            floats->origin[k][i] = (float)(rays[i].origin[k] - origin[k]);
            floats->direction[k][i] = (float)rays[i].direction[k];
        }
    }
    return floats;
}

static void add_own(struct side *side, const struct world *world, uint32_t count, rg_grid_kind kind) {
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    *side = (struct side){.name = own_kind_name(kind), .own = own_create(world->bodies, 1), .seconds = INFINITY};
    side->t = bench_allocate(count, sizeof *side->t);
    side->answers = bench_answers_create(count);
    own_check(rg_grid_configure(side->own->scene, RG_GRID_OF_SCENE, &grid));
}

static void add_peer(struct side *side, const char *name, const struct world *world, const rg_ray *rays,
                     uint32_t count, const struct peer_choice *choice, bool move) {
    static const double NOWHERE[3] = {0, 0, 0};
    *side = (struct side){.name = name, .seconds = INFINITY};
    if (move) side->bodies = moved(world->bodies, world->offset);
    side->peer = peer_create(choice, move ? side->bodies : world->bodies, PEER_MEDIUM);
    side->floats = in_floats(rays, count, move ? world->offset : NOWHERE);
    side->answers = bench_answers_create(count);
    for (int k = 0; k < 3; k++) side->answers.normal[k] = bench_allocate(count, sizeof(float));
    side->way = peer_best_way(side->peer, side->floats, false, &side->answers, NULL);
}

int sides_create(struct side sides[SIDES], const struct world *world, const rg_ray *rays, uint32_t count,
                 const struct embree_api *api) {
    const struct peer_choice robust = {api, true}, fast = {api, false};
    add_own(&sides[0], world, count, RG_GRID_LOOSE);
    add_own(&sides[1], world, count, RG_GRID_UNIFORM);
    add_own(&sides[2], world, count, RG_GRID_HIERARCHICAL);
    if (!api) return 3;
    add_peer(&sides[3], "peer, robust", world, rays, count, &robust, false);
    add_peer(&sides[4], "peer, fast", world, rays, count, &fast, false);
    if (world->offset[0] == 0) return 5;
    add_peer(&sides[5], "peer, robust, moved by its host", world, rays, count, &robust, true);
    return 6;
}

void sides_destroy(struct side *sides, int count) {
    for (int s = 0; s < count; s++) {
        own_destroy(sides[s].own);
        peer_destroy(sides[s].peer);
        if (sides[s].bodies) free(sides[s].bodies->positions);
        free(sides[s].bodies);
        bench_rays_destroy(sides[s].floats);
        bench_answers_destroy(&sides[s].answers);
        free(sides[s].t);
    }
}

static void trace_own(struct side *side, const rg_ray *rays, uint32_t count) {
    const ptrdiff_t stride = sizeof *rays;
    rg_ray_views views = {.size = sizeof views};
    rg_hit_views hits = {.size = sizeof hits};
    views.origin = rg_input3_packed(rays->origin, stride, RG_F64);
    views.direction = rg_input3_packed(rays->direction, stride, RG_F64);
    hits.t = (rg_output){side->t, sizeof *side->t, RG_F64};
    hits.object = (rg_output){side->answers.id, sizeof *side->answers.id, RG_U64};
    own_check(rg_scene_trace_views(side->own->scene, NULL, &views, &hits, count));
}

void side_time(struct side *side, const rg_ray *rays, uint32_t count) {
    struct bench_answers answers = side->answers;
    for (int k = 0; k < 3; k++) answers.normal[k] = NULL;
    double before = bench_thread_seconds();
    if (side->own) {
        trace_own(side, rays, count);
    } else {
        peer_trace(side->peer, side->floats, side->way, &answers);
    }
    side->seconds = fmin(side->seconds, bench_thread_seconds() - before);
}

/* The peer's normals of instances are those of their mesh: a host turns them. The bodies here are rotated and scaled
 * alike in all directions, so that their linear part does it. */
static void turn_normal(const struct bench_scene *bodies, uint32_t body, const float from[3], float out[3]) {
    double turned[3] = {(double)from[0], (double)from[1], (double)from[2]}, length = 0;
    if (bodies->linears && bench_shape_of(bodies, body)->kind == RG_SHAPE_MESH) {
        for (int r = 0; r < 3; r++) {
            const float *row = &bodies->linears[body][3 * r];
            turned[r] = (double)row[0] * (double)from[0] + (double)row[1] * (double)from[1] +
                        (double)row[2] * (double)from[2];
        }
    }
    for (int k = 0; k < 3; k++) length += turned[k] * turned[k];
    for (int k = 0; k < 3; k++) out[k] = (float)(turned[k] / sqrt(length));
}

void side_answer(struct side *side, const struct side *own, const rg_ray *rays, rg_hit *hits, uint32_t count) {
    if (side->own) {
        own_check(rg_scene_trace(side->own->scene, rays, hits, count));
        return;
    }
    const struct bench_answers *a = &side->answers;
    peer_trace(side->peer, side->floats, side->way, a);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t body = peer_body(side->peer, a->id[i]);
        hits[i] = (rg_hit){.t = INFINITY, .object = RG_NO_OBJECT, .primitive = RG_NO_PRIMITIVE};
        if (body == UINT32_MAX) continue;
        const float normal[3] = {a->normal[0][i], a->normal[1][i], a->normal[2][i]};
        hits[i] = (rg_hit){.t = (double)a->t[i], .object = own->own->objects[body]};
        turn_normal(own->own->bodies, body, normal, hits[i].normal);
    }
}
