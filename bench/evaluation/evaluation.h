/* SPDX-License-Identifier: MIT */
/*
 * evaluation.h: the experiments of E. Reinhard, B. Smits, C. Hansen, "Dynamic Acceleration Structures for Interactive
 * Ray Tracing" (Eurographics Workshop on Rendering 2000), made again. docs/evaluation.md reads the results.
 *
 * Each experiment appends records to an array of the report. A figure stands beside how many answers of the same
 * pictures were held against brute force in long double, and how many of these were wrong.
 */
#ifndef RAYGRID_BENCH_EVALUATION_H
#define RAYGRID_BENCH_EVALUATION_H

#include "animation.h"
#include "verdict.h"

#include <jansson.h>

/** How much is done. */
struct evaluation_effort {
    const char *name;
    int side;                                        /* of all pictures, in rays */
    int turns;                                       /* of each entrant, in turn; its least time counts */
    double checks;                                   /* about so many brute-force tests for each picture */
    uint32_t finest;                                 /* resolution tried: 8, 16, ... up to it */
    uint32_t flake, crowd, equal;                    /* bodies of the scenes in (a) and (b), and of equal in (d) */
    uint32_t most, most_meshes;                      /* (e): bodies of the largest scenes */
    int frames, runs;                                /* (c): of an animation, and how often it is shown */
    uint32_t shown_flake, shown_crowd, shown_escape; /* (c): bodies */
    uint32_t goal;                                   /* bodies of the frames that are to come 30 a second */
};

struct evaluation {
    struct evaluation_effort effort;
    struct peer_choice peer;
    bool spoil; /* spoil raygrid's answers before they are judged: a test of the judge */
    int wrong;  /* of raygrid's answers so far */
    json_t *report;
};

/** (a), (b): rates of frames and of updates with each resolution of the grid. */
void evaluate_resolutions(struct evaluation *evaluation);

/** (c): an animation that outgrows its first box, frame by frame. */
void evaluate_shows(struct evaluation *evaluation);

/** (d): inserting and removing objects of each size. */
void evaluate_sizes(struct evaluation *evaluation);

/** (e): the same as (a) and (b) with more and more objects, the grids left to choose. */
void evaluate_counts(struct evaluation *evaluation);

/** Frames with primary and shadow rays of two threads while a tenth of all spheres moves. */
void evaluate_goal(struct evaluation *evaluation);

/** {"checked", "wrong"} of raygrid's answers, or of the peer's. */
json_t *evaluation_judge_own(struct evaluation *evaluation, struct exact_sample *sample, const struct own *own,
                             const struct bench_answers *answers);
json_t *evaluation_judge_peer(struct exact_sample *sample, const struct peer *peer,
                              const struct bench_answers *answers);

/** The same of a sample made for it, of the bodies where they are now, with that share of the usual effort. */
json_t *evaluation_check_own(struct evaluation *evaluation, const struct own *own, const struct bench_rays *rays,
                             const struct bench_answers *answers, double share);

/** The array of that name in the report. */
json_t *evaluation_array(struct evaluation *evaluation, const char *name);

/** JSON knows no NaN: what was not measured is null. */
json_t *evaluation_number(double x);

#endif
