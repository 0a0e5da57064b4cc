/* SPDX-License-Identifier: MIT */
/* vectors.h: what those who make scenes compute with. */
#ifndef RAYGRID_BENCH_VECTORS_H
#define RAYGRID_BENCH_VECTORS_H

#include <math.h>

/** To a float, that is: see scenes.h. */
static inline double rounded(double x) {
    return (double)(float)x;
}

static inline void normalise(double v[3]) {
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) v[k] /= length;
}

static inline void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
