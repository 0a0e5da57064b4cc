/* SPDX-License-Identifier: MIT */
/*
 * The part of the kernels for rays side by side in meshes, each on its own way; included by kernels.h alone. All take
 * a step in turn, so that waits for memory overlap.
 */

/* Rays that go on, by their lanes. One more is written behind the last than counts: it is not to be foreseen which.
 */
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

/* After a nearer hit the rest of the way is cut. */
RGI_INLINE void visit_leaf_of(rgi_mesh_lanes *l, uint32_t lane, rgi_mesh_ref ref) {
    const uint32_t i = lane % RGI_PACKET;
    rgi_mesh_packet *m = &l->rows[lane / RGI_PACKET].inside;
    const void *leaf = rgi_mesh_at(m->mesh[i], ref);
    uint32_t met = meet_leaf(m->mesh[i], leaf, &m->filters[i]);
    fetch_next(l, lane, m->mesh[i]);
    if (!met) return;
    test_triangles(m, i, leaf, met);
    if (!m->changed) return;
    const rgi_beam_scale scale = {m->rays.shift[i], m->rays.length[i]};
    m->changed = 0;
    m->rays.t_hi[i] = rgi_beam_above(&scale, m->rays.pad[i], m->t_max[i]);
    cut_way(l, lane);
}

/* Takes all listed to the ends of their ways. */
static void go_side_by_side(rgi_mesh_lanes *l, lane_list *list) {
    while (list->count) {
        uint32_t count = list->count;
        list->count = 0;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t lane = list->lanes[k];
            rgi_mesh_ref ref = l->refs[lane][--l->depth[lane]];
            if (ref & RGI_MESH_LEAF)
                visit_leaf_of(l, lane, ref);
            else
                visit_node_of(l, lane, ref);
            list_lane(list, lane, l->depth[lane] > 0);
        }
    }
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
    go_side_by_side(l, &list);
}

static void mesh_apart(rgi_mesh_lanes *l) {
    lane_list list;
    list.count = 0;
    for (uint32_t r = 0; r < RGI_SIDE_BY_SIDE / RGI_PACKET; r++) {
        if (l->rows[r].inside.rays.active) begin_side_by_side(l, r, &list);
    }
    go_side_by_side(l, &list);
}
