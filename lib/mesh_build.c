/* SPDX-License-Identifier: MIT */
/*
 * The tree of a mesh: binary, split where the surface area heuristic over 16 bins is least. I. Wald, "On fast
 * Construction of SAH-based Bounding Volume Hierarchies" (RT 2007), section 3.
 */
#include "mesh.h"
#include "vec.h"

#include <string.h>

enum { BINS = 16, LEAF = 4, SAH_DEPTH = RGI_MESH_DEPTH - 36 };

/* A triangle while the tree is built. */
typedef struct item {
    double lo[3], hi[3];
    uint32_t primitive;
} item;

typedef struct bin {
    double lo[3], hi[3];
    uint32_t count;
} bin;

typedef struct split {
    int axis;  /* -1: none found */
    double at; /* between the centres */
    double cost;
} split;

/* A part of the items that is to become the subtree below `node`. */
typedef struct part {
    uint32_t node, first, count, depth;
} part;

/* Twice the middle, so that nothing is rounded but the sum. */
static double centre(const item *it, int axis) {
    return it->lo[axis] + it->hi[axis];
}

static double half_area(const double lo[3], const double hi[3]) {
    double d[3];
    rgi_sub(hi, lo, d);
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

static int bin_of(double value, double lo, double scale) {
    int b = (int)((value - lo) * scale);
    return b < 0 ? 0 : b >= BINS ? BINS - 1 : b;
}

/* The cheapest of the 15 planes between the bins of one axis: cost = sum over both sides of area * count. */
static void best_plane(const bin bins[BINS], int axis, double lo, double width, split *best) {
    double right_cost[BINS], box_lo[3], box_hi[3];
    uint32_t count = 0;
    rgi_empty_box(box_lo, box_hi);
    for (int b = BINS - 1; b > 0; b--) {
        rgi_grow(box_lo, box_hi, bins[b].lo, bins[b].hi);
        count += bins[b].count;
        right_cost[b] = count ? half_area(box_lo, box_hi) * count : INFINITY;
    }
    rgi_empty_box(box_lo, box_hi);
    count = 0;
    for (int b = 0; b < BINS - 1; b++) {
        rgi_grow(box_lo, box_hi, bins[b].lo, bins[b].hi);
        count += bins[b].count;
        double cost = count ? half_area(box_lo, box_hi) * count + right_cost[b + 1] : INFINITY;
        if (cost < best->cost) {
            best->cost = cost;
            best->axis = axis;
            best->at = lo + width * (b + 1) / BINS;
        }
    }
}

static split find_split(const item *items, uint32_t count) {
    double lo[3], hi[3];
    rgi_empty_box(lo, hi);
    for (uint32_t i = 0; i < count; i++) {
        for (int a = 0; a < 3; a++) {
            lo[a] = rgi_min(lo[a], centre(&items[i], a));
            hi[a] = rgi_max(hi[a], centre(&items[i], a));
        }
    }
    split best = {-1, 0, INFINITY};
    for (int a = 0; a < 3; a++) {
        double width = hi[a] - lo[a];
        double scale = BINS / width;
        if (!(width > 0) || !isfinite(scale)) continue;
        bin bins[BINS];
        for (int b = 0; b < BINS; b++) {
            rgi_empty_box(bins[b].lo, bins[b].hi);
            bins[b].count = 0;
        }
        for (uint32_t i = 0; i < count; i++) {
            bin *b = &bins[bin_of(centre(&items[i], a), lo[a], scale)];
            rgi_grow(b->lo, b->hi, items[i].lo, items[i].hi);
            b->count++;
        }
        best_plane(bins, a, lo[a], width, &best);
    }
    return best;
}

/* Brings the items left of the plane to the front; returns how many. */
static uint32_t partition(item *items, uint32_t count, const split *s) {
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (centre(&items[i], s->axis) >= s->at) continue;
        item swap = items[i];
        items[i] = items[left];
        items[left++] = swap;
    }
    return left;
}

/*
 * Boxes are padded by 2^-40 of the largest coordinate. The tests of boxes and triangles are rounded: with the ray's
 * origin at most 2^7 radii away (lib/object.c) to 2^-45 of that size; so a ray that meets a triangle meets its boxes.
 */
static void box_of_items(const item *items, uint32_t count, double pad, rgi_mesh_node *node) {
    rgi_empty_box(node->lo, node->hi);
    for (uint32_t i = 0; i < count; i++) rgi_grow(node->lo, node->hi, items[i].lo, items[i].hi);
    for (int a = 0; a < 3; a++) {
        node->lo[a] -= pad;
        node->hi[a] += pad;
    }
}

static void build_nodes(rgi_mesh *mesh, item *items, double pad) {
    part stack[RGI_MESH_DEPTH + 2];
    uint32_t top = 0;
    stack[top++] = (part){0, 0, mesh->triangle_count, 0};
    mesh->node_count = 1;
    while (top) {
        part p = stack[--top];
        rgi_mesh_node *node = &mesh->nodes[p.node];
        item *own = items + p.first;
        box_of_items(own, p.count, pad, node);
        if (p.count <= LEAF) {
            node->first = p.first;
            node->count = p.count;
            continue;
        }
        /* Halves by number where no plane parts them, or where the tree grows too deep: 2^36 of them would fit. */
        split s = {-1, 0, 0};
        if (p.depth < SAH_DEPTH) s = find_split(own, p.count);
        uint32_t left = s.axis >= 0 ? partition(own, p.count, &s) : 0;
        if (left == 0 || left == p.count) left = p.count / 2;
        node->count = 0;
        node->first = mesh->node_count;
        stack[top++] = (part){node->first + 1, p.first + left, p.count - left, p.depth + 1};
        stack[top++] = (part){node->first, p.first, left, p.depth + 1};
        mesh->node_count += 2;
    }
}

static void fill_items(const rgi_mesh *mesh, item *items) {
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        item *it = &items[i];
        it->primitive = i;
        rgi_empty_box(it->lo, it->hi);
        for (int c = 0; c < 3; c++) {
            const double *v = mesh->vertices[mesh->triangles[i][c]];
            rgi_grow(it->lo, it->hi, v, v);
        }
    }
}

rg_result rgi_mesh_build(rgi_mesh *mesh) {
    item *items = NULL;
    uint32_t(*ordered)[3] = NULL;
    uint64_t count = mesh->triangle_count;
    mesh->node_room = (uint32_t)(2 * count - 1);
    rg_result result = rgi_allocate(mesh->memory, count, sizeof *items, "building a mesh", &items);
    if (!result) result = rgi_allocate(mesh->memory, count, sizeof *ordered, "a mesh's triangles", &ordered);
    if (!result)
        result = rgi_allocate(mesh->memory, mesh->node_room, sizeof *mesh->nodes, "a mesh's tree", &mesh->nodes);
    if (!result)
        result = rgi_allocate(mesh->memory, count, sizeof *mesh->primitives, "a mesh's triangles", &mesh->primitives);
    if (result) {
        rgi_release(mesh->memory, ordered, count, sizeof *ordered);
    } else {
        fill_items(mesh, items);
        build_nodes(mesh, items, 0x1p-40 * rgi_max(rgi_max_magnitude(mesh->lo), rgi_max_magnitude(mesh->hi)));
        for (uint32_t i = 0; i < count; i++) {
            mesh->primitives[i] = items[i].primitive;
            memcpy(ordered[i], mesh->triangles[items[i].primitive], sizeof ordered[i]);
        }
        rgi_release(mesh->memory, mesh->triangles, count, sizeof *mesh->triangles);
        mesh->triangles = ordered;
    }
    rgi_release(mesh->memory, items, count, sizeof *items);
    return result;
}
