/* SPDX-License-Identifier: MIT */
/* The nodes and leaves of a mesh, out of its binary tree. */
#include "mesh_build.h"

#include "beam.h"
#include "error.h"
#include "vec.h"

#include <string.h>

enum {
    NODE_LINES = sizeof(rgi_mesh_node) / RGI_MESH_LINE,
    LEAF_LINES = sizeof(rgi_mesh_leaf) / RGI_MESH_LINE, /* of soups, too */
    MOST_LINES = 0x7FFFFFFF
};

/* Where the next node and leaf go. */
typedef struct writer {
    const rgi_making *making;
    uint64_t lines;
    uint32_t leaves;
    rgi_reaches reaches; /* of the leaves so far */
} writer;

typedef struct child {
    const rgi_branch *branch;
    rgi_mesh_ref ref;
    uint32_t levels; /* see rgi_mesh */
    float lo[3], hi[3];
} child;

static bool is_leaf(const rgi_making *m, const rgi_branch *b) {
    return m->fast ? b->children == 0 : b->opened == 0;
}

/* The subtrees that hang in `places` places. */
static uint32_t gather(const rgi_making *m, const rgi_branch *b, int places, const rgi_branch **out) {
    while (places > 1 && b->places[places - 1] == 0) places--;
    if (places == 1) {
        *out = b;
        return 1;
    }
    int of_left = b->places[places - 1];
    const rgi_branch *left = m->branches + b->children;
    uint32_t count = gather(m, left, of_left, out);
    return count + gather(m, left + 1, places - of_left, out + count);
}

/* In a hurry: the largest is opened as long as there is room. */
static uint32_t gather_largest(const rgi_making *m, const rgi_branch *b, const rgi_branch *out[RGI_CHILDREN]) {
    float areas[RGI_CHILDREN];
    uint32_t count = 0, next = 0;
    do {
        const rgi_branch *left = m->branches + (count ? out[next] : b)->children;
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t at = k ? count : next;
            out[at] = left + k;
            areas[at] = left[k].children ? rgi_wrap_half_area(&left[k].box) : -1;
            if (k || !count) count++;
        }
        for (uint32_t i = 0; i < count; i++) next = areas[i] > areas[next] ? i : next;
    } while (count < RGI_CHILDREN && areas[next] >= 0);
    return count;
}

static uint32_t gather_children(const rgi_making *m, const rgi_branch *b, const rgi_branch *out[RGI_CHILDREN]) {
    if (m->fast) return gather_largest(m, b, out);
    const rgi_branch *left = m->branches + b->children;
    uint32_t count = gather(m, left, b->opened, out);
    return count + gather(m, left + 1, RGI_CHILDREN - b->opened, out + count);
}

static void count_lines(writer *w, const rgi_branch *b) {
    const rgi_branch *children[RGI_CHILDREN];
    if (is_leaf(w->making, b)) {
        w->lines += LEAF_LINES;
        w->leaves++;
        return;
    }
    uint32_t count = gather_children(w->making, b, children);
    w->lines += NODE_LINES;
    for (uint32_t i = 0; i < count; i++) count_lines(w, children[i]);
}

/* ------------------------------------------------------------------------------------------------- leaves */

/* Known vertices are found by a table with open addressing, an eighth of which is used at the most. */
uint32_t rgi_corners_number(const rgi_making *m, const rgi_item *items, uint32_t count, uint32_t numbers[RGI_LEAF],
                            uint8_t corner[3][RGI_LEAF]) {
    enum { PLACES = 8 * RGI_LEAF };
    uint8_t lanes[PLACES] = {0}; /* and one */
    uint32_t vertices = 0;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *corners = m->triangles[rgi_item_number(&items[t])];
        for (int c = 0; c < 3; c++) {
            uint32_t at = corners[c] * UINT32_C(0x9E3779B9) >> 25;
            while (lanes[at] && numbers[lanes[at] - 1] != corners[c]) at = (at + 1) % PLACES;
            if (!lanes[at]) {
                if (vertices == RGI_LEAF) return RGI_LEAF + 1;
                numbers[vertices] = corners[c];
                lanes[at] = (uint8_t)++vertices;
            }
            corner[c][t] = (uint8_t)(lanes[at] - 1);
        }
    }
    return vertices;
}

static const rgi_run *run_of(const rgi_making *m, const rgi_branch *b) {
    return &m->runs[rgi_item_number(&m->items[b->first])];
}

static void list_triangles(const rgi_making *m, const rgi_branch *b, rgi_mesh_leaf *leaf, uint32_t *numbers) {
    const rgi_item *items = m->items + b->first;
    leaf->triangles = (uint16_t)b->count;
    for (uint32_t t = 0; t < b->count; t++) leaf->primitive[t] = rgi_item_number(&items[t]);
    leaf->vertices = (uint16_t)rgi_corners_number(m, items, b->count, numbers, leaf->corner);
    for (uint32_t k = leaf->vertices; k < RGI_LEAF; k++) numbers[k] = numbers[0];
}

static void take_run(const rgi_making *m, const rgi_run *run, rgi_mesh_leaf *leaf, uint32_t *numbers) {
    leaf->triangles = (uint16_t)run->count;
    leaf->vertices = (uint16_t)run->vertices;
    memcpy(leaf->primitive, m->order + run->first, run->count * sizeof *m->order);
    memcpy(leaf->corner, run->corner, sizeof leaf->corner);
    memcpy(numbers, run->numbers, sizeof run->numbers);
}

static void write_leaf(const rgi_making *m, const rgi_branch *b, rgi_mesh_leaf *leaf, uint32_t number) {
    uint32_t *numbers = m->mesh->numbers[number];
    memset(leaf, 0, sizeof *leaf);
    leaf->number = number;
    if (m->runs)
        take_run(m, run_of(m, b), leaf, numbers);
    else
        list_triangles(m, b, leaf, numbers);
    for (int k = 0; k < RGI_LEAF; k++) {
        const float *at = m->at[numbers[k]];
        for (int a = 0; a < 3; a++) leaf->at[a][k] = at[a];
    }
}

/* Lanes that hold no triangle are NaN, which no comparison lets pass. */
static void write_soup_leaf(const rgi_making *m, const rgi_branch *b, rgi_soup_leaf *leaf) {
    const float none[3] = {(float)NAN, (float)NAN, (float)NAN};
    const rgi_run *run = m->runs ? run_of(m, b) : NULL;
    for (uint32_t t = 0; t < RGI_SOUP_LEAF; t++) {
        bool used = t < (run ? run->count : b->count);
        leaf->primitive[t] = !used ? RGI_NO_TRIANGLE
                             : run ? m->order[run->first + t]
                                   : rgi_item_number(&m->items[b->first + t]);
        for (uint32_t c = 0; c < 3; c++) {
            const float *at = used ? rgi_corner(m, leaf->primitive[t], c) : none;
            for (int a = 0; a < 3; a++) leaf->at[c][a][t] = at[a];
        }
    }
}

/* ------------------------------------------------------------------------------------------------- nodes */

/*
 * Puts each child where the octant is that it lies in as seen from the middle of all, as far as they are free: the
 * farthest out first. So rays can go through them in the order of octants.
 */
static void take_octants(const child children[RGI_CHILDREN], uint32_t count, uint32_t octants[RGI_CHILDREN]) {
    float way[RGI_CHILDREN][3], far[RGI_CHILDREN], lo[3], hi[3];
    uint32_t order[RGI_CHILDREN], taken = 0;
    memcpy(lo, children[0].lo, sizeof lo);
    memcpy(hi, children[0].hi, sizeof hi);
    for (uint32_t i = 1; i < count; i++) {
        for (int a = 0; a < 3; a++) {
            lo[a] = children[i].lo[a] < lo[a] ? children[i].lo[a] : lo[a];
            hi[a] = children[i].hi[a] > hi[a] ? children[i].hi[a] : hi[a];
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        for (int a = 0; a < 3; a++) way[i][a] = (children[i].lo[a] - lo[a]) - (hi[a] - children[i].hi[a]);
        far[i] = fabsf(way[i][0]) + fabsf(way[i][1]) + fabsf(way[i][2]);
        for (; at > 0 && far[order[at - 1]] < far[i]; at--) order[at] = order[at - 1];
        order[at] = i;
    }
    for (uint32_t n = 0; n < count; n++) {
        const float *w = way[order[n]];
        uint32_t octant = 0;
        float most = -(float)INFINITY;
        for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
            float score = (o & 1 ? w[0] : -w[0]) + (o & 2 ? w[1] : -w[1]) + (o & 4 ? w[2] : -w[2]);
            if (taken >> o & 1 || !(score > most)) continue;
            most = score;
            octant = o;
        }
        octants[order[n]] = octant;
        taken |= 1u << octant;
    }
}

static void write_node(rgi_mesh_node *node, const child children[RGI_CHILDREN], uint32_t count) {
    uint32_t octants[RGI_CHILDREN];
    memset(node, 0, sizeof *node);
    for (int a = 0; a < 3; a++) {
        for (int o = 0; o < RGI_CHILDREN; o++) {
            node->lo[a][o] = (float)INFINITY;
            node->hi[a][o] = -(float)INFINITY;
        }
    }
    take_octants(children, count, octants);
    for (uint32_t i = 0; i < count; i++) {
        node->child[octants[i]] = children[i].ref;
        for (int a = 0; a < 3; a++) {
            node->lo[a][octants[i]] = children[i].lo[a];
            node->hi[a][octants[i]] = children[i].hi[a];
        }
    }
}

static void write_lines(writer *w, const rgi_branch *b, child *out);

/* Children in the order of the octants come one after the other, leaves at once behind their node. */
static void write_children(writer *w, const rgi_branch *b, child children[RGI_CHILDREN], uint32_t *count) {
    const rgi_branch *branches[RGI_CHILDREN];
    *count = gather_children(w->making, b, branches);
    for (uint32_t i = 0; i < *count && w->making->runs; i++) {
        if (is_leaf(w->making, branches[i])) rgi_run_fetch(w->making, run_of(w->making, branches[i]));
    }
    for (int leaves = 1; leaves >= 0; leaves--) {
        for (uint32_t i = 0; i < *count; i++) {
            if (is_leaf(w->making, branches[i]) == (leaves == 1)) write_lines(w, branches[i], &children[i]);
        }
    }
}

static void write_lines(writer *w, const rgi_branch *b, child *out) {
    const rgi_mesh *mesh = w->making->mesh;
    out->branch = b;
    out->ref = (rgi_mesh_ref)w->lines;
    out->levels = 1;
    if (is_leaf(w->making, b)) {
        out->ref |= RGI_MESH_LEAF;
        void *leaf = rgi_mesh_at(mesh, out->ref);
        w->lines += LEAF_LINES;
        if (mesh->soup)
            write_soup_leaf(w->making, b, leaf);
        else
            write_leaf(w->making, b, leaf, w->leaves++);
        mesh->kernels->measure_leaf(mesh, leaf, &w->reaches, out->lo, out->hi);
        for (int a = 0; a < 3; a++) {
            out->lo[a] -= mesh->pad;
            out->hi[a] += mesh->pad;
        }
        return;
    }
    child children[RGI_CHILDREN];
    uint32_t count;
    w->lines += NODE_LINES;
    write_children(w, b, children, &count);
    write_node(rgi_mesh_at(mesh, out->ref), children, count);
    memcpy(out->lo, children[0].lo, sizeof out->lo);
    memcpy(out->hi, children[0].hi, sizeof out->hi);
    for (uint32_t i = 0; i < count; i++) {
        out->levels = children[i].levels >= out->levels ? children[i].levels + 1 : out->levels;
        for (int a = 0; a < 3; a++) {
            out->lo[a] = children[i].lo[a] < out->lo[a] ? children[i].lo[a] : out->lo[a];
            out->hi[a] = children[i].hi[a] > out->hi[a] ? children[i].hi[a] : out->hi[a];
        }
    }
}

rg_result rgi_lines_make(const rgi_making *making) {
    rgi_mesh *mesh = making->mesh;
    writer w = {.making = making};
    child root;
    count_lines(&w, making->branches);
    if (w.lines > MOST_LINES)
        return rgi_fail(RG_LIMIT_EXCEEDED, "the mesh is too large: %u triangles", mesh->triangle_count);
    mesh->line_count = (uint32_t)w.lines;
    rg_result result = rgi_allocate(mesh->memory, mesh->line_count, RGI_MESH_LINE, "a mesh's tree", &mesh->lines);
    if (!result && !mesh->soup) {
        mesh->leaf_count = w.leaves;
        result =
            rgi_allocate(mesh->memory, mesh->leaf_count, sizeof *mesh->numbers, "a mesh's leaves", &mesh->numbers);
    }
    if (result) return result;
    w.lines = w.leaves = 0;
    rgi_reaches_empty(&w.reaches);
    write_lines(&w, making->branches, &root);
    mesh->root = root.ref;
    mesh->levels = root.levels;
    rgi_mesh_set_support(mesh, &w.reaches);
    return RG_OK;
}
