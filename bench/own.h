/* SPDX-License-Identifier: MIT */
/* own.h: raygrid's side. Failures of the library end the benchmark. */
#ifndef RAYGRID_BENCH_OWN_H
#define RAYGRID_BENCH_OWN_H

#include "rays.h"

struct own {
    const struct bench_scene *bodies;
    rg_scene *scene;
    rg_shape **shapes;
    rg_object *objects;     /* of each body */
    uint32_t *body_of_slot; /* the body in each slot of the scene */
    uint32_t slots;         /* room in body_of_slot */
    double filling;         /* seconds that inserting all bodies took */
};

/** A scene with all of `bodies`, which must outlive it, inserted at once. */
struct own *own_create(const struct bench_scene *bodies, uint32_t workers);
void own_destroy(struct own *own);

/** The same in two steps: without a body in it, with such a grid (NULL: the default); then all inserted at once. */
struct own *own_create_empty(const struct bench_scene *bodies, uint32_t workers, const rg_grid_config *grid);
void own_fill(struct own *own);

/** The rays where they lie. */
rg_ray_views own_ray_views(const struct bench_rays *rays);

/** Traces the rays with `a_call` rays a call, reading and writing the arrays by views. */
void own_trace(struct own *own, const struct bench_rays *rays, uint32_t a_call, const struct bench_answers *answers);

/** A mesh where it lies; how it is made. */
rg_mesh_views own_mesh_views(const struct bench_mesh *mesh);
rg_shape_config own_mesh_config(rg_mesh_quality quality);

/** The body with that id, UINT32_MAX for none. */
uint32_t own_body(const struct own *own, uint64_t id);

/** Puts a body into the scene, where it must not be; removes one. */
void own_insert(struct own *own, uint32_t body);
void own_remove(struct own *own, uint32_t body);

/** For those who insert bodies themselves, own->objects[body]: the shape, and what is to be noted afterwards. */
rg_shape *own_shape_of(const struct own *own, uint32_t body);
void own_remember(struct own *own, uint32_t body);

/**
 * Lets the objects of a shape have the vertices that its mesh has got meanwhile; the shape before is given back, as a
 * host does. Returns the seconds; `quality` as of a mesh that is made.
 */
double own_deform(struct own *own, int shape, rg_mesh_quality quality);

/** Moves objects in one call. */
void own_move_many(struct own *own, const rg_object *objects, double (*positions)[3], uint32_t count);

/** The scene and its shapes. */
double own_bytes_per_object(const struct own *own);

/** What is known of the scene's grid; what its kind is called. */
rg_grid_report own_grid_report(const struct own *own);
const char *own_kind_name(rg_grid_kind kind);

/** Prints what was wrong and ends the benchmark, unless the result is RG_OK. */
void own_check(rg_result result);

#endif
