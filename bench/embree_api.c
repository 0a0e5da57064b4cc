/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "embree_api.h"

#include "measure.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Version 4's RTCIntersectArguments, which RTCOccludedArguments equals. */
struct arguments_of_4 {
    int flags;
    unsigned feature_mask;
    void *context;
    void (*filter)(void);
    void (*intersect)(void);
    float min_width_distance_factor;
};

/* Version 3's RTCIntersectContext. */
struct context_of_3 {
    int flags;
    void (*filter)(void);
    unsigned instance;
    float min_width_distance_factor;
};

enum { COHERENT_OF_4 = 1 << 16, COHERENT_OF_3 = 1 };

struct symbol {
    const char *name;
    size_t offset; /* of its pointer in embree_api */
};

#define SYMBOL(name)                                                                                                 \
    { #name, offsetof(struct embree_api, name) }

static const struct symbol SYMBOLS[] = {
    SYMBOL(rtcNewDevice),
    SYMBOL(rtcReleaseDevice),
    SYMBOL(rtcGetDeviceError),
    SYMBOL(rtcGetDeviceProperty),
    SYMBOL(rtcSetDeviceMemoryMonitorFunction),
    SYMBOL(rtcNewScene),
    SYMBOL(rtcReleaseScene),
    SYMBOL(rtcSetSceneFlags),
    SYMBOL(rtcSetSceneBuildQuality),
    SYMBOL(rtcCommitScene),
    SYMBOL(rtcAttachGeometry),
    SYMBOL(rtcNewGeometry),
    SYMBOL(rtcReleaseGeometry),
    SYMBOL(rtcCommitGeometry),
    SYMBOL(rtcSetGeometryBuildQuality),
    SYMBOL(rtcSetSharedGeometryBuffer),
    SYMBOL(rtcUpdateGeometryBuffer),
    SYMBOL(rtcSetGeometryUserData),
    SYMBOL(rtcSetGeometryUserPrimitiveCount),
    SYMBOL(rtcSetGeometryBoundsFunction),
    SYMBOL(rtcSetGeometryIntersectFunction),
    SYMBOL(rtcSetGeometryOccludedFunction),
    SYMBOL(rtcSetGeometryInstancedScene),
    SYMBOL(rtcSetGeometryTransform),
    {"rtcIntersect1", offsetof(struct embree_api, query[0][0])},
    {"rtcIntersect4", offsetof(struct embree_api, query[0][1])},
    {"rtcIntersect8", offsetof(struct embree_api, query[0][2])},
    {"rtcIntersect16", offsetof(struct embree_api, query[0][3])},
    {"rtcOccluded1", offsetof(struct embree_api, query[1][0])},
    {"rtcOccluded4", offsetof(struct embree_api, query[1][1])},
    {"rtcOccluded8", offsetof(struct embree_api, query[1][2])},
    {"rtcOccluded16", offsetof(struct embree_api, query[1][3])},
};

static bool find_symbols(struct embree_api *api) {
    for (size_t i = 0; i < sizeof SYMBOLS / sizeof *SYMBOLS; i++) {
        void *found = dlsym(api->library, SYMBOLS[i].name);
        if (!found) return false;
        memcpy((char *)api + SYMBOLS[i].offset, &found, sizeof found);
    }
    return true;
}

static void *open_library(const char *path) {
    static const char *const USUAL[] = {"libembree4.so.4", "libembree4.so", "libembree3.so.3", "libembree3.so"};
    if (strcmp(path, "auto") != 0) return dlopen(path, RTLD_NOW | RTLD_LOCAL);
    void *library = NULL;
    for (size_t i = 0; !library && i < sizeof USUAL / sizeof *USUAL; i++) {
        library = dlopen(USUAL[i], RTLD_NOW | RTLD_LOCAL);
    }
    return library;
}

static bool count_bytes(void *user, ssize_t bytes, bool post) {
    (void)post;
    ((struct embree_api *)user)->bytes += bytes;
    return true;
}

static bool make_device(struct embree_api *api, const char *config) {
    char text[256];
    snprintf(text, sizeof text, "threads=1%s%s", config ? "," : "", config ? config : "");
    api->device = api->rtcNewDevice(text);
    if (!api->device) return false;
    api->version = (int)api->rtcGetDeviceProperty(api->device, RTC_DEVICE_PROPERTY_VERSION);
    api->rtcSetDeviceMemoryMonitorFunction(api->device, count_bytes, api);
    return api->version >= 30000 && api->version < 50000;
}

struct embree_api *embree_open(const char *path, const char *config) {
    void *library = open_library(path);
    if (!library) {
        if (strcmp(path, "auto") != 0) fprintf(stderr, "%s\n", dlerror());
        return NULL;
    }
    struct embree_api *api = bench_allocate(1, sizeof *api);
    api->library = library;
    if (!find_symbols(api) || !make_device(api, config)) {
        fprintf(stderr, "%s: not Embree 3 or 4, or it makes no device\n", path);
        free(api);
        return NULL;
    }
    return api;
}

/* The library stays: threads of its task system may still be in it. */
void embree_close(struct embree_api *api) {
    if (api) api->rtcReleaseDevice(api->device);
    free(api);
}

struct embree_query embree_query_make(const struct embree_api *api, bool coherent) {
    struct embree_query query = {{0}};
    if (api->version >= 40000) {
        struct arguments_of_4 arguments = {.flags = coherent ? COHERENT_OF_4 : 0, .feature_mask = UINT32_MAX};
        memcpy(&query, &arguments, sizeof arguments);
    } else {
        struct context_of_3 context = {.flags = coherent ? COHERENT_OF_3 : 0, .instance = RTC_INVALID_GEOMETRY_ID};
        memcpy(&query, &context, sizeof context);
    }
    return query;
}
