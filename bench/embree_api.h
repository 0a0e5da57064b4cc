/* SPDX-License-Identifier: MIT */
/*
 * embree_api.h: the little of Embree's C interface that the benchmark uses, found in a shared library at run time:
 * the benchmark builds and runs without Embree, and can be held against any release of version 3 or 4.
 *
 * Names and numbers are those of Embree's manual (https://www.embree.org/api.html); where versions 3 and 4 differ,
 * the calls below hide it.
 */
#ifndef RAYGRID_BENCH_EMBREE_API_H
#define RAYGRID_BENCH_EMBREE_API_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

typedef struct RTCDeviceTy *RTCDevice;
typedef struct RTCSceneTy *RTCScene;
typedef struct RTCGeometryTy *RTCGeometry;

enum {
    RTC_GEOMETRY_TYPE_TRIANGLE = 0,
    RTC_GEOMETRY_TYPE_QUAD = 1,
    RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE = 16,
    RTC_GEOMETRY_TYPE_SPHERE_POINT = 50,
    RTC_GEOMETRY_TYPE_USER = 120,
    RTC_GEOMETRY_TYPE_INSTANCE = 121,
    RTC_GEOMETRY_TYPE_INSTANCE_ARRAY = 122, /* from version 4.4 on */

    RTC_BUFFER_TYPE_INDEX = 0,
    RTC_BUFFER_TYPE_VERTEX = 1,
    RTC_BUFFER_TYPE_TRANSFORM = 23,

    RTC_FORMAT_UINT = 0x5001,
    RTC_FORMAT_UINT3 = 0x5003,
    RTC_FORMAT_UINT4 = 0x5004,
    RTC_FORMAT_FLOAT3 = 0x9003,
    RTC_FORMAT_FLOAT4 = 0x9004,
    RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR = 0x9234,

    RTC_BUILD_QUALITY_LOW = 0,
    RTC_BUILD_QUALITY_MEDIUM = 1,
    RTC_BUILD_QUALITY_HIGH = 2,
    RTC_BUILD_QUALITY_REFIT = 3,

    RTC_SCENE_FLAG_DYNAMIC = 1,
    RTC_SCENE_FLAG_ROBUST = 4,

    RTC_DEVICE_PROPERTY_VERSION = 0
};

#define RTC_INVALID_GEOMETRY_ID UINT32_MAX

/**
 * A ray and its hit, of one ray or of a packet of N: a row of N numbers for each field, in this order. Where a packet
 * of N begins it has to be aligned to 4 N bytes, a single ray to 16.
 */
enum embree_row {
    ROW_ORIGIN = 0,
    ROW_T_NEAR = 3,
    ROW_DIRECTION = 4,
    ROW_TIME = 7,
    ROW_T_FAR = 8,
    ROW_MASK = 9,
    ROW_ID = 10,
    ROW_FLAGS = 11,
    ROW_RAY_END = 12,
    ROW_NORMAL = 12,
    ROW_U = 15,
    ROW_V = 16,
    ROW_PRIMITIVE = 17,
    ROW_GEOMETRY = 18,
    ROW_INSTANCE = 19,           /* of one level of instances */
    ROW_INSTANCE_PRIMITIVE = 20, /* from version 4.4 on */
    ROWS = 24
};

/** Where a user-defined geometry has one of its primitives: eight floats, lower and upper with a pad each. */
struct embree_bounds_arguments {
    void *user;
    uint32_t primitive, time_step;
    float *bounds;
};

/** What a user-defined geometry is asked; `valid` holds -1 for each ray that takes part. */
struct embree_hit_arguments {
    int *valid;
    void *user;
    uint32_t primitive;
    void *context;
    float *rays; /* rows of `count`, up to ROW_RAY_END for any-hit queries */
    uint32_t count;
    uint32_t geometry;
};

typedef void embree_bounds_function(const struct embree_bounds_arguments *arguments);
typedef void embree_hit_function(const struct embree_hit_arguments *arguments);

/** The functions, by the names that they have there. */
struct embree_api {
    void *library;
    int version;      /* 40400 for 4.4.0 */
    RTCDevice device; /* one, of one thread: where there are more, each sets the number of threads of all */
    long long bytes;  /* that it holds now */
    RTCDevice (*rtcNewDevice)(const char *config);
    void (*rtcReleaseDevice)(RTCDevice device);
    int (*rtcGetDeviceError)(RTCDevice device);
    ssize_t (*rtcGetDeviceProperty)(RTCDevice device, int property);
    void (*rtcSetDeviceMemoryMonitorFunction)(RTCDevice device, bool (*monitor)(void *user, ssize_t bytes, bool post),
                                              void *user);
    RTCScene (*rtcNewScene)(RTCDevice device);
    void (*rtcReleaseScene)(RTCScene scene);
    void (*rtcSetSceneFlags)(RTCScene scene, int flags);
    void (*rtcSetSceneBuildQuality)(RTCScene scene, int quality);
    void (*rtcCommitScene)(RTCScene scene);
    unsigned (*rtcAttachGeometry)(RTCScene scene, RTCGeometry geometry);
    RTCGeometry (*rtcNewGeometry)(RTCDevice device, int type);
    void (*rtcReleaseGeometry)(RTCGeometry geometry);
    void (*rtcCommitGeometry)(RTCGeometry geometry);
    void (*rtcSetGeometryBuildQuality)(RTCGeometry geometry, int quality);
    void (*rtcSetSharedGeometryBuffer)(RTCGeometry geometry, int type, unsigned slot, int format, const void *data,
                                       size_t offset, size_t stride, size_t count);
    void (*rtcUpdateGeometryBuffer)(RTCGeometry geometry, int type, unsigned slot);
    void (*rtcSetGeometryUserData)(RTCGeometry geometry, void *user);
    void (*rtcSetGeometryUserPrimitiveCount)(RTCGeometry geometry, unsigned count);
    void (*rtcSetGeometryBoundsFunction)(RTCGeometry geometry, embree_bounds_function *bounds, void *user);
    void (*rtcSetGeometryIntersectFunction)(RTCGeometry geometry, embree_hit_function *intersect);
    void (*rtcSetGeometryOccludedFunction)(RTCGeometry geometry, embree_hit_function *occluded);
    void (*rtcSetGeometryInstancedScene)(RTCGeometry geometry, RTCScene scene);
    void (*rtcSetGeometryTransform)(RTCGeometry geometry, unsigned time_step, int format, const void *transform);
    void (*query[2][4])(void); /* rtcIntersect and rtcOccluded of 1, 4, 8 and 16 rays: see embree_query */
};

/**
 * Opens the library at `path`, or if that is "auto" the newest that the system's loader finds. NULL if there is none,
 * or none that can be used; with a path, a message says why. `config` is handed to rtcNewDevice beside the number of
 * threads; NULL: nothing.
 */
struct embree_api *embree_open(const char *path, const char *config);
void embree_close(struct embree_api *api);

/** What a query takes beside its rays; made once for many. */
struct embree_query {
    void *words[6];
};

struct embree_query embree_query_make(const struct embree_api *api, bool coherent);

typedef void embree_ask_one_of_4(RTCScene scene, void *ray, void *arguments);
typedef void embree_ask_many_of_4(const int *valid, RTCScene scene, void *rays, void *arguments);
typedef void embree_ask_one_of_3(RTCScene scene, void *context, void *ray);
typedef void embree_ask_many_of_3(const int *valid, RTCScene scene, void *context, void *rays);

/**
 * Asks for the closest or any hit of a packet of 1, 4, 8 or 16 rays (width 0 to 3). `valid`, -1 for each ray that
 * takes part and aligned like the packet, is not looked at for one ray. Here, so that it costs the peer nothing.
 */
static inline void embree_ask(const struct embree_api *api, struct embree_query *query, bool any, int width,
                              const int *valid, RTCScene scene, void *rays) {
    void (*function)(void) = api->query[any][width];
    if (api->version >= 40000) {
        if (width == 0) {
            ((embree_ask_one_of_4 *)function)(scene, rays, query);
        } else {
            ((embree_ask_many_of_4 *)function)(valid, scene, rays, query);
        }
    } else if (width == 0) {
        ((embree_ask_one_of_3 *)function)(scene, query, rays);
    } else {
        ((embree_ask_many_of_3 *)function)(valid, scene, query, rays);
    }
}

#endif
