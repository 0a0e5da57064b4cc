/* SPDX-License-Identifier: MIT */
/* Snapshots: what is loaded is what was saved; and what is not a snapshot is refused, with a message that says where.
 */
#include "saved_scene.h"
#include "scene.h"
#include "unit.h"

#include <stdio.h>

static const rg_grid_kind KINDS[] = {RG_GRID_LOOSE, RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL};

static rg_scene *load(const byte_sink *bytes, uint32_t workers) {
    const rg_source source = saved_scene_source(bytes);
    const rg_scene_config config = {.size = sizeof config, .workers = workers};
    rg_scene *scene = NULL;
    ck_assert_msg(rg_scene_load(&config, &source, &scene) == RG_OK, "%s", rg_error_message());
    return scene;
}

/* ---------------------------------------------------------------------------------------------- what is saved */

START_TEST(same_bytes_and_same_answers) {
    rg_hit before[SAVED_RAYS], after[SAVED_RAYS];
    saved_scene s;
    byte_sink first = {0}, second = {0};
    saved_scene_make(&s, KINDS[_i], 1);
    saved_scene_save(s.scene, &first);
    saved_scene_trace(s.scene, before);
    rg_scene *loaded = load(&first, 2);
    saved_scene_trace(loaded, after);
    ck_assert_mem_eq(before, after, sizeof before);
    saved_scene_save(loaded, &second);
    ck_assert(byte_sink_equal(&first, &second));
    rg_scene_destroy(&loaded);
    saved_scene_end(&s);
    byte_sink_free(&first);
    byte_sink_free(&second);
}
END_TEST

START_TEST(later_calls_give_the_same_ids) {
    rg_hit before[SAVED_RAYS], after[SAVED_RAYS];
    saved_scene s;
    byte_sink bytes = {0}, own = {0}, others = {0};
    saved_scene_make(&s, KINDS[_i], 1);
    saved_scene_save(s.scene, &bytes);
    saved_scene other = s;
    other.scene = load(&bytes, 1);
    for (int i = 0; i < SAVED_SHAPES; i++) { /* shapes of its own */
        rg_object_report report = {.size = sizeof report};
        ck_assert_int_eq(rg_scene_lookup(other.scene, s.objects[i], &report), RG_OK);
        other.shapes[i] = report.shape;
        rg_shape_retain(report.shape);
    }
    other.forms[0] = other.shapes[4];
    for (int i = 0; i < 2; i++) rg_shape_retain(other.forms[i]);
    for (uint32_t turn = 0; turn < 30; turn++) {
        saved_scene_change(&s, turn);
        saved_scene_change(&other, turn);
    }
    saved_scene_save(s.scene, &own);
    saved_scene_save(other.scene, &others);
    ck_assert(byte_sink_equal(&own, &others));
    saved_scene_trace(s.scene, before);
    saved_scene_trace(other.scene, after);
    ck_assert_mem_eq(before, after, sizeof before);
    saved_scene_end(&other);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
    byte_sink_free(&own);
    byte_sink_free(&others);
}
END_TEST

START_TEST(an_empty_scene) {
    rg_scene *scene;
    byte_sink first = {0}, second = {0};
    ck_assert_int_eq(rg_scene_create(NULL, &scene), RG_OK);
    saved_scene_save(scene, &first);
    rg_scene *loaded = load(&first, 1);
    saved_scene_save(loaded, &second);
    ck_assert(byte_sink_equal(&first, &second));
    rg_scene_destroy(&scene);
    rg_scene_destroy(&loaded);
    byte_sink_free(&first);
    byte_sink_free(&second);
}
END_TEST

START_TEST(retired_slots_and_places_stay_retired) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_object object;
    rg_grid grid;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    uint32_t slot = RG_OBJECT_SLOT(s.objects[8]);
    rgi_scene_object(s.scene, slot)->generation = UINT32_MAX;
    ck_assert_int_eq(rg_scene_remove(s.scene, (rg_object)UINT32_MAX << 32 | slot), RG_OK);
    s.scene->grids[1].generation = RGI_GENERATIONS; /* the place that is free */
    saved_scene_save(s.scene, &bytes);
    rg_scene *loaded = load(&bytes, 1);
    for (uint32_t i = 0; i < 8; i++) {
        ck_assert_int_eq(rg_scene_insert(loaded, s.shapes[0], NULL, &object), RG_OK);
        ck_assert_uint_ne(RG_OBJECT_SLOT(object), slot);
    }
    ck_assert_int_eq(rg_grid_create(loaded, NULL, &grid), RG_OK);
    ck_assert_uint_eq(grid, 1 << 8 | 3);
    rg_scene_destroy(&loaded);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* A frame is saved while its scene goes on; what is loaded is a scene of its own. */
START_TEST(a_frame) {
    rg_hit before[SAVED_RAYS], after[SAVED_RAYS];
    saved_scene s;
    byte_sink bytes = {0}, again = {0};
    rg_scene *frame;
    rg_object object;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    ck_assert_int_eq(rg_scene_create_frame(s.scene, NULL, &frame), RG_OK);
    saved_scene_change(&s, 0);
    ck_assert_int_eq(rg_scene_update_frame(frame), RG_OK);
    saved_scene_trace(s.scene, before);
    saved_scene_change(&s, 1);
    const rg_sink sink = saved_scene_sink(&bytes);
    ck_assert_int_eq(rg_scene_record(frame, &sink), RG_BUSY);
    saved_scene_save(frame, &bytes);
    rg_scene *loaded = load(&bytes, 1);
    saved_scene_trace(loaded, after);
    ck_assert_mem_eq(before, after, sizeof before);
    saved_scene_save(loaded, &again);
    ck_assert(byte_sink_equal(&bytes, &again));
    ck_assert_int_eq(rg_scene_insert(loaded, s.shapes[0], NULL, &object), RG_OK);
    ck_assert_uint_eq(RG_OBJECT_SLOT(object), 15); /* the lowest that saved_scene_make has left free */
    rg_scene_destroy(&loaded);
    rg_scene_destroy(&frame);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
    byte_sink_free(&again);
}
END_TEST

START_TEST(at_any_address) {
    saved_scene s;
    byte_sink bytes = {0}, again = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    unsigned char *moved = malloc(bytes.size + 3);
    memcpy(moved + 3, bytes.bytes, bytes.size);
    const byte_sink odd = {.bytes = moved + 3, .size = bytes.size};
    rg_scene *loaded = load(&odd, 1);
    free(moved);
    saved_scene_save(loaded, &again);
    ck_assert(byte_sink_equal(&bytes, &again));
    rg_scene_destroy(&loaded);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
    byte_sink_free(&again);
}
END_TEST

START_TEST(shapes_come_from_their_allocator_and_die_with_the_scene) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_object_report report = {.size = sizeof report};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    rg_scene *loaded = load(&bytes, 1);
    ck_assert_int_eq(rg_scene_lookup(loaded, s.objects[4], &report), RG_OK);
    rg_shape *mesh = report.shape;
    rg_shape_report shape = {.size = sizeof shape};
    ck_assert_int_eq(rg_shape_stats(mesh, &shape), RG_OK);
    ck_assert_int_eq(shape.kind, RG_SHAPE_MESH);
    ck_assert_uint_eq(shape.triangle_count, 7);
    rg_shape_retain(mesh);
    rg_scene_destroy(&loaded);
    ck_assert_int_eq(rg_shape_stats(mesh, &shape), RG_OK); /* the last reference: leaks are found by the sanitizer */
    rg_shape_release(&mesh);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* ------------------------------------------------------------------------------------------------ arguments */

START_TEST(arguments_are_checked) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *scene = NULL;
    rg_replay *replay = NULL;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    rg_sink sink = saved_scene_sink(&bytes);
    ck_assert_int_eq(rg_scene_save(NULL, &sink), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_save(s.scene, NULL), RG_INVALID_ARGUMENT);
    sink.size = 8;
    ck_assert_int_eq(rg_scene_save(s.scene, &sink), RG_INVALID_ARGUMENT);
    sink = saved_scene_sink(&bytes);
    sink.write = NULL;
    ck_assert_int_eq(rg_scene_save(s.scene, &sink), RG_INVALID_ARGUMENT);
    ck_assert_uint_eq(bytes.size, 0);
    saved_scene_save(s.scene, &bytes);
    rg_source source = saved_scene_source(&bytes);
    ck_assert_int_eq(rg_scene_load(NULL, &source, NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_scene_load(NULL, NULL, &scene), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_replay_create(NULL, &source, &replay, NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_replay_create(NULL, &source, NULL, &scene), RG_INVALID_ARGUMENT);
    source.bytes = NULL;
    ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_INVALID_ARGUMENT);
    source = saved_scene_source(&bytes);
    source.size = 1;
    ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_INVALID_ARGUMENT);
    source = saved_scene_source(&bytes);
    const rg_scene_config config = {.size = sizeof config, .workers = 5000};
    ck_assert_int_eq(rg_scene_load(&config, &source, &scene), RG_INVALID_VALUE);
    ck_assert_ptr_null(scene);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(a_sink_that_fails) {
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    size_t whole = bytes.size;
    ck_assert_uint_gt(bytes.calls, 1);
    for (size_t most = 1; most < whole; most += 1000) {
        byte_sink short_of = {.most = most};
        const rg_sink sink = saved_scene_sink(&short_of);
        ck_assert_int_eq(rg_scene_save(s.scene, &sink), RG_CALLBACK_FAILED);
        ck_assert_ptr_nonnull(strstr(rg_error_message(), "returned 7"));
        byte_sink_free(&short_of);
    }
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

static int32_t change_scene(void *user, const void *bytes, size_t size) {
    saved_scene *s = user;
    rg_scene_report report = {.size = sizeof report};
    const rg_sink sink = {.size = sizeof sink, .user = s, .write = change_scene};
    rg_scene *scene = s->scene;
    (void)bytes, (void)size;
    if (rg_scene_remove(s->scene, s->objects[0]) != RG_BUSY) return 1;
    if (rg_scene_record(s->scene, &sink) != RG_BUSY) return 2;
    if (rg_scene_destroy(&scene) != RG_BUSY) return 3;
    return rg_scene_stats(s->scene, &report) != RG_OK;
}

static int32_t no_number(void *user, const rg_shape *shape, void *shape_user, uint64_t *number) {
    (void)user, (void)shape, (void)shape_user, (void)number;
    return 1;
}

START_TEST(a_sink_may_read_and_not_change) {
    saved_scene s;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    rg_sink sink = saved_scene_sink(NULL);
    sink.user = &s;
    sink.write = change_scene;
    ck_assert_msg(rg_scene_save(s.scene, &sink) == RG_OK, "%s", rg_error_message());
    saved_scene_end(&s);
}
END_TEST

START_TEST(user_defined_shapes_need_numbers) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *scene = NULL;
    char object[32];
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    snprintf(object, sizeof object, "object 0x%llx:", (unsigned long long)s.objects[7]);
    rg_sink sink = byte_sink_sink(&bytes);
    ck_assert_int_eq(rg_scene_save(s.scene, &sink), RG_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), object));
    sink.number_shape = no_number;
    ck_assert_int_eq(rg_scene_save(s.scene, &sink), RG_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), object));
    bytes.size = 0;
    saved_scene_save(s.scene, &bytes);
    const rg_source source = byte_sink_source(&bytes);
    ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_INVALID_DATA);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "find_shape is NULL"));
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

static int32_t hit_nothing(void *user, const rg_local_ray *ray, rg_local_hit *hit) {
    (void)user, (void)ray, (void)hit;
    return 0;
}

/* What a host that finds the wrong shapes gives. */
static int32_t find_wrong(void *user, uint64_t number, const double lo[3], const double hi[3], rg_shape **shape) {
    static const double LO[3] = {-1, -1, -1}, HI[3] = {1, 1, 1};
    const rg_user_shape other = {.size = sizeof other, .lo = {-1, -1, -1}, .hi = {1, 1, 1}, .intersect = hit_nothing};
    (void)number, (void)lo, (void)hi;
    switch (*(const int *)user) {
    case 0:
        return -1;
    case 1:
        return 0; /* and leaves *shape */
    case 2:
        return rg_shape_create_box(NULL, LO, HI, shape);
    default:
        return rg_shape_create_user(NULL, &other, shape);
    }
}

START_TEST(user_defined_shapes_must_be_found_again) {
    static const char *const TEXTS[] = {"has no shape", "gave NULL", "not user-defined", "another box"};
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *scene = NULL;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    rg_source source = byte_sink_source(&bytes);
    source.find_shape = find_wrong;
    for (int i = 0; i < 4; i++) {
        source.user = &i;
        ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_CALLBACK_FAILED);
        ck_assert_msg(strstr(rg_error_message(), TEXTS[i]) != NULL, "%s", rg_error_message());
    }
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("snapshot_save");
    TCase *c = tcase_create("snapshot_save");
    tcase_set_timeout(c, 0);
    tcase_add_loop_test(c, same_bytes_and_same_answers, 0, 3);
    tcase_add_loop_test(c, later_calls_give_the_same_ids, 0, 3);
    tcase_add_test(c, an_empty_scene);
    tcase_add_test(c, retired_slots_and_places_stay_retired);
    tcase_add_test(c, a_frame);
    tcase_add_test(c, at_any_address);
    tcase_add_test(c, shapes_come_from_their_allocator_and_die_with_the_scene);
    tcase_add_test(c, arguments_are_checked);
    tcase_add_test(c, a_sink_that_fails);
    tcase_add_test(c, a_sink_may_read_and_not_change);
    tcase_add_test(c, user_defined_shapes_need_numbers);
    tcase_add_test(c, user_defined_shapes_must_be_found_again);
    suite_add_tcase(suite, c);
    return suite;
}
