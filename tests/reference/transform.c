/* SPDX-License-Identifier: MIT */
/* transform.c: from the world to the frame of a shape and back, without losing digits on the way. */
#include "internal.h"

/* The sum a + b without error: the rounded sum and what the rounding lost (Knuth). */
static void two_sum(real a, real b, real *sum, real *lost) {
    *sum = a + b;
    real b_part = *sum - a;
    *lost = (a - (*sum - b_part)) + (b - b_part);
}

/* Cuts the mantissa in two halves whose products are exact (Dekker, Veltkamp). */
static void split(real a, real *high, real *low) {
    const real factor = (real)(((uint64_t)1 << ((REAL_DIGITS + 1) / 2)) + 1);
    real c = factor * a;
    *high = c - (c - a);
    *low = a - *high;
}

static void two_product(real a, real b, real *product, real *lost) {
    real ah, al, bh, bl;
    split(a, &ah, &al);
    split(b, &bh, &bl);
    *product = a * b;
    *lost = ((ah * bh - *product) + ah * bl + al * bh) + al * bl;
}

/* A number of twice the digits: the rounded value, and what is missing. */
typedef struct pair {
    real value, rest;
} pair;

/* a + b * c, with an error of the square of a rounding, of the largest of them. */
static pair add_product(pair a, real b, real c) {
    real product, lost_product, sum, lost_sum;
    two_product(b, c, &product, &lost_product);
    two_sum(a.value, product, &sum, &lost_sum);
    two_sum(sum, a.rest + (lost_product + lost_sum), &a.value, &a.rest);
    return a;
}

/*
 * Finds the point of the ray that is nearest to the object's middle and writes it relative to the object's position;
 * returns its t. A step along the ray is reckoned with twice the digits, so what is left after it has lost nothing;
 * if that is still far off, for t itself was rounded, another step follows.
 */
static real step_near(const object *o, const rg_ray *ray, const real d[3], real base[3]) {
    pair point[3];
    real t = 0, dd = dot(d, d);
    for (int i = 0; i < 3; i++) {
        two_sum(ray->origin[i], -(real)o->pose.position[i], &point[i].value, &point[i].rest);
        base[i] = point[i].value;
    }
    /* An infinite box has no middle; its walls are met from where the ray begins. */
    if (!isfinite(o->radius)) return 0;
    for (int step = 0; step < 8; step++) {
        real to_middle[3];
        for (int i = 0; i < 3; i++) to_middle[i] = o->centre[i] - base[i];
        real by = dot(to_middle, d) / dd;
        if (step > 1 && fabsl(by) * sqrtl(dd) <= fmaxl(0x1p-30L * o->radius, 0x1p-60L * length(base))) break;
        t += by;
        for (int i = 0; i < 3; i++) {
            point[i] = add_product(point[i], by, d[i]);
            base[i] = point[i].value;
        }
    }
    return t;
}

static void multiply(const real m[9], const real v[3], real out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

line line_to_object(const object *o, const rg_ray *ray, const real aside[3]) {
    const real d[3] = {ray->direction[0], ray->direction[1], ray->direction[2]};
    real base[3];
    line at;
    at.t_base = step_near(o, ray, d, base);
    for (int i = 0; aside && i < 3; i++) base[i] += aside[i];
    if (o->plain) {
        for (int i = 0; i < 3; i++) at.base[i] = base[i], at.direction[i] = d[i];
    } else {
        multiply(o->inverse, base, at.base);
        multiply(o->inverse, d, at.direction);
    }
    return at;
}

real length_in_world(const object *o, const real local[3]) {
    real world[3];
    multiply(o->matrix, local, world);
    return length(world);
}

real normal_to_world(const object *o, const real local[3], real world[3]) {
    /* Normals are covectors: by the transposed inverse, which keeps the outside outside even if the pose mirrors. */
    for (int i = 0; i < 3; i++) {
        world[i] = o->plain ? local[i]
                            : o->inverse[i] * local[0] + o->inverse[3 + i] * local[1] + o->inverse[6 + i] * local[2];
    }
    real l = length(world);
    for (int i = 0; i < 3; i++) world[i] /= l;
    return l;
}

bool passes_by(const object *o, const rg_ray *ray, real margin) {
    if (!isfinite(o->radius)) return false;
    real d[3], l[3], c[3];
    for (int i = 0; i < 3; i++) {
        d[i] = ray->direction[i];
        l[i] = ((real)o->pose.position[i] - ray->origin[i]) + o->centre[i];
    }
    cross(l, d, c);
    real reach = (o->radius + margin) * (1 + 0x1p-18L) + 0x1p-40L * length(l);
    return dot(c, c) > reach * reach * dot(d, d) * (1 + 0x1p-40L);
}

/* The largest singular value of m: Jacobi's rotations bring m^T m to diagonal form, of which the largest entry is its
 * square. */
static real norm(const real m[9]) {
    real a[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) a[i][j] = m[i] * m[j] + m[3 + i] * m[3 + j] + m[6 + i] * m[6 + j];
    }
    for (int round = 0; round < 30; round++) {
        int p = round % 3, q = (p + 1) % 3, r = (p + 2) % 3;
        if (a[p][q] == 0) continue;
        real theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        real t = (theta < 0 ? -1 : 1) / (fabsl(theta) + sqrtl(theta * theta + 1));
        real c = 1 / sqrtl(t * t + 1), s = t * c;
        real apq = a[p][q], apr = a[p][r], aqr = a[q][r];
        a[p][p] -= t * apq;
        a[q][q] += t * apq;
        a[p][q] = a[q][p] = 0;
        a[p][r] = a[r][p] = c * apr - s * aqr;
        a[q][r] = a[r][q] = s * apr + c * aqr;
    }
    return sqrtl(fmaxl(a[0][0], fmaxl(a[1][1], a[2][2])));
}

static void invert(const real m[9], real inverse[9]) {
    real c0[3], c1[3], c2[3];
    cross(m + 3, m + 6, c0);
    cross(m + 6, m, c1);
    cross(m, m + 3, c2);
    real determinant = dot(m, c0);
    for (int i = 0; i < 3; i++) {
        inverse[3 * i] = c0[i] / determinant;
        inverse[3 * i + 1] = c1[i] / determinant;
        inverse[3 * i + 2] = c2[i] / determinant;
    }
}

/* The largest distance of a point of the object from its position. Boxes and meshes: from the corners of the local
 * box; infinite axes, which go with the identity alone, do not count. */
static real radius_around_position(const object *o, const real m[9]) {
    const reference_shape *s = o->shape;
    real most = 0;
    if (s->kind == RG_SHAPE_SPHERE) return s->r * o->stretch;
    if (s->kind == RG_SHAPE_CAPSULE) {
        real a[3], b[3];
        multiply(m, s->a, a);
        multiply(m, s->b, b);
        return fmaxl(length(a), length(b)) + s->r * o->stretch;
    }
    for (int corner = 0; corner < 8; corner++) {
        real local[3], world[3];
        for (int i = 0; i < 3; i++) {
            local[i] = corner >> i & 1 ? s->hi[i] : s->lo[i];
            if (!isfinite(local[i])) local[i] = 0;
        }
        multiply(m, local, world);
        most = fmaxl(most, length(world));
    }
    return most;
}

void prepare_object(object *o) {
    static const real identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    real *m = o->matrix;
    o->plain = true;
    if (o->pose.scale == 0) o->pose.scale = 1;
    for (int i = 0; i < 9; i++) {
        m[i] = (real)o->pose.scale * o->pose.linear[i];
        o->plain = o->plain && m[i] == identity[i];
    }
    invert(m, o->inverse);
    o->stretch = o->plain ? 1 : norm(m);
    o->condition = o->plain ? 1 : o->stretch * norm(o->inverse);
    multiply(m, o->shape->centre, o->centre);
    o->radius = o->shape->radius * o->stretch;
    o->world_radius = radius_around_position(o, m);
}
