/* SPDX-License-Identifier: MIT */
/*
 * The part of the kernels that is in double: what object.c, sphere.c and beam.c do for one ray, for 16, in the same
 * order of the same operations, so with the same bits. Plain loops over the lanes, for the compiler to vectorise.
 */
#include "bundle.h"
#include "exact.h"
#include "vec.h"

#define LANES(i) for (int i = 0; i < RGI_PACKET; i++)

static double from_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t to_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Lengths of directions, and limits of t unless they are 0 or infinite, are within 2^+-MODERATE: there scaling by a
 * power of two needs no care. */
#define MODERATE_LEAST 0x1p-400
#define MODERATE_MOST 0x1p400

static int is_moderate_limit(double t) {
    double size = fabs(t);
    return (size <= MODERATE_MOST) & ((size >= MODERATE_LEAST) | (size == 0)) ? 1 : size == INFINITY;
}

/* rgi_ray_init for all lanes; false if a ray is invalid or extreme, and then nothing is said about the others. */
static bool prepare(rgi_bundle *b) {
    double largest[RGI_PACKET];
    int right = 1;
    LANES(i) {
        double x = fabs(b->direction[0][i]), y = fabs(b->direction[1][i]), z = fabs(b->direction[2][i]);
        largest[i] = rgi_max(rgi_max(x, y), z);
        /* Comparisons that NaN fails, each on its own: of two maxima one would hide it. */
        right &= (x <= MODERATE_MOST) & (y <= MODERATE_MOST) & (z <= MODERATE_MOST) & (largest[i] >= MODERATE_LEAST);
        right &= (fabs(b->origin[0][i]) <= RG_COORDINATE_MAX) & (fabs(b->origin[1][i]) <= RG_COORDINATE_MAX);
        right &= fabs(b->origin[2][i]) <= RG_COORDINATE_MAX;
    }
    LANES(i) right &= (b->t_min[i] <= b->t_max[i]) & is_moderate_limit(b->t_min[i]) & is_moderate_limit(b->t_max[i]);
    if (!right) return false;
    LANES(i) {
        int32_t exponent = (int32_t)(to_bits(largest[i]) >> 52) - 1023, half = exponent / 2;
        b->to_world[i] = from_bits((uint64_t)(int64_t)(1023 - half) << 52);
        b->to_world2[i] = from_bits((uint64_t)(int64_t)(1023 - (exponent - half)) << 52);
        double from_world = from_bits((uint64_t)(int64_t)(1023 + half) << 52);
        double from_world2 = from_bits((uint64_t)(int64_t)(1023 + exponent - half) << 52);
        for (int a = 0; a < 3; a++) b->direction[a][i] = b->direction[a][i] * b->to_world[i] * b->to_world2[i];
        b->t_min[i] = rgi_max(rgi_max(b->t_min[i], -DBL_MAX) * from_world * from_world2, -RGI_FARTHEST);
        b->t_max[i] = rgi_min(rgi_min(b->t_max[i], DBL_MAX) * from_world * from_world2, RGI_FARTHEST);
        b->dd[i] = b->direction[0][i] * b->direction[0][i] + b->direction[1][i] * b->direction[1][i] +
                   b->direction[2][i] * b->direction[2][i];
    }
    return true;
}

/* world_normal of query.c for balls; where nothing is left of one, the ball is not met here. */
RGI_INLINE void meet_normals(const rgi_bundle *b, double in[3][RGI_PACKET], const double root[RGI_PACKET],
                             rgi_meeting *m, int met[RGI_PACKET]) {
    LANES(i) {
        double x = in[0][i] + root[i] * b->direction[0][i], y = in[1][i] + root[i] * b->direction[1][i];
        double z = in[2][i] + root[i] * b->direction[2][i];
        double largest = rgi_max(rgi_max(fabs(x), fabs(y)), fabs(z));
        met[i] &= (largest > 0) & (largest <= DBL_MAX);
        x /= largest;
        y /= largest;
        z /= largest;
        double length = sqrt(x * x + y * y + z * z);
        m->normal[0][i] = (float)(x / length);
        m->normal[1][i] = (float)(y / length);
        m->normal[2][i] = (float)(z / length);
    }
}

/* Where the rays meet balls: rgi_object_intersect with rgi_sphere_intersect. What is left out there, a first test
 * that most objects fail, changes no answer. */
static void meet(const rgi_bundle *b, rgi_meeting *m) {
    double in[3][RGI_PACKET], shift[RGI_PACKET], along[RGI_PACKET], root[RGI_PACKET];
    int met[RGI_PACKET];
    LANES(i) {
        double oo = 0, od = 0;
        for (int a = 0; a < 3; a++) {
            in[a][i] = b->origin[a][i] - m->centre[a][i];
            oo = a ? oo + in[a][i] * in[a][i] : in[a][i] * in[a][i];
            od = a ? od + in[a][i] * b->direction[a][i] : in[a][i] * b->direction[a][i];
        }
        bool far = oo > (double)(RGI_NEAR * RGI_NEAR) * m->radius[i] * m->radius[i];
        shift[i] = far ? -(od / b->dd[i]) : 0;
        along[i] = far;
    }
    for (int a = 0; a < 3; a++) {
        LANES(i) {
            double moved = rgi_rebase(b->origin[a][i], m->centre[a][i], shift[i], b->direction[a][i]);
            in[a][i] = along[i] != 0 ? moved : in[a][i];
        }
    }
    LANES(i) {
        double d[3] = {b->direction[0][i], b->direction[1][i], b->direction[2][i]};
        double o[3] = {in[0][i], in[1][i], in[2][i]}, dd = b->dd[i], r = m->radius[i];
        double od = o[0] * d[0] + o[1] * d[1] + o[2] * d[2], t = -(od / dd);
        double foot[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
        double inside = r * r - (foot[0] * foot[0] + foot[1] * foot[1] + foot[2] * foot[2]);
        double h = sqrt(dd * rgi_max(inside, 0));
        double c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] - r * r;
        double q = od > 0 ? -od - h : -od + h;
        double far_from_zero = q / dd;
        int rounding = fabs(c) > 2 * (q * far_from_zero);
        double over = rounding ? (od > 0 ? -od + h : -od - h) : c, under = rounding ? dd : q;
        double near_zero = under != 0 ? over / under : 0;
        double near_root = od > 0 ? far_from_zero : near_zero, far_root = od > 0 ? near_zero : far_from_zero;
        double first = shift[i] + near_root, second = shift[i] + far_root;
        int first_in = (first >= b->t_min[i]) & (first <= b->t_max[i]);
        int second_in = (second >= b->t_min[i]) & (second <= b->t_max[i]);
        m->scaled_t[i] = first_in ? first : second;
        root[i] = first_in ? near_root : far_root;
        met[i] = (inside >= 0) & (first_in | second_in);
    }
    if (m->wants_normals) meet_normals(b, in, root, m, met);
    m->met = 0;
    LANES(i) m->t[i] = m->scaled_t[i] * b->to_world[i] * b->to_world2[i];
    LANES(i) m->met |= (uint32_t)met[i] << i;
}

/* rgi_beam_init for all lanes of a packet. */
static void to_frame(const rgi_bundle *b, const rgi_lattice *lattice, const rgi_middle *middle, rgi_packet *p) {
    double from[3][RGI_PACKET], origin[3][RGI_PACKET], length[RGI_PACKET], shift[RGI_PACKET], pads[RGI_PACKET];
    double longest[RGI_PACKET], per_length[RGI_PACKET];
    double radius = middle->radius, scale = lattice->scale;
    int any_far = 0, passes[RGI_PACKET];
    LANES(i) {
        double distance2 = 0;
        for (int a = 0; a < 3; a++) {
            origin[a][i] = b->origin[a][i] - lattice->origin[a];
            from[a][i] = origin[a][i] - middle->centre[a];
            distance2 += from[a][i] * from[a][i];
        }
        any_far |= distance2 > RGI_FAR * RGI_FAR * radius * radius;
        length[i] = sqrt(b->dd[i]);
        per_length[i] = 1 / length[i];
        shift[i] = pads[i] = 0;
        passes[i] = 0;
    }
    if (any_far) {
        LANES(i) {
            double distance2 = from[0][i] * from[0][i] + from[1][i] * from[1][i] + from[2][i] * from[2][i];
            double od =
                from[0][i] * b->direction[0][i] + from[1][i] * b->direction[1][i] + from[2][i] * b->direction[2][i];
            bool far = distance2 > RGI_FAR * RGI_FAR * radius * radius;
            double along = od / b->dd[i];
            passes[i] = far & (distance2 - along * along * b->dd[i] > 2 * radius * radius + 0x1p-40 * distance2);
            shift[i] = far ? -along - RGI_BEFORE * radius * per_length[i] : 0;
        }
        for (int a = 0; a < 3; a++) {
            LANES(i) {
                double moved = rgi_rebase(b->origin[a][i], lattice->origin[a], shift[i], b->direction[a][i]);
                origin[a][i] = shift[i] != 0 ? moved : origin[a][i];
            }
        }
    }
    LANES(i)
    longest[i] = 2 * (middle->extent + scale * (fabs(origin[0][i]) + fabs(origin[1][i]) + fabs(origin[2][i])));
    for (int a = 0; a < 3; a++) {
        LANES(i) {
            double o = origin[a][i] * scale, d = b->direction[a][i] * per_length[i];
            double pad = 0x1p-20 * fabs(o) + 0x1p-90 * fabs(shift[i]) * length[i] * scale;
            float straight = (float)rgi_max(fabs(d), RGI_FLAT);
            float inverse = (d < 0 ? -1.0f : 1.0f) / straight;
            double widening = pad * fabs((double)inverse) + (fabs(d) < RGI_FLAT ? longest[i] : 0);
            p->origin[a][i] = (float)o;
            p->direction[a][i] = (float)d;
            p->inverse[a][i] = inverse;
            p->near[a][i] = (float)(-o * (double)inverse - widening);
            p->far[a][i] = (float)(-o * (double)inverse + widening);
            pads[i] += 2 * pad;
        }
    }
    LANES(i) {
        double unit = length[i] * scale, lost = 0x1p-50 * fabs(shift[i]) * unit;
        double first = (b->t_min[i] - shift[i]) * unit, last = (b->t_max[i] - shift[i]) * unit;
        float pad = (float)pads[i];
        /* All that is stored lies ahead of an origin that was moved. */
        first = shift[i] != 0 ? rgi_max(first, 0) : first;
        first = rgi_min(rgi_max(first, -RGI_T_MOST), RGI_T_MOST);
        last = rgi_min(rgi_max(last, -RGI_T_MOST), RGI_T_MOST);
        p->pad[i] = pad;
        p->shift[i] = shift[i];
        p->length[i] = unit;
        p->t_first[i] = (float)(first - 0x1p-19 * fabs(first) - lost) - 4 * pad;
        p->t_min[i] = (float)(first + 0x1p-19 * fabs(first) + lost) + 4 * pad;
        p->t_lo[i] = (float)(last - 0x1p-19 * fabs(last) - lost) - 4 * pad;
        p->t_hi[i] = (float)(last + 0x1p-19 * fabs(last) + lost) + 4 * pad;
    }
    p->active = (1u << b->count) - 1;
    LANES(i) p->active &= ~((uint32_t)passes[i] << i);
    p->certain = 0;
}
