/* SPDX-License-Identifier: MIT */
/*
 * saved.c: hostile snapshots and recordings. The entry is that of a fuzzer; driver.c runs it as a test, and the
 * target fuzz_saved_libfuzzer with libFuzzer (see script.c): -max_len=8192 new tests/fuzz/corpus_saved
 *
 * Bytes that begin as a file does are one; all others are edits of a good recording: which word, and what becomes of
 * it. The checksums are made right, so that what is behind them is tested. Whatever is accepted must be a scene in
 * order: saved and loaded again it gives the same bytes and the same answers.
 */
#include "repair.h"
#include "saved_scene.h"

#include <math.h>
#include <stdio.h>

enum { EDIT = 4, MOST_EDITS = 5, MOST_MEMORY = 1 << 26, TURNS = 2 };

static void fail(const char *why) {
    fprintf(stderr, "FAILED: %s: %s\n", why, rg_error_message());
    abort();
}

/* A few bytes may ask for much memory, as the calls may that they stand for: a host sets a limit. */
static size_t taken;

static void *allocate(void *user, size_t size, size_t alignment) {
    void *block = NULL;
    (void)user;
    if (size > MOST_MEMORY - taken || posix_memalign(&block, alignment, size) != 0) return NULL;
    taken += size;
    return block;
}

static void release(void *user, void *memory, size_t size, size_t alignment) {
    (void)user, (void)alignment;
    taken -= size;
    free(memory);
}

static const rg_shape_config SHAPES = {.size = sizeof SHAPES, .allocator = {NULL, allocate, release}};
static const rg_scene_config SCENE = {.size = sizeof SCENE, .workers = 1, .allocator = {NULL, allocate, release}};

static rg_source source_of(const byte_sink *bytes) {
    rg_source source = saved_scene_source(bytes);
    source.shapes = &SHAPES;
    return source;
}

/* What a result may be for bytes that may be anything. */
static void check_result(rg_result result) {
    if (result == RG_OK) return;
    if (result != RG_INVALID_DATA && result != RG_OUT_OF_MEMORY && result != RG_CALLBACK_FAILED)
        fail("a result that bytes can't have");
    if (!rg_error_message()[0]) fail("no message");
}

static void check_scene(rg_scene *scene) {
    rg_hit before[SAVED_RAYS], after[SAVED_RAYS];
    byte_sink first = {0}, second = {0};
    rg_scene *loaded = NULL;
    saved_scene_save(scene, &first);
    const rg_source source = source_of(&first);
    rg_result result = rg_scene_load(&SCENE, &source, &loaded);
    if (result != RG_OK && result != RG_OUT_OF_MEMORY) fail("what was saved is not loaded");
    if (result == RG_OK) {
        saved_scene_save(loaded, &second);
        if (!byte_sink_equal(&first, &second)) fail("saved again, the bytes are others");
        saved_scene_trace(scene, before);
        saved_scene_trace(loaded, after);
        if (memcmp(before, after, sizeof before) != 0) fail("the answers are others");
    }
    rg_scene_destroy(&loaded);
    byte_sink_free(&first);
    byte_sink_free(&second);
}

static void try_file(const byte_sink *file) {
    rg_replay_report report = {.size = sizeof report};
    rg_replay *replay = NULL;
    rg_scene *scene = NULL, *loaded = NULL;
    const rg_source source = source_of(file);
    rg_result result = rg_replay_create(&SCENE, &source, &replay, &scene);
    check_result(result);
    if (result == RG_OK) {
        check_scene(scene);
        do {
            result = rg_replay_step(replay, &report);
            check_result(result);
        } while (result == RG_OK && report.call != RG_CALL_NONE);
        check_scene(scene);
    } else if (replay || scene) {
        fail("an error gave something");
    }
    rg_replay_destroy(&replay);
    rg_scene_destroy(&scene);
    check_result(rg_scene_load(&SCENE, &source, &loaded));
    rg_scene_destroy(&loaded);
    if (taken) fail("memory is left");
}

/* ----------------------------------------------------------------------------------------------------- edits */

static const byte_sink *good_recording(void) {
    static byte_sink bytes;
    saved_scene s;
    if (bytes.size) return &bytes;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    const rg_sink sink = saved_scene_sink(&bytes);
    if (rg_scene_record(s.scene, &sink)) fail("record");
    for (uint32_t turn = 0; turn < TURNS; turn++) saved_scene_change(&s, turn);
    if (rg_scene_record(s.scene, NULL)) fail("the end of a recording");
    saved_scene_end(&s);
    return &bytes;
}

static void edit(unsigned char *word, uint8_t how, uint8_t by) {
    static const double NUMBERS[] = {0,      -0.0,    NAN,    HUGE_VAL, -HUGE_VAL, 1e100,
                                     -1e100, 1.1e100, 1e-100, 5e-324,   1,         -1};
    uint64_t value;
    memcpy(&value, word, sizeof value);
    switch (how % 6) {
    case 0:
        word[by % 8] ^= (unsigned char)(1u << how / 6 % 8);
        return;
    case 1:
        word[how / 6 % 8] = by;
        return;
    case 2:
        memcpy(word, &NUMBERS[by % (sizeof NUMBERS / sizeof *NUMBERS)], sizeof value);
        return;
    case 3:
        value += (int8_t)by;
        break;
    case 4:
        value = by;
        break;
    default:
        value = UINT64_C(1) << by % 64;
    }
    memcpy(word, &value, sizeof value);
}

static void edit_all(byte_sink *file, const uint8_t *bytes, size_t size) {
    size_t words = file->size / RGI_WORD;
    for (; size >= EDIT; bytes += EDIT, size -= EDIT) {
        size_t at = (bytes[0] | (size_t)bytes[1] << 8) % words;
        edit(file->bytes + at * RGI_WORD, bytes[2], bytes[3]);
        /* The sizes of records are mostly right: else only the first of them would ever be looked into. */
        if (bytes[2] >= 250) file->size = at * RGI_WORD + bytes[3] % RGI_WORD;
        if (file->size < RGI_WORD) return;
        words = file->size / RGI_WORD;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    const bool is_file = size >= RGI_WORD && memcmp(bytes, "raygrid", 7) == 0;
    byte_sink file = {0};
    if (is_file) {
        (void)byte_sink_write(&file, bytes, size);
    } else {
        (void)byte_sink_write(&file, good_recording()->bytes, good_recording()->size);
        /* Few at a time: most are found out, and then nothing behind them is looked at. */
        size_t edits = size ? 1 + bytes[0] % MOST_EDITS : 0;
        if (edits) edit_all(&file, bytes + 1, size - 1 < edits * EDIT ? size - 1 : edits * EDIT);
    }
    (void)repair(file.bytes, file.size);
    try_file(&file);
    byte_sink_free(&file);
    return 0;
}
