/* SPDX-License-Identifier: MIT */
/* peer_spheres.h: spheres as a user-defined geometry of the peer, which it can refit, as its own sphere points it can
 * not. */
#ifndef RAYGRID_BENCH_PEER_SPHERES_H
#define RAYGRID_BENCH_PEER_SPHERES_H

#include "embree_api.h"

/** `user` is an array of spheres: x, y, z and radius each. */
struct peer_sphere_functions {
    embree_bounds_function *bounds;
    embree_hit_function *intersect, *occluded;
};

/** Those for this processor. */
struct peer_sphere_functions peer_sphere_functions(void);

#endif
