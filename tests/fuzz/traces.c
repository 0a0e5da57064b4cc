/* SPDX-License-Identifier: MIT */
/* traces.c: queries with hostile rays and views; and the reference's judgement at the end. */
#include "script.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RAYS = 5, NEIGHBOURS = 16 };

static bool misbehaves(const script *s) {
    for (int i = 0; i < s->object_count; i++) {
        if (s->misbehaves[i] && reference_has(s->reference, s->objects[i])) return true;
    }
    return false;
}

/* Whether the reference can tell right from wrong for what there is. */
static bool can_judge(const script *s) {
    for (int i = 0; i < s->object_count; i++) {
        if (s->wild[i] && reference_has(s->reference, s->objects[i])) return false;
    }
    return !misbehaves(s);
}

static void print_object(const script *s, const char *which, rg_object id) {
    if (!reference_has(s->reference, id)) return;
    rg_object_report object = {.size = sizeof object};
    rg_shape_report shape = {.size = sizeof shape};
    if (rg_scene_lookup(s->scene, id, &object) == RG_OK) rg_shape_stats(object.shape, &shape);
    fprintf(stderr, "%s %" PRIx64 ": mask 0x%" PRIx32 ", kind %d, local (%a, %a, %a) to (%a, %a, %a)\n", which, id,
            object.mask, (int)shape.kind, shape.lo[0], shape.lo[1], shape.lo[2], shape.hi[0], shape.hi[1],
            shape.hi[2]);
    fprintf(stderr, "at (%a, %a, %a), linear", object.pose.position[0], object.pose.position[1],
            object.pose.position[2]);
    for (int i = 0; i < 9; i++) fprintf(stderr, " %a", object.pose.linear[i]);
    fprintf(stderr, ", scale %a\n", object.pose.scale);
}

static void fail_on(const script *s, const rg_ray *ray, rg_cull cull, const rg_hit *hit, const char *why) {
    reference_hit want;
    reference_trace(s->reference, ray, cull, &want);
    fprintf(stderr, "\nray {%a, %a, %a} {%a, %a, %a} t %a to %a mask 0x%" PRIx32 " cull %d\n", ray->origin[0],
            ray->origin[1], ray->origin[2], ray->direction[0], ray->direction[1], ray->direction[2], ray->t_min,
            ray->t_max, ray->mask, (int)cull);
    fprintf(stderr, "got object %" PRIx64 " primitive %" PRIu32 " t %a, position (%a, %a, %a)\n", hit->object,
            hit->primitive, hit->t, hit->position[0], hit->position[1], hit->position[2]);
    fprintf(stderr, "normal (%g, %g, %g) u %g v %g offset %g\n", hit->normal[0], hit->normal[1], hit->normal[2],
            hit->u, hit->v, hit->offset);
    fprintf(stderr, "expected object %" PRIx64 " primitive %" PRIu32 " t %La cosine %Lg\n", want.object,
            want.primitive, want.t, want.cosine);
    fprintf(stderr, "normal (%Lg, %Lg, %Lg) u %Lg v %Lg\n", want.normal[0], want.normal[1], want.normal[2], want.u,
            want.v);
    print_object(s, "got", hit->object);
    print_object(s, "expected", want.object);
    script_fail(why);
}

static void judge_ray(const script *s, const rg_ray *ray, rg_cull cull, const rg_hit *hit) {
    reference_error error;
    if (!can_judge(s)) return;
    if (reference_compare(s->reference, ray, cull, hit, &error) == REFERENCE_WRONG) {
        fail_on(s, ray, cull, hit, error.what);
    }
}

void trace_plain(script *s) {
    rg_ray rays[RAYS];
    rg_hit hits[RAYS];
    uint8_t occluded[RAYS];
    for (int i = 0; i < RAYS; i++) rays[i] = read_ray(s);
    rg_result result = script_check(rg_scene_trace(s->scene, rays, hits, RAYS));
    if (result != RG_OK && !(result == RG_CALLBACK_FAILED && misbehaves(s))) script_fail("a trace failed");
    for (int i = 0; i < RAYS; i++) judge_ray(s, &rays[i], RG_CULL_NONE, &hits[i]);
    result = script_check(rg_scene_occluded(s->scene, rays, occluded, RAYS));
    if (result != RG_OK && !(result == RG_CALLBACK_FAILED && misbehaves(s))) script_fail("an occluded query failed");
    for (int i = 0; i < RAYS && can_judge(s); i++) {
        reference_verdict verdict = reference_compare_occluded(s->reference, &rays[i], RG_CULL_NONE, occluded[i]);
        if (verdict == REFERENCE_WRONG) {
            fail_on(s, &rays[i], RG_CULL_NONE, &hits[i], occluded[i] ? "occluded by nothing" : "not occluded");
        }
    }
}

static int32_t filter(void *user, uint64_t index, const rg_hit *candidate) {
    const script *s = user;
    if (index >= RAYS || !reference_has(s->reference, candidate->object)) script_fail("a filter was asked nonsense");
    if (s->filter_fails) return -1;
    return candidate->primitive % 2 == 0;
}

static rg_ray_views ray_views(script *s, const rg_ray *rays, uint8_t flags) {
    rg_ray_views views = {.size = read_size(s, sizeof views)};
    const ptrdiff_t stride = flags & 1 ? 0 : (ptrdiff_t)sizeof *rays;
    views.origin = rg_input3_packed(rays->origin, stride, RG_F64);
    views.direction = rg_input3_packed(rays->direction, stride, RG_F64);
    if (flags & 2) views.t_min = (rg_input){&rays->t_min, stride, RG_F64};
    if (flags & 4) views.t_max = (rg_input){&rays->t_max, stride, (rg_type)read_below(s, 2)};
    if (flags & 8) views.mask = (rg_input){&rays->mask, stride, RG_U32};
    if (flags & 16) views.origin.type = (rg_type)read_below(s, 8) - 1;
    if (flags & 32) views.direction.x = NULL;
    if (flags & 64) views.mask.type = (rg_type)read_below(s, 8) - 1;
    return views;
}

/* Each output is wanted or not, of any type; room is there for the widest. */
typedef struct room {
    double t[RAYS], normal[3][RAYS], u[RAYS], v[RAYS], position[3][RAYS], offset[RAYS];
    uint64_t object[RAYS], primitive[RAYS], cells[RAYS], tests[RAYS];
} room;

static rg_output one(script *s, void *data, rg_type right) {
    uint8_t kind = read_byte(s);
    return (rg_output){kind & 1 ? data : NULL, sizeof(double), kind > 230 ? (rg_type)(kind % 8) - 1 : right};
}

static rg_output3 three(script *s, double data[3][RAYS], rg_type right) {
    uint8_t kind = read_byte(s);
    rg_type type = kind > 230 ? (rg_type)(kind % 8) - 1 : right;
    return (rg_output3){kind & 1 ? data[0] : NULL, data[1], kind == 250 ? NULL : data[2], sizeof(double), type};
}

static rg_hit_views hit_views(script *s, room *out) {
    rg_hit_views views = {.size = read_size(s, sizeof views)};
    views.t = one(s, out->t, RG_F64);
    views.object = one(s, out->object, RG_U64);
    views.primitive = one(s, out->primitive, RG_U32);
    views.normal = three(s, out->normal, RG_F32);
    views.u = one(s, out->u, RG_F32);
    views.v = one(s, out->v, RG_F64);
    views.position = three(s, out->position, RG_F64);
    views.offset = one(s, out->offset, RG_F32);
    views.cells = one(s, out->cells, RG_U32);
    views.tests = one(s, out->tests, RG_U32);
    return views;
}

static rg_trace_config trace_config(script *s, uint64_t *invalid) {
    rg_trace_config config = {.size = read_size(s, sizeof config), .invalid = invalid};
    uint8_t flags = read_byte(s);
    config.cull = (rg_cull)(flags % 5) - (flags == 255);
    if (flags & 32) config.filter = filter, config.filter_user = s;
    s->filter_fails = (flags & 64) != 0;
    return config;
}

void trace_views(script *s) {
    rg_ray rays[RAYS];
    room out;
    uint64_t invalid = 0;
    for (int i = 0; i < RAYS; i++) rays[i] = read_ray(s);
    rg_ray_views in = ray_views(s, rays, read_byte(s));
    rg_hit_views wanted = hit_views(s, &out);
    rg_trace_config config = trace_config(s, &invalid);
    script_check(rg_scene_trace_views(s->scene, &config, &in, &wanted, RAYS));
}

void occluded_views(script *s) {
    rg_ray rays[RAYS];
    uint64_t flags_of_rays[RAYS], invalid = 0;
    for (int i = 0; i < RAYS; i++) rays[i] = read_ray(s);
    rg_ray_views in = ray_views(s, rays, read_byte(s));
    rg_output out = one(s, flags_of_rays, RG_U8);
    rg_trace_config config = trace_config(s, &invalid);
    script_check(rg_scene_occluded_views(s->scene, &config, &in, &out, RAYS));
}

/* Neighbouring rays at an object, which may be taken through the scene together: all that is known of their hits, the
 * least that is, and whether there is one, must be the same as for each alone. */
static void judge_neighbours(script *s, const double from[3], const double along[3]) {
    rg_ray rays[NEIGHBOURS];
    rg_hit hits[NEIGHBOURS], few[NEIGHBOURS], alone;
    uint8_t occluded[NEIGHBOURS];
    for (int i = 0; i < NEIGHBOURS; i++) {
        const double d[3] = {along[0], along[1] + 0.002 * (i % 4), along[2] + 0.002 * (i / 4)};
        rays[i] = rg_ray_from(from, d);
    }
    rg_ray_views in = {.size = sizeof in};
    in.origin = rg_input3_packed(rays[0].origin, sizeof *rays, RG_F64);
    in.direction = rg_input3_packed(rays[0].direction, sizeof *rays, RG_F64);
    rg_hit_views out = {.size = sizeof out, .t = {&few[0].t, sizeof *few, RG_F64}};
    out.object = (rg_output){&few[0].object, sizeof *few, RG_U64};
    if (script_check(rg_scene_trace(s->scene, rays, hits, NEIGHBOURS)) != RG_OK) return;
    if (script_check(rg_scene_trace_views(s->scene, NULL, &in, &out, NEIGHBOURS)) != RG_OK) return;
    if (script_check(rg_scene_occluded(s->scene, rays, occluded, NEIGHBOURS)) != RG_OK) return;
    for (int i = 0; i < NEIGHBOURS && can_judge(s); i++) {
        judge_ray(s, &rays[i], RG_CULL_NONE, &hits[i]);
        if (script_check(rg_scene_trace(s->scene, &rays[i], &alone, 1)) != RG_OK) return;
        if (memcmp(&alone, &hits[i], sizeof alone) != 0)
            fail_on(s, &rays[i], RG_CULL_NONE, &hits[i], "another hit than alone");
        if ((few[i].t != alone.t && !isnan(alone.t)) || few[i].object != alone.object)
            fail_on(s, &rays[i], RG_CULL_NONE, &few[i], "another hit where less is asked for");
        if (occluded[i] != (alone.object != RG_NO_OBJECT))
            fail_on(s, &rays[i], RG_CULL_NONE, &hits[i], "occluded, or not, against the hit");
    }
}

/* From afar at each object and from its middle outward, each way of culling. */
void script_judge(script *s) {
    for (size_t n = 0; n < reference_count(s->reference); n++) {
        const double *at = reference_pose(s->reference, reference_object(s->reference, n))->position;
        double reach = 10 + fabs(at[0]) * 1e-3;
        const double from[3] = {at[0] - reach, at[1], at[2] + 0.125}, along[3] = {1, 0.03125, -0.015625};
        const double away[3] = {0.25, 1, n % 2 ? 0 : -3};
        if (n < 4) judge_neighbours(s, from, along);
        rg_ray rays[2] = {rg_ray_from(from, along), rg_ray_from(at, away)};
        rg_hit hits[2];
        rg_ray_views in = {.size = sizeof in};
        in.origin = rg_input3_packed(rays[0].origin, sizeof *rays, RG_F64);
        in.direction = rg_input3_packed(rays[0].direction, sizeof *rays, RG_F64);
        rg_hit_views out = {.size = sizeof out, .t = {&hits[0].t, sizeof *hits, RG_F64}};
        out.object = (rg_output){&hits[0].object, sizeof *hits, RG_U64};
        out.primitive = (rg_output){&hits[0].primitive, sizeof *hits, RG_U32};
        out.normal = rg_output3_packed(hits[0].normal, sizeof *hits, RG_F32);
        out.u = (rg_output){&hits[0].u, sizeof *hits, RG_F32};
        out.v = (rg_output){&hits[0].v, sizeof *hits, RG_F32};
        out.position = rg_output3_packed(hits[0].position, sizeof *hits, RG_F64);
        out.offset = (rg_output){&hits[0].offset, sizeof *hits, RG_F32};
        rg_trace_config config = {.size = sizeof config, .cull = (rg_cull)(n % 3)};
        memset(hits, 0, sizeof hits);
        rg_result result = script_check(rg_scene_trace_views(s->scene, &config, &in, &out, 2));
        if (result == RG_CALLBACK_FAILED && misbehaves(s)) continue;
        if (result != RG_OK) script_fail("a trace failed");
        for (int i = 0; i < 2; i++) judge_ray(s, &rays[i], config.cull, &hits[i]);
    }
}
