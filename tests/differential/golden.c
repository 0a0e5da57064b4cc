/* SPDX-License-Identifier: MIT */
#include "golden.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const golden_set GOLDEN_SETS[] = {
    {.name = "mixed",
     .objects = 400,
     .rays = 12000,
     .least_decade = -1,
     .space = {{0, 0, 0}, 30},
     .hash = UINT64_C(0xCB2BBA6B2F285729)},
    {.name = "balls",
     .objects = 4000,
     .rays = 12000,
     .least_decade = -1,
     .balls = true,
     .space = {{0, 0, 0}, 50},
     .hash = UINT64_C(0x04EC379CB767EFAF)},
    {.name = "masked",
     .objects = 800,
     .rays = 6000,
     .least_decade = -1,
     .balls = true,
     .masked = true,
     .space = {{0, 0, 0}, 30},
     .hash = UINT64_C(0xD24537E1BFC0997D)},
    {.name = "decades",
     .objects = 600,
     .rays = 8000,
     .least_decade = -6,
     .most_decade = 3,
     .space = {{0, 0, 0}, 3000},
     .hash = UINT64_C(0x47E284306BA70D70)},
    {.name = "far",
     .objects = 400,
     .rays = 8000,
     .least_decade = -1,
     .space = {{1e9, -0.71e9, 0.13e12}, 30},
     .hash = UINT64_C(0x55B35E7EB80DFCCC)},
    {.name = "crowd",
     .objects = 500,
     .rays = 8000,
     .least_decade = -3,
     .most_decade = -2,
     .space = {{5, 5, 5}, 0.02},
     .hash = UINT64_C(0x90CAF36458AE9B99)},
    {.name = "round",
     .objects = 300,
     .rays = 8000,
     .ties = true,
     .round = true,
     .space = {{0, 0, 0}, 8},
     .hash = UINT64_C(0x9B2D0A0CD276BAC3)},
    {.name = "twins",
     .objects = 1500,
     .rays = 8000,
     .ties = true,
     .round = true,
     .balls = true,
     .space = {{0, 0, 0}, 6},
     .hash = UINT64_C(0x89CA35DB93E57117)},
    {.name = "few", .objects = 3, .rays = 4000, .space = {{1, 2, 3}, 2}, .hash = UINT64_C(0xCAAA0A3C9A482234)},
};
const int GOLDEN_SET_COUNT = sizeof GOLDEN_SETS / sizeof *GOLDEN_SETS;

void golden_demand(rg_result result, const char *call) {
    if (result == RG_OK) return;
    fprintf(stderr, "FAILED: %s: %s: %s\n", call, rg_result_name(result), rg_error_message());
    exit(EXIT_FAILURE);
}

/* ------------------------------------------------------------------------------------------------- shapes */

static void add_box(golden_data *g, double x0, double y0, double z0, double x1, double y1, double z1) {
    const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
    golden_demand(rg_shape_create_box(NULL, lo, hi, &g->shapes[g->shape_count++]), "box");
}

static void add_capsule(golden_data *g, double x, double y, double z, double radius) {
    const double a[3] = {-x, -y, -z}, b[3] = {x, y, z};
    golden_demand(rg_shape_create_capsule(NULL, a, b, radius, &g->shapes[g->shape_count++]), "capsule");
}

static void add_mesh(golden_data *g, const double *vertices, size_t vertex_count, const uint16_t *indices,
                     size_t triangle_count) {
    rg_mesh_views views = {.size = sizeof views, .vertex_count = vertex_count, .triangle_count = triangle_count};
    views.vertices = rg_input3_packed(vertices, 3 * sizeof *vertices, RG_F64);
    views.indices = rg_input3_packed(indices, 3 * sizeof *indices, RG_U16);
    golden_demand(rg_shape_create_mesh(NULL, &views, &g->shapes[g->shape_count++]), "mesh");
}

/* A dented square of 12 x 12 pairs of triangles. */
static void add_sheet(golden_data *g) {
    enum { SIDE = 12, ROW = SIDE + 1 };
    double vertices[ROW * ROW][3];
    uint16_t indices[SIDE * SIDE * 2][3];
    for (int i = 0; i < ROW * ROW; i++) {
        vertices[i][0] = 2.0 * (i % ROW) / SIDE - 1;
        vertices[i][1] = 2.0 * (i / ROW) / SIDE - 1;
        vertices[i][2] = 0.1 * (i % 7);
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        int a = i / SIDE * ROW + i % SIDE;
        const int two[6] = {a, a + 1, a + ROW + 1, a, a + ROW + 1, a + ROW};
        for (int k = 0; k < 6; k++) indices[2 * i + k / 3][k % 3] = (uint16_t)two[k];
    }
    add_mesh(g, vertices[0], ROW * ROW, indices[0], SIDE * SIDE * 2);
}

/* The host's own shape: the plane x = 0 within a disc. */
static int32_t disc_intersect(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    (void)user;
    if (ray->direction[0] == 0) return 0;
    double t = -ray->origin[0] / ray->direction[0], square = 0;
    if (!(t >= ray->t_min && t <= ray->t_max)) return 0;
    for (int i = 1; i < 3; i++) {
        double at = ray->origin[i] + t * ray->direction[i];
        square += at * at;
    }
    if (square > 1) return 0;
    *hit = (rg_local_hit){.t = t, .normal = {1, 0, 0}, .u = square};
    return 1;
}

static void make_shapes(golden_data *g) {
    static const double OCTAHEDRON[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    static const uint16_t FACES[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    const rg_user_shape disc = {.size = sizeof disc, .lo = {0, -1, -1}, .hi = {0, 1, 1}, .intersect = disc_intersect};
    golden_demand(rg_shape_create_sphere(NULL, 1, &g->shapes[g->shape_count++]), "sphere");
    if (g->set->balls) return;
    golden_demand(rg_shape_create_sphere(NULL, 0.25, &g->shapes[g->shape_count++]), "sphere");
    add_box(g, -1, -1, -1, 1, 1, 1);
    add_box(g, 0, 0, 0, 0.5, 1, 2);
    add_box(g, -1, -1, 0, 1, 1, 0);
    add_capsule(g, 0, 0, 1, 0.5);
    add_capsule(g, 1, 0.5, -0.25, 0.0625);
    add_mesh(g, OCTAHEDRON, 6, FACES, 8);
    add_sheet(g);
    golden_demand(rg_shape_create_user(NULL, &disc, &g->shapes[g->shape_count++]), "user shape");
}

/* ------------------------------------------------------------------------------------------------ objects */

/* A rotation by a unit quaternion, at times stretched, mirrored or sheared. */
static void pick_linear(random_source *r, rg_pose *pose) {
    double q[4], l = 0;
    do {
        l = 0;
        for (int i = 0; i < 4; i++) q[i] = random_between(r, -1, 1), l += q[i] * q[i];
    } while (l > 1 || l < 1e-3);
    for (int i = 0; i < 4; i++) q[i] /= sqrt(l);
    double w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    uint32_t kind = random_below(r, 3);
    for (int i = 0; i < 9; i++) {
        double stretch = kind == 0 ? 1 : i % 3 == 1 ? -0.5 : i % 3 == 2 ? 1.5 : 1;
        double shear = kind == 2 && i % 3 == 0 ? 0.25 * turn[i + 1] : 0;
        pose->linear[i] = (float)(stretch * turn[i] + shear);
    }
}

static rg_pose pick_pose(random_source *r, const golden_set *set) {
    rg_pose pose = rg_pose_at(0, 0, 0);
    for (int i = 0; i < 3; i++) {
        pose.position[i] = set->space.centre[i] + random_between(r, -1, 1) * set->space.spread;
        if (set->round) pose.position[i] = floor(pose.position[i]);
    }
    if (set->round) return pose;
    pose.scale = random_decade(r, set->least_decade, set->most_decade);
    if (!set->balls && random_once_in(r, 2)) pick_linear(r, &pose);
    return pose;
}

/* Rays along axes through corners, edges, faces and silhouettes of what is round. */
static void pick_round(random_source *r, const golden_set *set, rg_ray *ray) {
    double origin[3], direction[3];
    do {
        for (int i = 0; i < 3; i++) direction[i] = (double)random_below(r, 3) - 1;
    } while (direction[0] == 0 && direction[1] == 0 && direction[2] == 0);
    for (int i = 0; i < 3; i++) {
        double at = floor(random_between(r, -1, 1) * set->space.spread);
        origin[i] = at + 0.5 * random_below(r, 2) - 32 * direction[i];
        if (direction[i] == 0 && random_once_in(r, 2)) direction[i] = -0.0;
    }
    *ray = rg_ray_from(origin, direction);
}

static void pick_lone(random_source *r, const golden_data *g, rg_ray *ray) {
    double origin[3], target[3], direction[3];
    const rg_pose *aim = &g->poses[random_below(r, (uint32_t)g->objects)];
    double size = aim->scale > 0 ? aim->scale : 1, away = random_once_in(r, 8) ? 1e6 : random_between(r, 0, 4);
    random_direction(r, direction);
    for (int i = 0; i < 3; i++) {
        target[i] = aim->position[i] + size * random_between(r, -1.2, 1.2);
        origin[i] = target[i] - direction[i] * away * g->set->space.spread;
        direction[i] = target[i] - origin[i];
    }
    *ray = rg_ray_from(origin, direction);
    if (random_once_in(r, 6)) ray->t_max = random_between(r, 0, 1.5);
    if (random_once_in(r, 8)) ray->t_min = fmin(ray->t_max, random_between(r, -1, 1.5));
    if (random_once_in(r, 20)) ray->mask = UINT32_C(1) << random_below(r, 8);
}

void golden_make(golden_data *g, const golden_set *set) {
    random_source r = {20003};
    memset(g, 0, sizeof *g);
    g->set = set;
    g->objects = set->objects;
    g->rays = set->rays;
    make_shapes(g);
    for (int i = 0; i < g->objects; i++) {
        g->shape_of[i] = (int)random_below(&r, (uint32_t)g->shape_count);
        g->poses[i] = pick_pose(&r, set);
        g->masks[i] = set->masked && random_once_in(&r, 2) ? UINT32_C(1) << random_below(&r, 8) : UINT32_MAX;
    }
    for (int i = 0; i < g->rays;) {
        int left = g->rays - i, count = 1 + (int)random_below(&r, 200);
        if (count > left) count = left;
        uint32_t kind = random_below(&r, 4);
        for (int k = 0; k < count && kind < 2; k++) {
            if (set->round && kind == 0)
                pick_round(&r, set, &g->ray[i + k]);
            else
                pick_lone(&r, g, &g->ray[i + k]);
        }
        if (kind >= 2) batch_rays(&r, &set->space, &g->ray[i], (uint32_t)count);
        i += count;
    }
}

void golden_release(golden_data *g) {
    for (int i = 0; i < g->shape_count; i++) rg_shape_release(&g->shapes[i]);
}

/* --------------------------------------------------------------------------------------------------- hash */

/* FNV-1a, of 64 bits at once. */
static void mix(uint64_t *hash, uint64_t value) {
    *hash = (*hash ^ value) * UINT64_C(0x100000001B3);
    *hash ^= *hash >> 29;
}

static void mix_double(uint64_t *hash, double x) {
    uint64_t bits;
    if (isnan(x)) x = 0, mix(hash, 1);
    memcpy(&bits, &x, sizeof bits);
    mix(hash, bits);
}

uint64_t golden_hash(const rg_hit *hits, const uint8_t *occluded, int count) {
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (int i = 0; i < count; i++) {
        const rg_hit *h = &hits[i];
        mix_double(&hash, h->t);
        mix(&hash, h->object);
        for (int k = 0; k < 3; k++) {
            mix_double(&hash, h->position[k]);
            mix_double(&hash, h->normal[k]);
        }
        mix_double(&hash, h->offset);
        mix_double(&hash, h->u);
        mix_double(&hash, h->v);
        mix(&hash, (uint64_t)h->primitive << 8 | occluded[i]);
    }
    return hash;
}
