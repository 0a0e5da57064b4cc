/* SPDX-License-Identifier: MIT */
/*
 * lanes.h: objects that tell which of their many states a ray has seen.
 *
 * Each object has a lane along x of its own; the rays of that lane meet nothing else. Its states are numbered, and
 * where it is in each follows from lane and number alone: so a hit is a cookie that names a state. The one thread
 * that changes a lane says before each change that it begins, and after it that it is done. A ray that was traced
 * between two looks at these numbers must have seen a state that the object had at some instant between: none that
 * was over before the call began, none that came after, and never none at all.
 */
#ifndef RAYGRID_TESTS_STRESS_LANES_H
#define RAYGRID_TESTS_STRESS_LANES_H

#include "common.h"

enum {
    LANES = 768,
    STILL = 64, /* the first lanes hold what never changes */
    IDS = 32    /* of each lane that are remembered */
};

enum lane_state { LANE_EMPTY, LANE_HIDDEN, LANE_SEEN };

struct lane {
    uint64_t begun, done; /* atomic: the numbers of states; equal, unless a change is under way */
    uint64_t ids[IDS];    /* atomic: of inserted objects, in a ring, and the state that each was inserted with */
    uint64_t since[IDS];
    uint64_t inserts; /* atomic: so many were inserted */
    rg_object object; /* the writer's: what is there now; 0 for nothing */
};

struct lanes {
    rg_scene *scene;
    rg_grid still_grid; /* where the first are */
    rg_shape *shapes[4];
    bool masks; /* some states are hidden by a mask */
    uint64_t seed;
    struct lane all[LANES];
};

/** The masks of rays and of hidden objects. */
enum { RAY_MASK = 1, HIDDEN_MASK = 2 };

/** What there is in a lane's state; where, if it is not empty. */
enum lane_state lane_state_of(const struct lanes *lanes, int lane, uint64_t number);
double lane_x(const struct lanes *lanes, int lane, uint64_t number);

/** Fills the lanes: all in state 0. */
void lanes_begin(struct lanes *lanes, rg_scene *scene, bool masks, uint64_t seed);

/** Takes one lane to its next state, by calls on one object. */
void lane_advance(struct lanes *lanes, int lane);

/** Takes `count` lanes, each holding an object now and seen before and after, to their next by one call. Returns how
 * many of those from `first` on it could take so. */
int lanes_move_together(struct lanes *lanes, int first, int count);

/**
 * How rays look at a lane: along it, which finds the object wherever it is, also if the grid has it somewhere else in
 * the lane; or across it, at the very place of one of its states, which finds it only where it is to be found.
 */
enum lane_way { LANE_FORWARD, LANE_BACKWARD, LANE_ACROSS, LANE_WAYS };

/** A ray into a lane. */
struct lane_look {
    int lane;
    enum lane_way way;
    uint64_t aim; /* the state at which it looks across */
};

rg_ray lane_ray(const struct lanes *lanes, const struct lane_look *look);

/** The states that a call may have seen: from the last that was done before it to the last that began before its
 * end. */
struct lane_span {
    uint64_t from, to;
};

static inline uint64_t lane_done(const struct lanes *lanes, int lane) {
    return __atomic_load_n(&lanes->all[lane].done, __ATOMIC_SEQ_CST);
}

static inline uint64_t lane_begun(const struct lanes *lanes, int lane) {
    return __atomic_load_n(&lanes->all[lane].begun, __ATOMIC_SEQ_CST);
}

/** Judges what the ray of a lane saw. Returns whether it is one of these states; `why` tells what is wrong. */
bool lane_judge(const struct lanes *lanes, const struct lane_look *look, struct lane_span span, const rg_hit *hit,
                const char **why);

/** The same for whether anything is there. */
bool lane_judge_occluded(const struct lanes *lanes, const struct lane_look *look, struct lane_span span,
                         bool occluded);

/** How many objects there are now; no change may be under way. */
uint64_t lanes_count(const struct lanes *lanes);

void lanes_end(struct lanes *lanes);

#endif
