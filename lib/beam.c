/* SPDX-License-Identifier: MIT */
#include "beam.h"

#include "exact.h"
#include "vec.h"

/*
 * From farther than this many radii of all that is stored, the origin is first moved along the ray to where it comes
 * near: floats then have their bits where they are needed.
 */
#define FAR 8
/* So many radii before the middle it is put: in front of everything. */
#define BEFORE 4

/* A component of the direction below this is taken for it: over the lattice that moves a ray by less than the pads.
 */
#define FLAT 0x1p-60

/* Beyond it all bounds of t are the same; products and sums of them stay finite. */
#define T_MOST 0x1p90

float rgi_beam_above(const rgi_beam_scale *scale, float pad, double t) {
    double at = (t - scale->shift) * scale->length;
    at = rgi_min(rgi_max(at, -T_MOST), T_MOST);
    return (float)(at + 0x1p-19 * fabs(at) + 0x1p-50 * fabs(scale->shift) * scale->length) + 4 * pad;
}

float rgi_beam_below(const rgi_beam_scale *scale, float pad, double t) {
    double at = (t - scale->shift) * scale->length;
    at = rgi_min(rgi_max(at, -T_MOST), T_MOST);
    return (float)(at - 0x1p-19 * fabs(at) - 0x1p-50 * fabs(scale->shift) * scale->length) - 4 * pad;
}

/* The middle of what is stored, relative to the frame's origin in world units, and its radius. */
static double middle(const rgi_lattice *lattice, double centre[3]) {
    double half[3];
    for (int a = 0; a < 3; a++) {
        centre[a] = 0.5 * ((double)lattice->lo[a] + lattice->hi[a]) / lattice->scale;
        half[a] = 0.5 * ((double)lattice->hi[a] - lattice->lo[a]) / lattice->scale;
    }
    return sqrt(rgi_dot(half, half));
}

bool rgi_beam_init(rgi_beam *beam, const rgi_lattice *lattice, const rgi_ray *ray, double t_max) {
    double centre[3], from[3], origin[3];
    double radius = middle(lattice, centre), length = sqrt(ray->dd);
    rgi_sub(ray->origin, lattice->origin, origin);
    rgi_sub(origin, centre, from);
    double distance2 = rgi_dot(from, from);
    beam->scale.shift = 0;
    beam->scale.length = length * lattice->scale;
    if (distance2 > FAR * FAR * radius * radius) {
        double b = rgi_dot(from, ray->direction) / ray->dd;
        if (distance2 - b * b * ray->dd > 2 * radius * radius + 0x1p-40 * distance2) return false;
        beam->scale.shift = -b - BEFORE * radius / length;
        rgi_rebase3(ray->origin, lattice->origin, beam->scale.shift, ray->direction, origin);
    }
    beam->negative = 0;
    beam->pad = 0;
    for (int a = 0; a < 3; a++) {
        double o = origin[a] * lattice->scale, d = ray->direction[a] / length;
        double pad = 0x1p-20 * fabs(o) + 0x1p-90 * fabs(beam->scale.shift) * beam->scale.length;
        bool down = d < 0;
        beam->origin[a] = (float)o;
        beam->direction[a] = (float)d;
        beam->inverse[a] = (float)(1 / rgi_max(fabs(d), FLAT)) * (down ? -1.0f : 1.0f);
        beam->near[a] = (float)(-o * (double)beam->inverse[a] - pad * fabs((double)beam->inverse[a]));
        beam->far[a] = (float)(-o * (double)beam->inverse[a] + pad * fabs((double)beam->inverse[a]));
        beam->pad += (float)(2 * pad);
        beam->negative |= (uint32_t)down << a;
    }
    beam->t_min = rgi_beam_below(&beam->scale, beam->pad, ray->t_min);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, t_max);
    beam->nodes = 0;
    beam->waiting = 0;
    beam->depth = 1;
    beam->stack[0].ref = lattice->root;
    beam->stack[0].t = beam->t_min;
    return true;
}
