/* SPDX-License-Identifier: MIT */
/* Trace steps: the rays of a step, all the ways to trace them, and what must come of it. */
#ifndef CONFORMANCE_TRACE_H
#define CONFORMANCE_TRACE_H

#include "read.h"

/** What a trace of some rays gave. */
typedef struct outcome {
    rg_hit *hits;
    uint32_t *cells, *tests;
} outcome;

/** The rays of a trace step. */
typedef struct batch {
    size_t count, invalid; /* rays, and those among them that the script calls invalid */
    rg_ray *rays;
    const json_t *lines; /* the script's rays, with what they must hit */
    const json_t *respawn;
    rg_cull cull;
    outcome first; /* by the first path; all others must give the same bits */
} batch;

bool outcome_make(outcome *o, size_t count);
void outcome_free(outcome *o);

/** Ends a batch; NULL is ignored. */
void batch_free(batch *b);

/** Traces the rays of a step by one call without any expectation. */
rg_result trace_once(context *c, const json_t *step);

/** Plays a trace step: checks the first path's outcome against the script, and all others' against the first's. */
void trace_play(context *c, const json_t *step);

/** Traces the last step's rays again: everything must be as it was. */
void trace_again(context *c);

/* paths.c */

/** Traces by views on doubles, an array for each field, everything asked for. Returns the library's result. */
rg_result path_separate(const context *c, const batch *b, outcome *o, uint64_t *invalid);

/** All other paths, each compared with b->first. */
void paths_play(context *c, const batch *b);

/* compare.c */

/** Compares an outcome with what the script expects, and with what holds for every hit. */
void compare_with_script(context *c, const batch *b, const outcome *o);

/** Compares two hits bit by bit; true if they are the same. */
bool same_hit(const rg_hit *a, const rg_hit *b);

/** One line about a hit, in hex and decimal; two texts hold at a time. */
const char *hit_text(const context *c, const rg_hit *hit);

#endif
