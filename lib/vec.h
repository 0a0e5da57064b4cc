/* SPDX-License-Identifier: MIT */
/* Vectors of three doubles as plain arrays. Sums run in the order x, y, z, so that every machine rounds alike. */
#ifndef RAYGRID_LIB_VEC_H
#define RAYGRID_LIB_VEC_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static inline double rgi_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void rgi_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void rgi_sub(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

/** out = a + t * b */
static inline void rgi_along(const double a[3], double t, const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] + t * b[i];
}

static inline void rgi_copy(const double a[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i];
}

static inline void rgi_set(double out[3], double x, double y, double z) {
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/* Not fmin and fmax: those must care for NaN and become library calls. */
static inline double rgi_min(double a, double b) {
    return a < b ? a : b;
}
static inline double rgi_max(double a, double b) {
    return a > b ? a : b;
}

/** Rounds down; |x| < 2^62. Not floor, which on baseline x86-64 is a library call. */
static inline double rgi_floor(double x) {
    double whole = (double)(int64_t)x;
    return whole > x ? whole - 1 : whole;
}

static inline double rgi_max_magnitude(const double a[3]) {
    return rgi_max(rgi_max(fabs(a[0]), fabs(a[1])), fabs(a[2]));
}

/** Grows the box lo..hi to hold the box a..b. */
static inline void rgi_grow(double lo[3], double hi[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) {
        lo[i] = rgi_min(lo[i], a[i]);
        hi[i] = rgi_max(hi[i], b[i]);
    }
}

/** The box that holds nothing: lo = +inf, hi = -inf. */
static inline void rgi_empty_box(double lo[3], double hi[3]) {
    rgi_set(lo, INFINITY, INFINITY, INFINITY);
    rgi_set(hi, -INFINITY, -INFINITY, -INFINITY);
}

static inline double rgi_diagonal(const double lo[3], const double hi[3]) {
    double d[3];
    rgi_sub(hi, lo, d);
    double m = rgi_max_magnitude(d);
    if (!(m > 0)) return 0;
    for (int i = 0; i < 3; i++) d[i] /= m;
    return m * sqrt(rgi_dot(d, d));
}

#endif
