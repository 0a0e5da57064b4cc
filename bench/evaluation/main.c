/* SPDX-License-Identifier: MIT */
/* main.c: runs the experiments and writes what they found, and where, as one JSON object. */
#define _DEFAULT_SOURCE
#include "evaluation.h"
#include "versions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const struct evaluation_effort EFFORTS[] = {
    {.name = "full",
     .side = 512,
     .turns = 3,
     .checks = 2e8,
     .finest = 256,
     .flake = 7381,
     .crowd = 5000,
     .equal = 10000,
     .most = 1000000,
     .most_meshes = 100000,
     .frames = 32,
     .runs = 3,
     .shown_flake = 20000,
     .shown_crowd = 5000,
     .shown_escape = 100000,
     .goal = 100000},
    {.name = "quick",
     .side = 256,
     .turns = 1,
     .checks = 1e7,
     .finest = 128,
     .flake = 7381,
     .crowd = 5000,
     .equal = 10000,
     .most = 100000,
     .most_meshes = 10000,
     .frames = 32,
     .runs = 1,
     .shown_flake = 5000,
     .shown_crowd = 5000,
     .shown_escape = 100000,
     .goal = 100000},
    {.name = "selftest",
     .side = 32,
     .turns = 1,
     .checks = 1e6,
     .finest = 16,
     .flake = 820,
     .crowd = 500,
     .equal = 1000,
     .most = 1000,
     .most_meshes = 1000,
     .frames = 12,
     .runs = 1,
     .shown_flake = 820,
     .shown_crowd = 500,
     .shown_escape = 2000,
     .goal = 1000},
};

static const struct {
    const char *name;
    void (*run)(struct evaluation *evaluation);
} EXPERIMENTS[] = {{"resolutions", evaluate_resolutions},
                   {"shows", evaluate_shows},
                   {"sizes", evaluate_sizes},
                   {"counts", evaluate_counts},
                   {"goal", evaluate_goal}};

/* --------------------------------------------------------------------------------------------------- where */

/* Linux names the processor here; elsewhere it stays unknown. */
static json_t *processor(void) {
    static const char KEY[] = "model name";
    char line[256];
    json_t *name = NULL;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && !name && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (colon && strncmp(line, KEY, strlen(KEY)) == 0) {
            line[strcspn(line, "\n")] = '\0';
            name = json_string(colon + 2);
        }
    }
    if (file) fclose(file);
    return name ? name : json_null();
}

/* What else runs: processes that wait for a processor or have one, over 1, 5 and 15 minutes. */
static json_t *load(void) {
    double l[3];
    if (getloadavg(l, 3) != 3) return json_null();
    return json_pack("[f, f, f]", l[0], l[1], l[2]);
}

static json_t *describe_run(const struct evaluation *evaluation) {
    const struct evaluation_effort *effort = &evaluation->effort;
    struct bench_versions v = bench_versions_of(evaluation->peer.api);
    char date[32];
    time_t now = time(NULL);
    strftime(date, sizeof date, "%Y-%m-%d", gmtime(&now));
    return json_pack("{s:s, s:s, s:s, s:s?, s:s, s:s, s:o, s:I, s:i, s:i, s:o}", "date", date, "effort", effort->name,
                     "raygrid", v.own, "peer", v.peer[0] ? v.peer : NULL, "compiler", v.compiler, "instructions",
                     v.isa, "processor", processor(), "processors", (json_int_t)sysconf(_SC_NPROCESSORS_ONLN), "side",
                     effort->side, "turns", effort->turns, "load before", load());
}

/* -------------------------------------------------------------------------------------------- the command */

static const char USAGE[] =
    "usage: evaluation [--json FILE] [--embree auto|none|LIBRARY] [--quick | --selftest] [--only EXPERIMENT] "
    "[--spoil]\n"
    "Experiments: resolutions, shows, sizes, counts, goal. --spoil: every answer of raygrid is made wrong before it "
    "is judged.\n";

struct options {
    const char *json, *embree, *only;
};

static bool read_options(struct evaluation *evaluation, struct options *o, int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (strcmp(argv[i], "--quick") == 0) {
            evaluation->effort = EFFORTS[1];
        } else if (strcmp(argv[i], "--selftest") == 0) {
            evaluation->effort = EFFORTS[2];
        } else if (strcmp(argv[i], "--spoil") == 0) {
            evaluation->spoil = true;
        } else if (value && strcmp(argv[i], "--json") == 0) {
            o->json = argv[++i];
        } else if (value && strcmp(argv[i], "--embree") == 0) {
            o->embree = argv[++i];
        } else if (value && strcmp(argv[i], "--only") == 0) {
            o->only = argv[++i];
        } else {
            return false;
        }
    }
    return true;
}

static void run_experiments(struct evaluation *evaluation, const char *only) {
    double start = bench_wall_seconds();
    evaluation->report = json_object();
    json_object_set_new(evaluation->report, "run", describe_run(evaluation));
    for (size_t i = 0; i < sizeof EXPERIMENTS / sizeof *EXPERIMENTS; i++) {
        json_object_set_new(evaluation->report, EXPERIMENTS[i].name, json_array());
        if (!only || strcmp(only, EXPERIMENTS[i].name) == 0) EXPERIMENTS[i].run(evaluation);
    }
    json_t *about = json_object_get(evaluation->report, "run");
    json_object_set_new(about, "load after", load());
    json_object_set_new(about, "seconds", json_real(bench_wall_seconds() - start));
}

int main(int argc, char **argv) {
    struct evaluation evaluation = {.effort = EFFORTS[0]};
    struct options o = {.embree = "auto"};
    if (!read_options(&evaluation, &o, argc, argv)) {
        fputs(USAGE, stderr);
        return 2;
    }
    struct embree_api *api = strcmp(o.embree, "none") == 0 ? NULL : embree_open(o.embree, NULL);
    FILE *file = o.json ? fopen(o.json, "w") : stdout;
    if (!file) {
        perror(o.json);
        return 2;
    }
    evaluation.peer.api = api;
    run_experiments(&evaluation, o.only);
    embree_close(api);
    bool written = json_dumpf(evaluation.report, file, JSON_INDENT(1) | JSON_REAL_PRECISION(6)) == 0;
    written = fputc('\n', file) != EOF && written;
    if (o.json) written = fclose(file) == 0 && written;
    if (!written) perror(o.json ? o.json : "stdout");
    json_decref(evaluation.report);
    if (evaluation.wrong) fprintf(stderr, "%d wrong answers of raygrid\n", evaluation.wrong);
    return !written || evaluation.wrong ? 1 : 0;
}
