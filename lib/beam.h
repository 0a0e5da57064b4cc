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

#include "bundle.h"
#include "lattice.h"
#include "object.h"

#include <string.h>

typedef struct rgi_kernels rgi_kernels;
struct rgi_mesh_ray;
struct rgi_mesh_lanes;
struct rgi_mesh_packet;
struct rgi_object;
struct rgi_wrap;
struct rgi_cut;
struct rgi_making;

/** Entries of a beam's stack; what goes deeper is walked by recursion. */
enum { RGI_STACK = 64 };

/** Packets that may go together: 8x8 pixels of a picture. */
enum { RGI_PACKETS = 4 };

/**
 * From farther than this many radii of all that is stored, the origin is first moved along the ray to where it comes
 * near, so many radii before the middle, in front of everything: floats then have their bits where they are needed.
 */
#define RGI_FAR 8
#define RGI_BEFORE 4

/** A component of the direction below this is taken for it; the planes across it then count as met so much earlier
 * and later as a ray can take to pass all that is stored. */
#define RGI_FLAT 0x1p-60

/** Beyond it all bounds of t are the same; products and sums of them stay finite. */
#define RGI_T_MOST 0x1p90

/** What came of trying to enter a mesh. */
typedef enum rgi_entered { RGI_NO_MESH_THERE, RGI_PASSED_BY, RGI_AT_DOOR } rgi_entered;

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
    uint32_t negative;            /* bits of the axes along which it runs down: the order of octants */
    uint32_t towards[3], away[3]; /* where a node keeps the planes that the ray meets first and last, in floats */
    rgi_beam_scale scale;
    /** Intersects the object with the ray in double; may lower t_max. Returns true to end. */
    bool (*ask)(struct rgi_beam *beam, uint32_t slot);
    void *query;
    /** For rays side by side: in which they go through meshes. NULL: meshes are asked as other objects. `enter` takes
     * a lane if the object is a mesh; `leave` looks what became of it, and returns true to end. */
    struct rgi_mesh_lanes *lanes;
    rgi_entered (*enter)(struct rgi_beam *beam, uint32_t slot);
    bool (*leave)(struct rgi_beam *beam, uint32_t lane);
    bool any;                /* any hit will do, and what is certain need not be asked */
    bool hit;                /* out: it has one that was not asked */
    float t_after, t_before; /* what is met between these is surely in range */
    uint32_t nodes;          /* counts nodes and blocks looked into */
    /* the walk */
    uint32_t depth;
    uint32_t waiting; /* bits of the objects of `block` that are to be asked */
    rgi_ref block;
    float t[RGI_BLOCK]; /* where each is met at the earliest */
    /* What is still to be looked into, and from where on along the ray. */
    rgi_ref refs[RGI_STACK];
    float ts[RGI_STACK];
} rgi_beam;

/** Fills all but ask, query and any; false if the ray passes all that is stored. */
bool rgi_beam_init(rgi_beam *beam, const rgi_lattice *lattice, const rgi_middle *middle, const rgi_ray *ray,
                   double t_max);

/** The same for the inside of a mesh. The largest component of the direction is no denormal number. */
bool rgi_beam_into_mesh(rgi_beam *beam, const rgi_mesh *mesh, const rgi_local_ray *ray);

/**
 * What a local direction is multiplied by inside of a mesh: the power of two that brings its largest component, which
 * is no denormal number, into [0.5, 1). So a t is not less than the way along any axis, and what errors are in units
 * of length are at most twice as much in those of t.
 */
static inline double rgi_mesh_unit(double largest) {
    uint64_t bits;
    double unit;
    memcpy(&bits, &largest, sizeof bits);
    bits = (0x7FDull - (bits >> 52)) << 52;
    memcpy(&unit, &bits, sizeof unit);
    return unit;
}

/** Begins the walk of a beam at a root. */
void rgi_beam_start(rgi_beam *beam, rgi_ref root);

/**
 * Up to RGI_PACKET rays, one a lane. Of each ray's nearest hit so far only bounds are known, t_lo to t_hi, as long as
 * they tell hits apart. Where they overlap, or where a hit is not certain, both are asked.
 */
typedef struct rgi_packet {
    float origin[3][RGI_PACKET] __attribute__((aligned(64))), direction[3][RGI_PACKET];
    float inverse[3][RGI_PACKET], near[3][RGI_PACKET], far[3][RGI_PACKET];
    float pad[RGI_PACKET];
    float t_min[RGI_PACKET];   /* a bound from above: what is beyond is in range */
    float t_first[RGI_PACKET]; /* and from below */
    float t_lo[RGI_PACKET], t_hi[RGI_PACKET];
    float best[RGI_PACKET];                       /* slots, as bits, of the hits that are certain but not asked yet */
    uint32_t found;                               /* bits of the rays that have asked and found something */
    uint32_t certain;                             /* bits of the rays that have one */
    uint32_t active;                              /* bits of the rays that are still on their way */
    bool any;                                     /* the first hit ends a ray */
    bool ask_all;                                 /* nothing is certain before it was asked */
    double shift[RGI_PACKET], length[RGI_PACKET]; /* see rgi_beam_scale */
    /** As rgi_beam; gives the bounds of the nearest hit so far, in the frame. Returns true to end the ray. */
    bool (*ask)(struct rgi_packet *packet, uint32_t ray, uint32_t slot);
    /** Asks about an object that is a mesh for some rays, named by bits; false: it is none, nothing was asked. */
    bool (*ask_mesh)(struct rgi_packet *packet, uint32_t rays, uint32_t slot);
    void *context;
    const rgi_bundle *bundle;
} rgi_packet;

/**
 * Packets that go the same way: all their rays run along one axis in the same sense, and between four planes, two
 * across each other axis. What none of them can meet is passed over for all at once.
 */
typedef struct rgi_frustum {
    rgi_packet *packets[RGI_PACKETS];
    uint32_t count;
    uint32_t visits;   /* nodes and blocks looked into */
    uint32_t patience; /* with more than so many it ends before it is through */
    /* the planes: x[across] - slope * x[axis], for rays between lo and hi */
    uint32_t axis, across[2];
    uint32_t far_of_hi[2], far_of_lo[2]; /* which end of a box along the axis counts for each plane: see end_of */
    uint32_t front, back;                /* and which the rays come to first and last */
    float sense;                         /* 1, or -1 if they run along the axis from high to low */
    float slope_lo[2], slope_hi[2], lo[2], hi[2];
    float norm_lo[2], norm_hi[2];  /* of the planes' normals */
    float start_first, start_last; /* along the axis: the origins lie between; first in the sense of the rays */
    float pad_most;
    uint32_t negative;
} rgi_frustum;

/** One ray of a packet on its own; ask, query and any are left. */
void rgi_beam_of_packet(rgi_beam *beam, const rgi_packet *packet, uint32_t ray, const rgi_lattice *lattice);

/** A bound from above for a t of the ray, in the frame. */
float rgi_beam_above(const rgi_beam_scale *scale, float pad, double t);
float rgi_beam_below(const rgi_beam_scale *scale, float pad, double t);

/** The kernels of one instruction set. */
struct rgi_kernels {
    const char *name;
    rg_isa isa;
    /** Makes a box hold all of a block. */
    void (*unite_block)(const rgi_block *block, float lo[3], float hi[3]);
    /** Scales the rays as rgi_ray_init; false if one is invalid, or extreme: then they are to be taken one by one. */
    bool (*prepare)(rgi_bundle *bundle);
    /** Brings prepared rays into the frame of a lattice. */
    void (*to_frame)(const rgi_bundle *bundle, const rgi_lattice *lattice, const rgi_middle *middle,
                     rgi_packet *packet);
    /** Whether the rays of the packets go the same way; then sets the planes that bound them, and begins. */
    bool (*bound)(rgi_frustum *frustum, const rgi_lattice *lattice, const rgi_middle *middle);
    /** Where the rays meet balls, to the same bits as rgi_object_intersect. */
    void (*meet)(const rgi_bundle *bundle, rgi_meeting *meeting);
    /** Takes one ray through the lattice. */
    void (*trace_one)(const rgi_lattice *lattice, rgi_beam *beam);
    /** Takes up to RGI_PACKET rays through side by side, each on its own way, so that waits for memory overlap. */
    void (*trace_some)(const rgi_lattice *lattice, rgi_beam *beams, uint32_t count);
    /** Takes packets through together. What is certain at its end has not been asked. If its patience has ended
     * before, those rays that are still active are to go on another way. */
    void (*trace_frustum)(const rgi_lattice *lattice, rgi_frustum *frustum);
    /** The same for two of them in turn. */
    void (*trace_frusta)(const rgi_lattice *lattice, rgi_frustum *one, rgi_frustum *other);
    /** Takes one ray through a mesh. */
    void (*mesh_one)(struct rgi_mesh_ray *ray);
    /** Brings the rays of a bundle into the local frame of an object that is a mesh, and into that of the mesh.
     * Returns the bits of those that do not pass it by. */
    uint32_t (*mesh_enter)(const rgi_bundle *bundle, const struct rgi_object *object, const rgi_linear *linear,
                           struct rgi_mesh_packet *packet);
    /** Takes them through, if they go the same way; else false: nothing was done. */
    bool (*mesh_packet)(struct rgi_mesh_packet *packet);
    /** Takes them through, each its own way: the active ones of all rows. */
    void (*mesh_apart)(struct rgi_mesh_lanes *lanes);
    /** Finds the plane between bins that parts the items of a mesh at the least cost; `fill`: items of a leaf. */
    void (*find_split)(const struct rgi_wrap *items, uint32_t count, const struct rgi_wrap *centres,
                       const float scales[3], uint32_t bins, uint32_t fill, struct rgi_cut *best);
    /** Brings the items of the left side to the front, with room for as many in `spare`. Returns how many; and the
     * boxes of twice the centres of each side. */
    uint32_t (*part_items)(struct rgi_wrap *items, struct rgi_wrap *spare, uint32_t count,
                           const struct rgi_wrap *centres, const float scales[3], const struct rgi_cut *cut,
                           struct rgi_wrap *left, struct rgi_wrap *right);
    /** Brings `left` of at most RGI_FEW_ITEMS items to the front: those with the least centres along the axis where
     * that costs least. */
    void (*part_few)(struct rgi_wrap *items, struct rgi_wrap *spare, uint32_t count, uint32_t left);
    /** Makes items of triangles, or of runs of them. */
    void (*wrap_items)(const struct rgi_making *making);
    /** The box of a leaf whose vertices are new, without a pad; sets what follows from them, and adds them to how far
     * those of all leaves reach. */
    void (*measure_leaf)(const struct rgi_mesh *mesh, void *leaf, struct rgi_reaches *reaches, float lo[3],
                         float hi[3]);
};

extern const rgi_kernels rgi_kernels_portable;
#if defined(__x86_64__)
extern const rgi_kernels rgi_kernels_sse2, rgi_kernels_avx2, rgi_kernels_avx512;
#elif defined(__aarch64__)
extern const rgi_kernels rgi_kernels_neon;
#endif

/** The best kernels that this processor can run. */
const rgi_kernels *rgi_kernels_best(void);

#endif
