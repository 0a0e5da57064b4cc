/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds_of(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bench_thread_seconds(void) {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double bench_process_seconds(void) {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double bench_wall_seconds(void) {
    return seconds_of(CLOCK_MONOTONIC);
}

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median(double *values, int count) {
    qsort(values, (size_t)count, sizeof *values, by_value);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

struct bench_duel bench_duel(struct bench_side own, struct bench_side peer, int turns) {
    double owns[BENCH_TURNS], peers[BENCH_TURNS], ratios[BENCH_TURNS];
    /* Turn -1 warms up; the next overwrites what it measured. */
    for (int i = -1; i < turns; i++) {
        int at = i < 0 ? 0 : i;
        owns[at] = own.turn(own.context);
        peers[at] = peer.turn ? peer.turn(peer.context) : NAN;
        ratios[at] = peers[at] / owns[at];
    }
    struct bench_duel result = {bench_median(owns, turns), NAN, NAN};
    if (peer.turn) {
        result.peer = bench_median(peers, turns);
        result.ratio = bench_median(ratios, turns);
    }
    return result;
}

void *bench_allocate(size_t count, size_t size) {
    void *memory = NULL;
    size_t bytes = count * size;
    if (posix_memalign(&memory, 64, bytes ? bytes : 1)) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    memset(memory, 0, bytes);
    return memory;
}

/* The generator is splitmix64. */
double bench_random(uint64_t *state) {
    uint64_t z = *state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void bench_random_direction(uint64_t *state, double direction[3]) {
    double z = 2 * bench_random(state) - 1, angle = 6.283185307179586 * bench_random(state);
    double r = sqrt(1 - z * z);
    direction[0] = r * cos(angle);
    direction[1] = r * sin(angle);
    direction[2] = z;
}
