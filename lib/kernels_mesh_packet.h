/* SPDX-License-Identifier: MIT */
/* The part of the kernels for rays that go through a mesh together; included by kernels.h alone. */

/* rgi_object_local for all lanes, but for the test whether a ray passes by. */
static void to_local(const rgi_bundle *b, const rgi_object *object, const rgi_linear *linear, rgi_mesh_packet *m) {
    double in[3][RGI_PACKET], far[RGI_PACKET];
    int any_far = 0;
    LANES(i) {
        double oo = 0, od = 0;
        for (int a = 0; a < 3; a++) {
            in[a][i] = b->origin[a][i] - object->position[a];
            oo = a ? oo + in[a][i] * in[a][i] : in[a][i] * in[a][i];
            od = a ? od + in[a][i] * b->direction[a][i] : in[a][i] * b->direction[a][i];
        }
        far[i] = oo > (double)(RGI_NEAR * RGI_NEAR) * object->reach * object->reach;
        m->shift[i] = far[i] != 0 ? -(od / b->dd[i]) : 0;
        any_far |= far[i] != 0;
    }
    for (int a = 0; a < 3 && any_far; a++) {
        LANES(i) {
            double moved = rgi_rebase(b->origin[a][i], object->position[a], m->shift[i], b->direction[a][i]);
            in[a][i] = far[i] != 0 ? moved : in[a][i];
        }
    }
    if (!linear) {
        memcpy(m->origin, in, sizeof in);
        memcpy(m->direction, b->direction, sizeof m->direction);
        return;
    }
    for (int a = 0; a < 3; a++) {
        const double x = linear->inverse[3 * a], y = linear->inverse[3 * a + 1], z = linear->inverse[3 * a + 2];
        LANES(i) m->origin[a][i] = x * in[0][i] + y * in[1][i] + z * in[2][i];
        LANES(i) m->direction[a][i] = x * b->direction[0][i] + y * b->direction[1][i] + z * b->direction[2][i];
    }
}

/* rgi_beam_into_mesh for all lanes. Rays that come from far away are brought near even where that shows that they
 * pass by. */
static void to_mesh(const rgi_mesh *mesh, rgi_mesh_packet *m) {
    rgi_packet *p = &m->rays;
    const double radius = mesh->middle.radius, scale = mesh->scale;
    double origin[3][RGI_PACKET], direction[3][RGI_PACKET], unit[RGI_PACKET], shift[RGI_PACKET], longest[RGI_PACKET];
    double pads[RGI_PACKET];
    int any_far = 0;
    LANES(i) {
        double x = fabs(m->direction[0][i]), y = fabs(m->direction[1][i]), z = fabs(m->direction[2][i]), square = 0;
        unit[i] = from_bits((0x7FDull - (to_bits(rgi_max(rgi_max(x, y), z)) >> 52)) << 52);
        for (int a = 0; a < 3; a++) {
            origin[a][i] = m->origin[a][i] - mesh->origin[a];
            direction[a][i] = m->direction[a][i] * unit[i];
            double from = origin[a][i] - mesh->middle.centre[a];
            square += from * from;
        }
        shift[i] = 0;
        any_far |= square > RGI_FAR * RGI_FAR * radius * radius;
    }
    if (any_far) {
        LANES(i) {
            double square = 0, along = 0, dd = 0;
            for (int a = 0; a < 3; a++) {
                double from = origin[a][i] - mesh->middle.centre[a];
                square += from * from;
                along += from * direction[a][i];
                dd += direction[a][i] * direction[a][i];
            }
            shift[i] = square > RGI_FAR * RGI_FAR * radius * radius ? -along / dd - RGI_BEFORE * radius : 0;
        }
        for (int a = 0; a < 3; a++) {
            LANES(i) {
                double moved = rgi_rebase(m->origin[a][i], mesh->origin[a], shift[i], direction[a][i]);
                origin[a][i] = shift[i] != 0 ? moved : origin[a][i];
            }
        }
    }
    LANES(i) {
        p->shift[i] = m->shift[i] + shift[i] * unit[i];
        p->length[i] = scale / unit[i];
        pads[i] = 0;
        for (int a = 0; a < 3; a++) origin[a][i] *= scale;
        longest[i] = 2 * (mesh->middle.extent + fabs(origin[0][i]) + fabs(origin[1][i]) + fabs(origin[2][i]));
    }
    for (int a = 0; a < 3; a++) {
        LANES(i) {
            double o = origin[a][i], d = direction[a][i];
            double pad = 0x1p-20 * fabs(o) + 0x1p-90 * fabs(p->shift[i]) * p->length[i];
            float inverse = (d < 0 ? -1.0f : 1.0f) / (float)rgi_max(fabs(d), RGI_FLAT);
            double middle = -o * (double)inverse;
            double widening = pad * fabs((double)inverse) + (fabs(d) < RGI_FLAT ? longest[i] : 0);
            p->origin[a][i] = (float)o;
            p->direction[a][i] = (float)d;
            p->inverse[a][i] = inverse;
            p->near[a][i] = (float)(middle - widening);
            p->far[a][i] = (float)(middle + widening);
            pads[i] += 2 * pad;
        }
    }
    LANES(i) p->pad[i] = (float)pads[i];
}

/* rgi_triangle_ray_init and the filters for all lanes. */
static void make_ready(const rgi_mesh *mesh, rgi_mesh_packet *m) {
    const rgi_packet *p = &m->rays;
    memset(m->along, 0, sizeof m->along);
    LANES(i) {
        rgi_triangle_ray t;
        const double d[3] = {m->direction[0][i], m->direction[1][i], m->direction[2][i]};
        const float o[3] = {p->origin[0][i], p->origin[1][i], p->origin[2][i]};
        const float df[3] = {p->direction[0][i], p->direction[1][i], p->direction[2][i]};
        rgi_triangle_axes(&t, d);
        m->along[t.z] |= 1u << i;
        m->shear[0][i] = t.shear[0];
        m->shear[1][i] = t.shear[1];
        rgi_triangle_filter_init(&m->filters[i], &t, o, df, p->inverse[t.z][i], rgi_place_error(mesh, o));
    }
}

/* rgi_beam_above for all lanes. */
static void bound_above(rgi_mesh_packet *m) {
    rgi_packet *p = &m->rays;
    LANES(i) {
        double at = (m->t_max[i] - p->shift[i]) * p->length[i];
        at = rgi_min(rgi_max(at, -RGI_T_MOST), RGI_T_MOST);
        double lost = 0x1p-50 * fabs(p->shift[i]) * p->length[i];
        p->t_hi[i] = (float)(at + 0x1p-19 * fabs(at) + lost) + 4 * p->pad[i];
    }
}

static void bound_below(rgi_mesh_packet *m) {
    rgi_packet *p = &m->rays;
    LANES(i) {
        double at = (m->t_min[i] - p->shift[i]) * p->length[i];
        at = rgi_min(rgi_max(at, -RGI_T_MOST), RGI_T_MOST);
        double lost = 0x1p-50 * fabs(p->shift[i]) * p->length[i];
        p->t_first[i] = (float)(at - 0x1p-19 * fabs(at) - lost) - 4 * p->pad[i];
    }
}

static void mesh_enter(const rgi_bundle *b, const rgi_object *object, const rgi_linear *linear, rgi_mesh_packet *m) {
    m->mesh = object->shape->of.mesh;
    to_local(b, object, linear, m);
    to_mesh(m->mesh, m);
    make_ready(m->mesh, m);
    memcpy(m->t_min, b->t_min, sizeof m->t_min);
    bound_below(m);
    m->found = 0;
}

/* ----------------------------------------------------------------------------------------------- the walk */

typedef struct mesh_stack {
    uint32_t depth;
    float most;
    float ts[FRUSTUM_STACK];
    uint32_t octants[FRUSTUM_STACK];
    rgi_mesh_ref parents[FRUSTUM_STACK];
} mesh_stack;

/* So few pairs are tested one by one. */
enum { FEW = 6 };

/* Pairs of a ray and a triangle that it may meet, of one leaf, in which all rays have the same axes. */
typedef struct pairs {
    uint8_t ray[RGI_PACKET], triangle[RGI_PACKET];
} pairs;

/* The triangle test of triangle.c for 16 pairs, the same operations in the same order. Returns the bits of those that
 * are met, with the roots; *odd: of those that run along the plane, for which the roots are not right. */
static uint32_t meet_pairs(const rgi_mesh_packet *m, const void *leaf, const pairs *q, double t[RGI_PACKET],
                           uint32_t *odd) {
    const rgi_triangle_filter *f = &m->filters[q->ray[0]];
    double v[3][3][RGI_PACKET], r[3][3][RGI_PACKET], d[3][RGI_PACKET], e[3][RGI_PACKET], px[3][RGI_PACKET];
    double py[3][RGI_PACKET], shear[2][RGI_PACKET], along[RGI_PACKET], shift[RGI_PACKET];
    int hit[RGI_PACKET], graze[RGI_PACKET];
    LANES(k) {
        double corners[3][3];
        uint32_t i = q->ray[k];
        rgi_triangle_corners(m->mesh, leaf, q->triangle[k], corners);
        for (int a = 0; a < 3; a++) {
            for (int c = 0; c < 3; c++) {
                v[c][a][k] = corners[c][a];
                r[c][a][k] = m->origin[a][i];
            }
            d[a][k] = m->direction[a][i];
        }
        shear[0][k] = m->shear[0][i];
        shear[1][k] = m->shear[1][i];
        shift[k] = m->shift[i];
    }
    for (int c = 0; c < 3; c++) {
        for (int a = 0; a < 3; a++) LANES(k) r[c][a][k] = v[c][a][k] - r[c][a][k];
        LANES(k) px[c][k] = r[c][f->x][k] - shear[0][k] * r[c][f->z][k];
        LANES(k) py[c][k] = r[c][f->y][k] - shear[1][k] * r[c][f->z][k];
    }
    for (int c = 0; c < 3; c++) {
        const int b = (c + 1) % 3, o = (c + 2) % 3;
        LANES(k) e[c][k] = px[b][k] * py[o][k] - py[b][k] * px[o][k];
    }
    LANES(k) {
        int some_less = (e[0][k] < 0) | (e[1][k] < 0) | (e[2][k] < 0);
        int some_more = (e[0][k] > 0) | (e[1][k] > 0) | (e[2][k] > 0);
        double sum = e[0][k] + e[1][k] + e[2][k];
        hit[k] = !(some_less & some_more) & (sum != 0);
    }
    LANES(k) {
        double ab[3], ac[3], n[3], dz = d[f->z][k];
        for (int a = 0; a < 3; a++) {
            ab[a] = v[1][a][k] - v[0][a][k];
            ac[a] = v[2][a][k] - v[0][a][k];
        }
        rgi_cross(ab, ac, n);
        double over = n[0] * d[0][k] + n[1] * d[1][k] + n[2] * d[2][k];
        double z0 = r[0][f->z][k] / dz, z1 = r[1][f->z][k] / dz, z2 = r[2][f->z][k] / dz;
        double low = rgi_min(rgi_min(z0, z1), z2), high = rgi_max(rgi_max(z0, z1), z2);
        double plane = (n[0] * r[0][0][k] + n[1] * r[0][1][k] + n[2] * r[0][2][k]) / (over != 0 ? over : 1);
        double root = rgi_min(rgi_max(plane, low), high);
        graze[k] = fabs(over) < RGI_GRAZING * ((fabs(n[0]) + fabs(n[1]) + fabs(n[2])) * fabs(dz));
        along[k] = over;
        t[k] = shift[k] + root;
    }
    uint32_t met = 0, fronts = 0;
    *odd = 0;
    LANES(k) met |= (uint32_t)hit[k] << k;
    LANES(k) fronts |= (uint32_t)(along[k] < 0) << k;
    LANES(k) *odd |= (uint32_t)(graze[k] | (along[k] == 0)) << k;
    *odd &= met;
    return met & ((m->sides & RGI_FRONT ? fronts : 0) | (m->sides & RGI_BACK ? ~fronts : 0));
}

/* A hit of a ray, if it is in range and before the last. */
RGI_INLINE bool take_hit(rgi_mesh_packet *m, const void *leaf, uint32_t ray, uint32_t triangle, double t) {
    uint32_t bit = 1u << ray;
    if (!(t >= m->t_min[ray] && t <= m->t_max[ray])) return false;
    if (m->found & bit && t == m->t_max[ray] &&
        rgi_mesh_primitive(m->mesh, leaf, triangle) > rgi_mesh_primitive(m->mesh, m->leaf[ray], m->triangle[ray]))
        return false;
    m->t_max[ray] = t;
    m->leaf[ray] = leaf;
    m->triangle[ray] = triangle;
    m->found |= bit;
    if (m->rays.any) m->rays.active &= ~bit;
    return true;
}

/* Up to 16 pairs. Returns whether some ray has a nearer hit now. */
static bool settle_pairs(rgi_mesh_packet *m, const void *leaf, const pairs *q, uint32_t count) {
    double t[RGI_PACKET];
    uint32_t odd, used = (1u << count) - 1;
    bool changed = false;
    if (count < FEW) {
        for (uint32_t k = 0; k < count; k++) {
            if (rgi_mesh_packet_test(m, q->ray[k], leaf, q->triangle[k], &t[0]))
                changed |= take_hit(m, leaf, q->ray[k], q->triangle[k], t[0]);
        }
        return changed;
    }
    uint32_t met = meet_pairs(m, leaf, q, t, &odd) & used;
    for (uint32_t rest = met; rest; rest &= rest - 1) {
        uint32_t k = (uint32_t)__builtin_ctz(rest);
        if (odd >> k & 1 && !rgi_mesh_packet_test(m, q->ray[k], leaf, q->triangle[k], &t[k])) continue;
        changed |= take_hit(m, leaf, q->ray[k], q->triangle[k], t[k]);
    }
    return changed;
}

/* The same for rays of one axis, any number of pairs: it is better not to be foreseen how many a ray adds. */
RGI_INLINE bool visit_leaf_along(rgi_mesh_packet *m, const void *leaf, uint32_t rays) {
    bool changed = false;
    pairs q;
    uint32_t count = 0;
    for (; rays; rays &= rays - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(rays), met = meet_leaf(m->mesh, leaf, &m->filters[i]);
        q.ray[count] = (uint8_t)i;
        q.triangle[count] = (uint8_t)__builtin_ctz(met | 1u << RGI_LEAF);
        count += met != 0;
        for (met &= met - 1; met & 0xFFFF; met &= met - 1) {
            if (count >= RGI_PACKET) {
                changed |= settle_pairs(m, leaf, &q, RGI_PACKET);
                count = 0;
            }
            q.ray[count] = (uint8_t)i;
            q.triangle[count++] = (uint8_t)__builtin_ctz(met);
        }
        if (count >= RGI_PACKET) {
            changed |= settle_pairs(m, leaf, &q, RGI_PACKET);
            count = 0;
        }
    }
    for (uint32_t k = count; k < RGI_PACKET && count >= FEW; k++) {
        q.ray[k] = q.ray[0];
        q.triangle[k] = q.triangle[0];
    }
    return settle_pairs(m, leaf, &q, count) || changed;
}

/* A leaf for each ray on its own. */
RGI_INLINE bool visit_leaf_with(rgi_mesh_packet *m, const void *leaf, uint32_t rays) {
    bool changed = false;
    for (int z = 0; z < 3; z++) {
        if (rays & m->along[z]) changed |= visit_leaf_along(m, leaf, rays & m->along[z]);
    }
    if (changed) bound_above(m);
    return changed;
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
    rgi_packet *p = &m->rays;
    mesh_stack s;
    bound_above(m);
    if (m->mesh->root & RGI_MESH_LEAF) {
        visit_leaf_with(m, rgi_mesh_at(m->mesh, m->mesh->root), p->active);
        return true;
    }
    rgi_frustum f;
    f.packets[0] = p;
    f.count = 1;
    if (!bound_in(&f, m->mesh->scale, &m->mesh->middle)) return false;
    s.depth = 0;
    s.most = f16_most(reaches(p));
    visit_node_with(m->mesh, &f, &s, m->mesh->root);
    while (s.depth && p->active) {
        s.depth--;
        if (s.ts[s.depth] > s.most) continue;
        const rgi_mesh_node *parent = rgi_mesh_at(m->mesh, s.parents[s.depth]);
        uint32_t octant = s.octants[s.depth], rays = meet_planes(p, parent->lo[0] + octant);
        if (!rays) continue;
        rgi_mesh_ref ref = parent->child[octant];
        if (!(ref & RGI_MESH_LEAF))
            visit_node_with(m->mesh, &f, &s, ref);
        else if (visit_leaf_with(m, rgi_mesh_at(m->mesh, ref), rays))
            s.most = f16_most(reaches(p));
    }
    return true;
}
