/* SPDX-License-Identifier: MIT */
#include "expect.h"

#include "calls.h"
#include "trace.h"

#include <inttypes.h>
#include <string.h>

/* A count in a report: a number, or an object with a least and a most. */
static void expect_count(context *c, const json_t *step, const char *key, uint64_t got) {
    const json_t *value = json_object_get(step, key);
    uint64_t least, most;
    if (!value) return;
    if (json_is_object(value)) {
        read_known_keys(c, value, "min max");
        least = read_integer(c, value, "min", INT64_MAX, 0);
        most = read_integer(c, value, "max", INT64_MAX, UINT64_MAX);
    } else {
        least = most = read_integer(c, step, key, INT64_MAX, 0);
    }
    if (got < least || got > most)
        fail(c, "%s is %" PRIu64 ", expected %" PRIu64 " to %" PRIu64, key, got, least, most);
}

static void expect_doubles(context *c, const json_t *step, const char *key, size_t count, const double *got) {
    double wanted[9];
    if (!json_object_get(step, key)) return;
    read_numbers(c, step, key, count, wanted);
    for (size_t i = 0; i < count; i++) {
        if (got[i] != wanted[i]) fail(c, "%s[%zu] is %.17g, expected %.17g", key, i, got[i], wanted[i]);
    }
}

static void expect_contains(context *c, const json_t *step, const char *key, const double lo[3], const double hi[3]) {
    const json_t *points = json_object_get(step, key);
    for (size_t i = 0; i < json_array_size(points); i++) {
        double p[3];
        read_vector(c, json_array_get(points, i), p);
        for (int a = 0; a < 3; a++) {
            if (!(lo[a] <= p[a] && p[a] <= hi[a]))
                fail(c, "%s: %.17g is not from lo[%d] = %.17g to hi = %.17g", key, p[a], a, lo[a], hi[a]);
        }
    }
}

static bool holds_here(const context *c, const json_t *step) {
    const json_t *on = json_object_get(step, "on");
    for (size_t i = 0; i < json_array_size(on); i++) {
        const char *name = json_string_value(json_array_get(on, i));
        if (name && strcmp(name, c->setup->name) == 0) return true;
    }
    return !on;
}

static void expect_grid(context *c, const json_t *step) {
    static const char *const kinds[] = {"default", "uniform", "hierarchical", "loose"};
    rg_grid_report r = {.size = sizeof r};
    const char *kind = json_string_value(json_object_get(step, "kind"));
    const json_t *resolution = json_object_get(step, "resolution");
    if (!holds_here(c, step)) return;
    if (rg_grid_stats(c->scene, read_grid(c, step, "grid"), &r)) {
        fail(c, "%s", rg_error_message());
        return;
    }
    if (kind && (r.kind < 1 || r.kind > 3 || strcmp(kinds[r.kind], kind) != 0))
        fail(c, "kind is %d, expected %s", (int)r.kind, kind);
    for (size_t a = 0; a < json_array_size(resolution); a++) {
        if (json_integer_value(json_array_get(resolution, a)) != (json_int_t)r.resolution[a])
            fail(c, "resolution[%zu] is %u", a, (unsigned)r.resolution[a]);
    }
    expect_count(c, step, "levels", r.levels);
    expect_count(c, step, "levels_used", r.levels_used);
    expect_count(c, step, "objects", r.objects);
    expect_count(c, step, "entries", r.entries);
    expect_count(c, step, "unbounded", r.unbounded);
    expect_count(c, step, "tiles", r.tiles);
    expect_count(c, step, "rebuilds", r.rebuilds);
    expect_doubles(c, step, "physical_lo", 3, r.physical_lo);
    expect_doubles(c, step, "physical_hi", 3, r.physical_hi);
    expect_contains(c, step, "physical_contains", r.physical_lo, r.physical_hi);
    expect_contains(c, step, "logical_contains", r.logical_lo, r.logical_hi);
}

static void expect_object(context *c, const json_t *step) {
    rg_object id = read_object(c, json_object_get(step, "object"));
    rg_object_report r = {.size = sizeof r};
    double linear[9];
    if (c->broken) return;
    if (rg_scene_lookup(c->scene, id, &r)) {
        fail(c, "%s", rg_error_message());
        return;
    }
    for (int i = 0; i < 9; i++) linear[i] = (double)r.pose.linear[i];
    expect_doubles(c, step, "position", 3, r.pose.position);
    expect_doubles(c, step, "linear", 9, linear);
    expect_contains(c, step, "contains", r.lo, r.hi);
    expect_count(c, step, "mask", r.mask);
    expect_count(c, step, "slot", RG_OBJECT_SLOT(id));
    expect_count(c, step, "generation", id >> 32);
    if (json_object_get(step, "grid") && r.grid != read_grid(c, step, "grid")) fail(c, "it is in another grid");
}

static void expect_scene(context *c, const json_t *step) {
    rg_scene_report r = {.size = sizeof r};
    if (rg_scene_stats(c->scene, &r)) fail(c, "%s", rg_error_message());
    expect_count(c, step, "objects", r.objects);
    expect_count(c, step, "slots", r.slots);
    expect_count(c, step, "grids", r.grids);
}

/* ------------------------------------------------------------------------------------------------- errors */

static rg_result result_of_name(context *c, const char *name) {
    for (rg_result r = RG_INVALID_ARGUMENT; r <= RG_CALLBACK_FAILED; r++) {
        if (strcmp(rg_result_name(r), name) == 0) return r;
    }
    malformed(c, "\"%s\" is no error", name);
    return MALFORMED;
}

/* What must not change when a call fails. */
typedef struct state {
    rg_scene_report scene;
    rg_grid_report grid;
} state;

static void look(context *c, state *s) {
    memset(s, 0, sizeof *s);
    s->scene.size = sizeof s->scene;
    s->grid.size = sizeof s->grid;
    if (rg_scene_stats(c->scene, &s->scene)) fail(c, "%s", rg_error_message());
    if (rg_grid_stats(c->scene, RG_GRID_OF_SCENE, &s->grid)) fail(c, "%s", rg_error_message());
}

static void compare_states(context *c, const state *before, const state *after) {
    const rg_scene_report *a = &before->scene, *b = &after->scene;
    if (a->objects != b->objects || a->slots != b->slots || a->grids != b->grids ||
        a->invalid_rays != b->invalid_rays)
        fail(c, "the failed call changed the scene's report");
    if (memcmp(&before->grid, &after->grid, sizeof before->grid) != 0)
        fail(c, "the failed call changed the grid's report");
}

static void expect_error(context *c, const json_t *step) {
    const json_t *call = json_object_get(step, "call");
    const char *message = read_text(c, step, "message");
    rg_result wanted = result_of_name(c, read_text(c, step, "result"));
    state before, after;
    bool known;
    if (c->broken) return;
    look(c, &before);
    rg_result got = call_step(c, call, &known);
    if (!known) malformed(c, "unknown call \"%s\"", read_text(c, call, "do"));
    if (c->broken) return;
    if (got != wanted) {
        fail(c, "%s gave %s, expected %s", read_text(c, call, "do"), rg_result_name(got), rg_result_name(wanted));
    } else if (!*rg_error_message() || !strstr(rg_error_message(), message)) {
        fail(c, "the message \"%s\" does not contain \"%s\"", rg_error_message(), message);
    }
    look(c, &after);
    compare_states(c, &before, &after);
    trace_again(c);
}

/* ------------------------------------------------------------------------------------------------ the set */

static const struct {
    const char *name, *keys;
    void (*play)(context *c, const json_t *step);
} steps[] = {
    {"trace", "do rays cull respawn", trace_play},
    {"expect_error", "do result message call", expect_error},
    {"expect_grid",
     "do grid on kind levels levels_used resolution physical_lo physical_hi physical_contains logical_contains "
     "objects entries unbounded tiles rebuilds",
     expect_grid},
    {"expect_object", "do object position linear mask grid contains slot generation", expect_object},
    {"expect_scene", "do objects slots grids", expect_scene},
};

bool expect_step(context *c, const json_t *step) {
    const char *name = read_text(c, step, "do");
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        if (strcmp(steps[i].name, name) != 0) continue;
        read_known_keys(c, step, steps[i].keys);
        if (!c->broken) steps[i].play(c, step);
        return true;
    }
    return false;
}
