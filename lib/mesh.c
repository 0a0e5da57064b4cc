/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include "beam.h"
#include "lattice_cell.h"
#include "mesh_build.h"
#include "mesh_fit.h"
#include "triangle.h"
#include "vec.h"

#include <string.h>

/* Triangles that a leaf of a connected mesh holds, as a rule, if it has not too many vertices. */
enum { CONNECTED_FILL = 16 };

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
        mesh->origin[a] = mesh->exact ? 0 : middle;
        mesh->middle.centre[a] = middle - mesh->origin[a];
    }
    mesh->scale = 1;
    double widest = rgi_max_magnitude(half);
    if (!mesh->exact) mesh->scale = 1 / rgi_power_of_two_near(rgi_max(widest, 0x1p-500));
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

void rgi_mesh_set_support(rgi_mesh *mesh, const rgi_reaches *reaches) {
    rgi_support_init(&mesh->support, reaches, mesh->lo, mesh->hi, mesh->origin, mesh->scale, (double)mesh->pad);
}

static rg_result make_room(rgi_making *m, const rg_mesh_views *views, bool floats) {
    rgi_mesh *mesh = m->mesh;
    rg_result result = RG_OK;
    mesh->exact = floats && rgi_mesh_fits_floats(mesh);
    if (!mesh->exact) result = rgi_vertices_keep(mesh, views);
    if (!result) result = rgi_allocate(mesh->memory, mesh->vertex_count, sizeof *m->at, "building a mesh", &m->at);
    return result;
}

/* The corners that a soup needs to find its vertices, where these do not come in order. */
static void place_corners(rgi_making *m, const rg_mesh_views *views, const rgi_mesh *like) {
    if (!m->mesh->soup || m->in_order) return;
    if (views->released && !like) {
        m->mesh->lent_corners = views->indices;
        return;
    }
    m->mesh->corners = m->triangles;
    m->triangles = NULL;
}

/* A connected mesh has half as many vertices as triangles, a soup three times as many. */
static rg_result make(rgi_making *m, const rg_mesh_views *views, const rgi_mesh *like) {
    rgi_mesh *mesh = m->mesh;
    bool floats;
    rg_result result = rgi_mesh_check(views, &floats);
    if (!result)
        result =
            rgi_allocate(mesh->memory, mesh->triangle_count, sizeof *m->triangles, "building a mesh", &m->triangles);
    mesh->soup = mesh->vertex_count > mesh->triangle_count;
    m->fill = mesh->soup ? RGI_SOUP_LEAF : CONNECTED_FILL;
    if (!result) result = rgi_triangles_copy(m, views, like);
    if (!result) result = make_room(m, views, floats);
    if (result) return result;
    rgi_mesh_set_frame(mesh);
    rgi_vertices_copy(m, views);
    result = m->fast ? rgi_runs_make(m) : rgi_items_make(m);
    if (!result) result = rgi_branches_make(m);
    if (!result) result = rgi_lines_make(m);
    if (!result) place_corners(m, views, like);
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
    rgi_release(memory, making.branches, 2 * (uint64_t)making.item_count, sizeof *making.branches);
    rgi_release(memory, making.items, making.item_count, sizeof *making.items);
    rgi_release(memory, making.spare, making.item_count, sizeof *making.spare);
    rgi_runs_free(&making);
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
    rgi_release(memory, mesh->kept_vertices, mesh->vertex_count, sizeof *mesh->kept_vertices);
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
    if (!mesh->exact) {
        for (uint32_t i = 0; i < mesh->vertex_count; i++) rgi_load3(&mesh->vertices, i, vertices[i]);
        return;
    }
    memset(vertices, 0, mesh->vertex_count * sizeof *vertices);
    read_leaves(mesh, mesh->root, &w);
}

void rgi_mesh_read_triangles(const rgi_mesh *mesh, uint32_t (*triangles)[3]) {
    const wanted w = {NULL, triangles};
    read_leaves(mesh, mesh->root, &w);
}
