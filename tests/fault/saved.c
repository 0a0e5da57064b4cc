/* SPDX-License-Identifier: MIT */
/*
 * saved: every allocation of saving, loading, recording and playing fails once, and once with all that follow. What
 * meets the failure returns RG_OUT_OF_MEMORY and leaves nothing behind; the scene is as it was; and a recording that
 * could not go on is good up to where it ended.
 */
#include "allocator.h"
#include "byte_sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { SHAPES = 20, OBJECTS = 90, STEPS = 60 };

typedef struct stage {
    test_allocator memory;
    rg_scene *scene;
    rg_shape *shapes[SHAPES];
    rg_object objects[OBJECTS + STEPS];
    int count;
} stage;

static void demand(bool holds, const char *what, uint64_t n) {
    if (holds) return;
    fprintf(stderr, "FAILED: allocation %" PRIu64 ": %s (last message: %s)\n", n, what, rg_error_message());
    exit(EXIT_FAILURE);
}

/* ------------------------------------------------------------------------------------------------- the scene */

static rg_result make_shape(int i, rg_shape **shape) {
    const float size = (float)(1 + 0.1 * i);
    const float corners[4][3] = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
    const double lo[3] = {-1, -1, -0.1 * i}, hi[3] = {1, 1, 1};
    static const uint32_t FACES[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    rg_mesh_views views = {.size = sizeof views, .vertex_count = 4, .triangle_count = 4};
    views.vertices = rg_input3_packed(corners, sizeof *corners, RG_F32);
    views.indices = rg_input3_packed(FACES, sizeof *FACES, RG_U32);
    if (i % 4 == 0) return rg_shape_create_mesh(NULL, &views, shape);
    if (i % 4 == 1) return rg_shape_create_capsule(NULL, lo, hi, 0.5, shape);
    return i % 4 == 2 ? rg_shape_create_box(NULL, lo, hi, shape) : rg_shape_create_sphere(NULL, size, shape);
}

static rg_pose pose_of(int i) {
    rg_pose pose = rg_pose_at(9 * sin(i), 9 * sin(1.7 * i), 9 * sin(2.3 * i));
    if (i % 3 == 0) pose.linear[1] = 0.5f;
    return pose;
}

static rg_result insert(stage *s, int i, int shapes) {
    const rg_pose pose = pose_of(i);
    rg_result result = rg_scene_insert(s->scene, s->shapes[i % shapes], &pose, &s->objects[s->count]);
    if (!result) s->count++;
    return result;
}

/* With some of its shapes only, so that there are new ones to come. */
static void open_stage(stage *s) {
    rg_scene_config config = {.size = sizeof config, .workers = 1};
    const rg_grid_config grid = {.size = sizeof grid, .kind = RG_GRID_HIERARCHICAL};
    rg_grid other;
    memset(s, 0, sizeof *s);
    config.allocator = test_allocator_hooks(&s->memory);
    for (int i = 0; i < SHAPES; i++) demand(make_shape(i, &s->shapes[i]) == RG_OK, "shape", 0);
    demand(rg_scene_create(&config, &s->scene) == RG_OK, "create", 0);
    demand(rg_grid_create(s->scene, &grid, &other) == RG_OK, "grid", 0);
    for (int i = 0; i < OBJECTS; i++) demand(insert(s, i, 5) == RG_OK, "insert", 0);
    for (int i = 0; i < 7; i++) demand(rg_scene_remove(s->scene, s->objects[--s->count]) == RG_OK, "remove", 0);
}

static void close_stage(stage *s, uint64_t n) {
    demand(rg_scene_destroy(&s->scene) == RG_OK, "destroy", n);
    for (int i = 0; i < SHAPES; i++) rg_shape_release(&s->shapes[i]);
    demand(s->memory.live_blocks == 0 && s->memory.live_bytes == 0, "memory is left", n);
}

/* Changes of the scene that meet shapes which were not used before. Those that fail are as if never made. */
static void play_stage(stage *s, uint64_t n) {
    for (int i = 0; i < STEPS; i++) {
        const rg_pose pose = pose_of(3 * i + 1);
        rg_result result = i % 3 == 0 ? insert(s, i, SHAPES) : rg_scene_move(s->scene, s->objects[i % 40], &pose);
        demand(result == RG_OK || result == RG_OUT_OF_MEMORY, "a change", n);
        if (i % 10 == 9) demand(rg_scene_remove(s->scene, s->objects[--s->count]) == RG_OK, "remove", n);
    }
}

static void save(rg_scene *scene, byte_sink *bytes) {
    const rg_sink sink = byte_sink_sink(bytes);
    demand(rg_scene_save(scene, &sink) == RG_OK, "save", 0);
}

static void fail_from(test_allocator *memory, uint64_t n, bool ever_after) {
    memory->fail_at = memory->calls + n;
    memory->fail_ever_after = ever_after;
}

static void fail_no_more(test_allocator *memory) {
    memory->fail_at = 0;
}

/* -------------------------------------------------------------------------------------------------- the trials */

/* Each returns whether the n-th allocation was reached. */
typedef bool trial(uint64_t n, bool ever_after);

static bool saving(uint64_t n, bool ever_after) {
    static stage s;
    byte_sink before = {0}, after = {0}, during = {0};
    open_stage(&s);
    save(s.scene, &before);
    uint64_t bytes = s.memory.live_bytes, failed = s.memory.failed;
    const rg_sink sink = byte_sink_sink(&during);
    fail_from(&s.memory, n, ever_after);
    rg_result result = rg_scene_save(s.scene, &sink);
    fail_no_more(&s.memory);
    bool reached = s.memory.failed > failed;
    demand(result == (reached ? RG_OUT_OF_MEMORY : RG_OK), "save without memory", n);
    demand(s.memory.live_bytes == bytes, "save keeps memory", n);
    save(s.scene, &after);
    demand(byte_sink_equal(&before, &after), "save has changed the scene", n);
    close_stage(&s, n);
    byte_sink_free(&before);
    byte_sink_free(&after);
    byte_sink_free(&during);
    return reached;
}

/* The scene and its shapes take their memory from the same books. What a grid only wishes for, it does without. */
static bool loading(uint64_t n, bool ever_after) {
    static stage s;
    test_allocator memory = {0};
    byte_sink first = {0}, second = {0};
    rg_scene *loaded = NULL;
    open_stage(&s);
    save(s.scene, &first);
    rg_scene_config config = {.size = sizeof config, .workers = 2, .allocator = test_allocator_hooks(&memory)};
    const rg_shape_config shapes = {.size = sizeof shapes, .allocator = test_allocator_hooks(&memory)};
    rg_source source = byte_sink_source(&first);
    source.shapes = &shapes;
    fail_from(&memory, n, ever_after);
    rg_result result = rg_scene_load(&config, &source, &loaded);
    fail_no_more(&memory);
    demand(result == RG_OK || result == RG_OUT_OF_MEMORY, "load without memory", n);
    demand(result == RG_OK || memory.failed, "load fails with memory there", n);
    demand(result == RG_OK || (!loaded && memory.live_blocks == 0), "load leaves something", n);
    if (result) demand(rg_scene_load(&config, &source, &loaded) == RG_OK, "load with memory again", n);
    save(loaded, &second);
    demand(byte_sink_equal(&first, &second), "what is loaded is another", n);
    rg_scene_destroy(&loaded);
    demand(memory.live_blocks == 0, "a scene that was loaded leaves memory", n);
    close_stage(&s, n);
    byte_sink_free(&first);
    byte_sink_free(&second);
    return memory.failed > 0;
}

/* Plays as far as it goes; tries each step again that finds no memory. Returns what ended it. */
static rg_result play(const byte_sink *bytes, test_allocator *memory, uint64_t n, bool ever_after, rg_scene **scene) {
    rg_scene_config config = {.size = sizeof config, .workers = 1, .allocator = test_allocator_hooks(memory)};
    const rg_shape_config shapes = {.size = sizeof shapes, .allocator = test_allocator_hooks(memory)};
    rg_replay_report report = {.size = sizeof report};
    rg_replay *replay = NULL;
    rg_source source = byte_sink_source(bytes);
    source.shapes = &shapes;
    if (n) fail_from(memory, n, ever_after);
    rg_result result = rg_replay_create(&config, &source, &replay, scene);
    if (result == RG_OUT_OF_MEMORY) {
        demand(memory->failed && memory->live_blocks == 0 && !replay && !*scene, "a replay leaves something", n);
        fail_no_more(memory);
        result = rg_replay_create(&config, &source, &replay, scene);
    }
    demand(result == RG_OK, "a replay", n);
    do {
        result = rg_replay_step(replay, &report);
        if (result != RG_OUT_OF_MEMORY) continue;
        demand(memory->failed > 0, "a step fails with memory there", n);
        fail_no_more(memory);
        result = rg_replay_step(replay, &report);
    } while (!result && report.call != RG_CALL_NONE);
    fail_no_more(memory);
    rg_replay_destroy(&replay);
    return result;
}

static void demand_played(const byte_sink *recording, const byte_sink *want, uint64_t n) {
    test_allocator memory = {0};
    byte_sink got = {0};
    rg_scene *scene = NULL;
    demand(play(recording, &memory, 0, false, &scene) == RG_OK, "play", n);
    save(scene, &got);
    demand(byte_sink_equal(&got, want), "what is played is another", n);
    rg_scene_destroy(&scene);
    demand(memory.live_blocks == 0, "a replay leaves memory", n);
    byte_sink_free(&got);
}

static bool recording(uint64_t n, bool ever_after) {
    static stage s;
    test_allocator memory = {0};
    byte_sink bytes = {0}, state = {0};
    rg_scene *scene = NULL;
    open_stage(&s);
    uint64_t before = s.memory.live_bytes;
    const rg_sink sink = byte_sink_sink(&bytes);
    fail_from(&s.memory, n, ever_after);
    rg_result result = rg_scene_record(s.scene, &sink);
    if (result) {
        demand(result == RG_OUT_OF_MEMORY && s.memory.failed && s.memory.live_bytes == before, "record", n);
        fail_no_more(&s.memory);
        bytes.size = 0;
        demand(rg_scene_record(s.scene, &sink) == RG_OK, "record with memory again", n);
    }
    play_stage(&s, n);
    fail_no_more(&s.memory);
    result = rg_scene_record(s.scene, NULL);
    save(s.scene, &state);
    if (result == RG_OK) {
        demand_played(&bytes, &state, n);
    } else {
        demand(result == RG_OUT_OF_MEMORY && s.memory.failed, "the end of a recording", n);
        demand(play(&bytes, &memory, 0, false, &scene) == RG_INVALID_DATA, "a recording without an end", n);
        demand(strstr(rg_error_message(), "without an end") != NULL, "it is damaged, not cut off", n);
        rg_scene_destroy(&scene);
    }
    close_stage(&s, n);
    byte_sink_free(&bytes);
    byte_sink_free(&state);
    return s.memory.failed > 0;
}

static bool playing(uint64_t n, bool ever_after) {
    static stage s;
    test_allocator memory = {0};
    byte_sink bytes = {0}, want = {0}, got = {0};
    rg_scene *scene = NULL;
    open_stage(&s);
    const rg_sink sink = byte_sink_sink(&bytes);
    demand(rg_scene_record(s.scene, &sink) == RG_OK, "record", n);
    play_stage(&s, n);
    demand(rg_scene_record(s.scene, NULL) == RG_OK, "the end of a recording", n);
    save(s.scene, &want);
    demand(play(&bytes, &memory, n, ever_after, &scene) == RG_OK, "play", n);
    save(scene, &got);
    demand(byte_sink_equal(&got, &want), "what is played is another", n);
    rg_scene_destroy(&scene);
    demand(memory.live_blocks == 0, "a replay leaves memory", n);
    close_stage(&s, n);
    byte_sink_free(&bytes);
    byte_sink_free(&want);
    byte_sink_free(&got);
    return memory.failed > 0;
}

int main(void) {
    static const struct {
        const char *name;
        trial *run;
    } TRIALS[] = {{"saving", saving}, {"loading", loading}, {"recording", recording}, {"playing", playing}};
    for (size_t i = 0; i < sizeof TRIALS / sizeof *TRIALS; i++) {
        uint64_t n = 0;
        bool reached = true;
        while (reached) {
            n++;
            reached = TRIALS[i].run(n, false);
            (void)TRIALS[i].run(n, true);
        }
        printf("%s: %" PRIu64 " allocations, each failed once and once with all after it\n", TRIALS[i].name, n - 1);
        demand(n > 2, "nothing was allocated", n);
    }
    return EXIT_SUCCESS;
}
