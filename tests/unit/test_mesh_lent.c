/* SPDX-License-Identifier: MIT */
/*
 * Meshes whose data stays with the host: they answer as those that have copied it, to the last bit, however the data
 * lies and whatever asks; and `released` is called once, when nothing reads it any more. The memory that is lent is
 * exactly as large as the data, and is overwritten and freed by that call.
 */
#include "byte_sink.h"
#include "machine.h"
#include "shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { AROUND = 20, RINGS = 12, VERTICES = RINGS * AROUND + 2, TRIANGLES = 2 * RINGS * AROUND, RAYS = 256 };

/* What a view is over: bytes of a number, and where the first record begins, all records, and components. */
typedef struct lie {
    rg_type type;
    int before, stride, apart;
} lie;

/* Packed; records of more, nowhere aligned; backward; arrays of their own; all records in one. */
static const lie VERTEX_LIES[] = {{RG_F64, 0, 24, 8},   {RG_F64, 3, 37, 9}, {RG_F64, 0, -24, 8}, {RG_F64, 0, 8, 0},
                                  {RG_F64, 8, -40, -8}, {RG_F32, 0, 12, 4}, {RG_F32, 1, 19, 5},  {RG_F32, 0, -4, 0}};
static const lie INDEX_LIES[] = {{RG_U16, 0, 6, 2},  {RG_U16, 1, 7, 2},   {RG_U16, 0, -2, 0},
                                 {RG_U32, 0, 12, 4}, {RG_U32, 5, 23, 6},  {RG_U32, 0, -12, 4},
                                 {RG_U64, 0, 24, 8}, {RG_U64, 3, -27, 8}, {RG_U64, 0, 8, 0}};
enum { VERTEX_WAYS = sizeof VERTEX_LIES / sizeof *VERTEX_LIES, INDEX_WAYS = sizeof INDEX_LIES / sizeof *INDEX_LIES };

/* Triangles that share vertices; that share none, in order; and by indices in another order. */
enum { CONNECTED, SOUP, SOUP_WITH_INDICES, KINDS };

typedef struct loan {
    char *vertices, *indices; /* of these sizes; NULL: given back */
    size_t vertex_bytes, index_bytes;
    rg_mesh_views views;
    int released;
} loan;

/* ---------------------------------------------------------------------------------------------------- the data */

/* A closed surface with bumps around a point that is no float; floats are of a size at which no frame takes them. */
static void vertex_of(uint32_t i, double phase, rg_type type, double out[3]) {
    const double pi = acos(-1), size = type == RG_F32 ? 0x1p50 : 1;
    double polar = pi * (i / AROUND + 1) / (RINGS + 1), around = 2 * pi * (i % AROUND) / AROUND;
    double radius = 1 + 0.1 * sin(5 * around + phase) * sin(4 * polar);
    if (i >= RINGS * AROUND) polar = i % 2 ? pi : 0, radius = 1;
    out[0] = size * (0.1 + radius * sin(polar) * cos(around));
    out[1] = size * radius * sin(polar) * sin(around);
    out[2] = size * (0.3 + radius * cos(polar));
}

static void triangle_of(uint32_t i, uint32_t out[3]) {
    uint32_t r = i / (2 * AROUND), s = i / 2 % AROUND, t = (s + 1) % AROUND, up = r * AROUND, down = up + AROUND;
    if (r == RINGS - 1)
        memcpy(out, i % 2 ? (uint32_t[]){t, s, VERTICES - 2} : (uint32_t[]){up + s, up + t, VERTICES - 1}, 12);
    else
        memcpy(out, i % 2 ? (uint32_t[]){up + s, down + t, up + t} : (uint32_t[]){up + s, down + s, down + t}, 12);
}

/* The number that a soup gives to a corner. */
static uint32_t corner_of(int kind, uint32_t triangle, uint32_t corner) {
    return 3 * (kind == SOUP ? triangle : (7 * triangle + 3) % TRIANGLES) + corner;
}

static int width(rg_type type) {
    return type == RG_U16 ? 2 : type == RG_F32 || type == RG_U32 ? 4 : 8;
}

/* Memory for records that lie so, no byte more, and the view over it. apart 0: each component has an array of its
 * own. */
static rg_input3 lay(const lie *l, uint64_t count, char **memory, size_t *bytes) {
    size_t reach = (size_t)(abs(l->stride) * (int64_t)(count - 1)),
           all = (size_t)(2 * abs(l->apart) + width(l->type));
    size_t column = reach + (size_t)width(l->type);
    *bytes = (size_t)l->before + (l->apart ? reach + all : 3 * column);
    *memory = malloc(*bytes);
    ck_assert_ptr_nonnull(*memory);
    memset(*memory, 0x5A, *bytes);
    char *x = *memory + l->before + (l->stride < 0 ? reach : 0) + (l->apart < 0 ? -2 * l->apart : 0);
    ptrdiff_t apart = l->apart ? l->apart : (ptrdiff_t)column;
    return (rg_input3){x, x + apart, x + 2 * apart, l->stride, l->type};
}

static void put(const rg_input3 *view, uint64_t i, const double value[3]) {
    const void *const columns[3] = {view->x, view->y, view->z};
    for (int a = 0; a < 3; a++) {
        char *at = (char *)columns[a] + view->stride * (ptrdiff_t)i;
        if (view->type == RG_F64 || view->type == RG_F32)
            rgi_write_float(at, view->type, value[a]);
        else if (view->type == RG_U16)
            memcpy(at, &(uint16_t){(uint16_t)value[a]}, 2);
        else
            rgi_write_integer(at, view->type, (uint64_t)value[a]);
    }
}

static void fill_soup(loan *l, int kind, double phase) {
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        uint32_t corners[3];
        double v[3], numbers[3];
        triangle_of(i, corners);
        for (uint32_t c = 0; c < 3; c++) {
            numbers[c] = corner_of(kind, i, c);
            vertex_of(corners[c], phase, l->views.vertices.type, v);
            put(&l->views.vertices, (uint64_t)numbers[c], v);
        }
        if (kind == SOUP_WITH_INDICES) put(&l->views.indices, i, numbers);
    }
}

static void fill_connected(loan *l, double phase) {
    for (uint32_t i = 0; i < VERTICES; i++) {
        double v[3];
        vertex_of(i, phase, l->views.vertices.type, v);
        put(&l->views.vertices, i, v);
    }
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        uint32_t corners[3];
        triangle_of(i, corners);
        put(&l->views.indices, i, (double[]){corners[0], corners[1], corners[2]});
    }
}

static void give_back(void *user) {
    loan *l = user;
    l->released++;
    memset(l->vertices, 0xFF, l->vertex_bytes);
    if (l->indices) memset(l->indices, 0xFF, l->index_bytes);
    free(l->vertices);
    free(l->indices);
    l->vertices = l->indices = NULL;
}

static void lend(loan *l, int kind, int vertices, int indices, double phase) {
    memset(l, 0, sizeof *l);
    l->views.size = sizeof l->views;
    l->views.vertex_count = kind == CONNECTED ? VERTICES : 3 * TRIANGLES;
    l->views.triangle_count = TRIANGLES;
    l->views.released = give_back;
    l->views.user = l;
    l->views.vertices = lay(&VERTEX_LIES[vertices], l->views.vertex_count, &l->vertices, &l->vertex_bytes);
    if (kind != SOUP) l->views.indices = lay(&INDEX_LIES[indices], TRIANGLES, &l->indices, &l->index_bytes);
    if (kind == CONNECTED)
        fill_connected(l, phase);
    else
        fill_soup(l, kind, phase);
}

static rg_shape *make(const loan *l, bool copy, const rg_shape *old, const rg_shape_config *config) {
    rg_mesh_views views = l->views;
    rg_shape *shape;
    if (copy) views.released = NULL;
    ck_assert_int_eq(old ? rg_shape_create_deformed(config, old, &views, &shape)
                         : rg_shape_create_mesh(config, &views, &shape),
                     RG_OK);
    return shape;
}

static uint64_t bytes_of(const rg_shape *shape) {
    rg_shape_report report = {.size = sizeof report};
    ck_assert_int_eq(rg_shape_stats(shape, &report), RG_OK);
    return report.bytes;
}

/* ---------------------------------------------------------------------------------------------------- the rays */

typedef struct answers {
    rg_hit hits[RAYS], alone[RAYS];
    uint8_t any[RAYS];
} answers;

/* The first half from one eye, near to each other; the others from anywhere to anywhere. Two objects, one mirrored
 * and turned. */
static void aim(rg_ray rays[RAYS], double size) {
    for (int i = 0; i < RAYS; i++) {
        double from[3] = {0, 0, -6 * size}, to[3];
        for (int a = 0; a < 3; a++) {
            if (i >= RAYS / 2) from[a] = 4 * size * (unit_random() - 0.5);
            to[a] = 2 * size * (unit_random() - 0.5) + 3 * size * (i / 16 % 2 && a == 0) - from[a];
        }
        rays[i] = rg_ray_from(from, to);
    }
}

static void ask(rg_shape *shape, const rg_ray rays[RAYS], double size, answers *a) {
    rg_scene *scene;
    rg_pose pose = rg_pose_at(0, 0, 0), mirrored = rg_pose_at(3 * size, 0, 0);
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    mirrored.linear[0] = -1;
    mirrored.linear[1] = 0.5f;
    memset(a, 0, sizeof *a);
    ck_assert_int_eq(rg_scene_create(&config, &scene), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, NULL), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, shape, &mirrored, NULL), RG_OK);
    ck_assert_int_eq(rg_scene_trace(scene, rays, a->hits, RAYS), RG_OK);
    ck_assert_int_eq(rg_scene_occluded(scene, rays, a->any, RAYS), RG_OK);
    for (int i = 0; i < RAYS; i++) ck_assert_int_eq(rg_scene_trace(scene, &rays[i], &a->alone[i], 1), RG_OK);
    ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
}

static void demand_same(rg_shape *lent, rg_shape *copied, double size) {
    static answers one, other;
    rg_ray rays[RAYS];
    int met = 0;
    aim(rays, size);
    ask(lent, rays, size, &one);
    ask(copied, rays, size, &other);
    ck_assert_int_eq(memcmp(&one, &other, sizeof one), 0);
    for (int i = 0; i < RAYS; i++) met += one.any[i];
    ck_assert_int_gt(met, RAYS / 8);
}

/* ---------------------------------------------------------------------------------------------------- the tests */

/* With every kernel, where builds let it be chosen. */
START_TEST(no_bit_depends_on_it) {
    for (int k = 0; k < MACHINE_KERNELS; k++) {
        ck_assert_int_eq(setenv("RAYGRID_ISA", machine_kernels[k]->name, 1), 0);
        for (int kind = 0; kind < KINDS; kind++) {
            for (int i = 0; i < VERTEX_WAYS * INDEX_WAYS; i++) {
                const rg_shape_config config = {.size = sizeof config,
                                                .quality = i % 2 ? RG_MESH_FAST : RG_MESH_BEST};
                loan l;
                if (kind == SOUP && i >= VERTEX_WAYS) continue;
                lend(&l, kind, i % VERTEX_WAYS, i / VERTEX_WAYS, i);
                rg_shape *copied = make(&l, true, NULL, &config), *lent = make(&l, false, NULL, &config);
                ck_assert_int_eq(l.released, 0);
                demand_same(lent, copied, l.views.vertices.type == RG_F32 ? 0x1p50 : 1);
                ck_assert_uint_eq(bytes_of(copied) - bytes_of(lent),
                                  24 * l.views.vertex_count + (kind == SOUP_WITH_INDICES ? 12 * TRIANGLES : 0));
                rg_shape_release(&lent);
                ck_assert_int_eq(l.released, 1);
                rg_shape_release(&copied);
            }
        }
    }
    ck_assert_int_eq(unsetenv("RAYGRID_ISA"), 0);
}
END_TEST

/* Fitted and made anew, of a mesh that has borrowed and one that has not, which go before the new one is asked. */
START_TEST(new_vertices_are_borrowed_too) {
    for (int i = 0; i < KINDS * VERTEX_WAYS; i++) {
        loan first, second, third;
        int kind = i / VERTEX_WAYS, way = i % VERTEX_WAYS;
        double size = VERTEX_LIES[way].type == RG_F32 ? 0x1p50 : 1;
        lend(&first, kind, way, i % INDEX_WAYS, 0);
        lend(&second, kind, way, i % INDEX_WAYS, 0.1);
        lend(&third, kind, way, i % INDEX_WAYS, 0.2);
        for (uint64_t v = 0; v < third.views.vertex_count; v++)
            put(&third.views.vertices, v,
                (double[]){size * unit_random(), size * unit_random(), size * unit_random()});
        rg_shape *old = make(&first, i % 2, NULL, NULL);
        rg_shape *lent = make(&second, false, old, NULL), *copied = make(&second, true, old, NULL);
        rg_shape *shuffled = make(&third, false, lent, NULL), *fresh = make(&third, true, copied, NULL);
        rg_shape_release(&old);
        if (i % 2) give_back(&first);
        ck_assert(first.released == 1 && second.released == 0 && third.released == 0);
        demand_same(lent, copied, size);
        rg_shape_release(&lent);
        ck_assert(second.released == 1 && third.released == 0);
        demand_same(shuffled, fresh, size);
        /* Corners are those of the mesh before, which may have gone: they are never the caller's. */
        ck_assert_uint_eq(bytes_of(fresh) - bytes_of(shuffled), 24 * third.views.vertex_count);
        rg_shape_release(&shuffled);
        ck_assert_int_eq(third.released, 1);
        rg_shape_release(&copied);
        rg_shape_release(&fresh);
    }
}
END_TEST

/* Vertices that the tree has as they are: nothing is read after the call, and the memory is free at once. */
START_TEST(what_is_not_needed_is_given_back_at_once) {
    const double home[3] = {0, 0, 0};
    for (int kind = 0; kind < KINDS; kind++) {
        loan l, bent;
        lend(&l, kind, 0, 0, 0);
        for (uint64_t v = 0; v < l.views.vertex_count; v++)
            put(&l.views.vertices, v, (double[]){(double)(v % 97), (double)(v % 61), (double)(v % 13)});
        rg_shape *shape = make(&l, false, NULL, NULL);
        ck_assert_int_eq(l.released, kind != SOUP_WITH_INDICES);
        lend(&bent, kind, 0, 0, 0);
        for (uint64_t v = 0; v < l.views.vertex_count; v++) put(&bent.views.vertices, v, home);
        put(&bent.views.vertices, 1, (double[]){1, 0, 0});
        rg_shape *other = make(&bent, false, shape, NULL);
        ck_assert_int_eq(bent.released, 1);
        rg_shape_release(&shape);
        ck_assert_int_eq(l.released, 1);
        rg_shape_release(&other);
        ck_assert_int_eq(bent.released, 1);
    }
}
END_TEST

START_TEST(who_fails_gives_nothing_back) {
    loan l;
    rg_shape *shape = NULL, *ball;
    lend(&l, SOUP_WITH_INDICES, 0, 3, 0);
    rg_mesh_views views = l.views;
    rg_shape_config config = {.size = sizeof config, .quality = 7};
    ck_assert_int_eq(rg_shape_create_mesh(&config, &views, &shape), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, NULL), RG_INVALID_ARGUMENT);
    put(&views.indices, TRIANGLES - 1, (double[]){0, 1, 3 * TRIANGLES});
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, &shape), RG_INVALID_VALUE);
    put(&views.vertices, 4, (double[]){0, NAN, 0});
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &views, &shape), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_shape_create_sphere(NULL, 1, &ball), RG_OK);
    ck_assert_int_eq(rg_shape_create_deformed(NULL, ball, &views, &shape), RG_INVALID_ARGUMENT);
    rg_shape_release(&ball);
    ck_assert_ptr_null(shape);
    ck_assert_int_eq(l.released, 0);
    give_back(&l);
}
END_TEST

/* Callers of the version before have no such fields: what they give is copied. */
START_TEST(views_of_old_have_no_such_fields) {
    loan l;
    rg_shape *shape;
    lend(&l, CONNECTED, 0, 3, 0);
    l.views.size = offsetof(rg_mesh_views, released);
    ck_assert_int_eq(rg_shape_create_mesh(NULL, &l.views, &shape), RG_OK);
    ck_assert_int_eq(l.released, 0);
    give_back(&l);
    uint64_t bytes = bytes_of(shape);
    ck_assert_uint_gt(bytes, 24 * VERTICES);
    rg_shape_release(&shape);
    ck_assert_int_eq(l.released, 1);
}
END_TEST

/* Objects, frames and recordings hold on to it. */
START_TEST(all_who_hold_the_mesh_hold_the_data) {
    loan l, bent;
    rg_scene *scene, *frame;
    rg_object object;
    byte_sink written = {0};
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    const rg_pose pose = rg_pose_at(0, 0, 0);
    const rg_sink sink = byte_sink_sink(&written);
    lend(&l, CONNECTED, 1, 4, 0);
    lend(&bent, CONNECTED, 1, 4, 1);
    rg_shape *shape = make(&l, false, NULL, NULL), *other = make(&bent, false, shape, NULL);
    ck_assert_int_eq(rg_scene_create(&config, &scene), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, &object), RG_OK);
    ck_assert_int_eq(rg_scene_create_frame(scene, &config, &frame), RG_OK);
    ck_assert_int_eq(rg_scene_record(scene, &sink), RG_OK);
    ck_assert_int_eq(rg_scene_replace_shape(scene, shape, other), RG_OK);
    rg_shape_release(&shape);
    rg_shape_release(&other);
    ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
    ck_assert_int_eq(l.released, 0);
    ck_assert_int_eq(rg_scene_record(scene, NULL), RG_OK);
    ck_assert_int_eq(l.released, 1);
    ck_assert_int_eq(rg_scene_remove(scene, object), RG_OK);
    ck_assert_int_eq(bent.released, 0);
    ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
    ck_assert_int_eq(bent.released, 1);
    ck_assert_int_eq(rg_scene_destroy(&frame), RG_OK);
    ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
    ck_assert(l.released == 1 && bent.released == 1);
    byte_sink_free(&written);
}
END_TEST

/* As the bytes of the mesh that has copied its data; and what is loaded has all of its own. */
START_TEST(saved_as_any_mesh) {
    for (int i = 0; i < KINDS * VERTEX_WAYS; i++) {
        byte_sink saved[2] = {{0}, {0}};
        loan l;
        rg_scene *scene;
        const rg_pose pose = rg_pose_at(0, 0, 0);
        const rg_scene_config config = {.size = sizeof config, .workers = 1};
        lend(&l, i / VERTEX_WAYS, i % VERTEX_WAYS, i % INDEX_WAYS, 0);
        for (int copy = 1; copy >= 0; copy--) {
            rg_shape *shape = make(&l, copy, NULL, NULL);
            const rg_sink sink = byte_sink_sink(&saved[copy]);
            ck_assert_int_eq(rg_scene_create(&config, &scene), RG_OK);
            ck_assert_int_eq(rg_scene_insert(scene, shape, &pose, NULL), RG_OK);
            rg_shape_release(&shape);
            ck_assert_int_eq(rg_scene_save(scene, &sink), RG_OK);
            ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
        }
        ck_assert_int_eq(l.released, 1);
        ck_assert(byte_sink_equal(&saved[0], &saved[1]));
        const rg_source source = byte_sink_source(&saved[0]);
        ck_assert_int_eq(rg_scene_load(&config, &source, &scene), RG_OK);
        ck_assert_int_eq(rg_scene_destroy(&scene), RG_OK);
        ck_assert_int_eq(l.released, 1);
        for (int k = 0; k < 2; k++) byte_sink_free(&saved[k]);
    }
}
END_TEST

/* Against the rules: whatever is met then, nothing else is read, which the address sanitizer holds. */
START_TEST(data_that_changes_leads_nowhere_else) {
    static answers a;
    rg_ray rays[RAYS];
    for (int i = 0; i < KINDS * VERTEX_WAYS; i++) {
        loan l, bent;
        int kind = i / VERTEX_WAYS, way = i % VERTEX_WAYS;
        double size = VERTEX_LIES[way].type == RG_F32 ? 0x1p50 : 1;
        lend(&l, kind, way, i % INDEX_WAYS, 0);
        lend(&bent, kind, way, i % INDEX_WAYS, 1);
        rg_shape *shape = make(&l, false, NULL, NULL);
        aim(rays, size);
        for (int filling = 0; filling < 2; filling++) {
            for (size_t at = 0; at < l.vertex_bytes; at++)
                l.vertices[at] = (char)(filling ? 256 * unit_random() : 0xFF);
            for (size_t at = 0; at < l.index_bytes; at++)
                l.indices[at] = (char)(filling ? 256 * unit_random() : 0xFF);
            ask(shape, rays, size, &a);
            rg_shape *other = make(&bent, true, shape, NULL);
            ask(other, rays, size, &a);
            rg_shape_release(&other);
        }
        rg_shape_release(&shape);
        ck_assert_int_eq(l.released, 1);
        give_back(&bent);
    }
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("mesh_lent");
    TCase *tests = tcase_create("mesh_lent");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, no_bit_depends_on_it);
    tcase_add_test(tests, new_vertices_are_borrowed_too);
    tcase_add_test(tests, what_is_not_needed_is_given_back_at_once);
    tcase_add_test(tests, who_fails_gives_nothing_back);
    tcase_add_test(tests, views_of_old_have_no_such_fields);
    tcase_add_test(tests, all_who_hold_the_mesh_hold_the_data);
    tcase_add_test(tests, saved_as_any_mesh);
    tcase_add_test(tests, data_that_changes_leads_nowhere_else);
    suite_add_tcase(suite, tests);
    return suite;
}
