/* SPDX-License-Identifier: MIT */
/*
 * Queries: rays are read through views, traced one by one through the grids, and what is wanted of the hits is
 * written.
 */
#include "any_grid.h"
#include "error.h"
#include "exact.h"
#include "struct_size.h"
#include "vec.h"
#include "views.h"

#include <raygrid/trace.h>

#include <inttypes.h>
#include <string.h>

enum {
    RAYS_PER_TILE = 256, /* what a worker takes at a time */
    MIN_PACKET = 4,      /* fewer rays are better off on their own */
    CONFIG_LEAST = sizeof(rg_trace_config),
    RAYS_LEAST = sizeof(rg_ray_views),
    HITS_LEAST = sizeof(rg_hit_views)
};

/** What hit_record is to compute beside t, object, primitive, u and v, as bits. */
enum { POSITION = 1, NORMAL = 2, OFFSET = 4, ALL = 7 };

/** A call: its views, and what has become of it so far. */
typedef struct call {
    const rg_scene *scene;
    rg_trace_config config;
    rg_ray_views rays;
    rg_hit_views hits;  /* closest hit by views */
    rg_hit *plain_hits; /* closest hit, plain: then the views are empty */
    unsigned wanted;    /* of the hits */
    rg_output occluded; /* any hit */
    bool any;
    uint64_t count;
    uint64_t invalid; /* atomic */
    uint32_t failed;  /* atomic: a callback failed */
} call;

/** One ray on its way. */
typedef struct query {
    const call *call;
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
} query;

/* ---------------------------------------------------------------------------------------------- the hit record */

/*
 * Normals go by the transposed inverse, so they stay outward under mirrors too. Where a shape is so thin for its
 * length that rounding leaves nothing of its normal, the one against the ray stands in: nothing in a hit is NaN.
 */
static void world_normal(const rgi_ray *ray, const rgi_linear *linear, const rgi_candidate *c, float out[3]) {
    double n[3];
    if (linear)
        rgi_transform_transposed(linear->inverse, c->normal, n);
    else
        rgi_copy(c->normal, n);
    double largest = rgi_max_magnitude(n);
    if (!(largest > 0 && largest < INFINITY)) {
        for (int i = 0; i < 3; i++) n[i] = -ray->direction[i];
        largest = 1;
    }
    for (int i = 0; i < 3; i++) n[i] /= largest;
    double length = sqrt(rgi_dot(n, n));
    for (int i = 0; i < 3; i++) out[i] = (float)(n[i] / length);
}

static double frobenius(const double *m) {
    double sum = 0;
    for (int i = 0; i < 9; i++) sum += m[i] * m[i];
    return sqrt(sum);
}

/*
 * How far off the surface a hit may be, and a second look at it: a position is rounded to 2^-53 of its size, t to
 * 2^-53 of the distance travelled, and the tests in the object's frame to some 2^-46 of its size (64 radii at the
 * most, see lib/object.c) times the condition of its linear part. Each with a factor of 2^5 to spare.
 */
static double offset(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray, double t,
                     const double position[3]) {
    double from_centre[3], condition = 3;
    rgi_sub(position, object->position, from_centre);
    double size = object->reach < INFINITY ? object->reach : rgi_max_magnitude(from_centre);
    if (linear) condition = frobenius(linear->product) * frobenius(linear->inverse);
    double travelled = fabs(t) * sqrt(ray->dd);
    return 0x1p-42 * condition * size + 0x1p-47 * (rgi_max_magnitude(position) + travelled);
}

static void hit_record(const query *q, const rgi_object *object, rg_object id, const rgi_candidate *c,
                       unsigned wanted, rg_hit *hit) {
    static const double nowhere[3] = {0, 0, 0};
    const rgi_linear *linear = rgi_scene_linear(q->call->scene, object);
    memset(hit, 0, sizeof *hit);
    hit->t = rgi_world_t(&q->ray, c->t);
    hit->object = id;
    if (wanted & (POSITION | OFFSET)) rgi_rebase3(q->ray.origin, nowhere, c->t, q->ray.direction, hit->position);
    if (wanted & OFFSET) hit->offset = (float)offset(object, linear, &q->ray, c->t, hit->position);
    if (wanted & NORMAL) world_normal(&q->ray, linear, c, hit->normal);
    hit->u = (float)c->u;
    hit->v = (float)c->v;
    hit->primitive = c->primitive;
}

/* --------------------------------------------------------------------------------------------------- one ray */

static bool filter(void *context, const rgi_candidate *candidate) {
    query *q = context;
    rg_hit hit;
    if (q->failed) return false;
    hit_record(q, q->testing, q->testing_id, candidate, ALL, &hit);
    int32_t answer = q->call->config.filter(q->call->config.filter_user, q->index, &hit);
    q->failed = answer < 0;
    return answer > 0;
}

/* Tests an object. Among equal t the lowest id wins, whatever the order in which they are met. */
static bool visit(void *context, uint32_t slot) {
    query *q = context;
    const rg_scene *scene = q->call->scene;
    const rgi_object *object = rgi_scene_object(scene, slot);
    rgi_candidate candidate;
    if (!(object->mask & q->ray.mask)) return false;
    q->tests++;
    q->testing = object;
    q->testing_id = rgi_object_id(object, slot);
    q->local.t_max = q->walk.t_max;
    bool hit = rgi_object_intersect(object, rgi_scene_linear(scene, object), &q->ray, &q->local, &candidate);
    q->failed |= q->local.failed;
    if (q->failed) return true;
    if (!hit) return false;
    if (q->found && candidate.t == q->best.t && q->testing_id >= q->id) return false;
    q->found = true;
    q->id = q->testing_id;
    q->object = object;
    q->best = candidate;
    q->walk.t_max = candidate.t;
    return q->call->any;
}

static void query_init(query *q, const call *c) {
    static const uint32_t sides[] = {RGI_FRONT | RGI_BACK, RGI_FRONT, RGI_BACK};
    q->call = c;
    q->local.sides = sides[c->config.cull];
    q->local.any = c->any;
    q->local.accept = c->config.filter ? filter : NULL;
    q->local.context = q;
}

static void query_begin(query *q, uint64_t index) {
    const call *c = q->call;
    double origin[3], direction[3];
    rgi_load3(&c->rays.origin, index, origin);
    rgi_load3(&c->rays.direction, index, direction);
    q->index = index;
    q->found = q->failed = q->local.failed = false;
    q->tests = q->walk.cells = 0;
    q->valid = rgi_ray_init(&q->ray, origin, direction, rgi_load(&c->rays.t_min, index, 0),
                            rgi_load(&c->rays.t_max, index, INFINITY),
                            (uint32_t)rgi_load_integer(&c->rays.mask, index, UINT32_MAX));
    q->done = !q->valid;
    q->local.t_min = q->ray.t_min;
    q->walk.t_max = q->ray.t_max;
}

/* ------------------------------------------------------------------------------------------- through grids */

/* What a kernel asks. */
static bool ask(rgi_beam *beam, uint32_t slot) {
    query *q = beam->query;
    q->done = visit(q, slot);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, q->walk.t_max);
    return q->done;
}

static bool visit_unbounded(query *q, const rgi_lattice *lattice) {
    for (uint32_t i = 0; i < lattice->unbounded_count && !q->done; i++) q->done = visit(q, lattice->unbounded[i]);
    return q->done;
}

/* What a kernel asks for a ray of a packet. */
static bool ask_of_packet(rgi_packet *packet, uint32_t ray, uint32_t slot) {
    query *q = packet->queries[ray];
    q->done = visit(q, slot);
    if (!q->found) return q->done;
    packet->t_hi[ray] = rgi_beam_above(&packet->scale[ray], packet->pad[ray], q->walk.t_max);
    packet->t_lo[ray] = rgi_beam_below(&packet->scale[ray], packet->pad[ray], q->walk.t_max);
    return q->done;
}

/* Takes rays that go the same way through a lattice; false if these do not. */
static bool through_together(const call *c, const rgi_beam *beams, uint32_t count, const rgi_lattice *lattice) {
    rgi_packet packet;
    if (c->hits.cells.data || c->hits.tests.data || !rgi_packet_init(&packet, beams, count, lattice)) return false;
    packet.any = c->any;
    packet.ask_all = c->config.filter || c->config.cull != RG_CULL_NONE || c->scene->masked;
    packet.ask = ask_of_packet;
    for (uint32_t i = 0; i < count; i++) {
        query *q = packet.queries[i] = beams[i].query;
        packet.ask_all |= q->ray.mask == 0;
    }
    c->scene->kernels->trace_packet(lattice, &packet);
    for (uint32_t rays = packet.any ? packet.certain : 0; rays; rays &= rays - 1) {
        query *q = packet.queries[__builtin_ctz(rays)];
        q->found = q->done = true;
    }
    return true;
}

/* Takes rays through a lattice, one or several side by side. */
static void through_lattice(query *queries, uint32_t count, const rgi_lattice *lattice) {
    rgi_beam beams[RGI_PACKET];
    uint32_t used = 0;
    const call *c = queries->call;
    for (uint32_t i = 0; i < count; i++) {
        query *q = &queries[i];
        rgi_beam *beam = &beams[used];
        if (q->done || visit_unbounded(q, lattice)) continue;
        if (!lattice->root || !rgi_beam_init(beam, lattice, &q->ray, q->walk.t_max)) continue;
        beam->ask = ask;
        beam->query = q;
        used++;
    }
    if (used > MIN_PACKET && through_together(c, beams, used, lattice)) return;
    if (used == 1)
        c->scene->kernels->trace_one(lattice, &beams[0]);
    else if (used)
        c->scene->kernels->trace_some(lattice, beams, used);
    for (uint32_t i = 0; i < used; i++) ((query *)beams[i].query)->walk.cells += beams[i].nodes;
}

static void through_cells(query *q, const rgi_grid *grid) {
    double t_max = q->walk.t_max;
    uint32_t cells = q->walk.cells;
    rgi_walk_init(&q->walk, q->ray.origin, q->ray.direction, q->ray.t_min, t_max);
    q->walk.visit = visit;
    q->walk.context = q;
    q->done = rgi_grid_walk(grid, &q->walk);
    q->walk.cells += cells;
}

static void through_grids(query *queries, uint32_t count) {
    const rg_scene *scene = queries->call->scene;
    for (uint32_t g = 0; g < scene->grid_places; g++) {
        const rgi_any_grid *store = scene->grids[g].grid;
        if (!store || !store->count) continue;
        if (rgi_any_grid_is_loose(store)) {
            through_lattice(queries, count, &store->lattice);
            continue;
        }
        for (uint32_t i = 0; i < count; i++) {
            if (!queries[i].done) through_cells(&queries[i], &store->cells);
        }
    }
}

static void write_hit(const query *q) {
    const rg_hit_views *v = &q->call->hits;
    uint64_t i = q->index;
    rg_hit hit;
    if (q->valid && q->found && !q->failed) {
        hit_record(q, q->object, q->id, &q->best, q->call->wanted, &hit);
    } else {
        memset(&hit, 0, sizeof hit);
        hit.t = q->valid && !q->failed ? INFINITY : NAN;
        hit.object = RG_NO_OBJECT;
        hit.primitive = RG_NO_PRIMITIVE;
    }
    if (q->call->plain_hits) {
        q->call->plain_hits[i] = hit;
        return;
    }
    rgi_store(&v->t, i, hit.t);
    rgi_store_integer(&v->object, i, hit.object);
    rgi_store_integer(&v->primitive, i, hit.primitive);
    rgi_store3(&v->normal, i, hit.normal[0], hit.normal[1], hit.normal[2]);
    rgi_store(&v->u, i, hit.u);
    rgi_store(&v->v, i, hit.v);
    rgi_store3(&v->position, i, hit.position[0], hit.position[1], hit.position[2]);
    rgi_store(&v->offset, i, hit.offset);
    rgi_store_integer(&v->cells, i, q->walk.cells);
    rgi_store_integer(&v->tests, i, q->tests);
}

/* ------------------------------------------------------------------------------------------------ many rays */

static void trace_range(call *c, uint64_t first, uint64_t last) {
    query queries[RGI_PACKET];
    uint64_t invalid = 0;
    bool failed = false;
    for (uint32_t i = 0; i < RGI_PACKET && i < last - first; i++) query_init(&queries[i], c);
    for (uint64_t at = first; at < last; at += RGI_PACKET) {
        uint32_t count = last - at < RGI_PACKET ? (uint32_t)(last - at) : RGI_PACKET;
        for (uint32_t i = 0; i < count; i++) query_begin(&queries[i], at + i);
        through_grids(queries, count);
        for (uint32_t i = 0; i < count; i++) {
            const query *q = &queries[i];
            invalid += !q->valid;
            failed |= q->failed;
            if (c->any)
                rgi_store_integer(&c->occluded, q->index, q->valid && q->found && !q->failed);
            else
                write_hit(q);
        }
    }
    if (invalid) __atomic_fetch_add(&c->invalid, invalid, __ATOMIC_RELAXED);
    if (failed) __atomic_store_n(&c->failed, 1, __ATOMIC_RELAXED);
}

/* Runs on a worker, or on a thread of the host's: callbacks are told apart there too. */
static void trace_tile(void *context, uint64_t index) {
    call *c = context;
    rgi_frame frame;
    uint64_t first = index * RAYS_PER_TILE, last = first + RAYS_PER_TILE;
    rgi_frame_push(&frame, c->scene);
    trace_range(c, first, last < c->count ? last : c->count);
    rgi_frame_pop(&frame);
}

static rg_result run(rg_scene *scene, call *c) {
    rgi_frame frame;
    c->scene = scene;
    bool nested = rgi_scene_inside(scene);
    rgi_scene_begin_read(scene, &frame);
    /* From inside a callback the workers may all be waiting for this very thread. */
    if (nested || c->count < 2 * RAYS_PER_TILE)
        trace_range(c, 0, c->count);
    else
        rgi_pool_run(scene->pool, (c->count + RAYS_PER_TILE - 1) / RAYS_PER_TILE, trace_tile, c);
    rgi_scene_end_read(scene, &frame);
    if (c->invalid) __atomic_fetch_add(&scene->invalid_rays, c->invalid, __ATOMIC_RELAXED);
    if (c->config.invalid) *c->config.invalid = c->invalid;
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

static rg_result read_rays(call *c, const rg_trace_config *config, const rg_ray_views *rays, uint64_t count) {
    memset(c, 0, sizeof *c);
    c->count = count;
    if (!rays) return rgi_fail(RG_INVALID_ARGUMENT, "rays is NULL");
    rg_result result = rgi_struct_read(&c->config, sizeof c->config, CONFIG_LEAST, config, "rg_trace_config");
    if (!result) result = rgi_struct_read(&c->rays, sizeof c->rays, RAYS_LEAST, rays, "rg_ray_views");
    if (result) return result;
    const rg_ray_views *v = &c->rays;
    if (c->config.cull < RG_CULL_NONE || c->config.cull > RG_CULL_FRONT)
        return rgi_fail(RG_INVALID_ARGUMENT, "cull is %d, which is no way to cull", (int)c->config.cull);
    if (c->config.reserved)
        return rgi_fail(RG_INVALID_ARGUMENT, "rg_trace_config.reserved is %u, not 0", c->config.reserved);
    bool required = count > 0;
    result = rgi_check_view3(v->origin.x, v->origin.y, v->origin.z, v->origin.type, RGI_FLOATS, required, "origin");
    if (!result)
        result = rgi_check_view3(v->direction.x, v->direction.y, v->direction.z, v->direction.type, RGI_FLOATS,
                                 required, "direction");
    if (!result) result = rgi_check_view(v->t_min.data, v->t_min.type, RGI_FLOATS, 0, "t_min");
    if (!result) result = rgi_check_view(v->t_max.data, v->t_max.type, RGI_FLOATS, 0, "t_max");
    if (!result) result = rgi_check_view(v->mask.data, v->mask.type, RGI_U32, 0, "mask");
    return result;
}

static rg_result read_hits(call *c, const rg_hit_views *hits) {
    if (!hits) return rgi_fail(RG_INVALID_ARGUMENT, "hits is NULL");
    rg_result result = rgi_struct_read(&c->hits, sizeof c->hits, HITS_LEAST, hits, "rg_hit_views");
    if (result) return result;
    const rg_hit_views *v = &c->hits;
    const struct {
        const rg_output *view;
        unsigned types;
        const char *name;
    } outputs[] = {{&v->t, RGI_FLOATS, "t"},      {&v->object, RGI_U64, "object"},
                   {&v->u, RGI_FLOATS, "u"},      {&v->primitive, RGI_U32 | RGI_U64, "primitive"},
                   {&v->v, RGI_FLOATS, "v"},      {&v->offset, RGI_FLOATS, "offset"},
                   {&v->cells, RGI_U32, "cells"}, {&v->tests, RGI_U32, "tests"}};
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs && !result; i++)
        result = rgi_check_view(outputs[i].view->data, outputs[i].view->type, outputs[i].types, 0, outputs[i].name);
    if (!result)
        result = rgi_check_view3(v->normal.x, v->normal.y, v->normal.z, v->normal.type, RGI_FLOATS, 0, "normal");
    if (!result)
        result =
            rgi_check_view3(v->position.x, v->position.y, v->position.z, v->position.type, RGI_FLOATS, 0, "position");
    c->wanted = (v->position.x ? POSITION : 0) | (v->normal.x ? NORMAL : 0) | (v->offset.data ? OFFSET : 0);
    return result;
}

rg_result rg_scene_trace_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                               const rg_hit_views *hits, uint64_t count) {
    call c;
    rg_result result = check_call(scene, count);
    if (!result) result = read_rays(&c, config, rays, count);
    if (!result) result = read_hits(&c, hits);
    return result ? result : run(scene, &c);
}

rg_result rg_scene_occluded_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                                  const rg_output *occluded, uint64_t count) {
    call c;
    rg_result result = check_call(scene, count);
    if (!result) result = read_rays(&c, config, rays, count);
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

/* The views of plain rays. */
static rg_result read_plain(call *c, const rg_scene *scene, const rg_ray *rays, const void *out, uint64_t count) {
    memset(c, 0, sizeof *c);
    c->count = count;
    rg_result result = check_call(scene, count);
    if (result || count == 0) return result;
    if (!rays || !out) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", rays ? "the output" : "rays");
    c->rays.origin = rg_input3_packed(rays->origin, sizeof *rays, RG_F64);
    c->rays.direction = rg_input3_packed(rays->direction, sizeof *rays, RG_F64);
    c->rays.t_min = plain(&rays->t_min, RG_F64);
    c->rays.t_max = plain(&rays->t_max, RG_F64);
    c->rays.mask = plain(&rays->mask, RG_U32);
    return RG_OK;
}

rg_result rg_scene_trace(rg_scene *scene, const rg_ray *rays, rg_hit *hits, uint64_t count) {
    call c;
    rg_result result = read_plain(&c, scene, rays, hits, count);
    if (result || count == 0) return result;
    c.plain_hits = hits;
    c.wanted = ALL;
    return run(scene, &c);
}

rg_result rg_scene_occluded(rg_scene *scene, const rg_ray *rays, uint8_t *occluded, uint64_t count) {
    call c;
    rg_result result = read_plain(&c, scene, rays, occluded, count);
    if (result || count == 0) return result;
    c.any = true;
    c.occluded.data = occluded;
    c.occluded.stride = 1;
    c.occluded.type = RG_U8;
    return run(scene, &c);
}
