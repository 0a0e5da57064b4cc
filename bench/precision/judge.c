/* SPDX-License-Identifier: MIT */
#include "judge.h"

#include "brute.h"
#include "measure.h"

#include <math.h>
#include <stdlib.h>

struct judge {
    const struct bench_scene *bodies;
    const rg_object *ids;
    reference_scene *all, *near;
    const reference_shape *shapes[BENCH_SHAPES];
    double *position[3], *reach;
    double widening; /* of balls, in parts of the distance squared */
    double margin;   /* the same, as it is */
    uint8_t *meets;  /* of each body, for the ray at hand */
};

struct judge *judge_create(const struct bench_scene *bodies, const rg_object *ids, const reference_bound *bound) {
    struct judge *judge = bench_allocate(1, sizeof *judge);
    judge->bodies = bodies;
    judge->ids = ids;
    judge->all = reference_create();
    judge->near = reference_create();
    double lost = 0x1p-46 + (bound ? 4 * bound->way : 0);
    judge->widening = 2 * 257 * lost * lost;
    judge->margin = bound ? 2 * 257 * 16 * bound->length * bound->length : 0;
    if (bound) reference_set_bound(judge->all, bound);
    for (int s = 0; s < bodies->shape_count; s++) {
        judge->shapes[s] = brute_shape(judge->all, &bodies->shapes[s]);
    }
    for (int k = 0; k < 3; k++) judge->position[k] = bench_allocate(bodies->count, sizeof(double));
    judge->reach = bench_allocate(bodies->count, sizeof(double));
    judge->meets = bench_allocate(bodies->count, 1);
    for (uint32_t i = 0; i < bodies->count; i++) {
        const rg_pose pose = bench_pose(bodies, i);
        reference_insert(judge->all, ids[i], judge->shapes[bodies->shape_of ? bodies->shape_of[i] : 0], &pose,
                         UINT32_MAX);
        for (int k = 0; k < 3; k++) judge->position[k][i] = pose.position[k];
        judge->reach[i] = bench_reach(bodies, i);
    }
    return judge;
}

void judge_destroy(struct judge *judge) {
    if (!judge) return;
    reference_destroy(judge->near);
    reference_destroy(judge->all);
    for (int k = 0; k < 3; k++) free(judge->position[k]);
    free(judge->reach);
    free(judge->meets);
    free(judge);
}

/*
 * Whether the line comes within (1 + 2^-8) r + s of each body's position: linear parts of floats are not quite
 * rotations, s is four times what the bound allows of the distance and beside it, and what doubles lose. For
 * (r + s)^2 stands (1 + 2^-8) r^2 + 257 s^2, which is never less, and likewise for the two parts of s. No branch, so
 * that the compiler takes several bodies at once.
 */
static void find_met(const struct judge *judge, const rg_ray *ray) {
    const double *o = ray->origin, *d = ray->direction;
    const double *px = judge->position[0], *py = judge->position[1], *pz = judge->position[2];
    const double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const double widening = judge->widening, margin = judge->margin;
    for (uint32_t i = 0; i < judge->bodies->count; i++) {
        double x = px[i] - o[0], y = py[i] - o[1], z = pz[i] - o[2];
        double cx = y * d[2] - z * d[1], cy = z * d[0] - x * d[2], cz = x * d[1] - y * d[0];
        double away = x * x + y * y + z * z, reach = judge->reach[i];
        judge->meets[i] = cx * cx + cy * cy + cz * cz <= dd * (1.012 * (reach * reach) + widening * away + margin);
    }
}

const reference_scene *judge_near(struct judge *judge, const rg_ray *ray) {
    reference_clear(judge->near);
    find_met(judge, ray);
    for (uint32_t i = 0; i < judge->bodies->count; i++) {
        if (judge->meets[i]) reference_share(judge->near, judge->all, judge->ids[i]);
    }
    return judge->near;
}
