/* SPDX-License-Identifier: MIT */
/* The part of the kernels for rays that go through a mesh together; included by kernels.h alone. */

/* As long as that of a ray of a row: both are for meshes of at most RGI_MESH_LEVELS. */
typedef struct mesh_stack {
    uint32_t depth;
    float most;
    float ts[RGI_MESH_ROOM];
    uint32_t octants[RGI_MESH_ROOM];
    rgi_mesh_ref parents[RGI_MESH_ROOM];
} mesh_stack;

/* A leaf for each ray on its own. Returns whether one has a nearer hit now. It is better not to be foreseen whether a
 * ray may meet a triangle: so those that do are listed first. */
RGI_INLINE bool visit_leaf_with(rgi_mesh_packet *m, const void *leaf, uint32_t rays) {
    uint32_t met[RGI_PACKET + 1], count = 0;
    uint8_t listed[RGI_PACKET + 1];
    for (; rays; rays &= rays - 1) {
        listed[count] = (uint8_t)__builtin_ctz(rays);
        met[count] = meet_leaf(m->mesh[0], leaf, &m->filters[listed[count]]);
        count += met[count] != 0;
    }
    for (uint32_t k = 0; k < count; k++) test_triangles(m, listed[k], leaf, met[k]);
    if (!m->changed) return false;
    m->changed = 0;
    bound_above(m);
    return true;
}

/* Looks into a node for the rays together. */
RGI_INLINE void visit_node_with(const rgi_mesh *mesh, const rgi_frustum *f, mesh_stack *s, rgi_mesh_ref ref) {
    static const uint32_t numbers[RGI_CHILDREN] __attribute__((aligned(32))) = {0, 1, 2, 3, 4, 5, 6, 7};
    const rgi_mesh_node *n = rgi_mesh_at(mesh, ref);
    f8 t;
    uint32_t met = meet_together_f8(n->lo[0], RGI_CHILDREN, f, s->most, &t);
    uint32_t count = f8_keep(met, orders[f->negative], t, numbers, s->ts + s->depth, s->octants + s->depth);
    for (uint32_t i = 0; i < count; i++) {
        const char *child = rgi_mesh_at(mesh, n->child[s->octants[s->depth + i]]);
        s->parents[s->depth + i] = ref;
        for (int k = 0; k < 4; k++) __builtin_prefetch(child + RGI_MESH_LINE * k);
    }
    s->depth += count;
}

static bool mesh_packet(rgi_mesh_packet *m) {
    const rgi_mesh *mesh = m->mesh[0];
    rgi_packet *p = &m->rays;
    mesh_stack s;
    m->changed = 0;
    bound_above(m);
    if (mesh->root & RGI_MESH_LEAF) {
        visit_leaf_with(m, rgi_mesh_at(mesh, mesh->root), p->active);
        return true;
    }
    rgi_frustum f;
    f.packets[0] = p;
    f.count = 1;
    if (!bound_in(&f, mesh->scale, &mesh->middle)) return false;
    s.depth = 0;
    s.most = f16_most(reaches(p));
    visit_node_with(mesh, &f, &s, mesh->root);
    while (s.depth && p->active) {
        s.depth--;
        if (s.ts[s.depth] > s.most) continue;
        const rgi_mesh_node *parent = rgi_mesh_at(mesh, s.parents[s.depth]);
        uint32_t octant = s.octants[s.depth], rays = meet_planes(p, parent->lo[0] + octant);
        if (!rays) continue;
        rgi_mesh_ref ref = parent->child[octant];
        if (!(ref & RGI_MESH_LEAF))
            visit_node_with(mesh, &f, &s, ref);
        else if (visit_leaf_with(m, rgi_mesh_at(mesh, ref), rays))
            s.most = f16_most(reaches(p));
    }
    return true;
}
