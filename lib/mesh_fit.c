/* SPDX-License-Identifier: MIT */
#include "mesh_fit.h"

#include "beam.h"
#include "error.h"
#include "mesh_build.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

/* A tree that was fitted to new vertices is made anew when rays cost so much more in it than in the tree as built. */
#define WORN 1.5

/* ------------------------------------------------------------------------------------------------- the cost */

static bool is_there(const rgi_mesh_node *node, uint32_t child) {
    return node->lo[0][child] <= node->hi[0][child];
}

/* Half the areas of the boxes of all children below, added up. */
static double settle(const rgi_mesh *mesh, rgi_mesh_ref ref, float pad) {
    rgi_mesh_node *node = rgi_mesh_at(mesh, ref);
    double sum = 0;
    for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
        double width[3];
        if (!is_there(node, o)) continue;
        for (uint32_t a = 0; a < 3; a++) {
            node->lo[a][o] -= pad;
            node->hi[a][o] += pad;
            width[a] = (double)node->hi[a][o] - (double)node->lo[a][o];
        }
        sum += width[0] * width[1] + width[1] * width[2] + width[2] * width[0];
    }
    for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
        if (is_there(node, o) && !(node->child[o] & RGI_MESH_LEAF)) sum += settle(mesh, node->child[o], pad);
    }
    return sum;
}

/* Half the area of the box around all children of the root. */
static double area_of_root(const rgi_mesh *mesh) {
    const rgi_mesh_node *node = rgi_mesh_at(mesh, mesh->root);
    double width[3];
    for (int a = 0; a < 3; a++) {
        float lo = (float)INFINITY, hi = -(float)INFINITY;
        for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
            lo = node->lo[a][o] < lo ? node->lo[a][o] : lo;
            hi = node->hi[a][o] > hi ? node->hi[a][o] : hi;
        }
        width[a] = (double)hi - (double)lo;
    }
    return width[0] * width[1] + width[1] * width[2] + width[2] * width[0];
}

double rgi_mesh_settle(rgi_mesh *mesh, float pad) {
    if (mesh->root & RGI_MESH_LEAF) return 1;
    double sum = settle(mesh, mesh->root, pad), area = area_of_root(mesh);
    return area > 0 ? 1 + sum / area : 1;
}

/* ---------------------------------------------------------------------------------------- new vertices */

typedef struct box {
    float lo[3], hi[3];
} box;

/* A tree, taken over with other vertices. */
typedef struct refill {
    const rgi_mesh *old;
    rgi_mesh *mesh;
    const rg_input3 *given;    /* vertices */
    const rg_input3 *vertices; /* the same, where the mesh keeps them if it does */
    rgi_reaches *reaches;      /* of the leaves so far */
} refill;

/* A vertex in the frame. */
static inline void load_vertex(const refill *r, uint32_t vertex, float *to, uint32_t apart) {
    const rgi_mesh *mesh = r->mesh;
    double v[3];
    rgi_load3(r->vertices, vertex, v);
    for (uint32_t a = 0; a < 3; a++)
        to[a * apart] = (float)(mesh->exact ? v[a] : (v[a] - mesh->origin[a]) * mesh->scale);
}

static void refill_leaf(const refill *r, const rgi_mesh_leaf *old, rgi_mesh_leaf *leaf) {
    const uint32_t *numbers = r->mesh->numbers[old->number];
    *leaf = *old;
    for (uint32_t k = 0; k < leaf->vertices; k++) load_vertex(r, numbers[k], &leaf->at[0][k], RGI_LEAF);
    for (int a = 0; a < 3; a++) {
        for (uint32_t k = leaf->vertices; k < RGI_LEAF; k++) leaf->at[a][k] = leaf->at[a][0];
    }
}

static void refill_soup(const refill *r, const rgi_soup_leaf *old, rgi_soup_leaf *leaf) {
    *leaf = *old;
    for (uint32_t t = 0; t < RGI_SOUP_LEAF && leaf->primitive[t] != RGI_NO_TRIANGLE; t++) {
        for (uint32_t c = 0; c < 3; c++)
            load_vertex(r, rgi_mesh_vertex(r->mesh, leaf, t, c), &leaf->at[c][0][t], RGI_SOUP_LEAF);
    }
}

/* Asks for the vertices of a leaf, so that they are there when it is filled: else each is waited for. */
static void fetch_vertices(const refill *r, rgi_mesh_ref ref) {
    const rgi_mesh *mesh = r->mesh;
    const void *leaf = rgi_mesh_at(r->old, ref);
    const uint32_t *numbers = mesh->soup ? NULL : mesh->numbers[((const rgi_mesh_leaf *)leaf)->number];
    for (uint32_t k = 0; k < (numbers ? RGI_LEAF : RGI_SOUP_LEAF); k++) {
        if (!numbers && rgi_mesh_primitive(mesh, leaf, k) == RGI_NO_TRIANGLE) return;
        uint32_t vertex = numbers ? numbers[k] : rgi_mesh_vertex(mesh, leaf, k, 0);
        __builtin_prefetch(rgi_record(r->vertices->x, r->vertices->stride, vertex));
    }
}

static void refill_below(const refill *r, rgi_mesh_ref ref, box *out);

/* Boxes are without a pad at first. */
static void refill_node(const refill *r, const rgi_mesh_node *old, rgi_mesh_node *node, box *out) {
    const float most = (float)INFINITY;
    *node = *old;
    *out = (box){{most, most, most}, {-most, -most, -most}};
    for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
        if (is_there(node, o) && node->child[o] & RGI_MESH_LEAF) fetch_vertices(r, node->child[o]);
    }
    for (uint32_t o = 0; o < RGI_CHILDREN; o++) {
        box child;
        if (!is_there(node, o)) continue;
        refill_below(r, node->child[o], &child);
        for (uint32_t a = 0; a < 3; a++) {
            node->lo[a][o] = child.lo[a];
            node->hi[a][o] = child.hi[a];
            out->lo[a] = child.lo[a] < out->lo[a] ? child.lo[a] : out->lo[a];
            out->hi[a] = child.hi[a] > out->hi[a] ? child.hi[a] : out->hi[a];
        }
    }
}

static void refill_below(const refill *r, rgi_mesh_ref ref, box *out) {
    const void *old = rgi_mesh_at(r->old, ref);
    void *at = rgi_mesh_at(r->mesh, ref);
    if (!(ref & RGI_MESH_LEAF)) {
        refill_node(r, old, at, out);
        return;
    }
    if (r->mesh->soup)
        refill_soup(r, old, at);
    else
        refill_leaf(r, old, at);
    r->mesh->kernels->measure_leaf(r->mesh, at, r->reaches, out->lo, out->hi);
}

static inline void grow_by(const rg_input3 *vertices, uint32_t vertex, double lo[3], double hi[3]) {
    double v[3];
    rgi_load3(vertices, vertex, v);
    rgi_grow(lo, hi, v, v);
}

/* The vertices that are kept in double, the box of those that triangles use, and the frame around it. */
static void refill_vertices(const refill *r) {
    rgi_mesh *mesh = r->mesh;
    const rg_input3 given = *r->given, vertices = *r->vertices;
    double lo[3], hi[3];
    for (uint32_t i = 0; i < mesh->vertex_count && mesh->kept_vertices; i++)
        rgi_load3(&given, i, mesh->kept_vertices[i]);
    rgi_empty_box(lo, hi);
    for (uint32_t l = 0; l < mesh->leaf_count; l++) {
        for (uint32_t k = 0; k < RGI_LEAF; k++) grow_by(&vertices, mesh->numbers[l][k], lo, hi);
    }
    for (uint32_t t = 0; t < mesh->triangle_count && mesh->soup; t++) {
        for (uint32_t c = 0; c < 3; c++) grow_by(&vertices, rgi_mesh_corner(mesh, t, c), lo, hi);
    }
    rgi_copy(lo, mesh->lo);
    rgi_copy(hi, mesh->hi);
    rgi_mesh_set_frame(mesh);
}

/* False if the frame is not the one that a mesh made of these vertices would have: how far a mesh reaches, and so
 * each bit of what rays hit, must not depend on which form it had before. */
static bool refill_mesh(const refill *r, bool floats) {
    rgi_mesh *mesh = r->mesh;
    box all;
    if (!mesh->exact) {
        refill_vertices(r);
        if (floats && rgi_mesh_fits_floats(mesh)) return false;
    }
    refill_below(r, mesh->root, &all);
    for (int a = 0; a < 3 && mesh->exact; a++) {
        mesh->lo[a] = (double)all.lo[a];
        mesh->hi[a] = (double)all.hi[a];
    }
    if (mesh->exact) {
        rgi_mesh_set_frame(mesh);
        if (!rgi_mesh_fits_floats(mesh)) return false;
    }
    rgi_mesh_set_support(mesh, r->reaches);
    return true;
}

static rg_result copy_numbers(const rgi_mesh *old, rgi_mesh *mesh) {
    if (!old->numbers) return RG_OK;
    rg_result result =
        rgi_allocate(mesh->memory, mesh->leaf_count, sizeof *mesh->numbers, "a mesh's leaves", &mesh->numbers);
    if (!result) memcpy(mesh->numbers, old->numbers, mesh->leaf_count * sizeof *mesh->numbers);
    return result;
}

/* Also what the old mesh borrows, for which its host answers to the old mesh alone. */
static rg_result copy_corners(const rgi_mesh *old, rgi_mesh *mesh) {
    if (!old->corners && !old->lent_corners.x) return RG_OK;
    rg_result result =
        rgi_allocate(mesh->memory, mesh->triangle_count, sizeof *mesh->corners, "a mesh's triangles", &mesh->corners);
    for (uint32_t t = 0; t < mesh->triangle_count && !result; t++) {
        for (uint32_t c = 0; c < 3; c++) mesh->corners[t][c] = rgi_mesh_corner(old, t, c);
    }
    return result;
}

/* A copy with room for the tree and the vertices, which are not there yet. */
static rg_result copy_mesh(rgi_memory *memory, const rgi_mesh *old, const rg_mesh_views *views, rgi_mesh **out) {
    rgi_mesh *mesh;
    rg_result result = rgi_allocate(memory, 1, sizeof *mesh, "a mesh", &mesh);
    if (result) return result;
    *mesh = *old;
    mesh->memory = memory;
    mesh->lines = NULL;
    mesh->numbers = NULL;
    mesh->kept_vertices = NULL;
    mesh->corners = NULL;
    memset(&mesh->lent_corners, 0, sizeof mesh->lent_corners);
    *out = mesh;
    result = rgi_allocate(memory, mesh->line_count, RGI_MESH_LINE, "a mesh's tree", &mesh->lines);
    if (!result && !mesh->exact) result = rgi_vertices_keep(mesh, views);
    if (!result) result = copy_numbers(old, mesh);
    if (!result) result = copy_corners(old, mesh);
    return result;
}

rg_result rgi_mesh_deform(rgi_memory *memory, const rgi_mesh *old, const rgi_mesh_making *how,
                          const rg_mesh_views *views, rgi_mesh **out) {
    rgi_mesh *mesh = NULL;
    bool floats;
    if (views->vertex_count != old->vertex_count)
        return rgi_fail(RG_INVALID_VALUE, "%" PRIu64 " vertices can't take the place of %u", views->vertex_count,
                        old->vertex_count);
    rg_result result = rgi_mesh_check(views, &floats);
    if (result) return result;
    if (!floats && old->exact) return rgi_mesh_create(memory, views, how, old, out);
    result = copy_mesh(memory, old, views, &mesh);
    if (!result) {
        rgi_reaches reaches;
        rgi_reaches_empty(&reaches);
        const refill r = {old, mesh, &views->vertices, mesh->exact ? &views->vertices : &mesh->vertices, &reaches};
        if (refill_mesh(&r, floats) && rgi_mesh_settle(mesh, mesh->pad) <= WORN * mesh->cost) {
            *out = mesh;
            return RG_OK;
        }
    }
    rgi_mesh_destroy(mesh);
    return result ? result : rgi_mesh_create(memory, views, how, old, out);
}
