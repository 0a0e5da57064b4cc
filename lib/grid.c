/* SPDX-License-Identifier: MIT */
#include "grid.h"

#include "error.h"
#include "struct_size.h"
#include "vec.h"

#include <raygrid/shape.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    MAX_RESOLUTION = 1 << 20,
    MAX_CELLS = 1 << 28,
    /* Members up to which a grid without a given box has no cells: testing each costs less than walking. */
    FEW = 8,
    /* Cells for each member of an automatic resolution, and how often the number of members may double or halve
     * before the resolution is adapted. */
    CELLS_PER_MEMBER = 4,
    GROWTH = 4,
    SHRINKAGE = 16,
    /* An automatic resolution stops here: 128 MB of cells. */
    MAX_AUTOMATIC_CELLS = 1 << 25,
    /* A member of a uniform grid of automatic resolution is in so many cells on average at the most. It is judged by
     * so many members. */
    ENTRIES_PER_MEMBER = 64,
    SAMPLE = 4096,
    /* Members that each change looks at to make the logical box exact. */
    SWEEP = 2
};

/* ------------------------------------------------------------------------------------------ configuration */

static const rg_grid_config default_config = {sizeof(rg_grid_config), RG_GRID_DEFAULT, 0, {0, 0, 0}, {0, 0, 0}, 2};
enum { CONFIG_LEAST = sizeof(rg_grid_config) };

rg_result rg_grid_config_default(rg_grid_config *config, size_t size) {
    return rgi_struct_default(&default_config, sizeof default_config, CONFIG_LEAST, config, size, "rg_grid_config");
}

static bool has_box(const rg_grid_config *config) {
    for (int a = 0; a < 3; a++) {
        if (config->lo[a] != 0 || config->hi[a] != 0) return true;
    }
    return false;
}

/* Numbers of cells for a box with so many along its longest side, the others in proportion. */
static void counts_for_resolution(rg_grid_kind kind, const double extent[3], uint32_t resolution, uint32_t count[3]) {
    double size = rgi_max_magnitude(extent) / resolution;
    for (int a = 0; a < 3; a++) {
        double n = ceil(extent[a] / size * (1 - 0x1p-40));
        count[a] = (uint32_t)rgi_max(1, rgi_min(n, MAX_RESOLUTION));
        uint32_t power = 1;
        while (power < count[a]) power *= 2;
        if (kind == RG_GRID_HIERARCHICAL) count[a] = power;
    }
}

static double cells_of(const uint32_t count[3]) {
    return (double)count[0] * count[1] * count[2];
}

rg_result rgi_grid_config_read(rg_grid_config *config, const rg_grid_config *given) {
    rg_result result = rgi_struct_read(config, sizeof *config, CONFIG_LEAST, given, "rg_grid_config");
    if (result) return result;
    rg_grid_config *c = config;
    c->size = sizeof *c;
    if (c->kind < RG_GRID_DEFAULT || c->kind > RG_GRID_LOOSE)
        return rgi_fail(RG_INVALID_ARGUMENT, "kind is %d, which is no kind of grid", (int)c->kind);
    if (c->kind == RG_GRID_DEFAULT) c->kind = RG_GRID_LOOSE;
    if (c->resolution > MAX_RESOLUTION)
        return rgi_fail(RG_INVALID_VALUE, "resolution is %u, above %d", c->resolution, MAX_RESOLUTION);
    if (c->rebuild_factor == 0) c->rebuild_factor = default_config.rebuild_factor;
    if (c->rebuild_factor != RG_REBUILD_NEVER && !(c->rebuild_factor >= 1 && c->rebuild_factor < INFINITY))
        return rgi_fail(RG_INVALID_VALUE, "rebuild_factor is %g, neither >= 1 nor RG_REBUILD_NEVER",
                        c->rebuild_factor);
    if (!has_box(c)) return RG_OK;
    double extent[3];
    for (int a = 0; a < 3; a++) {
        if (!(fabs(c->lo[a]) <= RG_COORDINATE_MAX && fabs(c->hi[a]) <= RG_COORDINATE_MAX && c->lo[a] < c->hi[a]))
            return rgi_fail(RG_INVALID_VALUE, "the box of the grid goes from lo[%d] = %g to hi[%d] = %g", a, c->lo[a],
                            a, c->hi[a]);
        extent[a] = c->hi[a] - c->lo[a];
        if (extent[a] < RG_RADIUS_MIN)
            return rgi_fail(RG_INVALID_VALUE, "the box of the grid is %g wide on axis %d, less than %g", extent[a], a,
                            RG_RADIUS_MIN);
    }
    uint32_t count[3];
    counts_for_resolution(c->kind, extent, c->resolution ? c->resolution : 1, count);
    if (cells_of(count) > MAX_CELLS)
        return rgi_fail(RG_LIMIT_EXCEEDED, "resolution %u gives %g cells, more than 2^28", c->resolution,
                        cells_of(count));
    return RG_OK;
}

/* ---------------------------------------------------------------------------------------- making the cells */

static void tell(const rgi_grid *grid, const char *what, const char *why) {
    char line[160];
    if (!grid->log) return;
    snprintf(line, sizeof line, "grid %s (%s): %" PRIu64 " objects, %" PRIu32 " x %" PRIu32 " x %" PRIu32 " cells",
             what, why, grid->member_count, grid->cells.levels[0].count[0], grid->cells.levels[0].count[1],
             grid->cells.levels[0].count[2]);
    grid->log(grid->log_user, line);
}

/* The side of cubic cells so that so many fit in the box; sides of the box that are no longer than a cell do not
 * count. */
static double automatic_size(const double sides[3], double wanted) {
    double e[3] = {sides[0], sides[1], sides[2]};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            if (e[j] > e[j + 1]) {
                double swap = e[j];
                e[j] = e[j + 1];
                e[j + 1] = swap;
            }
        }
    }
    double size = cbrt(e[0] / wanted * e[1] * e[2]);
    if (e[0] <= size) size = sqrt(e[1] / wanted * e[2]);
    if (e[1] <= size) size = e[2] / wanted;
    return size;
}

static void automatic_counts(rg_grid_kind kind, const double extent[3], uint64_t members, uint32_t count[3]) {
    double wanted = rgi_min(CELLS_PER_MEMBER * (double)(members > 2 ? members : 2), MAX_AUTOMATIC_CELLS);
    /* Free of the box's scale, and of sides that will have one cell anyway, so that the products stay in range. */
    double longest = rgi_max_magnitude(extent), sides[3];
    for (int a = 0; a < 3; a++) sides[a] = extent[a] / longest < 0x1p-40 ? 0 : extent[a] / longest;
    double size = automatic_size(sides, wanted);
    for (int a = 0; a < 3; a++) {
        double n = sides[a] / size;
        count[a] = (uint32_t)rgi_max(1, rgi_min(floor(n + 0.5), MAX_RESOLUTION));
        uint32_t power = 1;
        while (power * 1.4142135623730951 < n && power < MAX_RESOLUTION) power *= 2;
        if (kind == RG_GRID_HIERARCHICAL) count[a] = power;
    }
}

/*
 * A physical box a little larger than the logical one, so that what touches its walls has no entries in the tiles
 * beyond. Sides without length get some, and none is so short that doubles at its coordinates can't divide it.
 */
static void fitting_box(const double lo[3], const double hi[3], double base[3], double extent[3]) {
    double longest = 0;
    for (int a = 0; a < 3; a++) longest = rgi_max(longest, hi[a] - lo[a]);
    for (int a = 0; a < 3; a++) {
        double magnitude = rgi_max(fabs(lo[a]), fabs(hi[a]));
        double margin = rgi_max(longest * 0x1p-10, magnitude * 0x1p-46);
        if (margin == 0) margin = RG_RADIUS_MIN;
        base[a] = lo[a] - margin;
        extent[a] = (hi[a] + margin) - base[a];
    }
}

static bool make_box(const rg_grid_config *config, bool given, const double lo[3], const double hi[3], double base[3],
                     double extent[3]) {
    if (given) {
        rgi_copy(config->lo, base);
        rgi_sub(config->hi, config->lo, extent);
        return true;
    }
    if (!(lo[0] <= hi[0])) return false;
    fitting_box(lo, hi, base, extent);
    return true;
}

static bool is_finite(const double lo[3], const double hi[3]) {
    return rgi_max(rgi_max_magnitude(lo), rgi_max_magnitude(hi)) < INFINITY;
}

/* Whether the members would be in too many cells of a uniform grid. */
static bool too_fine(const rgi_grid *grid, const double extent[3], const uint32_t count[3]) {
    double entries = 0, seen = 0;
    uint32_t step = grid->members.used / SAMPLE + 1;
    for (uint32_t i = 0; i < grid->members.used; i += step) {
        const rgi_member *m = rgi_grid_member(grid, i);
        double own = 1;
        if (!m->alive) continue;
        seen++;
        if (!is_finite(m->lo, m->hi)) continue;
        for (int a = 0; a < 3; a++) own *= 1 + (m->hi[a] - m->lo[a]) * (count[a] / extent[a]);
        entries += own;
    }
    return entries > ENTRIES_PER_MEMBER * seen;
}

/* Makes cells, not cleared, for the members that the grid has. `given`: with the box of the configuration, else with
 * one around lo to hi. */
static rg_result make_cells(const rgi_grid *grid, const rg_grid_config *config, bool given, const double lo[3],
                            const double hi[3], rgi_cells *cells) {
    double base[3], extent[3];
    uint32_t count[3];
    rgi_cells_init(cells, grid->memory);
    if (!make_box(config, given, lo, hi, base, extent)) return RG_OK;
    if (config->resolution) {
        uint32_t resolution = config->resolution;
        do {
            counts_for_resolution(config->kind, extent, resolution, count);
            resolution /= 2;
        } while (cells_of(count) > MAX_CELLS);
    } else {
        automatic_counts(config->kind, extent, grid->member_count, count);
        while (config->kind == RG_GRID_UNIFORM && cells_of(count) > 1 && too_fine(grid, extent, count)) {
            for (int a = 0; a < 3; a++) count[a] = (count[a] + 1) / 2;
        }
    }
    return rgi_cells_make(cells, grid->memory, config->kind == RG_GRID_HIERARCHICAL, base, extent, count);
}

/* Stores all members in new cells; the records learn their entries only when nothing can fail any more. */
static rg_result fill_cells(rgi_grid *grid, rgi_cells *cells) {
    uint64_t entries = 0;
    rg_result result = RG_OK;
    rgi_placement p;
    for (uint32_t i = 0; i < grid->members.used; i++) {
        const rgi_member *m = rgi_grid_member(grid, i);
        uint64_t tiles = 0;
        if (!m->alive) continue;
        rgi_cells_place(cells, m->lo, m->hi, &p);
        rgi_cells_need(cells, &p, &entries, &tiles);
        /* Tiles are made here, so that each is reserved once: their number is not known before. */
        if (tiles) result = rgi_cells_reserve(cells, 0, tiles);
        if (result) return result;
        if (tiles) rgi_cells_touch(cells, &p);
    }
    result = rgi_cells_reserve(cells, entries, 0);
    if (result) return result;
    for (uint32_t i = 0; i < grid->members.used; i++) {
        rgi_member *m = rgi_slots_at(&grid->members, i);
        if (!m->alive) continue;
        rgi_cells_place(cells, m->lo, m->hi, &p);
        m->entries = rgi_cells_insert(cells, &p, m->object);
    }
    return RG_OK;
}

bool rgi_grid_survey(const rgi_grid *grid, uint32_t *member, uint32_t count, double lo[3], double hi[3]) {
    for (; count && *member < grid->members.used; count--, ++*member) {
        const rgi_member *m = rgi_grid_member(grid, *member);
        if (m->alive && is_finite(m->lo, m->hi)) rgi_grow(lo, hi, m->lo, m->hi);
    }
    return *member == grid->members.used;
}

static void begin_sweep(rgi_grid *grid) {
    grid->sweep = 0;
    rgi_empty_box(grid->sweep_lo, grid->sweep_hi);
}

/* A step of the sweep. */
static void sweep(rgi_grid *grid, uint32_t count) {
    if (!rgi_grid_survey(grid, &grid->sweep, count, grid->sweep_lo, grid->sweep_hi)) return;
    rgi_copy(grid->sweep_lo, grid->lo);
    rgi_copy(grid->sweep_hi, grid->hi);
    grid->swept = true;
    begin_sweep(grid);
}

/* Makes the logical box exact. */
static void tighten(rgi_grid *grid) {
    begin_sweep(grid);
    sweep(grid, UINT32_MAX);
}

/* Cells are made, for so many members. */
static void note_cells(rgi_grid *grid, bool given, uint64_t members) {
    const double origin[3] = {0, 0, 0};
    grid->box_given = given;
    grid->built_count = members;
    grid->grown = grid->swept = false;
    grid->physical = rgi_diagonal(origin, grid->cells.extent);
}

static rg_result rebuild(rgi_grid *grid, const rg_grid_config *config, bool given) {
    rgi_cells cells;
    tighten(grid);
    rg_result result = make_cells(grid, config, given, grid->lo, grid->hi, &cells);
    if (!result) rgi_cells_clear(&cells, 0, cells.cell_count);
    if (!result) result = fill_cells(grid, &cells);
    if (result) {
        rgi_cells_free(&cells);
        return result;
    }
    rgi_cells_free(&grid->cells);
    grid->cells = cells;
    note_cells(grid, given, grid->member_count);
    return RG_OK;
}

/* Without cells. */
static void begin(rgi_grid *grid, rgi_memory *memory, const rg_grid_config *config, rg_log log, void *log_user) {
    memset(grid, 0, sizeof *grid);
    grid->memory = memory;
    grid->config = *config;
    grid->log = log;
    grid->log_user = log_user;
    rgi_empty_box(grid->lo, grid->hi);
    begin_sweep(grid);
    rgi_cells_init(&grid->cells, memory);
    rgi_slots_init(&grid->members, memory, sizeof(rgi_member), "members of a grid");
}

rg_result rgi_grid_plan(rgi_grid *grid, const rgi_grid *old, const rgi_grid_rule *rule, const double lo[3],
                        const double hi[3]) {
    begin(grid, old->memory, &old->config, old->log, old->log_user);
    return make_cells(old, &old->config, rule->given, lo, hi, &grid->cells);
}

void rgi_grid_built(rgi_grid *grid, const rgi_grid *old, const rgi_grid_rule *rule) {
    bool first = !old->cells.level_count;
    note_cells(grid, rule->given, grid->member_count);
    grid->rebuilds = old->rebuilds + !first;
    tell(grid, first ? "built" : "rebuilt", rule->why);
}

/* ------------------------------------------------------------------------------------------------- lifetime */

rg_result rgi_grid_init(rgi_grid *grid, rgi_memory *memory, const rg_grid_config *config, rg_log log,
                        void *log_user) {
    begin(grid, memory, config, log, log_user);
    return rebuild(grid, config, has_box(config));
}

void rgi_grid_free(rgi_grid *grid) {
    rgi_cells_free(&grid->cells);
    rgi_slots_free(&grid->members);
}

/* ---------------------------------------------------------------------------------------------- the members */

void rgi_grid_need_insert(const rgi_grid *grid, const double lo[3], const double hi[3], rgi_grid_need *need) {
    rgi_placement p;
    rgi_cells_place(&grid->cells, lo, hi, &p);
    rgi_cells_need(&grid->cells, &p, &need->entries, &need->tiles);
    need->members++;
}

bool rgi_grid_need_move(const rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3],
                        rgi_grid_need *need) {
    const rgi_member *m = rgi_grid_member(grid, member);
    rgi_placement old, new;
    rgi_cells_place(&grid->cells, m->lo, m->hi, &old);
    rgi_cells_place(&grid->cells, lo, hi, &new);
    bool stays = rgi_placement_equal(&old, &new);
    if (!stays) rgi_cells_need(&grid->cells, &new, &need->entries, &need->tiles);
    return stays;
}

rg_result rgi_grid_reserve(rgi_grid *grid, const rgi_grid_need *need) {
    rg_result result = rgi_slots_reserve(&grid->members, need->members);
    if (!result) result = rgi_cells_reserve(&grid->cells, need->entries, need->tiles);
    return result;
}

/* The logical box takes a box in. */
static void hold(rgi_grid *grid, const double lo[3], const double hi[3]) {
    bool inside = true;
    if (is_finite(lo, hi)) {
        for (int a = 0; a < 3; a++) inside &= lo[a] >= grid->lo[a] && hi[a] <= grid->hi[a];
        rgi_grow(grid->sweep_lo, grid->sweep_hi, lo, hi);
    }
    if (!inside) {
        rgi_grow(grid->lo, grid->hi, lo, hi);
        grid->grown = true;
    }
    sweep(grid, SWEEP);
}

rg_result rgi_grid_insert(rgi_grid *grid, uint32_t object, const double lo[3], const double hi[3], uint32_t *member) {
    rgi_placement p;
    rgi_grid_need need = {1, 0, 0};
    rgi_cells_place(&grid->cells, lo, hi, &p);
    rgi_cells_need(&grid->cells, &p, &need.entries, &need.tiles);
    rg_result result = rgi_grid_reserve(grid, &need);
    if (result) return result;
    *member = rgi_slots_take(&grid->members);
    rgi_member *m = rgi_slots_at(&grid->members, *member);
    m->object = object;
    m->entries = rgi_cells_insert(&grid->cells, &p, object);
    m->alive = 1;
    rgi_copy(lo, m->lo);
    rgi_copy(hi, m->hi);
    grid->member_count++;
    hold(grid, lo, hi);
    return RG_OK;
}

void rgi_grid_move_inside(rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3]) {
    rgi_member *m = rgi_slots_at(&grid->members, member);
    rgi_copy(lo, m->lo);
    rgi_copy(hi, m->hi);
    hold(grid, lo, hi);
}

rg_result rgi_grid_move(rgi_grid *grid, uint32_t member, const double lo[3], const double hi[3]) {
    rgi_member *m = rgi_slots_at(&grid->members, member);
    rgi_placement old, new;
    rgi_cells_place(&grid->cells, m->lo, m->hi, &old);
    rgi_cells_place(&grid->cells, lo, hi, &new);
    if (!rgi_placement_equal(&old, &new)) {
        rgi_grid_need need = {0, 0, 0};
        rgi_cells_need(&grid->cells, &new, &need.entries, &need.tiles);
        rg_result result = rgi_grid_reserve(grid, &need);
        if (result) return result;
        rgi_cells_remove(&grid->cells, m->entries);
        m->entries = rgi_cells_insert(&grid->cells, &new, m->object);
    }
    rgi_grid_move_inside(grid, member, lo, hi);
    return RG_OK;
}

void rgi_grid_remove(rgi_grid *grid, uint32_t member) {
    rgi_member *m = rgi_slots_at(&grid->members, member);
    rgi_cells_remove(&grid->cells, m->entries);
    m->alive = 0;
    rgi_slots_give(&grid->members, member);
    grid->member_count--;
    sweep(grid, SWEEP);
}

/* -------------------------------------------------------------------------------------------------- the rules */

static rgi_grid_rule ruled(const char *why, bool given, bool outgrown) {
    const rgi_grid_rule r = {why, given, outgrown};
    return r;
}

static rgi_grid_rule ask_count(const rgi_grid *grid) {
    uint64_t now = grid->member_count, then = grid->built_count;
    if (!grid->cells.level_count)
        return ruled(now > FEW && grid->lo[0] <= grid->hi[0] ? "the first cells" : NULL, false, false);
    if (grid->config.resolution) return ruled(NULL, false, false);
    if (now > GROWTH * then + FEW) return ruled("more objects", grid->box_given, false);
    if (now * SHRINKAGE + FEW < then) return ruled("fewer objects", grid->box_given, false);
    return ruled(NULL, false, false);
}

/* The logical box is exact at the end of a sweep; if it then is far smaller than the physical box, that is made anew.
 */
static rgi_grid_rule ask_box(rgi_grid *grid) {
    double factor = grid->config.rebuild_factor;
    bool swept = grid->swept, grown = grid->grown;
    grid->swept = grid->grown = false;
    if (!swept && !grown) return ruled(NULL, false, false);
    double diagonal = rgi_diagonal(grid->lo, grid->hi);
    if (diagonal > factor * grid->physical) return ruled("the logical box outgrew the physical one", false, true);
    if (swept && !grid->box_given && diagonal * 2 * factor < grid->physical)
        return ruled("the objects drew together", false, false);
    return ruled(NULL, false, false);
}

rgi_grid_rule rgi_grid_ask(rgi_grid *grid) {
    if (grid->retry_in) {
        grid->retry_in--;
        return ruled(NULL, false, false);
    }
    bool never = grid->config.rebuild_factor == RG_REBUILD_NEVER;
    rgi_grid_rule r = ruled(NULL, false, false);
    if (!never || !grid->cells.level_count) r = ask_count(grid);
    if (!r.why && !never && grid->cells.level_count) r = ask_box(grid);
    return r;
}

bool rgi_grid_holds(const rgi_grid *grid, const rgi_grid_rule *r, const double lo[3], const double hi[3]) {
    return !r->outgrown || rgi_diagonal(lo, hi) > grid->config.rebuild_factor * grid->physical;
}

void rgi_grid_put_off(rgi_grid *grid, const char *why) {
    grid->retry_in = grid->member_count / 2 + FEW;
    if (why) tell(grid, "not rebuilt for want of memory", why);
}

void rgi_grid_obey(rgi_grid *grid, const rgi_grid_rule *r) {
    bool first = !grid->cells.level_count;
    tighten(grid);
    if (!rgi_grid_holds(grid, r, grid->lo, grid->hi)) return;
    rgi_fail_quietly(true);
    rg_result result = rebuild(grid, &grid->config, r->given);
    rgi_fail_quietly(false);
    if (result == RG_OK) {
        grid->rebuilds += !first;
        tell(grid, first ? "built" : "rebuilt", r->why);
    } else {
        rgi_grid_put_off(grid, r->why);
    }
}

void rgi_grid_settle(rgi_grid *grid) {
    const rgi_grid_rule r = rgi_grid_ask(grid);
    if (r.why) rgi_grid_obey(grid, &r);
}

rg_result rgi_grid_rebuild(rgi_grid *grid) {
    rg_result result = rebuild(grid, &grid->config, false);
    if (result) return result;
    grid->rebuilds++;
    tell(grid, "rebuilt", "asked for");
    return RG_OK;
}

rg_result rgi_grid_configure(rgi_grid *grid, const rg_grid_config *config) {
    bool given = has_box(config);
    rg_result result = rebuild(grid, config, given);
    if (result) return result;
    grid->config = *config;
    grid->rebuilds++;
    tell(grid, "rebuilt", "configured");
    return RG_OK;
}

void rgi_grid_report(const rgi_grid *grid, rg_grid_report *report) {
    const rgi_cells *c = &grid->cells;
    memset(report, 0, sizeof *report);
    report->kind = grid->config.kind;
    report->levels = c->level_count;
    for (int a = 0; a < 3 && c->level_count; a++) {
        report->resolution[a] = c->levels[0].count[a];
        report->physical_lo[a] = c->base[a];
        report->physical_hi[a] = c->base[a] + c->extent[a];
    }
    rgi_copy(grid->lo, report->logical_lo);
    rgi_copy(grid->hi, report->logical_hi);
    report->objects = grid->member_count;
    report->entries = c->entries.used - c->entries.free_count;
    report->unbounded = c->unbounded_count;
    report->tiles = c->tile_count;
    report->rebuilds = grid->rebuilds;
    for (uint32_t i = 0; i < c->table_room; i++) {
        if (c->table[i] != RGI_NONE)
            report->levels_used |= ((const rgi_tile *)rgi_slots_at(&c->tiles, c->table[i]))->levels_used;
    }
}
