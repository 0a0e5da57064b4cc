/* SPDX-License-Identifier: MIT */
/* Rays that are read, worked on and written together. */
#ifndef RAYGRID_LIB_GROUP_H
#define RAYGRID_LIB_GROUP_H

#include "query.h"

/** Hits that packets have found in meshes, of rays that have no query yet. */
typedef struct rgi_known {
    uint32_t rays; /* bits of those that have one */
    double t[RGI_PACKET];
    uint32_t slot[RGI_PACKET], triangle[RGI_PACKET], primitive[RGI_PACKET];
    const void *leaf[RGI_PACKET];
} rgi_known;

/** Rays that are worked on at a time. */
typedef struct rgi_group {
    const rgi_call *call;
    const rgi_lattice *lattice; /* which holds all objects of the scene; or NULL */
    uint64_t first;             /* number of the first ray */
    uint32_t count;
    uint32_t made; /* bits of the queries that have their ray: in a packet only those that ask */
    bool waits;    /* its rays are in `packet`, and have not gone through yet */
    bool together; /* they went the same way, as `packet` */
    rgi_packet packet;
    rgi_bundle bundle;
    rgi_known known;
    rgi_query queries[RGI_PACKET];
} rgi_group;

/** Reads the rays. Returns whether they are neither invalid nor extreme. */
bool rgi_group_load(rgi_group *group);

/** The query of a ray of the bundle, made when it is first needed. */
rgi_query *rgi_group_query(rgi_group *group, uint32_t ray);

/** What a query has found bounds its ray in the packet. */
void rgi_group_note_found(rgi_packet *packet, uint32_t ray, const rgi_query *query);

/** What kernels ask: see rgi_packet. */
bool rgi_group_ask(rgi_packet *packet, uint32_t ray, uint32_t slot);
bool rgi_group_ask_mesh(rgi_packet *packet, uint32_t rays, uint32_t slot);

/** Whether objects as this are for rgi_group_ask_mesh and rgi_group_through_mesh. */
bool rgi_group_takes_mesh(const rgi_call *call, const rgi_object *object);

/**
 * Takes the rays of one or two groups that wait through a mesh, those of the groups that `together` names by bits
 * together, if they go the same way. Returns the bits of the groups that did.
 */
uint32_t rgi_group_through_mesh(rgi_group *groups, uint32_t count, uint32_t slot, uint32_t together);

/** Before another object is asked about, what was certain so far is. */
void rgi_group_ask_certain(rgi_packet *packet, uint32_t rays);

/** After the rays went through as a packet: writes what it found without asking; the rest is asked. Returns the bits
 * of the rays written. */
uint32_t rgi_group_write(rgi_group *group);

#endif
