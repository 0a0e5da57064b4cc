/* SPDX-License-Identifier: MIT */
#include "exact.h"

#include "brute.h"

#include <math.h>
#include <reference.h>
#include <stdlib.h>

struct exact {
    const struct bench_scene *bodies;
    double (*positions)[3];
    reference_scene *reference; /* holds no objects between calls */
    const reference_shape *shapes[BENCH_SHAPES];
    uint32_t *near; /* the bodies that a ray may meet */
    uint32_t near_count;
};

struct truth {
    uint32_t ray;
    uint32_t body; /* UINT32_MAX: a miss */
    double t;
};

struct exact_sample {
    struct exact *exact;
    const struct bench_rays *rays;
    uint32_t count;
    struct truth *truths;
};

enum { NOBODY = -1, LEAST_SAMPLES = 64, MOST_SAMPLES = 2000 };

struct exact *exact_create(const struct bench_scene *bodies, double (*positions)[3]) {
    struct exact *exact = bench_allocate(1, sizeof *exact);
    exact->bodies = bodies;
    exact->positions = positions ? positions : bodies->positions;
    exact->reference = reference_create();
    for (int s = 0; s < bodies->shape_count; s++) {
        exact->shapes[s] = brute_shape(exact->reference, &bodies->shapes[s]);
    }
    exact->near = bench_allocate(bodies->count, sizeof *exact->near);
    return exact;
}

void exact_destroy(struct exact *exact) {
    if (!exact) return;
    reference_destroy(exact->reference);
    free(exact->near);
    free(exact);
}

/* ---------------------------------------------------------------------------------- one ray, all bodies */

/* Finds the bodies whose sphere, made larger by far more than double or float loses, the ray passes through. */
static void find_near(struct exact *exact, const rg_ray *ray) {
    const double *o = ray->origin, *d = ray->direction;
    double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    exact->near_count = 0;
    for (uint32_t i = 0; i < exact->bodies->count; i++) {
        const double *p = exact->positions[i];
        const double away[3] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]};
        double foot = (away[0] * d[0] + away[1] * d[1] + away[2] * d[2]) / dd, square = 0;
        foot = foot < 0 ? 0 : foot;
        for (int k = 0; k < 3; k++) square += (away[k] - foot * d[k]) * (away[k] - foot * d[k]);
        double reach = 1.001 * bench_reach(exact->bodies, i) + 1e-5 * (1 + foot * sqrt(dd));
        if (square <= reach * reach) exact->near[exact->near_count++] = i;
    }
}

/* The slot is the body; any generation will do. */
static rg_object id_of(uint32_t body) {
    return (rg_object)1 << 32 | body;
}

static double distance_to(const struct exact *exact, const rg_ray *ray, uint32_t body) {
    double square = 0;
    for (int k = 0; k < 3; k++) square += pow(exact->positions[body][k] - ray->origin[k], 2);
    return sqrt(square);
}

/* How much of its radius a body may seem larger or smaller. */
static double tolerance_of(const struct exact *exact, const rg_ray *ray, uint32_t body,
                           enum exact_tolerance tolerance) {
    double radius = bench_reach(exact->bodies, body), distance = distance_to(exact, ray, body);
    if (tolerance == EXACT_FLOAT) return 0x1p-22 * (distance + radius) / radius;
    return 0x1p-40 + 0x1p-50 * distance / radius;
}

static void insert(struct exact *exact, const rg_ray *ray, uint32_t body, int sign, enum exact_tolerance tolerance) {
    const struct bench_scene *bodies = exact->bodies;
    rg_pose pose = bench_pose(bodies, body);
    for (int k = 0; k < 3; k++) pose.position[k] = exact->positions[body][k];
    pose.scale *= 1 + sign * tolerance_of(exact, ray, body, tolerance);
    if (pose.scale <= 0) return;
    const reference_shape *shape = exact->shapes[bodies->shape_of ? bodies->shape_of[body] : 0];
    reference_insert(exact->reference, id_of(body), shape, &pose, UINT32_MAX);
}

/* The closest hit among the near bodies, made smaller (sign -1), larger (1), or as they are; or of `only` one. */
static struct truth find_hit(struct exact *exact, const rg_ray *ray, int only, int sign,
                             enum exact_tolerance tolerance) {
    if (only != NOBODY) {
        insert(exact, ray, (uint32_t)only, sign, tolerance);
    } else {
        for (uint32_t i = 0; i < exact->near_count; i++) insert(exact, ray, exact->near[i], sign, tolerance);
    }
    reference_hit hit;
    struct truth truth = {0, UINT32_MAX, INFINITY};
    if (reference_trace(exact->reference, ray, RG_CULL_NONE, &hit)) {
        truth.body = RG_OBJECT_SLOT(hit.object);
        truth.t = (double)hit.t;
    }
    while (reference_count(exact->reference)) {
        reference_remove(exact->reference, reference_object(exact->reference, 0));
    }
    return truth;
}

/* ------------------------------------------------------------------------------------------------ samples */

static double triangles_of(const struct bench_scene *bodies) {
    double most = 0;
    for (int s = 0; s < bodies->shape_count; s++) {
        if (bodies->shapes[s].mesh) most = fmax(most, bodies->shapes[s].mesh->triangle_count);
    }
    return most;
}

/* Anywhere in the `part`th of so many equal parts: every so many rays of a picture could all be of one column. */
static uint32_t choose_ray(const struct bench_rays *rays, uint32_t part, uint32_t parts, uint64_t *random) {
    uint64_t first = (uint64_t)part * rays->count / parts, end = (uint64_t)(part + 1) * rays->count / parts;
    return (uint32_t)first + (uint32_t)((double)(end - first) * bench_random(random));
}

struct exact_sample *exact_sample_create(struct exact *exact, const struct bench_rays *rays, double effort) {
    /* Each near body is tested in full, some ten a ray; a triangle in long double costs as much as ten near tests. */
    double near = fmin(exact->bodies->count, 10);
    double each = exact->bodies->count + 1000 + near * 10 * triangles_of(exact->bodies);
    uint64_t random = 7;
    struct exact_sample *sample = bench_allocate(1, sizeof *sample);
    sample->exact = exact;
    sample->rays = rays;
    sample->count = (uint32_t)fmin(fmax(effort / each, LEAST_SAMPLES), MOST_SAMPLES);
    if (sample->count > rays->count) sample->count = rays->count;
    sample->truths = bench_allocate(sample->count, sizeof *sample->truths);
    for (uint32_t i = 0; i < sample->count; i++) {
        uint32_t which = choose_ray(rays, i, sample->count, &random);
        rg_ray ray = bench_ray(rays, which);
        find_near(exact, &ray);
        sample->truths[i] = find_hit(exact, &ray, NOBODY, 0, EXACT_PROMISED);
        sample->truths[i].ray = which;
    }
    return sample;
}

void exact_sample_destroy(struct exact_sample *sample) {
    if (!sample) return;
    free(sample->truths);
    free(sample);
}

static double length_of(const double d[3]) {
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* How far a t may be off where a ray grazes a body of radius R that may be larger by `tolerance` of it: the chord
 * that such a rim has is 2 sqrt(2 tolerance) R. A float's own rounding of t comes to that. */
static double allowed_t(const rg_ray *ray, double t, double radius, double tolerance) {
    return (4 * sqrt(2 * tolerance) + 2 * tolerance) * radius / length_of(ray->direction) + 0x1p-23 * t;
}

/* Whether the answer is that of some ray within the tolerance. */
static bool within(struct exact *exact, const rg_ray *ray, uint32_t body, double t, enum exact_tolerance tolerance) {
    find_near(exact, ray);
    struct truth smaller = find_hit(exact, ray, NOBODY, -1, tolerance);
    if (body == UINT32_MAX) return smaller.body == UINT32_MAX;
    struct truth larger = find_hit(exact, ray, (int)body, 1, tolerance);
    double slack = allowed_t(ray, t, bench_reach(exact->bodies, body), tolerance_of(exact, ray, body, tolerance));
    return larger.body == body && t >= larger.t - slack && t <= smaller.t + slack;
}

struct exact_error exact_judge(struct exact_sample *sample, const struct bench_answers *answers, exact_body *body_of,
                               const void *side, enum exact_tolerance tolerance) {
    struct exact *exact = sample->exact;
    struct exact_error error = {0, 0, 0};
    for (uint32_t i = 0; i < sample->count; i++, error.checked++) {
        const struct truth *truth = &sample->truths[i];
        rg_ray ray = bench_ray(sample->rays, truth->ray);
        if (sample->rays->any) {
            bool hit = answers->occluded[truth->ray];
            if (hit == (truth->body != UINT32_MAX)) continue;
            find_near(exact, &ray);
            if ((find_hit(exact, &ray, NOBODY, hit ? 1 : -1, tolerance).body != UINT32_MAX) != hit) error.wrong++;
            continue;
        }
        uint32_t body = body_of(side, answers->id[truth->ray]);
        double t = (double)answers->t[truth->ray];
        if (body == UINT32_MAX && truth->body == UINT32_MAX) {
            if (t < INFINITY) error.wrong++;
            continue;
        }
        double radius = body == UINT32_MAX ? 0 : bench_reach(exact->bodies, body);
        if (body != truth->body ||
            !(fabs(t - truth->t) <= allowed_t(&ray, truth->t, radius, tolerance_of(exact, &ray, body, tolerance)))) {
            if (!within(exact, &ray, body, t, tolerance)) error.wrong++;
        } else {
            double length = length_of(ray.direction);
            error.worst_t = fmax(error.worst_t, length * fabs(t - truth->t) / fmax(length * truth->t, radius));
        }
    }
    return error;
}

void exact_spoil(const struct exact_sample *sample, const struct bench_answers *answers) {
    for (uint32_t i = 0; i < sample->count; i++) {
        uint32_t ray = sample->truths[i].ray;
        if (sample->rays->any) {
            answers->occluded[ray] ^= 1;
        } else if (sample->truths[i].body == UINT32_MAX) {
            answers->t[ray] = 1;
        } else if (i % 2) {
            answers->t[ray] *= 1.25f;
        } else {
            answers->id[ray] ^= 1;
        }
    }
}
