/* SPDX-License-Identifier: MIT */
/* peer_build.h: what a scene of the peer consists of; for peer.c and peer_build.c. */
#ifndef RAYGRID_BENCH_PEER_BUILD_H
#define RAYGRID_BENCH_PEER_BUILD_H

#include "peer.h"

enum { PEER_SPHERES, PEER_BOXES, PEER_CAPSULES, PEER_INSTANCES, PEER_MESH, PEER_PARTS };

/** All bodies of one kind. */
struct peer_part {
    uint32_t count;
    uint32_t each;         /* primitives a body */
    uint32_t id;           /* of the geometry; of the first instance */
    uint32_t *bodies;      /* the body of each member */
    RTCGeometry *geometry; /* one; of instances one each */
    float *coordinates;
    uint32_t *indices;
};

struct peer {
    const struct embree_api *api;
    const struct bench_scene *bodies;
    enum peer_build build;
    RTCScene scene;
    RTCScene meshes[BENCH_SHAPES]; /* what instances show, by shape */
    struct peer_part parts[PEER_PARTS];
    uint32_t *member; /* of each body: its place in its part */
    long long bytes;  /* that the peer took for it */
    long long input;  /* that it reads */
};

/** Whether its spheres are user-defined geometry. */
static inline bool defines_spheres(enum peer_build build) {
    return build == PEER_USER || build == PEER_USER_LOW || build == PEER_USER_REFIT;
}

/** Whether it has its instances as one geometry. */
static inline bool has_arrays(enum peer_build build) {
    return build == PEER_ARRAY || build == PEER_ARRAY_REFIT;
}

static inline bool in_array(const struct peer *peer) {
    return has_arrays(peer->build);
}

#endif
