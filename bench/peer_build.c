/* SPDX-License-Identifier: MIT */
#include "peer_build.h"

#include "peer_spheres.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const PEER_BUILD_NAMES[PEER_BUILDS] = {
    [PEER_MEDIUM] = "medium", [PEER_HIGH] = "high",         [PEER_LOW] = "low",
    [PEER_ARRAY] = "array",   [PEER_REFIT] = "refit",       [PEER_ARRAY_REFIT] = "array refit",
    [PEER_USER] = "user",     [PEER_USER_LOW] = "user low", [PEER_USER_REFIT] = "user refit",
};

/* How the coordinates of a member lie: points with a radius, or corners; a float of room at the end, as is asked. */
static const struct {
    uint32_t floats; /* a member */
    uint32_t each;   /* primitives a member */
} LAYOUT[PEER_PARTS] = {{4, 1}, {24, 6}, {8, 1}, {12, 1}, {0, UINT32_MAX}};

/* The part of a body. A mesh that is all there is needs no instance. */
static int part_of(const struct bench_scene *bodies, uint32_t body) {
    switch (bench_shape_of(bodies, body)->kind) {
    case RG_SHAPE_SPHERE:
        return PEER_SPHERES;
    case RG_SHAPE_BOX:
        return PEER_BOXES;
    case RG_SHAPE_CAPSULE:
        return PEER_CAPSULES;
    default:
        return bench_is_one_mesh(bodies) ? PEER_MESH : PEER_INSTANCES;
    }
}

static void check(const struct peer *peer, const char *what) {
    int error = peer->api->rtcGetDeviceError(peer->api->device);
    if (!error) return;
    fprintf(stderr, "the peer could not %s: error %d\n", what, error);
    exit(1);
}

/* ------------------------------------------------------------------------------------------- coordinates */

/* Where a local point of a body is, without the body's position. */
static void turn_point(const struct bench_scene *bodies, uint32_t body, const double local[3], double out[3]) {
    double scale = bodies->scales[body];
    for (int r = 0; r < 3; r++) {
        if (bodies->linears) {
            const float *row = &bodies->linears[body][3 * r];
            out[r] = scale * ((double)row[0] * local[0] + (double)row[1] * local[1] + (double)row[2] * local[2]);
        } else {
            out[r] = scale * local[r];
        }
    }
}

static void put_point(const struct bench_scene *bodies, uint32_t body, const double position[3],
                      const double local[3], float *to) {
    double turned[3];
    turn_point(bodies, body, local, turned);
    for (int k = 0; k < 3; k++) to[k] = (float)(position[k] + turned[k]);
}

static void place_box(const struct bench_scene *bodies, uint32_t body, const double position[3], float *to) {
    const double *half = bench_shape_of(bodies, body)->size;
    for (int corner = 0; corner < 8; corner++) {
        const double local[3] = {corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1],
                                 corner & 4 ? half[2] : -half[2]};
        put_point(bodies, body, position, local, to + 3 * corner);
    }
}

static void place_capsule(const struct bench_scene *bodies, uint32_t body, const double position[3], float *to) {
    const double *size = bench_shape_of(bodies, body)->size;
    for (int end = 0; end < 2; end++) {
        const double local[3] = {end ? size[0] : -size[0], 0, 0};
        put_point(bodies, body, position, local, to + 4 * end);
        to[4 * end + 3] = (float)(size[1] * bodies->scales[body]);
    }
}

/* Three columns and the position. */
static void place_instance(const struct bench_scene *bodies, uint32_t body, const double position[3], float *to) {
    const double origin[3] = {0, 0, 0};
    for (int column = 0; column < 3; column++) {
        double local[3] = {0, 0, 0}, turned[3];
        local[column] = 1;
        turn_point(bodies, body, local, turned);
        for (int k = 0; k < 3; k++) to[3 * column + k] = (float)turned[k];
    }
    put_point(bodies, body, position, origin, to + 9);
}

static void place(struct peer *peer, uint32_t body, const double position[3]) {
    const struct bench_scene *bodies = peer->bodies;
    int p = part_of(bodies, body);
    float *to = peer->parts[p].coordinates + (size_t)LAYOUT[p].floats * peer->member[body];
    const double origin[3] = {0, 0, 0};
    switch (p) {
    case PEER_SPHERES:
        put_point(bodies, body, position, origin, to);
        to[3] = (float)bench_reach(bodies, body);
        break;
    case PEER_BOXES:
        place_box(bodies, body, position, to);
        break;
    case PEER_CAPSULES:
        place_capsule(bodies, body, position, to);
        break;
    case PEER_INSTANCES:
        place_instance(bodies, body, position, to);
        break;
    default:
        break;
    }
}

/* ---------------------------------------------------------------------------------------------- building */

static void sort_bodies(struct peer *peer) {
    const struct bench_scene *bodies = peer->bodies;
    peer->member = bench_allocate(bodies->count, sizeof *peer->member);
    for (uint32_t i = 0; i < bodies->count; i++) {
        peer->member[i] = peer->parts[part_of(bodies, i)].count++;
    }
    for (int p = 0; p < PEER_PARTS; p++) {
        struct peer_part *part = &peer->parts[p];
        size_t floats = (size_t)part->count * LAYOUT[p].floats + 4;
        part->each = LAYOUT[p].each;
        part->bodies = bench_allocate(part->count, sizeof *part->bodies);
        part->coordinates = bench_allocate(floats, sizeof *part->coordinates);
        part->geometry = bench_allocate(p == PEER_INSTANCES ? part->count : 1, sizeof(RTCGeometry));
        if (part->count) peer->input += (long long)(floats * sizeof(float));
    }
    for (uint32_t i = 0; i < bodies->count; i++) {
        peer->parts[part_of(bodies, i)].bodies[peer->member[i]] = i;
        place(peer, i, bodies->positions[i]);
    }
}

static int geometry_quality(enum peer_build build) {
    static const int QUALITIES[PEER_BUILDS] = {
        [PEER_MEDIUM] = RTC_BUILD_QUALITY_MEDIUM,    [PEER_HIGH] = RTC_BUILD_QUALITY_HIGH,
        [PEER_LOW] = RTC_BUILD_QUALITY_LOW,          [PEER_ARRAY] = RTC_BUILD_QUALITY_MEDIUM,
        [PEER_REFIT] = RTC_BUILD_QUALITY_REFIT,      [PEER_USER_LOW] = RTC_BUILD_QUALITY_LOW,
        [PEER_USER_REFIT] = RTC_BUILD_QUALITY_REFIT, [PEER_ARRAY_REFIT] = RTC_BUILD_QUALITY_REFIT,
    };
    return QUALITIES[build];
}

static uint32_t attach(struct peer *peer, RTCScene scene, RTCGeometry geometry) {
    const struct embree_api *api = peer->api;
    api->rtcSetGeometryBuildQuality(geometry, geometry_quality(peer->build));
    api->rtcCommitGeometry(geometry);
    uint32_t id = api->rtcAttachGeometry(scene, geometry);
    api->rtcReleaseGeometry(geometry);
    return id;
}

static void make_spheres(struct peer *peer, struct peer_part *part) {
    const struct embree_api *api = peer->api;
    if (defines_spheres(peer->build)) {
        struct peer_sphere_functions functions = peer_sphere_functions();
        part->geometry[0] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_USER);
        api->rtcSetGeometryUserPrimitiveCount(part->geometry[0], part->count);
        api->rtcSetGeometryUserData(part->geometry[0], part->coordinates);
        api->rtcSetGeometryBoundsFunction(part->geometry[0], functions.bounds, NULL);
        api->rtcSetGeometryIntersectFunction(part->geometry[0], functions.intersect);
        api->rtcSetGeometryOccludedFunction(part->geometry[0], functions.occluded);
    } else {
        part->geometry[0] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                        part->coordinates, 0, 4 * sizeof(float), part->count);
    }
    part->id = attach(peer, peer->scene, part->geometry[0]);
}

/* Faces whose corners are those of place_box: bit k of a corner's number is its side on axis k. */
static void make_boxes(struct peer *peer, struct peer_part *part) {
    static const uint32_t FACES[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    const struct embree_api *api = peer->api;
    part->indices = bench_allocate(24 * (size_t)part->count, sizeof *part->indices);
    for (size_t i = 0; i < 24 * (size_t)part->count; i++) part->indices[i] = (uint32_t)(8 * (i / 24)) + FACES[i % 24];
    part->geometry[0] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_QUAD);
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    part->coordinates, 0, 3 * sizeof(float), 8 * (size_t)part->count);
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, part->indices, 0,
                                    4 * sizeof(uint32_t), 6 * (size_t)part->count);
    part->id = attach(peer, peer->scene, part->geometry[0]);
    peer->input += 24 * (long long)(part->count * sizeof(uint32_t));
}

static void make_capsules(struct peer *peer, struct peer_part *part) {
    const struct embree_api *api = peer->api;
    part->indices = bench_allocate(part->count, sizeof *part->indices);
    for (uint32_t i = 0; i < part->count; i++) part->indices[i] = 2 * i;
    part->geometry[0] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                    part->coordinates, 0, 4 * sizeof(float), 2 * (size_t)part->count);
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, part->indices, 0,
                                    sizeof(uint32_t), part->count);
    part->id = attach(peer, peer->scene, part->geometry[0]);
    peer->input += (long long)(part->count * sizeof(uint32_t));
}

static RTCGeometry geometry_of_mesh(const struct embree_api *api, const struct bench_mesh *mesh) {
    RTCGeometry geometry = api->rtcNewGeometry(api->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    api->rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->vertices, 0,
                                    3 * sizeof(float), mesh->vertex_count);
    api->rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->corners, 0,
                                    3 * sizeof(uint32_t), mesh->triangle_count);
    return geometry;
}

/* The mesh of a scene that is nothing else. */
static void make_one_mesh(struct peer *peer, struct peer_part *part) {
    const struct bench_mesh *mesh = peer->bodies->shapes[0].mesh;
    part->geometry[0] = geometry_of_mesh(peer->api, mesh);
    part->id = attach(peer, peer->scene, part->geometry[0]);
    peer->input += (long long)(3 * sizeof(float) * mesh->vertex_count + 3 * sizeof(uint32_t) * mesh->triangle_count);
}

/* The scene of a mesh stands still: it is built as well as the peer can. */
static void make_mesh(struct peer *peer, int shape, bool robust) {
    const struct embree_api *api = peer->api;
    RTCGeometry geometry = geometry_of_mesh(api, peer->bodies->shapes[shape].mesh);
    api->rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    api->rtcCommitGeometry(geometry);
    peer->meshes[shape] = api->rtcNewScene(peer->api->device);
    api->rtcSetSceneFlags(peer->meshes[shape], robust ? RTC_SCENE_FLAG_ROBUST : 0);
    api->rtcSetSceneBuildQuality(peer->meshes[shape], RTC_BUILD_QUALITY_HIGH);
    api->rtcAttachGeometry(peer->meshes[shape], geometry);
    api->rtcReleaseGeometry(geometry);
    api->rtcCommitScene(peer->meshes[shape]);
}

static void set_transform(struct peer *peer, uint32_t member) {
    const struct peer_part *part = &peer->parts[PEER_INSTANCES];
    peer->api->rtcSetGeometryTransform(part->geometry[member], 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                       part->coordinates + 12 * (size_t)member);
}

/* The number of the one shape that is a mesh; -1: there is none, or more than one. */
static int only_mesh(const struct bench_scene *bodies) {
    int found = -1;
    for (int s = 0; s < bodies->shape_count; s++) {
        if (bodies->shapes[s].kind != RG_SHAPE_MESH) continue;
        if (found >= 0) return -1;
        found = s;
    }
    return found;
}

static void make_instance_array(struct peer *peer, struct peer_part *part) {
    const struct embree_api *api = peer->api;
    part->geometry[0] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_INSTANCE_ARRAY);
    api->rtcSetGeometryInstancedScene(part->geometry[0], peer->meshes[only_mesh(peer->bodies)]);
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_TRANSFORM, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                    part->coordinates, 0, 12 * sizeof(float), part->count);
    part->id = attach(peer, peer->scene, part->geometry[0]);
}

static void make_instances(struct peer *peer, struct peer_part *part) {
    const struct embree_api *api = peer->api;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct bench_scene *bodies = peer->bodies;
        int shape = bodies->shape_of ? bodies->shape_of[part->bodies[i]] : 0;
        part->geometry[i] = api->rtcNewGeometry(peer->api->device, RTC_GEOMETRY_TYPE_INSTANCE);
        api->rtcSetGeometryInstancedScene(part->geometry[i], peer->meshes[shape]);
        set_transform(peer, i);
        uint32_t id = attach(peer, peer->scene, part->geometry[i]);
        if (i == 0) part->id = id;
    }
}

static bool has_meshes(const struct bench_scene *bodies) {
    for (int s = 0; s < bodies->shape_count; s++) {
        if (bodies->shapes[s].kind == RG_SHAPE_MESH) return true;
    }
    return false;
}

bool peer_can(const struct peer_choice *choice, const struct bench_scene *bodies, enum peer_build build) {
    bool spheres = bench_all_spheres(bodies);
    if (defines_spheres(build)) return spheres;
    if (bench_is_one_mesh(bodies)) return !has_arrays(build);
    if (build == PEER_REFIT) return !spheres && !has_meshes(bodies);
    return !has_arrays(build) || (choice->api->version >= 40400 && only_mesh(bodies) >= 0);
}

struct peer *peer_create(const struct peer_choice *choice, const struct bench_scene *bodies, enum peer_build build) {
    const struct embree_api *api = choice->api;
    struct peer *peer = bench_allocate(1, sizeof *peer);
    peer->api = api;
    peer->bodies = bodies;
    peer->build = build;
    peer->bytes = -api->bytes;
    peer->scene = api->rtcNewScene(peer->api->device);
    bool refitted = geometry_quality(build) == RTC_BUILD_QUALITY_REFIT;
    bool moving = build == PEER_LOW || build == PEER_USER_LOW || refitted;
    api->rtcSetSceneFlags(peer->scene,
                          (moving ? RTC_SCENE_FLAG_DYNAMIC : 0) | (choice->robust ? RTC_SCENE_FLAG_ROBUST : 0));
    api->rtcSetSceneBuildQuality(peer->scene, refitted ? RTC_BUILD_QUALITY_LOW : geometry_quality(build));
    sort_bodies(peer);
    if (peer->parts[PEER_SPHERES].count) make_spheres(peer, &peer->parts[PEER_SPHERES]);
    if (peer->parts[PEER_BOXES].count) make_boxes(peer, &peer->parts[PEER_BOXES]);
    if (peer->parts[PEER_CAPSULES].count) make_capsules(peer, &peer->parts[PEER_CAPSULES]);
    if (peer->parts[PEER_MESH].count) make_one_mesh(peer, &peer->parts[PEER_MESH]);
    if (peer->parts[PEER_INSTANCES].count) {
        for (int s = 0; s < bodies->shape_count; s++) {
            if (bodies->shapes[s].kind == RG_SHAPE_MESH) make_mesh(peer, s, choice->robust);
        }
        (in_array(peer) ? make_instance_array : make_instances)(peer, &peer->parts[PEER_INSTANCES]);
    }
    api->rtcCommitScene(peer->scene);
    peer->bytes += api->bytes;
    check(peer, "build the scene");
    return peer;
}

void peer_destroy(struct peer *peer) {
    if (!peer) return;
    peer->api->rtcReleaseScene(peer->scene);
    for (int s = 0; s < BENCH_SHAPES; s++) {
        if (peer->meshes[s]) peer->api->rtcReleaseScene(peer->meshes[s]);
    }
    for (int p = 0; p < PEER_PARTS; p++) {
        free(peer->parts[p].bodies);
        free(peer->parts[p].coordinates);
        free(peer->parts[p].geometry);
        free(peer->parts[p].indices);
    }
    free(peer->member);
    free(peer);
}

/* ----------------------------------------------------------------------------------------------- changes */

static void commit(struct peer *peer) {
    const struct embree_api *api = peer->api;
    bool user = defines_spheres(peer->build);
    for (int p = 0; p < PEER_PARTS; p++) {
        const struct peer_part *part = &peer->parts[p];
        if (!part->count || (p == PEER_INSTANCES && !in_array(peer))) continue;
        if (!user) {
            int buffer = p == PEER_INSTANCES ? RTC_BUFFER_TYPE_TRANSFORM : RTC_BUFFER_TYPE_VERTEX;
            api->rtcUpdateGeometryBuffer(part->geometry[0], buffer, 0);
        }
        api->rtcCommitGeometry(part->geometry[0]);
    }
    api->rtcCommitScene(peer->scene);
}

static void move_instances(struct peer *peer, const uint32_t *which, uint32_t from, uint32_t to) {
    if (!peer->parts[PEER_INSTANCES].count || in_array(peer)) return;
    for (uint32_t i = from; i < to; i++) {
        if (part_of(peer->bodies, which[i]) != PEER_INSTANCES) continue;
        uint32_t member = peer->member[which[i]];
        set_transform(peer, member);
        peer->api->rtcCommitGeometry(peer->parts[PEER_INSTANCES].geometry[member]);
    }
}

double peer_move(struct peer *peer, const uint32_t *which, double (*positions)[3], uint32_t count, uint32_t counted) {
    for (uint32_t i = 0; i < count; i++) place(peer, which[i], positions[i]);
    move_instances(peer, which, 0, counted);
    double before = bench_thread_seconds();
    move_instances(peer, which, counted, count);
    commit(peer);
    return bench_thread_seconds() - before;
}

double peer_keep(struct peer *peer, uint32_t count) {
    const struct embree_api *api = peer->api;
    struct peer_part *part = &peer->parts[PEER_SPHERES];
    double before = bench_thread_seconds();
    api->rtcSetSharedGeometryBuffer(part->geometry[0], RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                    part->coordinates, 0, 4 * sizeof(float), count);
    commit(peer);
    return bench_thread_seconds() - before;
}

enum peer_build peer_build_of(const struct peer *peer) {
    return peer->build;
}

double peer_bytes_per_object(const struct peer *peer) {
    return (double)(peer->bytes + peer->input) / (double)peer->bodies->size;
}
