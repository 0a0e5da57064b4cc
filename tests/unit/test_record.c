/* SPDX-License-Identifier: MIT */
/* Recordings: what is played is what was recorded, whoever recorded it, and up to where it is whole. */
#include "repair.h"
#include "saved_scene.h"
#include "unit.h"

#include <pthread.h>
#include <stdio.h>

static void begin(rg_scene *scene, byte_sink *bytes) {
    const rg_sink sink = saved_scene_sink(bytes);
    ck_assert_msg(rg_scene_record(scene, &sink) == RG_OK, "%s", rg_error_message());
}

static void end(rg_scene *scene) {
    ck_assert_msg(rg_scene_record(scene, NULL) == RG_OK, "%s", rg_error_message());
}

/* Plays as far as it goes. Returns what ended it; RG_OK: the end. */
static rg_result play(const byte_sink *bytes, uint32_t workers, rg_scene **scene, rg_replay_report *last) {
    const rg_source source = saved_scene_source(bytes);
    const rg_scene_config config = {.size = sizeof config, .workers = workers};
    rg_replay *replay = NULL;
    *scene = NULL;
    rg_result result = rg_replay_create(&config, &source, &replay, scene);
    last->size = sizeof *last;
    if (result) return result;
    do result = rg_replay_step(replay, last);
    while (!result && last->call != RG_CALL_NONE);
    rg_replay_destroy(&replay);
    ck_assert_ptr_null(replay);
    return result;
}

/* Demands that the recording is whole and ends with the scene as it is. */
static void demand_same(const byte_sink *recording, rg_scene *scene, uint64_t calls, uint32_t workers) {
    byte_sink want = {0}, got = {0};
    rg_replay_report last;
    rg_scene *played;
    ck_assert_msg(play(recording, workers, &played, &last) == RG_OK, "%s", rg_error_message());
    ck_assert_uint_eq(last.calls, calls);
    ck_assert_uint_eq(last.offset, recording->size);
    saved_scene_save(scene, &want);
    saved_scene_save(played, &got);
    ck_assert(byte_sink_equal(&want, &got));
    rg_scene_destroy(&played);
    byte_sink_free(&want);
    byte_sink_free(&got);
}

START_TEST(what_is_played_is_what_was_recorded) {
    static const rg_grid_kind KINDS[] = {RG_GRID_LOOSE, RG_GRID_UNIFORM, RG_GRID_HIERARCHICAL};
    saved_scene s;
    byte_sink bytes = {0};
    uint64_t calls = 0;
    saved_scene_make(&s, KINDS[_i], 1);
    begin(s.scene, &bytes);
    for (uint32_t turn = 0; turn < 40; turn++) calls += saved_scene_change(&s, turn);
    end(s.scene);
    demand_same(&bytes, s.scene, calls, 1);
    demand_same(&bytes, s.scene, calls, 3);
    end(s.scene); /* there is none any more */
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* Each kind of call in its turn, with what is known of it. */
START_TEST(steps_tell_what_they_were) {
    static const rg_call CALLS[] = {RG_CALL_MOVE,         RG_CALL_MOVE_TO,      RG_CALL_SET_MASK,
                                    RG_CALL_INSERT,       RG_CALL_INSERT_MANY,  RG_CALL_MOVE_MANY,
                                    RG_CALL_REMOVE_MANY,  RG_CALL_GRID_CREATE,  RG_CALL_GRID_CONFIGURE,
                                    RG_CALL_GRID_REBUILD, RG_CALL_GRID_DESTROY, RG_CALL_REPLACE_SHAPE};
    saved_scene s;
    byte_sink bytes = {0};
    rg_replay *replay;
    rg_scene *scene;
    rg_replay_report r = {.size = sizeof r};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    saved_scene_change(&s, 1);
    end(s.scene);
    const rg_source source = saved_scene_source(&bytes);
    ck_assert_int_eq(rg_replay_create(NULL, &source, &replay, &scene), RG_OK);
    for (size_t i = 0; i < sizeof CALLS / sizeof *CALLS; i++) {
        uint64_t before = r.offset;
        ck_assert_int_eq(rg_replay_step(replay, &r), RG_OK);
        ck_assert_int_eq(r.call, CALLS[i]);
        ck_assert_uint_eq(r.calls, i + 1);
        ck_assert_uint_gt(r.offset, before);
        if (i == 0) ck_assert_uint_eq(r.object, s.objects[1]);
        ck_assert_uint_eq(r.objects, i < 4 ? 1 : i < 6 ? 4 : i == 6 ? 3 : i == 11 ? 6 : 0);
        if (i == 11) ck_assert_uint_eq(r.object, s.objects[4]);
        if (i == 4 || i == 9) ck_assert_uint_eq(r.grid, s.grid);
    }
    for (int i = 0; i < 2; i++) {
        ck_assert_int_eq(rg_replay_step(replay, &r), RG_OK);
        ck_assert_int_eq(r.call, RG_CALL_NONE);
        ck_assert_uint_eq(r.calls, sizeof CALLS / sizeof *CALLS);
    }
    ck_assert_int_eq(rg_replay_step(replay, NULL), RG_OK);
    r.size = 3;
    ck_assert_int_eq(rg_replay_step(replay, &r), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_replay_step(NULL, NULL), RG_INVALID_ARGUMENT);
    rg_scene_destroy(&scene);
    rg_replay_destroy(&replay); /* in either order */
    rg_replay_destroy(&replay);
    rg_replay_destroy(NULL);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(names_of_calls) {
    ck_assert_str_eq(rg_call_name(RG_CALL_INSERT), "rg_scene_insert");
    ck_assert_str_eq(rg_call_name(RG_CALL_MOVE_MANY), "rg_scene_move_many");
    ck_assert_str_eq(rg_call_name(RG_CALL_GRID_REBUILD), "rg_grid_rebuild");
    ck_assert_str_eq(rg_call_name(-1), "unknown");
    ck_assert_str_eq(rg_call_name(RG_CALL_REPLACE_SHAPE), "rg_scene_replace_shape");
    ck_assert_str_eq(rg_call_name(RG_CALL_REPLACE_SHAPE + 1), "unknown");
}
END_TEST

START_TEST(calls_that_fail_are_not_recorded) {
    const double nowhere[3] = {NAN, 0, 0};
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    size_t size = bytes.size;
    ck_assert_int_eq(rg_scene_move_to(s.scene, s.objects[0], nowhere), RG_INVALID_VALUE);
    ck_assert_int_eq(rg_scene_remove(s.scene, RG_NO_OBJECT), RG_INVALID_ID);
    ck_assert_int_eq(rg_scene_insert(s.scene, NULL, NULL, NULL), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rg_grid_destroy(s.scene, RG_GRID_OF_SCENE), RG_BUSY);
    ck_assert_int_eq(rg_scene_replace_shape(s.scene, s.shapes[0], s.shapes[6]), RG_INVALID_VALUE);
    /* Nor those that find nothing to change. */
    ck_assert_int_eq(rg_scene_replace_shape(s.scene, s.forms[1], s.shapes[0]), RG_OK);
    ck_assert_int_eq(rg_scene_replace_shape(s.scene, s.shapes[0], s.shapes[0]), RG_OK);
    ck_assert_uint_eq(bytes.size, size);
    end(s.scene);
    demand_same(&bytes, s.scene, 0, 1);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(one_at_a_time) {
    saved_scene s;
    byte_sink bytes = {0}, other = {0};
    rg_scene *scene = NULL;
    rg_replay_report last;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    const rg_sink second = saved_scene_sink(&other);
    ck_assert_int_eq(rg_scene_record(s.scene, &second), RG_BUSY);
    ck_assert_int_eq(rg_scene_record(NULL, &second), RG_INVALID_ARGUMENT);
    ck_assert_uint_eq(other.size, 0);
    uint64_t calls = saved_scene_change(&s, 0);
    end(s.scene);
    demand_same(&bytes, s.scene, calls, 1);
    /* A recording is no snapshot, and a snapshot a recording of no calls. */
    const rg_source source = saved_scene_source(&bytes);
    ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_INVALID_DATA);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "recording"));
    saved_scene_save(s.scene, &other);
    ck_assert_int_eq(play(&other, 1, &scene, &last), RG_OK);
    ck_assert_uint_eq(last.calls, 0);
    rg_scene_destroy(&scene);
    /* Then another one, which the end of the scene ends. */
    byte_sink_free(&bytes);
    begin(s.scene, &bytes);
    calls = saved_scene_change(&s, 1);
    rg_scene_destroy(&s.scene);
    ck_assert_int_eq(play(&bytes, 1, &scene, &last), RG_OK);
    ck_assert_uint_eq(last.calls, calls);
    rg_scene_destroy(&scene);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
    byte_sink_free(&other);
}
END_TEST

/* ------------------------------------------------------------------------------------- recordings that break off */

static void log_line(void *user, const char *line) {
    snprintf(user, 200, "%s", line);
}

START_TEST(a_sink_that_fails_ends_the_recording_not_the_call) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *played;
    rg_replay_report last;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    uint64_t before = saved_scene_change(&s, 0);
    ck_assert_int_eq(rg_scene_remove(s.scene, RG_NO_OBJECT), RG_INVALID_ID); /* leaves a message */
    bytes.most = bytes.size + 100;
    saved_scene_change(&s, 1); /* all of its calls succeed */
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "no object"));
    uint64_t calls = bytes.calls;
    saved_scene_change(&s, 2);
    ck_assert_uint_eq(bytes.calls, calls); /* it is not called again */
    ck_assert_int_eq(rg_scene_record(s.scene, NULL), RG_CALLBACK_FAILED);
    ck_assert_msg(strstr(rg_error_message(), "write failed") != NULL, "%s", rg_error_message());
    ck_assert_int_eq(play(&bytes, 1, &played, &last), RG_INVALID_DATA);
    ck_assert_uint_eq(last.calls, before + 1);
    ck_assert_uint_eq(last.offset, bytes.size);
    rg_scene_destroy(&played);
    byte_sink_free(&bytes);
    begin(s.scene, &bytes); /* it can be recorded anew */
    end(s.scene);
    demand_same(&bytes, s.scene, 0, 1);
    byte_sink_free(&bytes);
    bytes.most = 1000;
    const rg_sink sink = saved_scene_sink(&bytes);
    ck_assert_int_eq(rg_scene_record(s.scene, &sink), RG_CALLBACK_FAILED);
    end(s.scene); /* there is none */
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(a_shape_without_a_number_ends_the_recording) {
    char line[200] = "", text[64];
    const rg_scene_config config = {.size = sizeof config, .workers = 1, .log = log_line, .log_user = line};
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *scene, *played;
    rg_replay_report last;
    rg_object object;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    ck_assert_int_eq(rg_scene_create(&config, &scene), RG_OK);
    const rg_sink sink = byte_sink_sink(&bytes);
    ck_assert_int_eq(rg_scene_record(scene, &sink), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, s.shapes[0], NULL, NULL), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, s.shapes[7], NULL, &object), RG_OK);
    snprintf(text, sizeof text, "after 1 calls at object 0x%llx", (unsigned long long)object);
    ck_assert_msg(strstr(line, text) != NULL, "%s", line);
    ck_assert_int_eq(rg_scene_insert(scene, s.shapes[0], NULL, NULL), RG_OK);
    ck_assert_int_eq(rg_scene_record(scene, NULL), RG_INVALID_ARGUMENT);
    ck_assert_str_eq(rg_error_message(), line);
    ck_assert_int_eq(play(&bytes, 1, &played, &last), RG_INVALID_DATA);
    ck_assert_uint_eq(last.calls, 1);
    rg_scene_destroy(&played);
    rg_scene_destroy(&scene);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* Each prefix plays all calls that are whole in it, and then says that it is cut off. */
START_TEST(every_prefix) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *played;
    rg_replay_report last;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    while (rg_scene_remove(s.scene, s.objects[3]) == RG_OK) {
    }
    begin(s.scene, &bytes);
    size_t snapshot = bytes.size;
    uint64_t most = 0, calls = saved_scene_change(&s, 1);
    end(s.scene);
    for (size_t size = 0; size < bytes.size; size++) {
        const byte_sink part = {.bytes = malloc(size + 1), .size = size};
        memcpy(part.bytes, bytes.bytes, size);
        last.calls = 0;
        ck_assert_int_eq(play(&part, 1, &played, &last), RG_INVALID_DATA);
        ck_assert(size < snapshot ? !played : played != NULL);
        ck_assert_uint_ge(last.calls, most);
        most = last.calls;
        rg_scene_destroy(&played);
        free(part.bytes);
    }
    ck_assert_uint_eq(most, calls);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(every_changed_byte_is_noticed) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *played;
    rg_replay_report last;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    size_t snapshot = bytes.size;
    saved_scene_change(&s, 1);
    end(s.scene);
    for (size_t i = snapshot; i < bytes.size; i++) {
        bytes.bytes[i] ^= (unsigned char)(1u << i % 8);
        ck_assert_int_eq(play(&bytes, 1, &played, &last), RG_INVALID_DATA);
        rg_scene_destroy(&played);
        bytes.bytes[i] ^= (unsigned char)(1u << i % 8);
    }
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* One record altered and all checksums made right: `text` is what the message must have. */
static void demand_refused(const byte_sink *bytes, size_t at, uint64_t value, const char *text) {
    const byte_sink copy = {.bytes = malloc(bytes->size), .size = bytes->size};
    rg_scene *played;
    rg_replay_report last;
    memcpy(copy.bytes, bytes->bytes, bytes->size);
    memcpy(copy.bytes + at, &value, sizeof value);
    repair(copy.bytes, copy.size);
    ck_assert_int_eq(play(&copy, 1, &played, &last), RG_INVALID_DATA);
    ck_assert_msg(strstr(rg_error_message(), text) != NULL, "\"%s\" has no \"%s\"", rg_error_message(), text);
    rg_scene_destroy(&played);
    free(copy.bytes);
}

START_TEST(a_call_that_comes_out_otherwise) {
    saved_scene s;
    byte_sink bytes = {0};
    const double place[3] = {1, 2, 3};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    rg_object object;
    rg_grid grid;
    begin(s.scene, &bytes);
    size_t at_insert = bytes.size;
    ck_assert_int_eq(rg_scene_insert(s.scene, s.shapes[0], NULL, &object), RG_OK);
    size_t at_move = bytes.size;
    ck_assert_int_eq(rg_scene_move_to(s.scene, object, place), RG_OK);
    size_t at_grid = bytes.size;
    ck_assert_int_eq(rg_grid_create(s.scene, NULL, &grid), RG_OK);
    ck_assert_int_eq(rg_scene_replace_shape(s.scene, s.shapes[0], s.shapes[1]), RG_OK);
    size_t at_end = bytes.size, at_replace = at_end - 5 * RGI_WORD;
    end(s.scene);
    demand_refused(&bytes, at_replace + 8, object, "came out");
    demand_refused(&bytes, at_replace + 16, 1, "is another");
    demand_refused(&bytes, at_replace + 24, 99, "shape 99");
    demand_refused(&bytes, at_replace + 24, UINT64_C(99) << 32, "shape 99");
    demand_refused(&bytes, at_replace + 24, UINT64_C(6) << 32, "infinite box");
    demand_refused(&bytes, at_replace, 2 << 8 | RG_CALL_REPLACE_SHAPE, "words");
    demand_refused(&bytes, at_insert + 8, object + 1, "came out");
    demand_refused(&bytes, at_insert + 16, 99, "shape 99");
    demand_refused(&bytes, at_insert + 16, UINT64_C(4) << 32, "unknown parts");
    demand_refused(&bytes, at_insert + 16, UINT64_C(1) << 32, "words");
    demand_refused(&bytes, at_insert, 6 << 8 | RG_CALL_INSERT, "6 words, not 5");
    demand_refused(&bytes, at_insert, 5 << 8, "no known kind");
    demand_refused(&bytes, at_insert, 5 << 8 | 200, "no known kind");
    demand_refused(&bytes, at_move + 8, object + 1, "is stale");
    demand_refused(&bytes, at_move + 16, UINT64_C(0x7ff8000000000000), "position.x");
    demand_refused(&bytes, at_move, 4 << 8 | RG_CALL_GRID_CREATE, "words");
    demand_refused(&bytes, at_move, 4 << 8 | RG_CALL_MOVE_MANY, "more objects than words");
    demand_refused(&bytes, at_move, 4 << 8 | RG_CALL_REMOVE_MANY, "stale");
    demand_refused(&bytes, at_grid + 8, grid + 1, "came out");
    demand_refused(&bytes, at_grid + 16, 77, "no kind of grid");
    demand_refused(&bytes, at_end + 8, 3, "the end of 3 calls, but there were 4");
    demand_same(&bytes, s.scene, 4, 1);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* Files of version 1 are those without replacements, but for the number. */
START_TEST(version_1) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_scene *scene;
    rg_replay_report last;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    for (int with = 0; with < 2; with++) {
        begin(s.scene, &bytes);
        ck_assert_int_eq(rg_scene_set_mask(s.scene, s.objects[1], 7), RG_OK);
        if (with) ck_assert_int_eq(rg_scene_replace_shape(s.scene, s.forms[0], s.forms[1]), RG_OK);
        end(s.scene);
        ck_assert_uint_eq(bytes.bytes[8], RG_FORMAT_VERSION);
        bytes.bytes[8] = 1;
        repair(bytes.bytes, bytes.size);
        if (with) {
            ck_assert_int_eq(play(&bytes, 1, &scene, &last), RG_INVALID_DATA);
            ck_assert_ptr_nonnull(strstr(rg_error_message(), "no known kind"));
            ck_assert_uint_eq(last.calls, 1);
            rg_scene_destroy(&scene);
        } else {
            demand_same(&bytes, s.scene, 1, 1);
        }
        byte_sink_free(&bytes);
    }
    saved_scene_end(&s);
}
END_TEST

START_TEST(a_scene_that_the_host_changes_is_found_out) {
    saved_scene s;
    byte_sink bytes = {0};
    rg_replay *replay;
    rg_scene *scene;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    begin(s.scene, &bytes);
    ck_assert_int_eq(rg_scene_insert(s.scene, s.shapes[0], NULL, NULL), RG_OK);
    end(s.scene);
    const rg_source source = saved_scene_source(&bytes);
    ck_assert_int_eq(rg_replay_create(NULL, &source, &replay, &scene), RG_OK);
    ck_assert_int_eq(rg_scene_insert(scene, s.shapes[0], NULL, NULL), RG_OK);
    ck_assert_int_eq(rg_replay_step(replay, NULL), RG_INVALID_DATA);
    ck_assert_ptr_nonnull(strstr(rg_error_message(), "came out"));
    rg_replay_destroy(&replay);
    rg_scene_destroy(&scene);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* -------------------------------------------------------------------------------------------------- threads */

enum { THREADS = 4, ROUNDS = 300 };

typedef struct busy_thread {
    saved_scene *s;
    uint64_t calls;
    uint32_t number;
} busy_thread;

/* Inserts, moves and removes what is its own, and traces in between. */
static void *keep_busy(void *argument) {
    busy_thread *t = argument;
    rg_hit hits[4];
    rg_object mine[8] = {0};
    for (uint32_t i = 0; i < ROUNDS; i++) {
        rg_object *object = &mine[(i + t->number) % 8];
        const double place[3] = {0.1 * i, t->number, 1};
        const rg_ray ray = rg_ray_from(place, (double[3]){0, 0, 1});
        rg_result result = *object ? rg_scene_move_to(t->s->scene, *object, place)
                                   : rg_scene_insert(t->s->scene, t->s->shapes[i % 6], NULL, object);
        if (!result) t->calls++;
        if (!result && i % 11 == 0) {
            result = rg_scene_remove(t->s->scene, *object);
            *object = RG_NO_OBJECT;
            t->calls++;
        }
        if (result || rg_scene_trace(t->s->scene, &ray, hits, 1)) return NULL;
    }
    return t;
}

START_TEST(many_threads) {
    saved_scene s;
    byte_sink bytes = {0}, snapshot = {0};
    pthread_t threads[THREADS];
    busy_thread busy[THREADS];
    uint64_t calls = 0;
    saved_scene_make(&s, RG_GRID_LOOSE, 2);
    begin(s.scene, &bytes);
    for (uint32_t i = 0; i < THREADS; i++) {
        busy[i] = (busy_thread){.s = &s, .number = i};
        ck_assert_int_eq(pthread_create(&threads[i], NULL, keep_busy, &busy[i]), 0);
    }
    saved_scene_save(s.scene, &snapshot); /* whatever they are at */
    for (uint32_t i = 0; i < THREADS; i++) {
        void *done;
        pthread_join(threads[i], &done);
        ck_assert_ptr_nonnull(done);
        calls += busy[i].calls;
    }
    end(s.scene);
    demand_same(&bytes, s.scene, calls, 1);
    const rg_source source = saved_scene_source(&snapshot);
    rg_scene *loaded;
    ck_assert_int_eq(rg_scene_load(NULL, &source, &loaded), RG_OK);
    rg_scene_destroy(&loaded);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
    byte_sink_free(&snapshot);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("record");
    TCase *c = tcase_create("record");
    tcase_set_timeout(c, 0);
    tcase_add_loop_test(c, what_is_played_is_what_was_recorded, 0, 3);
    tcase_add_test(c, steps_tell_what_they_were);
    tcase_add_test(c, names_of_calls);
    tcase_add_test(c, calls_that_fail_are_not_recorded);
    tcase_add_test(c, one_at_a_time);
    tcase_add_test(c, a_sink_that_fails_ends_the_recording_not_the_call);
    tcase_add_test(c, a_shape_without_a_number_ends_the_recording);
    tcase_add_test(c, every_prefix);
    tcase_add_test(c, every_changed_byte_is_noticed);
    tcase_add_test(c, a_call_that_comes_out_otherwise);
    tcase_add_test(c, version_1);
    tcase_add_test(c, a_scene_that_the_host_changes_is_found_out);
    tcase_add_test(c, many_threads);
    suite_add_tcase(suite, c);
    return suite;
}
