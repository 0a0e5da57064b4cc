/* SPDX-License-Identifier: MIT */
#include "shape.h"

#include "error.h"
#include "pose.h"
#include "struct_size.h"
#include "vec.h"
#include "views.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

/* Kinds that the Meson option `shapes` leaves out are refused when they are to be made, so what stands in for the
 * rest of them here is never asked. */
#if defined(RGI_NO_BOX)
#define rgi_box_intersect(lo, hi, ray, candidate) false
#endif
#if defined(RGI_NO_CAPSULE)
#define rgi_capsule_init(capsule, a, b, radius) ((void)0)
#define rgi_capsule_intersect(capsule, ray, candidate) false
#endif
#if defined(RGI_NO_MESH)
#define rgi_mesh_create(memory, views, how, like, mesh) RG_OK
#define rgi_mesh_deform(memory, old, how, views, mesh) RG_OK
#define rgi_mesh_destroy(mesh) ((void)0)
#define rgi_mesh_intersect(mesh, ray, candidate) false
#define rgi_support_reach(support) INFINITY
#define rgi_support_bounds(support, matrix, lo, hi) ((void)(matrix), (void)(lo), (void)(hi), INFINITY)
#endif

/* --------------------------------------------------------------------------------------------- intersection */

#if defined(RGI_NO_USER)
#define user_intersect(user, ray, candidate) false
#else
/* Surfaces of one user-defined shape that a ray may pass through before its callback counts as broken. */
enum { MOST_SURFACES = 1024 };

/* Asks for the closest hit from local->t_min on. Returns whether there is one in range, with its side; sets
 * ray->failed. */
static bool ask(const rg_user_shape *user, const rg_local_ray *local, rgi_local_ray *ray, rg_local_hit *hit,
                uint32_t *side) {
    memset(hit, 0, sizeof *hit);
    int32_t answer = user->intersect(user->user, local, hit);
    double nn = rgi_dot(hit->normal, hit->normal);
    if (answer < 0 || (answer > 0 && (isnan(hit->t) || !(nn > 0 && nn < INFINITY)))) ray->failed = true;
    if (answer <= 0 || ray->failed || !(hit->t >= local->t_min && hit->t <= local->t_max)) return false;
    *side = rgi_dot(hit->normal, ray->direction) < 0 ? RGI_FRONT : RGI_BACK;
    return true;
}

/* A callback knows nothing of culling and filters: where its hit does not count, it is asked for the next one beyond.
 */
static bool user_intersect(const rg_user_shape *user, rgi_local_ray *ray, rgi_candidate *candidate) {
    rg_local_ray local;
    rg_local_hit hit;
    uint32_t side;
    rgi_copy(ray->origin, local.origin);
    rgi_copy(ray->direction, local.direction);
    /* Wider than the range by what is rounded here and in the callback, so that no tie is lost; rgi_in_range decides.
     */
    local.t_min = ray->t_min - ray->shift;
    local.t_max = ray->t_max - ray->shift;
    if (isfinite(local.t_min)) local.t_min -= 0x1p-51 * (fabs(ray->t_min) + fabs(ray->shift));
    if (isfinite(local.t_max)) local.t_max += 0x1p-51 * (fabs(ray->t_max) + fabs(ray->shift));
    /* occluded may answer for all hits only where every hit counts. */
    if (ray->any && user->occluded && !ray->accept && ray->sides == (RGI_FRONT | RGI_BACK)) {
        int32_t answer = user->occluded(user->user, &local);
        ray->failed |= answer < 0;
        candidate->t = ray->t_max;
        return answer > 0;
    }
    for (int i = 0; i < MOST_SURFACES; i++) {
        if (!ask(user, &local, ray, &hit, &side)) return false;
        local.t_min = nextafter(hit.t, INFINITY);
        if (!rgi_in_range(ray, hit.t, side, candidate)) continue;
        rgi_copy(hit.normal, candidate->normal);
        candidate->u = hit.u;
        candidate->v = hit.v;
        candidate->primitive = hit.primitive;
        if (rgi_accepted(ray, candidate)) return true;
    }
    ray->failed = true;
    return false;
}
#endif

bool rgi_shape_intersect(const rg_shape *shape, rgi_local_ray *ray, rgi_candidate *candidate) {
    switch (shape->kind) {
    case RG_SHAPE_SPHERE:
        return rgi_sphere_intersect(shape->of.radius, ray, candidate);
    case RG_SHAPE_BOX:
        return rgi_box_intersect(shape->lo, shape->hi, ray, candidate);
    case RG_SHAPE_CAPSULE:
        return rgi_capsule_intersect(&shape->of.capsule, ray, candidate);
    case RG_SHAPE_MESH:
        return rgi_mesh_intersect(shape->of.mesh, ray, candidate);
    default:
        return user_intersect(&shape->of.user, ray, candidate);
    }
}

/* ------------------------------------------------------------------------------------------------- bounds */

static rg_result check_radius(double radius) {
    if (radius >= RG_RADIUS_MIN && radius <= RG_COORDINATE_MAX) return RG_OK;
    return rgi_fail(RG_INVALID_VALUE, "radius is %g, not in [%g, %g]", radius, RG_RADIUS_MIN, RG_COORDINATE_MAX);
}

/* Half the extent of a posed sphere along a world axis: the row's length times the radius. */
static double row_length(const double *matrix, int row) {
    return sqrt(rgi_dot(matrix + 3 * row, matrix + 3 * row));
}

/* One axis of the box around `linear * shape`, before the position is added; *scale bounds what was added up on the
 * way. */
static void posed_box(const rg_shape *shape, const double *matrix, int i, double *lo, double *hi, double *scale) {
    const double *row = matrix + 3 * i;
    double radius = shape->kind == RG_SHAPE_SPHERE ? shape->of.radius : shape->of.capsule.radius;
    if (shape->kind == RG_SHAPE_SPHERE) {
        *hi = radius * row_length(matrix, i);
        *lo = -*hi;
        *scale = *hi;
    } else if (shape->kind == RG_SHAPE_CAPSULE) {
        const rgi_capsule *c = &shape->of.capsule;
        double at_a = 0, along = 0, reach = radius * row_length(matrix, i);
        *scale = reach;
        for (int j = 0; j < 3; j++) {
            at_a += row[j] * c->a[j];
            along += row[j] * c->axis[j] * c->length;
            *scale += fabs(row[j] * c->a[j]) + fabs(row[j] * c->axis[j] * c->length);
        }
        *lo = rgi_min(at_a, at_a + along) - reach;
        *hi = rgi_max(at_a, at_a + along) + reach;
    } else {
        *lo = *hi = *scale = 0;
        for (int j = 0; j < 3; j++) {
            double a = row[j] * shape->lo[j], b = row[j] * shape->hi[j];
            *lo += rgi_min(a, b);
            *hi += rgi_max(a, b);
            *scale += rgi_max(fabs(a), fabs(b));
        }
    }
}

static bool is_infinite(const rg_shape *shape) {
    return isinf(shape->lo[0] + shape->lo[1] + shape->lo[2]) || isinf(shape->hi[0] + shape->hi[1] + shape->hi[2]);
}

/* Adds the position. At most a dozen roundings came before, each of half an ulp of `scale`. */
static rg_result world_bounds(int i, double position, double scale, bool infinite, double *lo, double *hi) {
    double pad = 0x1p-49 * (scale + fabs(position));
    *lo += position - pad;
    *hi += position + pad;
    if (infinite || (*lo >= -4 * RG_COORDINATE_MAX && *hi <= 4 * RG_COORDINATE_MAX)) return RG_OK;
    return rgi_fail(RG_INVALID_VALUE, "the posed shape reaches from %c = %g to %g, which is too far", "xyz"[i], *lo,
                    *hi);
}

rg_result rgi_ball_bounds(double radius, const double position[3], double lo[3], double hi[3]) {
    rg_result result = check_radius(radius);
    for (int i = 0; i < 3 && !result; i++) {
        lo[i] = -radius;
        hi[i] = radius;
        result = world_bounds(i, position[i], radius, false, &lo[i], &hi[i]);
    }
    return result;
}

/* The same for all axes of a mesh. */
static double posed_mesh(const rg_shape *shape, const double *matrix, double lo[3], double hi[3], double scale[3]) {
    for (int i = 0; i < 3; i++) {
        scale[i] = 0;
        for (int j = 0; j < 3; j++)
            scale[i] += fabs(matrix[3 * i + j]) * rgi_max(fabs(shape->lo[j]), fabs(shape->hi[j]));
    }
    return rgi_support_bounds(&shape->of.mesh->support, matrix, lo, hi);
}

/* A shape under the identity. */
static double upright(const rg_shape *shape, double lo[3], double hi[3], double scale[3]) {
    for (int i = 0; i < 3; i++) {
        lo[i] = shape->lo[i];
        hi[i] = shape->hi[i];
        scale[i] = isinf(lo[i]) || isinf(hi[i]) ? 0 : rgi_max(fabs(lo[i]), fabs(hi[i]));
    }
    return shape->kind == RG_SHAPE_MESH ? rgi_support_reach(&shape->of.mesh->support) : INFINITY;
}

rg_result rgi_shape_bounds(const rg_shape *shape, const double position[3], const double *matrix, double lo[3],
                           double hi[3], double *reach) {
    double scale[3];
    rg_result result = RG_OK;
    *reach = INFINITY;
    if (matrix && is_infinite(shape))
        return rgi_fail(RG_INVALID_VALUE, "an infinite box needs the identity as linear part of its pose");
    if (!matrix)
        *reach = upright(shape, lo, hi, scale);
    else if (shape->kind == RG_SHAPE_MESH)
        *reach = posed_mesh(shape, matrix, lo, hi, scale);
    else
        for (int i = 0; i < 3; i++) posed_box(shape, matrix, i, &lo[i], &hi[i], &scale[i]);
    for (int i = 0; i < 3 && !result; i++) {
        bool infinite = isinf(lo[i]) || isinf(hi[i]);
        result = world_bounds(i, position[i], scale[i], infinite, &lo[i], &hi[i]);
    }
    return result;
}

/* ----------------------------------------------------------------------------------------------- creation */

static const rg_shape_config default_config = {sizeof(rg_shape_config), {NULL, NULL, NULL}, 0, 0, NULL, NULL};
enum {
    MAX_WORKERS = 1024,
    CONFIG_LEAST = offsetof(rg_shape_config, quality),
    MESH_LEAST = offsetof(rg_mesh_views, released),
    USER_LEAST = sizeof(rg_user_shape),
    REPORT_LEAST = sizeof(rg_shape_report)
};

rg_result rg_shape_config_default(rg_shape_config *config, size_t size) {
    return rgi_struct_default(&default_config, sizeof default_config, CONFIG_LEAST, config, size, "rg_shape_config");
}

/* What a kind is called that the build leaves out; NULL for one that it has. */
static const char *left_out(rg_shape_kind kind) {
    switch (kind) {
#if defined(RGI_NO_SPHERE)
    case RG_SHAPE_SPHERE:
        return "spheres";
#endif
#if defined(RGI_NO_BOX)
    case RG_SHAPE_BOX:
        return "boxes";
#endif
#if defined(RGI_NO_CAPSULE)
    case RG_SHAPE_CAPSULE:
        return "capsules";
#endif
#if defined(RGI_NO_MESH)
    case RG_SHAPE_MESH:
        return "meshes";
#endif
#if defined(RGI_NO_USER)
    case RG_SHAPE_USER:
        return "user-defined shapes";
#endif
    default:
        return NULL;
    }
}

static rg_result refuse(rg_shape_kind kind) {
    return rgi_fail(RG_INVALID_ARGUMENT, "this build has no %s", left_out(kind));
}

static rg_result shape_new(const rg_shape_config *given, rg_shape_kind kind, rg_shape **out) {
    rg_shape_config config;
    rgi_memory memory;
    rg_shape *shape;
    if (!out) return rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL: nowhere to return it");
    rg_result result = rgi_struct_read(&config, sizeof config, CONFIG_LEAST, given, "rg_shape_config");
    if (!result) result = rgi_memory_init(&memory, &config.allocator);
    if (!result) result = rgi_allocate(&memory, 1, sizeof *shape, "a shape", &shape);
    if (result) return result;
    memset(shape, 0, sizeof *shape);
    shape->memory = memory;
    shape->references = 1;
    shape->kind = kind;
    *out = shape;
    return RG_OK;
}

static rg_result check_point(const double point[3], const char *name) {
    if (!point) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", name);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(point[i]) <= RG_COORDINATE_MAX))
            return rgi_fail(RG_INVALID_VALUE, "%s[%d] is %g, which is not finite or beyond %g", name, i, point[i],
                            RG_COORDINATE_MAX);
    }
    return RG_OK;
}

rg_result rg_shape_create_sphere(const rg_shape_config *config, double radius, rg_shape **out) {
    if (left_out(RG_SHAPE_SPHERE)) return refuse(RG_SHAPE_SPHERE);
    rg_result result = check_radius(radius);
    if (!result) result = shape_new(config, RG_SHAPE_SPHERE, out);
    if (result) return result;
    (*out)->of.radius = radius;
    rgi_set((*out)->lo, -radius, -radius, -radius);
    rgi_set((*out)->hi, radius, radius, radius);
    return RG_OK;
}

static rg_result check_box(const double lo[3], const double hi[3], bool infinite_allowed) {
    for (int i = 0; i < 3; i++) {
        bool lo_right = fabs(lo[i]) <= RG_COORDINATE_MAX || (infinite_allowed && lo[i] == -INFINITY);
        bool hi_right = fabs(hi[i]) <= RG_COORDINATE_MAX || (infinite_allowed && hi[i] == INFINITY);
        if (!lo_right) return rgi_fail(RG_INVALID_VALUE, "lo[%d] of the box is %g", i, lo[i]);
        if (!hi_right) return rgi_fail(RG_INVALID_VALUE, "hi[%d] of the box is %g", i, hi[i]);
        if (lo[i] > hi[i])
            return rgi_fail(RG_INVALID_VALUE, "lo[%d] = %g is larger than hi[%d] = %g", i, lo[i], i, hi[i]);
    }
    return RG_OK;
}

rg_result rg_shape_create_box(const rg_shape_config *config, const double lo[3], const double hi[3], rg_shape **out) {
    if (left_out(RG_SHAPE_BOX)) return refuse(RG_SHAPE_BOX);
    if (!lo || !hi) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", lo ? "hi" : "lo");
    rg_result result = check_box(lo, hi, true);
    if (!result) result = shape_new(config, RG_SHAPE_BOX, out);
    if (result) return result;
    rgi_copy(lo, (*out)->lo);
    rgi_copy(hi, (*out)->hi);
    return RG_OK;
}

rg_result rg_shape_create_capsule(const rg_shape_config *config, const double a[3], const double b[3], double radius,
                                  rg_shape **out) {
    if (left_out(RG_SHAPE_CAPSULE)) return refuse(RG_SHAPE_CAPSULE);
    rg_result result = check_point(a, "a");
    if (!result) result = check_point(b, "b");
    if (!result) result = check_radius(radius);
    if (!result) result = shape_new(config, RG_SHAPE_CAPSULE, out);
    if (result) return result;
    rgi_capsule_init(&(*out)->of.capsule, a, b, radius);
    for (int i = 0; i < 3; i++) {
        (*out)->lo[i] = rgi_min(a[i], b[i]) - radius;
        (*out)->hi[i] = rgi_max(a[i], b[i]) + radius;
    }
    return RG_OK;
}

static rg_result check_vertices(const rg_mesh_views *v) {
    rg_result result =
        rgi_check_view3(v->vertices.x, v->vertices.y, v->vertices.z, v->vertices.type, RGI_FLOATS, 1, "vertices");
    if (result) return result;
    if (v->vertex_count < UINT32_MAX) return RG_OK;
    return rgi_fail(RG_LIMIT_EXCEEDED, "vertex_count is %" PRIu64 ", not below 2^32 - 1", v->vertex_count);
}

static rg_result check_triangles(const rg_mesh_views *v) {
    rg_result result =
        rgi_check_view3(v->indices.x, v->indices.y, v->indices.z, v->indices.type, RGI_INDICES, 0, "indices");
    if (result) return result;
    if (v->triangle_count == 0)
        return rgi_fail(RG_INVALID_VALUE, "triangle_count is 0: a mesh has a triangle at least");
    if (v->triangle_count >= 1u << 31)
        return rgi_fail(RG_LIMIT_EXCEEDED, "triangle_count is %" PRIu64 ", not below 2^31", v->triangle_count);
    if (v->vertex_count == 0) return rgi_fail(RG_INVALID_VALUE, "vertex_count is 0");
    if (!v->indices.x && v->triangle_count != v->vertex_count / 3)
        return rgi_fail(RG_INVALID_VALUE,
                        "triangle_count is %" PRIu64 ", but %" PRIu64 " vertices without indices make %" PRIu64,
                        v->triangle_count, v->vertex_count, v->vertex_count / 3);
    return RG_OK;
}

/* How the config says that a mesh is to be made. */
static rg_result read_making(const rg_shape_config *given, rgi_mesh_making *how) {
    rg_shape_config config;
    rg_result result = rgi_struct_read(&config, sizeof config, CONFIG_LEAST, given, "rg_shape_config");
    if (result) return result;
    if (!given) config = default_config;
    if (config.quality != RG_MESH_BEST && config.quality != RG_MESH_FAST)
        return rgi_fail(RG_INVALID_ARGUMENT, "quality is %d, which is none", (int)config.quality);
    if (config.workers > MAX_WORKERS)
        return rgi_fail(RG_INVALID_VALUE, "workers is %u, above %d", config.workers, MAX_WORKERS);
    how->fast = config.quality == RG_MESH_FAST;
    how->workers = config.workers ? config.workers : 1;
    how->parallel_for = config.parallel_for;
    how->parallel_for_user = config.parallel_for_user;
    return RG_OK;
}

/* A mesh; `old`: the one whose triangles get new vertices, or NULL. */
static rg_result create_mesh(const rg_shape_config *config, const rgi_mesh *old, const rg_mesh_views *given,
                             rg_shape **out) {
    rg_mesh_views views;
    rgi_mesh_making how;
    rg_shape *shape = NULL;
    if (!given) return rgi_fail(RG_INVALID_ARGUMENT, "views is NULL");
    rg_result result = rgi_struct_read(&views, sizeof views, MESH_LEAST, given, "rg_mesh_views");
    if (!result) result = check_vertices(&views);
    if (!result && !old) result = check_triangles(&views);
    if (!result) result = out ? RG_OK : rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL: nowhere to return it");
    if (!result) result = read_making(config, &how);
    if (!result) result = shape_new(config, RG_SHAPE_MESH, &shape);
    if (!result)
        result = old ? rgi_mesh_deform(&shape->memory, old, &how, &views, &shape->of.mesh)
                     : rgi_mesh_create(&shape->memory, &views, &how, NULL, &shape->of.mesh);
    if (result) {
        rg_shape_release(&shape);
        return result;
    }
    rgi_copy(shape->of.mesh->lo, shape->lo);
    rgi_copy(shape->of.mesh->hi, shape->hi);
    *out = shape;
    if (!views.released) return RG_OK;
    if (rgi_mesh_borrows(shape->of.mesh)) {
        shape->released = views.released;
        shape->released_user = views.user;
    } else {
        views.released(views.user);
    }
    return RG_OK;
}

rg_result rg_shape_create_mesh(const rg_shape_config *config, const rg_mesh_views *views, rg_shape **out) {
    if (left_out(RG_SHAPE_MESH)) return refuse(RG_SHAPE_MESH);
    return create_mesh(config, NULL, views, out);
}

rg_result rg_shape_create_deformed(const rg_shape_config *config, const rg_shape *mesh, const rg_mesh_views *views,
                                   rg_shape **out) {
    if (left_out(RG_SHAPE_MESH)) return refuse(RG_SHAPE_MESH);
    if (!mesh || mesh->kind != RG_SHAPE_MESH)
        return rgi_fail(RG_INVALID_ARGUMENT, mesh ? "mesh is another shape" : "mesh is NULL");
    return create_mesh(config, mesh->of.mesh, views, out);
}

rg_result rg_shape_create_user(const rg_shape_config *config, const rg_user_shape *given, rg_shape **out) {
    rg_user_shape user;
    if (left_out(RG_SHAPE_USER)) return refuse(RG_SHAPE_USER);
    if (!given) return rgi_fail(RG_INVALID_ARGUMENT, "definition is NULL");
    rg_result result = rgi_struct_read(&user, sizeof user, USER_LEAST, given, "rg_user_shape");
    if (!result && !user.intersect) result = rgi_fail(RG_INVALID_ARGUMENT, "rg_user_shape.intersect is NULL");
    if (!result) result = check_box(user.lo, user.hi, false);
    if (!result) result = shape_new(config, RG_SHAPE_USER, out);
    if (result) return result;
    (*out)->of.user = user;
    rgi_copy(user.lo, (*out)->lo);
    rgi_copy(user.hi, (*out)->hi);
    return RG_OK;
}

/* ----------------------------------------------------------------------------------------------- lifetime */

void rg_shape_retain(rg_shape *shape) {
    if (shape) __atomic_fetch_add(&shape->references, 1, __ATOMIC_RELAXED);
}

void rgi_shape_put_aside(rg_shape *shape, rg_shape **list) {
    if (__atomic_sub_fetch(&shape->references, 1, __ATOMIC_ACQ_REL) != 0) return;
    shape->next = *list;
    *list = shape;
}

static void destroy(rg_shape *shape) {
    if (shape->kind == RG_SHAPE_MESH) rgi_mesh_destroy(shape->of.mesh);
    if (shape->kind == RG_SHAPE_USER && shape->of.user.destroy) shape->of.user.destroy(shape->of.user.user);
    if (shape->released) shape->released(shape->released_user);
    rgi_memory memory = shape->memory;
    rgi_release(&memory, shape, 1, sizeof *shape);
}

void rgi_shapes_destroy(rg_shape *list) {
    while (list) {
        rg_shape *next = list->next;
        destroy(list);
        list = next;
    }
}

void rg_shape_release(rg_shape **pointer) {
    rg_shape *gone = NULL;
    if (!pointer || !*pointer) return;
    rgi_shape_put_aside(*pointer, &gone);
    *pointer = NULL;
    rgi_shapes_destroy(gone);
}

rg_result rg_shape_stats(const rg_shape *shape, rg_shape_report *report) {
    rg_shape_report r;
    if (!shape) return rgi_fail(RG_INVALID_ARGUMENT, "shape is NULL");
    memset(&r, 0, sizeof r);
    r.kind = shape->kind;
    rgi_copy(shape->lo, r.lo);
    rgi_copy(shape->hi, r.hi);
    r.triangle_count = shape->kind == RG_SHAPE_MESH ? shape->of.mesh->triangle_count : 0;
    r.bytes = __atomic_load_n(&shape->memory.bytes, __ATOMIC_RELAXED);
    return rgi_struct_write(&r, sizeof r, REPORT_LEAST, report, "rg_shape_report");
}
