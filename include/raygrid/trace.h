/* SPDX-License-Identifier: MIT */
/*
 * raygrid/trace.h: rays, hits, and the queries.
 *
 * trace finds the closest hit of each ray; occluded whether there is any. Each comes twice: on plain arrays of rg_ray
 * and rg_hit, and on views, where every field lies where the host likes and only what is asked for is computed. Both
 * take one ray or any number; calls of some hundred rays and more are spread over the scene's workers.
 *
 * Among hits at exactly the same t the lowest object id wins, then the lowest primitive. The answer does not depend
 * on the number of workers, on the other rays of the call, or on the order in which objects were inserted or moved.
 *
 * A ray is invalid if its origin is not finite or beyond RG_COORDINATE_MAX, its direction is not finite or zero,
 * t_min or t_max is NaN, or t_min > t_max. An invalid ray hits nothing, and is told from a miss: its t is NaN. Other
 * rays of the call are not touched by it; the call succeeds and counts it (rg_trace_config, rg_scene_report).
 *
 * Accuracy: let D be the distance from the ray's origin to an object and R the radius of the object around its
 * position (of an infinite box: that of its finite axes). Where a ray passes the surface's silhouette by more than
 * 2^-40 R, whether it hits is decided right, at any D up to 2^60 R and any distance of both from the world's origin;
 * t is within 2^-50 D + 2^-40 R / |cos| in world length, where cos is that of the angle between ray and normal
 * (linear parts of condition k: 2^-40 k). Normals are right to 2^-20 and what that error of t makes of them where the
 * surface is curved. docs/numerics.md has more.
 *
 * Thread rule: any number of threads at once, also while others change the scene. Nothing is allocated.
 * A call takes up to 128 KB of the calling thread's stack.
 */
#ifndef RAYGRID_TRACE_H
#define RAYGRID_TRACE_H

#include <raygrid/base.h>
#include <raygrid/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A ray: the points origin + t * direction with t_min <= t <= t_max. Distances t are in units of direction's length.
 */
typedef struct rg_ray {
    double origin[3];
    double direction[3]; /* any length but 0 */
    double t_min;        /* may be negative or -infinity */
    double t_max;        /* may be +infinity. What lies at a t beyond the largest double, or farther away than 2e102,
                            as only infinite boxes may, is not hit. */
    uint32_t mask;       /* sees objects with (object mask & mask) != 0 */
    uint32_t reserved;   /* ignored */
} rg_ray;

/** The ray from `origin` along `direction`: t from 0 to infinity, all mask bits set. */
RG_API rg_ray rg_ray_from(const double origin[3], const double direction[3]);

/** primitive of a ray that hit nothing. */
#define RG_NO_PRIMITIVE ((uint32_t)0xFFFFFFFF)

/** The closest hit of a ray. For a miss: object RG_NO_OBJECT, t +infinity (NaN for an invalid ray), primitive
 *  RG_NO_PRIMITIVE, all else 0. */
typedef struct rg_hit {
    double t; /* in units of the direction's length */
    rg_object object;
    double position[3]; /* of the hit, world: origin + t * direction, rounded once */
    float normal[3];    /* geometric, outward, length 1, world */
    float offset;       /* distance along the normal, to either side, from which a further ray of any direction that
                           leaves on that side does not hit the same spot of this object again; +infinity
                           where no float is large enough, beyond coordinates of 1e50 */
    float u, v;         /* barycentrics, see the shapes */
    uint32_t primitive; /* see the shapes */
    uint32_t reserved;  /* 0 */
} rg_hit;

/**
 * Closest hits of `count` rays. hits[i] belongs to rays[i].
 * Errors: RG_INVALID_ARGUMENT (a NULL pointer with count > 0), RG_LIMIT_EXCEEDED (count > 2^48), RG_CALLBACK_FAILED
 * (a user-defined shape failed: the rays concerned have t NaN, all others are complete).
 */
RG_API rg_result rg_scene_trace(rg_scene *scene, const rg_ray *rays, rg_hit *hits, uint64_t count);

/** Whether each ray hits anything: occluded[i] = 1 or 0; 0 for an invalid ray. Errors: as rg_scene_trace. */
RG_API rg_result rg_scene_occluded(rg_scene *scene, const rg_ray *rays, uint8_t *occluded, uint64_t count);

/** Rays where they lie. Zero it, set the size, then what is given. */
typedef struct rg_ray_views {
    size_t size;
    rg_input3 origin;    /* RG_F64 or RG_F32. Required. */
    rg_input3 direction; /* RG_F64 or RG_F32. Required. */
    rg_input t_min;      /* RG_F64 or RG_F32; not given: 0 */
    rg_input t_max;      /* RG_F64 or RG_F32; not given: +infinity */
    rg_input mask;       /* RG_U32; not given: all bits set */
} rg_ray_views;

/** Hits where they are wanted. Zero it, set the size, then what is wanted; the rest is not computed. */
typedef struct rg_hit_views {
    size_t size;
    rg_output t;         /* RG_F64 or RG_F32 */
    rg_output object;    /* RG_U64 */
    rg_output primitive; /* RG_U32 or RG_U64 */
    rg_output3 normal;   /* RG_F64 or RG_F32 */
    rg_output u, v;      /* RG_F64 or RG_F32 */
    rg_output3 position; /* RG_F64 or RG_F32 */
    rg_output offset;    /* RG_F64 or RG_F32 */
    rg_output cells;     /* RG_U32: cells that the ray looked into, all grids and levels */
    rg_output tests;     /* RG_U32: objects that the ray was tested against, repeats counted */
} rg_hit_views;

/** Which sides of surfaces rays hit. */
typedef int32_t rg_cull;

enum {
    RG_CULL_NONE = 0,
    RG_CULL_BACK = 1, /* only fronts: where the ray runs against the normal */
    RG_CULL_FRONT = 2 /* only backs */
};

/**
 * Decides on a possible hit of ray `index`: 1 accepts, 0 lets the ray pass through this surface, negative fails the
 * ray: the trace then returns RG_CALLBACK_FAILED. Called for candidates in any order, not only for the closest, and
 * possibly more than once for the same one; from several threads at once.
 */
typedef int32_t (*rg_filter)(void *user, uint64_t index, const rg_hit *candidate);

/** Whether rays that follow one another in a call go nearly the same way. No answer depends on it, only time. */
typedef int32_t rg_coherence;

enum {
    RG_COHERENCE_UNKNOWN = 0, /* looked at, 16 rays at a time */
    RG_COHERENCE_LOW = 1,     /* they do not, as rays of random directions: they are not looked at */
    RG_COHERENCE_HIGH = 2     /* they do, as rays from a camera or to a light, in small tiles: even if they spread */
};

/** How to trace. NULL in place of it means all defaults. */
typedef struct rg_trace_config {
    size_t size;
    rg_cull cull;
    rg_coherence coherence;
    rg_filter filter; /* NULL: all candidates count */
    void *filter_user;
    uint64_t *invalid; /* receives the number of invalid rays of this call; NULL: not wanted */
} rg_trace_config;

/** Fills `config` with the defaults. RG_INVALID_ARGUMENT: config is NULL or the size unknown. */
RG_API rg_result rg_trace_config_default(rg_trace_config *config, size_t size);

/** Closest hits by views. Errors: as rg_scene_trace; RG_INVALID_ARGUMENT for a view of a type that it can't have. */
RG_API rg_result rg_scene_trace_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                                      const rg_hit_views *hits, uint64_t count);

/** Any hit by views: `occluded`, RG_U8, receives 1 or 0; 0 for an invalid ray. Errors: as rg_scene_trace_views. */
RG_API rg_result rg_scene_occluded_views(rg_scene *scene, const rg_trace_config *config, const rg_ray_views *rays,
                                         const rg_output *occluded, uint64_t count);

#ifdef __cplusplus
}
#endif
#endif
