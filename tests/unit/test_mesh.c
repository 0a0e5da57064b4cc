/* SPDX-License-Identifier: MIT */
#include "mesh.h"
#include "unit.h"
#include "vec.h"

#include <string.h>

enum { RINGS = 24, SPOKES = 40, VERTICES = RINGS * SPOKES + 2, TRIANGLES = 2 * RINGS * SPOKES };

static rgi_memory memory;
static double vertices[VERTICES][3];
static uint32_t triangles[TRIANGLES][3];

/* A closed globe: two poles and rings of vertices between them, so little dented that from its middle part all of it
 * can be seen: no edge is a silhouette, which a ray may rightly pass on either side. */
static void make_globe(void) {
    const double pi = acos(-1);
    uint32_t n = 0;
    for (int r = 0; r < RINGS; r++) {
        for (int s = 0; s < SPOKES; s++) {
            double polar = pi * (r + 1) / (RINGS + 1), around = 2 * pi * s / SPOKES;
            double radius = 1 + 0.002 * (unit_random() - 0.5);
            double *v = vertices[r * SPOKES + s];
            rgi_set(v, radius * sin(polar) * cos(around), radius * sin(polar) * sin(around), radius * cos(polar));
        }
    }
    rgi_set(vertices[VERTICES - 2], 0, 0, 1);
    rgi_set(vertices[VERTICES - 1], 0, 0, -1);
    for (uint32_t r = 0; r <= RINGS; r++) {
        for (uint32_t s = 0; s < SPOKES; s++) {
            uint32_t t = (s + 1) % SPOKES, up = (r - 1) * SPOKES, down = r * SPOKES;
            uint32_t a = r == 0 ? VERTICES - 2 : up + s, b = r == 0 ? VERTICES - 2 : up + t;
            uint32_t c = r == RINGS ? VERTICES - 1 : down + s, d = r == RINGS ? VERTICES - 1 : down + t;
            if (r != RINGS) memcpy(triangles[n++], (uint32_t[]){a, c, d}, 12);
            if (r != 0) memcpy(triangles[n++], (uint32_t[]){a, r == RINGS ? c : d, b}, 12);
        }
    }
    ck_assert_uint_eq(n, TRIANGLES);
}

static rgi_mesh *globe(void) {
    rg_mesh_views views;
    rgi_mesh *mesh;
    memset(&views, 0, sizeof views);
    views.size = sizeof views;
    views.vertices = rg_input3_packed(vertices, sizeof vertices[0], RG_F64);
    views.vertex_count = VERTICES;
    views.indices = rg_input3_packed(triangles, sizeof triangles[0], RG_U32);
    views.triangle_count = TRIANGLES;
    rgi_memory_init(&memory, NULL);
    make_globe();
    ck_assert_int_eq(rgi_mesh_create(&memory, &views, NULL, NULL, &mesh), RG_OK);
    return mesh;
}

static rgi_local_ray ray_from(const double origin[3], const double target[3]) {
    rgi_local_ray ray;
    memset(&ray, 0, sizeof ray);
    rgi_copy(origin, ray.origin);
    rgi_sub(target, origin, ray.direction);
    ray.t_max = INFINITY;
    ray.sides = RGI_FRONT | RGI_BACK;
    return ray;
}

/* Every triangle is in one leaf; each leaf has the caller's numbers and coordinates; each box holds all below it. */
static void look_below(const rgi_mesh *mesh, rgi_mesh_ref ref, const float lo[3], const float hi[3],
                       unsigned char *once, uint32_t *leaves) {
    if (!(ref & RGI_MESH_LEAF)) {
        const rgi_mesh_node *node = rgi_mesh_at(mesh, ref);
        for (int o = 0; o < RGI_CHILDREN; o++) {
            float child_lo[3], child_hi[3];
            for (int a = 0; a < 3; a++) {
                child_lo[a] = node->lo[a][o];
                child_hi[a] = node->hi[a][o];
            }
            if (child_lo[0] > child_hi[0]) continue;
            for (int a = 0; a < 3; a++) ck_assert(child_lo[a] >= lo[a] && child_hi[a] <= hi[a]);
            look_below(mesh, node->child[o], child_lo, child_hi, once, leaves);
        }
        return;
    }
    const rgi_mesh_leaf *leaf = rgi_mesh_at(mesh, ref);
    ++*leaves;
    ck_assert(leaf->triangles >= 1 && leaf->triangles <= RGI_LEAF && leaf->vertices <= RGI_LEAF);
    for (uint32_t t = 0; t < leaf->triangles; t++) {
        ck_assert_int_eq(once[leaf->primitive[t]]++, 0);
        for (int c = 0; c < 3; c++) {
            uint32_t lane = leaf->corner[c][t], vertex = triangles[leaf->primitive[t]][c];
            ck_assert_uint_lt(lane, leaf->vertices);
            ck_assert_uint_eq(vertex, rgi_mesh_vertex(mesh, leaf, t, (uint32_t)c));
            for (int a = 0; a < 3; a++) {
                float v = (float)((vertices[vertex][a] - mesh->origin[a]) * mesh->scale);
                ck_assert(leaf->at[a][lane] == v && v > lo[a] && v < hi[a]);
                ck_assert(mesh->kept_vertices[vertex][a] == vertices[vertex][a]);
            }
        }
    }
}

START_TEST(every_triangle_is_in_one_leaf_and_its_boxes) {
    const float lo[3] = {-INFINITY, -INFINITY, -INFINITY}, hi[3] = {INFINITY, INFINITY, INFINITY};
    rgi_mesh *mesh = globe();
    uint32_t leaves = 0;
    unsigned char *once = calloc(1, TRIANGLES);
    look_below(mesh, mesh->root, lo, hi, once, &leaves);
    for (uint32_t i = 0; i < TRIANGLES; i++) ck_assert_uint_eq(once[i], 1);
    ck_assert_uint_lt(leaves, TRIANGLES / 8);
    free(once);
    rgi_mesh_destroy(mesh);
    ck_assert_uint_eq(memory.bytes, 0);
}
END_TEST

/* NUMERICS: random aim proves nothing, so each ray aims at a vertex or at a point of an edge. From inside nothing
 * leaks, and what is hit is one of the triangles that share the target. */
START_TEST(watertight_at_vertices_and_edges) {
    rgi_mesh *mesh = globe();
    for (int i = 0; i < 200000; i++) {
        uint32_t triangle = (uint32_t)(unit_random() * TRIANGLES), corner = (uint32_t)(unit_random() * 3);
        const double *a = vertices[triangles[triangle][corner]], *b = vertices[triangles[triangle][(corner + 1) % 3]];
        double origin[3], target[3], along = i % 2 ? 0 : unit_random();
        for (int k = 0; k < 3; k++) {
            origin[k] = 0.4 * (unit_random() - 0.5);
            target[k] = a[k] + along * (b[k] - a[k]);
        }
        rgi_local_ray ray = ray_from(origin, target);
        rgi_candidate c;
        ck_assert_msg(rgi_mesh_intersect(mesh, &ray, &c), "leak: from %a %a %a to %a %a %a", origin[0], origin[1],
                      origin[2], target[0], target[1], target[2]);
        ck_assert(c.u >= 0 && c.v >= 0 && c.u + c.v <= 1 + 0x1p-50);
        bool shares = false;
        for (int k = 0; k < 3; k++) shares |= vertices[triangles[c.primitive][k]] == a;
        ck_assert_msg(c.t < 1 + 1e-12 && (along > 0 || c.t < 1 - 1e-12 || shares),
                      "t %.17g along %g primitive %u of %u", c.t, along, c.primitive, triangle);
        ray.any = true;
        ck_assert(rgi_mesh_intersect(mesh, &ray, &c));
    }
    rgi_mesh_destroy(mesh);
}
END_TEST

/* The closest hit over all triangles, each a mesh of its own. */
static bool test_each(const rgi_local_ray *ray, rgi_candidate *best) {
    bool found = false;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        rg_mesh_views one;
        rgi_mesh *single;
        rgi_candidate c;
        double v[3][3];
        for (int k = 0; k < 3; k++) rgi_copy(vertices[triangles[t][k]], v[k]);
        memset(&one, 0, sizeof one);
        one.vertices = rg_input3_packed(v, sizeof v[0], RG_F64);
        one.vertex_count = 3;
        one.triangle_count = 1;
        ck_assert_int_eq(rgi_mesh_create(&memory, &one, NULL, NULL, &single), RG_OK);
        if (rgi_mesh_intersect(single, ray, &c) && (!found || c.t < best->t)) {
            *best = c;
            best->primitive = t;
            found = true;
        }
        rgi_mesh_destroy(single);
    }
    return found;
}

START_TEST(same_as_testing_each_triangle) {
    rgi_mesh *mesh = globe();
    int hits = 0;
    for (int i = 0; i < 300; i++) {
        double origin[3], target[3];
        for (int k = 0; k < 3; k++) {
            origin[k] = 6 * unit_random() - 3;
            target[k] = 2 * unit_random() - 1;
        }
        rgi_local_ray ray = ray_from(origin, target);
        ray.sides = 1 + (uint32_t)i % 3;
        ray.t_min = i % 5 ? 0 : 0.7;
        rgi_candidate c, best = {INFINITY, {0, 0, 0}, 0, 0, 0};
        bool hit = rgi_mesh_intersect(mesh, &ray, &c);
        ck_assert_int_eq(hit, test_each(&ray, &best));
        if (hit) ck_assert(c.t == best.t && c.primitive == best.primitive && c.u == best.u && c.v == best.v);
        hits += hit;
    }
    ck_assert_int_gt(hits, 100);
    rgi_mesh_destroy(mesh);
}
END_TEST

/* Where no plane parts the triangles the tree must still end, and not grow deep. */
START_TEST(a_thousand_times_the_same_triangle) {
    double v[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    uint32_t t[1000][3];
    rg_mesh_views views;
    rgi_mesh *mesh;
    rgi_candidate c;
    for (int i = 0; i < 1000; i++) memcpy(t[i], (uint32_t[]){0, 1, 2}, 12);
    memset(&views, 0, sizeof views);
    views.vertices = rg_input3_packed(v, sizeof v[0], RG_F64);
    views.vertex_count = 3;
    views.indices = rg_input3_packed(t, sizeof t[0], RG_U32);
    views.triangle_count = 1000;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_mesh_create(&memory, &views, NULL, NULL, &mesh), RG_OK);
    rgi_local_ray ray = ray_from((double[]){0.25, 0.25, 1}, (double[]){0.25, 0.25, 0});
    ck_assert(rgi_mesh_intersect(mesh, &ray, &c) && c.t == 1 && c.primitive == 0 && c.u == 0.25 && c.v == 0.25);
    rgi_mesh_destroy(mesh);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("mesh");
    TCase *tests = tcase_create("mesh");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, every_triangle_is_in_one_leaf_and_its_boxes);
    tcase_add_test(tests, watertight_at_vertices_and_edges);
    tcase_add_test(tests, same_as_testing_each_triangle);
    tcase_add_test(tests, a_thousand_times_the_same_triangle);
    suite_add_tcase(suite, tests);
    return suite;
}
