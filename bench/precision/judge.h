/* SPDX-License-Identifier: MIT */
/*
 * judge.h: answers held against brute force. Of each ray, a quick pass in double over all bodies finds those that it
 * may meet, with a lot to spare; tests/reference decides among them.
 */
#ifndef RAYGRID_BENCH_PRECISION_JUDGE_H
#define RAYGRID_BENCH_PRECISION_JUDGE_H

#include "scenes.h"

#include <reference.h>

struct judge;

/** Of bodies that have these ids; both must outlive it. `bound` NULL: what raygrid/trace.h promises. */
struct judge *judge_create(const struct bench_scene *bodies, const rg_object *ids, const reference_bound *bound);
void judge_destroy(struct judge *judge);

/** The bodies that the ray may meet, as a scene that holds until the next call. */
const reference_scene *judge_near(struct judge *judge, const rg_ray *ray);

#endif
