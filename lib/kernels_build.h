/* SPDX-License-Identifier: MIT */
/* The part of the kernels that helps to build meshes; included by kernels.h alone. */
#include "mesh_build.h"

typedef struct bins {
    rgi_wrap box[3][RGI_BINS];
    uint32_t count[3][RGI_BINS];
} bins;

RGI_INLINE void grow(rgi_wrap *w, f8 by) {
    f8_store(w->least, f8_min(f8_load(w->least), by));
}

/* For one axis, sum over both sides of area * leaves: such as are not full count whole. */
RGI_INLINE void best_plane(const rgi_wrap *box, const uint32_t *counts, uint32_t bins, uint32_t fill, int axis,
                           rgi_cut *best) {
    float right_cost[RGI_BINS];
    rgi_wrap w;
    uint32_t count = 0;
    rgi_wrap_empty(&w);
    for (uint32_t b = bins - 1; b > 0; b--) {
        grow(&w, f8_load(box[b].least));
        count += counts[b];
        right_cost[b] = count ? rgi_wrap_half_area(&w) * (float)((count + fill - 1) / fill) : (float)INFINITY;
    }
    rgi_wrap_empty(&w);
    count = 0;
    for (uint32_t b = 0; b < bins - 1; b++) {
        grow(&w, f8_load(box[b].least));
        count += counts[b];
        float cost = rgi_wrap_half_area(&w) * (float)((count + fill - 1) / fill) + right_cost[b + 1];
        if (count && cost < best->cost) {
            best->cost = cost;
            best->axis = axis;
            best->bin = (int)b + 1;
        }
    }
}

static void find_split(const rgi_wrap *items, uint32_t count, const rgi_wrap *centres, const float scales[3],
                       uint32_t used, uint32_t fill, rgi_cut *best) {
    bins b;
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < used; i++) rgi_wrap_empty(&b.box[a][i]);
    }
    memset(b.count, 0, sizeof b.count);
    for (uint32_t i = 0; i < count; i++) {
        const float *item = items[i].least;
        f8 box = f8_load(item);
        for (int a = 0; a < 3; a++) {
            int n = rgi_bin_of(item[a] - item[a + 4], centres->least[a], scales[a]);
            grow(&b.box[a][n], box);
            b.count[a][n]++;
        }
    }
    best->axis = -1;
    best->cost = (float)INFINITY;
    for (int a = 0; a < 3; a++) {
        if (scales[a] > 0) best_plane(b.box[a], b.count[a], used, fill, a, best);
    }
}

/* Without branches on the sides, which can't be foreseen. */
static uint32_t part_items(rgi_item *items, rgi_item *spare, uint32_t count, const rgi_wrap *centres,
                           const float scales[3], const rgi_cut *cut, rgi_wrap *left, rgi_wrap *right) {
    const float lo = centres->least[cut->axis], scale = scales[cut->axis];
    const f8 none = f8_set(INFINITY);
    f8 of_left = none, of_right = none;
    uint32_t lefts = 0, rights = 0;
    for (uint32_t i = 0; i < count; i++) {
        f8 item = f8_load(items[i].least), centre = f8_sub(item, f8_turned(item));
        float c = items[i].least[cut->axis] - items[i].least[cut->axis + 4];
        uint32_t to_right = rgi_bin_of(c, lo, scale) >= cut->bin;
        f8_store(items[lefts].least, item);
        f8_store(spare[rights].least, item);
        of_left = f8_min(of_left, f8_pick(to_right - 1, centre, none));
        of_right = f8_min(of_right, f8_pick(0 - to_right, centre, none));
        rights += to_right;
        lefts += 1 - to_right;
    }
    memcpy(items + lefts, spare, rights * sizeof *spare);
    f8_store(left->least, of_left);
    f8_store(right->least, of_right);
    return lefts;
}

/* The right side when `left` items with the least centres along an axis go to the left, as bits: by the rank of each,
 * among equals by where it is. */
RGI_INLINE uint64_t right_by_rank(const float centres[RGI_FEW_ITEMS], uint32_t count, uint32_t left) {
    uint64_t right = 0;
    for (uint32_t i = 0; i < count; i++) {
        f16 centre = f16_set(centres[i]);
        uint64_t not_above = 0, not_below = 0;
        for (uint32_t k = 0; k < count; k += 16) {
            f16 others = f16_load(centres + k);
            not_above |= (uint64_t)f16_le(others, centre) << k;
            not_below |= (uint64_t)f16_le(centre, others) << k;
        }
        uint64_t before = (not_above & ~not_below) | (not_above & not_below & ((UINT64_C(1) << i) - 1));
        right |= (uint64_t)((uint32_t)__builtin_popcountll(before) >= left) << i;
    }
    return right;
}

static float cost_of_sides(const rgi_item *items, uint32_t count, uint64_t right, uint32_t left) {
    const f8 none = f8_set(INFINITY);
    f8 boxes[2] = {none, none};
    rgi_wrap w[2];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t to_right = right >> i & 1;
        f8 item = f8_load(items[i].least);
        boxes[0] = f8_min(boxes[0], f8_pick(to_right - 1, item, none));
        boxes[1] = f8_min(boxes[1], f8_pick(0 - to_right, item, none));
    }
    for (int s = 0; s < 2; s++) f8_store(w[s].least, boxes[s]);
    return rgi_wrap_half_area(&w[0]) * (float)left + rgi_wrap_half_area(&w[1]) * (float)(count - left);
}

static void part_few(rgi_item *items, rgi_item *spare, uint32_t count, uint32_t left) {
    float centres[RGI_FEW_ITEMS] __attribute__((aligned(64))), least = (float)INFINITY;
    uint32_t lefts = 0, rights = 0;
    uint64_t best = ~UINT64_C(0) << left;
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < RGI_FEW_ITEMS; i++)
            centres[i] = i < count ? items[i].least[a] - items[i].least[a + 4] : (float)INFINITY;
        uint64_t right = right_by_rank(centres, count, left);
        float cost = cost_of_sides(items, count, right, left);
        if (!(cost < least)) continue;
        least = cost;
        best = right;
    }
    for (uint32_t i = 0; i < count; i++) {
        f8 item = f8_load(items[i].least);
        uint32_t to_right = best >> i & 1;
        f8_store(items[lefts].least, item);
        f8_store(spare[rights].least, item);
        rights += to_right;
        lefts += 1 - to_right;
    }
    memcpy(items + lefts, spare, rights * sizeof *spare);
}

/* ------------------------------------------------------------------------------------------------- items */

/* Of a point. */
RGI_INLINE f8 wrap_of(const float at[4]) {
    static const float signs[8] __attribute__((aligned(32))) = {1, 1, 1, 1, -1, -1, -1, -1};
    return f8_mul(f8_twice(at), f8_load(signs));
}

RGI_INLINE f8 wrap_of_triangle(const rgi_making *m, uint32_t i) {
    return f8_min(f8_min(wrap_of(rgi_corner(m, i, 0)), wrap_of(rgi_corner(m, i, 1))), wrap_of(rgi_corner(m, i, 2)));
}

RGI_INLINE f8 wrap_of_run(const rgi_making *m, const rgi_run *run) {
    if (m->mesh->soup) {
        f8 box = wrap_of_triangle(m, m->order[run->first]);
        for (uint32_t k = 1; k < run->count; k++) box = f8_min(box, wrap_of_triangle(m, m->order[run->first + k]));
        return box;
    }
    f8 box = wrap_of(m->at[run->numbers[0]]);
    for (uint32_t k = 1; k < run->vertices; k++) box = f8_min(box, wrap_of(m->at[run->numbers[k]]));
    return box;
}

static void wrap_items(const rgi_making *m) {
    for (uint32_t i = 0; i < m->item_count; i++) {
        if (m->runs && i + 3 < m->item_count) rgi_run_fetch(m, &m->runs[i + 3]);
        f8_store(m->items[i].least, m->runs ? wrap_of_run(m, &m->runs[i]) : wrap_of_triangle(m, i));
        memcpy(&m->items[i].least[3], &i, sizeof i);
    }
}

/* ------------------------------------------------------------------------------------------------ leaves */

RGI_INLINE f16 f16_apart(f16 a, f16 b) {
    f16 d = f16_sub(a, b);
    return f16_max(d, f16_sub(f16_set(0), d));
}

static void measure_connected(rgi_mesh_leaf *leaf, float lo[3], float hi[3]) {
    f16 most = f16_set(0);
    for (int a = 0; a < 3; a++) {
        f16 at = f16_load(leaf->at[a]);
        f16 p = f16_take(at, leaf->corner[0]), q = f16_take(at, leaf->corner[1]), r = f16_take(at, leaf->corner[2]);
        most = f16_max(most, f16_max(f16_apart(p, q), f16_max(f16_apart(q, r), f16_apart(r, p))));
        lo[a] = f16_least(at);
        hi[a] = f16_most(at);
    }
    leaf->longest = f16_most(most) * (1 + 0x1p-20f);
}

/* Lanes that hold no triangle are NaN, and do not count. */
static void measure_soup(const rgi_soup_leaf *leaf, float lo[3], float hi[3]) {
    for (int a = 0; a < 3; a++) {
        float least[RGI_SOUP_LEAF], most[RGI_SOUP_LEAF];
        f8 p = f8_load(leaf->at[0][a]), q = f8_load(leaf->at[1][a]), r = f8_load(leaf->at[2][a]);
        f8_store(least, f8_min(f8_min(p, q), r));
        f8_store(most, f8_max(f8_max(p, q), r));
        lo[a] = (float)INFINITY;
        hi[a] = -(float)INFINITY;
        for (int i = 0; i < RGI_SOUP_LEAF; i++) {
            lo[a] = least[i] < lo[a] ? least[i] : lo[a];
            hi[a] = most[i] > hi[a] ? most[i] : hi[a];
        }
    }
}

RGI_INLINE void add_diagonal(rgi_reaches *r, int diagonal, f8 a, f8 b) {
    f8_store(r->most[diagonal], f8_max(f8_load(r->most[diagonal]), f8_max(a, b)));
    f8_store(r->least[diagonal], f8_min(f8_load(r->least[diagonal]), f8_min(a, b)));
}

/* Sums in this order and without fused operations: how far points reach has the same bits everywhere. */
RGI_INLINE f8 square_of(f8 x, f8 y, f8 z) {
    return f8_add(f8_add(f8_mul(x, x), f8_mul(y, y)), f8_mul(z, z));
}

/* Of twice as many points as there are lanes: what is stored costs more than what is computed. */
RGI_INLINE void add_points(rgi_reaches *r, const f8 x[2], const f8 y[2], const f8 z[2]) {
    const f8 sum[2] = {f8_add(x[0], y[0]), f8_add(x[1], y[1])};
    const f8 difference[2] = {f8_sub(x[0], y[0]), f8_sub(x[1], y[1])};
    add_diagonal(r, 0, sum[0], sum[1]);
    add_diagonal(r, 1, difference[0], difference[1]);
    add_diagonal(r, 2, f8_add(x[0], z[0]), f8_add(x[1], z[1]));
    add_diagonal(r, 3, f8_sub(x[0], z[0]), f8_sub(x[1], z[1]));
    add_diagonal(r, 4, f8_add(y[0], z[0]), f8_add(y[1], z[1]));
    add_diagonal(r, 5, f8_sub(y[0], z[0]), f8_sub(y[1], z[1]));
    add_diagonal(r, 6, f8_add(sum[0], z[0]), f8_add(sum[1], z[1]));
    add_diagonal(r, 7, f8_sub(sum[0], z[0]), f8_sub(sum[1], z[1]));
    add_diagonal(r, 8, f8_add(difference[0], z[0]), f8_add(difference[1], z[1]));
    add_diagonal(r, 9, f8_sub(difference[0], z[0]), f8_sub(difference[1], z[1]));
    f8 squares = f8_max(square_of(x[0], y[0], z[0]), square_of(x[1], y[1], z[1]));
    f8_store(r->square, f8_max(f8_load(r->square), squares));
}

/* For a lane that is NaN, the first, which never is. */
RGI_INLINE f8 load_soup(const float lanes[RGI_SOUP_LEAF]) {
    f8 at = f8_load(lanes);
    return f8_pick(f8_le(at, at), at, f8_set(lanes[0]));
}

RGI_INLINE void add_soup(rgi_reaches *r, const rgi_soup_leaf *leaf, int corner, int other) {
    f8 at[3][2];
    for (int a = 0; a < 3; a++) {
        at[a][0] = load_soup(leaf->at[corner][a]);
        at[a][1] = load_soup(leaf->at[other][a]);
    }
    add_points(r, at[0], at[1], at[2]);
}

RGI_INLINE void add_connected(rgi_reaches *r, const rgi_mesh_leaf *leaf) {
    f8 at[3][2];
    for (int a = 0; a < 3; a++) {
        for (int half = 0; half < 2; half++) at[a][half] = f8_load(leaf->at[a] + half * RGI_TOGETHER);
    }
    add_points(r, at[0], at[1], at[2]);
}

static void measure_leaf(const rgi_mesh *mesh, void *leaf, rgi_reaches *reaches, float lo[3], float hi[3]) {
    if (mesh->soup) {
        measure_soup(leaf, lo, hi);
        add_soup(reaches, leaf, 0, 1);
        add_soup(reaches, leaf, 1, 2);
    } else {
        measure_connected(leaf, lo, hi);
        add_connected(reaches, leaf);
    }
}
