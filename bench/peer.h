/* SPDX-License-Identifier: MIT */
/*
 * peer.h: Embree's side, in the way that suits it best: spheres as sphere points, boxes as quads, capsules as round
 * linear curves, each kind in one geometry; meshes as instances of one scene a shape, one by one or as an array.
 */
#ifndef RAYGRID_BENCH_PEER_H
#define RAYGRID_BENCH_PEER_H

#include "embree_api.h"
#include "rays.h"

/** How the hierarchy is built and kept up. */
enum peer_build {
    PEER_MEDIUM,
    PEER_HIGH,
    PEER_LOW,
    PEER_ARRAY,       /* medium, instances as one array of them: built low, Embree 4.4.0 crashes when traced */
    PEER_REFIT,       /* each geometry's boxes fitted anew in the tree as it was; not where there are instances */
    PEER_ARRAY_REFIT, /* the same of an array of instances: Embree 4.4.0 then answers most rays wrongly */
    PEER_USER,        /* medium, spheres as user-defined geometry */
    PEER_USER_LOW,
    PEER_USER_REFIT, /* fitted anew as in PEER_REFIT; sphere points are built anew even so */
    PEER_BUILDS
};

extern const char *const PEER_BUILD_NAMES[PEER_BUILDS];

/** The peer as the command line chose it. */
struct peer_choice {
    const struct embree_api *api; /* NULL: there is no peer */
    bool robust;
};

/** How rays are handed over: 1, 4, 8 or 16 at a time (width 0 to 3), with the hint or without. */
struct peer_way {
    int width;
    bool coherent;
};

struct peer;

/** Whether the peer can build these bodies so. */
bool peer_can(const struct peer_choice *choice, const struct bench_scene *bodies, enum peer_build build);

/** A scene with all of `bodies`, which must outlive it, built by one thread. */
struct peer *peer_create(const struct peer_choice *choice, const struct bench_scene *bodies, enum peer_build build);
void peer_destroy(struct peer *peer);

void peer_trace(struct peer *peer, const struct bench_rays *rays, struct peer_way way,
                const struct bench_answers *answers);

/**
 * The fastest way for these rays, tried on some of them, and the `seconds` that took (NULL: not wanted); with
 * `single` only one ray a call.
 */
struct peer_way peer_best_way(struct peer *peer, const struct bench_rays *rays, bool single,
                              const struct bench_answers *answers, double *seconds);

/** Such as "16 coherent". */
const char *peer_way_name(struct peer_way way);

/** The body with that id, UINT32_MAX for none. */
uint32_t peer_body(const struct peer *peer, uint64_t id);

/**
 * Moves bodies and makes the change seen: returns the seconds it takes. Writing the coordinates is not counted, as a
 * host may let them lie where Embree reads them; naming each moved instance is, from number `counted` on.
 */
double peer_move(struct peer *peer, const uint32_t *which, double (*positions)[3], uint32_t count, uint32_t counted);

/** Lets only the first `count` spheres of a scene of spheres be there, and makes it seen: returns the seconds. */
double peer_keep(struct peer *peer, uint32_t count);

enum peer_build peer_build_of(const struct peer *peer);

/** The coordinates that it reads included. */
double peer_bytes_per_object(const struct peer *peer);

#endif
