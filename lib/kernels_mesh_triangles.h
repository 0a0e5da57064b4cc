/* SPDX-License-Identifier: MIT */
/* The part of the kernels that tests triangles in double for a ray among others; included by kernels.h alone. */
#include "triangle.h"

/* A hit of a ray, if it is in range, before the last, and the filter lets it count. */
RGI_INLINE void take_hit(rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangle, double t) {
    uint32_t bit = 1u << ray;
    if (!(t >= m->t_min[ray] && t <= m->t_max[ray])) return;
    if (m->found & bit && t == m->t_max[ray] &&
        rgi_mesh_primitive(m->mesh[ray], leaf, triangle) >
            rgi_mesh_primitive(m->mesh[ray], m->leaf[ray], m->triangle[ray]))
        return;
    if (m->accept && !rgi_mesh_packet_accepts(m, ray, leaf, triangle)) return;
    m->t_max[ray] = t;
    m->leaf[ray] = leaf;
    m->triangle[ray] = triangle;
    m->found |= bit;
    m->changed |= bit;
    if (m->rays.any) m->rays.active &= ~bit;
}

/* Triangles of a leaf, named by bits. Notes in m->changed whether the ray has a nearer hit now. */
RGI_INLINE void test_triangles(rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangles) {
    rgi_triangle_line line;
    rgi_mesh_packet_line(m, ray, &line);
    for (; triangles; triangles &= triangles - 1) {
        uint32_t i = (uint32_t)__builtin_ctz(triangles);
        double v[3][3];
        rgi_triangle_meeting met;
        rgi_triangle_corners(m->mesh[ray], leaf, i, v);
        if (rgi_triangle_meet(&line, v, &met) && met.side & m->sides)
            take_hit(m, ray, leaf, i, m->shift[ray] + met.root);
    }
}
