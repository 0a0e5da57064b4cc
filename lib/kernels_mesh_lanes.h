/* SPDX-License-Identifier: MIT */
/*
 * The part of the kernels for rays side by side in meshes, each on its own way; included by kernels.h alone.
 *
 * All take a step in turn, so that waits for memory overlap. Whether a ray comes to a node or to a leaf, and whether
 * it may meet a triangle there, can't be foreseen: so rays are sorted into those at nodes and those at leaves, by
 * adding comparisons to counts, and each sort is gone through without such branches.
 */

/* Rays, by their lanes. One more is written behind the last than counts. */
typedef struct lane_list {
    uint32_t count;
    uint8_t lanes[RGI_SIDE_BY_SIDE + 1];
} lane_list;

RGI_INLINE void list_lane(lane_list *list, uint32_t lane, bool counts) {
    list->lanes[list->count] = (uint8_t)lane;
    list->count += counts;
}

/* Puts the active rays of a row at the roots of their meshes, and lists them. */
static void begin_side_by_side(rgi_mesh_lanes *l, uint32_t r, lane_list *list) {
    rgi_mesh_row *row = &l->rows[r];
    rgi_mesh_packet *m = &row->inside;
    const rgi_packet *p = &m->rays;
    m->changed = 0;
    bound_above(m);
    memset(row->negative, 0, sizeof row->negative);
    for (uint32_t a = 0; a < 3; a++) {
        LANES(i) {
            uint32_t down = p->inverse[a][i] < 0;
            row->negative[i] |= down << a;
            row->towards[a][i] = RGI_CHILDREN * (a + 3 * down);
        }
    }
    for (uint32_t rest = p->active; rest; rest &= rest - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rest), lane = r * RGI_PACKET + i;
        l->depth[lane] = 1;
        l->refs[lane][0] = m->mesh[i]->root;
        l->ts[lane][0] = p->t_first[i];
        list_lane(list, lane, true);
    }
}

RGI_INLINE void fetch_next(const rgi_mesh_lanes *l, uint32_t lane, const rgi_mesh *mesh) {
    uint32_t depth = l->depth[lane];
    const char *next = rgi_mesh_at(mesh, l->refs[lane][depth - (depth > 0)]);
    for (int k = 0; k < 5; k++) __builtin_prefetch(next + RGI_MESH_LINE * k);
}

RGI_INLINE void visit_node_of(rgi_mesh_lanes *l, uint32_t lane, rgi_mesh_ref ref) {
    const uint32_t i = lane % RGI_PACKET;
    const rgi_mesh_row *row = &l->rows[lane / RGI_PACKET];
    const rgi_packet *p = &row->inside.rays;
    const rgi_mesh_node *n = rgi_mesh_at(row->inside.mesh[i], ref);
    const float *planes = n->lo[0];
    uint32_t depth = l->depth[lane];
    f8 first = f8_set(p->t_first[i]), last = f8_set(p->t_hi[i]);
    for (uint32_t a = 0; a < 3; a++) {
        const uint32_t towards = row->towards[a][i], away = RGI_CHILDREN * (2 * a + 3) - towards;
        f8 inverse = f8_set(p->inverse[a][i]);
        first = f8_max(f8_fma(f8_load(planes + towards), inverse, f8_set(p->near[a][i])), first);
        last = f8_min(f8_fma(f8_load(planes + away), inverse, f8_set(p->far[a][i])), last);
    }
    l->depth[lane] += f8_keep(f8_le(first, last), orders[row->negative[i]], first, n->child, l->ts[lane] + depth,
                              l->refs[lane] + depth);
    fetch_next(l, lane, row->inside.mesh[i]);
}

/* What a ray has still to look into, without what lies beyond its nearest hit. */
static void cut_way(rgi_mesh_lanes *l, uint32_t lane) {
    static const uint32_t order[8] __attribute__((aligned(32))) = {0, 1, 2, 3, 4, 5, 6, 7};
    const rgi_packet *p = &l->rows[lane / RGI_PACKET].inside.rays;
    const uint32_t i = lane % RGI_PACKET, depth = p->active >> i & 1 ? l->depth[lane] : 0;
    uint32_t kept = 0;
    f8 most = f8_set(p->t_hi[i]);
    for (uint32_t at = 0; at < depth; at += 8) {
        uint32_t used = depth - at < 8 ? (1u << (depth - at)) - 1 : 0xFF;
        f8 t = f8_load(l->ts[lane] + at);
        kept +=
            f8_keep(f8_le(t, most) & used, order, t, l->refs[lane] + at, l->ts[lane] + kept, l->refs[lane] + kept);
    }
    l->depth[lane] = kept;
}

/* Rays at leaves with the triangles that each may meet: those that have a nearer hit then end there. */
static void settle_side_by_side(rgi_mesh_lanes *l, const lane_list *meeting, const void *const *leaves,
                                const uint32_t *met) {
    for (uint32_t k = 0; k < meeting->count; k++) {
        uint32_t lane = meeting->lanes[k];
        test_triangles(&l->rows[lane / RGI_PACKET].inside, lane % RGI_PACKET, leaves[k], met[k]);
    }
    for (uint32_t r = 0; r < RGI_SIDE_BY_SIDE / RGI_PACKET; r++) {
        rgi_mesh_packet *m = &l->rows[r].inside;
        if (!m->changed) continue;
        bound_above(m);
        for (uint32_t rest = m->changed; rest; rest &= rest - 1)
            cut_way(l, r * RGI_PACKET + (uint32_t)__builtin_ctz(rest));
        m->changed = 0;
    }
}

/* One step of all listed; lists those that go on. */
static void step_side_by_side(rgi_mesh_lanes *l, lane_list *list) {
    rgi_mesh_ref at[RGI_SIDE_BY_SIDE];
    const void *met_leaves[RGI_SIDE_BY_SIDE + 1];
    uint32_t met[RGI_SIDE_BY_SIDE + 1];
    lane_list nodes, leaves, meeting;
    nodes.count = leaves.count = meeting.count = 0;
    for (uint32_t k = 0; k < list->count; k++) {
        uint32_t lane = list->lanes[k];
        at[lane] = l->refs[lane][--l->depth[lane]];
        list_lane(&nodes, lane, !(at[lane] & RGI_MESH_LEAF));
        list_lane(&leaves, lane, (at[lane] & RGI_MESH_LEAF) != 0);
    }
    list->count = 0;
    for (uint32_t k = 0; k < nodes.count; k++) {
        visit_node_of(l, nodes.lanes[k], at[nodes.lanes[k]]);
        list_lane(list, nodes.lanes[k], l->depth[nodes.lanes[k]] > 0);
    }
    for (uint32_t k = 0; k < leaves.count; k++) {
        const uint32_t lane = leaves.lanes[k], i = lane % RGI_PACKET, m = meeting.count;
        const rgi_mesh_packet *inside = &l->rows[lane / RGI_PACKET].inside;
        met_leaves[m] = rgi_mesh_at(inside->mesh[i], at[lane]);
        met[m] = meet_leaf(inside->mesh[i], met_leaves[m], &inside->filters[i]);
        fetch_next(l, lane, inside->mesh[i]);
        list_lane(&meeting, lane, met[m] != 0);
    }
    if (meeting.count) settle_side_by_side(l, &meeting, met_leaves, met);
    for (uint32_t k = 0; k < leaves.count; k++) list_lane(list, leaves.lanes[k], l->depth[leaves.lanes[k]] > 0);
}

/* Takes the rays through the meshes at whose doors they are. */
static void mesh_side_by_side(rgi_mesh_lanes *l) {
    lane_list list;
    list.count = 0;
    for (uint32_t first = 0; first < l->count; first += RGI_PACKET) {
        rgi_mesh_row *row = &l->rows[first / RGI_PACKET];
        uint32_t rest = l->count - first, used = rest < RGI_PACKET ? (1u << rest) - 1 : 0xFFFF;
        row->inside.rays.active = used & go_in(&row->rays, &row->doors, 1, &row->inside);
        memcpy(row->inside.t_max, row->rays.t_max, sizeof row->inside.t_max);
        begin_side_by_side(l, first / RGI_PACKET, &list);
    }
    while (list.count) step_side_by_side(l, &list);
}

static void mesh_apart(rgi_mesh_lanes *l) {
    lane_list list;
    list.count = 0;
    begin_side_by_side(l, 0, &list);
    while (list.count) step_side_by_side(l, &list);
}
