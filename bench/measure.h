/* SPDX-License-Identifier: MIT */
/* measure.h: clocks, medians, and two sides that take turns. Running out of memory ends the benchmark. */
#ifndef RAYGRID_BENCH_MEASURE_H
#define RAYGRID_BENCH_MEASURE_H

#include <stddef.h>
#include <stdint.h>

/** How much is done. */
struct bench_effort {
    int turns;           /* of each side, after one that is thrown away; at most BENCH_TURNS */
    double turn_seconds; /* at least, of each turn: short passes are repeated */
    int side;            /* of the picture in rays */
    uint32_t incoherent; /* rays of each incoherent set */
    double checks;       /* about so many brute-force tests for each set of rays */
    uint32_t touched;    /* objects changed one by one in a turn, at most */
    uint32_t churn;      /* changes before the scene is compared with a fresh one */
    uint32_t calls;      /* timed one by one in each manner */
    int frames;          /* moved, not measured, before the frames that are */
    int shares;          /* of the bodies moved a frame: how many different ones are measured, at most 4 */
};

enum { BENCH_TURNS = 15 };

/** Seconds of processor time that this thread has used: others on the machine do not count. */
double bench_thread_seconds(void);

/** The same of all threads of this process. */
double bench_process_seconds(void);

/** Seconds since some time in the past. */
double bench_wall_seconds(void);

/** Sorts the values. */
double bench_median(double *values, int count);

/** One turn of a side: returns the seconds that count. */
typedef double bench_turn(void *context);

struct bench_side {
    bench_turn *turn; /* NULL: there is no such side */
    void *context;
};

/** Medians over all turns; without a peer its figures are NaN. */
struct bench_duel {
    double own, peer; /* seconds */
    double ratio;     /* of peer / own, turn by turn: more is better */
};

/** The sides take turns, so that what disturbs the machine disturbs both. */
struct bench_duel bench_duel(struct bench_side own, struct bench_side peer, int turns);

/** Zeroed memory, aligned to 64 bytes; given back by free(). */
void *bench_allocate(size_t count, size_t size);

/** The next of a row of random numbers, in [0, 1). */
double bench_random(uint64_t *state);

/** A random direction, evenly on the unit sphere. */
void bench_random_direction(uint64_t *state, double direction[3]);

#endif
