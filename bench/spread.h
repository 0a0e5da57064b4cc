/* SPDX-License-Identifier: MIT */
/*
 * spread.h: how long single calls take, each timed by itself: not their mean, but the few that take longest.
 *
 * On a machine that others use, the longest calls are those that the machine disturbed. They are told from the
 * others in two ways:
 * A call that takes long is "disturbed" if for a quarter of its time or more this thread neither ran nor slept (the
 * system or a hypervisor had taken the processor away), or threads of the process waited for a processor: the one,
 * maybe, that held the scene. Linux counts for each thread how long it so waited (/proc/self/task/N/schedstat, its
 * second number); where there is no such file, only the first is known.
 * Where the same calls are made several times over, in scenes that are alike to the bit, what the library does takes
 * long in each of them, what the machine does in one: so the "best" undisturbed time of each call is kept.
 */
#ifndef RAYGRID_BENCH_SPREAD_H
#define RAYGRID_BENCH_SPREAD_H

#include <stdbool.h>
#include <stdint.h>

/* Each octave of nanoseconds has so many steps: percentiles are right to 3 %. */
enum { SPREAD_STEPS = 32, SPREAD_BINS = SPREAD_STEPS * 40 };

/** Which calls. */
enum bench_view { SPREAD_ALL, SPREAD_QUIET, SPREAD_BEST, SPREAD_VIEWS };

/** Times of many calls, in ns. Zero it. */
struct bench_spread {
    struct bench_times {
        uint64_t calls, bins[SPREAD_BINS], longest;
    } views[SPREAD_VIEWS];
};

/** The time that no more than a share of 1 - `part` of the calls exceed, in us; NaN if there are none. */
double bench_spread_at(const struct bench_spread *spread, enum bench_view view, double part);

/** That of the longest call, in us. */
double bench_spread_longest(const struct bench_spread *spread, enum bench_view view);

void bench_spread_add(struct bench_spread *spread, enum bench_view view, uint64_t ns);

enum { WATCH_THREADS = 16 }; /* looked at, at most */

/** One thread that times its calls. */
struct bench_watch {
    uint64_t tick;                /* ns that reading the clock takes: subtracted */
    uint64_t last;                /* the end of the last call */
    uint64_t looked;              /* when the two below were last looked at */
    uint64_t processing, waiting; /* ns: this thread's processor time; what all threads have waited for a processor */
    long sleeps;                  /* of this thread */
    int calls;                    /* since then */
    int threads;                  /* of this process, */
    int files[WATCH_THREADS];     /* and where the system tells of each */
};

/** When all threads that take part are there. */
void bench_watch_begin(struct bench_watch *watch);
void bench_watch_end(struct bench_watch *watch);

/** Right before a call; its result goes to bench_watch_stop, right after the call, which returns its time in
 * ns, BENCH_DISTURBED if it was. */
#define BENCH_DISTURBED UINT64_MAX
uint64_t bench_watch_start(struct bench_watch *watch);
uint64_t bench_watch_stop(struct bench_watch *watch, uint64_t start, struct bench_spread *spread);

/** Times as many "calls" that do nothing, of some 500 ns each: what the machine itself does to calls. */
void bench_watch_idle(struct bench_watch *watch, struct bench_spread *spread, uint64_t calls);

#endif
