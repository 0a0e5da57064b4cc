/* SPDX-License-Identifier: MIT */
/*
 * How far the points of a mesh reach in fixed directions, and around the origin of its frame: from that follow in a
 * few operations bounds of the mesh under any linear part, much tighter than the box of its turned box.
 */
#ifndef RAYGRID_LIB_SUPPORT_H
#define RAYGRID_LIB_SUPPORT_H

/** The directions (x, y, z) with x, y and z each -1, 0 or 1; 0, 0, 0, which is none, makes them easy to number. */
enum { RGI_DIRECTIONS = 27, RGI_DIAGONALS = 10, RGI_TOGETHER = 8 };
#define RGI_DIRECTION(x, y, z) ((x) + 3 * (y) + 9 * (z) + 13)

typedef struct rgi_support {
    double along[RGI_DIRECTIONS]; /* no point p has a larger p * direction */
    double centre[3], radius;     /* of a ball that holds all */
} rgi_support;

/**
 * The same while points are gone through, RGI_TOGETHER at a time, as floats in the frame of the mesh: the largest and
 * least p * direction for diagonals, in the order of DIAGONALS in support.c, of each lane; and of p * p the largest.
 */
typedef struct rgi_reaches {
    float most[RGI_DIAGONALS][RGI_TOGETHER], least[RGI_DIAGONALS][RGI_TOGETHER], square[RGI_TOGETHER];
} rgi_reaches;

/** Those of no point. */
void rgi_reaches_empty(rgi_reaches *reaches);

/** What is within lo and hi, and within the reaches in a frame of that origin and scale, `pad` being as much as
 * rounding can have moved points there. */
void rgi_support_init(rgi_support *support, const rgi_reaches *reaches, const double lo[3], const double hi[3],
                      const double origin[3], double scale, double pad);

/** A distance from the local origin beyond which there is no point. */
double rgi_support_reach(const rgi_support *support);

/**
 * A box around the products of a matrix and all points, never wider than that of the points' turned box. Returns a
 * distance from the origin beyond which there is none. Along axis i it is rounded by less than 2^-50 of the sum over
 * k of |matrix[3 i + k]| times the largest coordinate along k.
 */
double rgi_support_bounds(const rgi_support *support, const double matrix[9], double lo[3], double hi[3]);

#endif
