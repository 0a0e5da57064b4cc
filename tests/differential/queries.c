/* SPDX-License-Identifier: MIT */
/* queries.c: every answer of the library is put before the reference; every way to ask must give the same answer. */
#include "world.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Prints all that is needed to look at one bad answer. */
static void fail_on(const world *w, const rg_ray *ray, rg_cull cull, const rg_hit *got, const char *what) {
    reference_hit want;
    reference_trace(w->reference, ray, cull, &want);
    world_dump_ray(ray);
    fprintf(stderr, "  cull %d; got object %llx primitive %u t %a normal (%g, %g, %g)\n", (int)cull,
            (unsigned long long)got->object, got->primitive, got->t, got->normal[0], got->normal[1], got->normal[2]);
    fprintf(stderr, "  position (%a, %a, %a) u %g v %g offset %g\n", got->position[0], got->position[1],
            got->position[2], got->u, got->v, got->offset);
    fprintf(stderr, "  expected object %llx primitive %u t %La normal (%Lg, %Lg, %Lg) cosine %Lg u %Lg v %Lg\n",
            (unsigned long long)want.object, want.primitive, want.t, want.normal[0], want.normal[1], want.normal[2],
            want.cosine, want.u, want.v);
    world_dump_object(w, "got", got->object);
    world_dump_object(w, "expected", want.object);
    world_fail(w, "%s", what);
}

static void judge(world *w, const rg_ray *ray, rg_cull cull, const rg_hit *got) {
    reference_error error;
    reference_verdict verdict = reference_compare(w->reference, ray, cull, got, &error);
    if (verdict == REFERENCE_WRONG) fail_on(w, ray, cull, got, error.what);
    w->counts.rays++;
    w->counts.hits += got->object != RG_NO_OBJECT;
    w->counts.within_bound += verdict == REFERENCE_WITHIN_BOUND;
    if (verdict != REFERENCE_EQUAL || got->object == RG_NO_OBJECT) return;
    w->counts.worst_t = fmaxl(w->counts.worst_t, error.t / error.t_bound);
    w->counts.worst_normal = fmaxl(w->counts.worst_normal, error.normal);
}

static void judge_occluded(world *w, const rg_ray *ray, rg_cull cull, const rg_hit *got, uint8_t occluded) {
    reference_verdict verdict = reference_compare_occluded(w->reference, ray, cull, occluded != 0);
    if (occluded > 1) fail_on(w, ray, cull, got, "occluded is neither 0 nor 1");
    if (verdict == REFERENCE_WRONG) fail_on(w, ray, cull, got, "occluded");
    w->counts.occluded++;
    w->counts.within_bound += verdict == REFERENCE_WITHIN_BOUND;
}

/* Where a ray starts that goes on from a hit: off the surface by the offset, rounded as a host would. */
static rg_ray reflected(world *w, const rg_hit *hit, bool outward) {
    rg_ray ray = {.t_max = HUGE_VAL, .mask = UINT32_MAX};
    double d[3], along;
    do {
        random_direction(&w->random, d);
        along = d[0] * hit->normal[0] + d[1] * hit->normal[1] + d[2] * hit->normal[2];
    } while (fabs(along) < 1e-3);
    bool flip = (along > 0) != outward;
    for (int i = 0; i < 3; i++) {
        double step = (double)hit->offset * hit->normal[i];
        ray.origin[i] = hit->position[i] + (outward ? step : -step);
        ray.direction[i] = flip ? -d[i] : d[i];
    }
    return ray;
}

/*
 * A ray that goes on from a hit must not meet the same spot again. On a convex shape no ray to the outside meets the
 * object at all; on a mesh, none to either side the same triangle.
 */
static void check_offset(world *w, const rg_hit *hit) {
    rg_object_report object = {.size = sizeof object};
    rg_shape_report shape = {.size = sizeof shape};
    world_expect(w, "rg_scene_lookup", rg_scene_lookup(w->scene, hit->object, &object), RG_OK);
    world_expect(w, "rg_shape_stats", rg_shape_stats(object.shape, &shape), RG_OK);
    bool mesh = shape.kind == RG_SHAPE_MESH;
    if (shape.kind == RG_SHAPE_USER) return; /* its surface is the host's */
    rg_ray ray = reflected(w, hit, !mesh || random_once_in(&w->random, 2));
    rg_hit again;
    if (!reference_valid(&ray)) return;
    world_expect(w, "rg_scene_trace", rg_scene_trace(w->scene, &ray, &again, 1), RG_OK);
    judge(w, &ray, RG_CULL_NONE, &again);
    w->counts.reflected++;
    if (again.object == hit->object && (!mesh || again.primitive == hit->primitive)) {
        fail_on(w, &ray, RG_CULL_NONE, &again, "a ray that leaves a hit by its offset meets the same spot again");
    }
}

static void trace_and_judge(world *w, const rg_ray *rays, rg_hit *hits, uint8_t *occluded, uint32_t count) {
    world_expect(w, "rg_scene_trace", rg_scene_trace(w->scene, rays, hits, count), RG_OK);
    world_expect(w, "rg_scene_occluded", rg_scene_occluded(w->scene, rays, occluded, count), RG_OK);
    for (uint32_t i = 0; i < count; i++) {
        judge(w, &rays[i], RG_CULL_NONE, &hits[i]);
        judge_occluded(w, &rays[i], RG_CULL_NONE, &hits[i], occluded[i]);
        w->invalid_rays += reference_valid(&rays[i]) ? 0 : 2;
    }
}

void world_query_plain(world *w, uint32_t count) {
    rg_ray rays[WORLD_BATCH] = {{{0}, {0}, 0, 0, 0, 0}};
    rg_hit hits[WORLD_BATCH];
    uint8_t occluded[WORLD_BATCH];
    memset(hits, 0xA5, sizeof hits);
    world_rays(w, rays, count);
    trace_and_judge(w, rays, hits, occluded, count);
    for (uint32_t i = 0; i < count; i++) {
        if (hits[i].object != RG_NO_OBJECT && random_once_in(&w->random, 8)) check_offset(w, &hits[i]);
    }
}

void world_query_shadows(world *w, uint32_t count) {
    const batch_space space = {{w->centre[0], w->centre[1], w->centre[2]}, w->spread};
    rg_ray rays[WORLD_BATCH];
    rg_hit hits[WORLD_BATCH], behind[WORLD_BATCH];
    uint8_t occluded[WORLD_BATCH];
    world_rays(w, rays, count);
    trace_and_judge(w, rays, hits, occluded, count);
    batch_shadows(&w->random, &space, hits, rays, count);
    trace_and_judge(w, rays, behind, occluded, count);
}

/* ---------------------------------------------------------------------------------------------------- views */

/* Rays by parts: origins of interleaved doubles, directions from the last ray to the first. */
typedef struct ray_parts {
    double origin[WORLD_BATCH][3], direction[3][WORLD_BATCH], t_min[WORLD_BATCH], t_max[WORLD_BATCH];
    uint32_t mask[WORLD_BATCH];
} ray_parts;

static rg_ray_views split_rays(const rg_ray *rays, uint32_t count, ray_parts *parts) {
    rg_ray_views views = {.size = sizeof views};
    uint32_t last = count - 1;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            parts->origin[i][k] = rays[i].origin[k];
            parts->direction[k][last - i] = rays[i].direction[k];
        }
        parts->t_min[i] = rays[i].t_min;
        parts->t_max[i] = rays[i].t_max;
        parts->mask[i] = rays[i].mask;
    }
    views.origin = rg_input3_packed(parts->origin[0], sizeof parts->origin[0], RG_F64);
    views.direction = (rg_input3){&parts->direction[0][last], &parts->direction[1][last], &parts->direction[2][last],
                                  -(ptrdiff_t)sizeof(double), RG_F64};
    views.t_min = (rg_input){parts->t_min, sizeof(double), RG_F64};
    views.t_max = (rg_input){parts->t_max, sizeof(double), RG_F64};
    views.mask = (rg_input){parts->mask, sizeof(uint32_t), RG_U32};
    return views;
}

/* Hits by parts: the types that rg_hit has, and the others. */
typedef struct hit_parts {
    rg_hit hits[WORLD_BATCH];
    float t[WORLD_BATCH], position[WORLD_BATCH][3];
    double normal[WORLD_BATCH][3], u[WORLD_BATCH], v[WORLD_BATCH], offset[WORLD_BATCH];
    uint64_t primitive[WORLD_BATCH];
    uint32_t cells[WORLD_BATCH], tests[WORLD_BATCH];
} hit_parts;

static rg_hit_views same_types(hit_parts *parts) {
    rg_hit *h = parts->hits;
    const ptrdiff_t stride = sizeof *h;
    rg_hit_views views = {.size = sizeof views};
    memset(parts->hits, 0, sizeof parts->hits);
    views.t = (rg_output){&h->t, stride, RG_F64};
    views.object = (rg_output){&h->object, stride, RG_U64};
    views.primitive = (rg_output){&h->primitive, stride, RG_U32};
    views.normal = rg_output3_packed(h->normal, stride, RG_F32);
    views.u = (rg_output){&h->u, stride, RG_F32};
    views.v = (rg_output){&h->v, stride, RG_F32};
    views.position = rg_output3_packed(h->position, stride, RG_F64);
    views.offset = (rg_output){&h->offset, stride, RG_F32};
    return views;
}

/* Counting may keep a library from taking the way that it takes otherwise. */
static void count_too(rg_hit_views *views, hit_parts *parts) {
    views->cells = (rg_output){parts->cells, sizeof(uint32_t), RG_U32};
    views->tests = (rg_output){parts->tests, sizeof(uint32_t), RG_U32};
}

/* No more than tells what is hit, and where, and perhaps the normal: what is not asked for may be found another way,
 * or not at all. */
static rg_hit_views little(rg_hit *hits, uint32_t count, bool normals) {
    const ptrdiff_t stride = sizeof *hits;
    rg_hit_views views = {.size = sizeof views};
    memset(hits, 0, count * sizeof *hits);
    views.t = (rg_output){&hits->t, stride, RG_F64};
    views.object = (rg_output){&hits->object, stride, RG_U64};
    views.primitive = (rg_output){&hits->primitive, stride, RG_U32};
    if (normals) views.normal = rg_output3_packed(hits->normal, stride, RG_F32);
    return views;
}

static rg_hit_views other_types(hit_parts *parts) {
    rg_hit_views views = {.size = sizeof views};
    views.t = (rg_output){parts->t, sizeof(float), RG_F32};
    views.primitive = (rg_output){parts->primitive, sizeof(uint64_t), RG_U64};
    views.normal = rg_output3_packed(parts->normal[0], sizeof parts->normal[0], RG_F64);
    views.u = (rg_output){parts->u, sizeof(double), RG_F64};
    views.v = (rg_output){parts->v, sizeof(double), RG_F64};
    views.position = rg_output3_packed(parts->position[0], sizeof parts->position[0], RG_F32);
    views.offset = (rg_output){parts->offset, sizeof(double), RG_F64};
    return views;
}

/* Whether both may be roundings of one number; NaN is one. */
static bool same_as_float(double wide, float narrow) {
    if (isnan(wide)) return isnan(narrow);
    return (float)wide == narrow || fabs(wide - narrow) <= 0x1p-23 * fabs(wide) + FLT_MIN;
}

static bool agree(const rg_hit *h, const hit_parts *p, uint32_t i) {
    bool same = same_as_float(h->t, p->t[i]) && same_as_float(p->offset[i], h->offset) &&
                same_as_float(p->u[i], h->u) && same_as_float(p->v[i], h->v) &&
                (p->primitive[i] == h->primitive || (p->primitive[i] == UINT64_MAX && h->object == RG_NO_OBJECT));
    for (int k = 0; k < 3; k++) {
        same = same && same_as_float(h->position[k], p->position[i][k]);
        same = same && same_as_float(p->normal[i][k], h->normal[k]);
    }
    return same;
}

/* ---------------------------------------------------------------------------------------------------- filter */

typedef struct filter_data {
    const world *w;
    uint64_t count;
} filter_data;

/* Objects in odd slots let rays pass. */
static int32_t only_even_slots(void *user, uint64_t index, const rg_hit *candidate) {
    const filter_data *data = user;
    if (index >= data->count) world_fail(data->w, "a filter was asked about ray %llu", (unsigned long long)index);
    if (!reference_has(data->w->reference, candidate->object)) world_fail(data->w, "a filter was shown no object");
    return RG_OBJECT_SLOT(candidate->object) % 2 == 0;
}

static void hide_odd_slots(world *w, uint32_t *masks) {
    for (size_t n = 0; n < reference_count(w->reference); n++) {
        rg_object id = reference_object(w->reference, n);
        masks[n] = reference_mask(w->reference, id);
        if (RG_OBJECT_SLOT(id) % 2 == 1) reference_set_mask(w->reference, id, 0);
    }
}

static void show_all_slots(world *w, const uint32_t *masks) {
    for (size_t n = 0; n < reference_count(w->reference); n++) {
        reference_set_mask(w->reference, reference_object(w->reference, n), masks[n]);
    }
}

void world_query_filtered(world *w, uint32_t count) {
    rg_ray rays[WORLD_BATCH] = {{{0}, {0}, 0, 0, 0, 0}};
    uint8_t occluded[WORLD_BATCH];
    ray_parts in;
    hit_parts out;
    filter_data data = {w, count};
    rg_trace_config config = {.size = sizeof config, .filter = only_even_slots, .filter_user = &data};
    config.cull = (rg_cull)random_below(&w->random, 3);
    config.coherence = (rg_coherence)random_below(&w->random, 3);
    world_rays(w, rays, count);
    for (uint32_t i = 0; i < count; i++) {
        w->invalid_rays += reference_valid(&rays[i]) ? 0 : 2;
    }
    rg_ray_views views = split_rays(rays, count, &in);
    rg_hit_views wanted = same_types(&out);
    rg_output flags = {occluded, 1, RG_U8};
    rg_result result = rg_scene_trace_views(w->scene, &config, &views, &wanted, count);
    world_expect(w, "rg_scene_trace_views", result, RG_OK);
    result = rg_scene_occluded_views(w->scene, &config, &views, &flags, count);
    world_expect(w, "rg_scene_occluded_views", result, RG_OK);
    uint32_t *masks = malloc((reference_count(w->reference) + 1) * sizeof *masks);
    if (!masks) world_fail(w, "out of memory");
    hide_odd_slots(w, masks);
    for (uint32_t i = 0; i < count; i++) {
        judge(w, &rays[i], config.cull, &out.hits[i]);
        judge_occluded(w, &rays[i], config.cull, &out.hits[i], occluded[i]);
    }
    show_all_slots(w, masks);
    free(masks);
}

/* ------------------------------------------------------------------------------------------ views and culling */

void world_query_views(world *w, uint32_t count) {
    static const rg_cull CULLS[] = {RG_CULL_NONE, RG_CULL_BACK, RG_CULL_FRONT};
    rg_ray rays[WORLD_BATCH] = {{{0}, {0}, 0, 0, 0, 0}};
    rg_hit plain[WORLD_BATCH], few[WORLD_BATCH];
    uint8_t occluded[WORLD_BATCH];
    ray_parts in;
    hit_parts out;
    uint64_t invalid = 0, expected_invalid = 0;
    rg_trace_config config = {.size = sizeof config, .invalid = &invalid};
    config.cull = CULLS[random_below(&w->random, 3)];
    config.coherence = (rg_coherence)random_below(&w->random, 3); /* true or not, it changes no answer */
    world_rays(w, rays, count);
    for (uint32_t i = 0; i < count; i++) {
        expected_invalid += !reference_valid(&rays[i]);
    }
    rg_ray_views views = split_rays(rays, count, &in);
    bool normals = random_once_in(&w->random, 2);
    rg_hit_views wanted = same_types(&out), others = other_types(&out), least = little(few, count, normals);
    if (random_once_in(&w->random, 2)) count_too(&wanted, &out);
    rg_output flags = {occluded, 1, RG_U8};
    rg_result result = rg_scene_trace_views(w->scene, &config, &views, &wanted, count);
    world_expect(w, "rg_scene_trace_views", result, RG_OK);
    if (invalid != expected_invalid) world_fail(w, "the number of invalid rays of a call is wrong");
    result = rg_scene_trace_views(w->scene, &config, &views, &others, count);
    world_expect(w, "rg_scene_trace_views", result, RG_OK);
    result = rg_scene_trace_views(w->scene, &config, &views, &least, count);
    world_expect(w, "rg_scene_trace_views", result, RG_OK);
    result = rg_scene_occluded_views(w->scene, &config, &views, &flags, count);
    world_expect(w, "rg_scene_occluded_views", result, RG_OK);
    world_expect(w, "rg_scene_trace", rg_scene_trace(w->scene, rays, plain, count), RG_OK);
    w->invalid_rays += 5 * expected_invalid;
    for (uint32_t i = 0; i < count; i++) {
        const rg_hit *h = &out.hits[i];
        judge(w, &rays[i], config.cull, h);
        judge_occluded(w, &rays[i], config.cull, h, occluded[i]);
        bool same = few[i].object == h->object && few[i].primitive == h->primitive;
        same &= !normals || memcmp(few[i].normal, h->normal, sizeof h->normal) == 0;
        if (!same || (few[i].t != h->t && !(isnan(few[i].t) && isnan(h->t))))
            fail_on(w, &rays[i], config.cull, &few[i], "another hit where less is asked for");
        if (!agree(h, &out, i)) fail_on(w, &rays[i], config.cull, h, "outputs of other types differ");
        /* `reserved` has no view: it stays 0 in both. */
        if (config.cull == RG_CULL_NONE && memcmp(h, &plain[i], sizeof *h) != 0) {
            fail_on(w, &rays[i], config.cull, &plain[i], "views and plain arrays differ");
        }
    }
}
