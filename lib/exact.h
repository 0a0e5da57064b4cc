/* SPDX-License-Identifier: MIT */
/*
 * Sums and products with their rounding error, and what is built from them: the origin of a ray moved along it to
 * where it matters. T. J. Dekker, "A floating-point technique for extending the available precision" (1971), sections
 * 3 to 5; D. E. Knuth, TAOCP vol. 2, section 4.2.2, theorem B. They rely on IEEE double arithmetic that is rounded
 * after every operation: see the compiler options in lib/meson.build.
 */
#ifndef RAYGRID_LIB_EXACT_H
#define RAYGRID_LIB_EXACT_H

/** Returns the rounded a + b; *error is what rounding lost, exactly. */
static inline double rgi_two_sum(double a, double b, double *error) {
    double s = a + b;
    double b_part = s - a;
    double a_part = s - b_part;
    *error = (a - a_part) + (b - b_part);
    return s;
}

/** Splits a into two halves of 26 bits; |a| < 2^996. */
static inline void rgi_split(double a, double *high, double *low) {
    double c = 134217729.0 * a; /* 2^27 + 1 */
    *high = c - (c - a);
    *low = a - *high;
}

/** Returns the rounded a * b; *error is what rounding lost, exactly unless it is denormal: the same bits with or
 * without a fused multiply-add. */
static inline double rgi_two_product(double a, double b, double *error) {
#ifdef __FMA__
    double p = a * b;
    *error = __builtin_fma(a, b, -p);
    return p;
#else
    double p = a * b, ah, al, bh, bl;
    rgi_split(a, &ah, &al);
    rgi_split(b, &bh, &bl);
    *error = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    return p;
#endif
}

/**
 * a - b + t * d, with an error of 2^-52 of the result and 2^-104 of the largest term: where the three cancel, as they
 * do when a ray's origin `a` far away is moved near a point `b` that it passes, nothing is lost.
 */
static inline double rgi_rebase(double a, double b, double t, double d) {
    double e1, e2, e3;
    double difference = rgi_two_sum(a, -b, &e1);
    double product = rgi_two_product(t, d, &e2);
    double sum = rgi_two_sum(difference, product, &e3);
    return sum + (e3 + (e1 + e2));
}

static inline void rgi_rebase3(const double a[3], const double b[3], double t, const double d[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = rgi_rebase(a[i], b[i], t, d[i]);
}

#endif
