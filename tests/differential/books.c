/* SPDX-License-Identifier: MIT */
/* books.c: what the library says of its scene, against what was done to it. */
#include "world.h"

#include <string.h>

/* The reported box holds the exact one, but for half an ulp that the reference lost; and is not much larger. */
static void check_bounds(const world *w, rg_object id, const rg_object_report *report) {
    double lo[3], hi[3];
    reference_bounds(w->reference, id, lo, hi);
    for (int i = 0; i < 3; i++) {
        double size = hi[i] - lo[i];
        if (!(nextafter(report->lo[i], -HUGE_VAL) <= lo[i]) || !(nextafter(report->hi[i], HUGE_VAL) >= hi[i])) {
            world_fail(w, "object %llx: axis %d: %a to %a is not in the reported %a to %a", (unsigned long long)id, i,
                       lo[i], hi[i], report->lo[i], report->hi[i]);
        }
        double spare = 3 * size + 1e-9 * (fabs(lo[i]) + fabs(hi[i]));
        if (isfinite(size) && (report->lo[i] < lo[i] - spare || report->hi[i] > hi[i] + spare)) {
            world_fail(w, "object %llx: axis %d: the reported box is far too large", (unsigned long long)id, i);
        }
    }
}

static bool same_pose(const rg_pose *a, const rg_pose *b) {
    return memcmp(a->position, b->position, sizeof a->position) == 0 &&
           memcmp(a->linear, b->linear, sizeof a->linear) == 0 && a->scale == b->scale;
}

/* Looks every object up; `boxes` counts those of each grid and gathers their finite bounds. */
typedef struct grid_books {
    uint64_t objects, infinite;
    double lo[3], hi[3];           /* of the finite ones, as the reference has them */
    double told_lo[3], told_hi[3]; /* of the same, as the library looks them up */
} grid_books;

static int index_of_grid(const world *w, rg_grid grid) {
    for (int g = 0; g < w->grid_count; g++) {
        if (w->grids[g] == grid) return g;
    }
    world_fail(w, "an object is in a grid that does not exist");
    return -1;
}

static void gather(const world *w, grid_books books[WORLD_GRIDS]) {
    for (int g = 0; g < WORLD_GRIDS; g++) {
        books[g] = (grid_books){0};
        for (int i = 0; i < 3; i++) {
            books[g].lo[i] = books[g].told_lo[i] = HUGE_VAL;
            books[g].hi[i] = books[g].told_hi[i] = -HUGE_VAL;
        }
    }
    for (size_t n = 0; n < reference_count(w->reference); n++) {
        rg_object id = reference_object(w->reference, n);
        rg_object_report report = {.size = sizeof report};
        world_expect(w, "rg_scene_lookup", rg_scene_lookup(w->scene, id, &report), RG_OK);
        if (!same_pose(&report.pose, reference_pose(w->reference, id))) world_fail(w, "lookup: another pose");
        if (report.mask != reference_mask(w->reference, id)) world_fail(w, "lookup: another mask");
        check_bounds(w, id, &report);
        grid_books *b = &books[index_of_grid(w, report.grid)];
        b->objects++;
        double lo[3], hi[3];
        reference_bounds(w->reference, id, lo, hi);
        bool finite = true;
        for (int i = 0; i < 3; i++) finite = finite && isfinite(lo[i]) && isfinite(hi[i]);
        b->infinite += !finite;
        for (int i = 0; finite && i < 3; i++) {
            b->lo[i] = fmin(b->lo[i], lo[i]), b->hi[i] = fmax(b->hi[i], hi[i]);
            b->told_lo[i] = fmin(b->told_lo[i], report.lo[i]), b->told_hi[i] = fmax(b->told_hi[i], report.hi[i]);
        }
    }
}

/* An object is in one place or in none, and what has a place anywhere has it in a cell. */
static void check_loose(const world *w, int g, const grid_books *b, const rg_grid_report *report) {
    if (report->entries + report->unbounded != report->objects) world_fail(w, "grid %d: entries and unbounded", g);
    if (report->unbounded < b->infinite || (!w->no_cells_for_finite && report->unbounded > b->infinite)) {
        world_fail(w, "grid %d: %llu unbounded, but %llu are infinite", g, (unsigned long long)report->unbounded,
                   (unsigned long long)b->infinite);
    }
    if (report->rebuilds < w->rebuilds[g]) {
        world_fail(w, "grid %d: rebuilt %llu times, asked for %llu", g, (unsigned long long)report->rebuilds,
                   (unsigned long long)w->rebuilds[g]);
    }
    for (int i = 0; i < 3; i++) {
        if (report->physical_lo[i] != 0 || report->physical_hi[i] != 0) world_fail(w, "grid %d: a physical box", g);
    }
    if (report->entries == 0 && report->levels != 0) world_fail(w, "grid %d: levels that hold nothing", g);
}

void world_check_rebuilt(const world *w, int g) {
    rg_grid_report report = {.size = sizeof report};
    grid_books books[WORLD_GRIDS];
    double longest = 0;
    world_expect(w, "rg_grid_stats", rg_grid_stats(w->scene, w->grids[g], &report), RG_OK);
    if (report.kind != RG_GRID_LOOSE || report.unbounded + 1 >= report.objects || w->no_cells_for_finite) return;
    gather(w, books);
    for (int i = 0; i < 3; i++) longest = fmax(longest, books[g].told_hi[i] - books[g].told_lo[i]);
    for (int i = 0; i < 3; i++) {
        double spare = longest * 0x1p-16;
        if (report.logical_lo[i] < books[g].told_lo[i] - spare || report.logical_hi[i] > books[g].told_hi[i] + spare)
            world_fail(w, "grid %d: axis %d: rebuilt, but the logical box is not tight", g, i);
    }
}

static void check_grid(const world *w, int g, const grid_books *b) {
    rg_grid_report report = {.size = sizeof report};
    world_expect(w, "rg_grid_stats", rg_grid_stats(w->scene, w->grids[g], &report), RG_OK);
    if (report.objects != b->objects) world_fail(w, "grid %d: number of objects", g);
    if (report.unbounded > report.objects) world_fail(w, "grid %d: more unbounded objects than objects", g);
    if (report.entries < report.objects - report.unbounded) world_fail(w, "grid %d: too few entries", g);
    if (report.kind < RG_GRID_UNIFORM || report.kind > RG_GRID_LOOSE) world_fail(w, "grid %d: kind", g);
    if (report.kind == RG_GRID_LOOSE) check_loose(w, g, b, &report);
    if (report.kind == RG_GRID_HIERARCHICAL && report.entries > 8 * report.objects) {
        world_fail(w, "grid %d: more than 8 places an object", g);
    }
    for (int i = 0; i < 3; i++) {
        if (report.kind != RG_GRID_LOOSE && report.levels > 0 && !(report.physical_lo[i] < report.physical_hi[i])) {
            world_fail(w, "grid %d: no physical box", g);
        }
        if (b->lo[i] > b->hi[i]) continue;
        if (!(nextafter(report.logical_lo[i], -HUGE_VAL) <= b->lo[i]) ||
            !(nextafter(report.logical_hi[i], HUGE_VAL) >= b->hi[i])) {
            world_fail(w, "grid %d: the logical box does not hold all objects", g);
        }
    }
}

static void check_stale(const world *w) {
    uint32_t known = w->removed < WORLD_STALE ? w->removed : WORLD_STALE;
    for (uint32_t i = 0; i < known; i++) {
        const rg_object id = w->stale[i];
        const double position[3] = {0, 0, 0};
        rg_pose pose = rg_pose_at(0, 0, 0);
        rg_object_report report = {.size = sizeof report};
        world_expect(w, "rg_scene_move of a stale id", rg_scene_move(w->scene, id, &pose), RG_INVALID_ID);
        world_expect(w, "rg_scene_move_to of a stale id", rg_scene_move_to(w->scene, id, position), RG_INVALID_ID);
        world_expect(w, "rg_scene_set_mask of a stale id", rg_scene_set_mask(w->scene, id, 1), RG_INVALID_ID);
        world_expect(w, "rg_scene_remove of a stale id", rg_scene_remove(w->scene, id), RG_INVALID_ID);
        world_expect(w, "rg_scene_lookup of a stale id", rg_scene_lookup(w->scene, id, &report), RG_INVALID_ID);
    }
}

void world_check_books(world *w) {
    grid_books books[WORLD_GRIDS];
    rg_scene_report report = {.size = sizeof report};
    world_expect(w, "rg_scene_stats", rg_scene_stats(w->scene, &report), RG_OK);
    if (report.objects != reference_count(w->reference)) world_fail(w, "stats: number of objects");
    if (report.slots != w->most_objects) world_fail(w, "stats: slots %llu", (unsigned long long)report.slots);
    if (report.grids != (uint32_t)w->grid_count) world_fail(w, "stats: number of grids");
    if (report.bytes == 0) world_fail(w, "stats: bytes");
    if (report.invalid_rays != w->invalid_rays) {
        world_fail(w, "stats: %llu invalid rays, expected %llu", (unsigned long long)report.invalid_rays,
                   (unsigned long long)w->invalid_rays);
    }
    gather(w, books);
    for (int g = 0; g < w->grid_count; g++) check_grid(w, g, &books[g]);
    check_stale(w);
}
