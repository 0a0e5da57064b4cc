/* SPDX-License-Identifier: MIT */
/* sphere.c, box.c and capsule.c, which share intersect.h. */
#include "intersect.h"
#include "unit.h"
#include "vec.h"

#include <string.h>

static rgi_local_ray ray_at(double ox, double oy, double oz, double dx, double dy, double dz) {
    rgi_local_ray ray;
    memset(&ray, 0, sizeof ray);
    rgi_set(ray.origin, ox, oy, oz);
    rgi_set(ray.direction, dx, dy, dz);
    ray.t_max = INFINITY;
    ray.sides = RGI_FRONT | RGI_BACK;
    return ray;
}

START_TEST(sphere_roots_are_exact_where_the_numbers_are) {
    rgi_candidate c;
    rgi_local_ray on = ray_at(3, 4, 0, -1, 0, 0), tangent = ray_at(5, -7, 0, 0, 2, 0);
    ck_assert(rgi_sphere_intersect(5, &on, &c) && c.t == 0);
    on.t_min = 0x1p-1000;
    ck_assert(rgi_sphere_intersect(5, &on, &c) && c.t == 6);
    ck_assert(rgi_sphere_intersect(5, &tangent, &c) && c.t == 3.5);
    tangent.origin[0] = nextafter(5, 6);
    ck_assert(!rgi_sphere_intersect(5, &tangent, &c));
    rgi_local_ray centre = ray_at(0, 0, 0, 0, 0, 0.5);
    ck_assert(rgi_sphere_intersect(5, &centre, &c) && c.t == 10 && c.normal[2] == 5);
}
END_TEST

/*
 * Rays that start near the foot of a tangent, as those from far away do once their origin was moved: the chord is at
 * most what rounding the origin makes of it, sqrt(2^-50), and so far may a hit be from the foot, no farther.
 */
START_TEST(tangents_are_hit_near_their_foot) {
    int hits = 0;
    for (int round = 0; round < 200000; round++) {
        double foot[3], guide[3], way[3];
        rgi_candidate c;
        for (int i = 0; i < 3; i++) foot[i] = unit_random() - 0.5, guide[i] = unit_random() - 0.5;
        double length = sqrt(rgi_dot(foot, foot));
        for (int i = 0; i < 3; i++) foot[i] /= length;
        rgi_cross(foot, guide, way);
        rgi_local_ray ray = ray_at(foot[0], foot[1], foot[2], way[0], way[1], way[2]);
        ray.t_min = -INFINITY;
        if (!rgi_sphere_intersect(1, &ray, &c)) continue;
        hits++;
        MUST(fabs(c.t) * sqrt(rgi_dot(way, way)) < 0x1p-24);
        ray.sides = RGI_BACK;
        MUST(rgi_sphere_intersect(1, &ray, &c) && fabs(c.t) * sqrt(rgi_dot(way, way)) < 0x1p-24);
    }
    ck_assert_int_gt(hits, 50000);
}
END_TEST

START_TEST(shift_counts_in_range_and_result) {
    rgi_candidate c;
    rgi_local_ray ray = ray_at(-3, 0, 0, 1, 0, 0);
    ray.shift = 100;
    ck_assert(rgi_sphere_intersect(1, &ray, &c) && c.t == 102);
    ray.t_min = 103;
    ck_assert(rgi_sphere_intersect(1, &ray, &c) && c.t == 104);
    ray.t_max = 103.5;
    ck_assert(!rgi_sphere_intersect(1, &ray, &c));
}
END_TEST

START_TEST(sides) {
    const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
    rgi_capsule capsule;
    rgi_capsule_init(&capsule, (double[]){0, 0, -1}, (double[]){0, 0, 1}, 1);
    for (int shape = 0; shape < 3; shape++) {
        rgi_candidate c;
        for (uint32_t s = 1; s <= 3; s++) {
            rgi_local_ray ray = ray_at(-4, 0, 0, 1, 0, 0);
            ray.sides = s;
            bool hit = shape == 0   ? rgi_sphere_intersect(1, &ray, &c)
                       : shape == 1 ? rgi_box_intersect(lo, hi, &ray, &c)
                                    : rgi_capsule_intersect(&capsule, &ray, &c);
            ck_assert(hit && c.t == (s == RGI_BACK ? 5 : 3));
            ck_assert(c.normal[0] == (s == RGI_BACK ? 1 : -1));
        }
    }
}
END_TEST

/* Every edge and corner of a box, met exactly, from both signs of zero. */
START_TEST(box_edges_and_corners_belong_to_it) {
    const double lo[3] = {-1, -2, -3}, hi[3] = {1, 2, 3};
    for (int axis = 0; axis < 3; axis++) {
        for (int corner = 0; corner < 4; corner++) {
            for (int signs = 0; signs < 4; signs++) {
                rgi_candidate c;
                rgi_local_ray ray = ray_at(0, 0, 0, 0, 0, 0);
                int u = (axis + 1) % 3, v = (axis + 2) % 3;
                ray.origin[u] = corner & 1 ? hi[u] : lo[u];
                ray.origin[v] = corner & 2 ? hi[v] : lo[v];
                ray.origin[axis] = -10;
                ray.direction[axis] = 1;
                ray.direction[u] = signs & 1 ? 0.0 : -0.0;
                ray.direction[v] = signs & 2 ? 0.0 : -0.0;
                ck_assert(rgi_box_intersect(lo, hi, &ray, &c));
                ck_assert(c.t == 10 + lo[axis] && c.primitive == 2 * (uint32_t)axis);
                ray.origin[u] = corner & 1 ? nextafter(hi[u], 9) : nextafter(lo[u], -9);
                ck_assert(!rgi_box_intersect(lo, hi, &ray, &c));
            }
        }
    }
    rgi_candidate c;
    rgi_local_ray diagonal = ray_at(-3, -6, -9, 1, 2, 3);
    ck_assert(rgi_box_intersect(lo, hi, &diagonal, &c) && c.t == 2 && c.primitive == 0);
    diagonal.t_min = 2.5;
    ck_assert(rgi_box_intersect(lo, hi, &diagonal, &c) && c.t == 4 && c.primitive == 1);
}
END_TEST

START_TEST(infinite_boxes) {
    const double lo[3] = {-INFINITY, -1, -INFINITY}, hi[3] = {INFINITY, 0, INFINITY};
    rgi_candidate c;
    rgi_local_ray down = ray_at(5, 3, 7, 1, -1, 0), along = ray_at(5, -0.5, 7, 1, 0, 0),
                  above = ray_at(5, 1, 7, 1, 0, 0);
    ck_assert(rgi_box_intersect(lo, hi, &down, &c) && c.t == 3 && c.primitive == 3);
    ck_assert(!rgi_box_intersect(lo, hi, &along, &c));
    ck_assert(!rgi_box_intersect(lo, hi, &above, &c));
}
END_TEST

/* Distance from a point to the capsule's segment. */
static double to_axis(const rgi_capsule *c, const double p[3]) {
    double m[3];
    rgi_sub(p, c->a, m);
    double along = rgi_min(rgi_max(rgi_dot(m, c->axis), 0), c->length);
    rgi_along(m, -along, c->axis, m);
    return sqrt(rgi_dot(m, m));
}

START_TEST(capsule_hits_lie_on_it_and_misses_pass_it) {
    int hits = 0;
    for (int i = 0; i < 20000; i++) {
        rgi_capsule capsule;
        rgi_candidate c;
        double a[3], b[3];
        for (int k = 0; k < 3; k++) {
            a[k] = 2 * unit_random() - 1;
            b[k] = i % 10 ? 2 * unit_random() - 1 : a[k];
        }
        rgi_capsule_init(&capsule, a, b, 0.05 + 0.5 * unit_random());
        rgi_local_ray ray = ray_at(6 * unit_random() - 3, 6 * unit_random() - 3, 6 * unit_random() - 3, 0, 0, 0);
        for (int k = 0; k < 3; k++)
            ray.direction[k] = i % 7 ? a[k] + unit_random() - 0.5 - ray.origin[k] : capsule.axis[k];
        bool inside = to_axis(&capsule, ray.origin) < capsule.radius;
        bool hit = rgi_capsule_intersect(&capsule, &ray, &c);
        double p[3], end = hit ? c.t : 4;
        hits += hit;
        ck_assert(!inside || hit);
        for (int s = 1; s < 40; s++) {
            rgi_along(ray.origin, end * s / 40, ray.direction, p);
            double gap = to_axis(&capsule, p) - capsule.radius;
            ck_assert(inside ? gap < 1e-12 : gap > -1e-12);
        }
        if (!hit) continue;
        rgi_along(ray.origin, c.t, ray.direction, p);
        ck_assert_double_le(fabs(to_axis(&capsule, p) - capsule.radius), 1e-12);
        ck_assert_double_le(fabs(sqrt(rgi_dot(c.normal, c.normal)) - capsule.radius), 1e-12);
    }
    ck_assert_int_gt(hits, 1000);
}
END_TEST

static bool beyond(void *context, const rgi_candidate *c) {
    return c->t > *(double *)context;
}

START_TEST(filters_let_the_far_side_through) {
    rgi_candidate c;
    double t = 3.5;
    rgi_local_ray ray = ray_at(-4, 0, 0, 1, 0, 0);
    ray.accept = beyond;
    ray.context = &t;
    ck_assert(rgi_sphere_intersect(1, &ray, &c) && c.t == 5);
    t = 6;
    ck_assert(!rgi_sphere_intersect(1, &ray, &c));
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("intersect");
    TCase *tests = tcase_create("intersect");
    tcase_add_test(tests, sphere_roots_are_exact_where_the_numbers_are);
    tcase_add_test(tests, tangents_are_hit_near_their_foot);
    tcase_add_test(tests, shift_counts_in_range_and_result);
    tcase_add_test(tests, sides);
    tcase_add_test(tests, box_edges_and_corners_belong_to_it);
    tcase_add_test(tests, infinite_boxes);
    tcase_add_test(tests, capsule_hits_lie_on_it_and_misses_pass_it);
    tcase_add_test(tests, filters_let_the_far_side_through);
    suite_add_tcase(suite, tests);
    return suite;
}
