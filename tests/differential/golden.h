/* SPDX-License-Identifier: MIT */
/*
 * golden.h: scenes and rays as plain data, the same bits on every machine: nothing but +, -, *, / and square roots
 * goes into them.
 */
#ifndef RAYGRID_TESTS_GOLDEN_H
#define RAYGRID_TESTS_GOLDEN_H

#include "batches.h"

#include <raygrid/raygrid.h>
#include <stdbool.h>
#include <stdint.h>

enum { GOLDEN_SHAPES = 12, GOLDEN_OBJECTS = 4000, GOLDEN_RAYS = 12000 };

typedef struct golden_set {
    const char *name;
    /** Objects may lie exactly in one place, so that the order of ids decides. */
    bool ties;
    int objects, rays;
    int least_decade, most_decade; /* of the sizes, as powers of ten */
    bool balls;                    /* spheres alone; else all shapes */
    bool round;                    /* places and rays are small whole numbers */
    bool masked;                   /* some objects are seen by some rays only */
    batch_space space;
    /** Of all fields of all answers, in the order of the rays: what every machine must get. */
    uint64_t hash;
} golden_set;

extern const golden_set GOLDEN_SETS[];
extern const int GOLDEN_SET_COUNT;

typedef struct golden_data {
    const golden_set *set;
    int objects, rays; /* how many */
    rg_shape *shapes[GOLDEN_SHAPES];
    int shape_count;
    int shape_of[GOLDEN_OBJECTS];
    rg_pose poses[GOLDEN_OBJECTS];
    uint32_t masks[GOLDEN_OBJECTS];
    rg_ray ray[GOLDEN_RAYS];
} golden_data;

/** Makes the data of a set. */
void golden_make(golden_data *data, const golden_set *set);
void golden_release(golden_data *data);

/** The hash of the answers; `object` of hits is the number of the object, from 1. NaN is NaN, whatever its bits. */
uint64_t golden_hash(const rg_hit *hits, const uint8_t *occluded, int count);

/** Ends the process if a call failed. */
void golden_demand(rg_result result, const char *call);

#endif
