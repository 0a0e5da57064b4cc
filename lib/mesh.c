/* SPDX-License-Identifier: MIT */
#include "mesh.h"

#include "error.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------- the ray */

/* A ray made ready for a mesh. */
typedef struct walk {
    const rgi_local_ray *ray;
    double inverse[3]; /* of the direction, for boxes only: never infinite */
    int x, y, z;       /* z: the direction's largest component; x, y, z is a rotation of the axes, or its mirror */
    double shear[2];
    double slack; /* rounding of t = shift + root */
    bool found;
    rgi_candidate best;
} walk;

static void walk_init(walk *w, const rgi_local_ray *ray) {
    const double *d = ray->direction;
    w->ray = ray;
    w->z = fabs(d[0]) > fabs(d[1]) ? 0 : 1;
    if (fabs(d[2]) > fabs(d[w->z])) w->z = 2;
    w->x = (w->z + 1) % 3;
    w->y = (w->z + 2) % 3;
    w->shear[0] = d[w->x] / d[w->z];
    w->shear[1] = d[w->y] / d[w->z];
    /* A component below 2^-60 of the largest moves the ray by less than the boxes' pad over any length that matters.
     */
    double least = fabs(d[w->z]) * 0x1p-60;
    for (int i = 0; i < 3; i++) w->inverse[i] = 1 / (fabs(d[i]) > least ? d[i] : copysign(least, d[i]));
    w->slack = fabs(ray->shift) * 0x1p-50;
    w->found = false;
    w->best.t = ray->t_max;
}

/* -------------------------------------------------------------------------------------------- the triangle */

/* A corner in the frame in which the ray is the z axis. */
static void to_ray(const walk *w, const double vertex[3], double relative[3], double out[2]) {
    rgi_sub(vertex, w->ray->origin, relative);
    out[0] = relative[w->x] - w->shear[0] * relative[w->z];
    out[1] = relative[w->y] - w->shear[1] * relative[w->z];
}

/* Which side of edge a to b the ray passes. Exactly the negative for edge b to a, so neighbours never both miss. */
static double edge(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/*
 * Where the ray meets the triangle's plane; along = normal * direction. The plane form stays exact for long thin
 * triangles, but not for a ray almost in the plane: the result is kept between the corners' depths, where it must be.
 */
static double plane_root(const walk *w, const double normal[3], double along, double r[3][3]) {
    double dz = w->ray->direction[w->z];
    double z0 = r[0][w->z] / dz, z1 = r[1][w->z] / dz, z2 = r[2][w->z] / dz;
    double low = rgi_min(rgi_min(z0, z1), z2), high = rgi_max(rgi_max(z0, z1), z2);
    double root = along != 0 ? rgi_dot(normal, r[0]) / along : low;
    return rgi_min(rgi_max(root, low), high);
}

/*
 * S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013), section 3, in double. Zero counts
 * as inside for both neighbours. Returns false for a miss; true with the root unchecked.
 */
static bool meets(const walk *w, const uint32_t corners[3], const double (*vertices)[3], double *root, uint32_t *side,
                  rgi_candidate *candidate) {
    double r[3][3], p[3][2];
    for (int c = 0; c < 3; c++) to_ray(w, vertices[corners[c]], r[c], p[c]);
    double e0 = edge(p[1], p[2]), e1 = edge(p[2], p[0]), e2 = edge(p[0], p[1]);
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return false;
    double sum = e0 + e1 + e2;
    if (sum == 0) return false;

    double ab[3], ac[3], *n = candidate->normal;
    rgi_sub(vertices[corners[1]], vertices[corners[0]], ab);
    rgi_sub(vertices[corners[2]], vertices[corners[0]], ac);
    rgi_cross(ab, ac, n);
    double along = rgi_dot(n, w->ray->direction);
    *root = plane_root(w, n, along, r);
    *side = along < 0 ? RGI_FRONT : RGI_BACK;
    candidate->u = e1 / sum;
    candidate->v = e2 / sum;
    return true;
}

static void test_leaf(walk *w, const rgi_mesh *mesh, const rgi_mesh_node *leaf) {
    for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
        rgi_candidate c;
        double root;
        uint32_t side;
        if (!meets(w, mesh->triangles[i], (const double(*)[3])mesh->vertices, &root, &side, &c)) continue;
        if (!rgi_in_range(w->ray, root, side, &c)) continue;
        c.primitive = mesh->primitives[i];
        if (c.t > w->best.t || (w->found && c.t == w->best.t && c.primitive > w->best.primitive)) continue;
        if (!rgi_accepted(w->ray, &c)) continue;
        w->best = c;
        w->found = true;
    }
}

/* ------------------------------------------------------------------------------------------------ the tree */

/* Where the ray enters a box, or +infinity if it misses it or enters beyond the best hit. */
static double enter(const walk *w, const rgi_mesh_node *node) {
    double from = w->ray->t_min - w->ray->shift - w->slack, to = w->best.t - w->ray->shift + w->slack;
    for (int a = 0; a < 3; a++) {
        double t0 = (node->lo[a] - w->ray->origin[a]) * w->inverse[a];
        double t1 = (node->hi[a] - w->ray->origin[a]) * w->inverse[a];
        from = rgi_max(from, rgi_min(t0, t1));
        to = rgi_min(to, rgi_max(t0, t1));
    }
    /* T. Ize, "Robust BVH Ray Traversal" (JCGT 2013): two ulp on the far side close what rounding opens. */
    return from <= to + fabs(to) * 0x1p-51 ? from : INFINITY;
}

bool rgi_mesh_intersect(const rgi_mesh *mesh, const rgi_local_ray *ray, rgi_candidate *candidate) {
    walk w;
    walk_init(&w, ray);
    uint32_t stack[RGI_MESH_DEPTH + 2];
    uint32_t top = 0;
    if (enter(&w, &mesh->nodes[0]) < INFINITY) stack[top++] = 0;
    while (top) {
        const rgi_mesh_node *node = &mesh->nodes[stack[--top]];
        if (node->count) {
            test_leaf(&w, mesh, node);
            if (w.found && ray->any) break;
            continue;
        }
        uint32_t near = node->first, far = node->first + 1;
        double t_near = enter(&w, &mesh->nodes[near]), t_far = enter(&w, &mesh->nodes[far]);
        if (t_far < t_near) {
            uint32_t swap = near;
            near = far;
            far = swap;
            double t = t_near;
            t_near = t_far;
            t_far = t;
        }
        if (t_far < INFINITY) stack[top++] = far;
        if (t_near < INFINITY) stack[top++] = near;
    }
    *candidate = w.best;
    return w.found;
}

/* ------------------------------------------------------------------------------------------------ creation */

static rg_result copy_vertices(rgi_mesh *mesh, const rg_mesh_views *views) {
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        double *v = mesh->vertices[i];
        rgi_load3(&views->vertices, i, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= RG_COORDINATE_MAX))
                return rgi_fail(RG_INVALID_VALUE, "vertex %u has %c = %g, which is not finite or beyond %g", i,
                                "xyz"[a], v[a], RG_COORDINATE_MAX);
        }
    }
    return RG_OK;
}

static rg_result copy_triangles(rgi_mesh *mesh, const rg_mesh_views *views) {
    rgi_empty_box(mesh->lo, mesh->hi);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint64_t corner[3] = {3ull * i, 3ull * i + 1, 3ull * i + 2};
        if (views->indices.x) rgi_load3_integer(&views->indices, i, corner);
        for (int c = 0; c < 3; c++) {
            if (corner[c] >= mesh->vertex_count)
                return rgi_fail(RG_INVALID_VALUE,
                                "index %" PRIu64 " of triangle %u (corner %d) is not below the %u vertices",
                                corner[c], i, c, mesh->vertex_count);
            mesh->triangles[i][c] = (uint32_t)corner[c];
            /* The mesh's box is that of the triangles: vertices that none uses must not make it larger. */
            const double *v = mesh->vertices[corner[c]];
            rgi_grow(mesh->lo, mesh->hi, v, v);
        }
    }
    return RG_OK;
}

static rg_result fill(rgi_mesh *mesh, const rg_mesh_views *views) {
    rgi_memory *memory = mesh->memory;
    rg_result result =
        rgi_allocate(memory, mesh->vertex_count, sizeof *mesh->vertices, "a mesh's vertices", &mesh->vertices);
    if (!result)
        result = rgi_allocate(memory, mesh->triangle_count, sizeof *mesh->triangles, "a mesh's triangles",
                              &mesh->triangles);
    if (!result) result = copy_vertices(mesh, views);
    if (!result) result = copy_triangles(mesh, views);
    if (!result) result = rgi_mesh_build(mesh);
    return result;
}

rg_result rgi_mesh_create(rgi_memory *memory, const rg_mesh_views *views, rgi_mesh **out) {
    rgi_mesh *mesh;
    rg_result result = rgi_allocate(memory, 1, sizeof *mesh, "a mesh", &mesh);
    if (result) return result;
    memset(mesh, 0, sizeof *mesh);
    mesh->memory = memory;
    mesh->vertex_count = (uint32_t)views->vertex_count;
    mesh->triangle_count = (uint32_t)views->triangle_count;
    result = fill(mesh, views);
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
    rgi_release(memory, mesh->primitives, mesh->triangle_count, sizeof *mesh->primitives);
    rgi_release(memory, mesh->nodes, mesh->node_room, sizeof *mesh->nodes);
    rgi_release(memory, mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    rgi_release(memory, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    rgi_release(memory, mesh, 1, sizeof *mesh);
}

void rgi_mesh_read(const rgi_mesh *mesh, double (*vertices)[3], uint32_t (*triangles)[3]) {
    memcpy(vertices, mesh->vertices, mesh->vertex_count * sizeof *vertices);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        memcpy(triangles[mesh->primitives[i]], mesh->triangles[i], sizeof *triangles);
}
