/* SPDX-License-Identifier: MIT */
/* The parts of the kernels that are in double give, for 16 rays, the bits that the code for one ray gives. */
#include "machine.h"
#include "vec.h"

#include <string.h>

static bool same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static double extreme(void) {
    static const double VALUES[] = {0,         -0.0, 1,      -1,     1e100, -1e100,  1.1e100,   INFINITY,
                                    -INFINITY, NAN,  1e-300, 5e-324, 1e300, 0x1p400, 0x1.8p-400};
    return machine_below(3) ? unit_random_scale(-30, 30) : machine_pick(VALUES, 15);
}

/* Rays as good as any, but for a few numbers. */
static void pick_bundle(rgi_bundle *b) {
    double far = pow(10, 24 * unit_random() - 12);
    bool wild = machine_below(2);
    b->count = RGI_PACKET;
    for (int i = 0; i < RGI_PACKET; i++) {
        for (int a = 0; a < 3; a++) {
            b->origin[a][i] = far * unit_random_scale(-1, 0);
            b->direction[a][i] = unit_random_scale(-3, 0) * (machine_below(20) ? 1 : 0);
        }
        b->t_min[i] = machine_below(3) ? 0 : unit_random_scale(-2, 3) * far;
        b->t_max[i] = machine_below(3) ? INFINITY : fabs(unit_random_scale(-2, 3)) * far + rgi_max(b->t_min[i], 0);
    }
    if (!wild) return;
    int lane = machine_below(RGI_PACKET), what = machine_below(8);
    *(what < 3   ? &b->origin[what][lane]
      : what < 6 ? &b->direction[what - 3][lane]
      : what < 7 ? &b->t_min[lane]
                 : &b->t_max[lane]) = extreme();
}

/* prepare gives the bits of rgi_ray_init, or false where one of the rays is invalid or extreme. */
START_TEST(prepared_alike) {
    const rgi_kernels *k = machine_kernels[_i];
    int good = 0, refused = 0;
    for (int round = 0; round < 20000 && machine_can_run(k); round++) {
        rgi_bundle b, given;
        pick_bundle(&b);
        given = b;
        bool ready = k->prepare(&b);
        good += ready;
        refused += !ready;
        for (int i = 0; i < RGI_PACKET && ready; i++) {
            const double o[3] = {given.origin[0][i], given.origin[1][i], given.origin[2][i]};
            const double d[3] = {given.direction[0][i], given.direction[1][i], given.direction[2][i]};
            rgi_ray r;
            MUST(rgi_ray_init(&r, o, d, given.t_min[i], given.t_max[i], 1));
            for (int a = 0; a < 3; a++) {
                MUST(same_bits(r.origin[a], b.origin[a][i]));
                MUST(same_bits(r.direction[a], b.direction[a][i]));
            }
            MUST(same_bits(r.t_min, b.t_min[i]) && same_bits(r.t_max, b.t_max[i]));
            MUST(same_bits(r.dd, b.dd[i]));
            MUST(same_bits(r.to_world, b.to_world[i]) && same_bits(r.to_world2, b.to_world2[i]));
        }
    }
    if (machine_can_run(k)) ck_assert(good > 5000 && refused > 500);
}
END_TEST

/* A component of a vector that is made one of length 1. */
static double unit_of(const double v[3], int axis) {
    double largest = rgi_max_magnitude(v), n[3];
    for (int a = 0; a < 3; a++) n[a] = v[a] / largest;
    return n[axis] / sqrt(rgi_dot(n, n));
}

/* Where a ray meets a ball: the bits of rgi_object_intersect. */
START_TEST(balls_met_alike) {
    const rgi_kernels *k = machine_kernels[_i];
    rg_shape *shape = NULL;
    uint64_t hits = 0;
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &shape), RG_OK);
    for (int round = 0; round < 20000 && machine_can_run(k); round++) {
        rgi_bundle b;
        rgi_meeting m;
        pick_bundle(&b);
        if (!k->prepare(&b)) continue;
        for (int i = 0; i < RGI_PACKET; i++) {
            double away = machine_below(4) ? 10 * unit_random() : pow(10, 12 * unit_random());
            m.radius[i] = pow(10, 6 * unit_random() - 3) * (fabs(b.origin[0][i]) + 1e-9);
            double beside = m.radius[i] * (machine_below(4) ? unit_random() : 1 - pow(2, -50 * unit_random()));
            const double d[3] = {b.direction[0][i], b.direction[1][i], b.direction[2][i]};
            double axis[3] = {round % 3 == 0, round % 3 == 1, round % 3 == 2}, across[3];
            /* Tangents, too: across the way, in every other round. */
            rgi_cross(d, axis, across);
            double length = round % 2 ? sqrt(rgi_dot(across, across)) : 0;
            for (int a = 0; a < 3; a++) {
                double aside = length > 0 ? across[a] / length : axis[a];
                m.centre[a][i] = b.origin[a][i] + away * m.radius[i] * d[a] + aside * beside;
            }
        }
        m.wants_normals = true;
        k->meet(&b, &m);
        for (int i = 0; i < RGI_PACKET; i++) {
            rgi_object o = {.shape = shape, .linear = RGI_NONE, .reach = m.radius[i], .mask = 1};
            rgi_ray r = {.t_min = b.t_min[i],
                         .t_max = b.t_max[i],
                         .dd = b.dd[i],
                         .to_world = b.to_world[i],
                         .to_world2 = b.to_world2[i],
                         .mask = 1};
            rgi_local_ray local = {.t_min = r.t_min, .t_max = r.t_max, .sides = RGI_FRONT | RGI_BACK};
            rgi_candidate found;
            for (int a = 0; a < 3; a++) {
                o.position[a] = m.centre[a][i];
                r.origin[a] = b.origin[a][i];
                r.direction[a] = b.direction[a][i];
            }
            bool hit = rgi_object_intersect(&o, NULL, &r, &local, &found);
            hits += hit;
            MUST((m.met >> i & 1) == hit);
            if (hit) MUST(same_bits(m.scaled_t[i], found.t) && same_bits(m.t[i], rgi_world_t(&r, found.t)));
            for (int a = 0; a < 3 && hit; a++) MUST(fabs(m.normal[a][i] - unit_of(found.normal, a)) <= 0x1p-24);
        }
    }
    if (machine_can_run(k)) ck_assert_uint_gt(hits, 10000);
    rg_shape_release(&shape);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("bundle");
    TCase *tests = tcase_create("bundle");
    tcase_set_timeout(tests, 120);
    tcase_add_loop_test(tests, prepared_alike, 0, MACHINE_KERNELS);
    tcase_add_loop_test(tests, balls_met_alike, 0, MACHINE_KERNELS);
    suite_add_tcase(suite, tests);
    return suite;
}
