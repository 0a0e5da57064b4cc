/* SPDX-License-Identifier: MIT */
/* The part of the kernels for the inside of meshes; included by kernels.h alone, after what it builds on. */
#include "mesh_ray.h"

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

RGI_INLINE bool visit_leaf(rgi_mesh_ray *m, rgi_mesh_ref ref) {
    const rgi_mesh_leaf *leaf = rgi_mesh_at(m->mesh, ref);
    uint32_t met = meet_triangles(leaf, &m->filter);
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

/* One step on the way of a ray among others. Returns false at the end. */
RGI_INLINE bool mesh_step(rgi_mesh_ray *m) {
    rgi_beam *b = &m->beam;
    f8 t;
    do {
        if (b->depth == 0) return false;
    } while (b->ts[--b->depth] > b->t_max);
    rgi_mesh_ref ref = b->refs[b->depth];
    if (ref & RGI_MESH_LEAF) {
        if (visit_leaf(m, ref)) return false;
    } else if (b->depth + RGI_CHILDREN > RGI_STACK) {
        if (mesh_below(m, ref)) return false;
    } else {
        const rgi_mesh_node *n = rgi_mesh_at(m->mesh, ref);
        uint32_t met = meet_octants(n->lo[0], b, &t);
        b->depth += f8_keep(met, orders[b->negative], t, n->child, b->ts + b->depth, b->refs + b->depth);
    }
    if (b->depth) {
        const char *next = rgi_mesh_at(m->mesh, b->refs[b->depth - 1]);
        for (int i = 0; i < 5; i++) __builtin_prefetch(next + RGI_MESH_LINE * i);
    }
    return true;
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
