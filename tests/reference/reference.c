/* SPDX-License-Identifier: MIT */
/* reference.c: the objects of a scene, and the loop over all of them. */
#include "internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NO_INDEX UINT32_MAX

static void give_up(const char *why) {
    fprintf(stderr, "reference: %s\n", why);
    abort();
}

void *reference_allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) give_up("out of memory");
    return memory;
}

static void *resized(void *memory, size_t bytes) {
    memory = realloc(memory, bytes);
    if (!memory) give_up("out of memory");
    return memory;
}

reference_scene *reference_create(void) {
    reference_scene *scene = reference_allocate(1, sizeof *scene);
    scene->bound = (reference_bound){0x1p-40, 0x1p-100, 0, 0x1p-50};
    return scene;
}

void reference_set_bound(reference_scene *scene, const reference_bound *bound) {
    scene->bound = *bound;
}

void reference_destroy(reference_scene *scene) {
    if (!scene) return;
    while (scene->shapes) {
        reference_shape *shape = scene->shapes;
        scene->shapes = shape->next;
        free(shape->vertices);
        free(shape->indices);
        free(shape);
    }
    free(scene->objects);
    free(scene->index_of_slot);
    free(scene);
}

/* ------------------------------------------------------------------------------------------------ objects */

const object *find_object(const reference_scene *scene, rg_object id) {
    uint32_t slot = RG_OBJECT_SLOT(id);
    if (slot >= scene->slots || scene->index_of_slot[slot] == NO_INDEX) return NULL;
    const object *o = &scene->objects[scene->index_of_slot[slot]];
    return o->id == id ? o : NULL;
}

static object *known_object(reference_scene *scene, rg_object id) {
    const object *o = find_object(scene, id);
    if (!o) give_up("no such object");
    return &scene->objects[o - scene->objects];
}

static const object *known_object_const(const reference_scene *scene, rg_object id) {
    const object *o = find_object(scene, id);
    if (!o) give_up("no such object");
    return o;
}

static void make_slot(reference_scene *scene, uint32_t slot) {
    if (slot < scene->slots) return;
    size_t slots = 2 * (size_t)slot + 64;
    scene->index_of_slot = resized(scene->index_of_slot, slots * sizeof *scene->index_of_slot);
    for (size_t i = scene->slots; i < slots; i++) scene->index_of_slot[i] = NO_INDEX;
    scene->slots = slots;
}

static object *make_object(reference_scene *scene, rg_object id) {
    uint32_t slot = RG_OBJECT_SLOT(id);
    if (id == RG_NO_OBJECT) give_up("RG_NO_OBJECT can't be inserted");
    make_slot(scene, slot);
    if (scene->index_of_slot[slot] != NO_INDEX) give_up("two objects in one slot");
    if (scene->count == scene->capacity) {
        scene->capacity = 2 * scene->capacity + 64;
        scene->objects = resized(scene->objects, scene->capacity * sizeof *scene->objects);
    }
    scene->index_of_slot[slot] = (uint32_t)scene->count;
    return &scene->objects[scene->count++];
}

void reference_insert(reference_scene *scene, rg_object id, const reference_shape *shape, const rg_pose *pose,
                      uint32_t mask) {
    object *o = make_object(scene, id);
    *o = (object){.id = id, .shape = shape, .pose = *pose, .mask = mask, .bound = scene->bound};
    prepare_object(o);
}

void reference_share(reference_scene *scene, const reference_scene *from, rg_object id) {
    *make_object(scene, id) = *known_object_const(from, id);
}

void reference_clear(reference_scene *scene) {
    for (size_t i = 0; i < scene->count; i++) {
        scene->index_of_slot[RG_OBJECT_SLOT(scene->objects[i].id)] = NO_INDEX;
    }
    scene->count = 0;
}

void reference_move(reference_scene *scene, rg_object id, const rg_pose *pose) {
    object *o = known_object(scene, id);
    o->pose = *pose;
    prepare_object(o);
}

void reference_set_mask(reference_scene *scene, rg_object id, uint32_t mask) {
    known_object(scene, id)->mask = mask;
}

void reference_remove(reference_scene *scene, rg_object id) {
    object *o = known_object(scene, id), *last = &scene->objects[--scene->count];
    scene->index_of_slot[RG_OBJECT_SLOT(id)] = NO_INDEX;
    if (o == last) return;
    *o = *last;
    scene->index_of_slot[RG_OBJECT_SLOT(o->id)] = (uint32_t)(o - scene->objects);
}

bool reference_has(const reference_scene *scene, rg_object id) {
    return find_object(scene, id) != NULL;
}
size_t reference_count(const reference_scene *scene) {
    return scene->count;
}
rg_object reference_object(const reference_scene *scene, size_t index) {
    return scene->objects[index].id;
}

const rg_pose *reference_pose(const reference_scene *scene, rg_object id) {
    return &known_object_const(scene, id)->pose;
}

uint32_t reference_mask(const reference_scene *scene, rg_object id) {
    return known_object_const(scene, id)->mask;
}

/* ------------------------------------------------------------------------------------------------- bounds */

/* The extent along one axis of the box, relative to the position. */
static void box_extent(const reference_shape *s, const real row[3], real *lo, real *hi) {
    for (int i = 0; i < 3; i++) {
        if (row[i] == 0) continue; /* an infinite axis must not make 0 * inf */
        *lo += row[i] * (row[i] > 0 ? s->lo[i] : s->hi[i]);
        *hi += row[i] * (row[i] > 0 ? s->hi[i] : s->lo[i]);
    }
}

static void mesh_extent(const reference_shape *s, const real row[3], real *lo, real *hi) {
    *lo = HUGE_VALL;
    *hi = -HUGE_VALL;
    for (size_t k = 0; k < 3 * s->triangle_count; k++) {
        const double *v = s->vertices + 3 * (size_t)s->indices[k];
        real at = row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
        *lo = fminl(*lo, at);
        *hi = fmaxl(*hi, at);
    }
}

static void round_extent(const reference_shape *s, const real row[3], real *lo, real *hi) {
    const real r[3] = {row[0], row[1], row[2]};
    real reach = s->r * length(r), a = dot(r, s->a), b = dot(r, s->b);
    *lo = fminl(a, b) - reach;
    *hi = fmaxl(a, b) + reach;
}

void reference_bounds(const reference_scene *scene, rg_object id, double lo[3], double hi[3]) {
    const object *o = known_object_const(scene, id);
    for (int i = 0; i < 3; i++) {
        const real *row = o->matrix + 3 * i;
        real least = 0, most = 0;
        switch (o->shape->kind) {
        case RG_SHAPE_BOX:
            box_extent(o->shape, row, &least, &most);
            break;
        case RG_SHAPE_MESH:
            mesh_extent(o->shape, row, &least, &most);
            break;
        default:
            round_extent(o->shape, row, &least, &most);
            break;
        }
        lo[i] = (double)(o->pose.position[i] + least);
        hi[i] = (double)(o->pose.position[i] + most);
    }
}

/* ------------------------------------------------------------------------------------------------- traces */

bool reference_valid(const rg_ray *ray) {
    bool moves = false;
    for (int i = 0; i < 3; i++) {
        if (!(fabs(ray->origin[i]) <= RG_COORDINATE_MAX) || !isfinite(ray->direction[i])) return false;
        moves = moves || ray->direction[i] != 0;
    }
    return moves && ray->t_min <= ray->t_max; /* false for NaN as well */
}

/* 2^340, a little more than 2e102, in units of the direction's largest component rounded down to a power of two. */
rg_ray within_reach(const rg_ray *ray) {
    rg_ray near = *ray;
    int exponent;
    frexp(fmax(fmax(fabs(ray->direction[0]), fabs(ray->direction[1])), fabs(ray->direction[2])), &exponent);
    double reach = ldexp(1, 341 - exponent);
    near.t_min = fmax(ray->t_min, -reach);
    near.t_max = fmin(ray->t_max, reach);
    return near;
}

int side_of(const line *at, const crossing *where) {
    real facing = dot(at->direction, where->normal);
    return (facing > 0) - (facing < 0);
}

/* What a trace knows on its way. */
typedef struct search {
    const line *at;
    real t_min, t_max;
    rg_cull cull;
    bool in_double; /* t counts as rounded to double */
    bool found;
    crossing best;
} search;

static void consider(void *context, const crossing *c) {
    search *s = context;
    real t = s->in_double ? (real)(double)c->t : c->t;
    if (fabsl(t) > DBL_MAX) return; /* no double can report it */
    if (t < s->t_min || t > s->t_max || culled(s->cull, side_of(s->at, c))) return;
    if (s->found && (c->t > s->best.t || (c->t == s->best.t && c->primitive >= s->best.primitive))) return;
    s->found = true;
    s->best = *c;
}

static bool closest_of_object(const object *o, const rg_ray *ray, rg_cull cull, crossing *best, line *at) {
    *at = line_to_object(o, ray, NULL);
    search s = {.at = at, .t_min = ray->t_min, .t_max = ray->t_max, .cull = cull};
    cross_shape(o->shape, at, consider, &s);
    *best = s.best;
    return s.found;
}

static void write_hit(const object *o, const rg_ray *ray, const crossing *c, reference_hit *hit) {
    const real d[3] = {ray->direction[0], ray->direction[1], ray->direction[2]};
    *hit = (reference_hit){.t = c->t, .object = o->id, .primitive = c->primitive, .u = c->u, .v = c->v};
    normal_to_world(o, c->normal, hit->normal);
    hit->cosine = dot(hit->normal, d) / length(d);
}

bool reference_trace(const reference_scene *scene, const rg_ray *ray, rg_cull cull, reference_hit *hit) {
    const object *best_object = NULL;
    crossing best = {0};
    bool valid = reference_valid(ray);
    rg_ray near = within_reach(ray);
    for (size_t i = 0; valid && i < scene->count; i++) {
        const object *o = &scene->objects[i];
        crossing c;
        line at;
        if (!(o->mask & ray->mask) || passes_by(o, ray, 0)) continue;
        if (!closest_of_object(o, &near, cull, &c, &at)) continue;
        if (best_object && (c.t > best.t || (c.t == best.t && o->id > best_object->id))) continue;
        best_object = o;
        best = c;
    }
    *hit = (reference_hit){.t = HUGE_VALL, .object = RG_NO_OBJECT, .primitive = RG_NO_PRIMITIVE};
    if (best_object) write_hit(best_object, ray, &best, hit);
    return best_object != NULL;
}

bool reference_occluded(const reference_scene *scene, const rg_ray *ray, rg_cull cull) {
    if (!reference_valid(ray)) return false;
    rg_ray near = within_reach(ray);
    for (size_t i = 0; i < scene->count; i++) {
        const object *o = &scene->objects[i];
        crossing c;
        line at;
        if (!(o->mask & ray->mask) || passes_by(o, ray, 0)) continue;
        if (closest_of_object(o, &near, cull, &c, &at)) return true;
    }
    return false;
}

int32_t reference_intersect(const reference_shape *shape, const rg_local_ray *ray, rg_local_hit *hit) {
    rg_ray world = {.t_min = ray->t_min, .t_max = ray->t_max};
    object o = {.shape = shape, .plain = true, .radius = shape->radius};
    memcpy(world.origin, ray->origin, sizeof world.origin);
    memcpy(world.direction, ray->direction, sizeof world.direction);
    memcpy(o.centre, shape->centre, sizeof o.centre);
    line at = line_to_object(&o, &world, NULL);
    /* The range may end at the very t that was returned before, rounded: it must be found again. */
    search s = {.at = &at, .t_min = ray->t_min, .t_max = ray->t_max, .in_double = true};
    cross_shape(shape, &at, consider, &s);
    if (!s.found) return 0;
    *hit = (rg_local_hit){.t = (double)s.best.t, .primitive = s.best.primitive};
    hit->u = (double)s.best.u;
    hit->v = (double)s.best.v;
    /* Length 1 first: the raw normal of a mesh may be too small for a double. */
    real l = length(s.best.normal);
    for (int i = 0; i < 3; i++) hit->normal[i] = (double)(s.best.normal[i] / l);
    return 1;
}
