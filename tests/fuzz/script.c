/* SPDX-License-Identifier: MIT */
/*
 * script.c: the fuzzer's entry. Any bytes are a script of calls; whatever they say, the library must not crash, hang,
 * or do other than its header says, and in the end the scene must still be the one that the reference has.
 *
 * As an ordinary test: driver.c, with the scripts in corpus/ and random ones. With libFuzzer:
 *   CC=clang meson setup build-fuzz -Db_sanitize=address,undefined -Db_lundef=false -Dbuildtype=debugoptimized \
 *     -Dc_args=-fsanitize=fuzzer-no-link
 *   ninja -C build-fuzz tests/fuzz/fuzz_libfuzzer
 *   mkdir new && build-fuzz/tests/fuzz/fuzz_libfuzzer -max_len=2048 new tests/fuzz/corpus
 */
#include "script.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

void script_fail(const char *why) {
    fprintf(stderr, "FAILED: %s; last message: %s\n", why, rg_error_message());
    abort();
}

rg_result script_check(rg_result result) {
    if (strcmp(rg_result_name(result), "unknown") == 0) script_fail("an unknown result");
    if (result != RG_OK && rg_error_message()[0] == 0) script_fail("a failure without a message");
    return result;
}

static void open_scene(script *s) {
    rg_grid_config grid = read_grid_config(s);
    rg_scene_config config = {.size = read_size(s, sizeof config), .grid = &grid};
    config.workers = 1 + read_below(s, 64) / 63;
    if (read_byte(s) == 255) config.workers = 2000;
    s->reference = reference_create();
    if (script_check(rg_scene_create(&config, &s->scene)) == RG_OK) return;
    if (s->scene) script_fail("a failed create wrote a scene");
    config = (rg_scene_config){.size = sizeof config, .workers = 1};
    if (rg_scene_create(&config, &s->scene) != RG_OK) script_fail("no scene of defaults");
}

static void close_scene(script *s) {
    if (rg_scene_destroy(&s->scene) != RG_OK || s->scene) script_fail("rg_scene_destroy");
    for (int i = 0; i < s->shape_count; i++) {
        const script_shape *shape = &s->shapes[i];
        rg_shape_release(&s->shapes[i].shape);
        if (shape->user && shape->user->destroyed != 1) script_fail("a user shape was not destroyed");
    }
    reference_destroy(s->reference);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static script_step *const STEPS[] = {make_a_shape,   make_a_shape, release_a_shape, insert_one,  insert_one,
                                         insert_one,     insert_some,  move_one,        move_one,    move_to,
                                         move_some,      set_mask,     remove_one,      remove_some, look_up,
                                         ask_stats,      create_grid,  destroy_grid,    pass_null,   rebuild_grid,
                                         configure_grid, trace_plain,  trace_plain,     trace_views, occluded_views};
    script *s = calloc(1, sizeof *s); /* user shapes point into it */
    if (!s) abort();
    s->bytes = bytes;
    s->end = bytes + size;
    open_scene(s);
    for (int step = 0; step < MOST_STEPS && s->bytes < s->end; step++) {
        STEPS[read_below(s, sizeof STEPS / sizeof *STEPS)](s);
    }
    script_judge(s);
    close_scene(s);
    free(s);
    return 0;
}
