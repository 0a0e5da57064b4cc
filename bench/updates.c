/* SPDX-License-Identifier: MIT */
/*
 * updates.c: what it costs to insert, move and remove single objects, and to trace single rays, by grid kind, number
 * of objects and distribution of sizes. Beside each speed stands its error against brute force.
 *
 *     updates [--quick] [--json FILE]
 *
 * All times are wall-clock of one thread, the scene having one worker; each is the median of several repeats after
 * one that is thrown away. Objects are touched in random order, as a game does it, so memory is met as cold as there.
 * Ends with 1 if any hit was wrong.
 */
#include "scenes.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_REPEATS = 9, MAX_TOUCHED = 100000, IMAGE_SIDE = 512, TILE_SIDE = 8 };

struct effort {
    int repeats;
    uint32_t largest;     /* objects */
    double ray_seconds;   /* at most, for each measured kind of rays */
    double checked_tests; /* about so many brute-force sphere tests for each configuration */
};

static const struct effort FULL = {7, 1000000, 2, 4e7};
static const struct effort QUICK = {3, 10000, 0.1, 2e6};

/* One line of the table. Times in nanoseconds a call. */
struct row {
    const char *sizes, *grid;
    uint32_t objects;
    double fill;   /* insert, from the empty scene up, rebuilds included */
    double insert; /* into the full scene */
    double remove;
    double move_tenth, move_one; /* rg_scene_move by 0.1 and by 1 radius */
    double move_to;              /* rg_scene_move_to by 1 radius */
    double move_many;            /* rg_scene_move_many of all by 1 radius, an object */
    double bytes;                /* an object */
    double primary, random;      /* million rays a second, one ray a call */
    int checked, wrong;
    double worst_t; /* |t - exact t| in world length; the scene has side 1 */
};

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count) {
    qsort(values, (size_t)count, sizeof *values, by_value);
    return values[count / 2];
}

/* ------------------------------------------------------------------------------------------------ updates */

static double time_fill(struct bench_scene *scene) {
    double start = bench_seconds();
    for (uint32_t i = 0; i < scene->count; i++) {
        rg_pose pose = bench_pose(scene, i);
        bench_check(rg_scene_insert(scene->scene, bench_shape(scene, i), &pose, &scene->objects[i]));
    }
    return (bench_seconds() - start) / scene->count;
}

/* Removes a random part of the objects and inserts them again, each timed. The ids change. */
static void time_churn(struct bench_scene *scene, double *removing, double *inserting) {
    uint32_t touched = scene->count / 2 < MAX_TOUCHED ? scene->count / 2 : MAX_TOUCHED;
    bench_shuffle(scene);
    double start = bench_seconds();
    for (uint32_t i = 0; i < touched; i++) {
        bench_check(rg_scene_remove(scene->scene, scene->objects[scene->order[i]]));
    }
    double removed = bench_seconds();
    for (uint32_t i = 0; i < touched; i++) {
        uint32_t which = scene->order[i];
        rg_pose pose = bench_pose(scene, which);
        bench_check(rg_scene_insert(scene->scene, bench_shape(scene, which), &pose, &scene->objects[which]));
    }
    *removing = (removed - start) / touched;
    *inserting = (bench_seconds() - removed) / touched;
}

/* Moves a random part of the objects by `step` of their radius each. */
static double time_moves(struct bench_scene *scene, double step, bool whole_pose) {
    uint32_t touched = scene->count < MAX_TOUCHED ? scene->count : MAX_TOUCHED;
    bench_shuffle(scene);
    for (uint32_t i = 0; i < touched; i++) bench_step(scene, scene->order[i], step);
    double start = bench_seconds();
    if (whole_pose) {
        for (uint32_t i = 0; i < touched; i++) {
            rg_pose pose = bench_pose(scene, scene->order[i]);
            bench_check(rg_scene_move(scene->scene, scene->objects[scene->order[i]], &pose));
        }
    } else {
        for (uint32_t i = 0; i < touched; i++) {
            uint32_t which = scene->order[i];
            bench_check(rg_scene_move_to(scene->scene, scene->objects[which], scene->positions[which]));
        }
    }
    return (bench_seconds() - start) / touched;
}

static double time_move_many(struct bench_scene *scene) {
    for (uint32_t i = 0; i < scene->count; i++) bench_step(scene, i, 1);
    rg_input objects = {scene->objects, sizeof *scene->objects, RG_U64};
    rg_pose_views poses = {.size = sizeof poses};
    poses.position = rg_input3_packed(scene->positions, sizeof *scene->positions, RG_F64);
    double start = bench_seconds();
    bench_check(rg_scene_move_many(scene->scene, &objects, &poses, scene->count));
    return (bench_seconds() - start) / scene->count;
}

static void measure_updates(struct bench_scene *scene, const struct effort *effort, struct row *row) {
    double fill[MAX_REPEATS], remove[MAX_REPEATS], insert[MAX_REPEATS], tenth[MAX_REPEATS], one[MAX_REPEATS];
    double to[MAX_REPEATS], many[MAX_REPEATS];
    /* Repeat -1 warms up; the next overwrites what it measured. */
    for (int r = -1; r < effort->repeats; r++) {
        int at = r < 0 ? 0 : r;
        bench_scene_empty(scene);
        fill[at] = time_fill(scene);
    }
    for (int r = -1; r < effort->repeats; r++) {
        int at = r < 0 ? 0 : r;
        time_churn(scene, &remove[at], &insert[at]);
        tenth[at] = time_moves(scene, 0.1, true);
        one[at] = time_moves(scene, 1, true);
        to[at] = time_moves(scene, 1, false);
        many[at] = time_move_many(scene);
    }
    row->fill = 1e9 * median(fill, effort->repeats);
    row->remove = 1e9 * median(remove, effort->repeats);
    row->insert = 1e9 * median(insert, effort->repeats);
    row->move_tenth = 1e9 * median(tenth, effort->repeats);
    row->move_one = 1e9 * median(one, effort->repeats);
    row->move_to = 1e9 * median(to, effort->repeats);
    row->move_many = 1e9 * median(many, effort->repeats);
    rg_scene_report report = {.size = sizeof report};
    bench_check(rg_scene_stats(scene->scene, &report));
    row->bytes = (double)report.bytes / scene->count;
}

/* --------------------------------------------------------------------------------------------------- rays */

/* Traces the rays one a call, from the first on, as many as the time allows; million rays a second. */
static double time_rays(struct bench_scene *scene, const rg_ray *rays, double seconds) {
    enum { BETWEEN_LOOKS = 256 };
    uint32_t done = 0, count = IMAGE_SIDE * IMAGE_SIDE;
    double start = bench_seconds(), now = start;
    while (done < count && now - start < seconds) {
        for (int i = 0; i < BETWEEN_LOOKS; i++) {
            rg_hit hit;
            bench_check(rg_scene_trace(scene->scene, &rays[done++], &hit, 1));
        }
        now = bench_seconds();
    }
    return 1e-6 * done / (now - start);
}

static double measure_rays(struct bench_scene *scene, const struct effort *effort, const rg_ray *rays) {
    double rate[MAX_REPEATS];
    for (int r = -1; r < effort->repeats; r++) {
        rate[r < 0 ? 0 : r] = time_rays(scene, rays, effort->ray_seconds / (effort->repeats + 1));
    }
    return median(rate, effort->repeats);
}

static void check_rays(struct bench_scene *scene, const struct effort *effort, const rg_ray *rays, struct row *row) {
    int samples = (int)fmin(fmax(effort->checked_tests / 2 / scene->count, 16), 2000);
    reference_scene *reference = bench_reference(scene);
    for (int i = 0; i < samples; i++) {
        const rg_ray *ray = &rays[(uint64_t)i * IMAGE_SIDE * IMAGE_SIDE / (uint64_t)samples];
        rg_hit hit;
        bench_check(rg_scene_trace(scene->scene, ray, &hit, 1));
        reference_error error;
        if (reference_compare(reference, ray, RG_CULL_NONE, &hit, &error) == REFERENCE_WRONG) {
            fprintf(stderr, "wrong: %s\n", error.what);
            row->wrong++;
        }
        row->worst_t = fmax(row->worst_t, (double)error.t);
        row->checked++;
    }
    reference_destroy(reference);
}

/* ------------------------------------------------------------------------------------------------- output */

static void print_head(void) {
    printf("ns a call; Mrays/s one ray a call; t error in sides of the scene\n");
    printf("%-8s %-12s %8s %7s %7s %7s %7s %7s %7s %7s %7s %8s %8s %8s %6s %9s\n", "sizes", "grid", "objects", "fill",
           "insert", "remove", "mv 0.1r", "mv 1r", "to 1r", "many 1r", "bytes", "primary", "random", "checked",
           "wrong", "t error");
}

static void print_row(const struct row *row) {
    printf("%-8s %-12s %8u %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %8.3f %8.3f %8d %6d %9.1e\n", row->sizes,
           row->grid, row->objects, row->fill, row->insert, row->remove, row->move_tenth, row->move_one, row->move_to,
           row->move_many, row->bytes, row->primary, row->random, row->checked, row->wrong, row->worst_t);
    fflush(stdout);
}

static json_t *row_as_json(const struct row *row) {
    return json_pack("{s:s, s:s, s:i, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:i, s:f}", "sizes",
                     row->sizes, "grid", row->grid, "objects", (int)row->objects, "fill_ns", row->fill, "insert_ns",
                     row->insert, "remove_ns", row->remove, "move_tenth_radius_ns", row->move_tenth,
                     "move_one_radius_ns", row->move_one, "move_to_one_radius_ns", row->move_to, "move_many_ns",
                     row->move_many, "bytes_per_object", row->bytes, "primary_mrays_per_second", row->primary,
                     "random_mrays_per_second", row->random, "rays_checked", row->checked, "rays_wrong", row->wrong,
                     "worst_t_error", row->worst_t);
}

static struct row measure(const struct bench_sizes *sizes, rg_grid_kind kind, uint32_t count,
                          const struct effort *effort, const rg_ray *primary, const rg_ray *random) {
    struct row row = {.sizes = sizes->name, .objects = count};
    row.grid = kind == RG_GRID_UNIFORM ? "uniform" : "hierarchical";
    struct bench_scene *scene = bench_scene_create(sizes, kind, count);
    measure_updates(scene, effort, &row);
    row.primary = measure_rays(scene, effort, primary);
    row.random = measure_rays(scene, effort, random);
    check_rays(scene, effort, primary, &row);
    check_rays(scene, effort, random, &row);
    bench_scene_destroy(scene);
    return row;
}

int main(int argc, char **argv) {
    const struct effort *effort = &FULL;
    const char *json_file = NULL;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0) {
            effort = &QUICK;
        } else if (strcmp(argv[i], "--json") == 0 && i + 1 < argc) {
            json_file = argv[++i];
        } else {
            fprintf(stderr, "usage: updates [--quick] [--json FILE]\n");
            return 2;
        }
    }
    rg_ray *primary = bench_primary_rays(IMAGE_SIDE, TILE_SIDE);
    rg_ray *random = bench_random_rays(IMAGE_SIDE * IMAGE_SIDE);
    json_t *rows = json_array();
    int wrong = 0;
    print_head();
    for (const struct bench_sizes *sizes = BENCH_SIZES; sizes->name; sizes++) {
        for (rg_grid_kind kind = RG_GRID_UNIFORM; kind <= RG_GRID_HIERARCHICAL; kind++) {
            for (uint32_t count = 1000; count <= effort->largest; count *= 10) {
                struct row row = measure(sizes, kind, count, effort, primary, random);
                print_row(&row);
                json_array_append_new(rows, row_as_json(&row));
                wrong += row.wrong;
            }
        }
    }
    int failed = json_file ? json_dump_file(rows, json_file, JSON_INDENT(2)) : 0;
    if (failed) fprintf(stderr, "could not write %s\n", json_file);
    json_decref(rows);
    free(primary);
    free(random);
    return failed || wrong ? 1 : 0;
}
