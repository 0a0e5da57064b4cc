/* SPDX-License-Identifier: MIT */
#include "object.h"
#include "unit.h"
#include "vec.h"

#include <float.h>
#include <string.h>

static rg_shape *ball;

static rgi_object object_at(double x, double y, double z) {
    rgi_object object;
    memset(&object, 0, sizeof object);
    object.shape = ball;
    object.reach = 1;
    object.linear = RGI_NONE;
    rgi_set(object.position, x, y, z);
    return object;
}

static bool hit(const rgi_object *object, const double origin[3], const double direction[3], double *t) {
    rgi_ray ray;
    rgi_local_ray local;
    rgi_candidate c;
    memset(&local, 0, sizeof local);
    ck_assert(rgi_ray_init(&ray, origin, direction, 0, INFINITY, 1));
    local.t_min = ray.t_min;
    local.t_max = ray.t_max;
    local.sides = RGI_FRONT | RGI_BACK;
    bool found = rgi_object_intersect(object, NULL, &ray, &local, &c);
    *t = found ? rgi_world_t(&ray, c.t) : INFINITY;
    return found;
}

/* Scaling directions changes t by exactly that scale, down to denormals and up to the largest. */
START_TEST(directions_of_any_length) {
    rgi_object object = object_at(5, 0, 0);
    const double origin[3] = {0, 0.25, 0}, unit[3] = {1, 0.0625, -0.03125};
    double t, first;
    ck_assert(hit(&object, origin, unit, &first));
    for (int e = -1000; e <= 1000; e++) {
        double d[3];
        for (int a = 0; a < 3; a++) d[a] = ldexp(unit[a], e);
        ck_assert(hit(&object, origin, d, &t));
        ck_assert(t == ldexp(first, -e));
    }
    const double denormal[3] = {DBL_MIN / 1048576, 0, 0}, largest[3] = {DBL_MAX, 0, 0};
    /* At some 2^1044: a t that is no double. A hit must not have the t of a miss. */
    ck_assert(!hit(&object, origin, denormal, &t));
    ck_assert(hit(&object, origin, largest, &t) && t < 1e-300);
}
END_TEST

START_TEST(invalid_rays) {
    const double bad_origin[] = {NAN, INFINITY, -INFINITY, 1.01e100}, bad_direction[] = {NAN, INFINITY, -INFINITY};
    double o[3] = {0, 0, 0}, d[3] = {1, 0, 0};
    rgi_ray ray;
    ck_assert(rgi_ray_init(&ray, o, d, -INFINITY, INFINITY, 1));
    ck_assert(rgi_ray_init(&ray, o, d, 1, 1, 1));
    ck_assert(!rgi_ray_init(&ray, o, d, 1, nextafter(1, 0), 1));
    ck_assert(!rgi_ray_init(&ray, o, d, NAN, 1, 1));
    ck_assert(!rgi_ray_init(&ray, o, d, 0, NAN, 1));
    for (int a = 0; a < 3; a++) {
        for (int i = 0; i < 4; i++) {
            double p[3] = {0, 0, 0};
            p[a] = bad_origin[i];
            ck_assert(!rgi_ray_init(&ray, p, d, 0, 1, 1));
        }
        for (int i = 0; i < 3; i++) {
            double e[3] = {1, 1, 1};
            e[a] = bad_direction[i];
            ck_assert(!rgi_ray_init(&ray, o, e, 0, 1, 1));
        }
    }
    const double zero[3] = {0, -0.0, 0};
    ck_assert(!rgi_ray_init(&ray, o, zero, 0, 1, 1));
}
END_TEST

/* The smallest t_min above 0 is above 0 in any scale: the hit at 0 is out of range. */
START_TEST(smallest_limits) {
    rgi_object object = object_at(0, 0, 0);
    const double origin[3] = {-1, 0, 0}, smallest = nextafter(0, 1);
    for (int e = -40; e <= 40; e++) {
        const double d[3] = {ldexp(1, e), 0, 0};
        rgi_ray ray;
        rgi_local_ray local;
        rgi_candidate c;
        memset(&local, 0, sizeof local);
        ck_assert(rgi_ray_init(&ray, origin, d, smallest, INFINITY, 1));
        ck_assert(ray.t_min > 0);
        local.t_min = ray.t_min;
        local.t_max = ray.t_max;
        local.sides = RGI_FRONT | RGI_BACK;
        ck_assert(rgi_object_intersect(&object, NULL, &ray, &local, &c));
        ck_assert(rgi_world_t(&ray, c.t) == ldexp(2, -e));
        ck_assert(rgi_ray_init(&ray, origin, d, -1, -smallest, 1) && ray.t_max < 0);
    }
}
END_TEST

/* NUMERICS, cases 1 and 2: whether a ray hits is right from any distance. The ray runs along an axis that doubles
 * resolve exactly, so the impact is known without rounding. */
START_TEST(from_any_distance) {
    const double direction[3] = {0.75, 0.5, 0.25};
    for (int e = 1; e < 50; e++) {
        for (int i = 0; i < 200; i++) {
            double across[3] = {0.5, -0.75, 0}, impact = ldexp(floor(ldexp(unit_random(), 20)) + 0.5, -19), t;
            double norm = sqrt(0.25 + 0.5625), far = ldexp(1, e);
            double scale = ldexp(floor(ldexp(impact / norm, 22)), -22), p[3], o[3];
            if (fabs(scale * norm - 1) < 0x1p-30) continue;
            for (int a = 0; a < 3; a++) {
                p[a] = ldexp(floor(ldexp(unit_random(), 6)), -6);
                o[a] = p[a] + across[a] * scale - direction[a] * far;
            }
            /* Skip distances at which the sum above is rounded. */
            if (o[0] + direction[0] * far - p[0] != across[0] * scale) continue;
            if (o[1] + direction[1] * far - p[1] != across[1] * scale) continue;
            rgi_object object = object_at(p[0], p[1], p[2]);
            ck_assert_msg(hit(&object, o, direction, &t) == (scale * norm < 1), "distance 2^%d impact %.17g", e,
                          scale * norm);
        }
    }
}
END_TEST

static void setup(void) {
    rg_shape_create_sphere(NULL, 1, &ball);
}
static void teardown(void) {
    rg_shape_release(&ball);
}

Suite *unit_suite(void) {
    Suite *suite = suite_create("object");
    TCase *tests = tcase_create("object");
    tcase_add_checked_fixture(tests, setup, teardown);
    tcase_add_test(tests, directions_of_any_length);
    tcase_add_test(tests, invalid_rays);
    tcase_add_test(tests, smallest_limits);
    tcase_add_test(tests, from_any_distance);
    suite_add_tcase(suite, tests);
    return suite;
}
