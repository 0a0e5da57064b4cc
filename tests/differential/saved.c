/* SPDX-License-Identifier: MIT */
/*
 * saved: scenes as bytes, on a large scale.
 *
 *   saved [--steps N] [--seed S]
 *
 * Each golden set is saved and loaded: the same bits of all answers, and the same bytes when it is saved again. Then
 * a long random script of all calls is recorded, on scenes of each kind of grid, and played with other numbers of
 * workers: the same bytes in the end. Without a script's own checks of answers: those are differential.c's.
 */
#include "byte_sink.h"
#include "golden.h"
#include "world.h"

#include <inttypes.h>
#include <stdio.h>

static golden_data data;

static void demand(bool holds, const char *set, const char *what) {
    if (holds) return;
    fprintf(stderr, "FAILED: %s: %s\n", set, what);
    exit(EXIT_FAILURE);
}

/* ------------------------------------------------------------------------------------- user-defined shapes */

/* The shapes of a test live on: their numbers are their places. */
typedef struct kept_shapes {
    byte_sink *sink;
    rg_shape *shapes[WORLD_SHAPES];
    int count;
} kept_shapes;

static int32_t write_bytes(void *user, const void *bytes, size_t size) {
    return byte_sink_write(((kept_shapes *)user)->sink, bytes, size);
}

static int32_t number_shape(void *user, const rg_shape *shape, void *shape_user, uint64_t *number) {
    const kept_shapes *kept = user;
    (void)shape_user;
    for (*number = 0; *number < (uint64_t)kept->count; ++*number) {
        if (kept->shapes[*number] == shape) return 0;
    }
    return 1;
}

static int32_t find_shape(void *user, uint64_t number, const double lo[3], const double hi[3], rg_shape **shape) {
    const kept_shapes *kept = user;
    (void)lo, (void)hi;
    if (number >= (uint64_t)kept->count) return 1;
    *shape = kept->shapes[number];
    rg_shape_retain(*shape);
    return 0;
}

static rg_sink sink_to(kept_shapes *kept) {
    return (rg_sink){.size = sizeof(rg_sink), .user = kept, .write = write_bytes, .number_shape = number_shape};
}

static rg_source source_of(kept_shapes *kept) {
    rg_source source = byte_sink_source(kept->sink);
    source.user = kept;
    source.find_shape = find_shape;
    return source;
}

static void save(rg_scene *scene, kept_shapes *kept, byte_sink *bytes) {
    kept->sink = bytes;
    const rg_sink sink = sink_to(kept);
    golden_demand(rg_scene_save(scene, &sink), "rg_scene_save");
}

/* ---------------------------------------------------------------------------------------------- golden sets */

static uint64_t hash_of(rg_scene *scene, const rg_object *ids) {
    static rg_hit hits[GOLDEN_RAYS];
    static uint8_t occluded[GOLDEN_RAYS];
    golden_demand(rg_scene_trace(scene, data.ray, hits, (uint64_t)data.rays), "trace");
    golden_demand(rg_scene_occluded(scene, data.ray, occluded, (uint64_t)data.rays), "occluded");
    for (int i = 0; i < data.rays; i++) {
        uint64_t number = 0;
        while (hits[i].object && ids[number] != hits[i].object) number++;
        hits[i].object = hits[i].object ? number + 1 : 0;
    }
    return golden_hash(hits, occluded, data.rays);
}

static void check_set(const golden_set *set, uint32_t workers) {
    static rg_object ids[GOLDEN_OBJECTS];
    const rg_scene_config config = {.size = sizeof config, .workers = workers};
    rg_scene *scene = NULL, *loaded = NULL;
    byte_sink first = {0}, second = {0};
    golden_make(&data, set);
    kept_shapes kept = {.count = data.shape_count};
    for (int i = 0; i < data.shape_count; i++) kept.shapes[i] = data.shapes[i];
    golden_demand(rg_scene_create(&config, &scene), "create");
    for (int i = 0; i < data.objects; i++) {
        golden_demand(rg_scene_insert(scene, data.shapes[data.shape_of[i]], &data.poses[i], &ids[i]), "insert");
        if (data.masks[i] != UINT32_MAX) golden_demand(rg_scene_set_mask(scene, ids[i], data.masks[i]), "set_mask");
    }
    save(scene, &kept, &first);
    const rg_source source = source_of(&kept);
    golden_demand(rg_scene_load(&config, &source, &loaded), "rg_scene_load");
    demand(hash_of(scene, ids) == set->hash, set->name, "another hash before it was saved");
    demand(hash_of(loaded, ids) == set->hash, set->name, "another hash after it was loaded");
    save(loaded, &kept, &second);
    demand(byte_sink_equal(&first, &second), set->name, "loaded and saved again, the bytes are others");
    printf("%-20s %5d objects: %7zu bytes, the same bits\n", set->name, data.objects, first.size);
    rg_scene_destroy(&scene);
    rg_scene_destroy(&loaded);
    golden_release(&data);
    byte_sink_free(&first);
    byte_sink_free(&second);
}

/* --------------------------------------------------------------------------------------------------- scripts */

/* Plays a recording to its end with so many workers, and demands the state that it ended with. */
static void check_played(kept_shapes *kept, byte_sink *recording, const byte_sink *want, uint32_t workers,
                         const char *name) {
    const rg_scene_config config = {.size = sizeof config, .workers = workers};
    rg_replay_report report = {.size = sizeof report};
    rg_replay *replay = NULL;
    rg_scene *scene = NULL;
    byte_sink got = {0};
    kept->sink = recording;
    const rg_source source = source_of(kept);
    golden_demand(rg_replay_create(&config, &source, &replay, &scene), "rg_replay_create");
    do golden_demand(rg_replay_step(replay, &report), "rg_replay_step");
    while (report.call != RG_CALL_NONE);
    rg_replay_destroy(&replay);
    save(scene, kept, &got);
    demand(byte_sink_equal(want, &got), name, "played, the scene is another");
    if (workers == 1)
        printf("%-20s %7" PRIu64 " calls in %9zu bytes: the same state with 1, 2 and 4 workers\n", name, report.calls,
               recording->size);
    rg_scene_destroy(&scene);
    byte_sink_free(&got);
}

static void check_script(const char *name, rg_grid_kind kind, bool configures, uint64_t steps, uint64_t seed) {
    static const rg_grid_config MORE[] = {{.size = sizeof *MORE, .kind = RG_GRID_UNIFORM},
                                          {.size = sizeof *MORE, .kind = RG_GRID_HIERARCHICAL}};
    static world w;
    const rg_grid_config grid = {.size = sizeof grid, .kind = kind};
    const rg_scene_config config = {.size = sizeof config, .workers = 2, .grid = &grid};
    byte_sink recording = {0}, state = {0};
    world_create(&w, name, seed, &config, MORE, 2);
    kept_shapes kept = {.sink = &recording, .count = w.shape_count};
    for (int i = 0; i < w.shape_count; i++) kept.shapes[i] = w.shapes[i].shape;
    w.configures = configures;
    w.many_of_16 = 2;
    for (uint64_t i = 0; i < steps / 4; i++) world_step(&w, 300);
    const rg_sink sink = sink_to(&kept);
    golden_demand(rg_scene_record(w.scene, &sink), "rg_scene_record");
    for (uint64_t i = 0; i < steps; i++) {
        if (i % 1000 == 0) w.centre[i / 1000 % 3] = random_decade(&w.random, 0, 3);
        world_step(&w, 300);
    }
    golden_demand(rg_scene_record(w.scene, NULL), "rg_scene_record");
    save(w.scene, &kept, &state);
    for (uint32_t workers = 1; workers <= 4; workers *= 2) check_played(&kept, &recording, &state, workers, name);
    world_destroy(&w);
    byte_sink_free(&recording);
    byte_sink_free(&state);
}

int main(int argc, char **argv) {
    uint64_t steps = 20000, seed = 20011;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "--steps") == 0) steps = strtoull(argv[i + 1], NULL, 0);
        if (strcmp(argv[i], "--seed") == 0) seed = strtoull(argv[i + 1], NULL, 0);
    }
    for (int i = 0; i < GOLDEN_SET_COUNT; i++) check_set(&GOLDEN_SETS[i], 1 + (uint32_t)i % 2);
    printf("seed %" PRIu64 "\n", seed);
    check_script("loose", RG_GRID_LOOSE, false, steps, seed);
    check_script("uniform", RG_GRID_UNIFORM, false, steps / 4, seed + 1);
    check_script("hierarchical", RG_GRID_HIERARCHICAL, false, steps / 4, seed + 2);
    check_script("configured", RG_GRID_LOOSE, true, steps / 4, seed + 3);
    return EXIT_SUCCESS;
}
