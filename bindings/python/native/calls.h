/* SPDX-License-Identifier: MIT */
/*
 * What is said more cheaply in C than by one assignment after another from Python: views of arrays, and a trace with
 * all that it takes. And the ends of objects as functions of the pointer alone, as cffi's garbage collection wants
 * them.
 */
#ifndef RAYGRID_PYTHON_CALLS_H
#define RAYGRID_PYTHON_CALLS_H

#include <raygrid/raygrid.h>

#include <string.h>

/**
 * A trace, zeroed, then filled with what is given. Where answers go is said by `hits` or `occluded`, or, if they are
 * to go to new arrays without gaps, by the addresses of these: that takes less time. A query for any hit if
 * `occluded` or `any` is given.
 */
typedef struct py_trace {
    rg_ray_views rays;
    rg_hit_views hits;
    rg_output occluded;
    rg_trace_config config;
    uint64_t invalid;
    void *t, *position;              /* double */
    void *object;                    /* uint64_t */
    void *normal, *uv, *offset;      /* float */
    void *primitive, *cells, *tests; /* uint32_t */
    void *any;                       /* uint8_t */
} py_trace;

/*
 * Views of arrays, put into the struct of views `into`, `at` bytes from its start. `step` is from one record to the
 * next, `component` from x to y to z, in bytes.
 */

static void py_input(void *into, size_t at, const void *data, ptrdiff_t step, rg_type type) {
    const rg_input view = {data, step, type};
    memcpy((char *)into + at, &view, sizeof view);
}

static void py_input3(void *into, size_t at, const void *data, ptrdiff_t step, ptrdiff_t component, rg_type type) {
    const char *x = data;
    const rg_input3 view = {x, x + component, x + 2 * component, step, type};
    memcpy((char *)into + at, &view, sizeof view);
}

static void py_output(void *into, size_t at, void *data, ptrdiff_t step, rg_type type) {
    const rg_output view = {data, step, type};
    memcpy((char *)into + at, &view, sizeof view);
}

static void py_output3(void *into, size_t at, void *data, ptrdiff_t step, ptrdiff_t component, rg_type type) {
    char *x = data;
    const rg_output3 view = {x, x + component, x + 2 * component, step, type};
    memcpy((char *)into + at, &view, sizeof view);
}

static void py_new(rg_output *view, void *data, size_t step, rg_type type) {
    if (data) py_output(view, 0, data, (ptrdiff_t)step, type);
}

static void py_new3(rg_output3 *view, void *data, size_t size, rg_type type) {
    if (data) py_output3(view, 0, data, (ptrdiff_t)(3 * size), (ptrdiff_t)size, type);
}

static void py_new_arrays(py_trace *call) {
    float *uv = call->uv;
    py_new(&call->hits.t, call->t, sizeof(double), RG_F64);
    py_new3(&call->hits.position, call->position, sizeof(double), RG_F64);
    py_new(&call->hits.object, call->object, sizeof(uint64_t), RG_U64);
    py_new3(&call->hits.normal, call->normal, sizeof(float), RG_F32);
    py_new(&call->hits.u, uv, 2 * sizeof *uv, RG_F32);
    py_new(&call->hits.v, uv ? uv + 1 : NULL, 2 * sizeof *uv, RG_F32);
    py_new(&call->hits.offset, call->offset, sizeof(float), RG_F32);
    py_new(&call->hits.primitive, call->primitive, sizeof(uint32_t), RG_U32);
    py_new(&call->hits.cells, call->cells, sizeof(uint32_t), RG_U32);
    py_new(&call->hits.tests, call->tests, sizeof(uint32_t), RG_U32);
    py_new(&call->occluded, call->any, sizeof(uint8_t), RG_U8);
}

/* The rays' origins and directions come with the trace itself: that spares two calls from Python, which cost more. */

static rg_result py_scene_trace(rg_scene *scene, py_trace *call, rg_cull cull, uint64_t count, const void *origin,
                                ptrdiff_t origin_step, ptrdiff_t origin_component, rg_type origin_type,
                                const void *direction, ptrdiff_t direction_step, ptrdiff_t direction_component,
                                rg_type direction_type) {
    py_input3(&call->rays, offsetof(rg_ray_views, origin), origin, origin_step, origin_component, origin_type);
    py_input3(&call->rays, offsetof(rg_ray_views, direction), direction, direction_step, direction_component,
              direction_type);
    py_new_arrays(call);
    call->rays.size = sizeof call->rays;
    call->hits.size = sizeof call->hits;
    call->config.size = sizeof call->config;
    call->config.cull = cull;
    call->config.invalid = &call->invalid;
    if (call->occluded.data)
        return rg_scene_occluded_views(scene, &call->config, &call->rays, &call->occluded, count);
    return rg_scene_trace_views(scene, &call->config, &call->rays, &call->hits, count);
}

static void py_scene_end(rg_scene *scene) {
    rg_scene_destroy(&scene);
}

static void py_replay_end(rg_replay *replay) {
    rg_replay_destroy(&replay);
}

static void py_shape_end(rg_shape *shape) {
    rg_shape_release(&shape);
}

#endif
