/* SPDX-License-Identifier: MIT */
/* shapes.c: shapes of any numbers; those that the library takes are also made in the reference. */
#include "script.h"

#include <math.h>

static bool usable(double x) {
    return fabs(x) <= RG_COORDINATE_MAX;
}

static void keep(script *s, rg_result result, rg_shape *shape, const reference_shape *reference, script_user *user) {
    if (result != RG_OK) script_fail("an error kept a shape");
    s->shapes[s->shape_count++] = (script_shape){shape, reference, user, false};
}

static void make_sphere(script *s) {
    double radius = read_number(s);
    rg_shape *shape = NULL;
    rg_result result = script_check(rg_shape_create_sphere(NULL, radius, &shape));
    bool right = radius >= RG_RADIUS_MIN && radius <= RG_COORDINATE_MAX;
    if (right != (result == RG_OK)) script_fail("a radius was judged wrong");
    if (right) keep(s, result, shape, reference_sphere(s->reference, radius), NULL);
}

static void make_box(script *s) {
    double lo[3], hi[3];
    rg_shape *shape = NULL;
    bool right = true;
    uint8_t flags = read_byte(s);
    for (int i = 0; i < 3; i++) {
        lo[i] = read_number(s);
        hi[i] = flags & 1 ? lo[i] + fabs(read_number(s)) : read_number(s);
        if (flags == 254) lo[i] = -HUGE_VAL, hi[i] = HUGE_VAL;
        right = right && lo[i] <= hi[i];
        right = right && (usable(lo[i]) || lo[i] == -HUGE_VAL) && (usable(hi[i]) || hi[i] == HUGE_VAL);
    }
    rg_result result = script_check(rg_shape_create_box(NULL, lo, hi, &shape));
    if (right != (result == RG_OK)) script_fail("the corners of a box were judged wrong");
    if (right) keep(s, result, shape, reference_box(s->reference, lo, hi), NULL);
}

static void make_capsule(script *s) {
    double a[3], b[3], radius;
    bool right = true;
    rg_shape *shape = NULL;
    for (int i = 0; i < 3; i++) {
        a[i] = read_number(s);
        b[i] = read_number(s);
        right = right && usable(a[i]) && usable(b[i]);
    }
    radius = read_number(s);
    right = right && radius >= RG_RADIUS_MIN && radius <= RG_COORDINATE_MAX;
    rg_result result = script_check(rg_shape_create_capsule(NULL, a, b, radius, &shape));
    if (right != (result == RG_OK)) script_fail("the numbers of a capsule were judged wrong");
    if (!right) return;
    keep(s, result, shape, reference_capsule(s->reference, a, b, radius), NULL);
    for (int i = 0; i < 3; i++) s->shapes[s->shape_count - 1].wild |= fmax(fabs(a[i]), fabs(b[i])) > 1e9 * radius;
}

enum { VERTICES = 6, TRIANGLES = 8 };

static void make_mesh(script *s) {
    static const uint32_t OCTAHEDRON[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    double v[3 * VERTICES] = {0};
    uint32_t index[3 * TRIANGLES + 1] = {0}; /* one more: they may be taken for wider ones */
    uint8_t flags = read_byte(s);
    rg_mesh_views views = {.size = read_size(s, sizeof views), .vertex_count = VERTICES, .triangle_count = TRIANGLES};
    bool right = views.size == sizeof views;
    for (int i = 0; i < VERTICES; i++) v[3 * i + i / 2] = i % 2 ? -1 : 1;
    for (int i = 0; flags & 1 && i < 3 * VERTICES; i++) v[i] = read_number(s);
    for (int i = 0; i < 3 * VERTICES; i++) right = right && usable(v[i]);
    for (int i = 0; i < 3 * TRIANGLES; i++) {
        index[i] = flags & 2 ? read_below(s, flags & 4 ? VERTICES + 1 : VERTICES) : OCTAHEDRON[i];
        right = right && index[i] < VERTICES;
    }
    views.vertices = rg_input3_packed(v, 3 * sizeof *v, RG_F64);
    views.indices = rg_input3_packed(index, 3 * sizeof *index, RG_U32);
    if (flags & 8) views.vertices.type = read_below(s, 8), right = right && views.vertices.type == RG_F64;
    if (flags & 16) views.indices.type = read_below(s, 8), right = right && views.indices.type == RG_U32;
    if (flags & 32) views.triangle_count = read_below(s, TRIANGLES + 1), right = right && views.triangle_count > 0;
    rg_shape *shape = NULL;
    rg_result result = script_check(rg_shape_create_mesh(NULL, &views, &shape));
    if (right && result != RG_OK) script_fail("a right mesh was refused");
    if (result == RG_OK && !right) rg_shape_release(&shape); /* of another type it may be right, but who knows how */
    if (result == RG_OK && right) {
        keep(s, result, shape, reference_mesh(s->reference, v, VERTICES, index, (size_t)views.triangle_count), NULL);
        for (int i = 0; i < 3 * VERTICES; i++) s->shapes[s->shape_count - 1].wild |= fabs(v[i]) > 1e9;
    }
}

/* ------------------------------------------------------------------------------------ user-defined shapes */

/* What a host must not do from a callback, and what it is told. */
static void try_to_change(script *s) {
    rg_scene *scene = s->scene;
    const rg_pose pose = {{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 1};
    const rg_grid_config config = {.size = sizeof config};
    rg_object id = s->object_count ? s->objects[0] : RG_NO_OBJECT;
    rg_grid grid;
    if (rg_scene_insert(scene, s->shapes[0].shape, &pose, &id) != RG_BUSY ||
        rg_grid_create(scene, &config, &grid) != RG_BUSY || rg_grid_rebuild(scene, RG_GRID_OF_SCENE) != RG_BUSY ||
        rg_scene_destroy(&scene) != RG_BUSY || scene != s->scene) {
        script_fail("a callback may change its scene");
    }
}

static void trace_from_inside(script *s) {
    const double origin[3] = {1, 2, 3}, direction[3] = {0, 0, 1};
    rg_ray ray = rg_ray_from(origin, direction);
    rg_hit hit;
    if (s->depth > 0) return; /* once: each object may do it for each other */
    s->depth++;
    rg_result result = rg_scene_trace(s->scene, &ray, &hit, 1);
    if (result != RG_OK && result != RG_CALLBACK_FAILED) script_fail("a callback may not trace");
    s->depth--;
}

static int32_t intersect(void *data, const rg_local_ray *ray, rg_local_hit *hit) {
    script_user *user = data;
    for (int i = 0; i < 3; i++) {
        if (!isfinite(ray->origin[i]) || !isfinite(ray->direction[i])) script_fail("a callback got a broken ray");
    }
    *hit = (rg_local_hit){.t = NAN};
    switch (user->misdeed) {
    case FAILS:
        return -1;
    case RETURNS_NAN:
        return 1;
    case RETURNS_NONSENSE:
        *hit = (rg_local_hit){.t = ray->t_max + 1, .normal = {NAN, 0, 0}, .u = HUGE_VAL, .primitive = 77};
        if (ray->origin[0] > 1) hit->t = ray->t_min;
        return 7;
    case CHANGES_SCENE:
        try_to_change(user->script);
        break;
    case TRACES_SCENE:
        trace_from_inside(user->script);
        break;
    default:
        break;
    }
    return reference_intersect(user->reference, ray, hit);
}

static int32_t occluded(void *data, const rg_local_ray *ray) {
    rg_local_hit hit;
    return intersect(data, ray, &hit);
}

static void destroyed(void *data) {
    script_user *user = data;
    if (user->destroyed++) script_fail("a user shape was destroyed twice");
}

static void make_user(script *s) {
    script_user *user = &s->users[s->shape_count];
    uint8_t flags = read_byte(s);
    rg_user_shape definition = {.size = read_size(s, sizeof definition), .user = user};
    definition.intersect = flags == 255 ? NULL : intersect;
    definition.occluded = flags & 1 ? occluded : NULL;
    definition.destroy = destroyed;
    bool right = definition.size == sizeof definition && definition.intersect;
    for (int i = 0; i < 3; i++) {
        definition.lo[i] = flags & 2 ? read_number(s) : -1;
        definition.hi[i] = flags & 2 ? read_number(s) : 1;
        right = right && definition.lo[i] <= definition.hi[i] && usable(definition.lo[i]) && usable(definition.hi[i]);
    }
    *user = (script_user){.script = s, .misdeed = flags & 4 ? (misdeed)((flags >> 3) % MISDEEDS) : NO_MISDEED};
    rg_shape *shape = NULL;
    rg_result result = script_check(rg_shape_create_user(NULL, &definition, &shape));
    if (right && result != RG_OK) script_fail("a right user shape was refused");
    if (result != RG_OK) return;
    if (!right) script_fail("a wrong user shape was taken");
    user->reference = reference_box(s->reference, definition.lo, definition.hi);
    keep(s, result, shape, user->reference, user);
    /* Of two surfaces in one place a callback may report one only, and if that is culled the other is lost. */
    for (int i = 0; i < 3; i++) {
        double thickness = definition.hi[i] - definition.lo[i],
               size = fabs(definition.lo[i]) + fabs(definition.hi[i]);
        s->shapes[s->shape_count - 1].wild |= thickness <= 1e-9 * fmax(1, size);
    }
}

void make_a_shape(script *s) {
    if (s->shape_count == MOST_SHAPES) return;
    switch (read_below(s, 5)) {
    case 0:
        make_sphere(s);
        break;
    case 1:
        make_box(s);
        break;
    case 2:
        make_capsule(s);
        break;
    case 3:
        make_mesh(s);
        break;
    default:
        make_user(s);
        break;
    }
}

/* Extra references come and go; the last one of a shape is given back at the end. */
void release_a_shape(script *s) {
    rg_shape *shape = s->shape_count ? s->shapes[read_byte(s) % s->shape_count].shape : NULL;
    rg_shape_report report = {.size = read_size(s, sizeof report)};
    rg_shape_retain(shape);
    script_check(rg_shape_stats(shape, &report));
    rg_shape_release(&shape);
    if (shape) script_fail("rg_shape_release left the pointer");
}
