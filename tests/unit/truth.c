/* SPDX-License-Identifier: MIT */
#include "truth.h"

#include <math.h>

typedef struct crossing {
    long double first, last;
} crossing;

/* Where the line enters and leaves. */
static verdict cross_ball(const rgi_bound *b, const rgi_ray *r, crossing *c) {
    long double to[3], along = 0, square = 0, distance = 0;
    for (int a = 0; a < 3; a++) {
        to[a] = (long double)r->origin[a] - b->centre[a];
        along -= to[a] * r->direction[a];
        distance += to[a] * to[a];
    }
    along /= r->dd;
    for (int a = 0; a < 3; a++) {
        long double foot = to[a] + along * r->direction[a];
        square += foot * foot;
    }
    long double foot = sqrtl(square), unsure = 0x1p-40L * b->radius + 0x1p-50L * sqrtl(distance);
    if (foot > b->radius + unsure) return MISSED;
    if (foot >= b->radius - unsure) return UNSURE;
    long double half = sqrtl((b->radius * (long double)b->radius - square) / r->dd);
    c->first = along - half;
    c->last = along + half;
    return MET;
}

static verdict cross_box(const rgi_bound *b, const rgi_ray *r, crossing *c) {
    long double from[3], to[3];
    verdict all = MET;
    c->first = -INFINITY;
    c->last = INFINITY;
    for (int a = 0; a < 3; a++) {
        from[a] = -INFINITY;
        to[a] = INFINITY;
        if (r->direction[a] == 0) {
            if (r->origin[a] < b->lo[a] || r->origin[a] > b->hi[a]) return MISSED;
            continue;
        }
        long double one = (b->lo[a] - (long double)r->origin[a]) / r->direction[a];
        long double other = (b->hi[a] - (long double)r->origin[a]) / r->direction[a];
        from[a] = fminl(one, other);
        to[a] = fmaxl(one, other);
        c->first = fmaxl(c->first, from[a]);
        c->last = fminl(c->last, to[a]);
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            long double unsure = 0x1p-50L * (fabsl(from[i]) + fabsl(to[k]));
            if (i == k || !(unsure < INFINITY)) continue;
            if (from[i] > to[k] + unsure) return MISSED;
            if (from[i] >= to[k] - unsure) all = UNSURE;
        }
    }
    return all;
}

long double truth_doubt(const rgi_ray *r, const rgi_bound *b, long double t) {
    long double size = 0;
    for (int a = 0; a < 3; a++) {
        size += fabsl((long double)r->origin[a] - b->centre[a]) * 0x1p-48L;
        size += 0x1p-38L * ((long double)b->hi[a] - b->lo[a]);
    }
    return size / sqrtl(r->dd) + 0x1p-48L * fabsl(t);
}

verdict truth_meets(const rgi_bound *b, const rgi_ray *r, long double *t) {
    crossing c;
    verdict line = b->ball ? cross_ball(b, r, &c) : cross_box(b, r, &c);
    if (line != MET) return line;
    for (int end = 0; end < 2; end++) {
        *t = end ? c.last : c.first;
        long double unsure = truth_doubt(r, b, *t);
        if (*t > r->t_max + unsure) return MISSED;
        if (*t > r->t_max - unsure) return UNSURE;
        if (*t >= r->t_min + unsure) return MET;
        if (*t > r->t_min - unsure) return UNSURE;
    }
    return MISSED;
}

bool truth_overlaps(const rgi_bound *b, const rgi_ray *r) {
    crossing c;
    verdict line = b->ball ? cross_ball(b, r, &c) : cross_box(b, r, &c);
    return line == UNSURE || (line == MET && c.first <= r->t_max && c.last >= r->t_min);
}
