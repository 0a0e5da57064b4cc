/* SPDX-License-Identifier: MIT */
/* The ways to trace a batch: plain and by views, one ray and many, double and float, forward and backward. */
#include "trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A batch of so many rays is large enough to be spread over workers. */
enum { MANY_RAYS = 4096 };

/* ------------------------------------------------------------------------- separate arrays, all outputs */

/* The rays field by field, and a place for every output, as doubles or as floats. */
typedef struct fields {
    size_t count;
    bool narrow;
    unsigned char *in;  /* 8 arrays: origin, direction, t_min, t_max */
    unsigned char *out; /* 10 arrays: t, normal, u, v, position, offset */
    uint32_t *masks;
    uint64_t *objects, *primitives;
    rg_ray_views rays;
    rg_hit_views hits;
} fields;

enum { INPUTS = 8, OUTPUTS = 10 };

static size_t width(const fields *f) {
    return f->narrow ? sizeof(float) : sizeof(double);
}

static void put(const fields *f, size_t array, size_t i, double value) {
    float narrowed = (float)value;
    unsigned char *at = f->in + (array * f->count + i) * width(f);
    memcpy(at, f->narrow ? (const void *)&narrowed : (const void *)&value, width(f));
}

static double get(const fields *f, size_t array, size_t i) {
    float narrowed;
    double value;
    const unsigned char *at = f->out + (array * f->count + i) * width(f);
    if (!f->narrow) return memcpy(&value, at, sizeof value), value;
    return memcpy(&narrowed, at, sizeof narrowed), (double)narrowed;
}

static rg_input input(const fields *f, size_t array) {
    const rg_input view = {f->in + array * f->count * width(f), (ptrdiff_t)width(f), f->narrow ? RG_F32 : RG_F64};
    return view;
}

static rg_input3 input3(const fields *f, size_t array) {
    const rg_input3 view = {input(f, array).data, input(f, array + 1).data, input(f, array + 2).data,
                            (ptrdiff_t)width(f), f->narrow ? RG_F32 : RG_F64};
    return view;
}

static rg_output output(const fields *f, size_t array) {
    const rg_output view = {f->out + array * f->count * width(f), (ptrdiff_t)width(f), f->narrow ? RG_F32 : RG_F64};
    return view;
}

static rg_output3 output3(const fields *f, size_t array) {
    const rg_output3 view = {output(f, array).data, output(f, array + 1).data, output(f, array + 2).data,
                             (ptrdiff_t)width(f), f->narrow ? RG_F32 : RG_F64};
    return view;
}

static void fields_views(fields *f, outcome *o) {
    memset(&f->rays, 0, sizeof f->rays);
    memset(&f->hits, 0, sizeof f->hits);
    f->rays.size = sizeof f->rays;
    f->rays.origin = input3(f, 0);
    f->rays.direction = input3(f, 3);
    f->rays.t_min = input(f, 6);
    f->rays.t_max = input(f, 7);
    f->rays.mask = (rg_input){f->masks, sizeof *f->masks, RG_U32};
    f->hits.size = sizeof f->hits;
    f->hits.t = output(f, 0);
    f->hits.normal = output3(f, 1);
    f->hits.u = output(f, 4);
    f->hits.v = output(f, 5);
    f->hits.position = output3(f, 6);
    f->hits.offset = output(f, 9);
    f->hits.object = (rg_output){f->objects, sizeof *f->objects, RG_U64};
    f->hits.primitive = (rg_output){f->primitives, sizeof *f->primitives, RG_U64};
    f->hits.cells = (rg_output){o->cells, sizeof *o->cells, RG_U32};
    f->hits.tests = (rg_output){o->tests, sizeof *o->tests, RG_U32};
}

static bool fields_make(fields *f, const batch *b, bool narrow, outcome *o) {
    size_t room = b->count ? b->count : 1;
    memset(f, 0, sizeof *f);
    f->count = b->count;
    f->narrow = narrow;
    f->in = calloc(room * INPUTS, sizeof(double));
    f->out = calloc(room * OUTPUTS, sizeof(double));
    f->masks = calloc(room, sizeof *f->masks);
    f->objects = calloc(room, sizeof *f->objects);
    f->primitives = calloc(room, sizeof *f->primitives);
    if (!f->in || !f->out || !f->masks || !f->objects || !f->primitives) return false;
    for (size_t i = 0; i < b->count; i++) {
        for (size_t a = 0; a < 3; a++) put(f, a, i, b->rays[i].origin[a]);
        for (size_t a = 0; a < 3; a++) put(f, 3 + a, i, b->rays[i].direction[a]);
        put(f, 6, i, b->rays[i].t_min);
        put(f, 7, i, b->rays[i].t_max);
        f->masks[i] = b->rays[i].mask;
    }
    fields_views(f, o);
    return true;
}

static void fields_free(fields *f) {
    free(f->in);
    free(f->out);
    free(f->masks);
    free(f->objects);
    free(f->primitives);
}

static void fields_hits(const fields *f, rg_hit *hits) {
    for (size_t i = 0; i < f->count; i++) {
        rg_hit *h = &hits[i];
        memset(h, 0, sizeof *h);
        h->t = get(f, 0, i);
        h->object = f->objects[i];
        h->primitive = (uint32_t)f->primitives[i];
        for (size_t a = 0; a < 3; a++) h->normal[a] = (float)get(f, 1 + a, i);
        h->u = (float)get(f, 4, i);
        h->v = (float)get(f, 5, i);
        for (size_t a = 0; a < 3; a++) h->position[a] = get(f, 6 + a, i);
        h->offset = (float)get(f, 9, i);
    }
}

static rg_trace_config trace_config(const batch *b, uint64_t *invalid) {
    rg_trace_config config;
    rg_trace_config_default(&config, sizeof config);
    config.cull = b->cull;
    config.invalid = invalid;
    return config;
}

static rg_result path_fields(const context *c, const batch *b, bool narrow, outcome *o, uint64_t *invalid) {
    fields f;
    rg_trace_config config = trace_config(b, invalid);
    rg_result result = RG_OUT_OF_MEMORY;
    *invalid = 0;
    if (fields_make(&f, b, narrow, o)) {
        result = rg_scene_trace_views(c->scene, &config, &f.rays, &f.hits, b->count);
        fields_hits(&f, o->hits);
    }
    fields_free(&f);
    return result;
}

rg_result path_separate(const context *c, const batch *b, outcome *o, uint64_t *invalid) {
    return path_fields(c, b, false, o, invalid);
}

/* ------------------------------------------------------------------------------------------- other paths */

static rg_result path_one_by_one(context *c, const batch *b, rg_hit *hits) {
    rg_result result = RG_OK;
    for (size_t i = 0; i < b->count && !result; i++) result = rg_scene_trace(c->scene, &b->rays[i], &hits[i], 1);
    return result;
}

static rg_result path_whole(context *c, const batch *b, rg_hit *hits) {
    return rg_scene_trace(c->scene, b->rays, hits, b->count);
}

/* All fields of plain records, the last record first. */
static void backward(const batch *b, rg_hit *hits, rg_ray_views *in, rg_hit_views *out) {
    const rg_ray *ray = b->rays + b->count - 1;
    rg_hit *hit = hits + b->count - 1;
    const ptrdiff_t rs = -(ptrdiff_t)sizeof *ray, hs = -(ptrdiff_t)sizeof *hit;
    const rg_ray_views rays = {sizeof rays,
                               rg_input3_packed(ray->origin, rs, RG_F64),
                               rg_input3_packed(ray->direction, rs, RG_F64),
                               {&ray->t_min, rs, RG_F64},
                               {&ray->t_max, rs, RG_F64},
                               {&ray->mask, rs, RG_U32}};
    const rg_hit_views views = {sizeof views,
                                {&hit->t, hs, RG_F64},
                                {&hit->object, hs, RG_U64},
                                {&hit->primitive, hs, RG_U32},
                                rg_output3_packed(hit->normal, hs, RG_F32),
                                {&hit->u, hs, RG_F32},
                                {&hit->v, hs, RG_F32},
                                rg_output3_packed(hit->position, hs, RG_F64),
                                {&hit->offset, hs, RG_F32},
                                {NULL, 0, RG_U32},
                                {NULL, 0, RG_U32}};
    *in = rays;
    *out = views;
}

static rg_result trace_backward(context *c, const batch *b, rg_hit *hits, const rg_trace_config *config) {
    rg_ray_views in;
    rg_hit_views out;
    if (!b->count) return RG_OK;
    backward(b, hits, &in, &out);
    for (size_t i = 0; i < b->count; i++) hits[i].reserved = 0;
    return rg_scene_trace_views(c->scene, config, &in, &out, b->count);
}

static rg_result path_backward(context *c, const batch *b, rg_hit *hits) {
    uint64_t invalid;
    rg_trace_config config = trace_config(b, &invalid);
    return trace_backward(c, b, hits, &config);
}

/* The last record is the first of the call: what the filter is told must fit the ray. */
static int32_t accept_all(void *user, uint64_t index, const rg_hit *candidate) {
    const batch *b = user;
    const rg_ray *ray = &b->rays[b->count - 1 - (size_t)index];
    bool sane = index < b->count && candidate->t >= ray->t_min && candidate->t <= ray->t_max &&
                candidate->object != RG_NO_OBJECT && candidate->primitive != RG_NO_PRIMITIVE;
    return sane ? 1 : -1;
}

static rg_result path_filtered(context *c, const batch *b, rg_hit *hits) {
    uint64_t invalid;
    rg_trace_config config = trace_config(b, &invalid);
    config.filter = accept_all;
    config.filter_user = (void *)b;
    return trace_backward(c, b, hits, &config);
}

static void compare_paths(context *c, const batch *b, const rg_hit *hits) {
    for (size_t i = 0; i < b->count; i++) {
        c->ray = (long)i;
        if (!same_hit(&b->first.hits[i], &hits[i]))
            fail(c, "differs from the first path: %s, was %s", hit_text(c, &hits[i]), hit_text(c, &b->first.hits[i]));
    }
    c->ray = -1;
}

static void play(context *c, const batch *b, const char *name,
                 rg_result (*path)(context *, const batch *, rg_hit *)) {
    outcome o;
    rg_scene_report before = {.size = sizeof before}, after = {.size = sizeof after};
    c->path = name;
    rg_scene_stats(c->scene, &before);
    if (!outcome_make(&o, b->count)) malformed(c, "out of memory");
    rg_result result = c->broken ? RG_OK : path(c, b, o.hits);
    rg_scene_stats(c->scene, &after);
    if (result) fail(c, "%s: %s", rg_result_name(result), rg_error_message());
    if (after.invalid_rays - before.invalid_rays != b->invalid)
        fail(c, "the scene counted %.0f invalid rays, not %zu", (double)(after.invalid_rays - before.invalid_rays),
             b->invalid);
    if (!c->broken) compare_paths(c, b, o.hits);
    outcome_free(&o);
}

/* ---------------------------------------------------------------------------------- floats in and out */

/* Through memory: gcc 12's vectorizer drops the rounding of (double)(float)x where it handles two at once. */
static double as_float(double x) {
    volatile float narrowed = (float)x;
    return (double)narrowed;
}

static bool is_float(double x) {
    return isnan(x) || as_float(x) == x;
}

static bool all_floats(const batch *b) {
    bool all = true;
    for (size_t i = 0; i < b->count; i++) {
        const rg_ray *r = &b->rays[i];
        for (int a = 0; a < 3; a++) all = all && is_float(r->origin[a]) && is_float(r->direction[a]);
        all = all && is_float(r->t_min) && is_float(r->t_max);
    }
    return all;
}

static void play_floats(context *c, const batch *b) {
    outcome o;
    uint64_t invalid = 0;
    c->path = "views, float";
    if (!outcome_make(&o, b->count)) malformed(c, "out of memory");
    rg_result result = c->broken ? RG_OK : path_fields(c, b, true, &o, &invalid);
    if (result) fail(c, "%s: %s", rg_result_name(result), rg_error_message());
    for (size_t i = 0; i < b->count && !c->broken; i++) {
        rg_hit wanted = b->first.hits[i];
        c->ray = (long)i;
        wanted.t = as_float(wanted.t);
        for (int a = 0; a < 3; a++) wanted.position[a] = as_float(wanted.position[a]);
        if (!same_hit(&wanted, &o.hits[i])) fail(c, "is %s, was %s", hit_text(c, &o.hits[i]), hit_text(c, &wanted));
    }
    c->ray = -1;
    outcome_free(&o);
}

/* ---------------------------------------------------------------------------------------------- any hit */

static void compare_occluded(context *c, const batch *b, const uint8_t *occluded, size_t step) {
    for (size_t i = 0; i < b->count; i++) {
        unsigned wanted = b->first.hits[i].object != RG_NO_OBJECT;
        c->ray = (long)i;
        if (occluded[i * step] != wanted)
            fail(c, "occluded is %u, the closest hit is %s", (unsigned)occluded[i * step],
                 hit_text(c, &b->first.hits[i]));
    }
    c->ray = -1;
}

static void play_occluded(context *c, const batch *b) {
    enum { STEP = 3 };
    rg_ray_views in;
    rg_hit_views unused;
    uint64_t invalid;
    rg_trace_config config = trace_config(b, &invalid);
    uint8_t *bytes = malloc(b->count * STEP + 1);
    if (!bytes || !b->count) {
        free(bytes);
        return;
    }
    backward(b, b->first.hits, &in, &unused);
    const rg_output out = {bytes + (b->count - 1) * STEP, -STEP, RG_U8};
    memset(bytes, 0x5A, b->count * STEP + 1);
    c->path = "occluded, views";
    if (rg_scene_occluded_views(c->scene, &config, &in, &out, b->count)) fail(c, "%s", rg_error_message());
    compare_occluded(c, b, bytes, STEP);
    config.filter = accept_all;
    config.filter_user = (void *)b;
    memset(bytes, 0x5A, b->count * STEP + 1);
    c->path = "occluded, filtered";
    if (rg_scene_occluded_views(c->scene, &config, &in, &out, b->count)) fail(c, "%s", rg_error_message());
    compare_occluded(c, b, bytes, STEP);
    c->path = "occluded, plain";
    memset(bytes, 0x5A, b->count);
    if (b->cull == RG_CULL_NONE && rg_scene_occluded(c->scene, b->rays, bytes, b->count))
        fail(c, "%s", rg_error_message());
    if (b->cull == RG_CULL_NONE) compare_occluded(c, b, bytes, 1);
    free(bytes);
}

/* ------------------------------------------------------------------------------- spread over the workers */

/* The batch again and again in one call: copies far apart are traced by different workers. */
static void play_many(context *c, const batch *b) {
    size_t copies = MANY_RAYS / (b->count ? b->count : 1) + 1, count = b->count * copies;
    if (c->costly || !b->count) return;
    batch large = *b;
    large.count = count;
    large.invalid = b->invalid * copies;
    large.rays = malloc(count * sizeof *large.rays);
    large.first.hits = malloc(count * sizeof *large.first.hits);
    if (!large.rays || !large.first.hits) {
        malformed(c, "out of memory");
    } else {
        for (size_t i = 0; i < count; i++) {
            large.rays[i] = b->rays[i % b->count];
            large.first.hits[i] = b->first.hits[i % b->count];
        }
        if (b->cull == RG_CULL_NONE) play(c, &large, "plain, many", path_whole);
        play(c, &large, "views, many", path_backward);
        play(c, &large, "views filtered, many", path_filtered);
    }
    free(large.rays);
    free(large.first.hits);
}

void paths_play(context *c, const batch *b) {
    if (b->cull == RG_CULL_NONE) {
        play(c, b, "plain, one ray a call", path_one_by_one);
        play(c, b, "plain, whole", path_whole);
    }
    play(c, b, "views, backward", path_backward);
    play(c, b, "views, filtered", path_filtered);
    if (all_floats(b)) play_floats(c, b);
    play_occluded(c, b);
    if (c->workers > 1) play_many(c, b);
}
