/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* RUSAGE_THREAD */
#include "spread.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum {
    LONG_CALL = 5000,        /* ns: two changes of context alone take some microseconds */
    LOOK_AFTER = 256,        /* calls: so few, that little else falls between a look and a long call */
    IDLE_CALL = 500,         /* ns */
    EXACT = 2 * SPREAD_STEPS /* ns: up to there, a bin for each */
};

static uint64_t now(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------ the bins */

static uint32_t bin_of(uint64_t ns) {
    uint32_t octave = 0;
    while (ns >> octave >= EXACT) octave++;
    uint32_t bin = octave * SPREAD_STEPS + (uint32_t)(ns >> octave);
    return bin < SPREAD_BINS ? bin : SPREAD_BINS - 1;
}

/* The end of a bin. */
static double end_of(uint32_t bin) {
    if (bin < EXACT) return bin;
    uint32_t octave = bin / SPREAD_STEPS - 1, step = bin % SPREAD_STEPS + SPREAD_STEPS;
    return ldexp(step + 1, (int)octave) - 1;
}

double bench_spread_at(const struct bench_spread *spread, enum bench_view view, double part) {
    const struct bench_times *times = &spread->views[view];
    uint64_t below = 0, wanted = (uint64_t)ceil(part * (double)times->calls);
    for (uint32_t i = 0; i < SPREAD_BINS && wanted; i++) {
        below += times->bins[i];
        if (below >= wanted) return 1e-3 * fmin(end_of(i), (double)times->longest);
    }
    return NAN;
}

double bench_spread_longest(const struct bench_spread *spread, enum bench_view view) {
    const struct bench_times *times = &spread->views[view];
    return times->calls ? 1e-3 * (double)times->longest : NAN;
}

void bench_spread_add(struct bench_spread *spread, enum bench_view view, uint64_t ns) {
    struct bench_times *times = &spread->views[view];
    times->calls++;
    times->bins[bin_of(ns)]++;
    if (ns > times->longest) times->longest = ns;
}

/* ----------------------------------------------------------------------------------------------- the watch */

/* Of all threads since they began, ns. Of one that waits just now the system tells when it runs again: so whoever was
 * waited for has been counted. */
static uint64_t waiting(const struct bench_watch *watch) {
    uint64_t sum = 0;
    for (int i = 0; i < watch->threads; i++) {
        char text[96];
        ssize_t length = pread(watch->files[i], text, sizeof text - 1, 0);
        if (length <= 0) continue;
        text[length] = 0;
        char *second;
        (void)strtoull(text, &second, 10);
        sum += strtoull(second, NULL, 10);
    }
    return sum;
}

static void look(struct bench_watch *watch) {
    struct rusage usage;
    getrusage(RUSAGE_THREAD, &usage);
    watch->sleeps = usage.ru_nvcsw;
    watch->waiting = waiting(watch);
    watch->processing = now(CLOCK_THREAD_CPUTIME_ID);
    watch->looked = watch->last = now(CLOCK_MONOTONIC);
    watch->calls = 0;
}

static void find_threads(struct bench_watch *watch) {
    DIR *all = opendir("/proc/self/task");
    watch->threads = 0;
    for (struct dirent *entry; all && watch->threads < WATCH_THREADS && (entry = readdir(all));) {
        char path[64];
        long number = strtol(entry->d_name, NULL, 10);
        snprintf(path, sizeof path, "/proc/self/task/%ld/schedstat", number);
        int file = number > 0 ? open(path, O_RDONLY) : -1;
        if (file >= 0) watch->files[watch->threads++] = file;
    }
    if (all) closedir(all);
}

void bench_watch_begin(struct bench_watch *watch) {
    find_threads(watch);
    watch->tick = UINT64_MAX;
    for (int i = 0; i < 1000; i++) {
        uint64_t before = now(CLOCK_MONOTONIC), ns = now(CLOCK_MONOTONIC) - before;
        if (ns < watch->tick) watch->tick = ns;
    }
    look(watch);
}

void bench_watch_end(struct bench_watch *watch) {
    while (watch->threads) close(watch->files[--watch->threads]);
}

/* In a pause since the last call threads may have waited, too, which is not to be taken for a disturbed call. */
uint64_t bench_watch_start(struct bench_watch *watch) {
    uint64_t start = now(CLOCK_MONOTONIC);
    if (watch->calls++ < LOOK_AFTER && start - watch->last < LONG_CALL) return start;
    look(watch);
    return now(CLOCK_MONOTONIC);
}

/* From the last look up to the call this thread ran all the time: else the pause would have been noticed. */
static bool is_disturbed(struct bench_watch *watch, uint64_t start, uint64_t ns) {
    const struct bench_watch before = *watch;
    look(watch);
    uint64_t ran = watch->processing - before.processing, ran_before = start - before.looked;
    uint64_t used = ran > ran_before ? ran - ran_before : 0;
    bool taken_away = watch->sleeps == before.sleeps && 4 * used < 3 * ns;
    return taken_away || 4 * (watch->waiting - before.waiting) > ns;
}

uint64_t bench_watch_stop(struct bench_watch *watch, uint64_t start, struct bench_spread *spread) {
    uint64_t end = now(CLOCK_MONOTONIC), taken = end - start;
    uint64_t ns = taken > watch->tick ? taken - watch->tick : 0;
    watch->last = end;
    bench_spread_add(spread, SPREAD_ALL, ns);
    if (ns >= LONG_CALL && is_disturbed(watch, start, ns)) return BENCH_DISTURBED;
    bench_spread_add(spread, SPREAD_QUIET, ns);
    return ns;
}

void bench_watch_idle(struct bench_watch *watch, struct bench_spread *spread, uint64_t calls) {
    for (uint64_t i = 0; i < calls; i++) {
        uint64_t start = bench_watch_start(watch);
        while (now(CLOCK_MONOTONIC) - start < IDLE_CALL) continue;
        (void)bench_watch_stop(watch, start, spread);
    }
}
