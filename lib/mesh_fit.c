/* SPDX-License-Identifier: MIT */
#include "mesh_fit.h"

#include "error.h"
#include "mesh_build.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

/* A tree that was fitted to new vertices is made anew when rays cost so much more in it than in the tree as built. */
#define WORN 1.5

/* ---------------------------------------------------------------------------------------------- the boxes */

typedef struct box {
    float lo[3], hi[3];
} box;

static void grow(box *b, const float *lo, const float *hi, uint32_t apart) {
    for (uint32_t a = 0; a < 3; a++) {
        b->lo[a] = lo[a * apart] < b->lo[a] ? lo[a * apart] : b->lo[a];
        b->hi[a] = hi[a * apart] > b->hi[a] ? hi[a * apart] : b->hi[a];
    }
}

static box empty(void) {
    const float most = (float)INFINITY;
    return (box){{most, most, most}, {-most, -most, -most}};
}

static double half_area(const box *b) {
    double x = (double)b->hi[0] - (double)b->lo[0], y = (double)b->hi[1] - (double)b->lo[1];
    double z = (double)b->hi[2] - (double)b->lo[2];
    return x * y + y * z + z * x;
}

/* Of all vertices of a leaf, without a pad. What is not used repeats others, or is NaN and does not count. */
static box box_of_leaf(const rgi_mesh *mesh, const void *leaf) {
    box b = empty();
    const float *at = mesh->soup ? ((const rgi_soup_leaf *)leaf)->at[0][0] : ((const rgi_mesh_leaf *)leaf)->at[0];
    const uint32_t count = mesh->soup ? RGI_SOUP_LEAF : RGI_LEAF, times = mesh->soup ? 3 : 1;
    for (uint32_t n = 0; n < times; n++) {
        for (uint32_t k = 0; k < count; k++) grow(&b, at + (3 * n) * count + k, at + (3 * n) * count + k, count);
    }
    return b;
}

/* Adds what is looked into below. */
static box fit(const rgi_mesh *mesh, rgi_mesh_ref ref, double *cost) {
    if (ref & RGI_MESH_LEAF) {
        box b = box_of_leaf(mesh, rgi_mesh_at(mesh, ref));
        for (int a = 0; a < 3; a++) {
            b.lo[a] -= mesh->pad;
            b.hi[a] += mesh->pad;
        }
        *cost += half_area(&b);
        return b;
    }
    rgi_mesh_node *node = rgi_mesh_at(mesh, ref);
    box all = empty();
    for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
        if (node->lo[0][o] > node->hi[0][o]) continue; /* there is none */
        box child = fit(mesh, node->child[o], cost);
        for (int a = 0; a < 3; a++) {
            node->lo[a][o] = child.lo[a];
            node->hi[a][o] = child.hi[a];
        }
        grow(&all, child.lo, child.hi, 1);
    }
    *cost += half_area(&all);
    return all;
}

double rgi_mesh_fit(rgi_mesh *mesh) {
    double cost = 0;
    box all = fit(mesh, mesh->root, &cost);
    double area = half_area(&all);
    return area > 0 ? cost / area : 1;
}

/* ---------------------------------------------------------------------------------------- new vertices */

/* New numbers in the leaves of a mesh, and the box of all. */
typedef struct refill {
    rgi_mesh *mesh;
    const rg_mesh_views *views;
} refill;

static rg_result corners_of(const refill *r, uint32_t triangle, uint32_t corners[3]) {
    uint64_t given[3] = {3ull * triangle, 3ull * triangle + 1, 3ull * triangle + 2};
    if (r->views->indices.x) rgi_load3_integer(&r->views->indices, triangle, given);
    for (int c = 0; c < 3; c++) {
        if (given[c] >= r->mesh->vertex_count) return rgi_fail_index(given[c], triangle, c, r->mesh->vertex_count);
        corners[c] = (uint32_t)given[c];
    }
    return RG_OK;
}

/* A vertex, into the mesh's box and the frame. */
static void load_vertex(const refill *r, uint32_t vertex, float *to, uint32_t apart) {
    rgi_mesh *mesh = r->mesh;
    double v[3];
    rgi_load3(&r->views->vertices, vertex, v);
    if (!mesh->vertices) rgi_grow(mesh->lo, mesh->hi, v, v);
    for (uint32_t a = 0; a < 3; a++) to[a * apart] = (float)((v[a] - mesh->origin[a]) * mesh->scale);
}

static rg_result refill_leaf(const refill *r, rgi_mesh_leaf *leaf) {
    uint32_t numbers[RGI_LEAF];
    memset(numbers, 0xFF, sizeof numbers); /* no vertex has that number */
    for (uint32_t t = 0; t < leaf->triangles; t++) {
        uint32_t corners[3];
        rg_result result = corners_of(r, leaf->primitive[t], corners);
        if (result) return result;
        for (int c = 0; c < 3; c++) {
            uint32_t vertex = corners[c], lane = leaf->corner[c][t];
            if (numbers[lane] == vertex) continue;
            if (numbers[lane] != UINT32_MAX)
                return rgi_fail(RG_INVALID_VALUE, "triangle %u does not have the corners that it was made with",
                                leaf->primitive[t]);
            numbers[lane] = vertex;
            load_vertex(r, vertex, &leaf->at[0][lane], RGI_LEAF);
        }
    }
    for (int a = 0; a < 3; a++) {
        for (uint32_t k = leaf->vertices; k < RGI_LEAF; k++) leaf->at[a][k] = leaf->at[a][0];
    }
    leaf->longest = rgi_leaf_longest(leaf);
    return RG_OK;
}

static rg_result refill_soup(const refill *r, rgi_soup_leaf *leaf) {
    for (uint32_t t = 0; t < RGI_SOUP_LEAF && leaf->primitive[t] != RGI_NO_TRIANGLE; t++) {
        uint32_t corners[3];
        rg_result result = corners_of(r, leaf->primitive[t], corners);
        if (result) return result;
        for (int c = 0; c < 3; c++) load_vertex(r, corners[c], &leaf->at[c][0][t], RGI_SOUP_LEAF);
    }
    return RG_OK;
}

static rg_result refill_below(const refill *r, rgi_mesh_ref ref) {
    void *at = rgi_mesh_at(r->mesh, ref);
    rg_result result = RG_OK;
    if (ref & RGI_MESH_LEAF) return r->mesh->soup ? refill_soup(r, at) : refill_leaf(r, at);
    const rgi_mesh_node *node = at;
    for (uint32_t o = 0; o < RGI_CHILDREN && !result; o++) {
        if (node->lo[0][o] <= node->hi[0][o]) result = refill_below(r, node->child[o]);
    }
    return result;
}

/* The vertices that are kept in double, and the frame around them. */
static rg_result refill_vertices(const refill *r) {
    rgi_mesh *mesh = r->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) rgi_load3(&r->views->vertices, i, mesh->vertices[i]);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        rg_result result = corners_of(r, t, mesh->corners[t]);
        if (result) return result;
        for (int c = 0; c < 3; c++) {
            const double *v = mesh->vertices[mesh->corners[t][c]];
            rgi_grow(mesh->lo, mesh->hi, v, v);
        }
    }
    rgi_mesh_set_frame(mesh);
    return RG_OK;
}

/* A copy without what is in the leaves' coordinates, and without triangles and vertices. */
static rg_result copy_tree(rgi_memory *memory, const rgi_mesh *old, rgi_mesh **out) {
    rgi_mesh *mesh;
    rg_result result = rgi_allocate(memory, 1, sizeof *mesh, "a mesh", &mesh);
    if (result) return result;
    *mesh = *old;
    mesh->memory = memory;
    mesh->lines = NULL;
    mesh->vertices = NULL;
    mesh->corners = NULL;
    *out = mesh;
    result = rgi_allocate(memory, mesh->line_count, RGI_MESH_LINE, "a mesh's tree", &mesh->lines);
    if (!result && old->vertices)
        result =
            rgi_allocate(memory, mesh->vertex_count, sizeof *mesh->vertices, "a mesh's vertices", &mesh->vertices);
    if (!result && old->vertices)
        result =
            rgi_allocate(memory, mesh->triangle_count, sizeof *mesh->corners, "a mesh's triangles", &mesh->corners);
    if (!result) memcpy(mesh->lines, old->lines, (size_t)mesh->line_count * RGI_MESH_LINE);
    return result;
}

rg_result rgi_mesh_deform(rgi_memory *memory, const rgi_mesh *old, const rgi_mesh_making *how,
                          const rg_mesh_views *views, rgi_mesh **out) {
    rgi_mesh *mesh = NULL;
    bool exact;
    if (views->triangle_count != old->triangle_count || views->vertex_count != old->vertex_count)
        return rgi_fail(RG_INVALID_VALUE,
                        "%" PRIu64 " triangles of %" PRIu64 " vertices can't take the place of %u of %u",
                        views->triangle_count, views->vertex_count, old->triangle_count, old->vertex_count);
    rg_result result = rgi_mesh_check(views, &exact);
    if (result) return result;
    if (exact != !old->vertices) return rgi_mesh_create(memory, views, how, out);
    result = copy_tree(memory, old, &mesh);
    if (!result) {
        const refill r = {mesh, views};
        rgi_empty_box(mesh->lo, mesh->hi);
        if (!exact) result = refill_vertices(&r);
        if (!result) result = refill_below(&r, mesh->root);
        if (!result && exact) rgi_mesh_set_frame(mesh);
    }
    bool worn = !result && rgi_mesh_fit(mesh) > WORN * mesh->cost;
    if (!result && !worn) {
        *out = mesh;
        return RG_OK;
    }
    rgi_mesh_destroy(mesh);
    return worn ? rgi_mesh_create(memory, views, how, out) : result;
}
