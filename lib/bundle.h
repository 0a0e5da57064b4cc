/* SPDX-License-Identifier: MIT */
/*
 * Rays that are worked on together, one a lane: the same numbers as in rgi_ray, to the last bit, as arrays.
 */
#ifndef RAYGRID_LIB_BUNDLE_H
#define RAYGRID_LIB_BUNDLE_H

#include <stdbool.h>
#include <stdint.h>

enum { RGI_PACKET = 16 };

typedef struct rgi_bundle {
    double origin[3][RGI_PACKET] __attribute__((aligned(64)));
    double direction[3][RGI_PACKET]; /* as given; rgi_kernels.prepare scales them, and the limits of t */
    double t_min[RGI_PACKET], t_max[RGI_PACKET];
    double dd[RGI_PACKET];
    double to_world[RGI_PACKET], to_world2[RGI_PACKET];
    uint32_t mask[RGI_PACKET];
    uint32_t count; /* lanes in use; the others repeat the first */
} rgi_bundle;

/** Balls to be met, one a lane, and where. */
typedef struct rgi_meeting {
    double centre[3][RGI_PACKET] __attribute__((aligned(64)));
    double radius[RGI_PACKET];
    double scaled_t[RGI_PACKET]; /* out: in units of the scaled direction */
    double t[RGI_PACKET];        /* out: in units of the direction that the caller gave */
    bool wants_normals;
    float normal[3][RGI_PACKET]; /* out, if wanted: of length 1, as in rg_hit */
    uint32_t met;                /* out: bits of the lanes where the ball is met in range */
} rgi_meeting;

#endif
