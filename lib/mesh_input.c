/* SPDX-License-Identifier: MIT */
/* What a mesh is made from: the caller's vertices and triangles, checked and copied. */
#include "mesh_build.h"

#include "error.h"
#include "vec.h"
#include "views.h"

#include <float.h>
#include <inttypes.h>
#include <string.h>

/* Vertices that are floats are the frame's as they are if the largest coordinate is in this range: no product over-
 * or underflows. */
#define EXACT_LEAST 0x1p-40
#define EXACT_MOST 0x1p40

/* ------------------------------------------------------------------------------------------------ vertices */

/* Whether a double is a float: whose mantissa ends in zeros, and which is no smaller than a float can be. By its
 * bits, because gcc 12 drops pairs of casts. */
static bool is_float(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits & 0x1FFFFFFF) == 0 && (x == 0 || fabs(x) >= (double)FLT_MIN);
}

/* Names the first vertex that is wrong. */
static rg_result blame_vertex(const rg_mesh_views *views) {
    for (uint64_t i = 0; i < views->vertex_count; i++) {
        double v[3];
        rgi_load3(&views->vertices, i, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= RG_COORDINATE_MAX))
                return rgi_fail(RG_INVALID_VALUE, "vertex %" PRIu64 " has %c = %g, which is not finite or beyond %g",
                                i, "xyz"[a], v[a], RG_COORDINATE_MAX);
        }
    }
    return RG_OK;
}

rg_result rgi_mesh_check(const rg_mesh_views *views, bool *floats) {
    const bool narrow = views->vertices.type == RG_F32;
    bool right = true;
    *floats = true;
    for (uint64_t i = 0; i < views->vertex_count; i++) {
        double v[3];
        rgi_load3(&views->vertices, i, v);
        for (int a = 0; a < 3; a++) {
            right &= fabs(v[a]) <= RG_COORDINATE_MAX;
            *floats &= narrow || is_float(v[a]);
        }
    }
    return right ? RG_OK : blame_vertex(views);
}

bool rgi_mesh_fits_floats(const rgi_mesh *mesh) {
    double largest = rgi_max(rgi_max_magnitude(mesh->lo), rgi_max_magnitude(mesh->hi));
    return largest >= EXACT_LEAST && largest <= EXACT_MOST;
}

rg_result rgi_vertices_keep(rgi_mesh *mesh, const rg_mesh_views *views) {
    if (views->released) {
        mesh->vertices = views->vertices;
        return RG_OK;
    }
    rg_result result = rgi_allocate(mesh->memory, mesh->vertex_count, sizeof *mesh->kept_vertices,
                                    "a mesh's vertices", &mesh->kept_vertices);
    if (!result) mesh->vertices = rg_input3_packed(mesh->kept_vertices, sizeof *mesh->kept_vertices, RG_F64);
    return result;
}

void rgi_vertices_copy(rgi_making *m, const rg_mesh_views *views) {
    const rgi_mesh *mesh = m->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float *at = m->at[i];
        double v[3];
        rgi_load3(&views->vertices, i, v);
        if (mesh->kept_vertices) rgi_copy(v, mesh->kept_vertices[i]);
        for (int a = 0; a < 3; a++) {
            /* Vertices that no triangle uses may lie anywhere. */
            double in_frame = mesh->exact ? v[a] : (v[a] - mesh->origin[a]) * mesh->scale;
            at[a] = (float)rgi_min(rgi_max(in_frame, -0x1p60), 0x1p60);
        }
        at[3] = 0;
    }
}

/* ----------------------------------------------------------------------------------------------- triangles */

static rg_result blame_index(const rg_mesh_views *views) {
    for (uint64_t i = 0; i < views->triangle_count; i++) {
        uint64_t corner[3];
        rgi_load3_integer(&views->indices, i, corner);
        for (int c = 0; c < 3; c++) {
            if (corner[c] >= views->vertex_count)
                return rgi_fail(RG_INVALID_VALUE,
                                "index %" PRIu64 " of triangle %" PRIu64 " (corner %d) is not below the %" PRIu64
                                " vertices",
                                corner[c], i, c, views->vertex_count);
        }
    }
    return RG_OK;
}

static rg_result read_indices(rgi_making *m, const rg_mesh_views *views) {
    const uint64_t vertices = views->vertex_count;
    bool right = true;
    for (uint32_t i = 0; i < m->mesh->triangle_count; i++) {
        uint64_t corner[3];
        rgi_load3_integer(&views->indices, i, corner);
        for (int c = 0; c < 3; c++) {
            right &= corner[c] < vertices;
            m->triangles[i][c] = (uint32_t)corner[c];
        }
    }
    return right ? RG_OK : blame_index(views);
}

static void number_in_order(rgi_making *m) {
    for (uint32_t i = 0; i < m->mesh->triangle_count; i++) {
        for (uint32_t c = 0; c < 3; c++) m->triangles[i][c] = 3 * i + c;
    }
}

static bool is_in_order(const rgi_making *m) {
    for (uint32_t i = 0; i < m->mesh->triangle_count; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            if (m->triangles[i][c] != 3 * i + c) return false;
        }
    }
    return true;
}

/* The mesh's box is that of the triangles: vertices that none uses must not make it larger. */
static rg_result find_box(rgi_making *m, const rg_mesh_views *views) {
    rgi_mesh *mesh = m->mesh;
    uint8_t *used;
    rg_result result = rgi_allocate(mesh->memory, mesh->vertex_count, 1, "building a mesh", &used);
    if (result) return result;
    memset(used, 0, mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int c = 0; c < 3; c++) used[m->triangles[i][c]] = 1;
    }
    rgi_empty_box(mesh->lo, mesh->hi);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        double v[3];
        if (!used[i]) continue;
        rgi_load3(&views->vertices, i, v);
        rgi_grow(mesh->lo, mesh->hi, v, v);
    }
    rgi_release(mesh->memory, used, mesh->vertex_count, 1);
    return RG_OK;
}

rg_result rgi_triangles_copy(rgi_making *m, const rg_mesh_views *views, const rgi_mesh *like) {
    rg_result result = RG_OK;
    if (like)
        rgi_mesh_read_triangles(like, m->triangles);
    else if (views->indices.x)
        result = read_indices(m, views);
    else
        number_in_order(m);
    if (result) return result;
    m->in_order = m->mesh->soup && is_in_order(m);
    return find_box(m, views);
}
