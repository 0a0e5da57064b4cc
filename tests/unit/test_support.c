/* SPDX-License-Identifier: MIT */
#include "shape.h"
#include "unit.h"
#include "vec.h"

#include <string.h>

enum { POINTS = 300, TRIANGLES = 200 };

static double points[POINTS][3];
static float rounded[POINTS][3];
static uint16_t corners[TRIANGLES][3];

/* Points of a ball, or of a rod along a diagonal, around a place; the last one is of no triangle, and far away. */
static void make_points(bool rod, double size, double place, bool floats) {
    for (int i = 0; i < POINTS; i++) {
        double n[3] = {unit_random() - 0.5, unit_random() - 0.5, unit_random() - 0.5};
        double length = sqrt(rgi_dot(n, n)), along = 2 * unit_random() - 1;
        for (int a = 0; a < 3; a++) {
            double x = rod ? along / sqrt(3) + 0.02 * n[a] / length : n[a] / length;
            points[i][a] = i == POINTS - 1 ? 100 * size : size * x + place * (a - 0.7);
            rounded[i][a] = (float)points[i][a];
            if (floats) points[i][a] = (double)rounded[i][a];
        }
    }
    for (int t = 0; t < TRIANGLES; t++) {
        /* Each of the others is used. */
        for (int c = 0; c < 3; c++) corners[t][c] = (uint16_t)((3 * t + c) % (POINTS - 1));
    }
}

static rg_mesh_views views_of(bool narrow) {
    rg_mesh_views views;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.vertices = narrow ? rg_input3_packed(rounded, sizeof rounded[0], RG_F32)
                            : rg_input3_packed(points, sizeof points[0], RG_F64);
    views.vertex_count = POINTS;
    views.indices = rg_input3_packed(corners, sizeof corners[0], RG_U16);
    views.triangle_count = TRIANGLES;
    return views;
}

static rg_shape *mesh_of_points(bool narrow, rg_mesh_quality quality) {
    const rg_mesh_views views = views_of(narrow);
    rg_shape_config config;
    rg_shape *shape;
    ck_assert_int_eq(rg_shape_config_default(&config, sizeof config), RG_OK);
    config.quality = quality;
    ck_assert_int_eq(rg_shape_create_mesh(&config, &views, &shape), RG_OK);
    return shape;
}

/* A box of the mesh's own box, turned likewise. */
static rg_shape *box_of(const rg_shape *mesh) {
    rg_shape *shape;
    ck_assert_int_eq(rg_shape_create_box(NULL, mesh->lo, mesh->hi, &shape), RG_OK);
    return shape;
}

static void random_turn(double m[9]) {
    double u[3], v[3], w[3];
    for (int a = 0; a < 3; a++) {
        u[a] = unit_random() - 0.5;
        v[a] = unit_random() - 0.5;
    }
    rgi_cross(u, v, w);
    rgi_cross(w, u, v);
    for (int a = 0; a < 3; a++) {
        m[a] = u[a] / sqrt(rgi_dot(u, u));
        m[3 + a] = v[a] / sqrt(rgi_dot(v, v));
        m[6 + a] = w[a] / sqrt(rgi_dot(w, w));
    }
}

/* Turned, mirrored, sheared, stretched by up to 10^6, or with zeros and equal sizes, where the order is a tie. */
static void random_matrix(int kind, double m[9]) {
    random_turn(m);
    for (int k = 0; k < 9; k++) {
        if (kind == 1) m[k] = -m[k];
        if (kind == 2) m[k] = unit_random_scale(-1, 1);
        if (kind == 3) m[k] *= pow(10, 3 * (k / 3 - 1));
        if (kind == 4) m[k] = floor(3 * unit_random()) - 1;
    }
}

/* The posed points are within the bounds and the reach, in long double, and the bounds within those of the box. */
static void check_pose(const rg_shape *mesh, const rg_shape *box, const double *m, const double position[3]) {
    double lo[3], hi[3], reach, box_lo[3], box_hi[3], box_reach;
    ck_assert_int_eq(rgi_shape_bounds(mesh, position, m, lo, hi, &reach), RG_OK);
    ck_assert_int_eq(rgi_shape_bounds(box, position, m, box_lo, box_hi, &box_reach), RG_OK);
    for (int i = 0; i < POINTS - 1; i++) {
        long double square = 0;
        for (int a = 0; a < 3; a++) {
            long double x = m ? 0 : points[i][a];
            for (int k = 0; k < 3 && m; k++) x += (long double)m[3 * a + k] * points[i][k];
            square += x * x;
            MUST(x + position[a] >= lo[a] && x + position[a] <= hi[a]);
        }
        MUST(square <= (long double)reach * reach);
    }
    for (int a = 0; a < 3; a++) {
        double largest = fabs(position[a]);
        for (int k = 0; k < 3; k++)
            largest += fabs(m ? m[3 * a + k] : k == a) * rgi_max(fabs(mesh->lo[k]), fabs(mesh->hi[k]));
        double rounding = 0x1p-48 * largest;
        MUST(lo[a] >= box_lo[a] - rounding && hi[a] <= box_hi[a] + rounding);
    }
}

START_TEST(bounds_hold_the_posed_mesh) {
    for (int i = 0; i < 400; i++) {
        bool floats = i % 2, rod = i / 2 % 2;
        double size = i % 3 ? 1 : pow(10, 40 * unit_random() - 20);
        double place = i % 5 == 0 ? 1e12 * size : i % 5 == 1 ? 3 * size : 0;
        make_points(rod, size, place, floats && i % 3);
        rg_shape *mesh = mesh_of_points(false, i % 7 ? RG_MESH_BEST : RG_MESH_FAST), *box = box_of(mesh);
        for (int k = 0; k < 10; k++) {
            double m[9], position[3];
            random_matrix(k % 5, m);
            for (int a = 0; a < 3; a++) position[a] = size * unit_random_scale(-2, k % 2 ? 12 : 2);
            check_pose(mesh, box, k == 9 ? NULL : m, position);
        }
        rg_shape_release(&mesh);
        rg_shape_release(&box);
    }
}
END_TEST

static double area(const double lo[3], const double hi[3]) {
    double x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + y * z + z * x;
}

/* Sums of areas over turns: of the bounds, of those of the turned box, and of the tightest that there are. */
static void add_areas(bool rod, double sums[3]) {
    const double at_home[3] = {0, 0, 0};
    make_points(rod, 1, 0, false);
    rg_shape *mesh = mesh_of_points(false, RG_MESH_BEST), *box = box_of(mesh);
    for (int k = 0; k < 500; k++) {
        double m[9], lo[3], hi[3], reach;
        random_turn(m);
        ck_assert_int_eq(rgi_shape_bounds(mesh, at_home, m, lo, hi, &reach), RG_OK);
        ck_assert_double_le(reach, 1.05);
        sums[0] += area(lo, hi);
        ck_assert_int_eq(rgi_shape_bounds(box, at_home, m, lo, hi, &reach), RG_OK);
        sums[1] += area(lo, hi);
        rgi_empty_box(lo, hi);
        for (int i = 0; i < POINTS - 1; i++) {
            double p[3];
            for (int a = 0; a < 3; a++) p[a] = rgi_dot(m + 3 * a, points[i]);
            rgi_grow(lo, hi, p, p);
        }
        sums[2] += area(lo, hi);
    }
    rg_shape_release(&mesh);
    rg_shape_release(&box);
}

START_TEST(bounds_are_tight) {
    double ball[3] = {0, 0, 0}, rod[3] = {0, 0, 0};
    add_areas(false, ball);
    add_areas(true, rod);
    ck_assert_double_lt(ball[0], 1.1 * ball[2]);
    ck_assert_double_lt(2 * ball[0], ball[1]);
    ck_assert_double_lt(rod[0], 1.5 * rod[2]);
    ck_assert_double_lt(2.5 * rod[0], rod[1]);
}
END_TEST

static rg_shape *deformed(rg_shape *mesh, bool narrow) {
    const rg_mesh_views views = views_of(narrow);
    rg_shape *shape;
    ck_assert_int_eq(rg_shape_create_deformed(NULL, mesh, &views, &shape), RG_OK);
    rg_shape_release(&mesh);
    return shape;
}

static void check_same(const rg_shape *mesh, rg_shape *other) {
    const rgi_support *a = &mesh->of.mesh->support, *b = &other->of.mesh->support;
    for (int d = 0; d < RGI_DIRECTIONS; d++) MUST(a->along[d] == b->along[d]);
    for (int k = 0; k < 3; k++) MUST(a->centre[k] == b->centre[k]);
    MUST(a->radius == b->radius);
    rg_shape_release(&other);
}

/* What a mesh reaches depends on its vertices, not on how it came to them: the bits of hits depend on it. */
START_TEST(the_same_whatever_it_was_before) {
    for (int i = 0; i < 60; i++) {
        bool floats = i % 2;
        double size = i % 3 ? 1 : 1e20;
        make_points(false, size, i % 5 ? 0 : 1e3, floats);
        rg_shape *was_even = mesh_of_points(false, RG_MESH_BEST);
        make_points(true, 1, 0, !floats);
        rg_shape *was_odd = mesh_of_points(false, RG_MESH_FAST);
        make_points(i % 4 < 2, size, 0, floats);
        rg_shape *mesh = mesh_of_points(false, RG_MESH_BEST);
        check_same(mesh, mesh_of_points(false, RG_MESH_FAST));
        check_same(mesh, deformed(was_even, false));
        check_same(mesh, deformed(was_odd, floats));
        if (floats) check_same(mesh, mesh_of_points(true, RG_MESH_FAST));
        rg_shape_release(&mesh);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("support");
    TCase *tests = tcase_create("support");
    tcase_add_test(tests, bounds_hold_the_posed_mesh);
    tcase_add_test(tests, bounds_are_tight);
    tcase_add_test(tests, the_same_whatever_it_was_before);
    suite_add_tcase(suite, tests);
    return suite;
}
