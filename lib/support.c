/* SPDX-License-Identifier: MIT */
#include "support.h"

#include "vec.h"

static const int DIAGONALS[RGI_DIAGONALS][3] = {{1, 1, 0},  {1, -1, 0}, {1, 0, 1},  {1, 0, -1}, {0, 1, 1},
                                                {0, 1, -1}, {1, 1, 1},  {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};

static const int STRIDES[3] = {RGI_DIRECTION(1, 0, 0) - RGI_DIRECTION(0, 0, 0),
                               RGI_DIRECTION(0, 1, 0) - RGI_DIRECTION(0, 0, 0),
                               RGI_DIRECTION(0, 0, 1) - RGI_DIRECTION(0, 0, 0)};

void rgi_reaches_empty(rgi_reaches *r) {
    for (int l = 0; l < RGI_TOGETHER; l++) {
        for (int d = 0; d < RGI_DIAGONALS; d++) {
            r->most[d][l] = -(float)INFINITY;
            r->least[d][l] = (float)INFINITY;
        }
        r->square[l] = 0;
    }
}

/* What the box lo..hi has of p * direction at the most. */
static double most_of_box(const int direction[3], const double lo[3], const double hi[3]) {
    double sum = 0;
    for (int a = 0; a < 3; a++) sum += direction[a] < 0 ? -lo[a] : direction[a] > 0 ? hi[a] : 0;
    return sum;
}

/* Both ways of a diagonal. `most` and `least` are relative to the origin of the frame, but in local units. */
static void set_diagonal(rgi_support *s, const int direction[3], double most, double least, const double lo[3],
                         const double hi[3]) {
    const int opposite[3] = {-direction[0], -direction[1], -direction[2]};
    int number = RGI_DIRECTION(direction[0], direction[1], direction[2]);
    double middle = direction[0] * s->centre[0] + direction[1] * s->centre[1] + direction[2] * s->centre[2];
    s->along[number] = rgi_min(middle + most, most_of_box(direction, lo, hi));
    s->along[RGI_DIRECTIONS - 1 - number] = rgi_min(-middle - least, most_of_box(opposite, lo, hi));
}

void rgi_support_init(rgi_support *s, const rgi_reaches *reaches, const double lo[3], const double hi[3],
                      const double origin[3], double scale, double pad) {
    float square = 0;
    rgi_copy(origin, s->centre);
    s->along[RGI_DIRECTION(0, 0, 0)] = 0;
    for (int a = 0; a < 3; a++) {
        s->along[RGI_DIRECTION(0, 0, 0) + STRIDES[a]] = hi[a];
        s->along[RGI_DIRECTION(0, 0, 0) - STRIDES[a]] = -lo[a];
    }
    for (int d = 0; d < RGI_DIAGONALS; d++) {
        float most = reaches->most[d][0], least = reaches->least[d][0];
        for (int l = 1; l < RGI_TOGETHER; l++) {
            most = reaches->most[d][l] > most ? reaches->most[d][l] : most;
            least = reaches->least[d][l] < least ? reaches->least[d][l] : least;
        }
        set_diagonal(s, DIAGONALS[d], ((double)most + pad) / scale, ((double)least - pad) / scale, lo, hi);
    }
    for (int l = 0; l < RGI_TOGETHER; l++) square = reaches->square[l] > square ? reaches->square[l] : square;
    s->radius = (sqrt((double)square) + pad) / scale;
}

/*
 * How far a set reaches is a sublinear function h of the direction (R. T. Rockafellar, Convex Analysis, 1970, section
 * 13): h(a + b) <= h(a) + h(b), and h(t a) = t h(a) for t >= 0. With the row's components by their size x >= y >= z
 * >= 0, each with its sign, row = (x - y) e1 + (y - z) (e1 + e2) + z (e1 + e2 + e3): three directions that are known.
 * Of a ball that is 13 % more than it reaches at the most. No branches: which component is larger can't be foreseen.
 */
static void bound_row(const rgi_support *s, const double row[3], double *lo, double *hi) {
    /* By whether the first is not below the second, the second not below the third, the first not below the third:
     * two of the eight can't be. */
    static const int ORDERS[8][3] = {{2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {0, 1, 2},
                                     {0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}};
    double size[3];
    int steps[3];
    for (int a = 0; a < 3; a++) {
        size[a] = fabs(row[a]);
        steps[a] = row[a] < 0 ? -STRIDES[a] : STRIDES[a];
    }
    const int *order = ORDERS[(size[0] >= size[1]) + 2 * (size[1] >= size[2]) + 4 * (size[0] >= size[2])];
    double x = size[order[0]], y = size[order[1]], z = size[order[2]];
    int one = steps[order[0]], two = one + steps[order[1]], three = two + steps[order[2]];
    const double *from = s->along + RGI_DIRECTION(0, 0, 0);
    *hi = (x - y) * from[one] + (y - z) * from[two] + z * from[three];
    *lo = -((x - y) * from[-one] + (y - z) * from[-two] + z * from[-three]);
}

/* The largest stretch of a matrix M is the root of the largest eigenvalue of M * transposed M, which is at most the
 * largest sum of the sizes of a row: exact for turns, mirrors and scales. */
static double largest_stretch(const double m[9]) {
    double xy = fabs(rgi_dot(m, m + 3)), yz = fabs(rgi_dot(m + 3, m + 6)), zx = fabs(rgi_dot(m + 6, m));
    double x = rgi_dot(m, m) + xy + zx, y = rgi_dot(m + 3, m + 3) + xy + yz, z = rgi_dot(m + 6, m + 6) + yz + zx;
    return sqrt(rgi_max(x, rgi_max(y, z)));
}

double rgi_support_reach(const rgi_support *s) {
    return (sqrt(rgi_dot(s->centre, s->centre)) + s->radius) * (1 + 0x1p-48);
}

double rgi_support_bounds(const rgi_support *s, const double m[9], double lo[3], double hi[3]) {
    double centre[3], radius = s->radius * largest_stretch(m) * (1 + 0x1p-48);
    for (int i = 0; i < 3; i++) {
        centre[i] = rgi_dot(m + 3 * i, s->centre);
        bound_row(s, m + 3 * i, &lo[i], &hi[i]);
        lo[i] = rgi_max(lo[i], centre[i] - radius);
        hi[i] = rgi_min(hi[i], centre[i] + radius);
    }
    /* Where the square overflows, as only that of a far centre can, the box tells how far it is. */
    return (sqrt(rgi_dot(centre, centre)) + radius) * (1 + 0x1p-48);
}
