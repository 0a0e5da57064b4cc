/* SPDX-License-Identifier: MIT */
#include "query.h"

#include "exact.h"
#include "vec.h"
#include "views.h"

#include <string.h>

/* ---------------------------------------------------------------------------------------------- the hit record */

/*
 * Normals go by the transposed inverse, so they stay outward under mirrors too. Where a shape is so thin for its
 * length that rounding leaves nothing of its normal, the one against the ray stands in: nothing in a hit is NaN.
 */
static void world_normal(const rgi_ray *ray, const rgi_linear *linear, const rgi_candidate *c, float out[3]) {
    double n[3];
    if (linear)
        rgi_transform_transposed(linear->inverse, c->normal, n);
    else
        rgi_copy(c->normal, n);
    double largest = rgi_max_magnitude(n);
    if (!(largest > 0 && largest < INFINITY)) {
        for (int i = 0; i < 3; i++) n[i] = -ray->direction[i];
        largest = 1;
    }
    for (int i = 0; i < 3; i++) n[i] /= largest;
    double length = sqrt(rgi_dot(n, n));
    for (int i = 0; i < 3; i++) out[i] = (float)(n[i] / length);
}

static double frobenius(const double *m) {
    double sum = 0;
    for (int i = 0; i < 9; i++) sum += m[i] * m[i];
    return sqrt(sum);
}

/*
 * How far off the surface a hit may be, and a second look at it: a position is rounded to 2^-53 of its size, t to
 * 2^-53 of the distance travelled, and the tests in the object's frame to some 2^-46 of its size (64 radii at the
 * most, see lib/object.c) times the condition of its linear part. Each with a factor of 2^5 to spare.
 */
static double offset(const rgi_object *object, const rgi_linear *linear, const rgi_ray *ray, double t,
                     const double position[3]) {
    double from_centre[3], condition = 3;
    rgi_sub(position, object->position, from_centre);
    double size = object->reach < INFINITY ? object->reach : rgi_max_magnitude(from_centre);
    if (linear) condition = frobenius(linear->product) * frobenius(linear->inverse);
    double travelled = fabs(t) * sqrt(ray->dd);
    return 0x1p-42 * condition * size + 0x1p-47 * (rgi_max_magnitude(position) + travelled);
}

static void hit_record(const rgi_query *q, const rgi_object *object, rg_object id, const rgi_candidate *c,
                       unsigned wanted, rg_hit *hit) {
    static const double nowhere[3] = {0, 0, 0};
    const rgi_linear *linear = rgi_scene_linear(q->call->scene, object);
    memset(hit, 0, sizeof *hit);
    hit->t = rgi_world_t(&q->ray, c->t);
    hit->object = id;
    if (wanted & (RGI_POSITION | RGI_OFFSET))
        rgi_rebase3(q->ray.origin, nowhere, c->t, q->ray.direction, hit->position);
    if (wanted & RGI_OFFSET) hit->offset = (float)offset(object, linear, &q->ray, c->t, hit->position);
    if (wanted & RGI_NORMAL) world_normal(&q->ray, linear, c, hit->normal);
    hit->u = (float)c->u;
    hit->v = (float)c->v;
    hit->primitive = c->primitive;
}

/* --------------------------------------------------------------------------------------------------- one ray */

static bool filter(void *context, const rgi_candidate *candidate) {
    rgi_query *q = context;
    rg_hit hit;
    if (q->failed) return false;
    hit_record(q, q->testing, q->testing_id, candidate, RGI_ALL, &hit);
    int32_t answer = q->call->config.filter(q->call->config.filter_user, q->index, &hit);
    q->failed = answer < 0;
    return answer > 0;
}

/* Returns false if the ray does not see the object. */
static bool begin_test(rgi_query *q, uint32_t slot, const rgi_object *object) {
    if (!(object->mask & q->ray.mask)) return false;
    q->tests++;
    q->testing = object;
    q->testing_id = rgi_object_id(object, slot);
    q->local.t_max = q->walk.t_max;
    return true;
}

/* Takes what the test gave; leaf and triangle as in rgi_query. Returns true if nothing more is wanted. */
static bool end_test(rgi_query *q, bool hit, const rgi_candidate *candidate, const void *leaf, uint32_t triangle) {
    q->failed |= q->local.failed;
    if (q->failed) return true;
    if (!hit) return false;
    if (q->found && candidate->t == q->best.t && q->testing_id >= q->id) return false;
    q->found = true;
    q->id = q->testing_id;
    q->object = q->testing;
    q->best = *candidate;
    q->leaf = leaf;
    q->triangle = triangle;
    q->walk.t_max = candidate->t;
    return q->call->any;
}

bool rgi_query_visit(void *context, uint32_t slot) {
    rgi_query *q = context;
    const rg_scene *scene = q->call->scene;
    const rgi_object *object = rgi_scene_object(scene, slot);
    rgi_candidate candidate;
    if (!begin_test(q, slot, object)) return false;
    bool hit = rgi_object_intersect(object, rgi_scene_linear(scene, object), &q->ray, &q->local, &candidate);
    return end_test(q, hit, &candidate, NULL, 0);
}

bool rgi_query_enter(rgi_query *q, uint32_t slot, rgi_mesh_lanes *l) {
    const rg_scene *scene = q->call->scene;
    const rgi_object *object = rgi_scene_object(scene, slot);
    if (!begin_test(q, slot, object)) return false;
    rgi_mesh_row *row = &l->rows[l->count / RGI_PACKET];
    uint32_t lane = l->count++ % RGI_PACKET;
    for (int a = 0; a < 3; a++) {
        row->rays.origin[a][lane] = q->ray.origin[a];
        row->rays.direction[a][lane] = q->ray.direction[a];
    }
    row->rays.dd[lane] = q->ray.dd;
    row->rays.t_min[lane] = q->local.t_min;
    row->rays.t_max[lane] = q->walk.t_max;
    row->inside.mesh[lane] = object->shape->of.mesh;
    row->inside.contexts[lane] = q;
    rgi_mesh_door(&row->doors, lane, object, rgi_scene_linear(scene, object));
    return true;
}

bool rgi_query_leave(rgi_query *q, const rgi_mesh_lanes *l, uint32_t lane) {
    const rgi_mesh_packet *m = &l->rows[lane / RGI_PACKET].inside;
    lane %= RGI_PACKET;
    rgi_candidate candidate = {.t = m->t_max[lane]};
    bool hit = m->found >> lane & 1;
    if (hit) candidate.primitive = rgi_mesh_primitive(m->mesh[lane], m->leaf[lane], m->triangle[lane]);
    return end_test(q, hit, &candidate, m->leaf[lane], m->triangle[lane]);
}

bool rgi_query_take(rgi_query *q, uint32_t slot, double t, const void *leaf, uint32_t triangle) {
    rgi_candidate candidate = {.t = t};
    q->testing = rgi_scene_object(q->call->scene, slot);
    q->testing_id = rgi_object_id(q->testing, slot);
    candidate.primitive = rgi_mesh_primitive(q->testing->shape->of.mesh, leaf, triangle);
    return end_test(q, true, &candidate, leaf, triangle);
}

/* The rest of a hit in a mesh. */
static void complete(const rgi_query *q, rgi_candidate *candidate) {
    rgi_local_ray local;
    rgi_triangle_ray ray;
    /* It does not pass the object by: it hits it. */
    (void)rgi_object_local(q->object, rgi_scene_linear(q->call->scene, q->object), &q->ray, &local);
    local.t_max = q->best.t;
    rgi_triangle_ray_init(&ray, &local);
    (void)rgi_triangle_meets(&ray, q->object->shape->of.mesh, q->leaf, q->triangle, candidate);
}

uint32_t rgi_query_sides(const rgi_call *c) {
    static const uint32_t sides[] = {RGI_FRONT | RGI_BACK, RGI_FRONT, RGI_BACK};
    return sides[c->config.cull];
}

void rgi_query_init(rgi_query *q, const rgi_call *c) {
    q->call = c;
    q->local.sides = rgi_query_sides(c);
    q->local.any = c->any;
    q->local.accept = c->config.filter ? filter : NULL;
    q->local.context = q;
}

void rgi_query_reset(rgi_query *q, uint64_t index) {
    q->index = index;
    q->found = q->failed = q->done = q->local.failed = false;
    q->valid = true;
    q->tests = q->walk.cells = 0;
}

void rgi_query_begin(rgi_query *q, uint64_t index) {
    const rgi_call *c = q->call;
    double origin[3], direction[3];
    rgi_load3(&c->rays->origin, index, origin);
    rgi_load3(&c->rays->direction, index, direction);
    rgi_query_reset(q, index);
    q->valid = rgi_ray_init(&q->ray, origin, direction, rgi_load(&c->rays->t_min, index, 0),
                            rgi_load(&c->rays->t_max, index, INFINITY),
                            (uint32_t)rgi_load_integer(&c->rays->mask, index, UINT32_MAX));
    q->done = !q->valid;
    q->local.t_min = q->ray.t_min;
    q->walk.t_max = q->ray.t_max;
}

void rgi_query_write(const rgi_query *q) {
    const rg_hit_views *v = q->call->hits;
    uint64_t i = q->index;
    rg_hit hit;
    if (q->valid && q->found && !q->failed) {
        rgi_candidate best = q->best;
        if (q->leaf && (q->call->plain_hits || q->call->wanted & RGI_NORMAL || v->u.data || v->v.data))
            complete(q, &best);
        hit_record(q, q->object, q->id, &best, q->call->wanted, &hit);
    } else {
        memset(&hit, 0, sizeof hit);
        hit.t = q->valid && !q->failed ? INFINITY : NAN;
        hit.object = RG_NO_OBJECT;
        hit.primitive = RG_NO_PRIMITIVE;
    }
    if (q->call->plain_hits) {
        q->call->plain_hits[i] = hit;
        return;
    }
    rgi_store(&v->t, i, hit.t);
    rgi_store_integer(&v->object, i, hit.object);
    rgi_store_integer(&v->primitive, i, hit.primitive);
    rgi_store3(&v->normal, i, hit.normal[0], hit.normal[1], hit.normal[2]);
    rgi_store(&v->u, i, hit.u);
    rgi_store(&v->v, i, hit.v);
    rgi_store3(&v->position, i, hit.position[0], hit.position[1], hit.position[2]);
    rgi_store(&v->offset, i, hit.offset);
    rgi_store_integer(&v->cells, i, q->walk.cells);
    rgi_store_integer(&v->tests, i, q->tests);
}
