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
    /* Parts that a large tree is cut into, to be made side by side, and how many triangles are large. */
    PARTS = 128,
    LEAST_SHARED = 16384,
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

/* ------------------------------------------------------------------------------------------------- the costs */

/* Whether the triangles of some items have no more vertices than a leaf holds. */
static bool leaf_holds(const rgi_making *m, uint32_t first, uint32_t count) {
    uint32_t numbers[RGI_LEAF];
    uint8_t corner[3][RGI_LEAF];
    if (m->fast) return count == 1;
    if (m->mesh->soup) return count <= RGI_SOUP_LEAF;
    if (count > RGI_LEAF) return false;
    if (3 * count <= RGI_LEAF) return true;
    return rgi_corners_number(m, m->items + first, count, numbers, corner) <= RGI_LEAF;
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
    if (m->fast) return;
    const rgi_branch *left = m->branches + b->children, *right = left + 1;
    float area = rgi_wrap_half_area(&b->box), leaf = (float)INFINITY;
    memset(b->places, 0, sizeof b->places);
    b->opened = 0;
    if (!b->children) leaf = area * (LEAF_COST + TRIANGLE_COST * (float)b->count);
    b->cost[0] = leaf;
    if (b->children) {
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
        if (!b->children) continue;
        uint8_t of_left = 0;
        float cost = share(left, right, i + 1, &of_left);
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

/* The axis along which the centres are farthest apart. */
static int widest_axis(const rgi_wrap *centres) {
    int widest = 0;
    for (int a = 1; a < 3; a++) {
        if (centres->least[a] + centres->least[a + 4] < centres->least[widest] + centres->least[widest + 4])
            widest = a;
    }
    return widest;
}

/* Few items: whole leaves to the left, near the middle. Returns how many that are. */
static uint32_t part_by_number(const rgi_making *m, const part *p) {
    uint32_t leaves = (p->count + m->fill - 1) / m->fill, left = leaves / 2 * m->fill;
    if (left == 0 || left >= p->count) left = p->count / 2;
    m->mesh->kernels->part_few(m->items + p->first, m->spare + p->first, p->count, left);
    return left;
}

/* In a hurry: of few leaves half to each side along the axis on which they are farthest apart. */
static uint32_t part_in_half(rgi_item *items, uint32_t count, const rgi_wrap *centres) {
    select_items(items, count, widest_axis(centres), count / 2);
    return count / 2;
}

/* Parts items where that costs least. Returns how many go to the left. */
static uint32_t part_items_of(const rgi_making *m, const part *p, rgi_wrap *left, rgi_wrap *right) {
    rgi_item *items = m->items + p->first;
    uint32_t fill = m->fast ? 1 : m->fill, count;
    uint32_t bins = p->count < 16 * RGI_BINS || m->fast ? RGI_BINS / 2 : RGI_BINS;
    bool few = p->count <= FEW_LEAVES * fill;
    rgi_cut cut = {-1, 0, 0};
    float scales[3];
    bin_scales(&p->centres, bins, scales);
    if (!few && p->depth < MOST_DEPTH)
        m->mesh->kernels->find_split(items, p->count, &p->centres, scales, bins, fill, &cut);
    if (cut.axis >= 0)
        return m->mesh->kernels->part_items(items, m->spare + p->first, p->count, &p->centres, scales, &cut, left,
                                            right);
    count = !few ? p->count / 2 : m->fast ? part_in_half(items, p->count, &p->centres) : part_by_number(m, p);
    rgi_wrap_empty(left);
    rgi_wrap_empty(right);
    for (uint32_t i = 0; i < p->count; i++) grow_centres(i < count ? left : right, &items[i]);
    return count;
}

/* Subtrees that are made apart, by whoever is free. */
typedef struct later {
    rgi_making *making;
    uint32_t most; /* of more items none is put off */
    uint32_t count;
    part parts[PARTS];
    uint32_t branches[PARTS];
} later;

static void end_branch(const rgi_making *m, rgi_branch *branch) {
    const rgi_branch *left = m->branches + branch->children;
    branch->box = left[0].box;
    rgi_wrap_grow(&branch->box, &left[1].box);
    find_costs(m, branch);
}

static void make_branch(rgi_making *m, uint32_t number, const part *p, later *put_off) {
    rgi_branch *branch = m->branches + number;
    part left = {p->first, 0, p->depth + 1, {{0}}}, right = left;
    branch->first = p->first;
    branch->count = p->count;
    branch->children = 0;
    if (put_off && p->count <= put_off->most && put_off->count < PARTS) {
        put_off->parts[put_off->count] = *p;
        put_off->branches[put_off->count++] = number;
        return;
    }
    if (leaf_holds(m, p->first, p->count)) {
        rgi_wrap_empty(&branch->box);
        for (uint32_t i = 0; i < p->count; i++) rgi_wrap_grow(&branch->box, &m->items[p->first + i]);
        find_costs(m, branch);
        return;
    }
    left.count = part_items_of(m, p, &left.centres, &right.centres);
    right.first += left.count;
    right.count = p->count - left.count;
    branch->children = __atomic_fetch_add(&m->used, 2, __ATOMIC_RELAXED);
    make_branch(m, branch->children, &left, put_off);
    make_branch(m, branch->children + 1, &right, put_off);
    if (!put_off) end_branch(m, branch);
}

static void make_later(void *context, uint64_t i) {
    later *l = context;
    make_branch(l->making, l->branches[i], &l->parts[i], NULL);
}

/* The branches above those that were put off. */
static void end_branches(const later *l, uint32_t number) {
    rgi_branch *branch = l->making->branches + number;
    for (uint32_t i = 0; i < l->count; i++) {
        if (l->branches[i] == number) return;
    }
    if (!branch->children) return;
    end_branches(l, branch->children);
    end_branches(l, branch->children + 1);
    end_branch(l->making, branch);
}

rg_result rgi_items_make(rgi_making *m) {
    rg_result result =
        rgi_allocate(m->mesh->memory, m->mesh->triangle_count, sizeof *m->items, "building a mesh", &m->items);
    if (result) return result;
    m->item_count = m->mesh->triangle_count;
    m->mesh->kernels->wrap_items(m);
    return RG_OK;
}

rg_result rgi_branches_make(rgi_making *m) {
    part all = {0, m->item_count, 0, {{0}}};
    rg_result result = rgi_allocate(m->mesh->memory, 2 * (uint64_t)m->item_count, sizeof *m->branches,
                                    "building a mesh", &m->branches);
    if (!result)
        result = rgi_allocate(m->mesh->memory, m->item_count, sizeof *m->spare, "building a mesh", &m->spare);
    if (result) return result;
    rgi_wrap_empty(&all.centres);
    for (uint32_t i = 0; i < all.count; i++) grow_centres(&all.centres, &m->items[i]);
    m->used = 1;
    if (!m->pool || rgi_pool_workers(m->pool) == 1 || all.count < LEAST_SHARED) {
        make_branch(m, 0, &all, NULL);
        return RG_OK;
    }
    later *l;
    result = rgi_allocate(m->mesh->memory, 1, sizeof *l, "building a mesh", &l);
    if (result) return result;
    l->making = m;
    l->most = all.count / (PARTS / 4);
    l->count = 0;
    make_branch(m, 0, &all, l);
    rgi_pool_run(m->pool, l->count, make_later, l);
    end_branches(l, 0);
    rgi_release(m->mesh->memory, l, 1, sizeof *l);
    return RG_OK;
}
