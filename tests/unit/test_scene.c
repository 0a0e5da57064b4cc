/* SPDX-License-Identifier: MIT */
/* Scenes through the public calls: what the conformance suite, which knows no callbacks and no threads, can't say. */
#include "unit.h"

#include <raygrid/raygrid.h>

#include <pthread.h>
#include <string.h>

static rg_scene *scene;
static rg_shape *ball;

static rg_ray along_x(double y, double z) {
    return rg_ray_from((double[]){-10, y, z}, (double[]){1, 0, 0});
}

static rg_hit trace(rg_scene *s, rg_ray ray) {
    rg_hit hit;
    ck_assert_int_eq(rg_scene_trace(s, &ray, &hit, 1), RG_OK);
    return hit;
}

static rg_object insert_at(double x, double y, double z) {
    rg_pose pose = rg_pose_at(x, y, z);
    rg_object id = RG_NO_OBJECT;
    ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, &id), RG_OK);
    return id;
}

/* ---------------------------------------------------------------------------------------------- callbacks */

typedef struct probe {
    rg_scene *scene;
    rg_object object;
    rg_result change, destroyed, trace, lookup;
    int32_t answer;
    double t;
    int called; /* atomic */
} probe;

/* Tries everything on the scene that is being traced. */
static int32_t try_all(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    probe *p = user;
    if (__atomic_fetch_add(&p->called, 1, __ATOMIC_RELAXED) == 0) {
        rg_pose pose = rg_pose_at(0, 0, 0);
        rg_object_report report;
        rg_ray aside = along_x(50, 0);
        rg_hit other;
        rg_scene *own = p->scene;
        report.size = sizeof report;
        p->change = rg_scene_move(p->scene, p->object, &pose);
        ck_assert_int_eq(rg_scene_insert(p->scene, ball, NULL, NULL), RG_BUSY);
        ck_assert_int_eq(rg_scene_remove(p->scene, p->object), RG_BUSY);
        ck_assert_int_eq(rg_scene_set_mask(p->scene, p->object, 0), RG_BUSY);
        ck_assert_int_eq(rg_grid_rebuild(p->scene, RG_GRID_OF_SCENE), RG_BUSY);
        p->destroyed = rg_scene_destroy(&own);
        p->lookup = rg_scene_lookup(p->scene, p->object, &report);
        p->trace = rg_scene_trace(p->scene, &aside, &other, 1);
    }
    hit->t = p->t;
    hit->normal[0] = -1;
    (void)ray;
    return p->answer;
}

static rg_shape *user_shape(probe *p) {
    rg_user_shape definition;
    rg_shape *shape;
    memset(&definition, 0, sizeof definition);
    definition.size = sizeof definition;
    definition.user = p;
    definition.intersect = try_all;
    for (int a = 0; a < 3; a++) {
        definition.lo[a] = -1;
        definition.hi[a] = 1;
    }
    ck_assert_int_eq(rg_shape_create_user(NULL, &definition, &shape), RG_OK);
    return shape;
}

START_TEST(a_callback_may_trace_but_not_change) {
    probe p = {scene, 0, RG_OK, RG_OK, RG_BUSY, RG_BUSY, 1, 10, 0};
    rg_shape *shape = user_shape(&p);
    p.object = insert_at(20, 0, 0);
    ck_assert_int_eq(rg_scene_insert(scene, shape, NULL, NULL), RG_OK);
    rg_hit hit = trace(scene, along_x(0, 0));
    ck_assert(hit.t == 10);
    ck_assert_int_eq(p.change, RG_BUSY);
    ck_assert_int_eq(p.destroyed, RG_BUSY);
    ck_assert_int_eq(p.lookup, RG_OK);
    ck_assert_int_eq(p.trace, RG_OK);
    /* The same on workers. */
    rg_ray rays[5000];
    rg_hit hits[5000];
    p.called = 0;
    for (int i = 0; i < 5000; i++) rays[i] = along_x(0, 0);
    ck_assert_int_eq(rg_scene_trace(scene, rays, hits, 5000), RG_OK);
    for (int i = 0; i < 5000; i++) ck_assert(hits[i].t == 10);
    ck_assert_int_eq(p.change, RG_BUSY);
    rg_shape_release(&shape);
}
END_TEST

START_TEST(a_callback_that_fails_is_no_miss) {
    probe p = {scene, 0, RG_OK, RG_OK, RG_OK, RG_OK, -1, 10, 1};
    rg_shape *shape = user_shape(&p);
    ck_assert_int_eq(rg_scene_insert(scene, shape, NULL, NULL), RG_OK);
    insert_at(0, 5, 0);
    rg_ray rays[2] = {along_x(0, 0), along_x(5, 0)};
    rg_hit hits[2];
    uint8_t occluded[2] = {9, 9};
    for (int kind = 0; kind < 2; kind++) {
        ck_assert_int_eq(rg_scene_trace(scene, rays, hits, 2), RG_CALLBACK_FAILED);
        ck_assert(isnan(hits[0].t) && hits[0].object == RG_NO_OBJECT);
        ck_assert(hits[1].t == 9);
        ck_assert_int_eq(rg_scene_occluded(scene, rays, occluded, 2), RG_CALLBACK_FAILED);
        ck_assert(occluded[0] == 0 && occluded[1] == 1);
        p.answer = 1;
        p.t = NAN;
    }
    rg_shape_release(&shape);
}
END_TEST

static int32_t only_far(void *user, uint64_t index, const rg_hit *candidate) {
    ck_assert_uint_eq(index, 0);
    ck_assert(candidate->normal[0] != 0 && candidate->offset > 0 && candidate->object != RG_NO_OBJECT);
    return candidate->t > *(double *)user;
}

static int32_t break_down(void *user, uint64_t index, const rg_hit *candidate) {
    (void)user, (void)index, (void)candidate;
    return -1;
}

START_TEST(filters) {
    rg_trace_config config;
    rg_ray ray = along_x(0, 0);
    rg_ray_views rays;
    rg_hit_views hits;
    double beyond = 9.5, t = 0;
    insert_at(0, 0, 0);
    insert_at(7, 0, 0);
    ck_assert_int_eq(rg_trace_config_default(&config, sizeof config), RG_OK);
    config.filter = only_far;
    config.filter_user = &beyond;
    memset(&rays, 0, sizeof rays);
    memset(&hits, 0, sizeof hits);
    rays.size = sizeof rays;
    hits.size = sizeof hits;
    rays.origin = rg_input3_packed(ray.origin, 0, RG_F64);
    rays.direction = rg_input3_packed(ray.direction, 0, RG_F64);
    hits.t.data = &t;
    const double expected[][2] = {{8, 9}, {9.5, 11}, {11.5, 16}, {17, 18}, {19, INFINITY}};
    for (int i = 0; i < 5; i++) {
        beyond = expected[i][0];
        ck_assert_int_eq(rg_scene_trace_views(scene, &config, &rays, &hits, 1), RG_OK);
        ck_assert(t == expected[i][1]);
    }
    config.filter = break_down;
    ck_assert_int_eq(rg_scene_trace_views(scene, &config, &rays, &hits, 1), RG_CALLBACK_FAILED);
    ck_assert(isnan(t));
}
END_TEST

/* --------------------------------------------------------------------------------------- host's own hooks */

static void count_bodies(void *user, uint64_t count, void (*body)(void *, uint64_t), void *context) {
    *(uint64_t *)user += count;
    for (uint64_t i = count; i-- > 0;) body(context, i);
}

START_TEST(the_hosts_own_parallel_for) {
    rg_scene_config config;
    uint64_t bodies = 0;
    rg_scene *own;
    rg_scene_report report;
    static rg_ray rays[20000];
    static rg_hit hits[20000];
    ck_assert_int_eq(rg_scene_config_default(&config, sizeof config), RG_OK);
    config.parallel_for = count_bodies;
    config.parallel_for_user = &bodies;
    ck_assert_int_eq(rg_scene_create(&config, &own), RG_OK);
    ck_assert_int_eq(rg_scene_insert(own, ball, NULL, NULL), RG_OK);
    for (int i = 0; i < 20000; i++) rays[i] = along_x(i % 3, 0);
    ck_assert_int_eq(rg_scene_trace(own, rays, hits, 100), RG_OK);
    ck_assert_uint_eq(bodies, 0);
    ck_assert_int_eq(rg_scene_trace(own, rays, hits, 20000), RG_OK);
    ck_assert_uint_gt(bodies, 10);
    for (int i = 0; i < 20000; i++) ck_assert(hits[i].t == (i % 3 == 0 ? 9 : i % 3 == 1 ? 10 : INFINITY));
    report.size = sizeof report;
    ck_assert_int_eq(rg_scene_stats(own, &report), RG_OK);
    ck_assert_uint_eq(report.workers, 0);
    ck_assert_int_eq(rg_scene_destroy(&own), RG_OK);
}
END_TEST

/* ------------------------------------------------------------------------------------ ids and bulk calls */

START_TEST(ids) {
    rg_object first = insert_at(0, 0, 0), second = insert_at(5, 0, 0);
    ck_assert_uint_eq(first, 1ull << 32);
    ck_assert_uint_eq(second, 1ull << 32 | 1);
    ck_assert_int_eq(rg_scene_remove(scene, first), RG_OK);
    rg_object again = insert_at(0, 0, 0);
    ck_assert_uint_eq(RG_OBJECT_SLOT(again), 0);
    ck_assert_uint_eq(again >> 32, 2);
    const rg_object stale[] = {first, RG_NO_OBJECT, 7ull << 32 | 1, 1ull << 32 | 2, UINT64_MAX};
    rg_pose pose = rg_pose_at(0, 0, 0);
    rg_object_report report;
    report.size = sizeof report;
    for (int i = 0; i < 5; i++) {
        ck_assert_int_eq(rg_scene_move(scene, stale[i], &pose), RG_INVALID_ID);
        ck_assert_int_eq(rg_scene_move_to(scene, stale[i], pose.position), RG_INVALID_ID);
        ck_assert_int_eq(rg_scene_remove(scene, stale[i]), RG_INVALID_ID);
        ck_assert_int_eq(rg_scene_set_mask(scene, stale[i], 1), RG_INVALID_ID);
        ck_assert_int_eq(rg_scene_lookup(scene, stale[i], &report), RG_INVALID_ID);
    }
}
END_TEST

START_TEST(bulk_calls_are_whole_or_nothing) {
    enum { MANY = 50 };
    double positions[MANY][3] = {{0, 0, 0}};
    rg_object ids[MANY];
    rg_pose_views poses;
    rg_insert_views views;
    rg_output out = {ids, sizeof ids[0], RG_U64};
    rg_input in = {ids, sizeof ids[0], RG_U64};
    memset(&poses, 0, sizeof poses);
    memset(&views, 0, sizeof views);
    poses.size = sizeof poses;
    poses.position = rg_input3_packed(positions, sizeof positions[0], RG_F64);
    views.size = sizeof views;
    views.shapes = &ball;
    views.poses = &poses;
    for (int i = 0; i < MANY; i++) {
        for (int a = 0; a < 3; a++) positions[i][a] = a == 0 ? 3 * i : 0;
        ids[i] = 77;
    }
    positions[MANY - 1][2] = NAN;
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, MANY, &out), RG_INVALID_VALUE);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "object 49"));
    ck_assert_uint_eq(ids[0], 77);
    ck_assert(trace(scene, along_x(0, 0)).t == INFINITY);
    positions[MANY - 1][2] = 0;
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, MANY, &out), RG_OK);
    ck_assert(trace(scene, along_x(0, 0)).t == 9);

    positions[0][1] = 100;
    positions[MANY - 1][2] = INFINITY;
    ck_assert_int_eq(rg_scene_move_many(scene, &in, &poses, MANY), RG_INVALID_VALUE);
    ck_assert(trace(scene, along_x(0, 0)).t == 9);
    positions[MANY - 1][2] = 0;
    ck_assert_int_eq(rg_scene_move_many(scene, &in, &poses, MANY), RG_OK);
    ck_assert(trace(scene, along_x(0, 0)).t == 12 && trace(scene, along_x(100, 0)).t == 9);

    rg_object last = ids[MANY - 1];
    ids[MANY - 1] = ids[3];
    ck_assert_int_eq(rg_scene_remove_many(scene, &in, MANY), RG_INVALID_ID);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "twice"));
    ck_assert(trace(scene, along_x(0, 0)).object == ids[1]);
    ids[MANY - 1] = last;
    ck_assert_int_eq(rg_scene_remove_many(scene, &in, MANY), RG_OK);
    ck_assert(trace(scene, along_x(0, 0)).t == INFINITY);
}
END_TEST

/* A ray all but parallel to an endless plane: hits up to 2e102 away have finite positions, beyond there are none. */
START_TEST(endless_planes) {
    const double lo[3] = {-INFINITY, -1, -INFINITY}, hi[3] = {INFINITY, 0, INFINITY};
    rg_shape *plane;
    rg_object id;
    ck_assert_int_eq(rg_shape_create_box(NULL, lo, hi, &plane), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, plane, NULL, &id), RG_OK);
    for (int e = 0; e >= -307; e--) {
        double slope = pow(10, e);
        rg_hit hit = trace(scene, rg_ray_from((double[]){0, 1, 0}, (double[]){1, -slope, 0}));
        ck_assert_uint_eq(hit.object, e >= -102 ? id : RG_NO_OBJECT);
        if (e < -102) continue;
        ck_assert_double_le(fabs(hit.t * slope - 1), 1e-15);
        ck_assert_double_le(fabs(hit.position[0] * slope - 1), 1e-15);
        ck_assert(fabs(hit.position[1]) <= 1e-15 && hit.normal[1] == 1);
    }
    rg_shape_release(&plane);
}
END_TEST

/* A scale beside the pose is what its product with the shape, or with the linear part, would be; and is given back.
 */
START_TEST(scales) {
    static const double wanted[] = {0.1, 1e-90, 3, 1e90, 0};
    for (int i = 0; i < 5; i++) {
        rg_object_report report = {.size = sizeof report};
        rg_object object;
        rg_hit hit;
        double scale = wanted[i] == 0 ? 1 : wanted[i];
        rg_pose pose = rg_pose_at(0, 0, 0);
        pose.scale = wanted[i];
        ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, &object), RG_OK);
        for (int turned = 0; turned < 2; turned++) {
            const double from[3] = {0, 0, -100 * scale}, along[3] = {0, 0, scale};
            const rg_ray ray = rg_ray_from(from, along);
            ck_assert_int_eq(rg_scene_trace(scene, &ray, &hit, 1), RG_OK);
            ck_assert_double_eq_tol(hit.t, turned ? 98 : 99, 1e-12);
            ck_assert_int_eq(rg_scene_lookup(scene, object, &report), RG_OK);
            ck_assert_double_eq(report.pose.scale, scale);
            ck_assert_double_le(report.hi[2], (turned ? 2.0001 : 1.0001) * scale);
            pose.linear[8] = 2;
            if (!turned) ck_assert_int_eq(rg_scene_move(scene, object, &pose), RG_OK);
        }
        ck_assert_int_eq(rg_scene_remove(scene, object), RG_OK);
    }
    static const double refused[] = {-1, 1e-101, 1e101, NAN, INFINITY};
    for (int i = 0; i < 5; i++) {
        rg_pose pose = rg_pose_at(0, 0, 0);
        pose.scale = refused[i];
        ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, NULL), RG_INVALID_VALUE);
    }
}
END_TEST

static uint32_t left_out(void) {
    rg_scene_report report = {.size = sizeof report};
    ck_assert_int_eq(rg_scene_stats(scene, &report), RG_OK);
    return report.left_out;
}

/* What the scene holds nothing of is left out, and is no more once it holds some. */
START_TEST(what_is_left_out) {
    rg_shape *plane, *cube;
    rg_grid_config config;
    rg_grid grid;
    rg_object ids[40];
    const double lo[3] = {-INFINITY, -INFINITY, -3}, hi[3] = {INFINITY, INFINITY, -2}, one[3] = {1, 1, 1};
    ck_assert_int_eq(rg_shape_create_box(NULL, lo, hi, &plane), RG_OK);
    ck_assert_int_eq(rg_shape_create_box(NULL, one, one, &cube), RG_OK);
    rg_pose pose = rg_pose_at(0, 0, 0);
    ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, &ids[0]), RG_OK);
    const uint32_t all = RG_WITHOUT_BOXES | RG_WITHOUT_MASKS | RG_WITHOUT_UNBOUNDED | RG_WITHOUT_TILES |
                         RG_WITHOUT_LEVELS | RG_WITHOUT_GRIDS;
    ck_assert_uint_eq(left_out() & ~RG_WITHOUT_THREADS, all);
    ck_assert_int_eq(rg_scene_insert(scene, cube, &pose, &ids[1]), RG_OK);
    ck_assert_uint_eq(left_out() & all, all & ~RG_WITHOUT_BOXES);
    ck_assert_int_eq(rg_scene_insert(scene, plane, &pose, &ids[2]), RG_OK);
    ck_assert_uint_eq(left_out() & all, all & ~(RG_WITHOUT_BOXES | RG_WITHOUT_UNBOUNDED));
    ck_assert_int_eq(rg_scene_remove(scene, ids[2]), RG_OK);
    ck_assert_int_eq(rg_scene_set_mask(scene, ids[0], 1), RG_OK);
    ck_assert_uint_eq(left_out() & all, all & ~(RG_WITHOUT_BOXES | RG_WITHOUT_MASKS));
    ck_assert_int_eq(rg_grid_config_default(&config, sizeof config), RG_OK);
    config.kind = RG_GRID_UNIFORM;
    config.resolution = 4;
    config.rebuild_factor = RG_REBUILD_NEVER;
    for (int a = 0; a < 3; a++) config.hi[a] = 4;
    ck_assert_int_eq(rg_grid_create(scene, &config, &grid), RG_OK);
    rg_pose_views poses;
    ck_assert_int_eq(rg_pose_views_of(&poses, sizeof poses, &pose, 0), RG_OK);
    rg_insert_views views = {.size = sizeof views, .shapes = &ball, .poses = &poses, .grid = grid};
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, 1, NULL), RG_OK);
    ck_assert(!(left_out() & RG_WITHOUT_GRIDS) && !(left_out() & RG_WITHOUT_TILES));
    rg_shape_release(&plane);
    rg_shape_release(&cube);
}
END_TEST

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
static void *trace_calls_of_all_sizes(void *hits) {
    static rg_ray rays[600];
    for (int i = 0; i < 600; i++) {
        const double from[3] = {0.5, 0.5, -2}, along[3] = {0.001 * i - 0.3, i % 2 ? 0.1 : unit_random() - 0.5, 1};
        rays[i] = rg_ray_from(from, along);
    }
    for (uint64_t count = 1; count <= 600; count *= 8)
        ck_assert_int_eq(rg_scene_trace(scene, rays, hits, count), RG_OK);
    return hits;
}

/* What raygrid/trace.h says of the stack; sanitizers take more. */
START_TEST(a_trace_fits_on_a_small_stack) {
    static rg_hit hits[600];
    static const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const uint16_t sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const rg_mesh_views views = {.size = sizeof views,
                                 .vertices = rg_input3_packed(corners, sizeof *corners, RG_F32),
                                 .vertex_count = 4,
                                 .indices = rg_input3_packed(sides, sizeof *sides, RG_U16),
                                 .triangle_count = 4};
    pthread_attr_t attributes;
    pthread_t thread;
    rg_shape *mesh;
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, &mesh), RG_OK);
    for (int i = 0; i < 400; i++) {
        rg_pose pose = rg_pose_at(unit_random(), unit_random(), unit_random());
        pose.scale = 0.05;
        ck_assert_int_eq(rg_scene_insert(scene, i % 2 ? mesh : ball, &pose, NULL), RG_OK);
    }
    rg_shape_release(&mesh);
    pthread_attr_init(&attributes);
    ck_assert_int_eq(pthread_attr_setstacksize(&attributes, 128 * 1024), 0);
    ck_assert_int_eq(pthread_create(&thread, &attributes, trace_calls_of_all_sizes, hits), 0);
    ck_assert_int_eq(pthread_join(thread, NULL), 0);
    pthread_attr_destroy(&attributes);
}
END_TEST
#endif

/* A hint changes no answer; a value that is none is refused. */
START_TEST(coherence_is_a_hint) {
    enum { RAYS = 320 };
    static rg_ray rays[RAYS];
    static double t[3][RAYS];
    rg_trace_config config;
    rg_ray_views views = {.size = sizeof views};
    for (int i = 0; i < 400; i++) {
        rg_pose pose = rg_pose_at(unit_random(), unit_random(), unit_random());
        pose.scale = 0.03;
        ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, NULL), RG_OK);
    }
    for (int i = 0; i < RAYS; i++) {
        const double from[3] = {0.5, 0.5, -2}, along[3] = {0.01 * (i % 32) - 0.16, 0.03 * (i / 32) - 0.15, 1};
        rays[i] = rg_ray_from(from, along);
    }
    views.origin = rg_input3_packed(rays[0].origin, sizeof *rays, RG_F64);
    views.direction = rg_input3_packed(rays[0].direction, sizeof *rays, RG_F64);
    ck_assert_int_eq(rg_trace_config_default(&config, sizeof config), RG_OK);
    for (int hint = 0; hint < 3; hint++) {
        rg_hit_views hits = {.size = sizeof hits, .t = {t[hint], sizeof(double), RG_F64}};
        config.coherence = hint;
        ck_assert_int_eq(rg_scene_trace_views(scene, &config, &views, &hits, RAYS), RG_OK);
        ck_assert_mem_eq(t[hint], t[0], sizeof t[0]);
    }
    config.coherence = 3;
    rg_hit_views none = {.size = sizeof none};
    ck_assert_int_eq(rg_scene_trace_views(scene, &config, &views, &none, RAYS), RG_INVALID_ARGUMENT);
}
END_TEST

/* Moves of many keep what their views do not give. */
START_TEST(moves_keep_what_is_not_given) {
    rg_pose pose = rg_pose_at(1, 2, 3);
    rg_object ids[2];
    const double positions[2][3] = {{4, 5, 6}, {7, 8, 9}}, scales[2] = {0.3, 7};
    rg_object_report report = {.size = sizeof report};
    rg_pose_views views = {.size = sizeof views};
    const rg_input objects = {ids, sizeof *ids, RG_U64};
    pose.scale = 0.7;
    ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, &ids[0]), RG_OK);
    pose.linear[1] = 0.5f;
    ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, &ids[1]), RG_OK);
    views.position = rg_input3_packed(positions, sizeof positions[0], RG_F64);
    for (int given = 0; given < 2; given++) {
        if (given) views.scale = (rg_input){scales, sizeof scales[0], RG_F64};
        ck_assert_int_eq(rg_scene_move_many(scene, &objects, &views, 2), RG_OK);
        for (int i = 0; i < 2; i++) {
            ck_assert_int_eq(rg_scene_lookup(scene, ids[i], &report), RG_OK);
            ck_assert_mem_eq(report.pose.position, positions[i], sizeof positions[i]);
            ck_assert_double_eq(report.pose.scale, given ? scales[i] : 0.7);
            ck_assert_float_eq(report.pose.linear[1], i ? 0.5f : 0);
        }
    }
}
END_TEST

START_TEST(views_of_poses) {
    struct {
        int32_t before;
        rg_pose pose;
        int32_t after;
    } records[3];
    rg_pose_views poses;
    rg_insert_views views;
    rg_object ids[3];
    rg_output out = {ids, sizeof ids[0], RG_U64};
    memset(&records, 0, sizeof records);
    memset(&views, 0, sizeof views);
    for (int i = 0; i < 3; i++) {
        records[i].pose = rg_pose_at(i, 2 * i, 3 * i);
        for (int k = 0; k < 9; k++) records[i].pose.linear[k] += (float)(i + 1) / (float)(k + 3);
    }
    ck_assert_int_eq(rg_pose_views_of(&poses, sizeof poses, &records[0].pose, sizeof records[0]), RG_OK);
    views.size = sizeof views;
    views.shapes = &ball;
    views.poses = &poses;
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, 3, &out), RG_OK);
    for (int i = 0; i < 3; i++) {
        rg_object_report report;
        report.size = sizeof report;
        ck_assert_int_eq(rg_scene_lookup(scene, ids[i], &report), RG_OK);
        ck_assert_mem_eq(report.pose.position, records[i].pose.position, sizeof report.pose.position);
        ck_assert_mem_eq(report.pose.linear, records[i].pose.linear, sizeof report.pose.linear);
    }
    ck_assert_int_eq(rg_pose_views_of(&poses, 3, &records[0].pose, 0), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_pose_views_of(&poses, sizeof poses, NULL, 0), RG_INVALID_ARGUMENT);
}
END_TEST

/* Columns given in double are rounded to float before anything is made of them: the same object as from floats, to
 * the last bit. (gcc 12 drops such roundings in pairs, see lib/meson.build.) */
START_TEST(columns_in_double_are_rounded) {
    const double position[3] = {0.1, 0.2, 0.3}, columns[9] = {1.1, 0.1, -0.2, 0.3, 0.9, 0.7, -0.4, 0.2, 1.3};
    float rounded[9];
    rg_hit hits[2];
    rg_object ids[2];
    rg_output out = {ids, sizeof ids[0], RG_U64};
    for (int i = 0; i < 9; i++) {
        volatile float f = (float)columns[i];
        rounded[i] = f;
    }
    for (int k = 0; k < 2; k++) {
        rg_pose_views poses;
        rg_insert_views views;
        memset(&poses, 0, sizeof poses);
        memset(&views, 0, sizeof views);
        poses.size = sizeof poses;
        poses.position = rg_input3_packed(position, 0, RG_F64);
        for (int j = 0; j < 3; j++)
            poses.column[j] =
                k ? rg_input3_packed(rounded + 3 * j, 0, RG_F32) : rg_input3_packed(columns + 3 * j, 0, RG_F64);
        views.size = sizeof views;
        views.shapes = &ball;
        views.poses = &poses;
        ck_assert_int_eq(rg_scene_insert_many(scene, &views, 1, &out), RG_OK);
        hits[k] = trace(scene, along_x(0.15, 0.25));
        ck_assert_uint_eq(hits[k].object, ids[0]);
        ck_assert_int_eq(rg_scene_remove(scene, ids[0]), RG_OK);
        hits[k].object = 0;
    }
    ck_assert_mem_eq(&hits[0], &hits[1], sizeof hits[0]);
}
END_TEST

/* -------------------------------------------------------------------------------------------------- grids */

START_TEST(several_grids) {
    rg_grid_config config;
    rg_grid grid, other;
    rg_grid_report report;
    rg_pose_views poses;
    rg_insert_views views;
    rg_object id;
    rg_output out = {&id, 0, RG_U64};
    const double position[3] = {3, 0, 0};
    ck_assert_int_eq(rg_grid_config_default(&config, sizeof config), RG_OK);
    config.kind = RG_GRID_UNIFORM;
    ck_assert_int_eq(rg_grid_create(scene, &config, &grid), RG_OK);
    ck_assert_uint_ne(grid, RG_GRID_OF_SCENE);
    memset(&poses, 0, sizeof poses);
    memset(&views, 0, sizeof views);
    poses.size = sizeof poses;
    poses.position = rg_input3_packed(position, 0, RG_F64);
    views.size = sizeof views;
    views.shapes = &ball;
    views.poses = &poses;
    views.grid = grid;
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, 1, &out), RG_OK);
    insert_at(6, 0, 0);
    ck_assert(trace(scene, along_x(0, 0)).object == id);
    ck_assert_int_eq(rg_grid_destroy(scene, grid), RG_BUSY);
    ck_assert_int_eq(rg_grid_destroy(scene, RG_GRID_OF_SCENE), RG_BUSY);
    ck_assert_int_eq(rg_scene_remove(scene, id), RG_OK);
    ck_assert(trace(scene, along_x(0, 0)).t == 15);
    ck_assert_int_eq(rg_grid_destroy(scene, grid), RG_OK);
    report.size = sizeof report;
    ck_assert_int_eq(rg_grid_stats(scene, grid, &report), RG_INVALID_ID);
    ck_assert_int_eq(rg_grid_create(scene, &config, &other), RG_OK);
    ck_assert_uint_ne(other, grid);
    ck_assert_int_eq(rg_scene_insert_many(scene, &views, 1, &out), RG_INVALID_ID);
    for (int i = 2; i < 256; i++) ck_assert_int_eq(rg_grid_create(scene, NULL, &other), RG_OK);
    ck_assert_int_eq(rg_grid_create(scene, NULL, &other), RG_LIMIT_EXCEEDED);
}
END_TEST

/* -------------------------------------------------------------------------------------------- offset of hits */

/* NUMERICS, case 28: a further ray from the lifted position, of any direction on that side, does not meet the same
 * spot. */
START_TEST(no_ray_hits_where_it_starts) {
    for (int e = -8; e <= 8; e++) {
        double at = pow(10, e) * 1.2345678;
        rg_shape *shape;
        rg_pose pose = rg_pose_at(at, -at, at);
        rg_object id;
        float matrix[9];
        ck_assert_int_eq(rg_shape_create_sphere(NULL, 0.7 * at, &shape), RG_OK);
        for (int i = 0; i < 9 && e % 2; i++) matrix[i] = (float)(i % 4 == 0) + (float)(unit_random() - 0.5);
        if (e % 2) memcpy(pose.linear, matrix, sizeof matrix);
        ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, &id), RG_OK);
        for (int i = 0; i < 4000; i++) {
            rg_ray ray = rg_ray_from((double[]){at * (4 * unit_random() - 2), at * 3, at * (4 * unit_random() - 2)},
                                     (double[]){unit_random() - 0.5, -unit_random(), unit_random() - 0.5});
            rg_hit hit = trace(scene, ray), next;
            if (hit.object != id) continue;
            double d[3], dn = 0, side = i % 2 ? 1 : -1;
            for (int a = 0; a < 3; a++) {
                d[a] = unit_random() - 0.5;
                dn += d[a] * hit.normal[a];
            }
            for (int a = 0; a < 3; a++) {
                if (dn * side < 0) d[a] = -d[a];
                ray.origin[a] = hit.position[a] + side * hit.normal[a] * (double)hit.offset;
            }
            ck_assert_double_le(hit.offset, 1e-9 * at);
            next = trace(scene, rg_ray_from(ray.origin, d));
            double away = 0;
            for (int a = 0; a < 3; a++) away += fabs(next.position[a] - hit.position[a]);
            if (side > 0) ck_assert_uint_ne(next.object, id);
            if (side < 0) ck_assert(next.object == id && next.t > 0 && away > 10 * (double)hit.offset);
        }
        ck_assert_int_eq(rg_scene_remove(scene, id), RG_OK);
        rg_shape_release(&shape);
    }
}
END_TEST

/* What a shape's destroy callback finds. */
static void use_scene(void *user) {
    rg_pose pose = rg_pose_at(0, 30, 0);
    int *called = user;
    ++*called;
    ck_assert_uint_eq(trace(scene, along_x(0, 0)).object, RG_NO_OBJECT);
    ck_assert_int_eq(rg_scene_insert(scene, ball, &pose, NULL), RG_OK);
}

/* Shapes end when the call that gave back their last reference has let go of the scene. */
START_TEST(destroy_callbacks_may_use_the_scene) {
    int called = 0;
    const rg_user_shape user = {
        .size = sizeof user, .user = &called, .hi = {1, 1, 1}, .intersect = try_all, .destroy = use_scene};
    for (int many = 0; many < 2; many++) {
        rg_object ids[4];
        for (int i = 0; i < 4; i++) {
            rg_shape *shape;
            ck_assert_int_eq(rg_shape_create_user(NULL, &user, &shape), RG_OK);
            ck_assert_int_eq(rg_scene_insert(scene, shape, NULL, &ids[i]), RG_OK);
            rg_shape_release(&shape);
        }
        ck_assert_int_eq(called, 4 * many);
        const rg_input all = {ids, sizeof *ids, RG_U64};
        if (many) ck_assert_int_eq(rg_scene_remove_many(scene, &all, 4), RG_OK);
        for (int i = 3; i >= 0 && !many; i--) {
            /* The others are in the way of the ray that the last one traces. */
            ck_assert_int_eq(rg_scene_set_mask(scene, ids[i], 0), RG_OK);
        }
        for (int i = 0; i < 4 && !many; i++) ck_assert_int_eq(rg_scene_remove(scene, ids[i]), RG_OK);
        ck_assert_int_eq(called, 4 * (many + 1));
    }
}
END_TEST

/* A shape that outlives its object because somebody asked for it. */
START_TEST(shapes_of_objects) {
    rg_object id = insert_at(0, 0, 0);
    rg_shape *shape = NULL, *none = NULL;
    ck_assert_int_eq(rg_scene_shape_of(scene, id, &shape), RG_OK);
    ck_assert_ptr_eq(shape, ball);
    ck_assert_int_eq(rg_scene_remove(scene, id), RG_OK);
    rg_shape_release(&ball);
    rg_shape_report report = {.size = sizeof report};
    ck_assert_int_eq(rg_shape_stats(shape, &report), RG_OK);
    ck_assert_int_eq(rg_scene_shape_of(scene, id, &none), RG_INVALID_ID);
    ck_assert_ptr_null(none);
    ck_assert_int_eq(rg_scene_shape_of(NULL, id, &none), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_shape_of(scene, id, NULL), RG_INVALID_ARGUMENT);
    ball = shape;
}
END_TEST

/* With a limit the scene fills up, refuses what is too much, and goes on. */
START_TEST(a_limit_of_memory) {
    enum { LIMIT = 1 << 20, MANY = 100000 };
    const rg_scene_config config = {.size = sizeof config, .workers = 1, .memory_limit = LIMIT};
    rg_scene_report report = {.size = sizeof report};
    rg_scene *limited;
    rg_object last = RG_NO_OBJECT;
    uint64_t count = 0;
    ck_assert_int_eq(rg_scene_create(&config, &limited), RG_OK);
    for (int i = 0; i < MANY; i++) {
        rg_pose pose = rg_pose_at(3 * (i % 50), 3 * (i / 50 % 50), 3 * (i / 2500));
        rg_result result = rg_scene_insert(limited, ball, &pose, &last);
        if (result) ck_assert_int_eq(result, RG_OUT_OF_MEMORY);
        if (result) break;
        count++;
    }
    ck_assert(count > 1000 && count < MANY);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "the limit of 1048576"));
    ck_assert_int_eq(rg_scene_stats(limited, &report), RG_OK);
    ck_assert_uint_eq(report.objects, count);
    ck_assert(report.bytes <= LIMIT && report.bytes > LIMIT / 2);
    ck_assert_uint_ne(trace(limited, along_x(0, 0)).object, RG_NO_OBJECT);
    for (int i = 0; i < 10; i++) {
        ck_assert_int_eq(rg_scene_remove(limited, last), RG_OK);
        ck_assert_int_eq(rg_scene_insert(limited, ball, NULL, &last), RG_OK);
    }
    ck_assert_int_eq(rg_scene_destroy(&limited), RG_OK);
    const rg_scene_config tiny = {.size = sizeof tiny, .memory_limit = 100};
    ck_assert_int_eq(rg_scene_create(&tiny, &limited), RG_OUT_OF_MEMORY);
}
END_TEST

static void setup(void) {
    rg_scene_config config;
    rg_scene_config_default(&config, sizeof config);
    config.workers = 3;
    rg_scene_create(&config, &scene);
    rg_shape_create_sphere(NULL, 1, &ball);
}

static void teardown(void) {
    rg_shape_release(&ball);
    rg_scene_destroy(&scene);
}

Suite *unit_suite(void) {
    Suite *suite = suite_create("scene");
    TCase *tests = tcase_create("scene");
    tcase_add_checked_fixture(tests, setup, teardown);
    tcase_add_test(tests, a_callback_may_trace_but_not_change);
    tcase_add_test(tests, a_callback_that_fails_is_no_miss);
    tcase_add_test(tests, filters);
    tcase_add_test(tests, the_hosts_own_parallel_for);
    tcase_add_test(tests, ids);
    tcase_add_test(tests, destroy_callbacks_may_use_the_scene);
    tcase_add_test(tests, shapes_of_objects);
    tcase_add_test(tests, a_limit_of_memory);
    tcase_add_test(tests, bulk_calls_are_whole_or_nothing);
    tcase_add_test(tests, endless_planes);
    tcase_add_test(tests, views_of_poses);
    tcase_add_test(tests, columns_in_double_are_rounded);
    tcase_add_test(tests, several_grids);
    tcase_add_test(tests, scales);
    tcase_add_test(tests, what_is_left_out);
    tcase_add_test(tests, coherence_is_a_hint);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    tcase_add_test(tests, a_trace_fits_on_a_small_stack);
#endif
    tcase_add_test(tests, moves_keep_what_is_not_given);
    tcase_add_test(tests, no_ray_hits_where_it_starts);
    suite_add_tcase(suite, tests);
    return suite;
}
