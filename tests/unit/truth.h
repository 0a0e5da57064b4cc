/* SPDX-License-Identifier: MIT */
/* Where rays meet balls and boxes, in long double: what kernels are judged by. */
#ifndef RAYGRID_TESTS_TRUTH_H
#define RAYGRID_TESTS_TRUTH_H

#include "lattice.h"
#include "object.h"

/** MISSED and MET are beyond doubt: by more than some ulp of double. */
typedef enum verdict { MISSED, MET, UNSURE } verdict;

/** Whether the ray meets the surface in its range, and where at first. */
verdict truth_meets(const rgi_bound *bound, const rgi_ray *ray, long double *t);

/** How far off a t may be before there is no doubt. */
long double truth_doubt(const rgi_ray *ray, const rgi_bound *bound, long double t);

/** Whether the range and the object, taken as solid, have a point in common, or nearly: the most that float can be
 *  expected to tell. */
bool truth_overlaps(const rgi_bound *bound, const rgi_ray *ray);

#endif
