/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include "beam.h"
#include "error.h"
#include "lattice_cell.h"
#include "mesh_build.h"
#include "mesh_fit.h"
#include "triangle.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

/* Float vertices are the frame's as they are if the largest coordinate is in this range: no product over- or
 * underflows. */
#define EXACT_LEAST 0x1p-40
#define EXACT_MOST 0x1p40

/* Triangles that a leaf of a connected mesh holds, as a rule, if it has not too many vertices. */
enum { CONNECTED_FILL = 16 };

rg_result rgi_fail_index(uint64_t index, uint32_t triangle, int corner, uint32_t vertices) {
    return rgi_fail(RG_INVALID_VALUE, "index %" PRIu64 " of triangle %u (corner %d) is not below the %u vertices",
                    index, triangle, corner, vertices);
}

rg_result rgi_mesh_check(const rg_mesh_views *views, bool *exact) {
    double largest = 0;
    for (uint64_t i = 0; i < views->vertex_count; i++) {
        double v[3];
        rgi_load3(&views->vertices, i, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= RG_COORDINATE_MAX))
                return rgi_fail(RG_INVALID_VALUE, "vertex %" PRIu64 " has %c = %g, which is not finite or beyond %g",
                                i, "xyz"[a], v[a], RG_COORDINATE_MAX);
        }
        largest = rgi_max(largest, rgi_max_magnitude(v));
    }
    *exact = views->vertices.type == RG_F32 && largest >= EXACT_LEAST && largest <= EXACT_MOST;
    return RG_OK;
}

static rg_result copy_triangles(rgi_making *making, const rg_mesh_views *views) {
    rgi_mesh *mesh = making->mesh;
    rgi_empty_box(mesh->lo, mesh->hi);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint64_t corner[3] = {3ull * i, 3ull * i + 1, 3ull * i + 2};
        if (views->indices.x) rgi_load3_integer(&views->indices, i, corner);
        for (int c = 0; c < 3; c++) {
            double v[3];
            if (corner[c] >= mesh->vertex_count) return rgi_fail_index(corner[c], i, c, mesh->vertex_count);
            making->triangles[i][c] = (uint32_t)corner[c];
            /* The mesh's box is that of the triangles: vertices that none uses must not make it larger. */
            rgi_load3(&views->vertices, corner[c], v);
            rgi_grow(mesh->lo, mesh->hi, v, v);
        }
    }
    return RG_OK;
}

/*
 * Pads, in units of the frame, around boxes: a plane takes part in the test of a float ray with an error of 2^-22 of
 * itself; tests in double, with the ray's origin at most 2^7 radii away (lib/object.c), are rounded to 2^-45 of the
 * largest coordinate.
 */
void rgi_mesh_set_frame(rgi_mesh *mesh) {
    double half[3], most = 0, largest = rgi_max(rgi_max_magnitude(mesh->lo), rgi_max_magnitude(mesh->hi));
    for (int a = 0; a < 3; a++) {
        double middle = 0.5 * mesh->lo[a] + 0.5 * mesh->hi[a];
        half[a] = 0.5 * mesh->hi[a] - 0.5 * mesh->lo[a];
        mesh->origin[a] = mesh->vertices ? middle : 0;
        mesh->middle.centre[a] = middle - mesh->origin[a];
    }
    mesh->scale = 1;
    double widest = rgi_max_magnitude(half);
    if (mesh->vertices) mesh->scale = 1 / rgi_power_of_two_near(rgi_max(widest, 0x1p-500));
    mesh->middle.radius = sqrt(rgi_dot(half, half)) * (1 + 0x1p-40) + 0x1p-40 * largest;
    mesh->middle.extent = 0;
    for (int a = 0; a < 3; a++) {
        double end = (fabs(mesh->middle.centre[a]) + half[a]) * mesh->scale;
        mesh->middle.extent += end;
        most = rgi_max(most, end);
    }
    mesh->middle.spacing = INFINITY;
    mesh->rounding = (float)(0x1p-40 * largest * mesh->scale);
    mesh->pad = (float)(0x1p-20 * most) + mesh->rounding;
}

static rg_result copy_vertices(rgi_making *making, const rg_mesh_views *views) {
    rgi_mesh *mesh = making->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        double v[3];
        rgi_load3(&views->vertices, i, v);
        if (mesh->vertices) rgi_copy(v, mesh->vertices[i]);
        for (int a = 0; a < 3; a++) {
            /* Vertices that no triangle uses may lie anywhere. */
            double in_frame = (v[a] - mesh->origin[a]) * mesh->scale;
            making->at[i][a] = (float)rgi_min(rgi_max(in_frame, -0x1p60), 0x1p60);
        }
    }
    return RG_OK;
}

static rg_result make(rgi_making *making, const rg_mesh_views *views) {
    rgi_mesh *mesh = making->mesh;
    rgi_memory *memory = mesh->memory;
    bool exact;
    rg_result result = rgi_mesh_check(views, &exact);
    if (!result)
        result = rgi_allocate(memory, mesh->triangle_count, sizeof *making->triangles, "building a mesh",
                              &making->triangles);
    if (!result) result = copy_triangles(making, views);
    if (!result && !exact)
        result =
            rgi_allocate(memory, mesh->vertex_count, sizeof *mesh->vertices, "a mesh's vertices", &mesh->vertices);
    if (!result)
        result = rgi_allocate(memory, mesh->vertex_count, sizeof *making->at, "building a mesh", &making->at);
    if (!result)
        result = rgi_allocate(memory, mesh->triangle_count, sizeof *making->items, "building a mesh", &making->items);
    if (!result)
        result = rgi_allocate(memory, 2 * (uint64_t)mesh->triangle_count, sizeof *making->branches, "building a mesh",
                              &making->branches);
    if (result) return result;
    /* A connected mesh has half as many vertices as triangles, a soup three times as many. */
    mesh->soup = mesh->vertex_count > mesh->triangle_count;
    making->fill = mesh->soup ? RGI_SOUP_LEAF : CONNECTED_FILL;
    rgi_mesh_set_frame(mesh);
    copy_vertices(making, views);
    result = rgi_branches_make(making);
    if (!result) result = rgi_lines_make(making);
    if (!result && mesh->vertices) {
        mesh->corners = making->triangles;
        making->triangles = NULL;
    }
    return result;
}

static rg_result fill(rgi_mesh *mesh, const rg_mesh_views *views, const rgi_mesh_making *how) {
    rgi_making making;
    rgi_memory *memory = mesh->memory;
    rg_result result = RG_OK;
    memset(&making, 0, sizeof making);
    making.mesh = mesh;
    making.fast = how && how->fast;
    if (how && (how->workers > 1 || how->parallel_for))
        result = rgi_pool_create(memory, how->workers, how->parallel_for, how->parallel_for_user, &making.pool);
    if (!result) result = make(&making, views);
    rgi_pool_destroy(making.pool);
    rgi_release(memory, making.branches, 2 * (uint64_t)mesh->triangle_count, sizeof *making.branches);
    rgi_release(memory, making.items, mesh->triangle_count, sizeof *making.items);
    rgi_release(memory, making.at, mesh->vertex_count, sizeof *making.at);
    rgi_release(memory, making.triangles, mesh->triangle_count, sizeof *making.triangles);
    return result;
}

rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, const rgi_mesh_making *how,
                          rgi_mesh **out) {
    rgi_mesh *mesh;
    rg_result result = rgi_allocate(memory, 1, sizeof *mesh, "a mesh", &mesh);
    if (result) return result;
    memset(mesh, 0, sizeof *mesh);
    mesh->memory = memory;
    mesh->kernels = rgi_kernels_best();
    mesh->vertex_count = (uint32_t)views->vertex_count;
    mesh->triangle_count = (uint32_t)views->triangle_count;
    result = fill(mesh, views, how);
    if (!result) mesh->cost = rgi_mesh_fit(mesh);
    if (result) {
        rgi_mesh_destroy(mesh);
        return result;
    }
    *out = mesh;
    return RG_OK;
}

void rgi_mesh_destroy(rgi_mesh *mesh) {
    if (!mesh) return;
    rgi_memory *memory = mesh->memory;
    rgi_release(memory, mesh->corners, mesh->triangle_count, sizeof *mesh->corners);
    rgi_release(memory, mesh->lines, mesh->line_count, RGI_MESH_LINE);
    rgi_release(memory, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    rgi_release(memory, mesh, 1, sizeof *mesh);
}

uint64_t rgi_mesh_read_vertices(const rgi_mesh *mesh) {
    return mesh->vertices ? mesh->vertex_count : 3 * (uint64_t)mesh->triangle_count;
}

/* The corners of all triangles in the leaves below. */
static void read_leaves(const rgi_mesh *mesh, rgi_mesh_ref ref, double (*vertices)[3]) {
    const void *at = rgi_mesh_at(mesh, ref);
    if (ref & RGI_MESH_LEAF) {
        uint32_t count = mesh->soup ? RGI_SOUP_LEAF : ((const rgi_mesh_leaf *)at)->triangles;
        for (uint32_t t = 0; t < count; t++) {
            uint32_t number = rgi_mesh_primitive(mesh, at, t);
            if (number != RGI_NO_TRIANGLE) rgi_triangle_corners(mesh, at, t, &vertices[3 * (size_t)number]);
        }
        return;
    }
    const rgi_mesh_node *node = at;
    for (int o = 0; o < RGI_CHILDREN; o++) {
        if (node->lo[0][o] <= node->hi[0][o]) read_leaves(mesh, node->child[o], vertices);
    }
}

void rgi_mesh_read(const rgi_mesh *mesh, double (*vertices)[3], uint32_t (*triangles)[3]) {
    if (mesh->vertices) {
        memcpy(vertices, mesh->vertices, mesh->vertex_count * sizeof *vertices);
        memcpy(triangles, mesh->corners, mesh->triangle_count * sizeof *triangles);
        return;
    }
    /* Triangles without area are in no leaf. */
    memset(vertices, 0, 3 * (size_t)mesh->triangle_count * sizeof *vertices);
    read_leaves(mesh, mesh->root, vertices);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (uint32_t c = 0; c < 3; c++) triangles[i][c] = 3 * i + c;
    }
}
