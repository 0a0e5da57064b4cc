/* SPDX-License-Identifier: MIT */
/* probe [KIND...]: whether the library that it runs with has those kinds of shapes and refuses all others. Prints the
 * workers and the instructions of a scene for which eight workers were asked. */
#include <raygrid/raygrid.h>

#include <stdio.h>
#include <string.h>

enum { RAYS = 4096, KINDS = 5, DISTANCE = 5 };

static const char *const KIND[KINDS] = {"sphere", "box", "capsule", "mesh", "user"};
static const char *const MANY[KINDS] = {"spheres", "boxes", "capsules", "meshes", "user-defined shapes"};
static int wrong;

static void check(int right, const char *what, const char *which) {
    if (right) return;
    printf("%s: %s: %s\n", which, what, rg_error_message());
    wrong++;
}

/* The plane z = -1. */
static int32_t meet_plane(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    (void)user;
    hit->t = (-1 - ray->origin[2]) / ray->direction[2];
    hit->normal[2] = -1;
    return 1;
}

/* Shapes that reach, on the z axis, from -1 to where nobody looks. */
static rg_result create(int kind, rg_shape **shape) {
    static const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1}, a[3] = {0, 0, 0}, b[3] = {0, 1, 0};
    static const double corners[9] = {-4, -4, -1, 4, -4, -1, 0, 4, -1};
    rg_mesh_views views = {.size = sizeof views, .vertex_count = 3, .triangle_count = 1};
    rg_user_shape user = {.size = sizeof user, .lo = {-1, -1, -1}, .hi = {1, 1, 1}, .intersect = meet_plane};
    views.vertices = rg_input3_packed(corners, 3 * sizeof *corners, RG_F64);
    switch (kind) {
    case RG_SHAPE_SPHERE:
        return rg_shape_create_sphere(NULL, 1, shape);
    case RG_SHAPE_BOX:
        return rg_shape_create_box(NULL, lo, hi, shape);
    case RG_SHAPE_CAPSULE:
        return rg_shape_create_capsule(NULL, a, b, 1, shape);
    case RG_SHAPE_MESH:
        return rg_shape_create_mesh(NULL, &views, shape);
    default:
        return rg_shape_create_user(NULL, &user, shape);
    }
}

static void try_traces(rg_scene *scene, rg_shape *shape, const char *name) {
    static rg_ray rays[RAYS];
    static rg_hit hits[RAYS];
    rg_pose pose = rg_pose_at(0, 0, DISTANCE);
    rg_object object;
    int right = 0;
    for (int i = 0; i < RAYS; i++) {
        rays[i] = rg_ray_from((double[3]){0, 0, 0}, (double[3]){0, 0, i % 2 ? 1 : -1});
    }
    check(!rg_scene_insert(scene, shape, &pose, &object), "not inserted", name);
    check(!rg_scene_trace(scene, rays, hits, RAYS), "not traced", name);
    for (int i = 0; i < RAYS; i++) {
        right += i % 2 ? hits[i].object == object && hits[i].t == DISTANCE - 1 : hits[i].object == RG_NO_OBJECT;
    }
    check(right == RAYS, "wrong hits", name);
    check(!rg_scene_remove(scene, object), "not removed", name);
}

static void try_kind(rg_scene *scene, int kind, int has) {
    char message[64];
    rg_shape *shape = NULL;
    rg_result result = create(kind, &shape);
    if (has) {
        check(result == RG_OK, "not made", KIND[kind]);
        if (result == RG_OK) try_traces(scene, shape, KIND[kind]);
    } else {
        snprintf(message, sizeof message, "this build has no %s", MANY[kind]);
        check(result == RG_INVALID_ARGUMENT && !shape, "not refused", KIND[kind]);
        check(strcmp(rg_error_message(), message) == 0, "refused with another message", KIND[kind]);
    }
    rg_shape_release(&shape);
}

int main(int argc, char **argv) {
    rg_scene_config config = {.size = sizeof config, .workers = 8};
    rg_scene_report report = {.size = sizeof report};
    rg_scene *scene = NULL;
    check(!rg_scene_create(&config, &scene), "not made", "scene");
    if (wrong) return 1;
    for (int kind = 0; kind < KINDS; kind++) {
        int has = 0;
        for (int i = 1; i < argc; i++) has |= strcmp(argv[i], KIND[kind]) == 0;
        try_kind(scene, kind, has);
    }
    check(!rg_scene_stats(scene, &report), "no report", "scene");
    printf("workers %u isa %d\n", report.workers, report.isa);
    check(!rg_scene_destroy(&scene), "not destroyed", "scene");
    return wrong > 0;
}
