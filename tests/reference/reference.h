/* SPDX-License-Identifier: MIT */
/*
 * reference.h: a second opinion on every hit, by testing every object in `long double`.
 *
 * It shares no code and no data structure with the library: of the public headers it uses only the plain types
 * (poses, rays, hits), and it links nothing of them. What it promises rests on a 64-bit mantissa (x87) or better;
 * where long double is the same as double it still compiles and runs, but its own rounding then comes near the bounds
 * of trace.h, most of all for linear parts of high condition, and its verdicts there mean nothing. Compiled with
 * REFERENCE_QUAD it computes with the 113 bits of __float128, much slower: then even an error of a thousandth of an
 * ulp of double can be told.
 *
 * How a far ray keeps its digits: for each object the ray's origin is first moved along the ray to the point nearest
 * to that object, with the products and sums of that one step carried in twice the digits. All that follows has the
 * size of the object, so distances cost nothing.
 *
 * A scene may be traced by several threads at once while nobody changes it. Running out of memory ends the process:
 * this is for tests, benchmarks and the demo alone.
 */
#ifndef RAYGRID_REFERENCE_H
#define RAYGRID_REFERENCE_H

#include <raygrid/raygrid.h>
#include <stdbool.h>

#ifdef REFERENCE_QUAD
__extension__ typedef __float128 reference_real;
#else
typedef long double reference_real;
#endif

typedef struct reference_scene reference_scene;

/** A shape; belongs to the scene that made it and lives as long as it. */
typedef struct reference_shape reference_shape;

reference_scene *reference_create(void);
void reference_destroy(reference_scene *scene);

/* The same meaning and the same numbers as those of raygrid/shape.h; nothing is checked. */
const reference_shape *reference_sphere(reference_scene *scene, double radius);
const reference_shape *reference_box(reference_scene *scene, const double lo[3], const double hi[3]);
const reference_shape *reference_capsule(reference_scene *scene, const double a[3], const double b[3], double radius);

/** `vertices` are x, y, z one after another; three `indices` a triangle. Both are copied. */
const reference_shape *reference_mesh(reference_scene *scene, const double *vertices, size_t vertex_count,
                                      const uint32_t *indices, size_t triangle_count);

/* Objects go by the id that the library gave them. Inserting a known id or naming an unknown one is a mistake of the
 * test and ends it. */
void reference_insert(reference_scene *scene, rg_object object, const reference_shape *shape, const rg_pose *pose,
                      uint32_t mask);
void reference_move(reference_scene *scene, rg_object object, const rg_pose *pose);
void reference_set_mask(reference_scene *scene, rg_object object, uint32_t mask);
void reference_remove(reference_scene *scene, rg_object object);

/** Inserts an object of another scene, as it is there, at the cost of copying it. Its shape stays that scene's. */
void reference_share(reference_scene *scene, const reference_scene *from, rg_object object);

/** Removes all objects. Shapes stay. */
void reference_clear(reference_scene *scene);

bool reference_has(const reference_scene *scene, rg_object object);
size_t reference_count(const reference_scene *scene);

/** The ids in no order that means anything: index < reference_count. */
rg_object reference_object(const reference_scene *scene, size_t index);
const rg_pose *reference_pose(const reference_scene *scene, rg_object object);
uint32_t reference_mask(const reference_scene *scene, rg_object object);

/** Writes the smallest world box that holds the object, rounded to double (so it may be half an ulp too small). */
void reference_bounds(const reference_scene *scene, rg_object object, double lo[3], double hi[3]);

/** A hit. For a miss: object RG_NO_OBJECT, t +infinity, primitive RG_NO_PRIMITIVE. */
typedef struct reference_hit {
    reference_real t; /* in units of the direction's length */
    rg_object object;
    uint32_t primitive;
    reference_real normal[3]; /* world, outward, length 1 */
    reference_real cosine;    /* of the angle between direction and normal: negative on fronts */
    reference_real u, v;
} reference_hit;

/** Whether the ray is one at all, by the rules of raygrid/trace.h. */
bool reference_valid(const rg_ray *ray);

/** The closest hit; returns whether there is one. Invalid rays have none. */
bool reference_trace(const reference_scene *scene, const rg_ray *ray, rg_cull cull, reference_hit *hit);

bool reference_occluded(const reference_scene *scene, const rg_ray *ray, rg_cull cull);

/** The closest hit of one shape in its local frame: fits rg_user_shape.intersect. Returns 1 or 0. */
int32_t reference_intersect(const reference_shape *shape, const rg_local_ray *ray, rg_local_hit *hit);

/* ----------------------------------------------------------------------------------------------- verdicts */

/**
 * How far off an answer may be: the surface of an object by `radius` of its world radius (times the condition of its
 * linear part), `way` of its distance, and `length`; t by `t` of the distance more. trace.h promises 2^-40, 2^-100, 0
 * and 2^-50: of D > 2^60 R it says nothing. A scene judges by that, unless it is told otherwise before objects are
 * inserted.
 */
typedef struct reference_bound {
    double radius, way, length, t;
} reference_bound;

void reference_set_bound(reference_scene *scene, const reference_bound *bound);

typedef enum reference_verdict {
    REFERENCE_EQUAL,
    /**
     * Not the same answer, but the ray passes a silhouette, an edge or a tie so closely that the bound of trace.h
     * allows it: the ray, moved aside by no more than the bound, does hit what was reported where it was reported,
     * and nothing that all of the rays so moved hit lies before it.
     */
    REFERENCE_WITHIN_BOUND,
    REFERENCE_WRONG
} reference_verdict;

/** How far off a hit was. Zero for misses. */
typedef struct reference_error {
    reference_real t;       /* |t - exact t| in world length */
    reference_real t_bound; /* what trace.h allows it to be */
    reference_real normal;  /* length of the difference to the exact normal */
    const char *what;       /* for REFERENCE_WRONG: which rule was broken; otherwise "" */
} reference_error;

/** Judges a hit of the library: object, primitive, t, normal, u, v, position and the marks of misses and invalid
 *  rays. `error` may be NULL. */
reference_verdict reference_compare(const reference_scene *scene, const rg_ray *ray, rg_cull cull, const rg_hit *got,
                                    reference_error *error);

/** The same for who tells no more than which object is hit at which t: of `got` nothing else is judged. */
reference_verdict reference_compare_place(const reference_scene *scene, const rg_ray *ray, const rg_hit *got,
                                          reference_error *error);

/** Judges the answer to an occluded query. */
reference_verdict reference_compare_occluded(const reference_scene *scene, const rg_ray *ray, rg_cull cull, bool got);

#endif
