/* SPDX-License-Identifier: MIT */
#include "trace.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Units in the last place of t that every hit is allowed, and what float normals and barycentrics are off at most. */
static const double t_ulps = 4, normal_within = 0x1p-20, weight_within = 0x1p-20;

const char *hit_text(const context *c, const rg_hit *hit) {
    static char text[2][512];
    static int turn;
    turn = !turn;
    snprintf(text[turn], sizeof text[turn],
             "%s t %a (%.17g) primitive %u normal (%.9g %.9g %.9g) u %.9g v %.9g position (%a %a %a) offset %a",
             object_name(c, hit->object), hit->t, hit->t, (unsigned)hit->primitive, (double)hit->normal[0],
             (double)hit->normal[1], (double)hit->normal[2], (double)hit->u, (double)hit->v, hit->position[0],
             hit->position[1], hit->position[2], (double)hit->offset);
    return text[turn];
}

static bool same_double(double a, double b) {
    return a == b || (isnan(a) && isnan(b));
}

bool same_hit(const rg_hit *a, const rg_hit *b) {
    bool same = same_double(a->t, b->t) && a->object == b->object && a->primitive == b->primitive;
    for (int i = 0; i < 3; i++)
        same = same && same_double(a->position[i], b->position[i]) && a->normal[i] == b->normal[i];
    return same && a->offset == b->offset && a->u == b->u && a->v == b->v && a->reserved == b->reserved;
}

static double ulp(double x) {
    double y = fabs(x);
    return y >= DBL_MAX ? INFINITY : nextafter(y, INFINITY) - y;
}

/* -------------------------------------------------------------------------------------- what always holds */

static void check_miss(context *c, const rg_hit *hit, bool invalid) {
    const rg_hit miss = {.t = invalid ? NAN : INFINITY, .primitive = RG_NO_PRIMITIVE};
    if (!same_hit(&miss, hit))
        fail(c, "expected %s, got %s", invalid ? "an invalid ray's miss" : "a miss", hit_text(c, hit));
}

/* position is origin + t * direction, rounded once: half an ulp, and what the long doubles here round. */
static void check_position(context *c, const rg_ray *ray, const rg_hit *hit) {
    for (int a = 0; a < 3; a++) {
        long double way = (long double)hit->t * (long double)ray->direction[a];
        long double right = (long double)ray->origin[a] + way;
        double slack =
            0.5 * ulp((double)right) + (double)(LDBL_EPSILON * 2) * (fabs(ray->origin[a]) + (double)fabsl(way));
        double off = (double)fabsl((long double)hit->position[a] - right);
        if (!(off <= slack))
            fail(c, "position[%d] is %a, off by %g from origin + t * direction = %a", a, hit->position[a], off,
                 (double)right);
    }
}

static void check_always(context *c, const rg_ray *ray, const rg_hit *hit) {
    rg_object_report report = {.size = sizeof report};
    double length = 0;
    for (int a = 0; a < 3; a++) length += (double)hit->normal[a] * (double)hit->normal[a];
    if (!(fabs(length - 1) <= 0x1p-20)) fail(c, "normal of length %.9g: %s", sqrt(length), hit_text(c, hit));
    if (!(hit->t >= ray->t_min && hit->t <= ray->t_max)) fail(c, "t out of the ray's range: %s", hit_text(c, hit));
    double farthest = fmax(fabs(hit->position[0]), fmax(fabs(hit->position[1]), fabs(hit->position[2])));
    /* An offset is a float, and may be infinite where coordinates are too large for one. */
    if (!(hit->offset >= 0 && (hit->offset < INFINITY || farthest > (double)FLT_MAX)))
        fail(c, "offset is %g", (double)hit->offset);
    if (hit->reserved != 0) fail(c, "reserved is %u", (unsigned)hit->reserved);
    if (rg_scene_lookup(c->scene, hit->object, &report) != RG_OK)
        fail(c, "hit of %s: %s", object_name(c, hit->object), rg_error_message());
    else if (!(report.mask & ray->mask))
        fail(c, "hit of %s, which the ray doesn't see", object_name(c, hit->object));
    if (!(hit->u >= 0 && hit->v >= 0 && hit->u + hit->v <= 1 + 0x1p-22f)) fail(c, "weights: %s", hit_text(c, hit));
    check_position(c, ray, hit);
}

/* --------------------------------------------------------------------------------- what the script expects */

/* Whether a value is the one given, or among those given. */
static bool accepted(context *c, const json_t *given, const rg_hit *hit,
                     bool (*is)(context *, const json_t *, const rg_hit *)) {
    if (!json_is_array(given)) return is(c, given, hit);
    for (size_t i = 0; i < json_array_size(given); i++) {
        if (is(c, json_array_get(given, i), hit)) return true;
    }
    return false;
}

static bool is_object(context *c, const json_t *value, const rg_hit *hit) {
    return hit->object == (json_is_null(value) ? RG_NO_OBJECT : read_object(c, value));
}

static bool is_primitive(context *c, const json_t *value, const rg_hit *hit) {
    if (!json_is_integer(value)) malformed(c, "a primitive is no whole number");
    return (json_int_t)hit->primitive == json_integer_value(value);
}

static double number_or(context *c, const json_t *expected, const char *key, double missing) {
    const json_t *value = json_object_get(expected, key);
    return value ? read_number(c, value) : missing;
}

static void check_near(context *c, const char *what, double got, double wanted, double within) {
    if (fabs(got - wanted) <= within) return;
    fail(c, "%s is %a (%.17g), expected %a (%.17g) within %.3g, off by %.3g", what, got, got, wanted, wanted, within,
         fabs(got - wanted));
}

static void check_vectors(context *c, const rg_hit *hit, const json_t *expected, const rg_ray *ray, double t_within) {
    static const char *const normals[] = {"normal x", "normal y", "normal z"};
    static const char *const positions[] = {"position x", "position y", "position z"};
    double wanted[3], within = number_or(c, expected, "normal_within", normal_within);
    if (json_object_get(expected, "normal")) {
        read_numbers(c, expected, "normal", 3, wanted);
        for (int a = 0; a < 3; a++) check_near(c, normals[a], (double)hit->normal[a], wanted[a], within);
    }
    if (json_object_get(expected, "position")) {
        read_numbers(c, expected, "position", 3, wanted);
        for (int a = 0; a < 3; a++)
            check_near(c, positions[a], hit->position[a], wanted[a],
                       t_within * fabs(ray->direction[a]) + 2 * ulp(fmax(fabs(wanted[a]), fabs(ray->origin[a]))));
    }
}

static void check_numbers(context *c, const rg_hit *hit, const json_t *expected, const rg_ray *ray) {
    double t = number_or(c, expected, "t", hit->t);
    double within = t_ulps * ulp(t) + number_or(c, expected, "within", 0);
    check_near(c, "t", hit->t, t, within);
    check_near(c, "u", (double)hit->u, number_or(c, expected, "u", (double)hit->u), weight_within);
    check_near(c, "v", (double)hit->v, number_or(c, expected, "v", (double)hit->v), weight_within);
    check_vectors(c, hit, expected, ray, within);
}

static void check_counts(context *c, const json_t *expected, uint32_t cells, uint32_t tests) {
    uint64_t most = read_integer(c, expected, "cells_max", UINT32_MAX, UINT32_MAX);
    uint64_t wanted = read_integer(c, expected, "tests", UINT32_MAX, tests);
    if (cells > most) fail(c, "looked into %u cells, expected at most %u", (unsigned)cells, (unsigned)most);
    if (tests != wanted) fail(c, "tested against %u objects, expected %u", (unsigned)tests, (unsigned)wanted);
}

static void check_expected(context *c, const json_t *expected, const rg_ray *ray, const rg_hit *hit) {
    read_known_keys(c, expected, "object t within primitive normal normal_within u v position cells_max tests");
    const json_t *object = json_object_get(expected, "object"), *primitive = json_object_get(expected, "primitive");
    if (!object) malformed(c, "no object is expected, not even null");
    if (!accepted(c, object, hit, is_object)) {
        char *text = json_dumps(object, JSON_ENCODE_ANY | JSON_COMPACT);
        fail(c, "expected %s at %.17g, got %s", text ? text : "?", number_or(c, expected, "t", NAN),
             hit_text(c, hit));
        free(text);
        return;
    }
    if (hit->object == RG_NO_OBJECT) {
        check_miss(c, hit, false);
        return;
    }
    if (primitive && !accepted(c, primitive, hit, is_primitive)) fail(c, "wrong primitive: %s", hit_text(c, hit));
    check_numbers(c, hit, expected, ray);
}

static void compare_one(context *c, const json_t *line, const rg_ray *ray, const rg_hit *hit, uint32_t cells,
                        uint32_t tests) {
    const json_t *expected = json_object_get(line, "hit");
    const char *word = json_string_value(expected);
    if (word && strcmp(word, "invalid") == 0) {
        check_miss(c, hit, true);
        if (cells || tests) fail(c, "an invalid ray looked into %u cells", (unsigned)cells);
    } else if (json_is_null(expected)) {
        check_miss(c, hit, false);
    } else if (json_is_object(expected)) {
        check_expected(c, expected, ray, hit);
        check_counts(c, expected, cells, tests);
    } else {
        malformed(c, "a ray without \"hit\"");
    }
    if (hit->object != RG_NO_OBJECT) check_always(c, ray, hit);
}

void compare_with_script(context *c, const batch *b, const outcome *o) {
    for (size_t i = 0; i < b->count && !c->broken; i++) {
        c->ray = (long)i;
        compare_one(c, json_array_get(b->lines, i), &b->rays[i], &o->hits[i], o->cells[i], o->tests[i]);
    }
    c->ray = -1;
}
