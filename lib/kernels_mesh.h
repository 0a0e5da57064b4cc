/* SPDX-License-Identifier: MIT */
/* The part of the kernels for the inside of meshes; included by kernels.h alone, after what it builds on. */

/*
 * Triangles of a leaf that the ray may meet, as bits. Signs of edge functions as in triangle.c, but in float and with
 * a margin. Of a triangle that is met, no corner is farther across the ray than its corners are from each other along
 * two axes, 2 L. With an error e of each place the products of an edge function are wrong by 8 L e + 2 e^2, and by
 * rounding by 2^-22 * 4 L^2.
 */
RGI_INLINE uint32_t meet_triangles(const rgi_mesh_leaf *leaf, const rgi_triangle_filter *r) {
    f16 z = f16_sub(f16_load(leaf->at[r->z]), f16_set(r->origin_z));
    f16 x = f16_fma(z, f16_set(-r->shear_x), f16_sub(f16_load(leaf->at[r->x]), f16_set(r->origin_x)));
    f16 y = f16_fma(z, f16_set(-r->shear_y), f16_sub(f16_load(leaf->at[r->y]), f16_set(r->origin_y)));
    f16 ax = f16_take(x, leaf->corner[0]), ay = f16_take(y, leaf->corner[0]);
    f16 bx = f16_take(x, leaf->corner[1]), by = f16_take(y, leaf->corner[1]);
    f16 cx = f16_take(x, leaf->corner[2]), cy = f16_take(y, leaf->corner[2]);
    f16 e0 = f16_sub(f16_mul(bx, cy), f16_mul(by, cx));
    f16 e1 = f16_sub(f16_mul(cx, ay), f16_mul(cy, ax));
    f16 e2 = f16_sub(f16_mul(ax, by), f16_mul(ay, bx));
    float e = r->error, margin = leaf->longest * (8 * e + 0x1p-19f * leaf->longest) + 4 * e * e;
    uint32_t in = f16_le(f16_set(-margin), f16_min(e0, f16_min(e1, e2)));
    in |= f16_le(f16_max(e0, f16_max(e1, e2)), f16_set(margin));
    return in & ((1u << leaf->triangles) - 1);
}

/* The same for the leaf of a soup. The margin is of each triangle's own places, S being the sum of their sizes: e S
 * of the errors, 2^-22 S^2 of the rounding. */
RGI_INLINE uint32_t meet_soup(const rgi_soup_leaf *leaf, const rgi_triangle_filter *r) {
    f8 x[3], y[3], size = f8_set(0), zero = f8_set(0);
    for (int c = 0; c < 3; c++) {
        f8 z = f8_sub(f8_load(leaf->at[c][r->z]), f8_set(r->origin_z));
        x[c] = f8_fma(z, f8_set(-r->shear_x), f8_sub(f8_load(leaf->at[c][r->x]), f8_set(r->origin_x)));
        y[c] = f8_fma(z, f8_set(-r->shear_y), f8_sub(f8_load(leaf->at[c][r->y]), f8_set(r->origin_y)));
        size = f8_add(size, f8_max(x[c], f8_sub(zero, x[c])));
        size = f8_add(size, f8_max(y[c], f8_sub(zero, y[c])));
    }
    f8 e0 = f8_sub(f8_mul(x[1], y[2]), f8_mul(y[1], x[2]));
    f8 e1 = f8_sub(f8_mul(x[2], y[0]), f8_mul(y[2], x[0]));
    f8 e2 = f8_sub(f8_mul(x[0], y[1]), f8_mul(y[0], x[1]));
    f8 margin = f8_fma(size, f8_set(0x1p-21f), f8_set(2 * r->error));
    margin = f8_fma(size, margin, f8_set(4 * r->error * r->error));
    return f8_le(f8_sub(zero, margin), f8_min(e0, f8_min(e1, e2))) | f8_le(f8_max(e0, f8_max(e1, e2)), margin);
}

RGI_INLINE uint32_t meet_leaf(const rgi_mesh *mesh, const void *leaf, const rgi_triangle_filter *r) {
    return mesh->soup ? meet_soup(leaf, r) : meet_triangles(leaf, r);
}

RGI_INLINE bool visit_leaf(rgi_mesh_ray *m, rgi_mesh_ref ref) {
    const void *leaf = rgi_mesh_at(m->mesh, ref);
    uint32_t met = meet_leaf(m->mesh, leaf, &m->filter);
    return met && rgi_mesh_test(m, leaf, met);
}

/* By recursion: where the stack is full. */
static bool mesh_below(rgi_mesh_ray *m, rgi_mesh_ref ref) {
    float t[RGI_CHILDREN];
    f8 first;
    rgi_beam *b = &m->beam;
    if (ref & RGI_MESH_LEAF) return visit_leaf(m, ref);
    const rgi_mesh_node *n = rgi_mesh_at(m->mesh, ref);
    uint32_t met = meet_octants(n->lo[0], b, &first);
    f8_store(t, first);
    for (uint32_t i = RGI_CHILDREN; i-- > 0;) {
        uint32_t octant = orders[b->negative][i];
        if (!(met >> octant & 1) || t[octant] > b->t_max) continue;
        if (mesh_below(m, n->child[octant])) return true;
    }
    return false;
}

/* As trace_one: the nearest child is gone into at once. */
static void mesh_one(rgi_mesh_ray *m) {
    rgi_beam *b = &m->beam;
    for (;;) {
        float t;
        do {
            if (b->depth == 0) return;
            t = b->ts[--b->depth];
        } while (t > b->t_max);
        rgi_mesh_ref ref = b->refs[b->depth];
        for (;;) {
            f8 ts;
            if (ref & RGI_MESH_LEAF) {
                if (visit_leaf(m, ref)) return;
                break;
            }
            if (b->depth + RGI_CHILDREN > RGI_STACK) {
                if (mesh_below(m, ref)) return;
                break;
            }
            const rgi_mesh_node *n = rgi_mesh_at(m->mesh, ref);
            uint32_t met = meet_octants(n->lo[0], b, &ts);
            if (!met) break;
            uint32_t nearest = (uint32_t)__builtin_ctz(flip_order(met, b->negative)) ^ b->negative;
            ref = n->child[nearest];
            met &= ~(1u << nearest);
            if (met)
                b->depth += f8_keep(met, orders[b->negative], ts, n->child, b->ts + b->depth, b->refs + b->depth);
        }
    }
}
