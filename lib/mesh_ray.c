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
    const rgi_triangle_ray *t = &m->triangles;
    const float *o = m->beam.origin, *d = m->beam.direction;
    rgi_triangle_filter *f = &m->filter;
    f->x = (uint32_t)t->x;
    f->y = (uint32_t)t->y;
    f->z = (uint32_t)t->z;
    f->origin_x = o[t->x];
    f->origin_y = o[t->y];
    f->origin_z = o[t->z];
    float inverse = m->beam.inverse[t->z];
    f->shear_x = d[t->x] * inverse;
    f->shear_y = d[t->y] * inverse;
    f->error =
        0x1p-20f * ((float)m->mesh->middle.extent + fabsf(o[0]) + fabsf(o[1]) + fabsf(o[2])) + m->mesh->rounding;
}

bool rgi_mesh_begin(rgi_mesh_ray *m, const rgi_mesh *mesh, const rgi_local_ray *ray) {
    rgi_triangle_ray_init(&m->triangles, ray);
    m->mesh = mesh;
    if (!rgi_beam_into_mesh(&m->beam, mesh, ray)) return false;
    make_filter(m);
    return true;
}

bool rgi_mesh_test(rgi_mesh_ray *m, const rgi_mesh_leaf *leaf, uint32_t triangles) {
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
