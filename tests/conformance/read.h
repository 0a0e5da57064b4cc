/* SPDX-License-Identifier: MIT */
/*
 * Values of case files. Whatever is not as the schema says makes the case malformed (context.h); a reader then
 * returns zeros, and callers look at context.broken before they act.
 */
#ifndef CONFORMANCE_READ_H
#define CONFORMANCE_READ_H

#include "context.h"

/** Every key of the object must be among the words. */
void read_known_keys(context *c, const json_t *object, const char *words);

/** A JSON number, "inf", "-inf", "nan", or the bits "x" + 16 (double) or 8 (float) hex digits. */
double read_number(context *c, const json_t *value);

/** The vector at a key, `count` numbers. */
void read_numbers(context *c, const json_t *object, const char *key, size_t count, double *out);
void read_vector(context *c, const json_t *value, double out[3]);

/** A whole number from 0 to `most`; `missing` if there is no such key. */
uint64_t read_integer(context *c, const json_t *object, const char *key, uint64_t most, uint64_t missing);

const char *read_text(context *c, const json_t *object, const char *key);

/** The array at a key; NULL, after a complaint, if there is none. */
const json_t *read_array(context *c, const json_t *object, const char *key);

/** The id that a reference to an object means: a name, a name with an index, or {"id": ...}. */
rg_object read_object(context *c, const json_t *value);
rg_shape *read_shape(context *c, const char *name);

/** "scene" is the scene's own grid. */
rg_grid read_grid(context *c, const json_t *object, const char *key);

/** A pose of "position" and "linear"; the identity if there is no linear part. */
rg_pose read_pose(context *c, const json_t *object);

/** A grid's configuration on top of the defaults; its kind is the set-up's if none is given. */
rg_grid_config read_grid_config(context *c, const json_t *object);

#endif
