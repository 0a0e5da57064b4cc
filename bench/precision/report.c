/* SPDX-License-Identifier: MIT */
/*
 * Errors beside run times: each world, at the origin and far away, with every kind of grid and with the peer; brute
 * force has 113 bits. Writes a line of JSON for each; script/precision makes tables and plots of them.
 */
#include "figures.h"
#include "sides.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TURNS = 7, SEED = 41 };

/* Four roundings of a float, of the radius, the distance and the size of the scene together (not of how far that lies
 * from the origin): what a peer that computes in float is given. */
static reference_bound of_floats(const struct world *world) {
    return (reference_bound){0x1p-22, 0x1p-22, 0x1p-22 * sqrt(3) * world->side, 0x1p-22};
}

struct options {
    uint32_t objects, rays, judged;
    const char *embree, *json;
};

/* JSON knows no NaN: what was not measured is null. */
static json_t *number(double x) {
    return isnan(x) ? json_null() : json_real(x);
}

static json_t *json_spread(const struct spread *s) {
    return json_pack("{s:o, s:o, s:o}", "median", number(s->median), "99 %", number(s->most_of_100), "most",
                     number(s->largest));
}

static json_t *json_counts(const struct figures *f) {
    return json_pack("{s:i, s:i, s:i}", "wrong", (int)f->wrong, "missed", (int)f->missed, "within", (int)f->within);
}

static void write_line(FILE *file, const struct world *world, double offset, const struct side *side,
                       const struct embree_api *api, uint32_t rays, const struct figures *promised,
                       const struct figures *floats) {
    const struct figures *f = floats;
    json_t *line = json_pack("{s:s, s:f, s:s, s:i, s:i, s:f, s:i, s:i}", "scene", world->name, "offset", offset,
                             "side", side->name, "objects", (int)world->bodies->count, "rays", (int)rays, "ns",
                             1e9 * side->seconds / rays, "judged", (int)f->judged, "hits", (int)f->hits);
    json_object_set_new(line, "by four roundings of floats", json_counts(floats));
    json_object_set_new(line, "by the promise", promised ? json_counts(promised) : json_null());
    json_object_set_new(line, "worst t of the promise", number(promised ? promised->of_bound : NAN));
    json_object_set_new(line, "t ulp", json_spread(&f->t));
    json_object_set_new(line, "normal ulp", json_spread(&f->normal));
    json_object_set_new(line, "peer version", api && side->peer ? json_integer(api->version) : json_null());
    json_dumpf(line, file, JSON_PRESERVE_ORDER);
    fputc('\n', file);
    fflush(file);
    json_decref(line);
}

/* Turn by turn, so that what disturbs the machine disturbs all. */
static void time_all(struct side *sides, int count, const rg_ray *rays, uint32_t ray_count) {
    for (int turn = 0; turn < TURNS; turn++) {
        for (int s = 0; s < count; s++) side_time(&sides[s], rays, ray_count);
    }
}

static void report_world(const struct options *o, const char *name, double offset, const struct embree_api *api,
                         FILE *file) {
    struct world *world = world_create(name, o->objects, offset, SEED);
    rg_ray *rays = bench_allocate(o->rays, sizeof *rays);
    rg_hit *hits = bench_allocate(o->rays, sizeof *hits);
    struct side sides[SIDES];
    uint64_t random = SEED;
    world->floats = offset == 0;
    for (uint32_t i = 0; i < o->rays; i++) rays[i] = world_ray(world, &random);
    int count = sides_create(sides, world, rays, o->rays, api);
    time_all(sides, count, rays, o->rays);
    struct judge *promised = judge_create(world->bodies, sides[0].own->objects, NULL);
    const reference_bound bound = of_floats(world);
    struct judge *floats = judge_create(world->bodies, sides[0].own->objects, &bound);
    uint32_t step = o->rays / o->judged ? o->rays / o->judged : 1;
    for (int s = 0; s < count; s++) {
        bool own = sides[s].own != NULL;
        struct figures by_promise;
        side_answer(&sides[s], &sides[0], rays, hits, o->rays);
        if (own) by_promise = figures_of(promised, rays, hits, o->rays, step, true, false);
        struct figures by_floats = figures_of(floats, rays, hits, o->rays, step, own, true);
        write_line(file, world, offset, &sides[s], api, o->rays, own ? &by_promise : NULL, &by_floats);
        fprintf(stderr, "%s at %g, %s: %.0f ns, %u wrong, %u missed\n", name, offset, sides[s].name,
                1e9 * sides[s].seconds / o->rays, by_floats.wrong, by_floats.missed);
    }
    judge_destroy(promised);
    judge_destroy(floats);
    sides_destroy(sides, count);
    free(rays);
    free(hits);
    world_destroy(world);
}

static const char USAGE[] =
    "usage: precision [--json FILE] [--embree auto|none|LIBRARY] [--objects N] [--rays N] [--judged N]\n"
    "Writes for each scene, offset and side: run time, wrong and missed hits, errors of t and normals.\n";

static bool read_options(struct options *o, int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (!value) return false;
        i++;
        if (strcmp(name, "--json") == 0) {
            o->json = value;
        } else if (strcmp(name, "--embree") == 0) {
            o->embree = value;
        } else if (strcmp(name, "--objects") == 0) {
            o->objects = (uint32_t)strtoul(value, NULL, 10);
        } else if (strcmp(name, "--rays") == 0) {
            o->rays = (uint32_t)strtoul(value, NULL, 10);
        } else if (strcmp(name, "--judged") == 0) {
            o->judged = (uint32_t)strtoul(value, NULL, 10);
        } else {
            return false;
        }
    }
    return o->objects && o->rays && o->judged;
}

int main(int argc, char **argv) {
    static const double OFFSETS[] = {1e3, 1e6, 1e9, 1e12};
    struct options o = {.objects = 2000, .rays = 1 << 16, .judged = 1 << 12, .embree = "auto"};
    if (!read_options(&o, argc, argv)) {
        fputs(USAGE, stderr);
        return 2;
    }
    struct embree_api *api = strcmp(o.embree, "none") == 0 ? NULL : embree_open(o.embree, NULL);
    FILE *file = o.json ? fopen(o.json, "w") : stdout;
    if (!file) {
        perror(o.json);
        return 1;
    }
    for (int w = 0; WORLDS[w]; w++) report_world(&o, WORLDS[w], 0, api, file);
    for (size_t i = 0; i < sizeof OFFSETS / sizeof *OFFSETS; i++) report_world(&o, "ordinary", OFFSETS[i], api, file);
    if (file != stdout) fclose(file);
    if (api) embree_close(api);
    return 0;
}
