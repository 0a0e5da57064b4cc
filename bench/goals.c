/* SPDX-License-Identifier: MIT */
#include "goals.h"

#include <math.h>

static const struct {
    double value[4]; /* 10^3, 10^4, 10^5 and 10^6 objects */
    int on_ratio;
} TABLE[GOALS] = {
    [GOAL_COHERENT] = {{7, 5.5, 4.5, 3.5}, 1},
    [GOAL_COHERENT_STADIUM] = {{4, 4, 4, 3}, 1},
    [GOAL_INCOHERENT] = {{1.3, 1.3, 2, 3.5}, 1},
    [GOAL_SINGLE] = {{1, 1, 1, 1.3}, 1},
    [GOAL_MOVE_SMALL] = {{15, 20, 30, 60}, 0},
    [GOAL_MOVE_RADIUS] = {{30, 30, 60, 120}, 0},
    [GOAL_INSERT] = {{80, 80, 200, 400}, 0},
    [GOAL_REMOVE] = {{40, 40, 80, 150}, 0},
    [GOAL_FRAME] = {{4, 4, 4, 4}, 1},
    [GOAL_LASTING] = {{0.95, 0.95, 0.95, 0.95}, 1},
    [GOAL_BYTES] = {{100, 100, 100, 100}, 0},
    [GOAL_TWO_THREADS] = {{1.85, 1.85, 1.85, 1.85}, 1},
    [GOAL_CHANGE_USUAL] = {{20, 20, 20, 20}, 0},
    [GOAL_CHANGE_LONGEST] = {{1000, 1000, 1000, 1000}, 0},
    [GOAL_REBUILD_FRAME] = {{0.8, 0.8, 0.8, 0.8}, 1},
    [GOAL_REBUILD_MEMORY] = {{2.2, 2.2, 2.2, 2.2}, 0},
};

struct bench_goal bench_goal(enum bench_aim aim, uint32_t count) {
    int column = (int)lround(log10(count)) - 3;
    column = column < 0 ? 0 : column > 3 ? 3 : column;
    return (struct bench_goal){TABLE[aim].value[column], TABLE[aim].on_ratio};
}

struct bench_goal bench_no_goal(void) {
    return (struct bench_goal){NAN, 0};
}
