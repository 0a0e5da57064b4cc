/* SPDX-License-Identifier: MIT */
#include "trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes in places that the library is to write: a hit that it forgot is then none. */
enum { UNWRITTEN = 0xA5 };

bool outcome_make(outcome *o, size_t count) {
    size_t room = count ? count : 1;
    o->hits = malloc(room * sizeof *o->hits);
    o->cells = malloc(room * sizeof *o->cells);
    o->tests = malloc(room * sizeof *o->tests);
    if (!o->hits || !o->cells || !o->tests) return false;
    memset(o->hits, UNWRITTEN, room * sizeof *o->hits);
    memset(o->cells, UNWRITTEN, room * sizeof *o->cells);
    memset(o->tests, UNWRITTEN, room * sizeof *o->tests);
    return true;
}

void outcome_free(outcome *o) {
    free(o->hits);
    free(o->cells);
    free(o->tests);
    memset(o, 0, sizeof *o);
}

void batch_free(batch *b) {
    if (!b) return;
    outcome_free(&b->first);
    free(b->rays);
    free(b);
}

static rg_cull read_cull(context *c, const json_t *value) {
    static const char *const words[] = {"none", "back", "front"};
    const char *text = json_string_value(value);
    if (!value) return RG_CULL_NONE;
    if (json_is_integer(value)) return (rg_cull)json_integer_value(value);
    for (rg_cull i = 0; text && i < 3; i++) {
        if (strcmp(text, words[i]) == 0) return i;
    }
    malformed(c, "\"%s\" is no way to cull", text ? text : "?");
    return RG_CULL_NONE;
}

static void read_ray(context *c, const json_t *line, rg_ray *ray) {
    const double origin[3] = {0, 0, 0}, direction[3] = {0, 0, 1};
    read_known_keys(c, line, "origin direction t_min t_max mask hit");
    *ray = rg_ray_from(origin, direction);
    read_numbers(c, line, "origin", 3, ray->origin);
    read_numbers(c, line, "direction", 3, ray->direction);
    if (json_object_get(line, "t_min")) ray->t_min = read_number(c, json_object_get(line, "t_min"));
    if (json_object_get(line, "t_max")) ray->t_max = read_number(c, json_object_get(line, "t_max"));
    ray->mask = (uint32_t)read_integer(c, line, "mask", UINT32_MAX, ray->mask);
}

static batch *read_batch(context *c, const json_t *step) {
    batch *b = calloc(1, sizeof *b);
    const json_t *lines = read_array(c, step, "rays");
    if (!b) {
        malformed(c, "out of memory");
        return NULL;
    }
    b->lines = lines;
    b->count = json_array_size(lines);
    b->cull = read_cull(c, json_object_get(step, "cull"));
    b->respawn = json_object_get(step, "respawn");
    b->rays = calloc(b->count ? b->count : 1, sizeof *b->rays);
    if (!b->rays || !outcome_make(&b->first, b->count)) malformed(c, "out of memory");
    for (size_t i = 0; i < b->count && !c->broken; i++) {
        const json_t *line = json_array_get(lines, i);
        const char *word = json_string_value(json_object_get(line, "hit"));
        read_ray(c, line, &b->rays[i]);
        b->invalid += word && strcmp(word, "invalid") == 0;
    }
    return b;
}

rg_result trace_once(context *c, const json_t *step) {
    batch *b = read_batch(c, step);
    uint64_t invalid;
    rg_result result = c->broken ? MALFORMED : path_separate(c, b, &b->first, &invalid);
    batch_free(b);
    return result;
}

/* A direction on the side of the surface from which the ray came. */
static void turn_outside(const rg_ray *ray, const rg_hit *hit, double direction[3]) {
    double ray_side = 0, own_side = 0;
    for (int a = 0; a < 3; a++) {
        ray_side += ray->direction[a] * hit->normal[a];
        own_side += direction[a] * hit->normal[a];
    }
    for (int a = 0; a < 3 && ray_side * own_side > 0; a++) direction[a] = -direction[a];
}

/* From each hit a ray in each direction of "respawn", moved by the offset, must not hit the same object. */
static void respawn(context *c, const batch *b) {
    c->path = "respawn";
    for (size_t i = 0; i < b->count * json_array_size(b->respawn); i++) {
        const rg_hit *hit = &b->first.hits[i % b->count];
        double direction[3], origin[3], along = 0;
        if (hit->object == RG_NO_OBJECT) continue;
        c->ray = (long)(i % b->count);
        read_vector(c, json_array_get(b->respawn, i / b->count), direction);
        turn_outside(&b->rays[i % b->count], hit, direction);
        for (int a = 0; a < 3; a++) along += direction[a] * hit->normal[a];
        for (int a = 0; a < 3; a++)
            origin[a] = hit->position[a] + copysign((double)hit->offset, along) * (double)hit->normal[a];
        rg_ray again = rg_ray_from(origin, direction);
        rg_hit found;
        if (rg_scene_trace(c->scene, &again, &found, 1) != RG_OK) fail(c, "%s", rg_error_message());
        if (found.object != hit->object) continue;
        fail(c, "direction %zu leaves %s, and hits it again: %s", i / b->count, hit_text(c, hit),
             hit_text(c, &found));
    }
    c->ray = -1;
}

void trace_play(context *c, const json_t *step) {
    uint64_t invalid = UINT64_MAX;
    batch *b = read_batch(c, step);
    if (c->setup->rebuilt && rg_grid_rebuild(c->scene, RG_GRID_OF_SCENE) != RG_OK) fail(c, "%s", rg_error_message());
    if (!c->broken) {
        c->path = "views, separate";
        rg_result result = path_separate(c, b, &b->first, &invalid);
        if (result) fail(c, "%s: %s", rg_result_name(result), rg_error_message());
        if (invalid != b->invalid) fail(c, "%zu invalid rays, counted %.0f", b->invalid, (double)invalid);
        compare_with_script(c, b, &b->first);
        paths_play(c, b);
        respawn(c, b);
    }
    c->path = NULL;
    batch_free(c->last);
    c->last = b;
}

void trace_again(context *c) {
    outcome o;
    uint64_t invalid;
    const batch *b = c->last;
    if (!b) return;
    c->path = "again after the error";
    if (!outcome_make(&o, b->count)) malformed(c, "out of memory");
    rg_result result = c->broken ? RG_OK : path_separate(c, b, &o, &invalid);
    if (result) fail(c, "%s: %s", rg_result_name(result), rg_error_message());
    for (size_t i = 0; i < b->count && !c->broken; i++) {
        c->ray = (long)i;
        if (!same_hit(&b->first.hits[i], &o.hits[i]))
            fail(c, "was %s, is %s", hit_text(c, &b->first.hits[i]), hit_text(c, &o.hits[i]));
    }
    outcome_free(&o);
    c->path = NULL;
    c->ray = -1;
}
