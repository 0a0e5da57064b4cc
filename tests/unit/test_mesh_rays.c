/* SPDX-License-Identifier: MIT */
/*
 * Rays through meshes: whatever the kernel, the frame, the leaves, the tree and the company of other rays, they meet
 * what testing every triangle in double meets, to the last bit.
 */
#include "machine.h"
#include "mesh_ray.h"
#include "vec.h"

#include <raygrid/raygrid.h>

#include <string.h>

enum { AROUND = 36, RINGS = 24, VERTICES = RINGS * AROUND + 2, TRIANGLES = 2 * RINGS * AROUND, RAYS = 512 };
enum { ROUNDS = SHORT_TESTS ? 1500 : 8000 };

static double vertices[VERTICES][3];
static uint32_t triangles[TRIANGLES][3], holes[2][3];
static rgi_memory memory;

/* A double that is a float. Not by casts: gcc 12 drops two of them in a row. */
static double in_float(double x) {
    volatile float f = (float)x;
    return f;
}

/* A surface with bumps, `stretched` along an axis, around a centre: closed but for two holes, see close_surface. */
static void make_surface(const double centre[3], double size, double stretched, double phase) {
    const double pi = acos(-1);
    uint32_t n = 0;
    for (int r = 0; r < RINGS; r++) {
        for (int s = 0; s < AROUND; s++) {
            double polar = pi * (r + 1) / (RINGS + 1), around = 2 * pi * s / AROUND;
            double radius = size * (1 + 0.1 * sin(5 * around + phase) * sin(4 * polar));
            double *v = vertices[r * AROUND + s];
            rgi_set(v, centre[0] + stretched * radius * sin(polar) * cos(around),
                    centre[1] + radius * sin(polar) * sin(around), centre[2] + radius * cos(polar));
            for (int a = 0; a < 3; a++) v[a] = in_float(v[a]);
        }
    }
    for (int a = 0; a < 3; a++)
        vertices[VERTICES - 2][a] = vertices[VERTICES - 1][a] = in_float(centre[a] + (a == 2 ? size : 0));
    vertices[VERTICES - 1][2] = in_float(centre[2] - size);
    for (uint32_t r = 0; r <= RINGS; r++) {
        for (uint32_t s = 0; s < AROUND; s++) {
            uint32_t t = (s + 1) % AROUND, up = (r - 1) * AROUND, down = r * AROUND;
            uint32_t a = r == 0 ? VERTICES - 2 : up + s, b = r == 0 ? VERTICES - 2 : up + t;
            uint32_t c = r == RINGS ? VERTICES - 1 : down + s, d = r == RINGS ? VERTICES - 1 : down + t;
            if (r != RINGS) memcpy(triangles[n++], (uint32_t[]){a, c, d}, 12);
            if (r != 0) memcpy(triangles[n++], (uint32_t[]){a, r == RINGS ? c : d, b}, 12);
        }
    }
    memcpy(holes[0], triangles[7], 12);
    memcpy(holes[1], triangles[TRIANGLES - 1], 12);
    memcpy(triangles[7], (uint32_t[]){3, 3, 9}, 12);
    memcpy(triangles[TRIANGLES - 1], triangles[0], 12);
}

/* Puts back the two triangles in whose place there was one without area, and one for the second time. */
static void close_surface(void) {
    memcpy(triangles[7], holes[0], 12);
    memcpy(triangles[TRIANGLES - 1], holes[1], 12);
}

typedef struct source {
    float floats[VERTICES][3], soup[3 * TRIANGLES][3];
    double doubles[VERTICES + 1][3];
    uint32_t order[TRIANGLES][3];
    rg_mesh_views views;
} source;

static source given;

enum { FLOATS, DOUBLES, FLOATS_AS_DOUBLES, SOUP, SOUP_WITH_INDICES, FORMS };

/* Triangles that share nothing, from the first to the last or the other way round. */
static void set_soup(rg_mesh_views *v, bool backward) {
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        uint32_t at = 3 * (backward ? TRIANGLES - 1 - i : i);
        for (uint32_t c = 0; c < 3; c++) {
            memcpy(given.soup[at + c], given.floats[triangles[i][c]], 12);
            given.order[i][c] = at + c;
        }
    }
    memset(&v->indices, 0, sizeof v->indices);
    if (backward) v->indices = rg_input3_packed(given.order, sizeof given.order[0], RG_U32);
    v->vertices = rg_input3_packed(given.soup, sizeof given.soup[0], RG_F32);
    v->vertex_count = 3 * TRIANGLES;
}

static const rg_mesh_views *views_of(int form) {
    rg_mesh_views *v = &given.views;
    memset(v, 0, sizeof *v);
    v->size = sizeof *v;
    v->triangle_count = TRIANGLES;
    memcpy(given.doubles, vertices, sizeof vertices);
    /* Of no triangle, and no float: so all are kept in double. */
    for (int a = 0; a < 3; a++) given.doubles[VERTICES][a] = 0.1;
    for (int i = 0; i < VERTICES; i++) {
        for (int a = 0; a < 3; a++) given.floats[i][a] = (float)vertices[i][a];
    }
    v->indices = rg_input3_packed(triangles, sizeof triangles[0], RG_U32);
    v->vertex_count = VERTICES + (form == DOUBLES);
    v->vertices = rg_input3_packed(given.doubles, sizeof given.doubles[0], RG_F64);
    if (form == FLOATS) v->vertices = rg_input3_packed(given.floats, sizeof given.floats[0], RG_F32);
    if (form >= SOUP) set_soup(v, form == SOUP_WITH_INDICES);
    return v;
}

static rgi_mesh *mesh_of(int form) {
    rgi_mesh *mesh;
    rgi_memory_init(&memory, NULL);
    ck_assert_int_eq(rgi_mesh_create(&memory, views_of(form), NULL, NULL, &mesh), RG_OK);
    return mesh;
}

/* Tests all triangles below, passing over nothing. */
static void test_all(rgi_triangle_ray *t, const rgi_mesh *mesh, rgi_mesh_ref ref) {
    if (ref & RGI_MESH_LEAF) {
        const void *leaf = rgi_mesh_at(mesh, ref);
        uint32_t count = 0;
        if (!mesh->soup) count = ((const rgi_mesh_leaf *)leaf)->triangles;
        while (mesh->soup && count < RGI_SOUP_LEAF && rgi_mesh_primitive(mesh, leaf, count) != RGI_NO_TRIANGLE)
            count++;
        rgi_triangles_test(t, mesh, leaf, (1u << count) - 1);
        return;
    }
    const rgi_mesh_node *node = rgi_mesh_at(mesh, ref);
    for (int o = 0; o < RGI_CHILDREN; o++) {
        if (node->lo[0][o] <= node->hi[0][o]) test_all(t, mesh, node->child[o]);
    }
}

/* At a vertex, a point of an edge, or of a triangle; from inside, outside and far away; along axes at times. */
static void aim(const double centre[3], double size, double origin[3], double direction[3]) {
    static const double AWAY[] = {0.3, 2, 3, 9, 60, 1e3}, TINY[] = {0, -0.0, 1e-300, 1e-20};
    const uint32_t *t = triangles[machine_below(TRIANGLES)];
    double w[3] = {1, 0, 0}, away = machine_pick(AWAY, 6) * size;
    int kind = machine_below(4);
    if (kind > 0) w[1] = unit_random();
    if (kind > 1) w[2] = unit_random() * (1 - w[1]);
    w[0] = 1 - w[1] - w[2];
    for (int a = 0; a < 3; a++) {
        double target = w[0] * vertices[t[0]][a] + w[1] * vertices[t[1]][a] + w[2] * vertices[t[2]][a];
        origin[a] = centre[a] + away * (2 * unit_random() - 1);
        direction[a] = target - origin[a];
    }
    int axis = machine_below(9);
    if (axis < 3) {
        double away_along = direction[axis];
        for (int a = 0; a < 3; a++) {
            if (a != axis) origin[a] += direction[a], direction[a] = machine_pick(TINY, 4);
        }
        direction[axis] = away_along != 0 ? away_along : 1;
    }
}

static rgi_local_ray local_ray(const double centre[3], double size) {
    rgi_local_ray ray;
    memset(&ray, 0, sizeof ray);
    aim(centre, size, ray.origin, ray.direction);
    ray.sides = 1 + (uint32_t)machine_below(3);
    ray.shift = machine_below(4) ? 0 : unit_random();
    ray.t_min = machine_below(3) ? 0 : unit_random();
    ray.t_max = machine_below(3) ? INFINITY : ray.t_min + unit_random();
    return ray;
}

static void demand_same(const rgi_mesh *mesh, const rgi_local_ray *given_ray, const char *name) {
    rgi_local_ray ray = *given_ray;
    rgi_triangle_ray all;
    rgi_candidate c;
    rgi_triangle_ray_init(&all, &ray);
    test_all(&all, mesh, mesh->root);
    bool hit = rgi_mesh_intersect(mesh, &ray, &c);
    if (hit != all.found || (hit && (c.t != all.best.t || c.primitive != all.best.primitive)))
        ck_abort_msg("%s: t %a primitive %u, not t %a primitive %u: from %a %a %a along %a %a %a", name,
                     hit ? c.t : INFINITY, c.primitive, all.found ? all.best.t : INFINITY, all.best.primitive,
                     ray.origin[0], ray.origin[1], ray.origin[2], ray.direction[0], ray.direction[1],
                     ray.direction[2]);
    MUST(!hit || (c.u == all.best.u && c.v == all.best.v && memcmp(c.normal, all.best.normal, sizeof c.normal) == 0));
    ray.any = true;
    MUST(rgi_mesh_intersect(mesh, &ray, &c) == all.found);
}

/* Sizes and places where floats are short of bits, or of range. */
static const struct {
    double centre[3], size, stretched;
} PLACES[] = {{{0, 0, 0}, 1, 1},          {{3, -2, 1}, 1, 1},        {{1e3, 0.3, -700}, 1, 0.01},
              {{1e7, 1e7, -3e6}, 100, 1}, {{0, 0, 0}, 1e-30, 1},     {{0, 0, 0}, 1e30, 1e-4},
              {{0, 0, 0}, 1, 1e-6},       {{1e-5, 0, 0}, 1e-7, 100}, {{0, 0, 0}, 1, 0}};
enum { PLACE_COUNT = sizeof PLACES / sizeof *PLACES };

START_TEST(every_kernel_finds_what_testing_all_finds) {
    for (int place = 0; place < PLACE_COUNT; place++) {
        make_surface(PLACES[place].centre, PLACES[place].size, PLACES[place].stretched, place);
        for (int form = 0; form < FORMS; form++) {
            rgi_mesh *mesh = mesh_of(form);
            for (int k = 0; k < MACHINE_KERNELS; k++) {
                if (!machine_can_run(machine_kernels[k])) continue;
                mesh->kernels = machine_kernels[k];
                for (int i = 0; i < ROUNDS / 24; i++) {
                    const rgi_local_ray ray = local_ray(PLACES[place].centre, PLACES[place].size);
                    demand_same(mesh, &ray, machine_kernels[k]->name);
                }
            }
            rgi_mesh_destroy(mesh);
            ck_assert_uint_eq(memory.bytes, 0);
        }
    }
}
END_TEST

/* Nor how much is done for it. */
START_TEST(the_form_of_the_data_changes_no_bit) {
    const rgi_mesh_making hurry = {.fast = true};
    make_surface(PLACES[1].centre, 1, 1, 0);
    rgi_mesh *mesh[2 * FORMS];
    for (int form = 0; form < FORMS; form++) {
        mesh[form] = mesh_of(form);
        ck_assert_int_eq(rgi_mesh_create(&memory, views_of(form), &hurry, NULL, &mesh[FORMS + form]), RG_OK);
    }
    for (int i = 0; i < ROUNDS; i++) {
        rgi_local_ray ray = local_ray(PLACES[1].centre, 1);
        rgi_candidate c[2 * FORMS];
        bool hit[2 * FORMS];
        for (int form = 0; form < 2 * FORMS; form++) hit[form] = rgi_mesh_intersect(mesh[form], &ray, &c[form]);
        for (int form = 1; form < 2 * FORMS; form++) {
            MUST(hit[form] == hit[0]);
            MUST(!hit[0] || (c[form].t == c[0].t && c[form].primitive == c[0].primitive && c[form].u == c[0].u));
        }
    }
    for (int form = 0; form < 2 * FORMS; form++) {
        ck_assert((mesh[form]->kept_vertices != NULL) == (form % FORMS == DOUBLES));
        ck_assert(mesh[form]->soup == (form % FORMS >= SOUP));
        ck_assert((mesh[form]->corners != NULL) == (form % FORMS == SOUP_WITH_INDICES));
        rgi_mesh_destroy(mesh[form]);
    }
}
END_TEST

/* Each vertex that a triangle uses, and all triangles, once. */
START_TEST(what_was_given_can_be_read) {
    static double got[3 * TRIANGLES][3];
    static uint32_t corners[TRIANGLES][3];
    make_surface(PLACES[1].centre, 1, 1, 0);
    for (int form = 0; form < FORMS; form++) {
        const rgi_mesh_making hurry = {.fast = form % 2 == 0};
        rgi_mesh *mesh;
        rgi_memory_init(&memory, NULL);
        ck_assert_int_eq(rgi_mesh_create(&memory, views_of(form), &hurry, NULL, &mesh), RG_OK);
        memset(corners, 0xFF, sizeof corners);
        rgi_mesh_read_vertices(mesh, got);
        rgi_mesh_read_triangles(mesh, corners);
        for (uint32_t i = 0; i < TRIANGLES; i++) {
            MUST(memcmp(corners[i], form < SOUP ? triangles[i] : given.order[i], sizeof corners[i]) == 0);
            for (int c = 0; c < 3; c++)
                MUST(memcmp(got[corners[i][c]], vertices[triangles[i][c]], sizeof got[0]) == 0);
        }
        rgi_mesh_destroy(mesh);
    }
}
END_TEST

/* ------------------------------------------------------------------------------------------------ new vertices */

static void demand_all_same(const rgi_mesh *one, const rgi_mesh *other, const double centre[3], double size) {
    for (int i = 0; i < ROUNDS / 4; i++) {
        rgi_local_ray ray = local_ray(centre, size);
        rgi_candidate a, b;
        bool hit = rgi_mesh_intersect(one, &ray, &a);
        MUST(hit == rgi_mesh_intersect(other, &ray, &b));
        MUST(!hit || (a.t == b.t && a.primitive == b.primitive && a.u == b.u && a.v == b.v));
    }
}

/* Bent a little the tree is fitted, shuffled it is made anew: either way as if the mesh were new. */
START_TEST(new_vertices_are_as_a_new_mesh) {
    static const double HOME[3] = {0.5, 0, 0}, AWAY[3] = {2, 1, -1};
    for (int form = 0; form < FORMS; form++) {
        make_surface(HOME, 1, 1, 0);
        rgi_mesh *first = mesh_of(form), *bent, *fresh, *shuffled, *fresh_shuffled;
        make_surface(AWAY, 1.5, 0.8, 1);
        ck_assert_int_eq(rgi_mesh_deform(&memory, first, NULL, views_of(form), &bent), RG_OK);
        ck_assert_int_eq(rgi_mesh_create(&memory, views_of(form), NULL, NULL, &fresh), RG_OK);
        ck_assert(bent->cost == first->cost); /* as built, not as it is now */
        ck_assert(memcmp(bent->lo, fresh->lo, sizeof bent->lo) == 0 && memcmp(bent->hi, fresh->hi, 24) == 0);
        demand_all_same(bent, fresh, AWAY, 1.5);
        for (int i = VERTICES - 1; i > 0; i--) {
            double swap[3];
            int j = machine_below(i + 1);
            memcpy(swap, vertices[i], sizeof swap);
            memcpy(vertices[i], vertices[j], sizeof swap);
            memcpy(vertices[j], swap, sizeof swap);
        }
        ck_assert_int_eq(rgi_mesh_deform(&memory, bent, NULL, views_of(form), &shuffled), RG_OK);
        ck_assert_int_eq(rgi_mesh_create(&memory, views_of(form), NULL, NULL, &fresh_shuffled), RG_OK);
        ck_assert(shuffled->cost == fresh_shuffled->cost);
        demand_all_same(shuffled, fresh_shuffled, AWAY, 1.5);
        rgi_mesh *all[] = {first, bent, fresh, shuffled, fresh_shuffled};
        for (int i = 0; i < 5; i++) rgi_mesh_destroy(all[i]);
        ck_assert_uint_eq(memory.bytes, 0);
    }
}
END_TEST

START_TEST(new_vertices_that_do_not_fit_are_refused) {
    rg_shape *shape, *other = NULL;
    make_surface(PLACES[0].centre, 1, 1, 0);
    rg_mesh_views views = *views_of(FLOATS);
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, &shape), RG_OK);
    views.vertex_count--;
    ck_assert_int_eq(rg_shape_create_deformed(NULL, shape, &views, &other), RG_INVALID_VALUE);
    views = *views_of(FLOATS);
    given.floats[5][1] = NAN;
    ck_assert_int_eq(rg_shape_create_deformed(NULL, shape, &views, &other), RG_INVALID_VALUE);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "vertex 5 has y = nan"));
    views = *views_of(FLOATS);
    ck_assert_ptr_null(other);
    rg_shape *ball;
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &ball), RG_OK);
    ck_assert_int_eq(rg_shape_create_deformed(NULL, ball, &views, &other), RG_INVALID_ARGUMENT);
    rg_shape_config config;
    ck_assert_int_eq(rg_shape_config_default(&config, sizeof config), RG_OK);
    config.quality = 2;
    ck_assert_int_eq(rg_shape_create_mesh(&config, &views, &other), RG_INVALID_ARGUMENT);
    config.quality = RG_MESH_FAST;
    config.workers = 1025;
    ck_assert_int_eq(rg_shape_create_mesh(&config, &views, &other), RG_INVALID_VALUE);
    /* The triangles are those of the mesh, whatever the views say. */
    rg_shape_report report = {.size = sizeof report};
    memset(&views.indices, 0, sizeof views.indices);
    views.triangle_count = 0;
    ck_assert_int_eq(rg_shape_create_deformed(NULL, shape, &views, &other), RG_OK);
    ck_assert_int_eq(rg_shape_stats(other, &report), RG_OK);
    ck_assert_uint_eq(report.triangle_count, TRIANGLES);
    rg_shape_release(&other);
    rg_shape_release(&ball);
    rg_shape_release(&shape);
}
END_TEST

/* ------------------------------------------------------------------------------------------------ how it is made */

static void run_backward(void *user, uint64_t count, void (*body)(void *context, uint64_t index), void *context) {
    *(uint64_t *)user += count;
    while (count-- > 0) body(context, count);
}

START_TEST(who_helps_changes_nothing) {
    enum { LARGE = 20000 };
    static float soup[3 * LARGE][3];
    uint64_t jobs = 0;
    rg_mesh_views views = {.size = sizeof views, .vertex_count = 3 * LARGE, .triangle_count = LARGE};
    views.vertices = rg_input3_packed(soup, sizeof soup[0], RG_F32);
    for (int i = 0; i < 3 * LARGE; i++) {
        for (int a = 0; a < 3; a++)
            soup[i][a] = i % 3 ? soup[i - i % 3][a] + 0.05f * (float)unit_random() : (float)unit_random();
    }
    const rgi_mesh_making ways[] = {
        {0}, {.workers = 3}, {.parallel_for = run_backward, .parallel_for_user = &jobs}, {.fast = true}};
    rgi_mesh *mesh[4];
    rgi_memory_init(&memory, NULL);
    for (int i = 0; i < 4; i++) ck_assert_int_eq(rgi_mesh_create(&memory, &views, &ways[i], NULL, &mesh[i]), RG_OK);
    ck_assert_uint_gt(jobs, 10);
    for (int i = 1; i < 3; i++) {
        ck_assert_uint_eq(mesh[i]->line_count, mesh[0]->line_count);
        ck_assert_int_eq(memcmp(mesh[i]->lines, mesh[0]->lines, (size_t)mesh[0]->line_count * RGI_MESH_LINE), 0);
    }
    for (int i = 0; i < 500; i++) {
        rgi_local_ray ray = {.t_max = INFINITY, .sides = RGI_FRONT | RGI_BACK};
        for (int a = 0; a < 3; a++) ray.origin[a] = unit_random(), ray.direction[a] = unit_random() - 0.5;
        demand_same(mesh[0], &ray, "the best");
        demand_same(mesh[3], &ray, "the fast");
    }
    for (int i = 0; i < 4; i++) rgi_mesh_destroy(mesh[i]);
    ck_assert_uint_eq(memory.bytes, 0);
}
END_TEST

/* ------------------------------------------------------------------------------------------------ in scenes */

static rg_pose some_pose(const double at[3], int i) {
    rg_pose pose = rg_pose_at(at[0] + 6 * (i % 3) - 6, at[1] + 6 * (i / 3) - 6, at[2]);
    if (i % 2) pose.scale = 1.5;
    if (i == 4 || i == 8) pose.linear[0] = -1; /* mirrored */
    if (i == 2) pose.linear[1] = 0.7f, pose.linear[8] = 0.3f;
    return pose;
}

/* Rays from an eye, 16 after 16 so near to each other that they go together, at nine objects at an offset. */
static void fill_rays(rg_ray *rays, const double at[3], bool inside) {
    for (int i = 0; i < RAYS; i++) {
        double eye[3] = {at[0] + (inside ? 0.1 : 1), at[1], at[2] + (inside ? 0.2 : -30)}, target[3];
        const uint32_t *t = triangles[(i / 16 * 37 + i % 4) % TRIANGLES];
        double w = i % 3 == 0 ? 0 : unit_random();
        rg_pose pose = some_pose(at, inside ? 4 : i / 16 % 9);
        for (int a = 0; a < 3; a++) {
            double on = (1 - w) * vertices[t[0]][a] + w * vertices[t[1]][a];
            target[a] = pose.position[a] + (a == 0 ? (double)pose.linear[0] : 1) * pose.scale * on;
        }
        rgi_sub(target, eye, target);
        rays[i] = rg_ray_from(eye, target);
        if (i % 7 == 3) rays[i].t_max = 1;
        if (i % 64 > 40) rays[i].mask = 2;
    }
}

/* Every third triangle is as glass. */
static int32_t is_opaque(void *user, uint64_t ray, const rg_hit *hit) {
    (void)user;
    (void)ray;
    return hit->primitive % 3 != 0;
}

/* The ways that a batch may go. */
typedef enum way { IN_PACKETS, SIDE_BY_SIDE, SIDE_BY_SIDE_WITH_FILTER, WAYS } way;

static void demand_same_hits(rg_scene *scene, const rg_ray *rays, rg_cull cull, way way, uint32_t *found) {
    static rg_hit together[RAYS], alone[RAYS];
    static uint8_t any[RAYS], any_alone[RAYS];
    rg_trace_config config = {.size = sizeof config, .cull = cull, .coherence = RG_COHERENCE_LOW};
    if (way == IN_PACKETS) config.coherence = RG_COHERENCE_HIGH;
    if (way == SIDE_BY_SIDE_WITH_FILTER) config.filter = is_opaque;
    rg_ray_views in = {.size = sizeof in};
    rg_hit_views out = {.size = sizeof out};
    memset(together, 0, sizeof together);
    memset(alone, 0, sizeof alone);
    in.t_max = (rg_input){&rays->t_max, sizeof *rays, RG_F64};
    in.mask = (rg_input){&rays->mask, sizeof *rays, RG_U32};
    out.t = (rg_output){&together->t, sizeof *together, RG_F64};
    out.object = (rg_output){&together->object, sizeof *together, RG_U64};
    out.primitive = (rg_output){&together->primitive, sizeof *together, RG_U32};
    rg_output flags = {any, 1, RG_U8};
    in.origin = rg_input3_packed(rays->origin, sizeof *rays, RG_F64);
    in.direction = rg_input3_packed(rays->direction, sizeof *rays, RG_F64);
    ck_assert_int_eq(rg_scene_trace_views(scene, &config, &in, &out, RAYS), RG_OK);
    ck_assert_int_eq(rg_scene_occluded_views(scene, &config, &in, &flags, RAYS), RG_OK);
    for (int i = 0; i < RAYS; i++) {
        in.origin = rg_input3_packed(rays[i].origin, 0, RG_F64);
        in.direction = rg_input3_packed(rays[i].direction, 0, RG_F64);
        in.t_max.data = &rays[i].t_max;
        in.mask.data = &rays[i].mask;
        out.t.data = &alone[i].t;
        out.object.data = &alone[i].object;
        out.primitive.data = &alone[i].primitive;
        flags.data = &any_alone[i];
        ck_assert_int_eq(rg_scene_trace_views(scene, &config, &in, &out, 1), RG_OK);
        ck_assert_int_eq(rg_scene_occluded_views(scene, &config, &in, &flags, 1), RG_OK);
        if (memcmp(&together[i], &alone[i], sizeof alone[i]) != 0 || any[i] != any_alone[i])
            ck_abort_msg("ray %d: t %a object %d primitive %u %d together, t %a object %d primitive %u %d alone", i,
                         together[i].t, (int)together[i].object, together[i].primitive, any[i], alone[i].t,
                         (int)alone[i].object, alone[i].primitive, any_alone[i]);
        MUST((alone[i].t < INFINITY) == any[i]);
        *found += any[i];
    }
}

static const double OFFSETS[][3] = {{0, 0, 0}, {1e3 + 0.37, -1e3, 5}, {1e7 + 0.56, 3e6, -1e7}};

static rg_scene *nine_objects(const double at[3], rg_shape *shape, rg_object ids[9]) {
    rg_scene *scene;
    ck_assert_int_eq(rg_scene_create(NULL, &scene), RG_OK);
    for (int i = 0; i < 9; i++) {
        rg_pose pose = some_pose(at, i);
        ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, &ids[i]), RG_OK);
    }
    return scene;
}

START_TEST(together_as_alone) {
    static rg_ray rays[RAYS];
    uint32_t found = 0, few_found = 0;
    make_surface(PLACES[0].centre, 1, 1, 0);
    for (int form = 0; form < FORMS; form++) {
        rg_shape *shape;
        ck_assert_int_eq(rg_shape_create_mesh(NULL, views_of(form), &shape), RG_OK);
        for (size_t n = 0; n < sizeof OFFSETS / sizeof *OFFSETS; n++) {
            rg_object ids[9];
            rg_scene *scene = nine_objects(OFFSETS[n], shape, ids);
            for (int round = 0; round < 4; round++) {
                fill_rays(rays, OFFSETS[n], round == 3);
                if (round == 2) ck_assert_int_eq(rg_scene_set_mask(scene, ids[4], 1), RG_OK);
                for (rg_cull cull = RG_CULL_NONE; cull <= RG_CULL_FRONT; cull++)
                    demand_same_hits(scene, rays, cull, (way)((round + cull) % WAYS), &found);
            }
            /* Few are gone through without the grid. */
            for (int i = 0; i < 9; i++) {
                if (i != 2 && i != 4) ck_assert_int_eq(rg_scene_remove(scene, ids[i]), RG_OK);
            }
            for (way way = IN_PACKETS; way < WAYS; way++)
                demand_same_hits(scene, rays, RG_CULL_NONE, way, &few_found);
            ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
        }
        rg_shape_release(&shape);
    }
    ck_assert_uint_gt(found, FORMS * 3 * 4 * 3 * RAYS / 3);
    ck_assert_uint_gt(few_found, FORMS * 3 * 3 * RAYS / 3);
}
END_TEST

/* Objects of forty sizes around one point, all around it: rays there have more before them than a stack of
 * theirs holds. And a mesh that counts as deeper than rays side by side have room for. */
START_TEST(where_room_ends) {
    enum { SIZES = 40 };
    const double MIDDLE = 0.37;
    static rg_ray rays[RAYS];
    rg_scene *scene;
    rg_shape *shape;
    uint32_t found = 0;
    make_surface(PLACES[0].centre, 1, 1, 0);
    ck_assert_int_eq(rg_shape_create_mesh(NULL, views_of(FLOATS), &shape), RG_OK);
    ck_assert_int_eq(rg_scene_create(NULL, &scene), RG_OK);
    for (int i = 0; i < 26 * SIZES; i++) {
        double far = ldexp(1, -(i / 26));
        int place = i % 26 + (i % 26 >= 13); /* of 27, but for the middle */
        rg_pose pose = rg_pose_at(MIDDLE + far * (place % 3 - 1), MIDDLE + far * (place / 3 % 3 - 1),
                                  MIDDLE + far * (place / 9 - 1));
        pose.scale = 0.4 * far;
        ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, NULL), RG_OK);
    }
    for (int i = 0; i < RAYS; i++) {
        double eye[3], direction[3], near = ldexp(1, -(int)machine_below(SIZES));
        for (int a = 0; a < 3; a++) {
            eye[a] = 20 * (unit_random() - 0.5);
            direction[a] = MIDDLE + near * (unit_random() - 0.5) - eye[a];
        }
        rays[i] = rg_ray_from(eye, direction);
    }
    const uint32_t levels = shape->of.mesh->levels;
    for (int deep = 0; deep < 2; deep++) {
        shape->of.mesh->levels = deep ? RGI_MESH_LEVELS + 1 : levels;
        for (way way = IN_PACKETS; way < WAYS; way++) demand_same_hits(scene, rays, RG_CULL_NONE, way, &found);
    }
    ck_assert_uint_gt(found, 2 * WAYS * RAYS / 10);
    ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
    rg_shape_release(&shape);
}
END_TEST

/* From inside a closed mesh no ray at an edge or a vertex gets out, by whatever way it is asked. */
START_TEST(nothing_leaks) {
    static rg_ray rays[RAYS];
    static rg_hit hits[RAYS];
    static uint8_t any[RAYS];
    for (size_t n = 0; n < sizeof OFFSETS / sizeof *OFFSETS; n++) {
        rg_shape *shape;
        rg_scene *scene;
        make_surface(PLACES[0].centre, 1, 1, 0);
        close_surface();
        rg_mesh_views views = *views_of(DOUBLES);
        ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, &shape), RG_OK);
        ck_assert_int_eq(rg_scene_create(NULL, &scene), RG_OK);
        rg_pose pose = rg_pose_at(OFFSETS[n][0], OFFSETS[n][1], OFFSETS[n][2]);
        ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, NULL), RG_OK);
        for (int round = 0; round < (SHORT_TESTS ? 20 : 100); round++) {
            double eye[3] = {0.2 * unit_random(), 0.2 * unit_random(), 0.2 * unit_random()};
            for (int i = 0; i < RAYS; i++) {
                const uint32_t *t = triangles[machine_below(TRIANGLES)];
                double w = i % 2 ? unit_random() : 0, origin[3], direction[3];
                for (int a = 0; a < 3; a++) {
                    origin[a] = OFFSETS[n][a] + eye[a];
                    direction[a] = (1 - w) * vertices[t[0]][a] + w * vertices[t[1]][a] - (origin[a] - OFFSETS[n][a]);
                }
                rays[i] = rg_ray_from(origin, direction);
            }
            ck_assert_int_eq(rg_scene_trace(scene, rays, hits, RAYS), RG_OK);
            ck_assert_int_eq(rg_scene_occluded(scene, rays, any, RAYS), RG_OK);
            for (int i = 0; i < RAYS; i++) {
                rg_hit one;
                ck_assert_int_eq(rg_scene_trace(scene, &rays[i], &one, 1), RG_OK);
                MUST(any[i] == 1 && hits[i].t < INFINITY && one.t == hits[i].t);
            }
        }
        ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
        rg_shape_release(&shape);
    }
}
END_TEST

START_TEST(a_shape_in_place_of_another) {
    static rg_ray rays[RAYS];
    rg_shape *small, *large, *huge;
    rg_object ids[9];
    rg_object_report report = {.size = sizeof report};
    rg_hit hit;
    uint32_t found = 0;
    make_surface(PLACES[0].centre, 1, 1, 0);
    ck_assert_int_eq(rg_shape_create_mesh(NULL, views_of(FLOATS), &small), RG_OK);
    rg_scene *scene = nine_objects(OFFSETS[0], small, ids), *other = nine_objects(OFFSETS[0], small, ids);
    make_surface(PLACES[0].centre, 2, 1, 1);
    ck_assert_int_eq(rg_shape_create_deformed(NULL, small, views_of(FLOATS), &large), RG_OK);
    rg_ray past = rg_ray_from((double[3]){0.1, 1.9, -30}, (double[3]){0, 0, 1});
    ck_assert_int_eq(rg_scene_trace(scene, &past, &hit, 1), RG_OK);
    ck_assert(hit.object == RG_NO_OBJECT);
    ck_assert_int_eq(rg_scene_replace_shape(scene, small, large), RG_OK);
    ck_assert_int_eq(rg_scene_trace(scene, &past, &hit, 1), RG_OK);
    ck_assert(hit.object == ids[4]);
    ck_assert_int_eq(rg_scene_trace(other, &past, &hit, 1), RG_OK);
    ck_assert(hit.object == RG_NO_OBJECT);
    for (int i = 0; i < 9; i++) {
        ck_assert_int_eq(rg_scene_lookup(scene, ids[i], &report), RG_OK);
        ck_assert(report.shape == large && report.pose.scale == some_pose(OFFSETS[0], i).scale);
        ck_assert(memcmp(report.pose.linear, some_pose(OFFSETS[0], i).linear, sizeof report.pose.linear) == 0);
        ck_assert_int_eq(rg_scene_lookup(other, ids[i], &report), RG_OK);
        ck_assert(report.shape == small);
    }
    fill_rays(rays, OFFSETS[0], false);
    demand_same_hits(scene, rays, RG_CULL_NONE, IN_PACKETS, &found);
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1e100, &huge), RG_OK);
    rg_pose far_away = rg_pose_at(1e100, 0, 0);
    far_away.scale = 3.5;
    ck_assert_int_eq(rg_scene_move(scene, ids[0], &far_away), RG_OK);
    ck_assert_int_eq(rg_scene_replace_shape(scene, large, huge), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_scene_lookup(scene, ids[8], &report), RG_OK);
    ck_assert(report.shape == large);
    ck_assert_int_eq(rg_scene_replace_shape(scene, large, NULL), RG_INVALID_ARGUMENT);
    rg_shape_release(&small);
    rg_shape_release(&large);
    rg_shape_release(&huge);
    ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
    ck_assert_int_eq(rg_scene_destroy(&other), RG_OK);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("mesh_rays");
    TCase *tests = tcase_create("mesh_rays");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, every_kernel_finds_what_testing_all_finds);
    tcase_add_test(tests, the_form_of_the_data_changes_no_bit);
    tcase_add_test(tests, what_was_given_can_be_read);
    tcase_add_test(tests, new_vertices_are_as_a_new_mesh);
    tcase_add_test(tests, new_vertices_that_do_not_fit_are_refused);
    tcase_add_test(tests, who_helps_changes_nothing);
    tcase_add_test(tests, together_as_alone);
    tcase_add_test(tests, where_room_ends);
    tcase_add_test(tests, nothing_leaks);
    tcase_add_test(tests, a_shape_in_place_of_another);
    suite_add_tcase(suite, tests);
    return suite;
}
