/* SPDX-License-Identifier: MIT */
#include "field.h"

#include <math.h>
#include <string.h>

enum { ROW = 64, APART = 3, TURNS = 100 };

/* Where rays begin, x. */
static const double FAR_AWAY = 1e6;

/* And those from the side: how far from the middle. */
static const double ASIDE = 1.5;

static void place(struct field *field, int i, double x) {
    field->x[i] = x + 0.37 * (i % 101);
}

void field_begin(struct field *field, rg_grid_kind kind, uint32_t workers) {
    memset(field, 0, sizeof *field);
    field->scene = create_scene(&field->books, kind, workers);
    MUST(rg_shape_create_sphere(NULL, 1, &field->ball));
    for (int i = 0; i < FIELD; i++) {
        place(field, i, 0);
        const rg_pose pose = rg_pose_at(field->x[i], APART * (i % ROW), APART * (i / ROW));
        MUST(rg_scene_insert(field->scene, field->ball, &pose, &field->objects[i]));
    }
}

static void move_one(struct field *field, int i, double x) {
    place(field, i, x);
    const double to[3] = {field->x[i], APART * (i % ROW), APART * (i / ROW)};
    MUST(rg_scene_move_to(field->scene, field->objects[i], to));
}

void field_move(struct field *field, double x) {
    for (int i = 0; i < FIELD; i++) move_one(field, i, x);
}

/* Each time farther, so that grids of all kinds fit no more. */
void field_move_until_rebuilding(struct field *field) {
    const uint64_t before = report_grid(field->scene).rebuilds;
    double x = 1000;
    for (int turn = 0; turn < TURNS; turn++) {
        for (int i = 0; i < FIELD; i++) {
            move_one(field, i, x);
            const rg_grid_report report = report_grid(field->scene);
            if (report.rebuilding || report.rebuilds > before) return;
        }
        x = x < 100000 ? 4 * x : x + 1000;
    }
    demand(false, "a rebuild begins");
}

/* Every second one looks from between the rows to the middle of its ball. */
static bool is_aside(int i) {
    return i % 2;
}

void field_rays(const struct field *field, rg_ray rays[FIELD]) {
    for (int i = 0; i < FIELD; i++) {
        const double y = APART * (i % ROW), z = APART * (i / ROW);
        const double far[3] = {-FAR_AWAY, y, z}, aside[3] = {field->x[i], y, z - ASIDE};
        const double along[3] = {1, 0, 0}, across[3] = {0, 0, 1};
        rays[i] = is_aside(i) ? rg_ray_from(aside, across) : rg_ray_from(far, along);
    }
}

bool field_is_right(const struct field *field, const rg_hit hits[FIELD]) {
    for (int i = 0; i < FIELD; i++) {
        if (hits[i].object != field->objects[i]) return false;
        double t = is_aside(i) ? ASIDE - 1 : field->x[i] - 1 + FAR_AWAY;
        if (fabs(hits[i].t - t) > 0x1p-25) return false;
    }
    return true;
}

void field_check(const struct field *field) {
    static rg_ray rays[FIELD];
    static rg_hit hits[FIELD];
    field_rays(field, rays);
    MUST(rg_scene_trace(field->scene, rays, hits, FIELD));
    demand(field_is_right(field, hits), "every ray hits its ball");
}

void field_end(struct field *field) {
    destroy_scene(&field->books, &field->scene);
    rg_shape_release(&field->ball);
}
