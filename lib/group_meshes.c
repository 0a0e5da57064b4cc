/* SPDX-License-Identifier: MIT */
#include "group.h"

#include <string.h>

bool rgi_group_takes_mesh(const rgi_call *c, const rgi_object *object) {
    const rg_shape *shape = object->shape;
    return shape->kind == RG_SHAPE_MESH && shape->of.mesh->levels <= RGI_MESH_LEVELS && !c->config.filter;
}

/* The rays that see an object, of those named by bits, with the range of t in which they look for hits. */
static uint32_t join_mesh(const rgi_group *g, const rgi_object *object, uint32_t rays, rgi_mesh_packet *m) {
    const rgi_bundle *b = &g->bundle;
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        if (!(object->mask & b->mask[i])) rays &= ~(1u << i);
        m->t_max[i] = g->made >> i & 1         ? g->queries[i].walk.t_max
                      : g->known.rays >> i & 1 ? g->known.t[i]
                                               : b->t_max[i];
    }
    return rays;
}

/* Keeps a hit for a ray without a query; one that has a query takes it. */
static void take_from_mesh(rgi_group *g, const rgi_mesh_packet *m, uint32_t ray, uint32_t slot) {
    rgi_known *k = &g->known;
    rgi_packet *p = &g->packet;
    if (g->made >> ray & 1) {
        rgi_query *q = &g->queries[ray];
        q->done = rgi_query_take(q, slot, m->t_max[ray], m->leaf[ray], m->triangle[ray]);
        rgi_group_note_found(p, ray, q);
        return;
    }
    const rg_scene *scene = g->call->scene;
    if (k->rays >> ray & 1 && m->t_max[ray] == k->t[ray] &&
        rgi_object_id(rgi_scene_object(scene, slot), slot) >=
            rgi_object_id(rgi_scene_object(scene, k->slot[ray]), k->slot[ray]))
        return;
    const rgi_beam_scale scale = {p->shift[ray], p->length[ray]};
    k->rays |= 1u << ray;
    k->t[ray] = m->t_max[ray];
    k->slot[ray] = slot;
    k->leaf[ray] = m->leaf[ray];
    k->triangle[ray] = m->triangle[ray];
    k->primitive[ray] = rgi_mesh_primitive(m->mesh[ray], m->leaf[ray], m->triangle[ray]);
    p->found |= 1u << ray;
    p->t_hi[ray] = rgi_beam_above(&scale, p->pad[ray], k->t[ray]);
    p->t_lo[ray] = rgi_beam_below(&scale, p->pad[ray], k->t[ray]);
}

/* Brings the rays of a group that see a mesh to its root; those that do are active. */
static void enter_mesh(rgi_group *g, const rgi_object *object, uint32_t rays, rgi_mesh_packet *m) {
    const rg_scene *scene = g->call->scene;
    rays &= scene->kernels->mesh_enter(&g->bundle, object, rgi_scene_linear(scene, object), m);
    m->rays.active = join_mesh(g, object, rays & g->packet.active, m);
    m->rays.any = g->call->any;
    m->sides = rgi_query_sides(g->call);
    m->accept = NULL;
}

static void take_found(rgi_group *g, const rgi_mesh_packet *m, uint32_t slot) {
    rgi_packet *p = &g->packet;
    if (g->call->any) {
        p->certain |= m->found;
        p->active &= ~m->found;
        return;
    }
    for (uint32_t rest = m->found; rest; rest &= rest - 1) take_from_mesh(g, m, (uint32_t)__builtin_ctz(rest), slot);
}

bool rgi_group_ask_mesh(rgi_packet *p, uint32_t rays, uint32_t slot) {
    rgi_group *g = p->context;
    const rgi_kernels *kernels = g->call->scene->kernels;
    const rgi_object *object = rgi_scene_object(g->call->scene, slot);
    rgi_mesh_lanes lanes;
    rgi_mesh_packet *m = &lanes.rows[0].inside;
    if (!rgi_group_takes_mesh(g->call, object)) return false;
    rgi_group_ask_certain(p, rays);
    enter_mesh(g, object, rays, m);
    if (!m->rays.active) return true;
    lanes.rows[1].inside.rays.active = 0;
    if (!kernels->mesh_packet(m)) kernels->mesh_apart(&lanes);
    take_found(g, m, slot);
    return true;
}

uint32_t rgi_group_through_mesh(rgi_group *groups, uint32_t count, uint32_t slot, uint32_t together) {
    const rgi_kernels *kernels = groups[0].call->scene->kernels;
    const rgi_object *object = rgi_scene_object(groups[0].call->scene, slot);
    rgi_mesh_lanes lanes;
    uint32_t went = 0, apart = 0;
    for (uint32_t n = 0; n < RGI_SIDE_BY_SIDE / RGI_PACKET; n++) {
        rgi_mesh_packet *m = &lanes.rows[n].inside;
        m->rays.active = 0;
        if (n >= count || !groups[n].waits) continue;
        enter_mesh(&groups[n], object, groups[n].packet.active, m);
        if (!m->rays.active) {
            went |= 1u << n;
        } else if (together >> n & 1 && kernels->mesh_packet(m)) {
            went |= 1u << n;
            take_found(&groups[n], m, slot);
            m->rays.active = 0;
        } else {
            apart |= 1u << n;
        }
    }
    if (apart) kernels->mesh_apart(&lanes);
    for (uint32_t n = 0; n < count; n++) {
        if (apart >> n & 1) take_found(&groups[n], &lanes.rows[n].inside, slot);
    }
    return went;
}
