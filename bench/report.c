/* SPDX-License-Identifier: MIT */
#include "report.h"

#include <math.h>
#include <string.h>

struct bench_line bench_line(const char *section, const char *scene, uint32_t count, const char *what) {
    struct bench_line line = {.section = section, .unit = "", .goal = bench_no_goal(), .threads = 1};
    line.figure = line.peer_figure = line.ratio = line.bytes = line.peer_bytes = NAN;
    snprintf(line.name, sizeof line.name, "%s/%s/%u/%s", section, scene, count, what);
    return line;
}

/* 1 if the goal is reached, 0 if not, -1 if there is none or nothing to hold against it. */
static int reached(const struct bench_line *line) {
    double value = line->goal.on_ratio ? line->ratio : line->figure;
    if (isnan(line->goal.value) || isnan(value)) return -1;
    return line->goal.on_ratio ? value >= line->goal.value : value <= line->goal.value;
}

/* ------------------------------------------------------------------------------------------------- table */

static void print_number(double number, int width) {
    if (isnan(number)) {
        printf(" %*s", width, "-");
    } else if (fabs(number) >= 1000) {
        printf(" %*.0f", width, number);
    } else {
        printf(" %*.3g", width, number);
    }
}

static void print_error(const struct exact_error *error) {
    char text[32] = "-";
    if (error) snprintf(text, sizeof text, "%d/%d", error->wrong, error->checked);
    printf(" %8s", text);
    if (error && error->worst_t > 0) {
        printf(" %7.0e", error->worst_t);
    } else {
        printf(" %7s", error ? "0" : "-");
    }
}

static void print_head(const struct bench_report *report) {
    printf("\n%-50s %8s %-8s %8s %6s %9s %8s %7s %8s %7s  %s\n", report->section, "figure", "unit", "peer", "ratio",
           "goal", "wrong", "t error", "peer's", "t error", "peer's way");
}

/* A line for each view of the calls. */
static void print_spread(const struct bench_spread *s) {
    static const char *const NAMES[SPREAD_VIEWS] = {"all", "undisturbed", "best"};
    for (int v = 0; v < SPREAD_VIEWS; v++) {
        if (!s->views[v].calls) continue;
        printf("%20s %9llu calls, us: p50 %.3g, p99 %.3g, p99.9 %.3g, p99.99 %.3g, max %.4g\n", NAMES[v],
               (unsigned long long)s->views[v].calls, bench_spread_at(s, v, 0.5), bench_spread_at(s, v, 0.99),
               bench_spread_at(s, v, 0.999), bench_spread_at(s, v, 0.9999), bench_spread_longest(s, v));
    }
}

static void print_line(const struct bench_line *line) {
    char goal[32] = "";
    if (!isnan(line->goal.value)) {
        static const char *const SIGNS[] = {" !", "", " ?"};
        int state = reached(line);
        snprintf(goal, sizeof goal, "%s%.4g%s", line->goal.on_ratio ? ">" : "<", line->goal.value,
                 SIGNS[state < 0 ? 2 : state]);
    }
    printf("%-50s", line->name + strlen(line->section) + 1);
    print_number(line->figure, 8);
    printf(" %-8s", line->unit);
    print_number(line->peer_figure, 8);
    print_number(line->ratio, 6);
    printf(" %9s", goal);
    print_error(line->error);
    print_error(line->peer_error);
    printf("  %s\n", line->peer_way ? line->peer_way : "");
    if (line->spread) print_spread(line->spread);
    fflush(stdout);
}

/* -------------------------------------------------------------------------------------------------- JSON */

static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static void put_error(json_t *object, const char *prefix, const struct exact_error *error) {
    char key[32];
    snprintf(key, sizeof key, "%schecked", prefix);
    json_object_set_new(object, key, error ? json_integer(error->checked) : json_null());
    snprintf(key, sizeof key, "%swrong", prefix);
    json_object_set_new(object, key, error ? json_integer(error->wrong) : json_null());
    snprintf(key, sizeof key, "%sworst_t_error", prefix);
    json_object_set_new(object, key, error ? json_real(error->worst_t) : json_null());
}

/* In microseconds. */
static json_t *times_of(const struct bench_spread *s, enum bench_view view) {
    if (!s->views[view].calls) return json_null();
    return json_pack("{s:I, s:f, s:f, s:f, s:f, s:f}", "calls", (json_int_t)s->views[view].calls, "p50",
                     bench_spread_at(s, view, 0.5), "p99", bench_spread_at(s, view, 0.99), "p99.9",
                     bench_spread_at(s, view, 0.999), "p99.99", bench_spread_at(s, view, 0.9999), "max",
                     bench_spread_longest(s, view));
}

static json_t *spread_of(const struct bench_spread *s) {
    if (!s) return json_null();
    return json_pack("{s:o, s:o, s:o}", "all", times_of(s, SPREAD_ALL), "undisturbed", times_of(s, SPREAD_QUIET),
                     "best", times_of(s, SPREAD_BEST));
}

static void write_line(const struct bench_report *report, const struct bench_line *line) {
    const struct bench_versions *v = &report->versions;
    int state = reached(line);
    json_t *object = json_object();
    json_object_set_new(object, "name", json_string(line->name));
    json_object_set_new(object, "figure", number(line->figure));
    json_object_set_new(object, "unit", json_string(line->unit));
    json_object_set_new(object, "peer_figure", number(line->peer_figure));
    json_object_set_new(object, "ratio", number(line->ratio));
    json_object_set_new(object, "goal", number(line->goal.value));
    json_object_set_new(object, "goal_on",
                        isnan(line->goal.value) ? json_null()
                        : line->goal.on_ratio   ? json_string("ratio, at least")
                                                : json_string("figure, at most"));
    json_object_set_new(object, "reached", state < 0 ? json_null() : json_boolean(state));
    put_error(object, "", line->error);
    put_error(object, "peer_", line->peer_error);
    json_object_set_new(object, "spread", spread_of(line->spread));
    json_object_set_new(object, "bytes_per_object", number(line->bytes));
    json_object_set_new(object, "peer_bytes_per_object", number(line->peer_bytes));
    json_object_set_new(object, "threads", json_integer(line->threads));
    json_object_set_new(object, "isa", json_string(v->isa));
    json_object_set_new(object, "peer_way", line->peer_way ? json_string(line->peer_way) : json_null());
    json_object_set_new(object, "versions",
                        json_pack("{s:s, s:s?, s:s}", "raygrid", v->own, "peer", v->peer[0] ? v->peer : NULL,
                                  "compiler", v->compiler));
    json_dumpf(object, report->json, JSON_COMPACT | JSON_REAL_PRECISION(6));
    fputc('\n', report->json);
    fflush(report->json);
    json_decref(object);
}

void bench_report_line(struct bench_report *report, const struct bench_line *line) {
    if (!report->section || strcmp(report->section, line->section) != 0) {
        report->section = line->section;
        print_head(report);
    }
    print_line(line);
    if (report->json) write_line(report, line);
    report->lines++;
    report->wrong += line->error ? line->error->wrong : 0;
    report->peer_wrong += line->peer_error ? line->peer_error->wrong : 0;
    report->goals += reached(line) >= 0;
    report->missed += reached(line) == 0;
}

void bench_report_end(const struct bench_report *report) {
    printf("\n%d lines; %d goals, %d of them missed (marked !); wrong hits in the samples: raygrid %d, peer %d\n",
           report->lines, report->goals, report->missed, report->wrong, report->peer_wrong);
}
