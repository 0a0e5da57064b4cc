/* SPDX-License-Identifier: MIT */
/*
 * The binary tree of a mesh, split where the surface area heuristic over bins is least: I. Wald, "On fast
 * Construction of SAH-based Bounding Volume Hierarchies" (RT 2007), section 3. And what it costs to make wide nodes
 * of it: M. Pinedo's optimal collapse as in H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on
 * GPUs Through Compressed Wide BVHs" (HPG 2017), section 3.2.
 */
#include "mesh_build.h"

#include "beam.h"
#include "vec.h"

#include <string.h>

enum {
    /* Fewer leaves than that are parted by number, so that they are full. */
    FEW_LEAVES = 4,
    /* Below this depth items are parted by number: the tree is at most 32 levels deeper. */
    MOST_DEPTH = 48
};

/* What a leaf costs against a node, tested for a ray (measured): all its triangles at once, then what may be hit. */
#define LEAF_COST 1.2f
#define TRIANGLE_COST 0.03f

/* Items on the way to a subtree: its root, the box of twice their centres, and how deep it is. */
typedef struct part {
    uint32_t first, count, depth;
    rgi_wrap centres;
} part;

/* Twice the middle. */
static inline float centre(const rgi_item *it, int axis) {
    return it->least[axis] - it->least[axis + 4];
}

static inline void grow_centres(rgi_wrap *w, const rgi_item *it) {
    for (int a = 0; a < 3; a++) {
        float c = centre(it, a);
        w->least[a] = c < w->least[a] ? c : w->least[a];
        w->least[a + 4] = -c < w->least[a + 4] ? -c : w->least[a + 4];
    }
}

/* So wide are the bins, 0 along an axis where all centres are the same. */
static void bin_scales(const rgi_wrap *centres, uint32_t bins, float scales[3]) {
    for (int a = 0; a < 3; a++) {
        float width = -centres->least[a + 4] - centres->least[a], scale = (float)bins * (1 - 0x1p-20f) / width;
        scales[a] = width > 0 && scale < 0x1p100f ? scale : 0;
    }
}

/* Brings the items of the left side to the front; returns how many. */
static uint32_t part_items(rgi_item *items, uint32_t count, const rgi_wrap *centres, const float scales[3],
                           const rgi_cut *s, rgi_wrap *left, rgi_wrap *right) {
    const float lo = centres->least[s->axis], scale = scales[s->axis];
    uint32_t i = 0, j = count;
    while (i < j) {
        if (rgi_bin_of(centre(&items[i], s->axis), lo, scale) < s->bin) {
            grow_centres(left, &items[i++]);
            continue;
        }
        grow_centres(right, &items[i]);
        rgi_item swap = items[i];
        items[i] = items[--j];
        items[j] = swap;
    }
    return i;
}

/* ------------------------------------------------------------------------------------------------- the costs */

/* Whether the triangles of some items have no more vertices than a leaf holds. */
static bool leaf_holds(const rgi_making *m, uint32_t first, uint32_t count) {
    uint32_t seen[RGI_LEAF], vertices = 0;
    if (m->mesh->soup) return count <= RGI_SOUP_LEAF;
    if (count > RGI_LEAF) return false;
    if (3 * count <= RGI_LEAF) return true;
    memset(seen, 0xFF, sizeof seen); /* no vertex has that number */
    for (uint32_t i = first; i < first + count; i++) {
        uint32_t triangle;
        memcpy(&triangle, &m->items[i].least[3], sizeof triangle);
        for (int c = 0; c < 3; c++) {
            uint32_t v = m->triangles[triangle][c], known = 0;
            for (int k = 0; k < RGI_LEAF; k++) known |= seen[k] == v;
            if (known) continue;
            if (vertices == RGI_LEAF) return false;
            seen[vertices++] = v;
        }
    }
    return true;
}

/* The least cost of two subtrees in `places` places together. */
static float share(const rgi_branch *left, const rgi_branch *right, int places, uint8_t *of_left) {
    float least = (float)INFINITY;
    for (int k = 1; k < places; k++) {
        float cost = left->cost[k - 1] + right->cost[places - k - 1];
        if (!(cost < least)) continue;
        least = cost;
        *of_left = (uint8_t)k;
    }
    return least;
}

static void find_costs(const rgi_making *m, rgi_branch *b) {
    float area = rgi_wrap_half_area(&b->box), leaf = (float)INFINITY;
    memset(b->places, 0, sizeof b->places);
    b->opened = 0;
    if (!b->left) leaf = area * (LEAF_COST + TRIANGLE_COST * (float)b->count);
    b->cost[0] = leaf;
    if (b->left) {
        const rgi_branch *left = b + 1, *right = b + 2 * b->left;
        uint8_t opened = 0;
        float node = area + share(left, right, RGI_CHILDREN, &opened);
        /* Of areas that are all 0 or all too large the sums can't be compared: then any way will do. */
        if (node < leaf || !(leaf < (float)INFINITY)) {
            b->cost[0] = node;
            b->opened = opened ? opened : RGI_CHILDREN / 2;
        }
    }
    for (int i = 1; i < RGI_CHILDREN - 1; i++) {
        b->cost[i] = b->cost[i - 1];
        if (!b->left) continue;
        uint8_t of_left = 0;
        float cost = share(b + 1, b + 2 * b->left, i + 1, &of_left);
        if (!(cost < b->cost[i])) continue;
        b->cost[i] = cost;
        b->places[i] = of_left;
    }
}

/* -------------------------------------------------------------------------------------------------- the tree */

/* Brings the `first` items with the least centres along an axis to the front: C. A. R. Hoare, "Find" (1961). */
static void select_items(rgi_item *items, uint32_t count, int axis, uint32_t first) {
    int64_t from = 0, to = (int64_t)count - 1, wanted = (int64_t)first - 1;
    while (from < to) {
        float pivot = centre(&items[wanted], axis);
        int64_t i = from, j = to;
        while (i <= j) {
            while (centre(&items[i], axis) < pivot) i++;
            while (centre(&items[j], axis) > pivot) j--;
            if (i > j) break;
            rgi_item swap = items[i];
            items[i++] = items[j];
            items[j--] = swap;
        }
        if (j < wanted) from = i;
        if (i > wanted) to = j;
    }
}

static float half_area_of(const rgi_item *items, uint32_t count) {
    rgi_wrap w;
    rgi_wrap_empty(&w);
    for (uint32_t i = 0; i < count; i++) rgi_wrap_grow(&w, &items[i]);
    return rgi_wrap_half_area(&w);
}

/* Parts items by number along the best axis: whole leaves to the left, near the middle. Returns how many that are. */
static uint32_t part_by_number(rgi_item *items, uint32_t count, uint32_t fill) {
    uint32_t leaves = (count + fill - 1) / fill, left = leaves / 2 * fill;
    float least = (float)INFINITY;
    int best = 2;
    if (left == 0 || left >= count) left = count / 2;
    for (int a = 0; a < 3; a++) {
        select_items(items, count, a, left);
        float area = half_area_of(items, left) * (float)left +
                     half_area_of(items + left, count - left) * (float)(count - left);
        if (!(area < least)) continue;
        least = area;
        best = a;
    }
    if (best != 2) select_items(items, count, best, left);
    return left;
}

static void make_branch(const rgi_making *m, rgi_branch *branch, const part *p) {
    rgi_item *items = m->items + p->first;
    part left = {p->first, 0, p->depth + 1, {{0}}}, right = left;
    branch->first = p->first;
    branch->count = p->count;
    branch->left = 0;
    if (leaf_holds(m, p->first, p->count)) {
        rgi_wrap_empty(&branch->box);
        for (uint32_t i = 0; i < p->count; i++) rgi_wrap_grow(&branch->box, &items[i]);
        find_costs(m, branch);
        return;
    }
    float scales[3];
    rgi_cut s = {-1, 0, 0};
    bool few = p->count <= FEW_LEAVES * m->fill;
    uint32_t bins = p->count < 16 * RGI_BINS ? RGI_BINS / 2 : RGI_BINS;
    bin_scales(&p->centres, bins, scales);
    rgi_wrap_empty(&left.centres);
    rgi_wrap_empty(&right.centres);
    if (!few && p->depth < MOST_DEPTH) m->mesh->kernels->find_split(items, p->count, &p->centres, scales, bins, m->fill, &s);
    if (s.axis >= 0) {
        left.count = part_items(items, p->count, &p->centres, scales, &s, &left.centres, &right.centres);
    } else {
        left.count = few ? part_by_number(items, p->count, m->fill) : p->count / 2;
        for (uint32_t i = 0; i < p->count; i++)
            grow_centres(i < left.count ? &left.centres : &right.centres, &items[i]);
    }
    right.first += left.count;
    right.count = p->count - left.count;
    branch->left = left.count;
    make_branch(m, branch + 1, &left);
    make_branch(m, branch + 2 * (size_t)left.count, &right);
    branch->box = branch[1].box;
    rgi_wrap_grow(&branch->box, &branch[2 * (size_t)left.count].box);
    find_costs(m, branch);
}

void rgi_branches_make(rgi_making *m) {
    part all = {0, m->mesh->triangle_count, 0, {{0}}};
    rgi_wrap_empty(&all.centres);
    for (uint32_t i = 0; i < m->mesh->triangle_count; i++) {
        rgi_item *it = &m->items[i];
        rgi_wrap_empty(it);
        for (int c = 0; c < 3; c++) {
            const float *v = m->at[m->triangles[i][c]];
            const rgi_wrap corner = {{v[0], v[1], v[2], 0, -v[0], -v[1], -v[2], 0}};
            rgi_wrap_grow(it, &corner);
        }
        memcpy(&it->least[3], &i, sizeof i);
        grow_centres(&all.centres, it);
    }
    make_branch(m, m->branches, &all);
}
