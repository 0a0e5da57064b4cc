/* SPDX-License-Identifier: MIT */
/* A ray on its way through a scene: what it asks of objects, and what becomes of it. */
#ifndef RAYGRID_LIB_QUERY_H
#define RAYGRID_LIB_QUERY_H

#include "any_grid.h"
#include "mesh_ray.h"

#include <raygrid/trace.h>

/** What is to be computed of a hit beside t, object, primitive, u and v, as bits. */
enum { RGI_POSITION = 1, RGI_NORMAL = 2, RGI_OFFSET = 4, RGI_ALL = 7 };

/** A call: its views, and what has become of it so far. */
typedef struct rgi_call {
    rg_scene *scene;
    rg_trace_config config;
    const rg_ray_views *rays;
    const rg_hit_views *hits; /* closest hit by views */
    rg_hit *plain_hits;       /* closest hit, plain: then the views are empty */
    unsigned wanted;          /* of the hits */
    rg_output occluded;       /* any hit */
    bool any;
    uint64_t count;
    uint64_t invalid; /* atomic */
    uint32_t failed;  /* atomic: a callback failed */
} rgi_call;

/** One ray on its way. */
typedef struct rgi_query {
    const rgi_call *call;
    uint64_t index;
    rgi_ray ray;
    rgi_walk walk;
    rgi_local_ray local;
    const rgi_object *testing; /* the object that is being tested, for the filter */
    rg_object testing_id;
    uint32_t tests;
    bool valid;
    bool failed;
    bool found;
    bool done; /* nothing more is wanted */
    rg_object id;
    const rgi_object *object;
    rgi_candidate best;
    const void *leaf; /* NULL; or where the best was met in a mesh, of which only t and primitive are known yet */
    uint32_t triangle;
} rgi_query;

/** The sides of surfaces that count in a call. */
uint32_t rgi_query_sides(const rgi_call *call);

/** For all rays of a call. */
void rgi_query_init(rgi_query *query, const rgi_call *call);

/** For the ray of a number, before the ray itself is filled: then `walk.t_max` and `local.t_min` are to be set. */
void rgi_query_reset(rgi_query *query, uint64_t index);

/** Reads a ray of the call and begins it; it may turn out invalid. */
void rgi_query_begin(rgi_query *query, uint64_t index);

/**
 * Tests an object. Among equal t the lowest id wins, whatever the order in which they are met. Returns true if
 * nothing more is wanted. `context` is the query.
 */
bool rgi_query_visit(void *context, uint32_t slot);

/** The same for an object that is a mesh, in two steps: false if the ray does not see it, else it has taken a lane,
 * is to be taken through and to leave, which returns true if nothing more is wanted. */
bool rgi_query_enter(rgi_query *query, uint32_t slot, rgi_mesh_lanes *lanes);
bool rgi_query_leave(rgi_query *query, const rgi_mesh_lanes *lanes, uint32_t lane);

/** Takes a hit on a triangle of a mesh that was found another way. Returns true if nothing more is wanted. */
bool rgi_query_take(rgi_query *query, uint32_t slot, double t, const void *leaf, uint32_t triangle);

/** Writes what is wanted of the ray. */
void rgi_query_write(const rgi_query *query);

#endif
