/* SPDX-License-Identifier: MIT */
/* shapes.c: the shapes that random objects take, each made in the library and in the reference, and their poses. */
#include "world.h"

#include <string.h>

static void add(world *w, rg_result result, rg_shape *shape, const reference_shape *reference, bool finite) {
    world_expect(w, "making a shape", result, RG_OK);
    w->shapes[w->shape_count++] = (world_shape){shape, reference, finite, false, !finite};
}

static void add_sphere(world *w, double radius) {
    rg_shape *shape = NULL;
    rg_result result = rg_shape_create_sphere(NULL, radius, &shape);
    add(w, result, shape, reference_sphere(w->reference, radius), true);
    w->shapes[w->shape_count - 1].ball = true;
}

static void add_box(world *w, double x0, double y0, double z0, double x1, double y1, double z1) {
    const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
    rg_shape *shape = NULL;
    rg_result result = rg_shape_create_box(NULL, lo, hi, &shape);
    add(w, result, shape, reference_box(w->reference, lo, hi), isfinite(x1) && isfinite(y1) && isfinite(z1));
}

static void add_capsule(world *w, double ax, double ay, double az, double bx, double by, double bz, double radius) {
    const double a[3] = {ax, ay, az}, b[3] = {bx, by, bz};
    rg_shape *shape = NULL;
    rg_result result = rg_shape_create_capsule(NULL, a, b, radius, &shape);
    add(w, result, shape, reference_capsule(w->reference, a, b, radius), true);
}

rg_mesh_views world_mesh_views(const double *vertices, size_t vertex_count, const uint32_t *indices,
                               size_t triangle_count) {
    rg_mesh_views views = {.size = sizeof views, .vertex_count = vertex_count, .triangle_count = triangle_count};
    views.vertices = rg_input3_packed(vertices, 3 * sizeof *vertices, RG_F64);
    views.indices = rg_input3_packed(indices, 3 * sizeof *indices, RG_U32);
    return views;
}

static const reference_shape *add_mesh(world *w, const double *vertices, size_t vertex_count, const uint32_t *indices,
                                       size_t triangle_count) {
    rg_mesh_views views = world_mesh_views(vertices, vertex_count, indices, triangle_count);
    rg_shape *shape = NULL;
    rg_result result = rg_shape_create_mesh(NULL, &views, &shape);
    const reference_shape *reference = reference_mesh(w->reference, vertices, vertex_count, indices, triangle_count);
    add(w, result, shape, reference, true);
    return reference;
}

static const double OCTAHEDRON[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
static const uint32_t OCTAHEDRON_FACES[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const double TETRAHEDRON[12] = {5, 5, 5, 6, 5, 5, 5, 6, 5, 5, 5, 6}; /* well off its origin */
static const uint32_t TETRAHEDRON_FACES[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

/* A ring of 12 x 8 squares, each cut in two: closed, not convex, with inner silhouettes. */
static void add_ring(world *w) {
    enum { AROUND = 12, ACROSS = 8 };
    double v[AROUND * ACROSS][3];
    uint32_t index[2 * AROUND * ACROSS][3];
    for (int i = 0; i < AROUND; i++) {
        for (int k = 0; k < ACROSS; k++) {
            double a = 6.28318530717958648 * i / AROUND, b = 6.28318530717958648 * k / ACROSS;
            double *p = v[i * ACROSS + k];
            p[0] = cos(a) * (0.75 + 0.25 * cos(b));
            p[1] = sin(a) * (0.75 + 0.25 * cos(b));
            p[2] = 0.25 * sin(b);
            uint32_t next_i = (uint32_t)((i + 1) % AROUND * ACROSS), next_k = (uint32_t)((k + 1) % ACROSS);
            uint32_t a00 = (uint32_t)(i * ACROSS + k), a10 = next_i + (uint32_t)k;
            uint32_t a01 = (uint32_t)(i * ACROSS) + next_k, a11 = next_i + next_k;
            uint32_t *t = index[2 * (i * ACROSS + k)];
            t[0] = a00, t[1] = a10, t[2] = a11;
            t[3] = a00, t[4] = a11, t[5] = a01;
        }
    }
    add_mesh(w, v[0], AROUND * ACROSS, index[0], 2 * AROUND * ACROSS);
}

static int32_t user_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    return reference_intersect(((const world_user *)user)->shape, ray, hit);
}

static int32_t user_occluded(void *user, const rg_local_ray *ray) {
    rg_local_hit hit;
    return reference_intersect(((const world_user *)user)->shape, ray, &hit);
}

static void user_destroy(void *user) {
    --*((world_user *)user)->alive;
}

static void add_user(world *w, const reference_shape *reference, double radius, bool with_occluded) {
    world_user *user = &w->users[w->shape_count];
    rg_user_shape definition = {.size = sizeof definition,
                                .user = user,
                                .lo = {-radius, -radius, -radius},
                                .hi = {radius, radius, radius},
                                .intersect = user_intersect,
                                .occluded = with_occluded ? user_occluded : NULL,
                                .destroy = user_destroy};
    rg_shape *shape = NULL;
    *user = (world_user){reference, &w->users_alive};
    rg_result result = rg_shape_create_user(NULL, &definition, &shape);
    w->users_alive++;
    add(w, result, shape, reference, true);
}

void world_make_shapes(world *w) {
    static const double RADII[] = {1e-7, 1e-4, 1e-3, 0.01, 0.1, 1, 1, 10, 1000};
    for (size_t i = 0; i < sizeof RADII / sizeof *RADII; i++) add_sphere(w, RADII[i]);
    w->shapes[w->shape_count - 1].rare = true;
    add_box(w, -1, -1, -1, 1, 1, 1);
    add_box(w, 0, 0, 0, 0.5, 1, 2);
    add_box(w, -1, -1, 0, 1, 1, 0); /* no thickness */
    add_box(w, -1, 0, 0, 1, 0, 0);  /* a segment */
    add_box(w, 3, -0.01, -0.01, 5, 0.01, 0.01);
    add_capsule(w, 0, 0, -1, 0, 0, 1, 0.5);
    add_capsule(w, 0, 0, 0, 0, 0, 0, 1);
    add_capsule(w, 1, 2, 3, -2, 0.5, 3, 0.01);
    const reference_shape *octahedron = add_mesh(w, OCTAHEDRON, 6, OCTAHEDRON_FACES, 8);
    add_mesh(w, TETRAHEDRON, 4, TETRAHEDRON_FACES, 4);
    add_ring(w);
    add_user(w, octahedron, 1, true);
    add_user(w, reference_sphere(w->reference, 1), 1, false);
    add_box(w, -HUGE_VAL, -HUGE_VAL, -0.5, HUGE_VAL, HUGE_VAL, 0.5);
}

/* -------------------------------------------------------------------------------------------------- poses */

/* A rotation by a random unit quaternion, to float. */
static void rotation(random_source *r, double m[9]) {
    double axis[3], angle = random_between(r, -3.2, 3.2);
    random_direction(r, axis);
    double s = sin(angle / 2), w = cos(angle / 2), x = s * axis[0], y = s * axis[1], z = s * axis[2];
    const double q[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    memcpy(m, q, sizeof q);
}

static void set_linear(rg_pose *pose, const double m[9]) {
    for (int i = 0; i < 9; i++) pose->linear[i] = (float)m[i];
}

/* Rotation after scales of each local axis of its own: even, uneven, or mirroring. */
static void scaled_rotation(world *w, rg_pose *pose) {
    double m[9], size = random_decade(&w->random, w->least_decade, w->most_decade), scale[3];
    bool even = random_once_in(&w->random, 2);
    for (int k = 0; k < 3; k++) scale[k] = even ? size : size * random_decade(&w->random, -1, 0);
    if (random_once_in(&w->random, 3)) scale[random_below(&w->random, 3)] *= -1;
    rotation(&w->random, m);
    for (int i = 0; i < 9; i++) m[i] *= scale[i % 3];
    set_linear(pose, m);
}

/* Each axis gets a random direction and size: any shear. Retries until no axis is too near to the others' plane. */
static void sheared(world *w, rg_pose *pose) {
    double m[9], volume;
    do {
        for (int i = 0; i < 3; i++) random_direction(&w->random, m + 3 * i);
        volume = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                 m[2] * (m[3] * m[7] - m[4] * m[6]);
    } while (fabs(volume) < 0.01);
    double size = random_decade(&w->random, w->least_decade, w->most_decade);
    for (int i = 0; i < 9; i++) m[i] *= size;
    set_linear(pose, m);
}

rg_pose world_pose(world *w, const world_shape *shape) {
    rg_pose pose = rg_pose_at(0, 0, 0);
    for (int i = 0; i < 3; i++) {
        pose.position[i] = w->centre[i] + random_between(&w->random, -w->spread, w->spread);
        /* Round places put surfaces exactly on the walls of cells and of each other. */
        if (random_once_in(&w->random, 4)) pose.position[i] = floor(pose.position[i]);
    }
    if (!shape->finite) return pose;
    if (random_once_in(&w->random, 4)) pose.scale = random_decade(&w->random, w->least_decade, w->most_decade);
    if (w->balls) return pose;
    switch (random_below(&w->random, 6)) {
    case 0:
        scaled_rotation(w, &pose);
        break;
    case 1:
        sheared(w, &pose);
        break;
    default:
        break;
    }
    return pose;
}
