/* SPDX-License-Identifier: MIT */
/* report.h: lines of figures, as a table and as JSON, one object a line. A figure that there is not is NaN. */
#ifndef RAYGRID_BENCH_REPORT_H
#define RAYGRID_BENCH_REPORT_H

#include "exact.h"
#include "goals.h"
#include "spread.h"
#include "versions.h"

#include <jansson.h>
#include <stdio.h>

struct bench_report {
    FILE *json; /* NULL: only the table */
    struct bench_versions versions;
    int lines, wrong, peer_wrong, goals, missed;
    const char *section; /* printed last */
};

/** A line that is all to be filled in: what is not stays NaN or 0. */
struct bench_line {
    const char *section; /* its part of the table */
    char name[96];
    const char
        *unit; /* "Mrays/s": more is better. "ns", "ms", "bytes": less is. "of fresh", "times": a bare ratio. */
    double figure, peer_figure, ratio;
    struct bench_goal goal;
    const struct exact_error *error, *peer_error; /* NULL: rays are not what is measured */
    const struct bench_spread *spread;            /* of single calls; NULL: they are not what is measured */
    double bytes, peer_bytes;                     /* an object */
    int threads;
    const char *peer_way; /* how the peer did it; NULL: there is none */
};

/** A line with the name "section/scene/count/...". */
struct bench_line bench_line(const char *section, const char *scene, uint32_t count, const char *what);

void bench_report_line(struct bench_report *report, const struct bench_line *line);

/** The last words: how many lines, goals and wrong hits. */
void bench_report_end(const struct bench_report *report);

#endif
