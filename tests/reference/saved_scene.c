/* SPDX-License-Identifier: MIT */
#include "saved_scene.h"

#include <math.h>
#include <stdio.h>

static const double LO[3] = {-1, -0.5, 0}, HI[3] = {1, 0.5, 2};
static uint64_t user_numbers[] = {0, 1};

static void demand(rg_result result) {
    if (result == RG_OK) return;
    fprintf(stderr, "FAILED: %s\n", rg_error_message());
    abort();
}

/* The plane z = 0 within the box; of number 1 turned away by a little. */
static int32_t plane_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    double slope = *(const uint64_t *)user ? 0.125 : 0;
    double along = ray->direction[2] - slope * ray->direction[0];
    if (along == 0) return 0;
    double t = (slope * ray->origin[0] - ray->origin[2]) / along;
    if (!(t >= ray->t_min && t <= ray->t_max)) return 0;
    for (int i = 0; i < 3; i++) {
        double at = ray->origin[i] + t * ray->direction[i];
        if (at < LO[i] || at > HI[i]) return 0;
    }
    *hit = (rg_local_hit){.t = t, .normal = {-slope, 0, 1}, .u = t};
    return 1;
}

static rg_result make_user(uint64_t number, rg_shape **shape) {
    const rg_user_shape plane = {.size = sizeof plane,
                                 .user = &user_numbers[number],
                                 .lo = {LO[0], LO[1], LO[2]},
                                 .hi = {HI[0], HI[1], HI[2]},
                                 .intersect = plane_intersect};
    return rg_shape_create_user(NULL, &plane, shape);
}

/* `mesh`: the one that gets other vertices, or NULL. */
static rg_result make_mesh(bool indexed, const rg_shape *mesh, rg_shape **shape) {
    static const float VERTICES[8][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},       {0, -1.1f, 0},
                                         {0, 0, 1}, {0, 0, -1}, {0.1f, 0.2f, 9}, {2, 0.5f, 0}};
    /* The last vertex of a mesh is not used. */
    static const uint16_t FACES[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    rg_mesh_views views = {.size = sizeof views, .vertex_count = 7, .triangle_count = indexed ? 7 : 2};
    views.vertices = rg_input3_packed(VERTICES[mesh ? 1 : 0], sizeof *VERTICES, RG_F32);
    if (indexed) views.indices = rg_input3_packed(FACES, sizeof *FACES, RG_U16);
    return mesh ? rg_shape_create_deformed(NULL, mesh, &views, shape) : rg_shape_create_mesh(NULL, &views, shape);
}

static void make_shapes(saved_scene *s) {
    static const double WIDE[2][3] = {{-HUGE_VAL, -HUGE_VAL, -30}, {HUGE_VAL, HUGE_VAL, -29}};
    static const double ENDS[2][3] = {{0.1, 0.2, 0.3}, {-0.7, 1.9, 0.3}};
    demand(rg_shape_create_sphere(NULL, 1, &s->shapes[0]));
    demand(rg_shape_create_sphere(NULL, 0.3, &s->shapes[1]));
    demand(rg_shape_create_box(NULL, LO, HI, &s->shapes[2]));
    demand(rg_shape_create_capsule(NULL, ENDS[0], ENDS[1], 0.2, &s->shapes[3]));
    demand(make_mesh(true, NULL, &s->shapes[4]));
    demand(make_mesh(false, NULL, &s->shapes[5]));
    demand(make_mesh(true, s->shapes[4], &s->forms[1]));
    s->forms[0] = s->shapes[4];
    rg_shape_retain(s->forms[0]);
    demand(rg_shape_create_box(NULL, WIDE[0], WIDE[1], &s->shapes[6]));
    demand(make_user(0, &s->shapes[7]));
    demand(make_user(1, &s->shapes[8]));
}

static rg_pose pose_of(uint32_t i) {
    rg_pose pose = rg_pose_at(10 * sin(i), 10 * sin(2.3 * i + 1), 10 * sin(1.7 * i + 2));
    if (i % SAVED_SHAPES == 6) return pose; /* an infinite box */
    if (i % 3 == 0) pose.scale = 0.75 + 0.1 * (i % 7);
    if (i % 4 == 0) pose.linear[1] = 0.25f * (float)(i % 5);
    if (i % 8 == 0) pose.linear[8] = -1;
    return pose;
}

void saved_scene_make(saved_scene *s, rg_grid_kind kind, uint32_t workers) {
    rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {.size = sizeof config, .workers = workers, .grid = &grid};
    rg_grid spare;
    memset(s, 0, sizeof *s);
    make_shapes(s);
    demand(rg_scene_create(&config, &s->scene));
    demand(rg_grid_create(s->scene, NULL, &spare));
    grid = (rg_grid_config){.size = sizeof grid, .kind = RG_GRID_UNIFORM, .resolution = 8, .lo = {-5, -5, -5}};
    grid.hi[0] = grid.hi[1] = grid.hi[2] = 5;
    grid.rebuild_factor = RG_REBUILD_NEVER;
    demand(rg_grid_create(s->scene, &grid, &s->grid));
    demand(rg_grid_destroy(s->scene, spare));
    for (uint32_t i = 0; i < SAVED_OBJECTS; i++) {
        rg_pose pose = pose_of(i);
        demand(rg_scene_insert(s->scene, s->shapes[i % SAVED_SHAPES], &pose, &s->objects[i]));
        if (i % 5 == 0) demand(rg_scene_set_mask(s->scene, s->objects[i], 1u << i % 3));
    }
    for (uint32_t i = 50; i > 10; i -= 7) demand(rg_scene_remove(s->scene, s->objects[i]));
}

void saved_scene_end(saved_scene *s) {
    demand(rg_scene_destroy(&s->scene));
    for (int i = 0; i < SAVED_SHAPES; i++) rg_shape_release(&s->shapes[i]);
    for (int i = 0; i < 2; i++) rg_shape_release(&s->forms[i]);
}

static uint64_t change_many(saved_scene *s, uint32_t turn) {
    enum { MANY = 4 };
    rg_pose poses[MANY];
    rg_pose_views pose_views;
    rg_object ids[MANY];
    const uint32_t masks[MANY] = {1, 2, UINT32_MAX, 7};
    for (uint32_t i = 0; i < MANY; i++) poses[i] = pose_of(9 * turn + i);
    demand(rg_pose_views_of(&pose_views, sizeof pose_views, poses, sizeof *poses));
    rg_insert_views views = {.size = sizeof views, .shapes = s->shapes, .poses = &pose_views, .grid = s->grid};
    views.shapes_stride = sizeof *s->shapes;
    views.mask = (rg_input){masks, sizeof *masks, RG_U32};
    const rg_output out = {ids, sizeof *ids, RG_U64};
    const rg_input in = {ids, sizeof *ids, RG_U64};
    demand(rg_scene_insert_many(s->scene, &views, MANY, &out));
    for (uint32_t i = 0; i < MANY; i++) poses[i] = pose_of(9 * turn + i + 2);
    if (turn % 2) pose_views.column[0].x = pose_views.column[1].x = pose_views.column[2].x = NULL;
    if (turn % 3) pose_views.scale.data = NULL;
    demand(rg_scene_move_many(s->scene, &in, &pose_views, MANY));
    demand(rg_scene_remove_many(s->scene, &in, MANY - 1));
    return 3;
}

static uint64_t change_grids(saved_scene *s, uint32_t turn) {
    static const rg_grid_kind KINDS[] = {RG_GRID_LOOSE, RG_GRID_HIERARCHICAL, RG_GRID_UNIFORM};
    const rg_grid_config config = {.size = sizeof config, .kind = KINDS[turn % 3], .resolution = turn % 2 ? 0 : 9};
    rg_grid grid;
    demand(rg_grid_create(s->scene, &config, &grid));
    demand(rg_grid_configure(s->scene, turn % 2 ? s->grid : RG_GRID_OF_SCENE, &config));
    demand(rg_grid_rebuild(s->scene, s->grid));
    if (turn % 2 == 0) return 3;
    demand(rg_grid_destroy(s->scene, grid));
    return 4;
}

static uint64_t change_form(saved_scene *s) {
    rg_shape *now = s->forms[1];
    demand(rg_scene_replace_shape(s->scene, s->forms[0], now));
    s->forms[1] = s->forms[0];
    s->forms[0] = now;
    return 1;
}

uint64_t saved_scene_change(saved_scene *s, uint32_t turn) {
    uint32_t i = turn % 8, other = 51 + turn % 6; /* neither is ever removed */
    rg_pose pose = pose_of(turn + 3);
    rg_object object;
    uint64_t calls = 0;
    if (i % SAVED_SHAPES == 6) pose = rg_pose_at(0, 0, turn);
    demand(rg_scene_move(s->scene, s->objects[i], &pose));
    demand(rg_scene_move_to(s->scene, s->objects[other], pose_of(turn + 5).position));
    demand(rg_scene_set_mask(s->scene, s->objects[other], turn));
    demand(rg_scene_insert(s->scene, s->shapes[turn % SAVED_SHAPES], NULL, &object));
    calls += 4;
    if (turn % 3 == 0) {
        demand(rg_scene_remove(s->scene, object));
        calls++;
    }
    calls += change_many(s, turn);
    calls += change_grids(s, turn);
    return calls + change_form(s);
}

/* ------------------------------------------------------------------------------------------------- bytes */

static int32_t number_shape(void *user, const rg_shape *shape, void *shape_user, uint64_t *number) {
    (void)user, (void)shape;
    *number = *(const uint64_t *)shape_user;
    return 0;
}

static int32_t find_shape(void *user, uint64_t number, const double lo[3], const double hi[3], rg_shape **shape) {
    (void)user, (void)lo, (void)hi;
    return number < 2 ? make_user(number, shape) : 1;
}

rg_sink saved_scene_sink(byte_sink *sink) {
    rg_sink s = byte_sink_sink(sink);
    s.number_shape = number_shape;
    return s;
}

rg_source saved_scene_source(const byte_sink *sink) {
    rg_source s = byte_sink_source(sink);
    s.find_shape = find_shape;
    return s;
}

void saved_scene_save(rg_scene *scene, byte_sink *bytes) {
    const rg_sink sink = saved_scene_sink(bytes);
    if (bytes->size) abort();
    demand(rg_scene_save(scene, &sink));
}

void saved_scene_trace(rg_scene *scene, rg_hit hits[SAVED_RAYS]) {
    rg_ray rays[SAVED_RAYS];
    for (int i = 0; i < SAVED_RAYS; i++) {
        const double from[3] = {20 * cos(i), 20 * sin(i), 9 * cos(1.3 * i)};
        const double to[3] = {-from[0] + i % 5, -from[1] + i % 7, -from[2]};
        rays[i] = rg_ray_from(from, to);
        if (i % 4 == 0) rays[i].mask = 1u << i % 3;
    }
    demand(rg_scene_trace(scene, rays, hits, SAVED_RAYS));
}
