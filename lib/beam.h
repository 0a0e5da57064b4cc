/* SPDX-License-Identifier: MIT */
/*
 * Rays in the frame of a lattice, in float, and the kernels that take them through it.
 *
 * Kernels decide nothing that an answer depends on. They find what a ray may meet, by bounds that hold whatever was
 * rounded, and ask: the object is then intersected in double, the same way wherever the kernel, the packet, or the
 * place of the object differ. What is certain in float is not asked in between, only at the end.
 */
#ifndef RAYGRID_LIB_BEAM_H
#define RAYGRID_LIB_BEAM_H

#include "lattice.h"
#include "object.h"

enum {
    RGI_PACKET = 16,
    RGI_STACK = 256 /* of a beam; what goes deeper is walked by recursion */
};

/** What is still to be looked into, from where on along the ray. */
typedef struct rgi_visit_later {
    rgi_ref ref;
    float t;
} rgi_visit_later;

/** Where the frame's t is zero, and how it grows with the ray's. */
typedef struct rgi_beam_scale {
    double shift;  /* the t of the ray where the beam's is 0 */
    double length; /* of the ray's direction, in units of the frame */
} rgi_beam_scale;

/**
 * One ray. Bounds of t are wider than the truth: t_min is below, t_max above what the ray may meet.
 * Planes are met at plane * inverse + near, or + far, for the planes towards the ray's origin and away from it: both
 * constants hold the error of all that is rounded.
 */
typedef struct rgi_beam {
    float origin[3], direction[3]; /* of length 1 */
    float inverse[3], near[3], far[3];
    float pad; /* what the rounding of origin and direction can do to a ball */
    float t_min, t_max;
    uint32_t negative; /* bits of the axes along which it runs down: the order of octants */
    rgi_beam_scale scale;
    /** Intersects the object with the ray in double; may lower t_max. Returns true to end. */
    bool (*ask)(struct rgi_beam *beam, uint32_t slot);
    void *query;
    uint32_t nodes; /* counts nodes and blocks looked into */
    /* the walk */
    uint32_t depth;
    uint32_t waiting; /* bits of the objects of `block` that are to be asked */
    rgi_ref block;
    float t[RGI_BLOCK]; /* where each is met at the earliest */
    rgi_visit_later stack[RGI_STACK];
} rgi_beam;

/** Fills all but ask and query; false if the ray passes all that is stored. */
bool rgi_beam_init(rgi_beam *beam, const rgi_lattice *lattice, const rgi_ray *ray, double t_max);

/** A bound from above for a t of the ray, in the frame. */
float rgi_beam_above(const rgi_beam_scale *scale, float pad, double t);
float rgi_beam_below(const rgi_beam_scale *scale, float pad, double t);

/** The kernels of one instruction set. */
typedef struct rgi_kernels {
    const char *name;
    /** Takes one ray through the lattice. */
    void (*trace_one)(const rgi_lattice *lattice, rgi_beam *beam);
    /** Takes up to RGI_PACKET rays through side by side, each on its own way, so that waits for memory overlap. */
    void (*trace_some)(const rgi_lattice *lattice, rgi_beam *beams, uint32_t count);
} rgi_kernels;

extern const rgi_kernels rgi_kernels_portable;
#if defined(__x86_64__)
extern const rgi_kernels rgi_kernels_sse2, rgi_kernels_avx2, rgi_kernels_avx512;
#elif defined(__aarch64__)
extern const rgi_kernels rgi_kernels_neon;
#endif

/** The best kernels that this processor can run. */
const rgi_kernels *rgi_kernels_best(void);

#endif
