/* SPDX-License-Identifier: MIT */
/*
 * Plays conformance cases: each case of each file on every set-up of the scene's grid that it names, with one worker
 * and with two. Usage: runner [--at-least N] [--only CASE] FILE...
 */
#include "calls.h"
#include "expect.h"
#include "trace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const setup setups[] = {
    {"uniform", RG_GRID_UNIFORM, false, false},
    {"hierarchical", RG_GRID_HIERARCHICAL, false, false},
    {"loose", RG_GRID_LOOSE, false, false},
    {"uniform-tiled", RG_GRID_UNIFORM, true, false},
    {"hierarchical-tiled", RG_GRID_HIERARCHICAL, true, false},
    {"uniform-rebuilt", RG_GRID_UNIFORM, false, true},
    {"hierarchical-rebuilt", RG_GRID_HIERARCHICAL, false, true},
    {"loose-rebuilt", RG_GRID_LOOSE, false, true},
};

typedef struct tally {
    const char *only;
    unsigned long cases, passed, failed;
} tally;

static rg_grid_config scene_grid(context *c, const json_t *given) {
    json_t *none = json_object();
    rg_grid_config config = read_grid_config(c, given ? given : none);
    json_decref(none);
    if (given && (c->setup->tiled || c->setup->rebuilt)) malformed(c, "set-up %s takes no grid", c->setup->name);
    for (int a = 0; a < 3 && c->setup->tiled; a++) {
        config.lo[a] = -1;
        config.hi[a] = 1;
    }
    if (c->setup->tiled) {
        config.resolution = 4;
        config.rebuild_factor = RG_REBUILD_NEVER;
    }
    return config;
}

static void open_scene(context *c, const json_t *one) {
    rg_grid_config grid = scene_grid(c, json_object_get(one, "grid"));
    rg_scene_config config;
    rg_scene_config_default(&config, sizeof config);
    config.workers = c->workers;
    config.grid = &grid;
    if (rg_scene_create(&config, &c->scene)) malformed(c, "no scene: %s", rg_error_message());
}

static void play_step(context *c, const json_t *step) {
    bool known;
    if (expect_step(c, step)) return;
    rg_result result = call_step(c, step, &known);
    if (!known) malformed(c, "unknown step \"%s\"", read_text(c, step, "do"));
    if (!c->broken && result)
        fail(c, "%s: %s: %s", read_text(c, step, "do"), rg_result_name(result), rg_error_message());
}

/* Plays a case once; returns whether all was as expected. */
static bool play_case(const json_t *one, const setup *setup, uint32_t workers) {
    const char *name = json_string_value(json_object_get(one, "name"));
    context c;
    memset(&c, 0, sizeof c);
    c.name = name ? name : "a case without a name";
    c.setup = setup;
    c.workers = workers;
    c.ray = -1;
    read_known_keys(&c, one, "name note numerics flags grids grid steps");
    const json_t *flags = read_array(&c, one, "flags"), *steps = read_array(&c, one, "steps");
    for (size_t i = 0; i < json_array_size(flags); i++) {
        const char *flag = json_string_value(json_array_get(flags, i));
        if (!flag || strcmp(flag, "costly") != 0) malformed(&c, "unknown flag \"%s\"", flag ? flag : "?");
        c.costly = true;
    }
    if (!json_array_size(steps)) malformed(&c, "no steps");
    if (!c.broken) open_scene(&c, one);
    for (c.step = 0; c.step < json_array_size(steps) && !c.broken; c.step++)
        play_step(&c, json_array_get(steps, c.step));
    if (c.scene && rg_scene_destroy(&c.scene)) fail(&c, "destroy: %s", rg_error_message());
    batch_free(c.last);
    names_free(&c.shapes);
    names_free(&c.objects);
    names_free(&c.grids);
    return c.failures == 0;
}

static const setup *setup_of(const char *name) {
    for (size_t i = 0; name && i < sizeof setups / sizeof *setups; i++) {
        if (strcmp(setups[i].name, name) == 0) return &setups[i];
    }
    printf("FAILED: unknown set-up \"%s\"\n", name ? name : "?");
    return NULL;
}

static void play_everywhere(tally *all, const json_t *one) {
    const json_t *grids = json_object_get(one, "grids");
    const char *name = json_string_value(json_object_get(one, "name"));
    if (all->only && (!name || strcmp(all->only, name) != 0)) return;
    all->cases++;
    if (!json_array_size(grids)) all->failed++;
    for (size_t i = 0; i < json_array_size(grids); i++) {
        const setup *setup = setup_of(json_string_value(json_array_get(grids, i)));
        bool good = setup && play_case(one, setup, 1);
        good = setup && play_case(one, setup, 2) && good;
        all->passed += good;
        all->failed += !good;
    }
}

static void play_file(tally *all, const char *path) {
    json_error_t error;
    json_t *cases = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!json_array_size(cases)) {
        printf("FAILED %s: %s\n", path, cases ? "no array of cases" : error.text);
        all->failed++;
    }
    for (size_t i = 0; i < json_array_size(cases); i++) play_everywhere(all, json_array_get(cases, i));
    json_decref(cases);
}

int main(int count, char **arguments) {
    tally all = {NULL, 0, 0, 0};
    unsigned long at_least = 1;
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "--at-least") == 0 && i + 1 < count) {
            at_least = strtoul(arguments[++i], NULL, 10);
        } else if (strcmp(arguments[i], "--only") == 0 && i + 1 < count) {
            all.only = arguments[++i];
        } else {
            play_file(&all, arguments[i]);
        }
    }
    if (all.cases < at_least) {
        printf("FAILED: %lu cases, expected at least %lu\n", all.cases, at_least);
        all.failed++;
    }
    printf("%lu cases on their grids: %lu passed, %lu failed\n", all.cases, all.passed, all.failed);
    return all.failed ? 1 : 0;
}
