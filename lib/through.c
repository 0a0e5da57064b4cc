/* SPDX-License-Identifier: MIT */
#include "through.h"

#include "group.h"
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
    MOST_LOST = 4,
    /* Meshes that make up the scene, each to be gone through at once; more are found through the lattice. */
    FEW = 4
};

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
    uint32_t few, slots[FEW];   /* meshes that are all there is; else 0 */
    pace wide, narrow;          /* of several groups together, of the rays of one */
} course;

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

/* Whether there is a single object: the way to it is longer than the test that passes it by. Not those of the host,
 * whose hits may lie beside their bounds and count then if the bounds are met. */
static bool is_found_at_once(const rgi_call *c, const rgi_lattice *lattice, uint32_t *slot) {
    return lattice->count == 1 && !c->hits->cells.data && rgi_lattice_few(lattice, slot, 1) &&
           rgi_scene_object(c->scene, *slot)->shape->kind != RG_SHAPE_USER;
}

static void through_lattice(const rgi_call *c, rgi_query *queries, uint32_t count, const rgi_lattice *lattice) {
    rgi_beam beams[RGI_PACKET];
    uint32_t only;
    if (count == 1 && is_found_at_once(c, lattice, &only)) {
        visit_unbounded(queries, lattice);
        if (!queries->done) queries->done = rgi_query_visit(queries, only);
        return;
    }
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

/* Objects without a cell are asked before the others, for each ray. */
static void ask_unbounded(rgi_group *g, rgi_packet *p) {
    for (uint32_t i = 0; i < g->count; i++) {
        rgi_query *q = rgi_group_query(g, i);
        visit_unbounded(q, g->lattice);
        rgi_group_note_found(p, i, q);
        if (q->done) p->active &= ~(1u << i);
    }
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
static void begin(rgi_group *g, const course *way) {
    rgi_packet *p = &g->packet;
    g->together = false;
    g->waits = g->lattice && rgi_group_load(g);
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
    p->ask = rgi_group_ask;
    p->ask_mesh = rgi_group_ask_mesh;
    p->context = g;
    p->bundle = &g->bundle;
    if (g->lattice->unbounded_count) ask_unbounded(g, p);
}

/* Beams for the rays of a group that are still on their way. Returns how many. */
static uint32_t set_apart(rgi_group *g, rgi_beam *beams) {
    const rgi_call *c = g->call;
    rgi_packet *p = &g->packet;
    uint32_t used = 0;
    /* What a packet that was given up has found is asked first. */
    for (uint32_t rays = c->any ? 0 : p->certain; rays; rays &= rays - 1) {
        uint32_t ray = (uint32_t)__builtin_ctz(rays), slot;
        memcpy(&slot, &p->best[ray], sizeof slot);
        (void)rgi_group_ask(p, ray, slot);
        p->certain &= ~(1u << ray);
    }
    for (uint32_t rays = p->active; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays);
        rgi_beam_of_packet(&beams[used], p, i, g->lattice);
        beams[used].ask = ask;
        beams[used].any = c->any && !asks_all(c) && g->bundle.mask[i];
        beams[used++].query = rgi_group_query(g, i);
    }
    g->waits = false;
    g->together = c->any; /* what is certain needs no query */
    return used;
}

/* Each ray of the groups that wait its own way: the beams are not to take stack of other ways. */
static __attribute__((noinline)) void go_apart(rgi_group *groups, uint32_t count) {
    rgi_beam beams[RGI_SIDE_BY_SIDE];
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) used += groups[i].waits ? set_apart(&groups[i], beams + used) : 0;
    if (used) trace_beams(groups[0].call, groups[0].lattice, beams, used);
}

/* Whether groups can go together, as a frustum. */
static bool unite(rgi_frustum *f, rgi_group *groups, uint32_t count, const course *way) {
    f->count = count;
    f->patience = PATIENCE;
    for (uint32_t i = 0; i < count; i++) {
        if (!groups[i].waits) return false;
        f->packets[i] = &groups[i].packet;
    }
    return way->call->scene->kernels->bound(f, way->lattice, &way->middle);
}

/* Whether a frustum has come to its end; else its rays still wait. */
static bool has_arrived(const rgi_frustum *f, rgi_group *groups) {
    if (f->visits > f->patience) return false;
    for (uint32_t i = 0; i < f->count; i++) {
        groups[i].waits = false;
        groups[i].together = true;
    }
    return true;
}

/* All groups together, if they go the same way. */
static void go_wide(rgi_group *groups, uint32_t count, course *way) {
    rgi_frustum f;
    bool united = unite(&f, groups, count, way);
    if (united) way->call->scene->kernels->trace_frustum(way->lattice, &f);
    note_try(&way->wide, !united || !has_arrived(&f, groups));
}

/* One group, or two in turn, the rays of each together if they go the same way, and else apart. */
static void go_narrow(rgi_group *groups, uint32_t count, course *way) {
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

/* One group or two through the few meshes that there are. */
static void go_through_few(rgi_group *groups, uint32_t count, course *way) {
    uint32_t together = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (groups[i].waits && !way->apart && is_due(&way->narrow)) together |= 1u << i;
    }
    for (uint32_t s = 0; s < way->few; s++) {
        uint32_t went = rgi_group_through_mesh(groups, count, way->slots[s], together);
        for (uint32_t i = 0; i < count && s == 0; i++) {
            if (together >> i & 1) note_try(&way->narrow, !(went >> i & 1));
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        groups[i].together |= groups[i].waits;
        groups[i].waits = false;
    }
}

/* One group or two, by the way that pays. */
static void go_on(rgi_group *groups, uint32_t count, course *way) {
    if (way->few)
        go_through_few(groups, count, way);
    else
        go_narrow(groups, count, way);
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

static void finish(rgi_group *g, uint64_t *invalid, bool *failed) {
    uint32_t written = g->together ? rgi_group_write(g) : 0;
    for (uint32_t i = 0; i < g->count; i++) {
        if (!(written >> i & 1)) finish_query(rgi_group_query(g, i), invalid, failed);
    }
}

/* Whether all that there is are a few meshes. */
static void find_few(course *way) {
    const rgi_call *c = way->call;
    if (!way->lattice || c->hits->cells.data || c->hits->tests.data) return;
    way->few = rgi_lattice_few(way->lattice, way->slots, FEW);
    for (uint32_t s = 0; s < way->few; s++) {
        if (!rgi_group_takes_mesh(c, rgi_scene_object(c->scene, way->slots[s]))) way->few = 0;
    }
}

/* Groups for all rays of a range. */
static void init(course *way, rgi_group *groups, uint32_t room, const rgi_call *c, uint64_t rays) {
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
    find_few(way);
    for (uint32_t n = 0; n < room; n++) {
        groups[n].call = c;
        groups[n].lattice = way->lattice;
        for (uint32_t i = 0; i < RGI_PACKET && i < rays; i++) rgi_query_init(&groups[n].queries[i], c);
    }
}

static uint64_t next_rays(rgi_group *g, const course *way, uint64_t at, uint64_t last) {
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

/* A few rays, on a small stack: what is not inlined takes none of the others' room. */
static __attribute__((noinline)) void through_one(rgi_call *c, uint64_t first, uint64_t last, uint64_t *invalid,
                                                  bool *failed) {
    course way;
    rgi_group g;
    init(&way, &g, 1, c, last - first);
    next_rays(&g, &way, first, last);
    go_on(&g, 1, &way);
    finish(&g, invalid, failed);
}

static __attribute__((noinline)) uint64_t through_many(rgi_call *c, uint64_t first, uint64_t last, bool may_stop,
                                                       uint64_t *invalid, bool *failed) {
    course way;
    rgi_group groups[RGI_PACKETS];
    init(&way, groups, RGI_PACKETS, c, last - first);
    do {
        bool wide = way.lattice && !way.apart && is_due(&way.wide);
        uint32_t count = 0, most = wide ? RGI_PACKETS : 2;
        while (count < most && first < last) first = next_rays(&groups[count++], &way, first, last);
        if (wide) go_wide(groups, count, &way);
        for (uint32_t i = 0; i < count; i += 2) go_on(&groups[i], count - i < 2 ? 1 : 2, &way);
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
