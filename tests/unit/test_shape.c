/* SPDX-License-Identifier: MIT */
#include "pose.h"
#include "shape.h"
#include "unit.h"
#include "vec.h"

#include <string.h>

/* A point of the surface of a shape, at random. */
static void surface_point(const rg_shape *shape, double out[3]) {
    double n[3] = {unit_random() - 0.5, unit_random() - 0.5, unit_random() - 0.5};
    double length = sqrt(rgi_dot(n, n));
    if (shape->kind == RG_SHAPE_BOX) {
        for (int i = 0; i < 3; i++) out[i] = shape->lo[i] + unit_random() * (shape->hi[i] - shape->lo[i]);
        int axis = (int)(3 * unit_random());
        out[axis] = unit_random() < 0.5 ? shape->lo[axis] : shape->hi[axis];
        return;
    }
    const rgi_capsule *c = &shape->of.capsule;
    double radius = shape->kind == RG_SHAPE_SPHERE ? shape->of.radius : c->radius;
    double along = shape->kind == RG_SHAPE_SPHERE ? 0 : c->length * unit_random();
    for (int i = 0; i < 3; i++)
        out[i] = n[i] / length * radius + (shape->kind == RG_SHAPE_SPHERE ? 0 : c->a[i] + along * c->axis[i]);
}

static void transform(const double m[9], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

/* Under any pose, world boxes hold the surface, and those of spheres and capsules hold little else. */
static void check_bounds(const rg_shape *shape) {
    for (int i = 0; i < 200; i++) {
        double m[9];
        double position[3], lo[3], hi[3], reach, seen_lo[3], seen_hi[3];
        for (int k = 0; k < 9; k++) m[k] = unit_random_scale(-1, 1);
        for (int k = 0; k < 3; k++) position[k] = unit_random_scale(-2, 6);
        const double *matrix = i % 2 ? m : NULL;
        ck_assert_int_eq(rgi_shape_bounds(shape, position, matrix, lo, hi, &reach), RG_OK);
        rgi_empty_box(seen_lo, seen_hi);
        for (int k = 0; k < 500; k++) {
            double local[3], world[3];
            surface_point(shape, local);
            if (matrix)
                transform(matrix, local, world);
            else
                memcpy(world, local, sizeof world);
            for (int a = 0; a < 3; a++) {
                world[a] += position[a];
                ck_assert(world[a] >= lo[a] && world[a] <= hi[a]);
                local[a] = world[a] - position[a];
            }
            ck_assert(sqrt(rgi_dot(local, local)) <= reach);
            rgi_grow(seen_lo, seen_hi, world, world);
        }
        for (int a = 0; a < 3; a++) ck_assert_double_ge(seen_hi[a] - seen_lo[a], 0.6 * (hi[a] - lo[a]));
    }
}

START_TEST(bounds) {
    rg_shape *shape;
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 0.75, &shape), RG_OK);
    check_bounds(shape);
    rg_shape_release(&shape);
    ck_assert_int_eq(rg_shape_create_box(NULL, (double[]){-1, 2, 0}, (double[]){1, 5, 0.5}, &shape), RG_OK);
    check_bounds(shape);
    rg_shape_release(&shape);
    ck_assert_int_eq(rg_shape_create_capsule(NULL, (double[]){1, 0, 3}, (double[]){-1, 2, 2}, 0.5, &shape), RG_OK);
    check_bounds(shape);
    rg_shape_release(&shape);
}
END_TEST

START_TEST(infinite_and_far) {
    rg_shape *plane, *ball;
    double lo[3], hi[3], reach, position[3] = {1, 2, 3};
    const double turned[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    ck_assert_int_eq(
        rg_shape_create_box(NULL, (double[]){-INFINITY, -1, -INFINITY}, (double[]){INFINITY, 0, INFINITY}, &plane),
        RG_OK);
    ck_assert_int_eq(rgi_shape_bounds(plane, position, NULL, lo, hi, &reach), RG_OK);
    ck_assert(lo[0] == -INFINITY && hi[2] == INFINITY && lo[1] <= 1 && hi[1] >= 2 && hi[1] < 2.0000001);
    ck_assert_int_eq(rgi_shape_bounds(plane, position, turned, lo, hi, &reach), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1e100, &ball), RG_OK);
    position[0] = 1e100;
    ck_assert_int_eq(rgi_shape_bounds(ball, position, NULL, lo, hi, &reach), RG_OK);
    const double large[9] = {3, 0, 0, 0, 1, 0, 0, 0, 1};
    ck_assert_int_eq(rgi_shape_bounds(ball, position, large, lo, hi, &reach), RG_INVALID_VALUE);
    rg_shape_release(&plane);
    rg_shape_release(&ball);
}
END_TEST

static void count_destroy(void *user) {
    ++*(int *)user;
}

static int32_t never(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    (void)user, (void)ray, (void)hit;
    return 0;
}

START_TEST(references) {
    int destroyed = 0;
    rg_shape *shape;
    rg_user_shape user;
    memset(&user, 0, sizeof user);
    user.size = sizeof user;
    user.user = &destroyed;
    user.intersect = never;
    user.destroy = count_destroy;
    user.lo[0] = 1;
    ck_assert_int_eq(rg_shape_create_user(NULL, &user, &shape), RG_INVALID_VALUE);
    ck_assert_int_eq(destroyed, 0);
    user.lo[0] = -1;
    ck_assert_int_eq(rg_shape_create_user(NULL, &user, &shape), RG_OK);
    rg_shape *same = shape;
    rg_shape_retain(shape);
    rg_shape_release(&shape);
    ck_assert_ptr_null(shape);
    ck_assert_int_eq(destroyed, 0);
    rg_shape_release(&same);
    ck_assert_int_eq(destroyed, 1);
    rg_shape_release(&same);
    rg_shape_release(NULL);
    ck_assert_int_eq(destroyed, 1);
}
END_TEST

/* A plane z = 0, 1, 2, ... for each whole number up to `count`: many surfaces behind one another. */
typedef struct stack {
    int count;
    int calls;
} stack;

static int32_t stack_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    stack *s = user;
    s->calls++;
    hit->t = ceil(ray->t_min);
    hit->normal[2] = 1;
    return hit->t < s->count;
}

static bool from_seventh(void *context, const rgi_candidate *candidate) {
    (void)context;
    return candidate->t >= 7;
}

START_TEST(user_shapes_are_asked_beyond_what_does_not_count) {
    stack s = {100, 0};
    rg_user_shape user;
    rg_shape *shape;
    rgi_candidate c;
    memset(&user, 0, sizeof user);
    user.size = sizeof user;
    user.user = &s;
    user.intersect = stack_intersect;
    ck_assert_int_eq(rg_shape_create_user(NULL, &user, &shape), RG_OK);
    rgi_local_ray ray;
    memset(&ray, 0, sizeof ray);
    ray.direction[2] = 1;
    ray.t_max = 50;
    ray.sides = RGI_FRONT | RGI_BACK;
    ray.accept = from_seventh;
    ck_assert(rgi_shape_intersect(shape, &ray, &c));
    ck_assert(c.t == 7 && s.calls == 8 && !ray.failed);
    ray.sides = RGI_FRONT;
    ck_assert(!rgi_shape_intersect(shape, &ray, &c) && !ray.failed);
    s.count = 1000000;
    ray.t_max = INFINITY;
    ck_assert(!rgi_shape_intersect(shape, &ray, &c) && ray.failed);
    rg_shape_release(&shape);
}
END_TEST

START_TEST(refused) {
    rg_shape *shape = NULL;
    const double bad[] = {0, -1, NAN, INFINITY, 1e-101, 1e101};
    double o[3] = {0, 0, 0}, one[3] = {1, 1, 1}, nan[3] = {0, NAN, 0};
    for (int i = 0; i < 6; i++) {
        ck_assert_int_eq(rg_shape_create_sphere(NULL, bad[i], &shape), RG_INVALID_VALUE);
        ck_assert_int_eq(rg_shape_create_capsule(NULL, o, one, bad[i], &shape), RG_INVALID_VALUE);
    }
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_shape_create_box(NULL, one, o, &shape), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_shape_create_box(NULL, nan, one, &shape), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_shape_create_box(NULL, NULL, one, &shape), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_shape_create_capsule(NULL, nan, one, 1, &shape), RG_INVALID_VALUE);
    rg_shape_config config;
    ck_assert_int_eq(rg_shape_config_default(&config, sizeof config), RG_OK);
    ck_assert_int_eq(rg_shape_config_default(&config, 3), RG_INVALID_ARGUMENT);
    config.size = 1;
    ck_assert_int_eq(rg_shape_create_sphere(&config, 1, &shape), RG_INVALID_ARGUMENT);
    ck_assert_ptr_null(shape);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("shape");
    TCase *tests = tcase_create("shape");
    tcase_add_test(tests, bounds);
    tcase_add_test(tests, infinite_and_far);
    tcase_add_test(tests, references);
    tcase_add_test(tests, user_shapes_are_asked_beyond_what_does_not_count);
    tcase_add_test(tests, refused);
    suite_add_tcase(suite, tests);
    return suite;
}
