/* SPDX-License-Identifier: MIT */
/*
 * raygrid/shape.h: shapes, the geometry that objects share.
 *
 * A shape belongs to no scene: any number of objects, in any number of scenes, may use it at once. It never changes
 * after creation. It is counted by reference: creation gives the caller one reference, each object holds one, and
 * the shape is destroyed with the last. So a caller who has inserted its objects may release its own at once.
 *
 * All coordinates here are local to the shape, in double. Shapes are surfaces: a ray that starts inside hits the far
 * side. The geometric normal points outward (for a triangle: to the side from which its corners run
 * counter-clockwise in a right-handed frame). A ray meets the front of a surface when it runs against the normal.
 *
 * Thread rule: all functions here may be called from any thread at any time.
 */
#ifndef RAYGRID_SHAPE_H
#define RAYGRID_SHAPE_H

#include <raygrid/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** No coordinate, length or position may be larger than this in magnitude, so that no product overflows. */
#define RG_COORDINATE_MAX 1e100

/** No radius may be smaller than this, so that no product underflows. */
#define RG_RADIUS_MIN 1e-100

/** A shape. Opaque; counted by reference. */
typedef struct rg_shape rg_shape;

/** How much is done for rays when a mesh is made. */
typedef int32_t rg_mesh_quality;

enum {
    RG_MESH_BEST = 0, /* what rays go through fastest */
    RG_MESH_FAST = 1  /* what is made fastest: for meshes of which few rays are asked before they change */
};

/** How a shape is made. NULL in place of it means all defaults. */
typedef struct rg_shape_config {
    size_t size;
    /** Where the shape's memory comes from; both functions NULL: malloc. Copied. */
    rg_allocator allocator;
    /** Of meshes: how much time their making may take. */
    rg_mesh_quality quality;
    /** Threads that make a mesh together, the calling one among them: 0 or 1 for the calling thread alone, at most
     *  1024. They end before the call does. Ignored with parallel_for. */
    uint32_t workers;
    /** The host's job system in place of threads. NULL: none. */
    rg_parallel_for parallel_for;
    void *parallel_for_user;
} rg_shape_config;

/**
 * Fills `config` with the defaults; `size` is sizeof(rg_shape_config) at the caller's.
 * RG_INVALID_ARGUMENT: config is NULL or the size unknown.
 */
RG_API rg_result rg_shape_config_default(rg_shape_config *config, size_t size);

/**
 * A sphere around the local origin. `radius` in [RG_RADIUS_MIN, RG_COORDINATE_MAX]; a radius of 0 is refused.
 * Hits: primitive 0, u = v = 0.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_OUT_OF_MEMORY. Cost: one allocation.
 */
RG_API rg_result rg_shape_create_sphere(const rg_shape_config *config, double radius, rg_shape **shape);

/**
 * A box with its faces in the local axes' planes, from corner `lo` to corner `hi`, lo <= hi on each axis. It may have
 * no thickness (lo == hi), and may be infinite (lo -inf, hi +inf, or both), on any axis; an infinite axis needs a
 * pose whose linear part is the identity. Edges and corners belong to the box. Hits: primitive 0 to 5 for the faces
 * -x, +x, -y, +y, -z, +z: the face by which the ray enters the box (leaves it, if that is the hit), the lowest of
 * those where it does so at an edge or corner; u = v = 0. Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE,
 * RG_OUT_OF_MEMORY. Cost: one allocation.
 */
RG_API rg_result rg_shape_create_box(const rg_shape_config *config, const double lo[3], const double hi[3],
                                     rg_shape **shape);

/**
 * A capsule: all points within `radius` of the segment from `a` to `b` (which may be one point).
 * Hits: primitive 0, u = v = 0.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_OUT_OF_MEMORY. Cost: one allocation.
 */
RG_API rg_result rg_shape_create_capsule(const rg_shape_config *config, const double a[3], const double b[3],
                                         double radius, rg_shape **shape);

/** The triangles of a mesh. Zero it, set the size, then what is given. */
typedef struct rg_mesh_views {
    size_t size;
    /** Positions of the vertices, RG_F32 or RG_F64. */
    rg_input3 vertices;
    uint64_t vertex_count;
    /**
     * The three vertex indices of each triangle, RG_U16, RG_U32 or RG_U64. Not given: triangle i has the vertices
     * 3i, 3i+1 and 3i+2, and triangle_count must be vertex_count / 3.
     */
    rg_input3 indices;
    uint64_t triangle_count;
    /**
     * NULL: the data is read while the mesh is made, what it needs of it later is copied. Else that is borrowed, read
     * where the views say for as long as it takes: the vertices, if not all are floats or if they are of extreme size
     * (see the cost of rg_shape_create_mesh), and the indices, if triangles share hardly any vertices. No answer
     * depends on it.
     *
     * What all views of the call show must then stay there, and stay as it is, until `released` is called: once, as
     * soon as nothing reads it any more. Where nothing is needed later that is in the call that makes the mesh,
     * just before it returns; else when the last reference has gone, by the thread that gave it back, as
     * rg_user_shape.destroy is called. Who has references: the host, objects (those of frames, too, until these are
     * brought up to date), and a recording until it ends. If the call fails, `released` is not called and nothing is
     * read any more. Should the data change all the same, hits of this mesh may be wrong, but no other memory is
     * read.
     */
    void (*released)(void *user);
    /** Handed to `released`. */
    void *user;
} rg_mesh_views;

/**
 * A triangle mesh. The data is copied, unless the views lend it (rg_mesh_views.released). At least one triangle,
 * fewer than 2^31 triangles and 2^32 - 1 vertices. Triangles without area are kept, so that primitive numbers hold,
 * and are never hit. Hits: primitive = number of the triangle; u and v the barycentric weights of its second and
 * third corner. Watertight: a ray at a shared edge or vertex of a closed mesh always hits one of the triangles that
 * share it. Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE (a vertex that is not finite or beyond RG_COORDINATE_MAX,
 * an index without a vertex; the message names its number), RG_LIMIT_EXCEEDED, RG_OUT_OF_MEMORY, RG_OUT_OF_THREADS.
 * Cost: O(n log n) for n triangles; while it is made up to 350 bytes a triangle. What it holds of a triangle: some 30
 * bytes where triangles share vertices, 50 where they do not, 62 where these have indices; and 24 bytes a vertex if
 * not all are floats, given in whichever type, or if the largest coordinate is beyond 2^40 or below 2^-40. The 24
 * bytes, and 12 of the 62, are what it borrows if it may.
 */
RG_API rg_result rg_shape_create_mesh(const rg_shape_config *config, const rg_mesh_views *views, rg_shape **shape);

/**
 * A mesh of the triangles of another one with new vertices, for meshes that change their form: made much faster than
 * by rg_shape_create_mesh. Of `views` only the vertices are read, as many as `mesh` has, and copied or borrowed: the
 * triangles are those of `mesh`, which stays as it is and may be released afterwards with all that it has borrowed;
 * rg_scene_replace_shape puts the new one in its place.
 * What finds the triangles is taken over and fitted, unless triangles have moved so much against each other, in this
 * and earlier such steps, that rays would cost half as much again: then it is made anew, as config says. No answer
 * depends on which of the two. Errors: as rg_shape_create_mesh; RG_INVALID_ARGUMENT: `mesh` is no mesh;
 * RG_INVALID_VALUE: another number of vertices. Cost: linear.
 */
RG_API rg_result rg_shape_create_deformed(const rg_shape_config *config, const rg_shape *mesh,
                                          const rg_mesh_views *views, rg_shape **shape);

/** A ray as a user-defined shape sees it: origin + t * direction, in the shape's local frame. */
typedef struct rg_local_ray {
    double origin[3];
    double direction[3]; /* any length but 0 */
    double t_min, t_max; /* hits with t_min <= t <= t_max may count; the library checks the last bits itself */
} rg_local_ray;

/** What a user-defined shape reports of a hit. */
typedef struct rg_local_hit {
    double t;
    double normal[3]; /* outward, of any length but 0, in the local frame */
    double u, v;
    uint32_t primitive;
} rg_local_hit;

/**
 * A shape that the host intersects. The callbacks may be called from several threads at once; they may trace (any
 * scene) but must not change a scene in which the shape is used: such calls return RG_BUSY.
 */
typedef struct rg_user_shape {
    size_t size;
    /** Handed to each callback. */
    void *user;
    /** The local box that holds the shape, lo <= hi, finite. */
    double lo[3], hi[3];
    /**
     * Finds the hit with the smallest t in [ray->t_min, ray->t_max]. Returns 1 and fills all of `hit`, or 0 for none
     * (`hit` is then ignored), or a negative number for a failure: the trace then returns RG_CALLBACK_FAILED. A t
     * outside the range counts as none. Where a hit does not count (culling, a filter), it is called again with t_min
     * just beyond it; more than 1024 such hits of one ray count as a failure. The ray it sees may have its origin
     * moved along it and its direction scaled by a power of two, t_min and t_max with them, so that nothing loses
     * precision far away. Required.
     */
    int32_t (*intersect)(void *user, const rg_local_ray *ray, rg_local_hit *hit);
    /** Whether there is any hit in the range; the same returns. NULL: intersect is asked. */
    int32_t (*occluded)(void *user, const rg_local_ray *ray);
    /** Called once when the last reference has gone, by the thread that gave it back, when the call of it on a scene
     * is done: it may use any scene but one that is being destroyed. May be NULL. */
    void (*destroy)(void *user);
} rg_user_shape;

/**
 * A user-defined shape. `definition` is copied; what `user` points at must live until destroy was called. If the call
 * fails, destroy is not called.
 * Errors: RG_INVALID_ARGUMENT, RG_INVALID_VALUE, RG_OUT_OF_MEMORY. Cost: one allocation.
 */
RG_API rg_result rg_shape_create_user(const rg_shape_config *config, const rg_user_shape *definition,
                                      rg_shape **shape);

/** What kind of geometry a shape is. */
typedef int32_t rg_shape_kind;

enum { RG_SHAPE_SPHERE = 0, RG_SHAPE_BOX = 1, RG_SHAPE_CAPSULE = 2, RG_SHAPE_MESH = 3, RG_SHAPE_USER = 4 };

/** What is known of a shape. Set `size` before the call; the library fills what both sides know. */
typedef struct rg_shape_report {
    size_t size;
    rg_shape_kind kind;
    double lo[3], hi[3];     /* the local box that holds it */
    uint64_t triangle_count; /* meshes: of the triangles; others: 0 */
    uint64_t bytes;          /* memory it holds */
} rg_shape_report;

/** Fills `report`. RG_INVALID_ARGUMENT: a NULL pointer or an unknown size. */
RG_API rg_result rg_shape_stats(const rg_shape *shape, rg_shape_report *report);

/** Adds a reference. NULL is ignored. */
RG_API void rg_shape_retain(rg_shape *shape);

/** Gives one reference back and sets the pointer to NULL. NULL, or a pointer to NULL, is ignored. */
RG_API void rg_shape_release(rg_shape **shape);

#ifdef __cplusplus
}
#endif
#endif
