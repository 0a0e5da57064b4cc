/* SPDX-License-Identifier: MIT */
/*
 * The cells of the lattice. Cells of width 2^e begin at (k - t(e)) * 2^e for whole k, with t = 1/3 for even and 2/3
 * for odd e. These walls nest (each is also one of the level below), yet no two levels share them all the way up, so
 * every two points have some cell in common, and round coordinates, where scenes like to have their corners, are on
 * no wall.
 */
#ifndef RAYGRID_LIB_LATTICE_CELL_H
#define RAYGRID_LIB_LATTICE_CELL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/** Coordinates beyond this, in units of the frame, are not stored in cells: products of them stay in float's range.
 */
#define RGI_COORDINATE_MOST 0x1p60
#define RGI_CELL_LEAST 0x1p-40f /* width of the smallest cell */
#define RGI_CELL_MOST 0x1p62f   /* half the width of the largest */

typedef struct rgi_cell {
    float centre[3], half;
} rgi_cell;

/** Whether a point is in the cell, or so near to it that rounding may say either. */
static inline bool rgi_cell_holds(const float centre[3], float half, const float point[3]) {
    float reach = half * (1 + 0x1p-10f);
    return fabsf(point[0] - centre[0]) <= reach && fabsf(point[1] - centre[1]) <= reach &&
           fabsf(point[2] - centre[2]) <= reach;
}

/** The largest power of two that is not above x > 0. */
static inline double rgi_power_of_two_near(double x) {
    int exponent;
    frexp(x, &exponent);
    return ldexp(1, exponent - 1);
}

/**
 * The smallest cell that holds both corners of a box, with half its width not below `narrowest` and not above
 * `widest`; false if there is none.
 */
static inline bool rgi_cell_around(const float lo[3], const float hi[3], float narrowest, float widest,
                                   rgi_cell *cell) {
    float size = RGI_CELL_LEAST;
    int exponent;
    for (int a = 0; a < 3; a++) size = fmaxf(size, hi[a] - lo[a]);
    frexpf(fmaxf(0.5f * size, narrowest), &exponent); /* half = 2^(exponent - 1), or one more */
    if (ldexpf(1, exponent - 1) < narrowest) exponent++;
    for (float half = ldexpf(1, exponent - 1); half <= widest; half *= 2, exponent++) {
        /* The width is 2^exponent. */
        double width = ldexp(1, exponent), shift = exponent & 1 ? 2. / 3 : 1. / 3;
        for (int a = 0; a < 3; a++) cell->centre[a] = (float)((floor(lo[a] / width + shift) + 0.5 - shift) * width);
        cell->half = half;
        if (rgi_cell_holds(cell->centre, half, lo) && rgi_cell_holds(cell->centre, half, hi)) return true;
    }
    return false;
}

/** Whether floats at the cell's place are fine enough to part what is in it. */
static inline bool rgi_cell_is_precise(const rgi_cell *cell) {
    float far = fmaxf(fabsf(cell->centre[0]), fmaxf(fabsf(cell->centre[1]), fabsf(cell->centre[2])));
    return cell->half >= far * 0x1p-18f;
}

#endif
