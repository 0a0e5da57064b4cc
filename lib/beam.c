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

/* A component of the direction below this is taken for it; the planes across it then count as met so much earlier and
 * later as a ray can take to pass all that is stored. */
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

/* A bound of t within the box of all that is stored, from an origin relative to the frame's. */
static double longest(const rgi_lattice *lattice, const double origin[3]) {
    double sum = 0;
    for (int a = 0; a < 3; a++)
        sum += fabs(origin[a]) * lattice->scale + rgi_max(fabs((double)lattice->lo[a]), fabs((double)lattice->hi[a]));
    return 2 * sum;
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
        double widening = pad * fabs((double)beam->inverse[a]);
        if (fabs(d) < FLAT) widening += longest(lattice, origin);
        beam->near[a] = (float)(-o * (double)beam->inverse[a] - widening);
        beam->far[a] = (float)(-o * (double)beam->inverse[a] + widening);
        beam->pad += (float)(2 * pad);
        beam->negative |= (uint32_t)down << a;
        beam->towards[a] = RGI_OCTANTS * (uint32_t)(down ? a + 3 : a);
        beam->away[a] = RGI_OCTANTS * (uint32_t)(down ? a : a + 3);
    }
    beam->t_min = rgi_beam_below(&beam->scale, beam->pad, ray->t_min);
    beam->t_max = rgi_beam_above(&beam->scale, beam->pad, t_max);
    beam->nodes = 0;
    beam->waiting = 0;
    beam->depth = 1;
    beam->refs[0] = lattice->root;
    beam->ts[0] = beam->t_min;
    return true;
}

/* ------------------------------------------------------------------------------------------------- packets */

/* Slopes against the axis may differ by this much, and the planes that bound the rays be so far apart, in radii of
 * all that is stored: beyond it what is passed over for one ray hardly ever is for all. */
#define SLOPES 0.15
#define APART 0.1

/* Slopes are widened by what rounding a direction can change of them. */
#define SLOPE_PAD 0x1p-21

static bool choose_axis(rgi_packet *p, const rgi_beam *beams, uint32_t count) {
    const float *d = beams[0].direction;
    p->axis = fabsf(d[1]) > fabsf(d[0]) ? 1 : 0;
    if (fabsf(d[2]) > fabsf(d[p->axis])) p->axis = 2;
    p->across[0] = (p->axis + 1) % 3;
    p->across[1] = (p->axis + 2) % 3;
    p->down = d[p->axis] < 0;
    p->negative = beams[0].negative;
    for (uint32_t i = 1; i < count; i++) {
        if ((beams[i].direction[p->axis] < 0) != p->down || fabsf(beams[i].direction[p->axis]) < 0.25f) return false;
    }
    return true;
}

/* The two planes across one axis. */
static bool bound_slopes(rgi_packet *p, const rgi_beam *beams, uint32_t count, uint32_t which, double radius) {
    uint32_t a = p->across[which], k = p->axis;
    double least = INFINITY, most = -INFINITY, lo = INFINITY, hi = -INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        /* Per length of way along the axis, whichever its sense. */
        double slope = beams[i].direction[a] / fabs((double)beams[i].direction[k]);
        least = rgi_min(least, slope);
        most = rgi_max(most, slope);
    }
    if (most - least > SLOPES) return false;
    least -= SLOPE_PAD * (1 + fabs(least));
    most += SLOPE_PAD * (1 + fabs(most));
    p->slope_lo[which] = (float)(p->down ? -least : least);
    p->slope_hi[which] = (float)(p->down ? -most : most);
    for (uint32_t i = 0; i < count; i++) {
        const float *o = beams[i].origin;
        double pad = 4 * beams[i].pad;
        lo = rgi_min(lo, o[a] - (double)p->slope_lo[which] * o[k] - pad);
        hi = rgi_max(hi, o[a] - (double)p->slope_hi[which] * o[k] + pad);
    }
    p->lo[which] = (float)(lo - 0x1p-22 * fabs(lo));
    p->hi[which] = (float)(hi + 0x1p-22 * fabs(hi));
    p->norm_lo[which] = (float)(1 + 0x1p-20) * sqrtf(1 + p->slope_lo[which] * p->slope_lo[which]);
    p->norm_hi[which] = (float)(1 + 0x1p-20) * sqrtf(1 + p->slope_hi[which] * p->slope_hi[which]);
    return hi - lo <= APART * radius;
}

static void copy_ray(rgi_packet *p, const rgi_beam *b, uint32_t i) {
    for (int a = 0; a < 3; a++) {
        p->origin[a][i] = b->origin[a];
        p->direction[a][i] = b->direction[a];
        p->inverse[a][i] = b->inverse[a];
        p->near[a][i] = b->near[a];
        p->far[a][i] = b->far[a];
    }
    p->pad[i] = b->pad;
    p->t_first[i] = b->t_min;
    p->t_min[i] = b->t_min + 0x1p-17f * fabsf(b->t_min) + 8 * b->pad;
    p->t_hi[i] = b->t_max;
    p->t_lo[i] = b->t_max - 0x1p-17f * fabsf(b->t_max) - 8 * b->pad;
    p->scale[i] = b->scale;
}

bool rgi_packet_init(rgi_packet *p, const rgi_beam *beams, uint32_t count, const rgi_lattice *lattice) {
    double radius = 0, centre[3];
    if (!choose_axis(p, beams, count)) return false;
    radius = middle(lattice, centre) * lattice->scale;
    if (!bound_slopes(p, beams, count, 0, radius) || !bound_slopes(p, beams, count, 1, radius)) return false;
    double first = INFINITY, last = -INFINITY;
    p->pad_most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const rgi_beam *b = &beams[i];
        /* What lies behind an origin is out of the planes. */
        if (b->t_min < -8 * b->pad - 0x1p-17f * fabsf(b->t_min)) return false;
        double along = p->down ? -(double)b->origin[p->axis] : b->origin[p->axis];
        first = rgi_min(first, along - 4 * b->pad);
        last = rgi_max(last, along + 4 * b->pad);
        p->pad_most = b->pad > p->pad_most ? b->pad : p->pad_most;
    }
    p->start_first = (float)(first - 0x1p-22 * fabs(first));
    p->start_last = (float)(last + 0x1p-22 * fabs(last));
    p->stretch = 1 - 0x1p-18f;
    for (uint32_t i = 0; i < RGI_PACKET; i++) copy_ray(p, &beams[i < count ? i : 0], i);
    p->active = (1u << count) - 1;
    p->certain = 0;
    p->visits = 0;
    return true;
}
