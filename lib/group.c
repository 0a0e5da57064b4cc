/* SPDX-License-Identifier: MIT */
#include "group.h"

#include "vec.h"
#include "views.h"

#include <string.h>

/* ---------------------------------------------------------------------------------------------------- reading */

static void load_lanes(const rg_input *view, uint64_t first, uint32_t count, double missing, double *out) {
    if (!view->data) {
        for (uint32_t i = 0; i < RGI_PACKET; i++) out[i] = missing;
        return;
    }
    const char *at = rgi_record(view->data, view->stride, first);
    if (view->type == RG_F32) {
        for (uint32_t i = 0; i < count; i++) out[i] = rgi_read_float(at + view->stride * (ptrdiff_t)i, RG_F32);
    } else {
        for (uint32_t i = 0; i < count; i++) out[i] = rgi_read_float(at + view->stride * (ptrdiff_t)i, RG_F64);
    }
    for (uint32_t i = count; i < RGI_PACKET; i++) out[i] = out[0];
}

/* Reads the rays. Returns whether they are neither invalid nor extreme. */
bool rgi_group_load(rgi_group *g) {
    const rg_ray_views *rays = g->call->rays;
    rgi_bundle *b = &g->bundle;
    const void *const origins[3] = {rays->origin.x, rays->origin.y, rays->origin.z};
    const void *const directions[3] = {rays->direction.x, rays->direction.y, rays->direction.z};
    for (int a = 0; a < 3; a++) {
        const rg_input origin = {origins[a], rays->origin.stride, rays->origin.type};
        const rg_input direction = {directions[a], rays->direction.stride, rays->direction.type};
        load_lanes(&origin, g->first, g->count, 0, b->origin[a]);
        load_lanes(&direction, g->first, g->count, 0, b->direction[a]);
    }
    load_lanes(&rays->t_min, g->first, g->count, 0, b->t_min);
    load_lanes(&rays->t_max, g->first, g->count, INFINITY, b->t_max);
    for (uint32_t i = 0; i < RGI_PACKET; i++)
        b->mask[i] = (uint32_t)rgi_load_integer(&rays->mask, i < g->count ? g->first + i : g->first, UINT32_MAX);
    b->count = g->count;
    g->made = 0;
    g->known.rays = 0;
    return g->call->scene->kernels->prepare(b);
}

/* The query of a ray of the bundle, made when it is first needed. */
rgi_query *rgi_group_query(rgi_group *g, uint32_t i) {
    rgi_query *q = &g->queries[i];
    const rgi_bundle *b = &g->bundle;
    if (g->made >> i & 1) return q;
    g->made |= 1u << i;
    rgi_query_reset(q, g->first + i);
    for (int a = 0; a < 3; a++) {
        q->ray.origin[a] = b->origin[a][i];
        q->ray.direction[a] = b->direction[a][i];
    }
    q->local.t_min = q->ray.t_min = b->t_min[i];
    q->walk.t_max = q->ray.t_max = b->t_max[i];
    q->ray.dd = b->dd[i];
    q->ray.to_world = b->to_world[i];
    q->ray.to_world2 = b->to_world2[i];
    q->ray.mask = b->mask[i];
    if (g->known.rays >> i & 1) {
        g->known.rays &= ~(1u << i);
        (void)rgi_query_take(q, g->known.slot[i], g->known.t[i], g->known.leaf[i], g->known.triangle[i]);
    }
    return q;
}

/* What a query has found bounds its ray in the packet. */
void rgi_group_note_found(rgi_packet *p, uint32_t ray, const rgi_query *q) {
    const rgi_beam_scale scale = {p->shift[ray], p->length[ray]};
    if (!q->found) return;
    p->found |= 1u << ray;
    p->t_hi[ray] = rgi_beam_above(&scale, p->pad[ray], q->walk.t_max);
    p->t_lo[ray] = rgi_beam_below(&scale, p->pad[ray], q->walk.t_max);
}

/* What a kernel asks for a ray of a packet. */
bool rgi_group_ask(rgi_packet *p, uint32_t ray, uint32_t slot) {
    rgi_query *q = rgi_group_query(p->context, ray);
    q->done = rgi_query_visit(q, slot);
    rgi_group_note_found(p, ray, q);
    return q->done;
}

/* Before another object is asked about, what was certain so far is. */
void rgi_group_ask_certain(rgi_packet *p, uint32_t rays) {
    for (rays &= p->certain; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), best;
        memcpy(&best, &p->best[ray], sizeof best);
        p->certain &= ~(1u << ray);
        if (rgi_group_ask(p, ray, best)) p->active &= ~(1u << ray);
    }
}

/* ---------------------------------------------------------------------------------------------------- writing */

/* Whether of a hit no more is wanted than what rgi_meeting has. */
static bool wants_little(const rgi_call *c) {
    return !c->plain_hits && !(c->wanted & ~(unsigned)RGI_NORMAL) && !c->hits->u.data && !c->hits->v.data;
}

/* Where the rays meet the balls that are certain: for all at once. Returns the bits of those it is right for. */
static uint32_t meet_certain(const rgi_group *g, const rgi_packet *p, rgi_meeting *m, uint64_t ids[RGI_PACKET]) {
    const rg_scene *scene = g->call->scene;
    uint32_t slots[RGI_PACKET];
    memcpy(slots, p->best, sizeof slots);
    uint32_t any = slots[__builtin_ctz(p->certain)];
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        uint32_t slot = p->certain >> i & 1 ? slots[i] : any;
        const rgi_object *object = rgi_scene_object(scene, slot);
        for (int a = 0; a < 3; a++) m->centre[a][i] = object->position[a];
        m->radius[i] = object->reach;
        ids[i] = rgi_object_id(object, slot);
    }
    m->wants_normals = g->call->wanted & RGI_NORMAL;
    scene->kernels->meet(&g->bundle, m);
    return p->certain & m->met;
}

/* Numbers of the rays that are named by bits. */
static void store_lanes(const rg_output *view, uint64_t first, uint32_t rays, const double numbers[RGI_PACKET]) {
    if (!view->data) return;
    char *at = rgi_record_out(view->data, view->stride, first);
    for (; view->type == RG_F32 && rays; rays &= rays - 1) {
        int i = __builtin_ctz(rays);
        rgi_write_float(at + view->stride * i, RG_F32, numbers[i]);
    }
    for (; rays; rays &= rays - 1) {
        int i = __builtin_ctz(rays);
        rgi_write_float(at + view->stride * i, RG_F64, numbers[i]);
    }
}

static void store_integers(const rg_output *view, uint64_t first, uint32_t rays, const uint64_t numbers[RGI_PACKET]) {
    if (!view->data) return;
    char *at = rgi_record_out(view->data, view->stride, first);
    for (; view->type == RG_U64 && rays; rays &= rays - 1) {
        int i = __builtin_ctz(rays);
        rgi_write_integer(at + view->stride * i, RG_U64, numbers[i]);
    }
    for (; rays; rays &= rays - 1) {
        int i = __builtin_ctz(rays);
        rgi_write_integer(at + view->stride * i, view->type, numbers[i]);
    }
}

/* Writes the hits that are certain, or known, and the misses of rays that asked nothing. Returns their bits. */
static uint32_t write_unasked(const rgi_group *g, const rgi_packet *p) {
    const rgi_call *c = g->call;
    const rgi_known *k = &g->known;
    rgi_meeting m;
    double t[RGI_PACKET];
    uint64_t objects[RGI_PACKET], primitives[RGI_PACKET], ids[RGI_PACKET];
    uint32_t all = (1u << g->count) - 1, met = 0, written = all & ~g->made & ~p->certain;
    if (p->certain) met = meet_certain(g, p, &m, ids);
    /* Of triangles the normals are not known. */
    if (c->wanted) written &= ~k->rays;
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        t[i] = INFINITY;
        objects[i] = RG_NO_OBJECT;
        primitives[i] = RG_NO_PRIMITIVE;
    }
    for (uint32_t rays = written & k->rays; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays);
        t[i] = k->t[i] * g->bundle.to_world[i] * g->bundle.to_world2[i];
        objects[i] = rgi_object_id(rgi_scene_object(c->scene, k->slot[i]), k->slot[i]);
        primitives[i] = k->primitive[i];
    }
    for (uint32_t rays = met; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays);
        t[i] = m.t[i];
        objects[i] = ids[i];
        primitives[i] = 0;
    }
    written |= met;
    store_lanes(&c->hits->t, g->first, written, t);
    store_integers(&c->hits->object, g->first, written, objects);
    store_integers(&c->hits->primitive, g->first, written, primitives);
    for (uint32_t rays = c->hits->normal.x ? written : 0; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays);
        bool hit = met >> i & 1;
        rgi_store3(&c->hits->normal, g->first + i, hit ? m.normal[0][i] : 0, hit ? m.normal[1][i] : 0,
                   hit ? m.normal[2][i] : 0);
    }
    return written;
}

static uint32_t write_occluded(const rgi_group *g, const rgi_packet *p) {
    uint32_t written = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        bool found = p->certain >> i & 1;
        if (!found && (g->made >> i & 1)) continue;
        rgi_store_integer(&g->call->occluded, g->first + i, found);
        written |= 1u << i;
    }
    return written;
}

/* After the kernel: writes what it found without asking; the rest is asked. Returns the bits of the rays written. */
uint32_t rgi_group_write(rgi_group *g) {
    rgi_packet *p = &g->packet;
    if (g->call->any) return write_occluded(g, p);
    uint32_t written = wants_little(g->call) ? write_unasked(g, p) : 0;
    for (uint32_t rays = p->certain & ~written; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), slot;
        memcpy(&slot, &p->best[ray], sizeof slot);
        (void)rgi_group_ask(p, ray, slot);
    }
    return written;
}
