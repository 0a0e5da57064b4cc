/* SPDX-License-Identifier: MIT */
/* Loading: what is no snapshot, or a damaged or hostile one, is refused, with a message that says where. */
#include "repair.h"
#include "saved_scene.h"
#include "unit.h"

#include <stdio.h>

static rg_scene *load(const byte_sink *bytes) {
    const rg_source source = saved_scene_source(bytes);
    const rg_scene_config config = {.size = sizeof config, .workers = 1};
    rg_scene *scene = NULL;
    ck_assert_msg(rg_scene_load(&config, &source, &scene) == RG_OK, "%s", rg_error_message());
    return scene;
}

/* Demands that the bytes are refused and that the message has `text`. */
static void refused(const unsigned char *bytes, size_t size, const char *text) {
    const byte_sink data = {.bytes = (unsigned char *)bytes, .size = size};
    const rg_source source = saved_scene_source(&data);
    rg_scene *scene = NULL;
    rg_replay *replay = NULL;
    ck_assert_int_eq(rg_scene_load(NULL, &source, &scene), RG_INVALID_DATA);
    ck_assert_msg(strstr(rg_error_message(), text) != NULL, "\"%s\" has no \"%s\"", rg_error_message(), text);
    ck_assert_int_eq(rg_replay_create(NULL, &source, &replay, &scene), RG_INVALID_DATA);
    ck_assert(!scene && !replay);
}

/* ---------------------------------------------------------------------------------------------- damaged bytes */

START_TEST(every_prefix_is_refused) {
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    for (size_t size = 0; size < bytes.size; size++) {
        unsigned char *part = malloc(size + 1); /* so that reading beyond it is noticed */
        memcpy(part, bytes.bytes, size);
        refused(part, size, "");
        free(part);
    }
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(every_changed_byte_is_noticed) {
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    for (size_t i = 0; i < bytes.size; i++) {
        bytes.bytes[i] ^= (unsigned char)(1u << i % 8);
        refused(bytes.bytes, bytes.size, "byte");
        bytes.bytes[i] ^= (unsigned char)(1u << i % 8);
    }
    rg_scene *loaded = load(&bytes);
    rg_scene_destroy(&loaded);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(other_files_and_versions) {
    saved_scene s;
    byte_sink bytes = {0};
    char text[64];
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    refused((const unsigned char *)"This is a text, of no kind at all", 33, "no snapshot");
    bytes.bytes[8] = 77;
    repair(bytes.bytes, bytes.size);
    snprintf(text, sizeof text, "of version 77, this library reads 1 to %d", RG_FORMAT_VERSION);
    refused(bytes.bytes, bytes.size, text);
    bytes.bytes[8] = 0;
    repair(bytes.bytes, bytes.size);
    refused(bytes.bytes, bytes.size, "of version 0, this library reads 1 to");
    bytes.bytes[8] = RG_FORMAT_VERSION;
    bytes.bytes[12] = 3;
    repair(bytes.bytes, bytes.size);
    refused(bytes.bytes, bytes.size, "kind 3");
    bytes.bytes[12] = RGI_SNAPSHOT;
    repair(bytes.bytes, bytes.size);
    rg_scene *loaded = load(&bytes);
    rg_scene_destroy(&loaded);
    const unsigned char more[8] = {0};
    ck_assert_int_eq(byte_sink_write(&bytes, more, sizeof more), 0);
    refused(bytes.bytes, bytes.size, "8 bytes follow");
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* ------------------------------------------------------------------------------------------------- hostile bytes */

/** A number put into a record, the checksums made right again: what the message must have. */
typedef struct edit {
    uint32_t kind; /* the first record of that kind */
    uint32_t nth;  /* or so many later */
    uint32_t word; /* from its head on, which is word 0 */
    uint64_t value;
    const char *text;
} edit;

#define BITS_OF_NAN UINT64_C(0x7ff8000000000000)

static const edit EDITS[] = {
    {RGI_RECORD_GRID, 0, 0, RGI_RECORD_SHAPE | 9 << 8, "not that of a grid"},
    {RGI_RECORD_GRID, 0, 0, RGI_RECORD_GRID | UINT64_C(0xFFFFFFFFFFFF) << 8, "words"},
    {RGI_RECORD_GRID, 0, 1, 0, "words"},
    {RGI_RECORD_GRID, 0, 1, UINT64_C(1) << 32 | 1, "no place"},
    {RGI_RECORD_GRID, 0, 2, 9, "no kind of grid"},
    {RGI_RECORD_GRID, 0, 2, UINT64_C(0xFFFFFFFF) << 32, "resolution"},
    {RGI_RECORD_GRID, 1, 1, 0, "no place"},
    {RGI_RECORD_GRID, 2, 1, UINT64_C(1) << 32, "no place"},
    {RGI_RECORD_GRID, 2, 1, UINT64_C(1) << 32 | 1 << 24, "no place"},
    {RGI_RECORD_GRID, 2, 1, UINT64_C(3) << 32 | 1, "no place"},
    {RGI_RECORD_GRID, 2, 1, UINT64_C(1) << 32 | UINT32_MAX, "no place"},
    {RGI_RECORD_GRID, 2, 3, BITS_OF_NAN, "box of the grid"},
    {RGI_RECORD_GRID, 2, 9, BITS_OF_NAN, "rebuild_factor"},
    {RGI_RECORD_SHAPE, 0, 1, 5, "no kind"},
    {RGI_RECORD_SHAPE, 0, 1, RG_SHAPE_BOX, "words"},
    {RGI_RECORD_SHAPE, 0, 2, 0, "radius is 0"},
    {RGI_RECORD_SHAPE, 2, 2, BITS_OF_NAN, "lo[0] of the box"},
    {RGI_RECORD_SHAPE, 3, 5, BITS_OF_NAN, "b[0] is nan"},
    {RGI_RECORD_SHAPE, 4, 2, UINT64_MAX, "vertices"},
    {RGI_RECORD_SHAPE, 4, 3, UINT64_C(1) << 40, "triangles"},
    {RGI_RECORD_SHAPE, 4, 4, BITS_OF_NAN, "vertex 0 has x"},
    {RGI_RECORD_SHAPE, 4, 25, 7, "index 7 of triangle 0"},
    {RGI_RECORD_SLOTS, 0, 1, 0, "no slot"},
    {RGI_RECORD_SLOTS, 0, 1, UINT64_C(1) << 32 | 1, "no slot"},
    {RGI_RECORD_SLOTS, 0, 1, UINT64_C(0xFF) << 32 | 1, "no slot"},
    {RGI_RECORD_SLOTS, 0, 1, UINT64_C(0x107) << 32 | 1, "place 1, where there is no grid"},
    {RGI_RECORD_SLOTS, 0, 1, UINT64_C(0xFFFFFF07) << 32 | 1, "no grid"},
    {RGI_RECORD_SLOTS, 0, 2, 9, "shape 9 of 9"},
    {RGI_RECORD_SLOTS, 0, 3, BITS_OF_NAN, "position.x"},
    {RGI_RECORD_FREE, 0, 1, UINT64_C(1) << 32, "is not free"},
    {RGI_RECORD_FREE, 0, 1, 0, "is not free"},
    {RGI_RECORD_FREE, 0, 2, 15, "free twice"},
    {RGI_RECORD_STATE, 0, 0, RGI_RECORD_SLOTS | 4 << 8, "out of place"},
    {RGI_RECORD_STATE, 0, 0, 1 | 4 << 8, "out of place"},
    {RGI_RECORD_STATE, 0, 0, 99 | 4 << 8, "out of place"},
    {RGI_RECORD_STATE, 0, 1, 2, "2 places for grids"},
    {RGI_RECORD_STATE, 0, 2, 0, "0 shapes"},
    {RGI_RECORD_STATE, 0, 3, 61, "61 slots"},
    {RGI_RECORD_STATE, 0, 4, 60, "60 objects"},
};

/* Where the head of a record is. */
static size_t find_record(const byte_sink *bytes, uint32_t kind, uint32_t nth) {
    for (size_t at = 2 * RGI_WORD; at < bytes->size;) {
        uint64_t head;
        memcpy(&head, bytes->bytes + at, sizeof head);
        if ((head & 0xFF) == kind && nth-- == 0) return at;
        at += (size_t)((head >> 8) + RGI_RECORD_AROUND) * RGI_WORD;
    }
    ck_abort_msg("no such record");
    return 0;
}

START_TEST(each_number_is_checked) {
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    for (size_t i = 0; i < sizeof EDITS / sizeof *EDITS; i++) {
        const edit *e = &EDITS[i];
        unsigned char *copy = malloc(bytes.size);
        memcpy(copy, bytes.bytes, bytes.size);
        memcpy(copy + find_record(&bytes, e->kind, e->nth) + e->word * RGI_WORD, &e->value, sizeof e->value);
        repair(copy, bytes.size);
        refused(copy, bytes.size, e->text);
        free(copy);
    }
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

START_TEST(a_slot_that_is_nowhere) {
    saved_scene s;
    byte_sink bytes = {0};
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    /* One slot less is free: what is behind the record moves up. */
    size_t at = find_record(&bytes, RGI_RECORD_FREE, 0);
    uint64_t head;
    memcpy(&head, bytes.bytes + at, sizeof head);
    head -= 1 << 8;
    memcpy(bytes.bytes + at, &head, sizeof head);
    memmove(bytes.bytes + at + RGI_WORD, bytes.bytes + at + 2 * RGI_WORD, bytes.size - at - 2 * RGI_WORD);
    bytes.size -= RGI_WORD;
    repair(bytes.bytes, bytes.size);
    refused(bytes.bytes, bytes.size, "neither live, free nor retired");
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

/* Nobody needs much memory for so small a scene, unless damaged numbers ask for it. */
static void *allocate_little(void *user, size_t size, size_t alignment) {
    void *block = NULL;
    (void)user;
    return size < 1 << 24 && posix_memalign(&block, alignment, size) == 0 ? block : NULL;
}

static void release_little(void *user, void *memory, size_t size, size_t alignment) {
    (void)user, (void)size, (void)alignment;
    free(memory);
}

/* Most of what random bytes do to a snapshot is refused; the rest is another scene, and a whole one. */
START_TEST(random_damage_behind_right_checksums) {
    const rg_scene_config config = {
        .size = sizeof config, .workers = 1, .allocator = {NULL, allocate_little, release_little}};
    rg_hit hits[SAVED_RAYS];
    saved_scene s;
    byte_sink bytes = {0};
    int taken = 0, refused_count = 0;
    saved_scene_make(&s, RG_GRID_LOOSE, 1);
    saved_scene_save(s.scene, &bytes);
    unsigned char *copy = malloc(bytes.size);
    for (int i = 0; i < 3000; i++) {
        const byte_sink damaged = {.bytes = copy, .size = bytes.size};
        const rg_source source = saved_scene_source(&damaged);
        rg_scene *scene = NULL;
        memcpy(copy, bytes.bytes, bytes.size);
        for (int k = 0; k <= i % 3; k++)
            copy[(size_t)(unit_random() * (double)bytes.size)] ^= (unsigned char)(1 + 255 * unit_random());
        repair(copy, bytes.size);
        rg_result result = rg_scene_load(&config, &source, &scene);
        taken += result == RG_OK;
        refused_count += result != RG_OK;
        if (result == RG_OK) saved_scene_trace(scene, hits);
        rg_scene_destroy(&scene);
    }
    ck_assert_int_gt(taken, 300);
    ck_assert_int_gt(refused_count, 300);
    free(copy);
    saved_scene_end(&s);
    byte_sink_free(&bytes);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("snapshot_load");
    TCase *c = tcase_create("snapshot_load");
    tcase_set_timeout(c, 0);
    tcase_add_test(c, every_prefix_is_refused);
    tcase_add_test(c, every_changed_byte_is_noticed);
    tcase_add_test(c, other_files_and_versions);
    tcase_add_test(c, each_number_is_checked);
    tcase_add_test(c, a_slot_that_is_nowhere);
    tcase_add_test(c, random_damage_behind_right_checksums);
    suite_add_tcase(suite, c);
    return suite;
}
