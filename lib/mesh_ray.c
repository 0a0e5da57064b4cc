/* SPDX-License-Identifier: MIT */
#include "mesh_ray.h"

#include "vec.h"

/*
 * A corner's place across the ray, x - o_x - s_x (z - o_z), is wrong by less than 2^-21 M, M bounding corners and
 * origin: each of the two differences by 2^-24 for the rounding of each number in it and 2^-24 of itself, at most 2
 * M; the shear by 2^-23 of itself, at most 1, times 2 M; the result by 2^-24 of at most 4 M. Beside it, what the test
 * in double may be wrong by.
 */
static void make_filter(rgi_mesh_ray *m) {
    const rgi_beam *b = &m->beam;
    rgi_triangle_filter_init(&m->filter, &m->triangles.line, b->origin, b->direction, b->inverse[m->triangles.line.z],
                             rgi_place_error(m->mesh->middle.extent, (double)m->mesh->rounding, b->origin));
}

bool rgi_mesh_packet_accepts(const rgi_mesh_packet *m, uint32_t ray, const void *leaf, uint32_t triangle) {
    rgi_triangle_ray t;
    rgi_candidate c;
    const rgi_local_ray local = {.shift = m->shift[ray]};
    t.ray = &local;
    rgi_mesh_packet_line(m, ray, &t.line);
    (void)rgi_triangle_meets(&t, m->mesh[ray], leaf, triangle, &c);
    return m->accept(m->contexts[ray], &c);
}

bool rgi_mesh_begin(rgi_mesh_ray *m, const rgi_mesh *mesh, const rgi_local_ray *ray) {
    rgi_triangle_ray_init(&m->triangles, ray);
    m->mesh = mesh;
    if (!rgi_beam_into_mesh(&m->beam, mesh, ray)) return false;
    make_filter(m);
    return true;
}

bool rgi_mesh_test(rgi_mesh_ray *m, const void *leaf, uint32_t triangles) {
    if (rgi_triangles_test(&m->triangles, m->mesh, leaf, triangles)) return true;
    if (m->triangles.found) m->beam.t_max = rgi_beam_above(&m->beam.scale, m->beam.pad, m->triangles.best.t);
    return false;
}

bool rgi_mesh_intersect(const rgi_mesh *mesh, const rgi_local_ray *ray, rgi_candidate *candidate) {
    rgi_mesh_ray m;
    if (!rgi_mesh_begin(&m, mesh, ray)) return false;
    mesh->kernels->mesh_one(&m);
    *candidate = m.triangles.best;
    return m.triangles.found;
}
