/* SPDX-License-Identifier: MIT */
#include "beam.h"

#include "exact.h"
#include "vec.h"

#include <string.h>

float rgi_beam_above(const rgi_beam_scale *scale, float pad, double t) {
    double at = (t - scale->shift) * scale->length;
    at = rgi_min(rgi_max(at, -RGI_T_MOST), RGI_T_MOST);
    return (float)(at + 0x1p-19 * fabs(at) + 0x1p-50 * fabs(scale->shift) * scale->length) + 4 * pad;
}

float rgi_beam_below(const rgi_beam_scale *scale, float pad, double t) {
    double at = (t - scale->shift) * scale->length;
    at = rgi_min(rgi_max(at, -RGI_T_MOST), RGI_T_MOST);
    return (float)(at - 0x1p-19 * fabs(at) - 0x1p-50 * fabs(scale->shift) * scale->length) - 4 * pad;
}

/* The limits of t, and the first step of the walk. */
static void start(rgi_beam *beam, rgi_ref root, double t_min, double t_max) {
    beam->t_min = rgi_beam_below(&beam->scale, beam->pad, t_min);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, t_max);
    rgi_beam_start(beam, root);
}

void rgi_beam_start(rgi_beam *beam, rgi_ref root) {
    beam->t_after = beam->t_min + 0x1p-17f * fabsf(beam->t_min) + 8 * beam->pad;
    beam->t_before = beam->t_max - 0x1p-17f * fabsf(beam->t_max) - 8 * beam->pad;
    beam->hit = false;
    beam->nodes = 0;
    beam->waiting = 0;
    beam->lanes = NULL;
    beam->depth = 1;
    beam->refs[0] = root;
    beam->ts[0] = beam->t_min;
}

bool rgi_beam_init(rgi_beam *beam, const rgi_lattice *lattice, const rgi_middle *middle, const rgi_ray *ray,
                   double t_max) {
    double from[3], origin[3], radius = middle->radius, length = sqrt(ray->dd);
    rgi_sub(ray->origin, lattice->origin, origin);
    rgi_sub(origin, middle->centre, from);
    double distance2 = rgi_dot(from, from);
    beam->scale.shift = 0;
    beam->scale.length = length * lattice->scale;
    if (distance2 > RGI_FAR * RGI_FAR * radius * radius) {
        double b = rgi_dot(from, ray->direction) / ray->dd;
        if (distance2 - b * b * ray->dd > 2 * radius * radius + 0x1p-40 * distance2) return false;
        beam->scale.shift = -b - RGI_BEFORE * radius / length;
        rgi_rebase3(ray->origin, lattice->origin, beam->scale.shift, ray->direction, origin);
    }
    /* A bound of t within all that is stored. */
    double longest = 2 * (middle->extent + lattice->scale * (fabs(origin[0]) + fabs(origin[1]) + fabs(origin[2])));
    beam->negative = 0;
    beam->pad = 0;
    double per_length = 1 / length;
    for (int a = 0; a < 3; a++) {
        double o = origin[a] * lattice->scale, d = ray->direction[a] * per_length;
        double pad = 0x1p-20 * fabs(o) + 0x1p-90 * fabs(beam->scale.shift) * beam->scale.length;
        bool down = d < 0;
        beam->origin[a] = (float)o;
        beam->direction[a] = (float)d;
        beam->inverse[a] = (down ? -1.0f : 1.0f) / (float)rgi_max(fabs(d), RGI_FLAT);
        double widening = pad * fabs((double)beam->inverse[a]);
        if (fabs(d) < RGI_FLAT) widening += longest;
        beam->near[a] = (float)(-o * (double)beam->inverse[a] - widening);
        beam->far[a] = (float)(-o * (double)beam->inverse[a] + widening);
        beam->pad += (float)(2 * pad);
        beam->negative |= (uint32_t)down << a;
        beam->towards[a] = RGI_OCTANTS * (uint32_t)(down ? a + 3 : a);
        beam->away[a] = RGI_OCTANTS * (uint32_t)(down ? a : a + 3);
    }
    start(beam, lattice->root, ray->t_min, t_max);
    return true;
}

/* The same way for all axes, without branches: which way a ray runs is not to be foreseen. */
static void set_slabs(rgi_beam *beam, const double origin[3], const double direction[3], double lost,
                      double longest) {
    for (uint32_t a = 0; a < 3; a++) {
        double o = origin[a], d = direction[a], pad = 0x1p-20 * fabs(o) + lost;
        bool down = d < 0;
        float size = (float)rgi_max(fabs(d), RGI_FLAT), inverse = (down ? -1.0f : 1.0f) / size;
        double middle = -o * (double)inverse, widening = pad * fabs((double)inverse);
        widening += fabs(d) < RGI_FLAT ? longest : 0;
        beam->origin[a] = (float)o;
        beam->direction[a] = (float)d;
        beam->inverse[a] = inverse;
        beam->near[a] = (float)(middle - widening);
        beam->far[a] = (float)(middle + widening);
        beam->pad += (float)(2 * pad);
        beam->negative |= (uint32_t)down << a;
        beam->towards[a] = RGI_OCTANTS * (a + 3 * down);
        beam->away[a] = RGI_OCTANTS * (a + 3 * !down);
    }
}

bool rgi_beam_into_mesh(rgi_beam *beam, const rgi_mesh *mesh, const rgi_local_ray *ray) {
    double origin[3], direction[3], from[3], shift = 0, radius = mesh->middle.radius;
    double unit = rgi_mesh_unit(rgi_max_magnitude(ray->direction));
    for (int a = 0; a < 3; a++) {
        origin[a] = ray->origin[a] - mesh->origin[a];
        from[a] = origin[a] - mesh->middle.centre[a];
        direction[a] = ray->direction[a] * unit;
    }
    double distance2 = rgi_dot(from, from);
    if (distance2 > RGI_FAR * RGI_FAR * radius * radius) {
        double dd = rgi_dot(direction, direction), b = rgi_dot(from, direction) / dd;
        if (distance2 - b * b * dd > 2 * radius * radius + 0x1p-40 * distance2) return false;
        shift = -b - RGI_BEFORE * radius;
        rgi_rebase3(ray->origin, mesh->origin, shift, direction, origin);
    }
    beam->scale.shift = ray->shift + shift * unit;
    beam->scale.length = mesh->scale / unit;
    for (int a = 0; a < 3; a++) origin[a] *= mesh->scale;
    beam->negative = 0;
    beam->pad = 0;
    /* A bound of t within all that is stored. */
    double longest = 2 * (mesh->middle.extent + fabs(origin[0]) + fabs(origin[1]) + fabs(origin[2]));
    set_slabs(beam, origin, direction, 0x1p-90 * fabs(beam->scale.shift) * beam->scale.length, longest);
    start(beam, mesh->root, ray->t_min, ray->t_max);
    return true;
}

void rgi_beam_of_packet(rgi_beam *beam, const rgi_packet *p, uint32_t ray, const rgi_lattice *lattice) {
    beam->negative = 0;
    for (uint32_t a = 0; a < 3; a++) {
        bool down = p->inverse[a][ray] < 0;
        beam->origin[a] = p->origin[a][ray];
        beam->direction[a] = p->direction[a][ray];
        beam->inverse[a] = p->inverse[a][ray];
        beam->near[a] = p->near[a][ray];
        beam->far[a] = p->far[a][ray];
        beam->negative |= (uint32_t)down << a;
        beam->towards[a] = RGI_OCTANTS * (down ? a + 3 : a);
        beam->away[a] = RGI_OCTANTS * (down ? a : a + 3);
    }
    beam->pad = p->pad[ray];
    beam->t_min = p->t_first[ray];
    beam->t_max = p->t_hi[ray];
    beam->scale.shift = p->shift[ray];
    beam->scale.length = p->length[ray];
    rgi_beam_start(beam, lattice->root);
}
