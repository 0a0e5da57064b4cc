/* SPDX-License-Identifier: MIT */
/*
 * batches.h: neighbouring rays, as hosts send them: of a camera, parallel, towards a light. A library may take groups
 * of such rays another way than lone ones, so among them are some that fit in no group: that run the other way on an
 * axis, have a range of their own, or are no rays.
 */
#ifndef RAYGRID_TESTS_BATCHES_H
#define RAYGRID_TESTS_BATCHES_H

#include "random.h"

#include <raygrid/raygrid.h>

/** Where a scene is: most of it within `spread` of `centre` on each axis. */
typedef struct batch_space {
    double centre[3], spread;
} batch_space;

/** Fills `count` rays that belong together. The same bits on every machine. */
void batch_rays(random_source *random, const batch_space *space, rg_ray *rays, uint32_t count);

/** Rays from what others hit, off the surface, to a light: t from 0 to 1. Of those that hit nothing: from anywhere.
 */
void batch_shadows(random_source *random, const batch_space *space, const rg_hit *hits, rg_ray *rays, uint32_t count);

#endif
