/* SPDX-License-Identifier: MIT */
#include "own.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void own_check(rg_result result) {
    if (result == RG_OK) return;
    fprintf(stderr, "%s: %s\n", rg_result_name(result), rg_error_message());
    exit(1);
}

rg_mesh_views own_mesh_views(const struct bench_mesh *mesh) {
    rg_mesh_views views = {.size = sizeof views};
    views.vertices = rg_input3_packed(mesh->vertices, 3 * sizeof(float), RG_F32);
    views.vertex_count = mesh->vertex_count;
    views.indices = rg_input3_packed(mesh->corners, 3 * sizeof(uint32_t), RG_U32);
    views.triangle_count = mesh->triangle_count;
    return views;
}

rg_shape_config own_mesh_config(rg_mesh_quality quality) {
    rg_shape_config config;
    own_check(rg_shape_config_default(&config, sizeof config));
    config.quality = quality;
    return config;
}

static rg_shape *create_shape(const struct bench_shape *shape) {
    const double *s = shape->size;
    const double lo[3] = {-s[0], -s[1], -s[2]}, a[3] = {-s[0], 0, 0}, b[3] = {s[0], 0, 0};
    rg_shape *result = NULL;
    rg_mesh_views views;
    switch (shape->kind) {
    case RG_SHAPE_SPHERE:
        own_check(rg_shape_create_sphere(NULL, s[0], &result));
        break;
    case RG_SHAPE_BOX:
        own_check(rg_shape_create_box(NULL, lo, s, &result));
        break;
    case RG_SHAPE_CAPSULE:
        own_check(rg_shape_create_capsule(NULL, a, b, s[1], &result));
        break;
    default:
        views = own_mesh_views(shape->mesh);
        own_check(rg_shape_create_mesh(NULL, &views, &result));
    }
    return result;
}

rg_shape *own_shape_of(const struct own *own, uint32_t body) {
    return own->shapes[own->bodies->shape_of ? own->bodies->shape_of[body] : 0];
}

void own_remember(struct own *own, uint32_t body) {
    uint32_t slot = RG_OBJECT_SLOT(own->objects[body]);
    if (slot >= own->slots) {
        uint32_t room = 2 * slot + 64;
        uint32_t *larger = realloc(own->body_of_slot, room * sizeof *larger);
        if (!larger) own_check(RG_OUT_OF_MEMORY);
        own->body_of_slot = larger;
        own->slots = room;
    }
    own->body_of_slot[slot] = body;
}

void own_fill(struct own *own) {
    uint32_t count = own->bodies->count;
    rg_pose *poses = bench_allocate(count, sizeof *poses);
    rg_shape **shapes = bench_allocate(count, sizeof(rg_shape *));
    for (uint32_t i = 0; i < count; i++) {
        poses[i] = bench_pose(own->bodies, i);
        shapes[i] = own_shape_of(own, i);
    }
    rg_pose_views pose_views;
    rg_insert_views views = {.size = sizeof views};
    own_check(rg_pose_views_of(&pose_views, sizeof pose_views, poses, sizeof *poses));
    /* Spheres get no linear part: they need none. */
    for (int k = 0; !own->bodies->linears && k < 3; k++) pose_views.column[k] = (rg_input3){0};
    views.shapes = shapes;
    views.shapes_stride = sizeof(rg_shape *);
    views.poses = &pose_views;
    rg_output objects = {own->objects, sizeof *own->objects, RG_U64};
    double before = bench_thread_seconds();
    own_check(rg_scene_insert_many(own->scene, &views, count, &objects));
    own->filling = bench_thread_seconds() - before;
    for (uint32_t i = 0; i < count; i++) own_remember(own, i);
    free(poses);
    free(shapes);
}

struct own *own_create_empty(const struct bench_scene *bodies, uint32_t workers, const rg_grid_config *grid) {
    struct own *own = bench_allocate(1, sizeof *own);
    rg_scene_config config;
    own->bodies = bodies;
    own_check(rg_scene_config_default(&config, sizeof config));
    config.workers = workers;
    config.grid = grid;
    own_check(rg_scene_create(&config, &own->scene));
    own->shapes = bench_allocate((size_t)bodies->shape_count, sizeof(rg_shape *));
    for (int s = 0; s < bodies->shape_count; s++) own->shapes[s] = create_shape(&bodies->shapes[s]);
    own->objects = bench_allocate(bodies->count, sizeof *own->objects);
    return own;
}

struct own *own_create(const struct bench_scene *bodies, uint32_t workers) {
    struct own *own = own_create_empty(bodies, workers, NULL);
    own_fill(own);
    return own;
}

void own_destroy(struct own *own) {
    if (!own) return;
    own_check(rg_scene_destroy(&own->scene));
    for (int s = 0; s < own->bodies->shape_count; s++) rg_shape_release(&own->shapes[s]);
    free(own->shapes);
    free(own->objects);
    free(own->body_of_slot);
    free(own);
}

/* ------------------------------------------------------------------------------------------------- traces */

rg_ray_views own_ray_views(const struct bench_rays *rays) {
    rg_ray_views views = {.size = sizeof views};
    views.origin = (rg_input3){rays->origin[0], rays->origin[1], rays->origin[2], sizeof(float), RG_F32};
    views.direction = (rg_input3){rays->direction[0], rays->direction[1], rays->direction[2], sizeof(float), RG_F32};
    if (rays->t_max < INFINITY) views.t_max = (rg_input){&rays->t_max, 0, RG_F32};
    return views;
}

static void advance3(rg_input3 *input, uint32_t records) {
    input->x = (const float *)input->x + records;
    input->y = (const float *)input->y + records;
    input->z = (const float *)input->z + records;
}

void own_trace(struct own *own, const struct bench_rays *rays, uint32_t a_call, const struct bench_answers *answers) {
    rg_ray_views views = own_ray_views(rays);
    rg_hit_views hits = {.size = sizeof hits};
    rg_output occluded = {answers->occluded, 1, RG_U8};
    hits.t = (rg_output){answers->t, sizeof *answers->t, RG_F32};
    hits.object = (rg_output){answers->id, sizeof *answers->id, RG_U64};
    for (uint32_t done = 0; done < rays->count; done += a_call) {
        uint32_t count = rays->count - done < a_call ? rays->count - done : a_call;
        if (rays->any) {
            own_check(rg_scene_occluded_views(own->scene, NULL, &views, &occluded, count));
            occluded.data = (uint8_t *)occluded.data + count;
        } else {
            own_check(rg_scene_trace_views(own->scene, NULL, &views, &hits, count));
            hits.t.data = (float *)hits.t.data + count;
            hits.object.data = (uint64_t *)hits.object.data + count;
        }
        advance3(&views.origin, count);
        advance3(&views.direction, count);
    }
}

uint32_t own_body(const struct own *own, uint64_t id) {
    if (id == RG_NO_OBJECT) return UINT32_MAX;
    uint32_t slot = RG_OBJECT_SLOT(id);
    uint32_t body = slot < own->slots ? own->body_of_slot[slot] : UINT32_MAX;
    return body < own->bodies->count && own->objects[body] == id ? body : UINT32_MAX;
}

/* ------------------------------------------------------------------------------------------------ changes */

void own_insert(struct own *own, uint32_t body) {
    rg_pose pose = bench_pose(own->bodies, body);
    own_check(rg_scene_insert(own->scene, own_shape_of(own, body), &pose, &own->objects[body]));
    own_remember(own, body);
}

void own_remove(struct own *own, uint32_t body) {
    own_check(rg_scene_remove(own->scene, own->objects[body]));
}

double own_deform(struct own *own, int shape, rg_mesh_quality quality) {
    const rg_mesh_views views = own_mesh_views(own->bodies->shapes[shape].mesh);
    const rg_shape_config config = own_mesh_config(quality);
    rg_shape *bent;
    double before = bench_thread_seconds();
    own_check(rg_shape_create_deformed(&config, own->shapes[shape], &views, &bent));
    own_check(rg_scene_replace_shape(own->scene, own->shapes[shape], bent));
    rg_shape_release(&own->shapes[shape]);
    own->shapes[shape] = bent;
    return bench_thread_seconds() - before;
}

void own_move_many(struct own *own, const rg_object *objects, double (*positions)[3], uint32_t count) {
    rg_input ids = {objects, sizeof *objects, RG_U64};
    rg_pose_views poses = {.size = sizeof poses};
    poses.position = rg_input3_packed(positions, sizeof *positions, RG_F64);
    own_check(rg_scene_move_many(own->scene, &ids, &poses, count));
}

double own_bytes_per_object(const struct own *own) {
    rg_scene_report report = {.size = sizeof report};
    own_check(rg_scene_stats(own->scene, &report));
    for (int s = 0; s < own->bodies->shape_count; s++) {
        rg_shape_report shape = {.size = sizeof shape};
        own_check(rg_shape_stats(own->shapes[s], &shape));
        report.bytes += shape.bytes;
    }
    return (double)report.bytes / (double)own->bodies->size;
}

rg_grid_report own_grid_report(const struct own *own) {
    rg_grid_report report = {.size = sizeof report};
    own_check(rg_grid_stats(own->scene, RG_GRID_OF_SCENE, &report));
    return report;
}

const char *own_kind_name(rg_grid_kind kind) {
    static const char *const NAMES[] = {"default", "uniform", "hierarchical", "loose"};
    return NAMES[kind];
}
