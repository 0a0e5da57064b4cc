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
    [GOAL_MESH_INCOHERENT] = {{1.15, 1.15, 1.15, 2.5}, 1},
    [GOAL_MESH_INCOHERENT_ROBUST] = {{1.4, 1.4, 1.4, 3}, 1},
    [GOAL_MESH_PRIMARY] = {{1.2, 1.2, 1.2, 1.4}, 1},
    [GOAL_MESH_PRIMARY_ROBUST] = {{1.4, 1.4, 1.4, 1.5}, 1},
    [GOAL_MESH_SHADOW] = {{1.4, 1.4, 1.4, 1.5}, 1},
    [GOAL_MESH_SHADOW_ROBUST] = {{1.5, 1.5, 1.5, 1.6}, 1},
    [GOAL_MESH_SINGLE] = {{0.95, 0.95, 0.95, 1}, 1},
    [GOAL_MESH_SINGLE_ROBUST] = {{1.1, 1.1, 1.1, 1.1}, 1},
    /* Times: 1.1 of the peer's medium, 1.2 of its low, 1 of its refit. */
    [GOAL_MESH_BEST] = {{1 / 1.1, 1 / 1.1, 1 / 1.1, 1 / 1.1}, 1},
    [GOAL_MESH_FAST] = {{1 / 1.2, 1 / 1.2, 1 / 1.2, 1 / 1.2}, 1},
    [GOAL_MESH_REFIT] = {{1, 1, 1, 1}, 1},
    [GOAL_MESH_BYTES] = {{40, 40, 40, 40}, 0},
    [GOAL_MESH_BYTES_SOUP] = {{60, 60, 60, 60}, 0},
    [GOAL_INSTANCES_COHERENT] = {{2, 2, 2, 2}, 1},
    [GOAL_INSTANCES_INCOHERENT] = {{1.5, 2, 2.5, 2.5}, 1},
    [GOAL_INSTANCES_MOVED] = {{20, 100, 500, 500}, 1},
};

struct bench_goal bench_no_goal(void) {
    return (struct bench_goal){NAN, 0};
}

struct bench_goal bench_goal(enum bench_aim aim, uint32_t count) {
    int column = (int)lround(log10(count)) - 3;
    if (column < 0) return bench_no_goal();
    return (struct bench_goal){TABLE[aim].value[column > 3 ? 3 : column], TABLE[aim].on_ratio};
}
