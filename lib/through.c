/* SPDX-License-Identifier: MIT */
#include "through.h"

#include "vec.h"
#include "views.h"

#include <string.h>

enum {
    /* Fewer rays are better off on their own. */
    MIN_PACKET = 4,
    /* Nodes and blocks that packets look into before their rays go on apart: where objects are dense against the
     * distance of the rays, as in a small cluster, the planes around them hold too many. Some 17 to 50 are common. */
    PATIENCE = 160,
    /* After tries given up in a row 1, 3, 7, then 15 are left out. */
    MOST_LOST = 4
};

/** Hits that packets have found in meshes, of rays that have no query yet. */
typedef struct known {
    uint32_t rays; /* bits of those that have one */
    double t[RGI_PACKET];
    uint32_t slot[RGI_PACKET], triangle[RGI_PACKET], primitive[RGI_PACKET];
    const void *leaf[RGI_PACKET];
} known;

/** Whether it is worth a try to take rays through together: not for a while after tries that were given up. */
typedef struct pace {
    uint32_t lost;     /* tries in a row that were given up */
    uint32_t left_out; /* those still to be left out because of it */
} pace;

/** What the groups of a range have in common. */
typedef struct course {
    const rgi_call *call;
    const rgi_lattice *lattice; /* which holds all objects of the scene; or NULL */
    rgi_middle middle;          /* of it */
    bool apart;                 /* each ray is to go alone */
    pace wide, narrow;          /* of several groups together, of the rays of one */
} course;

/** Rays that are worked on at a time. */
typedef struct group {
    const rgi_call *call;
    const rgi_lattice *lattice; /* see course */
    uint64_t first;             /* number of the first ray */
    uint32_t count;
    uint32_t made; /* bits of the queries that have their ray: in a packet only those that ask */
    bool waits;    /* its rays are in `packet`, and have not gone through yet */
    bool together; /* they went the same way, as `packet` */
    rgi_packet packet;
    rgi_bundle bundle;
    known known;
    rgi_query queries[RGI_PACKET];
} group;

/* ----------------------------------------------------------------------------------- each ray with its query */

/* What a kernel asks. */
static bool ask(rgi_beam *beam, uint32_t slot) {
    rgi_query *q = beam->query;
    q->done = rgi_query_visit(q, slot);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, q->walk.t_max);
    return q->done;
}

/* Whether not every hit counts: then nothing is certain before it was asked. */
static bool asks_all(const rgi_call *c) {
    return c->config.filter || c->config.cull != RG_CULL_NONE || c->scene->masked;
}

static void visit_unbounded(rgi_query *q, const rgi_lattice *lattice) {
    for (uint32_t i = 0; i < lattice->unbounded_count && !q->done; i++)
        q->done = rgi_query_visit(q, lattice->unbounded[i]);
}

static rgi_entered enter(rgi_beam *beam, uint32_t slot) {
    rgi_query *q = beam->query;
    const rg_shape *shape = rgi_scene_object(q->call->scene, slot)->shape;
    if (shape->kind != RG_SHAPE_MESH || shape->of.mesh->levels > RGI_MESH_LEVELS) return RGI_NO_MESH_THERE;
    beam->lanes->beams[beam->lanes->count] = beam;
    return rgi_query_enter(q, slot, beam->lanes) ? RGI_AT_DOOR : RGI_PASSED_BY;
}

static bool leave(rgi_beam *beam, uint32_t lane) {
    rgi_query *q = beam->query;
    q->done = rgi_query_leave(q, beam->lanes, lane);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, q->walk.t_max);
    return q->done;
}

/* Rays side by side, in meshes, too: those take much of the stack. */
static __attribute__((noinline)) void trace_some_into_meshes(const rgi_call *c, const rgi_lattice *lattice,
                                                             rgi_beam *beams, uint32_t count) {
    const rgi_query *first = beams[0].query;
    rgi_mesh_lanes lanes;
    lanes.count = 0;
    for (uint32_t r = 0; r < RGI_SIDE_BY_SIDE / RGI_PACKET; r++) {
        rgi_mesh_row *row = &lanes.rows[r];
        row->inside.rays.any = c->any;
        row->inside.changed = 0;
        row->inside.sides = first->local.sides;
        row->inside.accept = first->local.accept;
        /* All lanes of a row are computed, used or not. */
        memset(&row->rays, 0, sizeof row->rays);
        memset(&row->doors, 0, sizeof row->doors);
    }
    for (uint32_t i = 0; i < count; i++) {
        beams[i].lanes = &lanes;
        beams[i].enter = enter;
        beams[i].leave = leave;
    }
    c->scene->kernels->trace_some(lattice, beams, count);
}

static void trace_beams(const rgi_call *c, const rgi_lattice *lattice, rgi_beam *beams, uint32_t count) {
    if (count == 1)
        c->scene->kernels->trace_one(lattice, &beams[0]);
    else if (count && lattice->boxes)
        trace_some_into_meshes(c, lattice, beams, count);
    else if (count)
        c->scene->kernels->trace_some(lattice, beams, count);
    for (uint32_t i = 0; i < count; i++) {
        rgi_query *q = beams[i].query;
        q->walk.cells += beams[i].nodes;
        q->found |= beams[i].hit;
        q->done |= beams[i].hit;
    }
}

static void through_lattice(const rgi_call *c, rgi_query *queries, uint32_t count, const rgi_lattice *lattice) {
    rgi_beam beams[RGI_PACKET];
    const rgi_middle middle = rgi_lattice_middle(lattice);
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        rgi_query *q = &queries[i];
        rgi_beam *beam = &beams[used];
        if (!q->done) visit_unbounded(q, lattice);
        if (q->done || !lattice->root || !rgi_beam_init(beam, lattice, &middle, &q->ray, q->walk.t_max)) continue;
        beam->ask = ask;
        beam->query = q;
        beam->any = c->any && !asks_all(c) && q->ray.mask;
        used++;
    }
    trace_beams(c, lattice, beams, used);
}

static void through_cells(rgi_query *q, const rgi_grid *grid) {
    double t_max = q->walk.t_max;
    uint32_t cells = q->walk.cells;
    rgi_walk_init(&q->walk, q->ray.origin, q->ray.direction, q->ray.t_min, t_max);
    q->walk.visit = rgi_query_visit;
    q->walk.context = q;
    q->done = rgi_grid_walk(grid, &q->walk);
    q->walk.cells += cells;
}

static void each_through_grids(const rgi_call *c, rgi_query *queries, uint64_t first, uint32_t count) {
    const rg_scene *scene = c->scene;
    for (uint32_t i = 0; i < count; i++) rgi_query_begin(&queries[i], first + i);
    for (uint32_t n = 0; n < scene->grid_places; n++) {
        const rgi_any_grid *grid = scene->grids[n].grid;
        if (!grid || !grid->count) continue;
        if (rgi_any_grid_is_loose(grid)) {
            through_lattice(c, queries, count, &grid->lattice);
            continue;
        }
        for (uint32_t i = 0; i < count; i++) {
            if (!queries[i].done) through_cells(&queries[i], &grid->cells);
        }
    }
}

/* ------------------------------------------------------------------------------------------- rays as a bundle */

/* The lattice that holds all objects of the scene, if there is such a one. */
static const rgi_lattice *only_lattice(const rg_scene *scene) {
    const rgi_any_grid *only = NULL;
    for (uint32_t n = 0; n < scene->grid_places; n++) {
        const rgi_any_grid *grid = scene->grids[n].grid;
        if (!grid || !grid->count) continue;
        if (only || !rgi_any_grid_is_loose(grid) || !grid->lattice.root) return NULL;
        only = grid;
    }
    return only ? &only->lattice : NULL;
}

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
static bool load(group *g) {
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
static rgi_query *query_of(group *g, uint32_t i) {
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
static void note_found(rgi_packet *p, uint32_t ray, const rgi_query *q) {
    const rgi_beam_scale scale = {p->shift[ray], p->length[ray]};
    if (!q->found) return;
    p->found |= 1u << ray;
    p->t_hi[ray] = rgi_beam_above(&scale, p->pad[ray], q->walk.t_max);
    p->t_lo[ray] = rgi_beam_below(&scale, p->pad[ray], q->walk.t_max);
}

/* What a kernel asks for a ray of a packet. */
static bool ask_of_packet(rgi_packet *p, uint32_t ray, uint32_t slot) {
    rgi_query *q = query_of(p->context, ray);
    q->done = rgi_query_visit(q, slot);
    note_found(p, ray, q);
    return q->done;
}

/* The rays that see an object, of those named by bits, with the range of t in which they look for hits. */
static uint32_t join_mesh(const group *g, const rgi_object *object, uint32_t rays, rgi_mesh_packet *m) {
    const rgi_bundle *b = &g->bundle;
    for (uint32_t i = 0; i < RGI_PACKET; i++) {
        if (!(object->mask & b->mask[i])) rays &= ~(1u << i);
        m->t_max[i] = g->made >> i & 1         ? g->queries[i].walk.t_max
                      : g->known.rays >> i & 1 ? g->known.t[i]
                                               : b->t_max[i];
    }
    return rays;
}

/* Before another object is asked about, what was certain so far is. */
static void ask_certain(rgi_packet *p, uint32_t rays) {
    for (rays &= p->certain; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), best;
        memcpy(&best, &p->best[ray], sizeof best);
        p->certain &= ~(1u << ray);
        if (ask_of_packet(p, ray, best)) p->active &= ~(1u << ray);
    }
}

/* Keeps a hit for a ray without a query; one that has a query takes it. */
static void take_from_mesh(group *g, const rgi_mesh_packet *m, uint32_t ray, uint32_t slot) {
    known *k = &g->known;
    rgi_packet *p = &g->packet;
    if (g->made >> ray & 1) {
        rgi_query *q = &g->queries[ray];
        q->done = rgi_query_take(q, slot, m->t_max[ray], m->leaf[ray], m->triangle[ray]);
        note_found(p, ray, q);
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

/* What a kernel asks for several rays of a packet about a mesh: they go through it together, if they can, or side by
 * side. */
static bool ask_mesh(rgi_packet *p, uint32_t rays, uint32_t slot) {
    group *g = p->context;
    const rg_scene *scene = g->call->scene;
    const rgi_object *object = rgi_scene_object(scene, slot);
    if (object->shape->kind != RG_SHAPE_MESH || object->shape->of.mesh->levels > RGI_MESH_LEVELS) return false;
    if (g->call->config.filter) return false;
    rgi_mesh_lanes lanes;
    rgi_mesh_packet *m = &lanes.rows[0].inside;
    ask_certain(p, rays);
    rays &= scene->kernels->mesh_enter(&g->bundle, object, rgi_scene_linear(scene, object), m);
    m->rays.active = join_mesh(g, object, rays & p->active, m);
    m->rays.any = g->call->any;
    m->sides = rgi_query_sides(g->call);
    m->accept = NULL;
    if (!m->rays.active) return true;
    if (!scene->kernels->mesh_packet(m)) scene->kernels->mesh_apart(&lanes);
    if (g->call->any) {
        p->certain |= m->found;
        p->active &= ~m->found;
        return true;
    }
    for (uint32_t rest = m->found; rest; rest &= rest - 1) take_from_mesh(g, m, (uint32_t)__builtin_ctz(rest), slot);
    return true;
}

/* Objects without a cell are asked before the others, for each ray. */
static void ask_unbounded(group *g, rgi_packet *p) {
    for (uint32_t i = 0; i < g->count; i++) {
        rgi_query *q = query_of(g, i);
        visit_unbounded(q, g->lattice);
        note_found(p, i, q);
        if (q->done) p->active &= ~(1u << i);
    }
}

/* Whether of a hit no more is wanted than what rgi_meeting has. */
static bool wants_little(const rgi_call *c) {
    return !c->plain_hits && !(c->wanted & ~(unsigned)RGI_NORMAL) && !c->hits->u.data && !c->hits->v.data;
}

/* Where the rays meet the balls that are certain: for all at once. Returns the bits of those it is right for. */
static uint32_t meet_certain(const group *g, const rgi_packet *p, rgi_meeting *m, uint64_t ids[RGI_PACKET]) {
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
static uint32_t write_unasked(const group *g, const rgi_packet *p) {
    const rgi_call *c = g->call;
    const known *k = &g->known;
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

static uint32_t write_occluded(const group *g, const rgi_packet *p) {
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
static uint32_t finish_packet(group *g, rgi_packet *p) {
    if (g->call->any) return write_occluded(g, p);
    uint32_t written = wants_little(g->call) ? write_unasked(g, p) : 0;
    for (uint32_t rays = p->certain & ~written; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), slot;
        memcpy(&slot, &p->best[ray], sizeof slot);
        (void)ask_of_packet(p, ray, slot);
    }
    return written;
}

/* ------------------------------------------------------------------------------------------- ways through */

static bool is_due(pace *p) {
    if (!p->left_out) return true;
    p->left_out--;
    return false;
}

static void note_try(pace *p, bool lost) {
    p->lost = lost ? p->lost + (p->lost < MOST_LOST) : 0;
    p->left_out = (1u << p->lost) - 1;
}

/* Reads the rays of a group. Those that can't be in a packet are taken through at once. */
static void begin(group *g, const course *way) {
    rgi_packet *p = &g->packet;
    g->together = false;
    g->waits = g->lattice && load(g);
    if (!g->waits) {
        each_through_grids(g->call, g->queries, g->first, g->count);
        g->made = UINT32_MAX;
        return;
    }
    g->call->scene->kernels->to_frame(&g->bundle, g->lattice, &way->middle, p);
    p->found = 0;
    p->any = g->call->any;
    p->ask_all = asks_all(g->call);
    for (uint32_t i = 0; i < g->count; i++) p->ask_all |= g->bundle.mask[i] == 0;
    p->ask = ask_of_packet;
    p->ask_mesh = ask_mesh;
    p->context = g;
    p->bundle = &g->bundle;
    if (g->lattice->unbounded_count) ask_unbounded(g, p);
}

/* Beams for the rays of a group that are still on their way. Returns how many. */
static uint32_t set_apart(group *g, rgi_beam *beams) {
    const rgi_call *c = g->call;
    rgi_packet *p = &g->packet;
    uint32_t used = 0;
    /* What a packet that was given up has found is asked first. */
    for (uint32_t rays = c->any ? 0 : p->certain; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), slot;
        memcpy(&slot, &p->best[ray], sizeof slot);
        (void)ask_of_packet(p, ray, slot);
        p->certain &= ~(1u << ray);
    }
    for (uint32_t rays = p->active; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays);
        rgi_beam_of_packet(&beams[used], p, i, g->lattice);
        beams[used].ask = ask;
        beams[used].any = c->any && !asks_all(c) && g->bundle.mask[i];
        beams[used++].query = query_of(g, i);
    }
    g->waits = false;
    g->together = c->any; /* what is certain needs no query */
    return used;
}

/* Each ray of the groups that wait its own way: the beams are not to take stack of other ways. */
static __attribute__((noinline)) void go_apart(group *groups, uint32_t count) {
    rgi_beam beams[RGI_SIDE_BY_SIDE];
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) used += groups[i].waits ? set_apart(&groups[i], beams + used) : 0;
    if (used) trace_beams(groups[0].call, groups[0].lattice, beams, used);
}

/* Whether groups can go together, as a frustum. */
static bool unite(rgi_frustum *f, group *groups, uint32_t count, const course *way) {
    f->count = count;
    f->patience = PATIENCE;
    for (uint32_t i = 0; i < count; i++) {
        if (!groups[i].waits) return false;
        f->packets[i] = &groups[i].packet;
    }
    return way->call->scene->kernels->bound(f, way->lattice, &way->middle);
}

/* Whether a frustum has come to its end; else its rays still wait. */
static bool has_arrived(const rgi_frustum *f, group *groups) {
    if (f->visits > f->patience) return false;
    for (uint32_t i = 0; i < f->count; i++) {
        groups[i].waits = false;
        groups[i].together = true;
    }
    return true;
}

/* All groups together, if they go the same way. */
static void go_wide(group *groups, uint32_t count, course *way) {
    rgi_frustum f;
    bool united = unite(&f, groups, count, way);
    if (united) way->call->scene->kernels->trace_frustum(way->lattice, &f);
    note_try(&way->wide, !united || !has_arrived(&f, groups));
}

/* One group, or two in turn, the rays of each together if they go the same way, and else apart. */
static void go_narrow(group *groups, uint32_t count, course *way) {
    const rgi_kernels *kernels = way->call->scene->kernels;
    rgi_frustum frusta[2];
    bool united[2] = {false, false};
    for (uint32_t i = 0; i < count; i++)
        united[i] = groups[i].waits && !way->apart && is_due(&way->narrow) && unite(&frusta[i], &groups[i], 1, way);
    if (united[0] && united[1])
        kernels->trace_frusta(way->lattice, &frusta[0], &frusta[1]);
    else if (united[0] || united[1])
        kernels->trace_frustum(way->lattice, &frusta[united[1]]);
    for (uint32_t i = 0; i < count; i++) {
        if (united[i]) note_try(&way->narrow, !has_arrived(&frusta[i], &groups[i]));
    }
    go_apart(groups, count);
}

/* Writes what became of a ray. */
static void finish_query(const rgi_query *q, uint64_t *invalid, bool *failed) {
    *invalid += !q->valid;
    *failed |= q->failed;
    if (q->call->any)
        rgi_store_integer(&q->call->occluded, q->index, q->valid && q->found && !q->failed);
    else
        rgi_query_write(q);
}

static void finish(group *g, uint64_t *invalid, bool *failed) {
    uint32_t written = g->together ? finish_packet(g, &g->packet) : 0;
    for (uint32_t i = 0; i < g->count; i++) {
        if (!(written >> i & 1)) finish_query(query_of(g, i), invalid, failed);
    }
}

/* Groups for all rays of a range. */
static void init(course *way, group *groups, uint32_t room, const rgi_call *c, uint64_t rays) {
    memset(way, 0, sizeof *way);
    way->call = c;
    way->lattice = rays < MIN_PACKET ? NULL : only_lattice(c->scene);
    if (way->lattice) {
        way->middle = rgi_lattice_middle(way->lattice);
        way->middle.spacing = rgi_lattice_spacing(way->lattice);
    }
    way->apart = c->hits->cells.data || c->hits->tests.data || c->config.coherence == RG_COHERENCE_LOW;
    /* Then rays may spread as they like to count as going the same way. */
    if (c->config.coherence == RG_COHERENCE_HIGH) way->middle.spacing = INFINITY;
    for (uint32_t n = 0; n < room; n++) {
        groups[n].call = c;
        groups[n].lattice = way->lattice;
        for (uint32_t i = 0; i < RGI_PACKET && i < rays; i++) rgi_query_init(&groups[n].queries[i], c);
    }
}

static uint64_t next_rays(group *g, const course *way, uint64_t at, uint64_t last) {
    g->first = at;
    g->count = last - at < RGI_PACKET ? (uint32_t)(last - at) : RGI_PACKET;
    begin(g, way);
    return at + g->count;
}

static __attribute__((noinline)) void through_alone(rgi_call *c, uint64_t index, uint64_t *invalid, bool *failed) {
    rgi_query q;
    rgi_query_init(&q, c);
    each_through_grids(c, &q, index, 1);
    finish_query(&q, invalid, failed);
}

/* A few rays, on a small stack. */
static __attribute__((noinline)) void through_one(rgi_call *c, uint64_t first, uint64_t last, uint64_t *invalid,
                                                  bool *failed) {
    course way;
    group g;
    init(&way, &g, 1, c, last - first);
    next_rays(&g, &way, first, last);
    go_narrow(&g, 1, &way);
    finish(&g, invalid, failed);
}

static uint64_t through_many(rgi_call *c, uint64_t first, uint64_t last, bool may_stop, uint64_t *invalid,
                             bool *failed) {
    course way;
    group groups[RGI_PACKETS];
    init(&way, groups, RGI_PACKETS, c, last - first);
    do {
        bool wide = way.lattice && !way.apart && is_due(&way.wide);
        uint32_t count = 0, most = wide ? RGI_PACKETS : 2;
        while (count < most && first < last) first = next_rays(&groups[count++], &way, first, last);
        if (wide) go_wide(groups, count, &way);
        for (uint32_t i = 0; i < count; i += 2) go_narrow(&groups[i], count - i < 2 ? 1 : 2, &way);
        for (uint32_t i = 0; i < count; i++) finish(&groups[i], invalid, failed);
    } while (first < last && !(may_stop && rgi_lock_is_wanted(&c->scene->lock)));
    return first;
}

uint64_t rgi_through(rgi_call *c, uint64_t first, uint64_t last, bool may_stop) {
    uint64_t invalid = 0;
    bool failed = false;
    if (last - first == 1) {
        through_alone(c, first++, &invalid, &failed);
    } else if (last - first <= RGI_PACKET) {
        through_one(c, first, last, &invalid, &failed);
        first = last;
    } else {
        first = through_many(c, first, last, may_stop, &invalid, &failed);
    }
    if (invalid) __atomic_fetch_add(&c->invalid, invalid, __ATOMIC_RELAXED);
    if (failed) __atomic_store_n(&c->failed, 1, __ATOMIC_RELAXED);
    return first;
}
