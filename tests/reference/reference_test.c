/* SPDX-License-Identifier: MIT */
/* reference_test.c: the reference against values worked out by hand. */
#include "reference.h"

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

static reference_scene *scene;
static const rg_object FIRST = (rg_object)1 << 32, SECOND = (rg_object)1 << 32 | 1;

static void setup(void) {
    scene = reference_create();
}
static void teardown(void) {
    reference_destroy(scene);
}

static rg_pose pose_at(double x, double y, double z) {
    return (rg_pose){{x, y, z}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1};
}

static rg_ray ray_of(double ox, double oy, double oz, double dx, double dy, double dz) {
    return (rg_ray){.origin = {ox, oy, oz}, .direction = {dx, dy, dz}, .t_max = HUGE_VAL, .mask = UINT32_MAX};
}

static void insert(rg_object id, const reference_shape *shape, rg_pose pose) {
    reference_insert(scene, id, shape, &pose, UINT32_MAX);
}

static reference_hit trace(rg_ray ray, rg_cull cull) {
    reference_hit hit;
    ck_assert(reference_trace(scene, &ray, cull, &hit) == (hit.object != RG_NO_OBJECT));
    ck_assert(reference_occluded(scene, &ray, cull) == (hit.object != RG_NO_OBJECT));
    return hit;
}

static void assert_close(long double got, long double want) {
    ck_assert_ldouble_eq_tol(got, want, 0x1p-60L * fmaxl(1, fabsl(want)));
}

static void assert_normal(const reference_hit *hit, long double x, long double y, long double z) {
    assert_close(hit->normal[0], x);
    assert_close(hit->normal[1], y);
    assert_close(hit->normal[2], z);
}

/* A hit as the library would report it. */
static rg_hit as_reported(const rg_ray *ray, const reference_hit *want) {
    rg_hit got = {.t = (double)want->t, .object = want->object, .primitive = want->primitive};
    got.u = (float)want->u;
    got.v = (float)want->v;
    for (int i = 0; i < 3; i++) {
        got.normal[i] = (float)want->normal[i];
        if (want->object != RG_NO_OBJECT) got.position[i] = (double)(ray->origin[i] + want->t * ray->direction[i]);
    }
    return got;
}

START_TEST(sphere_from_outside_and_inside) {
    insert(FIRST, reference_sphere(scene, 1), pose_at(10, 0, 0));
    reference_hit hit = trace(ray_of(0, 0, 0, 2, 0, 0), RG_CULL_NONE);
    ck_assert(hit.t == 4.5L && hit.object == FIRST && hit.primitive == 0 && hit.cosine == -1);
    assert_normal(&hit, -1, 0, 0);
    hit = trace(ray_of(10, 0, 0, 0, 0.5, 0), RG_CULL_NONE);
    ck_assert(hit.t == 2 && hit.cosine == 1);
    assert_normal(&hit, 0, 1, 0);
    ck_assert(trace(ray_of(10, 0, 0, 0, 0.5, 0), RG_CULL_BACK).object == RG_NO_OBJECT);
    ck_assert(trace(ray_of(0, 0, 0, 1, 0, 0), RG_CULL_BACK).t == 9);
    ck_assert(trace(ray_of(0, 0, 0, 1, 0, 0), RG_CULL_FRONT).t == 11);
}
END_TEST

START_TEST(range_is_inclusive) {
    insert(FIRST, reference_sphere(scene, 1), pose_at(0, 0, 0));
    rg_ray ray = ray_of(-1, 0, 0, 1, 0, 0);
    ck_assert(trace(ray, RG_CULL_NONE).t == 0);
    ray.t_min = DBL_MIN;
    ck_assert(trace(ray, RG_CULL_NONE).t == 2);
    ray.t_max = 2;
    ck_assert(trace(ray, RG_CULL_NONE).t == 2);
    ray.t_max = nextafter(2, 0);
    ck_assert(trace(ray, RG_CULL_NONE).object == RG_NO_OBJECT);
    ray.t_min = -HUGE_VAL;
    ray.origin[0] = 5;
    ck_assert(trace(ray, RG_CULL_NONE).t == -6);
}
END_TEST

/* The centre lies 5e12 away and 5/8 beside the line, exactly; no digit of the half chord may be lost. */
START_TEST(far_sphere_keeps_its_digits) {
    insert(FIRST, reference_sphere(scene, 1), pose_at(3e12 - 0.5, 4e12 + 0.375, 0));
    reference_hit hit = trace(ray_of(0, 0, 0, 3, 4, 0), RG_CULL_NONE);
    assert_close(hit.t, 1e12L - sqrtl(0.609375L) / 5);
    assert_normal(&hit, 0.5L - 0.6L * sqrtl(0.609375L), -0.375L - 0.8L * sqrtl(0.609375L), 0);
}
END_TEST

/* Exactly tangent at a distance of 2^50: a neighbouring double of the radius, times 4 for the margin, decides. */
START_TEST(far_tangent_is_decided_by_the_last_bits) {
    rg_ray ray = ray_of(-0x1p50, 1, 0, 1, 0, 0);
    insert(FIRST, reference_sphere(scene, 1 - 0x1p-50), pose_at(0, 0, 0));
    ck_assert(trace(ray, RG_CULL_NONE).object == RG_NO_OBJECT);
    insert(SECOND, reference_sphere(scene, 1 + 0x1p-50), pose_at(0, 0, 0));
    ck_assert(trace(ray, RG_CULL_NONE).object == SECOND);
}
END_TEST

START_TEST(box_faces_edges_and_corners) {
    const double lo[3] = {-1, -2, -3}, hi[3] = {1, 2, 3};
    insert(FIRST, reference_box(scene, lo, hi), pose_at(0, 0, 0));
    reference_hit hit = trace(ray_of(-5, 0, 0, 1, 0, 0), RG_CULL_NONE);
    ck_assert(hit.t == 4 && hit.primitive == 0);
    assert_normal(&hit, -1, 0, 0);
    hit = trace(ray_of(0, 0, 9, 0, 0, -2), RG_CULL_NONE);
    ck_assert(hit.t == 3 && hit.primitive == 5);
    hit = trace(ray_of(0, 0, 0, 0, 1, 0), RG_CULL_NONE);
    ck_assert(hit.t == 2 && hit.primitive == 3 && hit.cosine == 1);
    hit = trace(ray_of(-2, -3, 0, 1, 1, 0), RG_CULL_NONE);
    ck_assert(hit.t == 1 && hit.primitive == 0);
    /* in the plane of a face, then just beside it */
    ck_assert(trace(ray_of(1, -5, 0, 0, 1, -0.0), RG_CULL_NONE).t == 3);
    ck_assert(trace(ray_of(nextafter(1, 2), -5, 0, 0, 1, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
    /* touches the edge x = -1, y = 2 only */
    ck_assert(trace(ray_of(-2, 1, 0, 1, 1, 0), RG_CULL_NONE).t == 1);
}
END_TEST

START_TEST(flat_and_infinite_boxes) {
    const double flat_lo[3] = {-1, -1, 0}, flat_hi[3] = {1, 1, 0};
    const double wall_lo[3] = {-HUGE_VAL, -HUGE_VAL, -1}, wall_hi[3] = {HUGE_VAL, HUGE_VAL, 1};
    insert(FIRST, reference_box(scene, flat_lo, flat_hi), pose_at(0, 0, 0));
    ck_assert(trace(ray_of(0, 0, 5, 0, 0, -1), RG_CULL_NONE).primitive == 4);
    ck_assert(trace(ray_of(0, 0, 5, 0, 0, -1), RG_CULL_BACK).primitive == 5);
    ck_assert(trace(ray_of(-2, 0, 0, 1, 0, 0), RG_CULL_NONE).t == 1);
    insert(SECOND, reference_box(scene, wall_lo, wall_hi), pose_at(0, 0, -10));
    reference_hit hit = trace(ray_of(1e30, 7, 11, 0, 0, -1), RG_CULL_NONE);
    ck_assert(hit.t == 20 && hit.object == SECOND && hit.primitive == 5);
    ck_assert(trace(ray_of(0, 0, -8, 1, 0, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
}
END_TEST

START_TEST(capsule_side_and_caps) {
    const double a[3] = {0, 0, -2}, b[3] = {0, 0, 2};
    insert(FIRST, reference_capsule(scene, a, b, 1), pose_at(0, 0, 0));
    reference_hit hit = trace(ray_of(-4, 0, 1, 1, 0, 0), RG_CULL_NONE);
    assert_close(hit.t, 3);
    assert_normal(&hit, -1, 0, 0);
    ck_assert(trace(ray_of(0, 0, 9, 0, 0, -1), RG_CULL_NONE).t == 6);
    hit = trace(ray_of(-4, 0, 2.6, 1, 0, 0), RG_CULL_NONE);
    long double up = (long double)2.6 - 2, in = sqrtl(1 - up * up);
    assert_close(hit.t, 4 - in);
    assert_normal(&hit, -in, 0, up);
    assert_close(trace(ray_of(0.6, 0, 0, 0, 0, 1), RG_CULL_NONE).t, 2 + sqrtl(1 - (long double)0.6 * 0.6));
    ck_assert(trace(ray_of(-4, 0, 3.01, 1, 0, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
    const double p[3] = {0, 0, 7};
    insert(SECOND, reference_capsule(scene, p, p, 0.5), pose_at(0, 0, 0));
    ck_assert(trace(ray_of(0, 0, 9, 0, 0, -1), RG_CULL_NONE).t == 1.5L);
}
END_TEST

/* Two triangles make the unit square; its diagonal belongs to both, the lower one wins. */
START_TEST(mesh_square) {
    const double v[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const uint32_t index[] = {0, 1, 2, 0, 2, 3, 0, 0, 1};
    insert(FIRST, reference_mesh(scene, v, 4, index, 3), pose_at(0, 0, 0));
    reference_hit hit = trace(ray_of(0.75, 0.25, 2, 0, 0, -1), RG_CULL_NONE);
    ck_assert(hit.t == 2 && hit.primitive == 0 && hit.u == 0.5L && hit.v == 0.25L && hit.cosine == -1);
    assert_normal(&hit, 0, 0, 1);
    hit = trace(ray_of(0.25, 0.75, -2, 0, 0, 1), RG_CULL_NONE);
    ck_assert(hit.primitive == 1 && hit.u == 0.25L && hit.v == 0.5L && hit.cosine == 1);
    ck_assert(trace(ray_of(0.5, 0.5, 2, 0, 0, -1), RG_CULL_NONE).primitive == 0);
    ck_assert(trace(ray_of(0, 0, 2, 0, 0, -1), RG_CULL_NONE).primitive == 0);
    ck_assert(trace(ray_of(0.5, -1, 0, 0, 1, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
    ck_assert(trace(ray_of(0.25, 0.75, -2, 0, 0, 1), RG_CULL_BACK).object == RG_NO_OBJECT);
    ck_assert(trace(ray_of(1.0000001, 0.5, 2, 0, 0, -1), RG_CULL_NONE).object == RG_NO_OBJECT);
}
END_TEST

START_TEST(posed_sphere_is_an_ellipsoid) {
    rg_pose pose = {{10, 0, 0}, {-2, 0, 0, 0, 4, 0, 0, 0, 0.5f}, 1};
    insert(FIRST, reference_sphere(scene, 1), pose);
    reference_hit hit = trace(ray_of(0, 0, 0, 1, 0, 0), RG_CULL_NONE);
    ck_assert(hit.t == 8 && hit.cosine == -1);
    ck_assert(trace(ray_of(10, 9, 0, 0, -1, 0), RG_CULL_NONE).t == 5);
    /* x = 1 from the centre, half the half axis: y = 4 sqrt(3/4), normal ~ (x / 4, y / 16) */
    hit = trace(ray_of(11, 9, 0, 0, -1, 0), RG_CULL_NONE);
    assert_close(hit.t, 9 - 4 * sqrtl(0.75L));
    assert_normal(&hit, 2 / sqrtl(7), sqrtl(3) / sqrtl(7), 0);
}
END_TEST

START_TEST(mirrored_mesh_keeps_its_outside) {
    const double v[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t index[] = {0, 1, 2};
    rg_pose pose = {{0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, -1}, 1};
    insert(FIRST, reference_mesh(scene, v, 3, index, 1), pose);
    reference_hit hit = trace(ray_of(0.25, 0.25, 1, 0, 0, -1), RG_CULL_NONE);
    ck_assert(hit.cosine == 1);
    assert_normal(&hit, 0, 0, -1);
}
END_TEST

START_TEST(masks_ties_and_updates) {
    const reference_shape *ball = reference_sphere(scene, 1);
    const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
    double got_lo[3], got_hi[3];
    rg_ray ray = ray_of(-9, 0, 0, 1, 0, 0);
    insert(SECOND, ball, pose_at(0, 0, 0));
    insert(FIRST, reference_box(scene, lo, hi), pose_at(0, 0, 0));
    ck_assert(trace(ray, RG_CULL_NONE).object == FIRST);
    reference_set_mask(scene, FIRST, 2);
    ray.mask = 5;
    ck_assert(trace(ray, RG_CULL_NONE).object == SECOND);
    rg_pose away = pose_at(3, 7, 0);
    reference_move(scene, SECOND, &away);
    ck_assert(trace(ray, RG_CULL_NONE).object == RG_NO_OBJECT);
    reference_bounds(scene, SECOND, got_lo, got_hi);
    ck_assert(got_lo[0] == 2 && got_hi[0] == 4 && got_lo[1] == 6 && got_hi[1] == 8 && got_hi[2] == 1);
    reference_remove(scene, FIRST);
    ck_assert(!reference_has(scene, FIRST) && reference_has(scene, SECOND) && reference_count(scene) == 1);
    ck_assert(reference_object(scene, 0) == SECOND);
}
END_TEST

START_TEST(invalid_rays) {
    rg_ray ray = ray_of(0, 0, 0, 1, 0, 0);
    ck_assert(reference_valid(&ray));
    ray.t_min = ray.t_max;
    ck_assert(reference_valid(&ray));
    ray.t_max = 1;
    ck_assert(!reference_valid(&ray));
    ray = ray_of(0, 0, 0, 0, -0.0, 0);
    ck_assert(!reference_valid(&ray));
    ray = ray_of(0, 2e100, 0, 1, 0, 0);
    ck_assert(!reference_valid(&ray));
    ray = ray_of(0, 0, 0, 1, NAN, 0);
    ck_assert(!reference_valid(&ray));
    rg_hit got = {.t = NAN, .primitive = RG_NO_PRIMITIVE};
    ck_assert_int_eq(reference_compare(scene, &ray, RG_CULL_NONE, &got, NULL), REFERENCE_EQUAL);
    got.t = HUGE_VAL;
    ck_assert_int_eq(reference_compare(scene, &ray, RG_CULL_NONE, &got, NULL), REFERENCE_WRONG);
}
END_TEST

/* -------------------------------------------------------------------------------------------------- compare */

static int judged(rg_ray ray, rg_hit got) {
    return reference_compare(scene, &ray, RG_CULL_NONE, &got, NULL);
}

START_TEST(compare_tells_right_from_wrong) {
    insert(FIRST, reference_sphere(scene, 1), pose_at(10, 0.25, 0));
    rg_ray ray = ray_of(0, 0, 0, 1, 0, 0);
    reference_hit want = trace(ray, RG_CULL_NONE);
    const rg_hit right = as_reported(&ray, &want);
    ck_assert_int_eq(judged(ray, right), REFERENCE_EQUAL);
    rg_hit got = right;
    got.t += 0x1p-41;
    got.position[0] = got.t;
    ck_assert_int_eq(judged(ray, got), REFERENCE_EQUAL);
    got.t += 0x1p-38;
    got.position[0] = got.t;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    got = right;
    got.position[0] += 0x1p-40;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    got = right;
    got.normal[1] += 1e-5f;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    got = right;
    got.u = 1e-3f;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    got = (rg_hit){.t = HUGE_VAL, .primitive = RG_NO_PRIMITIVE};
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    ray.t_max = 5;
    ck_assert_int_eq(judged(ray, got), REFERENCE_EQUAL);
    ck_assert_int_eq(judged(ray, right), REFERENCE_WRONG);
}
END_TEST

/* A ray that passes the silhouette within 2^-40 R may hit or miss; beyond it may not. */
START_TEST(compare_at_the_silhouette) {
    rg_hit miss = {.t = HUGE_VAL, .primitive = RG_NO_PRIMITIVE};
    insert(FIRST, reference_sphere(scene, 1), pose_at(0, 0, 0));
    rg_ray ray = ray_of(-9, 1 - 0x1p-42, 0, 1, 0, 0);
    reference_hit want = trace(ray, RG_CULL_NONE);
    ck_assert_int_eq(judged(ray, as_reported(&ray, &want)), REFERENCE_EQUAL);
    ck_assert_int_eq(judged(ray, miss), REFERENCE_WITHIN_BOUND);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, false) == REFERENCE_WITHIN_BOUND);
    ray.origin[1] = 1 - 0x1p-38;
    ck_assert_int_eq(judged(ray, miss), REFERENCE_WRONG);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, false) == REFERENCE_WRONG);
    ray.origin[1] = 1 + 0x1p-42;
    rg_hit touch = {.t = 9, .object = FIRST, .position = {0, ray.origin[1], 0}, .normal = {0, 1, 0}};
    ck_assert_int_eq(judged(ray, miss), REFERENCE_EQUAL);
    ck_assert_int_eq(judged(ray, touch), REFERENCE_WITHIN_BOUND);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, true) == REFERENCE_WITHIN_BOUND);
    ray.origin[1] = touch.position[1] = 1 + 0x1p-38;
    ck_assert_int_eq(judged(ray, touch), REFERENCE_WRONG);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, true) == REFERENCE_WRONG);
}
END_TEST

START_TEST(compare_order_and_ties) {
    const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
    const reference_shape *cube = reference_box(scene, lo, hi);
    rg_ray ray = ray_of(-9, 0, 0, 1, 0, 0);
    insert(FIRST, cube, pose_at(0, 0, 0));
    insert(SECOND, cube, pose_at(0, 0, 0));
    reference_hit want = trace(ray, RG_CULL_NONE);
    rg_hit got = as_reported(&ray, &want);
    ck_assert_int_eq(judged(ray, got), REFERENCE_EQUAL);
    got.object = SECOND;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    /* a hair behind, then clearly behind */
    rg_pose pose = pose_at(0x1p-43, 0, 0);
    reference_move(scene, SECOND, &pose);
    ck_assert_int_eq(judged(ray, got), REFERENCE_WITHIN_BOUND);
    pose.position[0] = 0.5;
    reference_move(scene, SECOND, &pose);
    got.t = 8.5;
    got.position[0] = -0.5;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    /* at an edge of the box either face will do */
    ray = ray_of(-2, -2, 0, 1, 1, 0);
    want = trace(ray, RG_CULL_NONE);
    got = as_reported(&ray, &want);
    got.primitive = 2;
    got.normal[0] = 0;
    got.normal[1] = -1;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WITHIN_BOUND);
    got.primitive = 4;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
}
END_TEST

/* What has no thickness is missed by every ray moved aside, and may be hit all the same: its edges tell. */
START_TEST(compare_with_a_segment) {
    const double lo[3] = {-1, 0, 0}, hi[3] = {1, 0, 0};
    insert(FIRST, reference_box(scene, lo, hi), pose_at(0, 0, 0));
    rg_ray ray = ray_of(0.5, -3, 0x1p-43, 0, 1, 0);
    rg_hit got = {.t = 3, .object = FIRST, .primitive = 2, .position = {0.5, 0, 0x1p-43}, .normal = {0, -1, 0}};
    ck_assert(trace(ray, RG_CULL_NONE).object == RG_NO_OBJECT);
    ck_assert_int_eq(judged(ray, got), REFERENCE_WITHIN_BOUND);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, true) == REFERENCE_WITHIN_BOUND);
    ray.origin[2] = got.position[2] = 0x1p-38;
    ck_assert_int_eq(judged(ray, got), REFERENCE_WRONG);
    ck_assert(reference_compare_occluded(scene, &ray, RG_CULL_NONE, true) == REFERENCE_WRONG);
}
END_TEST

/* 2^300 radii away the nearest point is found in several steps, and still exactly. */
START_TEST(absurdly_far) {
    const double far = 0x1p300;
    insert(FIRST, reference_sphere(scene, 5), pose_at(3, 4, 0));
    reference_hit hit = trace(ray_of(0, -far, 0, 0, far, 0), RG_CULL_NONE);
    assert_close(hit.t, 1);
    assert_normal(&hit, -0.6L, -0.8L, 0);
    ck_assert(trace(ray_of(-2 - 0x1p-30, -far, 0, 0, far, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
    ck_assert(trace(ray_of(-2 + 0x1p-30, -far, 0, 0, far, 0), RG_CULL_NONE).object == FIRST);
    /* beyond what a double t can say */
    ck_assert(trace(ray_of(3, -far, 0, 0, 0x1p-1000, 0), RG_CULL_NONE).object == RG_NO_OBJECT);
}
END_TEST

START_TEST(intersect_in_the_local_frame) {
    rg_local_ray ray = {.origin = {-3, 0, 0}, .direction = {2, 0, 0}, .t_max = HUGE_VAL};
    rg_local_hit hit;
    const reference_shape *ball = reference_sphere(scene, 1);
    ck_assert_int_eq(reference_intersect(ball, &ray, &hit), 1);
    ck_assert(hit.t == 1 && hit.normal[0] == -1 && hit.primitive == 0);
    ray.t_max = 0.5;
    ck_assert_int_eq(reference_intersect(ball, &ray, &hit), 0);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("reference");
    TCase *cases = tcase_create("by hand");
    tcase_add_checked_fixture(cases, setup, teardown);
    tcase_add_test(cases, sphere_from_outside_and_inside);
    tcase_add_test(cases, range_is_inclusive);
    tcase_add_test(cases, far_sphere_keeps_its_digits);
    tcase_add_test(cases, far_tangent_is_decided_by_the_last_bits);
    tcase_add_test(cases, box_faces_edges_and_corners);
    tcase_add_test(cases, flat_and_infinite_boxes);
    tcase_add_test(cases, capsule_side_and_caps);
    tcase_add_test(cases, mesh_square);
    tcase_add_test(cases, posed_sphere_is_an_ellipsoid);
    tcase_add_test(cases, mirrored_mesh_keeps_its_outside);
    tcase_add_test(cases, masks_ties_and_updates);
    tcase_add_test(cases, invalid_rays);
    tcase_add_test(cases, compare_tells_right_from_wrong);
    tcase_add_test(cases, compare_at_the_silhouette);
    tcase_add_test(cases, compare_order_and_ties);
    tcase_add_test(cases, compare_with_a_segment);
    tcase_add_test(cases, absurdly_far);
    tcase_add_test(cases, intersect_in_the_local_frame);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
