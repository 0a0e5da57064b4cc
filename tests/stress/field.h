/* SPDX-License-Identifier: MIT */
/*
 * field.h: a scene of balls on a square lattice, each with a ray of its own that must hit it, of every second one
 * from the side, at the very place where it is: for tests of what may happen to a scene as a whole.
 */
#ifndef RAYGRID_TESTS_STRESS_FIELD_H
#define RAYGRID_TESTS_STRESS_FIELD_H

#include "common.h"

enum { FIELD = 4096 };

struct field {
    struct books books;
    rg_scene *scene;
    rg_shape *ball;
    rg_object objects[FIELD];
    double x[FIELD]; /* where each is */
};

void field_begin(struct field *field, rg_grid_kind kind, uint32_t workers);

/** Moves all to about x. */
void field_move(struct field *field, double x);

/** Moves them away, again and again, until the grid is being rebuilt, or, by workers, has been. */
void field_move_until_rebuilding(struct field *field);

/** Traces the rays of all, in one call, and demands that each hits its ball. */
void field_check(const struct field *field);

/** In two steps: the rays to the balls where they are now; whether the hits are those that they must be. */
void field_rays(const struct field *field, rg_ray rays[FIELD]);
bool field_is_right(const struct field *field, const rg_hit hits[FIELD]);

/** Destroys the scene, and demands that nothing is left. */
void field_end(struct field *field);

#endif
