/* SPDX-License-Identifier: MIT */
/*
 * compare.c: is an answer of the library right to the bounds of trace.h?
 *
 * Let e be what the bound lets an object's surface be off: of trace.h's 2^-40 k R, k the condition of its linear
 * part.
 *   - A hit is certain if the ray itself and eight rays moved aside by e, all around, each have one.
 *   - A reported hit is possible if one of the nine rays has it; or if the ray's point at the reported t lies within
 *     e of the reported primitive (which is the same as an error of e / |cos| in t), and all fits the nearest point
 *     of that. The nine alone would miss what is thinner than e.
 * A right answer is a possible hit, or a miss, such that no certain hit comes before it.
 */
#include "internal.h"

#include <string.h>

enum { SAMPLES = 9 };

/* An octagon of which the inner circle has radius 1. */
static const real OCTAGON = 1.0823922002923940L + 0.001L;

typedef struct judge {
    const object *o;
    const rg_ray *ray;
    rg_cull cull;
    real unit;              /* length of the direction */
    real aside[SAMPLES][3]; /* the first is zero */
} judge;

static real direction_length(const rg_ray *ray) {
    const real d[3] = {ray->direction[0], ray->direction[1], ray->direction[2]};
    return length(d);
}

static real distance_to(const object *o, const rg_ray *ray) {
    real from[3];
    for (int i = 0; i < 3; i++) from[i] = (real)o->pose.position[i] - ray->origin[i];
    return length(from);
}

/* So far away that trace.h promises nothing. */
static bool is_too_far(const object *o, const rg_ray *ray) {
    return distance_to(o, ray) > 0x1p60L * o->world_radius;
}

/*
 * The e above. From more than 2^60 radii away even twice the digits of a double come to an end. Infinite boxes have
 * no near point to start from, so what a double resolves at their distance must do.
 */
static real surface_bound(const object *o, const rg_ray *ray) {
    real part = isfinite(o->radius) ? o->bound.way : fmaxl(o->bound.way, 0x1p-48L);
    return o->bound.radius * o->condition * o->world_radius + part * distance_to(o, ray) + o->bound.length;
}

/* What trace.h allows t to be off, in world length. The last term is the spacing of the smallest doubles. */
static real t_bound(const object *o, const rg_ray *ray, real t, real cosine) {
    real unit = direction_length(ray), distance = fabsl(t) * unit;
    if (isfinite(o->radius)) distance = fmaxl(distance, distance_to(o, ray));
    return o->bound.t * distance + surface_bound(o, ray) / fabsl(cosine) + 0x1p-1074L * unit;
}

/* The largest of the surface in the world, or more. */
static real curvature(const object *o) {
    real least_stretch = o->stretch / o->condition;
    return o->shape->curvature * o->stretch / (least_stretch * least_stretch);
}

/* Normals are floats; and where the surface is curved they turn along with the point's own error. */
static real normal_bound(const object *o, const rg_ray *ray, real cosine) {
    real curved = curvature(o), distance = curved > 0 ? 0x1p-50L * distance_to(o, ray) : 0;
    return 0x1p-21L + 2 * curved * (distance + surface_bound(o, ray) / fabsl(cosine));
}

static judge judge_of(const object *o, const rg_ray *ray, rg_cull cull) {
    judge j = {.o = o, .ray = ray, .cull = cull, .unit = direction_length(ray)};
    real d[3], x[3], y[3];
    int least = 0;
    for (int i = 0; i < 3; i++) {
        d[i] = ray->direction[i] / j.unit;
        if (fabsl(d[i]) < fabsl(d[least])) least = i;
    }
    real axis[3] = {least == 0, least == 1, least == 2};
    cross(d, axis, x);
    cross(d, x, y);
    real radius = OCTAGON * surface_bound(o, ray), lx = length(x), ly = length(y);
    for (int k = 1; k < SAMPLES; k++) {
        real angle = 0.78539816339744830962L * (real)k;
        for (int i = 0; i < 3; i++) {
            j.aside[k][i] = radius * (cosl(angle) * x[i] / lx + sinl(angle) * y[i] / ly);
        }
    }
    return j;
}

static real cosine_at(const object *o, const rg_ray *ray, const crossing *c, real normal[3]) {
    const real d[3] = {ray->direction[0], ray->direction[1], ray->direction[2]};
    normal_to_world(o, c->normal, normal);
    return dot(normal, d) / length(d);
}

/* ---------------------------------------------------------------------------- details of one reported hit */

static real difference(const real a[3], const float b[3]) {
    real d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length(d);
}

/*
 * Whether u and v name the point, measured where it counts: as a distance in the world. They are ratios of areas as
 * the ray sees them, so slivers, and the more so if it grazes them, whose areas are far smaller than the numbers that
 * they come from, have less of their digits: what is rounded is a part of R times an edge, what it is divided by the
 * area times the cosine.
 */
static bool right_weights(const object *o, const crossing *c, const rg_hit *got, real bound, real cosine) {
    const reference_shape *s = o->shape;
    if (s->kind != RG_SHAPE_MESH) return got->u == 0 && got->v == 0;
    if (!(got->u >= 0 && got->v >= 0 && (real)got->u + got->v <= 1 + 0x1p-22L)) return false;
    const uint32_t *index = s->indices + 3 * (size_t)c->primitive;
    const double *v0 = s->vertices + 3 * (size_t)index[0];
    const double *v1 = s->vertices + 3 * (size_t)index[1], *v2 = s->vertices + 3 * (size_t)index[2];
    real apart[3], ab[3], ac[3];
    for (int i = 0; i < 3; i++) {
        const real *row = o->matrix + 3 * i;
        ab[i] = ac[i] = 0;
        for (int k = 0; k < 3; k++) {
            ab[i] += row[k] * ((real)v1[k] - v0[k]);
            ac[i] += row[k] * ((real)v2[k] - v0[k]);
        }
        apart[i] = (got->u - c->u) * ab[i] + (got->v - c->v) * ac[i];
    }
    real area[3], edges = length(ab) + length(ac);
    cross(ab, ac, area);
    real digits = 0x1p-22L + 0x1p-48L * o->condition * o->world_radius * edges / (length(area) * fabsl(cosine));
    return length(apart) <= 2 * bound + digits * edges;
}

/* origin + t * direction, rounded once; by the t reported or by the exact one. Where t or a component is
 * denormal, that is not much. */
static bool right_position(const rg_ray *ray, const rg_hit *got) {
    real denormal = 0x1p-1022L + 0x1p-1072L * (1 + fabsl(got->t)) * fmaxl(1, direction_length(ray));
    for (int i = 0; i < 3; i++) {
        real along = (real)got->t * ray->direction[i], exact = ray->origin[i] + along;
        real allowed = 0x1.01p-53L * (fabsl(exact) + fabsl(along)) + denormal;
        if (!(fabsl(got->position[i] - exact) <= allowed)) return false;
    }
    return true;
}

/* Places, objects and ways may be so large that a float can't hold what would be needed. */
static bool right_offset(const object *o, const rg_ray *ray, const rg_hit *got) {
    real most = o->world_radius * o->condition + fabsl(got->t) * direction_length(ray);
    for (int i = 0; i < 3; i++) most = fmaxl(most, fabsl(got->position[i]) + fabsl(o->pose.position[i]));
    return got->offset >= 0 && (isfinite(got->offset) || most > FLT_MAX || o->condition > 0x1p38L);
}

static bool is_clean_miss(const rg_hit *got) {
    return got->object == RG_NO_OBJECT && got->primitive == RG_NO_PRIMITIVE && got->position[0] == 0 &&
           got->position[1] == 0 && got->position[2] == 0 && got->normal[0] == 0 && got->normal[1] == 0 &&
           got->normal[2] == 0 && got->offset == 0 && got->u == 0 && got->v == 0;
}

/* ------------------------------------------------------------------------- possible and certain hits */

typedef struct certain {
    const judge *j;
    const line *at;
    real until;
    bool hit;
} certain;

static void try_certain(void *context, const crossing *c) {
    certain *s = context;
    const judge *j = s->j;
    real normal[3], cosine = cosine_at(j->o, j->ray, c, normal);
    if (culled(j->cull, side_of(s->at, c))) return;
    /* On an infinite box there are places of which doubles can't speak. */
    if (fabsl(c->t) * j->unit > 0x1p1000L) return;
    real slack = t_bound(j->o, j->ray, c->t, cosine) / j->unit;
    real last = fminl(fminl(j->ray->t_max, s->until), DBL_MAX);
    if (c->t - slack >= fmaxl(j->ray->t_min, -DBL_MAX) && c->t + slack <= last) s->hit = true;
}

/* Whether every one of the rays hits before `until`. */
static bool certainly_hit(const judge *j, real until) {
    for (int k = 0; k < SAMPLES; k++) {
        line at = line_to_object(j->o, j->ray, k ? j->aside[k] : NULL);
        certain s = {.j = j, .until = until, .at = &at};
        cross_shape(j->o->shape, &at, try_certain, &s);
        if (!s.hit) return false;
    }
    return true;
}

/*
 * Whether `apart`, local, from a point of the ray to a place of the surface, is as short as the bound allows: by e
 * across the surface, by e / |cos| along it. A direction in the surface may be stretched more than the one across, so
 * the two are measured each for itself; the one across by the covector, as the distance of two planes.
 */
static bool is_near(const object *o, const real apart[3], const real normal[3], real cosine, real e, real along) {
    real nn = dot(normal, normal), part = dot(apart, normal) / nn, unit[3], within[3];
    for (int i = 0; i < 3; i++) within[i] = apart[i] - part * normal[i];
    real scale = normal_to_world(o, normal, unit);
    return fabsl(part) * nn / scale <= e + along && length_in_world(o, within) <= e / fabsl(cosine) + along;
}

typedef struct match {
    const judge *j;
    const line *at;
    const rg_hit *got;
    bool place; /* nothing but the place is judged */
    bool found;
} match;

/* Is this crossing the one that was reported? */
static void try_match(void *context, const crossing *c) {
    match *m = context;
    const judge *j = m->j;
    real normal[3], cosine = cosine_at(j->o, j->ray, c, normal), bound = t_bound(j->o, j->ray, c->t, cosine);
    if (culled(j->cull, side_of(m->at, c)) || !(fabsl(c->t - m->got->t) * j->unit <= bound)) return;
    if (m->place) m->found = true;
    if (m->place || c->primitive != m->got->primitive) return;
    if (difference(normal, m->got->normal) > normal_bound(j->o, j->ray, cosine)) return;
    if (right_weights(j->o, c, m->got, bound, cosine)) m->found = true;
}

static bool found_by_a_ray(const judge *j, const rg_hit *got, bool place) {
    match m = {.j = j, .got = got, .place = place};
    for (int k = 0; k < SAMPLES && !m.found; k++) {
        line at = line_to_object(j->o, j->ray, k ? j->aside[k] : NULL);
        m.at = &at;
        cross_shape(j->o->shape, &at, try_match, &m);
    }
    return m.found;
}

/* What speaks against there being a surface as reported; NULL if nothing does. */
static const char *impossible(const object *o, const rg_ray *ray, rg_cull cull, const rg_hit *got) {
    line at = line_to_object(o, ray, NULL);
    real point[3], apart[3], normal[3], s = got->t - at.t_base, e = surface_bound(o, ray);
    place near;
    for (int i = 0; i < 3; i++) point[i] = at.base[i] + s * at.direction[i];
    if (!nearest_place(o->shape, got->primitive, point, &near)) return "no such primitive";
    for (int i = 0; i < 3; i++) apart[i] = near.point[i] - point[i];
    /* Of a triangle thinner than e the place is all that can be told. */
    if (near.thickness * o->stretch <= 8 * e && length_in_world(o, apart) <= 4 * e) return NULL;
    crossing c = {.t = got->t, .primitive = got->primitive, .u = near.u, .v = near.v};
    for (int i = 0; i < 3; i++) c.normal[i] = near.normal[i];
    real cosine = cosine_at(o, ray, &c, normal), along = t_bound(o, ray, got->t, 1) - e;
    real bound = 2 * e / fabsl(cosine) + along;
    if (!is_near(o, apart, near.normal, cosine, 1.5L * e, along)) return "no surface there";
    /* Where the surface turns away, its two sides come nearer to each other than e. */
    if (fabsl(cosine) > 0x1p-30L + 8 * sqrtl(curvature(o) * e) && culled(cull, side_of(&at, &c))) return "culled";
    if (!(difference(normal, got->normal) <= normal_bound(o, ray, 0.5L))) return "normal";
    return right_weights(o, &c, got, bound, cosine) ? NULL : "u or v";
}

/* The same of a place alone, on whichever primitive it is. */
static bool has_surface_at(const object *o, const rg_ray *ray, real t) {
    line at = line_to_object(o, ray, NULL);
    real point[3], e = surface_bound(o, ray), along = t_bound(o, ray, t, 1) - e;
    size_t primitives = o->shape->kind == RG_SHAPE_MESH ? o->shape->triangle_count : 6;
    for (int i = 0; i < 3; i++) point[i] = at.base[i] + (t - at.t_base) * at.direction[i];
    for (uint32_t p = 0; p < primitives; p++) {
        place near;
        real apart[3], normal[3];
        if (!nearest_place(o->shape, p, point, &near)) continue;
        for (int i = 0; i < 3; i++) apart[i] = near.point[i] - point[i];
        crossing c = {.normal = {near.normal[0], near.normal[1], near.normal[2]}};
        real cosine = cosine_at(o, ray, &c, normal);
        if (near.thickness * o->stretch <= 8 * e && length_in_world(o, apart) <= 4 * e) return true;
        if (is_near(o, apart, near.normal, cosine, 1.5L * e, along)) return true;
    }
    return false;
}

/* --------------------------------------------------------------------------------------------- the verdict */

static bool same_place(const object *a, const object *b) {
    return a->shape == b->shape && memcmp(a->pose.position, b->pose.position, sizeof a->pose.position) == 0 &&
           memcmp(a->pose.linear, b->pose.linear, sizeof a->pose.linear) == 0 && a->pose.scale == b->pose.scale;
}

/* What speaks against `got` among the objects that the ray sees; NULL if nothing does. */
static const char *objection(const reference_scene *scene, const rg_ray *ray, rg_cull cull, const object *hit,
                             real until) {
    for (size_t i = 0; i < scene->count; i++) {
        const object *o = &scene->objects[i];
        if (!(o->mask & ray->mask)) continue;
        if (hit && o->id < hit->id && same_place(o, hit)) return "a lower id at the very same place";
        if (is_too_far(o, ray) || passes_by(o, ray, 2 * surface_bound(o, ray))) continue;
        judge j = judge_of(o, ray, cull);
        if (certainly_hit(&j, until)) return hit ? "a certain hit lies before it" : "a certain hit missed";
    }
    return NULL;
}

static const char *judge_hit(const reference_scene *scene, const rg_ray *ray, rg_cull cull, const rg_hit *got) {
    const object *o = find_object(scene, got->object);
    if (!o) return "no such object";
    if (!(o->mask & ray->mask)) return "the mask hides the object";
    if (!isfinite(got->t)) return "t is not finite";
    if (!(got->t >= ray->t_min && got->t <= ray->t_max)) return "t out of the ray's range";
    if (!right_position(ray, got)) return "position";
    if (!right_offset(o, ray, got)) return "offset";
    if (is_too_far(o, ray)) return NULL;
    /* A linear part of such a condition leaves nothing that a bound could say. */
    if (surface_bound(o, ray) >= o->world_radius / 4 && o->condition > 0x1p38L) return NULL;
    judge j = judge_of(o, ray, cull);
    return found_by_a_ray(&j, got, false) ? NULL : impossible(o, ray, cull, got);
}

static void fill_error(const reference_scene *scene, const rg_ray *ray, const reference_hit *want, const rg_hit *got,
                       reference_error *error) {
    const object *o = find_object(scene, want->object);
    error->t = fabsl(want->t - got->t) * direction_length(ray);
    error->t_bound = t_bound(o, ray, want->t, want->cosine);
    error->normal = difference(want->normal, got->normal);
}

/* The quick way for nearly all answers: the very same surface at the very same place. */
static bool is_equal(const reference_scene *scene, const rg_ray *ray, const reference_hit *want, const rg_hit *got,
                     const reference_error *error) {
    const object *o = find_object(scene, want->object);
    const crossing c = {.t = want->t, .primitive = want->primitive, .u = want->u, .v = want->v};
    return got->t >= ray->t_min && got->t <= ray->t_max && error->t <= error->t_bound &&
           error->normal <= normal_bound(o, ray, want->cosine) &&
           right_weights(o, &c, got, error->t_bound, want->cosine) && right_position(ray, got) &&
           right_offset(o, ray, got);
}

static reference_verdict verdict(reference_error *error, const char *what) {
    error->what = what ? what : "";
    return what ? REFERENCE_WRONG : REFERENCE_WITHIN_BOUND;
}

reference_verdict reference_compare(const reference_scene *scene, const rg_ray *ray, rg_cull cull, const rg_hit *got,
                                    reference_error *error) {
    reference_error ignored;
    reference_hit want;
    const char *what;
    if (!error) error = &ignored;
    *error = (reference_error){.what = ""};
    if (!reference_valid(ray)) {
        if (is_clean_miss(got) && isnan(got->t)) return REFERENCE_EQUAL;
        return verdict(error, "not the mark of an invalid ray");
    }
    rg_ray near = within_reach(ray);
    ray = &near;
    bool hit = reference_trace(scene, ray, cull, &want);
    if (got->object == RG_NO_OBJECT) {
        if (!is_clean_miss(got) || got->t != HUGE_VAL) return verdict(error, "not the mark of a miss");
        return hit ? verdict(error, objection(scene, ray, cull, NULL, HUGE_VALL)) : REFERENCE_EQUAL;
    }
    if (hit && want.object == got->object && want.primitive == got->primitive) {
        fill_error(scene, ray, &want, got, error);
        if (is_equal(scene, ray, &want, got, error)) return REFERENCE_EQUAL;
    }
    what = judge_hit(scene, ray, cull, got);
    if (what) return verdict(error, what);
    return verdict(error, objection(scene, ray, cull, find_object(scene, got->object), got->t));
}

static const char *judge_place(const reference_scene *scene, const rg_ray *ray, const rg_hit *got) {
    const object *o = find_object(scene, got->object);
    if (!o) return "no such object";
    if (!(got->t >= ray->t_min && got->t <= ray->t_max)) return "t out of the ray's range";
    judge j = judge_of(o, ray, RG_CULL_NONE);
    if (!found_by_a_ray(&j, got, true) && !has_surface_at(o, ray, got->t)) return "no surface there";
    return objection(scene, ray, RG_CULL_NONE, o, got->t);
}

reference_verdict reference_compare_place(const reference_scene *scene, const rg_ray *ray, const rg_hit *got,
                                          reference_error *error) {
    reference_hit want;
    rg_ray near = within_reach(ray);
    *error = (reference_error){.what = ""};
    bool hit = reference_trace(scene, &near, RG_CULL_NONE, &want);
    if (got->object == RG_NO_OBJECT) {
        return hit ? verdict(error, objection(scene, &near, RG_CULL_NONE, NULL, HUGE_VALL)) : REFERENCE_EQUAL;
    }
    if (hit && want.object == got->object) {
        fill_error(scene, &near, &want, got, error);
        if (got->t >= near.t_min && got->t <= near.t_max && error->t <= error->t_bound) return REFERENCE_EQUAL;
    }
    return verdict(error, judge_place(scene, &near, got));
}

/* ------------------------------------------------------------------------------------------------ occluded */

/* Whether a ray moved aside hits anything, its range widened by the bound. */
static void try_possible(void *context, const crossing *c) {
    certain *s = context;
    const judge *j = s->j;
    real normal[3], cosine = cosine_at(j->o, j->ray, c, normal);
    if (culled(j->cull, side_of(s->at, c))) return;
    real slack = t_bound(j->o, j->ray, c->t, cosine) / j->unit;
    if (c->t + slack >= j->ray->t_min && c->t - slack <= j->ray->t_max) s->hit = true;
}

/* What is thinner than e may slip through between the nine rays; then the ray comes that near to one of its edges. */
static void try_edge(void *context, real t, real distance) {
    certain *s = context;
    const judge *j = s->j;
    real slack = 16 * t_bound(j->o, j->ray, t, 1) / j->unit;
    if (distance <= s->until && t + slack >= j->ray->t_min && t - slack <= j->ray->t_max) s->hit = true;
}

static bool possibly_hit(const judge *j) {
    line at = line_to_object(j->o, j->ray, NULL);
    /* Edges are measured in the local frame, where e is at most this. */
    certain edges = {.j = j, .at = &at, .until = surface_bound(j->o, j->ray) * j->o->condition / j->o->stretch};
    edges_of(j->o->shape, &at, try_edge, &edges);
    for (int k = 0; !edges.hit && k < SAMPLES; k++) {
        at = line_to_object(j->o, j->ray, k ? j->aside[k] : NULL);
        cross_shape(j->o->shape, &at, try_possible, &edges);
    }
    return edges.hit;
}

reference_verdict reference_compare_occluded(const reference_scene *scene, const rg_ray *ray, rg_cull cull,
                                             bool got) {
    if (reference_occluded(scene, ray, cull) == got) return REFERENCE_EQUAL;
    if (!reference_valid(ray)) return REFERENCE_WRONG;
    rg_ray near = within_reach(ray);
    ray = &near;
    if (!got) return objection(scene, ray, cull, NULL, HUGE_VALL) ? REFERENCE_WRONG : REFERENCE_WITHIN_BOUND;
    for (size_t i = 0; i < scene->count; i++) {
        const object *o = &scene->objects[i];
        if (!(o->mask & ray->mask) || passes_by(o, ray, 2 * surface_bound(o, ray))) continue;
        judge j = judge_of(o, ray, cull);
        if (is_too_far(o, ray) || possibly_hit(&j)) return REFERENCE_WITHIN_BOUND;
    }
    return REFERENCE_WRONG;
}
