/* SPDX-License-Identifier: MIT */
/* figures.h: how wrong a side's answers are, counted and measured against brute force. */
#ifndef RAYGRID_BENCH_PRECISION_FIGURES_H
#define RAYGRID_BENCH_PRECISION_FIGURES_H

#include "judge.h"

#include <stdbool.h>

/** Of many values: the middle one, the one that 99 of 100 do not exceed, and the largest. NaN if there are none. */
struct spread {
    double median, most_of_100, largest;
};

struct figures {
    uint32_t judged;
    uint32_t hits;   /* of the exact answers */
    uint32_t wrong;  /* hits on what is not there, or not first, or not at that t: by more than the bound allows */
    uint32_t missed; /* misses of what is there, by more than the bound allows */
    uint32_t within; /* other answers than the exact one that the bound does allow */
    double of_bound; /* the worst error of t, in parts of the bound, where the right object was hit */
    struct spread t, normal; /* errors where the right object was hit: of t in ulp of its double, of the normal as the
                                length of the difference in ulp of a float just below 1 */
};

/**
 * Judges every `step`-th answer. `whole`: the full record, else object and t, and normals of either sign. `measure`:
 * t and normal are measured, too.
 */
struct figures figures_of(struct judge *judge, const rg_ray *rays, const rg_hit *hits, uint32_t count, uint32_t step,
                          bool whole, bool measure);

#endif
