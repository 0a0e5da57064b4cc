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
} writer;

typedef struct child {
    const rgi_branch *branch;
    rgi_mesh_ref ref;
    float lo[3], hi[3];
} child;

static bool is_leaf(const rgi_branch *b) {
    return b->opened == 0;
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

static uint32_t gather_children(const rgi_making *m, const rgi_branch *b, const rgi_branch *out[RGI_CHILDREN]) {
    const rgi_branch *left = m->branches + b->children;
    uint32_t count = gather(m, left, b->opened, out);
    return count + gather(m, left + 1, RGI_CHILDREN - b->opened, out + count);
}

static void count_lines(writer *w, const rgi_branch *b) {
    const rgi_branch *children[RGI_CHILDREN];
    if (is_leaf(b)) {
        w->lines += LEAF_LINES;
        w->leaves++;
        return;
    }
    uint32_t count = gather_children(w->making, b, children);
    w->lines += NODE_LINES;
    for (uint32_t i = 0; i < count; i++) count_lines(w, children[i]);
}

/* ------------------------------------------------------------------------------------------------- leaves */

static uint8_t lane_of(rgi_mesh_leaf *leaf, uint32_t numbers[RGI_LEAF], uint32_t vertex) {
    for (uint8_t k = 0; k < leaf->vertices; k++) {
        if (numbers[k] == vertex) return k;
    }
    numbers[leaf->vertices] = vertex;
    return (uint8_t)leaf->vertices++;
}

/* The number of the triangle of an item. */
static uint32_t number_of(const rgi_item *item) {
    uint32_t number;
    memcpy(&number, &item->least[3], sizeof number);
    return number;
}

static void write_leaf(const rgi_making *m, const rgi_branch *b, rgi_mesh_leaf *leaf, uint32_t number) {
    uint32_t *numbers = m->mesh->numbers[number];
    memset(leaf, 0, sizeof *leaf);
    leaf->number = number;
    leaf->triangles = (uint16_t)b->count;
    for (uint32_t t = 0; t < b->count; t++) {
        leaf->primitive[t] = number_of(&m->items[b->first + t]);
        const uint32_t *corners = m->triangles[leaf->primitive[t]];
        for (int c = 0; c < 3; c++) leaf->corner[c][t] = lane_of(leaf, numbers, corners[c]);
    }
    for (uint32_t k = leaf->vertices; k < RGI_LEAF; k++) numbers[k] = numbers[0];
    for (int a = 0; a < 3; a++) {
        for (int k = 0; k < RGI_LEAF; k++) leaf->at[a][k] = m->at[numbers[k]][a];
    }
}

/* Lanes that hold no triangle are NaN, which no comparison lets pass. */
static void write_soup_leaf(const rgi_making *m, const rgi_branch *b, rgi_soup_leaf *leaf) {
    for (uint32_t t = 0; t < RGI_SOUP_LEAF; t++) {
        bool used = t < b->count;
        leaf->primitive[t] = used ? number_of(&m->items[b->first + t]) : RGI_NO_TRIANGLE;
        for (int c = 0; c < 3; c++) {
            for (int a = 0; a < 3; a++)
                leaf->at[c][a][t] = used ? m->at[m->triangles[leaf->primitive[t]][c]][a] : (float)NAN;
        }
    }
}

/* ------------------------------------------------------------------------------------------------- nodes */

/*
 * Puts each child where the octant is that it lies in as seen from the middle of all, as far as they are free: the
 * farthest out first. So rays can go through them in the order of octants.
 */
static void take_octants(const child children[RGI_CHILDREN], uint32_t count, uint32_t octants[RGI_CHILDREN]) {
    float way[RGI_CHILDREN][3], lo[3], hi[3];
    uint32_t placed = 0, taken = 0;
    memcpy(lo, children[0].lo, sizeof lo);
    memcpy(hi, children[0].hi, sizeof hi);
    for (uint32_t i = 1; i < count; i++) {
        for (int a = 0; a < 3; a++) {
            lo[a] = children[i].lo[a] < lo[a] ? children[i].lo[a] : lo[a];
            hi[a] = children[i].hi[a] > hi[a] ? children[i].hi[a] : hi[a];
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int a = 0; a < 3; a++) way[i][a] = (children[i].lo[a] - lo[a]) - (hi[a] - children[i].hi[a]);
    }
    for (uint32_t n = 0; n < count; n++) {
        uint32_t child = 0, octant = 0;
        float most = -(float)INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
                if (placed >> i & 1 || taken >> o & 1) continue;
                float score = (o & 1 ? way[i][0] : -way[i][0]) + (o & 2 ? way[i][1] : -way[i][1]) +
                              (o & 4 ? way[i][2] : -way[i][2]);
                if (!(score > most)) continue;
                most = score;
                child = i;
                octant = o;
            }
        }
        octants[child] = octant;
        placed |= 1u << child;
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
    for (int leaves = 1; leaves >= 0; leaves--) {
        for (uint32_t i = 0; i < *count; i++) {
            if (is_leaf(branches[i]) == (leaves == 1)) write_lines(w, branches[i], &children[i]);
        }
    }
}

static void write_lines(writer *w, const rgi_branch *b, child *out) {
    const rgi_mesh *mesh = w->making->mesh;
    out->branch = b;
    out->ref = (rgi_mesh_ref)w->lines;
    if (is_leaf(b)) {
        out->ref |= RGI_MESH_LEAF;
        void *leaf = rgi_mesh_at(mesh, out->ref);
        w->lines += LEAF_LINES;
        if (mesh->soup)
            write_soup_leaf(w->making, b, leaf);
        else
            write_leaf(w->making, b, leaf, w->leaves++);
        mesh->kernels->measure_leaf(mesh, leaf, out->lo, out->hi);
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
    for (uint32_t i = 1; i < count; i++) {
        for (int a = 0; a < 3; a++) {
            out->lo[a] = children[i].lo[a] < out->lo[a] ? children[i].lo[a] : out->lo[a];
            out->hi[a] = children[i].hi[a] > out->hi[a] ? children[i].hi[a] : out->hi[a];
        }
    }
}

rg_result rgi_lines_make(const rgi_making *making) {
    rgi_mesh *mesh = making->mesh;
    writer w = {making, 0, 0};
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
    write_lines(&w, making->branches, &root);
    mesh->root = root.ref;
    return RG_OK;
}
