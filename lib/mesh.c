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

#include <float.h>
#include <inttypes.h>
#include <string.h>

/* Vertices that are floats are the frame's as they are if the largest coordinate is in this range: no product over-
 * or underflows. */
#define EXACT_LEAST 0x1p-40
#define EXACT_MOST 0x1p40

/* Triangles that a leaf of a connected mesh holds, as a rule, if it has not too many vertices. */
enum { CONNECTED_FILL = 16 };

/* Whether a double is a float: whose mantissa ends in zeros, and which is no smaller than a float can be. By its bits,
 * because gcc 12 drops pairs of casts. */
static bool is_float(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x1FFFFFFF) == 0 && (x == 0 || fabs(x) >= FLT_MIN);
}

rg_result rgi_mesh_check(const rg_mesh_views *views, bool *floats) {
    *floats = true;
    for (uint64_t i = 0; i < views->vertex_count; i++) {
        double v[3];
        rgi_load3(&views->vertices, i, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= RG_COORDINATE_MAX))
                return rgi_fail(RG_INVALID_VALUE, "vertex %" PRIu64 " has %c = %g, which is not finite or beyond %g",
                                i, "xyz"[a], v[a], RG_COORDINATE_MAX);
            *floats &= views->vertices.type == RG_F32 || is_float(v[a]);
        }
    }
    return RG_OK;
}

bool rgi_mesh_fits_floats(const rgi_mesh *mesh) {
    double largest = rgi_max(rgi_max_magnitude(mesh->lo), rgi_max_magnitude(mesh->hi));
    return largest >= EXACT_LEAST && largest <= EXACT_MOST;
}

static rg_result read_indices(rgi_making *making, const rg_mesh_views *views) {
    const uint32_t vertices = making->mesh->vertex_count;
    making->in_order = true;
    for (uint32_t i = 0; i < making->mesh->triangle_count; i++) {
        uint64_t corner[3] = {3ull * i, 3ull * i + 1, 3ull * i + 2};
        if (views->indices.x) rgi_load3_integer(&views->indices, i, corner);
        for (uint32_t c = 0; c < 3; c++) {
            if (corner[c] >= vertices)
                return rgi_fail(RG_INVALID_VALUE,
                                "index %" PRIu64 " of triangle %u (corner %u) is not below the %u vertices",
                                corner[c], i, c, vertices);
            making->triangles[i][c] = (uint32_t)corner[c];
            making->in_order &= corner[c] == 3ull * i + c;
        }
    }
    return RG_OK;
}

/* The triangles' vertices, and the box of all. */
static rg_result copy_triangles(rgi_making *making, const rg_mesh_views *views, const rgi_mesh *like) {
    rgi_mesh *mesh = making->mesh;
    rg_result result = RG_OK;
    if (like) {
        rgi_mesh_read_triangles(like, making->triangles);
        making->in_order = like->soup && !like->corners;
    } else {
        result = read_indices(making, views);
    }
    rgi_empty_box(mesh->lo, mesh->hi);
    for (uint32_t i = 0; i < mesh->triangle_count && !result; i++) {
        for (int c = 0; c < 3; c++) {
            double v[3];
            /* The mesh's box is that of the triangles: vertices that none uses must not make it larger. */
            rgi_load3(&views->vertices, making->triangles[i][c], v);
            rgi_grow(mesh->lo, mesh->hi, v, v);
        }
    }
    return result;
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

static rg_result make(rgi_making *making, const rg_mesh_views *views, const rgi_mesh *like) {
    rgi_mesh *mesh = making->mesh;
    rgi_memory *memory = mesh->memory;
    bool floats;
    rg_result result = rgi_mesh_check(views, &floats);
    if (!result)
        result = rgi_allocate(memory, mesh->triangle_count, sizeof *making->triangles, "building a mesh",
                              &making->triangles);
    if (!result) result = copy_triangles(making, views, like);
    if (!result && !(floats && rgi_mesh_fits_floats(mesh)))
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
    if (!result && mesh->soup && !making->in_order) {
        mesh->corners = making->triangles;
        making->triangles = NULL;
    }
    return result;
}

static rg_result fill(rgi_mesh *mesh, const rg_mesh_views *views, const rgi_mesh_making *how, const rgi_mesh *like) {
    rgi_making making;
    rgi_memory *memory = mesh->memory;
    rg_result result = RG_OK;
    memset(&making, 0, sizeof making);
    making.mesh = mesh;
    making.fast = how && how->fast;
    if (how && (how->workers > 1 || how->parallel_for))
        result = rgi_pool_create(memory, how->workers, how->parallel_for, how->parallel_for_user, &making.pool);
    if (!result) result = make(&making, views, like);
    rgi_pool_destroy(making.pool);
    rgi_release(memory, making.branches, 2 * (uint64_t)mesh->triangle_count, sizeof *making.branches);
    rgi_release(memory, making.items, mesh->triangle_count, sizeof *making.items);
    rgi_release(memory, making.at, mesh->vertex_count, sizeof *making.at);
    rgi_release(memory, making.triangles, mesh->triangle_count, sizeof *making.triangles);
    return result;
}

rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, const rgi_mesh_making *how,
                          const rgi_mesh *like, rgi_mesh **out) {
    rgi_mesh *mesh;
    rg_result result = rgi_allocate(memory, 1, sizeof *mesh, "a mesh", &mesh);
    if (result) return result;
    memset(mesh, 0, sizeof *mesh);
    mesh->memory = memory;
    mesh->kernels = rgi_kernels_best();
    mesh->vertex_count = (uint32_t)views->vertex_count;
    mesh->triangle_count = like ? like->triangle_count : (uint32_t)views->triangle_count;
    result = fill(mesh, views, how, like);
    if (!result) mesh->cost = rgi_mesh_settle(mesh, 0);
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
    rgi_release(memory, mesh->numbers, mesh->leaf_count, sizeof *mesh->numbers);
    rgi_release(memory, mesh->lines, mesh->line_count, RGI_MESH_LINE);
    rgi_release(memory, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    rgi_release(memory, mesh, 1, sizeof *mesh);
}

/* ------------------------------------------------------------------------------------------- what was given */

/** What is wanted of the triangles in the leaves; NULL: not that. */
typedef struct wanted {
    double (*vertices)[3];
    uint32_t (*triangles)[3];
} wanted;

static void read_triangle(const rgi_mesh *mesh, const void *leaf, uint32_t triangle, const wanted *w) {
    double v[3][3];
    uint32_t number = rgi_mesh_primitive(mesh, leaf, triangle);
    rgi_triangle_corners(mesh, leaf, triangle, v);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t vertex = rgi_mesh_vertex(mesh, leaf, triangle, c);
        if (w->vertices) rgi_copy(v[c], w->vertices[vertex]);
        if (w->triangles) w->triangles[number][c] = vertex;
    }
}

static void read_leaves(const rgi_mesh *mesh, rgi_mesh_ref ref, const wanted *w) {
    const void *at = rgi_mesh_at(mesh, ref);
    if (ref & RGI_MESH_LEAF) {
        uint32_t count = mesh->soup ? RGI_SOUP_LEAF : ((const rgi_mesh_leaf *)at)->triangles;
        for (uint32_t t = 0; t < count; t++) {
            if (rgi_mesh_primitive(mesh, at, t) != RGI_NO_TRIANGLE) read_triangle(mesh, at, t, w);
        }
        return;
    }
    const rgi_mesh_node *node = at;
    for (int o = 0; o < RGI_CHILDREN; o++) {
        if (node->lo[0][o] <= node->hi[0][o]) read_leaves(mesh, node->child[o], w);
    }
}

void rgi_mesh_read_vertices(const rgi_mesh *mesh, double (*vertices)[3]) {
    const wanted w = {vertices, NULL};
    if (mesh->vertices) {
        memcpy(vertices, mesh->vertices, mesh->vertex_count * sizeof *vertices);
        return;
    }
    memset(vertices, 0, mesh->vertex_count * sizeof *vertices);
    read_leaves(mesh, mesh->root, &w);
}

void rgi_mesh_read_triangles(const rgi_mesh *mesh, uint32_t (*triangles)[3]) {
    const wanted w = {NULL, triangles};
    read_leaves(mesh, mesh->root, &w);
}
