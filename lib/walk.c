/* SPDX-License-Identifier: MIT */
/*
 * Walks never add up steps. Every crossing of a wall is computed from the wall's integer index, t = (index * size -
 * origin) / direction, so an error can't grow (J. Amanatides, A. Woo, "A Fast Voxel Traversal Algorithm for Ray
 * Tracing", Eurographics 1987, gives the order of the walls; the sum in their loop is what drifts). For each tile the
 * ray is first moved to where it enters, by exact sums, and everything counts from the tile's corner: the error is
 * some 2^-50 of the tile's size wherever the tile and the ray's origin are, and boxes are listed with a pad of 2^-36
 * of it.
 */
#include "walk.h"

#include "exact.h"
#include "vec.h"

/* Up to so many tiles along each axis of the logical box a ray goes from tile to tile; the walls between them are
 * then placed right to 2^-50 * 2^10 of a tile. Larger worlds are sparse: there each tile that holds something is
 * tested. */
#define MANY_TILES 1024.0

/* Below 2^-60 of the largest component a direction can't leave the pad of the boxes inside one tile. */
#define LEAST_COMPONENT 0x1p-60

void rgi_walk_init(rgi_walk *walk, const double origin[3], const double direction[3], double t_min, double t_max) {
    for (int a = 0; a < 3; a++) {
        double d = direction[a];
        walk->origin[a] = origin[a];
        walk->direction[a] = d;
        walk->inverse[a] = 1 / (fabs(d) > LEAST_COMPONENT ? d : copysign(LEAST_COMPONENT, d));
    }
    walk->t_min = t_min;
    walk->t_max = t_max;
    walk->cells = 0;
}

static double earlier(double t) {
    return t > 0 ? t * (1 - 0x1p-49) : t * (1 + 0x1p-49);
}
static double later(double t) {
    return t > 0 ? t * (1 + 0x1p-49) : t * (1 - 0x1p-49);
}

/*
 * Narrows [*from, *to] to where the ray is inside the box, rounded outward; false if nowhere. Not by walk->inverse:
 * from far away even the smallest component counts. Below 2^-900 it moves nothing, whatever the distance
 * (RG_COORDINATE_MAX).
 */
static bool clip(const rgi_walk *walk, const double lo[3], const double hi[3], double *from, double *to) {
    for (int a = 0; a < 3; a++) {
        if (fabs(walk->direction[a]) < 0x1p-900) {
            if (walk->origin[a] < lo[a] || walk->origin[a] > hi[a]) return false;
            continue;
        }
        double inverse = 1 / walk->direction[a];
        double t0 = (lo[a] - walk->origin[a]) * inverse, t1 = (hi[a] - walk->origin[a]) * inverse;
        *from = rgi_max(*from, earlier(rgi_min(t0, t1)));
        *to = rgi_min(*to, later(rgi_max(t0, t1)));
    }
    return *from <= *to;
}

/* ------------------------------------------------------------------------------------------ inside a tile */

/* A walk through one lattice of cells; t counts from `start`. */
typedef struct stepper {
    double origin[3]; /* from the lattice's corner, at t = 0 */
    double size[3];
    const double *inverse;
    int32_t cell[3], step[3];
    double next[3]; /* t of the wall ahead on each axis */
    bool fixed[3];  /* on this axis the ray stays within the pad of the boxes: there is no wall ahead */
    double start;
    double slack; /* rounding of start + t */
} stepper;

static double wall_ahead(const stepper *s, int a) {
    if (s->fixed[a]) return INFINITY;
    return (s->size[a] * ((double)s->cell[a] + (s->step[a] > 0)) - s->origin[a]) * s->inverse[a];
}

/*
 * From `start` to `to`, which are finite. A ray that hardly moves along an axis stays in one cell there: everything
 * that it can meet is listed in it, the pad being wider than the way. Its walls must not count: where the ray runs
 * along one, rounding may put it on either side, and it would leave the lattice at once, unseen.
 */
static void stepper_init(stepper *s, const rgi_walk *walk, const double corner[3], const double size[3],
                         const int32_t first[3], const int32_t last[3], double pad, double start, double to) {
    rgi_rebase3(walk->origin, corner, start, walk->direction, s->origin);
    s->inverse = walk->inverse;
    s->start = start;
    s->slack = fabs(start) * 0x1p-50;
    for (int a = 0; a < 3; a++) {
        s->size[a] = size[a];
        s->step[a] = s->inverse[a] < 0 ? -1 : 1;
        s->cell[a] = (int32_t)rgi_floor(rgi_max(first[a], rgi_min(s->origin[a] / size[a], last[a])));
        s->fixed[a] = fabs(walk->direction[a]) * (to - start) <= 0.5 * pad;
        s->next[a] = wall_ahead(s, a);
    }
}

/* Which wall comes next. */
static int next_axis(const stepper *s) {
    int axis = s->next[1] < s->next[0] ? 1 : 0;
    return s->next[2] < s->next[axis] ? 2 : axis;
}

static bool ends_before(const stepper *s, int axis, double t_max) {
    return s->next[axis] > t_max - s->start + s->slack;
}

static void advance(stepper *s, int axis) {
    s->cell[axis] += s->step[axis];
    s->next[axis] = wall_ahead(s, axis);
}

static bool visit_list(const rgi_cells *cells, uint32_t entry, uint32_t tile, rgi_walk *walk) {
    while (entry != RGI_NONE) {
        const rgi_entry *e = rgi_slots_at(&cells->entries, entry);
        /* The mark that tells apart what the torus maps to the same cell. */
        if (e->tile == tile && walk->visit(walk->context, e->object)) return true;
        entry = e->next;
    }
    return false;
}

/* Looks into the cell of each level in `levels` that contains cell s->cell of level `finest`. */
static bool visit_levels(const rgi_cells *cells, uint32_t levels, uint32_t finest, uint32_t tile, const stepper *s,
                         rgi_walk *walk) {
    while (levels) {
        uint32_t l = (uint32_t)__builtin_ctz(levels), shift = l - finest;
        const rgi_level *level = &cells->levels[l];
        uint32_t x = (uint32_t)s->cell[0] >> shift, y = (uint32_t)s->cell[1] >> shift,
                 z = (uint32_t)s->cell[2] >> shift;
        uint32_t cell = level->first + (z * level->count[1] + y) * level->count[0] + x;
        walk->cells++;
        if (visit_list(cells, cells->heads[cell], tile, walk)) return true;
        levels &= levels - 1;
    }
    return false;
}

/*
 * From cell to cell at the finest level that holds anything in this tile. A step from index i to j enters new cells
 * on all levels up to the highest bit in which i and j differ; those that hold anything are looked into, so no cell
 * of any level is looked into twice, and none of an empty level.
 */
static bool walk_tile(const rgi_cells *cells, uint32_t index, double from, double to, rgi_walk *walk) {
    const rgi_tile *tile = rgi_slots_at(&cells->tiles, index);
    static const int32_t first[3] = {0, 0, 0};
    double corner[3], lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        corner[a] = rgi_tile_base(cells, a, tile->at[a]);
        double pad = cells->pad + 0x1p-49 * fabs(corner[a]);
        lo[a] = corner[a] - pad;
        hi[a] = corner[a] + cells->extent[a] + pad;
    }
    if (!clip(walk, lo, hi, &from, &to)) return false;
    uint32_t finest = (uint32_t)__builtin_ctz(tile->levels_used), entered = tile->levels_used;
    const rgi_level *level = &cells->levels[finest];
    int32_t last[3];
    for (int a = 0; a < 3; a++) last[a] = (int32_t)level->count[a] - 1;
    stepper s;
    stepper_init(&s, walk, corner, level->size, first, last, cells->pad, from, to);
    for (;;) {
        if (visit_levels(cells, entered, finest, index, &s, walk)) return true;
        int axis = next_axis(&s);
        if (ends_before(&s, axis, rgi_min(to, walk->t_max))) return false;
        uint32_t before = (uint32_t)s.cell[axis];
        advance(&s, axis);
        if (s.cell[axis] < 0 || s.cell[axis] > last[axis]) return false;
        uint32_t highest = 31 - (uint32_t)__builtin_clz(before ^ (uint32_t)s.cell[axis]);
        entered = tile->levels_used & (uint32_t)((2ull << (finest + highest)) - 1);
    }
}

/* ------------------------------------------------------------------------------------------- among tiles */

/* The tiles that the logical box overlaps; false if there are too many to step through. */
static bool tile_range(const rgi_cells *cells, const double lo[3], const double hi[3], int32_t first[3],
                       int32_t last[3]) {
    for (int a = 0; a < 3; a++) {
        double from = (lo[a] - cells->pad - cells->base[a]) / cells->extent[a] - 1;
        double to = (hi[a] + cells->pad - cells->base[a]) / cells->extent[a] + 1;
        if (!(fabs(from) < MANY_TILES && fabs(to) < MANY_TILES)) return false;
        first[a] = (int32_t)rgi_floor(from);
        last[a] = (int32_t)rgi_floor(to);
    }
    return true;
}

static uint32_t index_of(const rgi_cells *cells, const int32_t at[3]) {
    return cells->table[rgi_cells_table_place(cells, at)];
}

static bool step_through_tiles(const rgi_cells *cells, const int32_t first[3], const int32_t last[3], double from,
                               double to, rgi_walk *walk) {
    stepper s;
    stepper_init(&s, walk, cells->base, cells->extent, first, last, cells->pad, from, to);
    for (;;) {
        uint32_t tile = index_of(cells, s.cell);
        if (tile != RGI_NONE && walk_tile(cells, tile, from, to, walk)) return true;
        int axis = next_axis(&s);
        if (ends_before(&s, axis, rgi_min(to, walk->t_max))) return false;
        advance(&s, axis);
        if (s.cell[axis] < first[axis] || s.cell[axis] > last[axis]) return false;
    }
}

static bool try_all_tiles(const rgi_cells *cells, double from, double to, rgi_walk *walk) {
    for (uint32_t i = 0; i < cells->table_room; i++) {
        if (cells->table[i] == RGI_NONE) continue;
        if (walk_tile(cells, cells->table[i], from, rgi_min(to, later(walk->t_max)), walk)) return true;
    }
    return false;
}

bool rgi_cells_walk(const rgi_cells *cells, const double lo[3], const double hi[3], rgi_walk *walk) {
    static const int32_t home[3] = {0, 0, 0};
    int32_t first[3], last[3];
    if (visit_list(cells, cells->unbounded, RGI_NONE, walk)) return true;
    double from = walk->t_min, to = walk->t_max;
    if (!cells->tile_count || !clip(walk, lo, hi, &from, &to)) return false;
    /* Nothing has left the box: what tiles are for is left out. */
    uint32_t tile = cells->tile_count == 1 ? index_of(cells, home) : RGI_NONE;
    if (tile != RGI_NONE) return walk_tile(cells, tile, from, to, walk);
    if (tile_range(cells, lo, hi, first, last)) return step_through_tiles(cells, first, last, from, to, walk);
    return try_all_tiles(cells, from, to, walk);
}
