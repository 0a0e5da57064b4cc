/* SPDX-License-Identifier: MIT */
/*
 * exact.h: how wrong the answers are, against brute force in long double (tests/reference).
 *
 * A sample of each set of rays is held against every body. The answer to a ray is wrong if no ray within the
 * tolerance has it: it names a body that even a slightly larger one in its place would not show there, or lets a
 * slightly smaller body pass that lies before it. By how much larger and smaller:
 *   - raygrid is held to what raygrid/trace.h promises: 2^-40 of the body's radius and 2^-50 of the distance;
 *   - a peer that computes in float is given four roundings of a float, of the radius and the distance together.
 */
#ifndef RAYGRID_BENCH_EXACT_H
#define RAYGRID_BENCH_EXACT_H

#include "rays.h"

enum exact_tolerance { EXACT_PROMISED, EXACT_FLOAT };

struct exact_error {
    int checked, wrong;
    double
        worst_t; /* of right closest hits: |t - exact t|, in parts of t or, if that is more, of the body's radius */
};

struct exact;

/** Brute force over bodies that lie at `positions` (NULL: where the scene has them). Both must outlive it. */
struct exact *exact_create(const struct bench_scene *bodies, double (*positions)[3]);
void exact_destroy(struct exact *exact);

/** The right answers to a sample of a set of rays. */
struct exact_sample;

/** `effort`: about so many tests of a ray against a body. */
struct exact_sample *exact_sample_create(struct exact *exact, const struct bench_rays *rays, double effort);
void exact_sample_destroy(struct exact_sample *sample);

/** Names the body of a side's id, UINT32_MAX for none. */
typedef uint32_t exact_body(const void *side, uint64_t id);

struct exact_error exact_judge(struct exact_sample *sample, const struct bench_answers *answers, exact_body *body_of,
                               const void *side, enum exact_tolerance tolerance);

/** Makes every answer of the sample wrong, in turn in each way that there is: judging must notice each. */
void exact_spoil(const struct exact_sample *sample, const struct bench_answers *answers);

#endif
