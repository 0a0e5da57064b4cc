/* SPDX-License-Identifier: MIT */
/* Queries: what is given is checked, and the rays are shared out among the workers. */
#include "error.h"
#include "struct_size.h"
#include "through.h"
#include "vec.h"
#include "views.h"

#include <raygrid/trace.h>

#include <inttypes.h>
#include <string.h>

enum {
    RAYS_PER_TILE = 256, /* what a worker takes at a time */
    CONFIG_LEAST = sizeof(rg_trace_config),
    RAYS_LEAST = sizeof(rg_ray_views),
    HITS_LEAST = sizeof(rg_hit_views)
};

/* ------------------------------------------------------------------------------------------------ many rays */

/*
 * Between two groups of rays a change that waits is let in. So no change waits longer than a group takes; each ray
 * sees the scene at one instant, the rays of a long call not all the same. Not from inside a callback: the trace
 * around it holds the scene.
 */
static void trace_range(rgi_call *c, uint64_t first, uint64_t last) {
    rgi_frame frame;
    while (first < last) {
        rgi_scene_begin_read(c->scene, &frame);
        first = rgi_through(c, first, last, frame.locked);
        rgi_scene_end_read(c->scene, &frame);
    }
}

/* Runs on a worker, or on a thread of the host's: callbacks are told apart there too. */
static void trace_tile(void *context, uint64_t index) {
    rgi_call *c = context;
    uint64_t first = index * RAYS_PER_TILE, last = first + RAYS_PER_TILE;
    trace_range(c, first, last < c->count ? last : c->count);
}

static void trace_all(rg_scene *scene, rgi_call *c) {
    /* From inside a callback the workers may all be waiting for this very thread. */
    if (c->count < 2 * RAYS_PER_TILE || rgi_scene_inside(scene))
        trace_range(c, 0, c->count);
    else
        rgi_pool_run(scene->pool, (c->count + RAYS_PER_TILE - 1) / RAYS_PER_TILE, trace_tile, c);
}

static rg_result run(rg_scene *scene, rgi_call *c) {
    /* Small calls hold the lock from their begin to their end, which tells the same. */
    bool counted = c->count > RGI_PACKET;
    if (counted) __atomic_fetch_add(&scene->running, 1, __ATOMIC_ACQUIRE);
    trace_all(scene, c);
    if (c->invalid) __atomic_fetch_add(&scene->invalid_rays, c->invalid, __ATOMIC_RELAXED);
    if (c->config.invalid) *c->config.invalid = c->invalid;
    if (counted) __atomic_fetch_sub(&scene->running, 1, __ATOMIC_RELEASE);
    return c->failed ? rgi_fail(RG_CALLBACK_FAILED, "a callback of the host failed during the trace") : RG_OK;
}

/* ----------------------------------------------------------------------------------------- the entry points */

static const rg_trace_config default_config = {sizeof(rg_trace_config), RG_CULL_NONE, 0, NULL, NULL, NULL};

rg_result rg_trace_config_default(rg_trace_config *config, size_t size) {
    return rgi_struct_default(&default_config, sizeof default_config, CONFIG_LEAST, config, size, "rg_trace_config");
}

rg_ray rg_ray_from(const double origin[3], const double direction[3]) {
    rg_ray ray;
    rgi_copy(origin, ray.origin);
    rgi_copy(direction, ray.direction);
    ray.t_min = 0;
    ray.t_max = INFINITY;
    ray.mask = UINT32_MAX;
    ray.reserved = 0;
    return ray;
}

static rg_result check_call(const rg_scene *scene, uint64_t count) {
    if (!scene) return rgi_fail(RG_INVALID_ARGUMENT, "scene is NULL");
    if (count > 1ull << 48) return rgi_fail(RG_LIMIT_EXCEEDED, "count is %" PRIu64 ", above 2^48", count);
    return RG_OK;
}

/* Nothing of views, and the defaults. */
static void begin_call(rgi_call *c, rg_scene *scene, uint64_t count) {
    static const rg_hit_views none;
    c->scene = scene;
    c->config = default_config;
    c->hits = &none;
    c->plain_hits = NULL;
    c->wanted = 0;
    c->any = false;
    c->count = count;
    c->invalid = 0;
    c->failed = 0;
}

/* `room`: for the views, if they are another version's. */
static rg_result read_rays(rgi_call *c, const rg_trace_config *config, const rg_ray_views *rays, rg_ray_views *room) {
    const void *view;
    if (!rays) return rgi_fail(RG_INVALID_ARGUMENT, "rays is NULL");
    rg_result result =
        config ? rgi_struct_read(&c->config, sizeof c->config, CONFIG_LEAST, config, "rg_trace_config") : RG_OK;
    if (!result) result = rgi_struct_view(rays, room, sizeof *room, RAYS_LEAST, "rg_ray_views", &view);
    if (result) return result;
    const rg_ray_views *v = c->rays = view;
    if (c->config.cull < RG_CULL_NONE || c->config.cull > RG_CULL_FRONT)
        return rgi_fail(RG_INVALID_ARGUMENT, "cull is %d, which is no way to cull", (int)c->config.cull);
    if (c->config.coherence < RG_COHERENCE_UNKNOWN || c->config.coherence > RG_COHERENCE_HIGH)
        return rgi_fail(RG_INVALID_ARGUMENT, "coherence is %d, which is none", (int)c->config.coherence);
    bool required = c->count > 0;
    result = rgi_check_view3(v->origin.x, v->origin.y, v->origin.z, v->origin.type, RGI_FLOATS, required, "origin");
    if (!result)
        result = rgi_check_view3(v->direction.x, v->direction.y, v->direction.z, v->direction.type, RGI_FLOATS,
                                 required, "direction");
    if (!result) result = rgi_check_view(v->t_min.data, v->t_min.type, RGI_FLOATS, 0, "t_min");
    if (!result) result = rgi_check_view(v->t_max.data, v->t_max.type, RGI_FLOATS, 0, "t_max");
    if (!result) result = rgi_check_view(v->mask.data, v->mask.type, RGI_U32, 0, "mask");
    return result;
}

static rg_result read_hits(rgi_call *c, const rg_hit_views *hits, rg_hit_views *room) {
    const void *view;
    if (!hits) return rgi_fail(RG_INVALID_ARGUMENT, "hits is NULL");
    rg_result result = rgi_struct_view(hits, room, sizeof *room, HITS_LEAST, "rg_hit_views", &view);
    if (result) return result;
    const rg_hit_views *v = c->hits = view;
#define CHECK(field, types)                                                                                          \
    if (!result) result = rgi_check_view(v->field.data, v->field.type, types, 0, #field)
    CHECK(t, RGI_FLOATS);
    CHECK(object, RGI_U64);
    CHECK(primitive, RGI_U32 | RGI_U64);
    CHECK(u, RGI_FLOATS);
    CHECK(v, RGI_FLOATS);
    CHECK(offset, RGI_FLOATS);
    CHECK(cells, RGI_U32);
    CHECK(tests, RGI_U32);
#undef CHECK
    if (!result)
        result = rgi_check_view3(v->normal.x, v->normal.y, v->normal.z, v->normal.type, RGI_FLOATS, 0, "normal");
    if (!result)
        result =
            rgi_check_view3(v->position.x, v->position.y, v->position.z, v->position.type, RGI_FLOATS, 0, "position");
    c->wanted =
        (v->position.x ? RGI_POSITION : 0) | (v->normal.x ? RGI_NORMAL : 0) | (v->offset.data ? RGI_OFFSET : 0);
    return result;
}

rg_result rg_scene_trace_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                               const rg_hit_views *hits, uint64_t count) {
    rgi_call c;
    rg_ray_views ray_room;
    rg_hit_views hit_room;
    begin_call(&c, scene, count);
    rg_result result = check_call(scene, count);
    if (!result) result = read_rays(&c, config, rays, &ray_room);
    if (!result) result = read_hits(&c, hits, &hit_room);
    return result ? result : run(scene, &c);
}

rg_result rg_scene_occluded_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                                  const rg_output *occluded, uint64_t count) {
    rgi_call c;
    rg_ray_views room;
    begin_call(&c, scene, count);
    rg_result result = check_call(scene, count);
    if (!result) result = read_rays(&c, config, rays, &room);
    if (!result && !occluded) result = rgi_fail(RG_INVALID_ARGUMENT, "occluded is NULL");
    if (!result) result = rgi_check_view(occluded->data, occluded->type, RGI_U8, count > 0, "occluded");
    if (result) return result;
    c.any = true;
    c.occluded = *occluded;
    return run(scene, &c);
}

static rg_input plain(const void *data, rg_type type) {
    rg_input view = {data, sizeof(rg_ray), type};
    return view;
}

static rg_input3 plain3(const double at[3]) {
    rg_input3 view = {at, at + 1, at + 2, sizeof(rg_ray), RG_F64};
    return view;
}

/* The views of plain rays. */
static rg_result read_plain(rgi_call *c, rg_scene *scene, const rg_ray *rays, const void *out, uint64_t count,
                            rg_ray_views *views) {
    begin_call(c, scene, count);
    rg_result result = check_call(scene, count);
    if (result || count == 0) return result;
    if (!rays || !out) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", rays ? "the output" : "rays");
    views->origin = plain3(rays->origin);
    views->direction = plain3(rays->direction);
    views->t_min = plain(&rays->t_min, RG_F64);
    views->t_max = plain(&rays->t_max, RG_F64);
    views->mask = plain(&rays->mask, RG_U32);
    c->rays = views;
    return RG_OK;
}

rg_result rg_scene_trace(rg_scene *scene, const rg_ray *rays, rg_hit *hits, uint64_t count) {
    rgi_call c;
    rg_ray_views views;
    rg_result result = read_plain(&c, scene, rays, hits, count, &views);
    if (result || count == 0) return result;
    c.plain_hits = hits;
    c.wanted = RGI_ALL;
    return run(scene, &c);
}

rg_result rg_scene_occluded(rg_scene *scene, const rg_ray *rays, uint8_t *occluded, uint64_t count) {
    rgi_call c;
    rg_ray_views views;
    rg_result result = read_plain(&c, scene, rays, occluded, count, &views);
    if (result || count == 0) return result;
    c.any = true;
    c.occluded.data = occluded;
    c.occluded.stride = 1;
    c.occluded.type = RG_U8;
    return run(scene, &c);
}
