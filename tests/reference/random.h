/* SPDX-License-Identifier: MIT */
/* random.h: the numbers of all randomized tests; the same on every machine for the same seed. */
#ifndef RAYGRID_TESTS_RANDOM_H
#define RAYGRID_TESTS_RANDOM_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct random_source {
    uint64_t state;
} random_source;

/* SplitMix64 (Steele, Lea, Flood 2014). */
static inline uint64_t random_bits(random_source *r) {
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/** In [0, n). */
static inline uint32_t random_below(random_source *r, uint32_t n) {
    return (uint32_t)(((random_bits(r) >> 32) * n) >> 32);
}

static inline double random_between(random_source *r, double lo, double hi) {
    return lo + (hi - lo) * ((double)(random_bits(r) >> 11) * 0x1p-53);
}

/** True once in n times. */
static inline bool random_once_in(random_source *r, uint32_t n) {
    return random_below(r, n) == 0;
}

/** 10 to the power of something between lo and hi. Made of exact steps and one product: no libm, no differences. */
static inline double random_decade(random_source *r, int lo, int hi) {
    int power = lo + (int)random_below(r, (uint32_t)(hi - lo + 1));
    double x = random_between(r, 0.3, 3);
    for (; power > 0; power--) x *= 10;
    for (; power < 0; power++) x /= 10;
    return x;
}

/** A direction, each alike, of length 1 to some ulp. */
static inline void random_direction(random_source *r, double d[3]) {
    double l;
    do {
        for (int i = 0; i < 3; i++) d[i] = random_between(r, -1, 1);
        l = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    } while (l > 1 || l < 1e-6);
    for (int i = 0; i < 3; i++) d[i] /= sqrt(l);
}

#endif
