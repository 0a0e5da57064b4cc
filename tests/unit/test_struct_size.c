/* SPDX-License-Identifier: MIT */
#include "struct_size.h"
#include "unit.h"

#include <string.h>

/* A struct at three ages. */
typedef struct v1 {
    size_t size;
    uint64_t a;
} v1;

typedef struct v2 {
    size_t size;
    uint64_t a, b;
} v2;

typedef struct v3 {
    size_t size;
    uint64_t a, b, c;
} v3;

START_TEST(older_callers) {
    v1 given = {sizeof given, 5};
    v2 known;
    ck_assert_int_eq(rgi_struct_read(&known, sizeof known, sizeof(v1), &given, "v"), RG_OK);
    ck_assert_uint_eq(known.a, 5);
    ck_assert_uint_eq(known.b, 0);
    struct {
        v1 given;
        uint64_t guard;
    } out = {{sizeof(v1), 0}, 77};
    known.a = 6;
    ck_assert_int_eq(rgi_struct_write(&known, sizeof known, sizeof(v1), &out.given, "v"), RG_OK);
    ck_assert_uint_eq(out.given.a, 6);
    ck_assert_uint_eq(out.given.size, sizeof(v1));
    ck_assert_uint_eq(out.guard, 77);
}
END_TEST

START_TEST(newer_callers) {
    v3 given = {sizeof given, 5, 6, 0};
    v2 known;
    ck_assert_int_eq(rgi_struct_read(&known, sizeof known, sizeof(v1), &given, "v"), RG_OK);
    ck_assert_uint_eq(known.b, 6);
    given.c = 1;
    ck_assert_int_eq(rgi_struct_read(&known, sizeof known, sizeof(v1), &given, "v"), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rgi_struct_write(&known, sizeof known, sizeof(v1), &given, "v"), RG_OK);
    ck_assert_uint_eq(given.c, 0);
    v2 defaults = {sizeof defaults, 8, 9};
    memset(&given, 0xff, sizeof given);
    ck_assert_int_eq(rgi_struct_default(&defaults, sizeof defaults, sizeof(v1), &given, sizeof given, "v"), RG_OK);
    ck_assert_uint_eq(given.size, sizeof given);
    ck_assert_uint_eq(given.b, 9);
    ck_assert_uint_eq(given.c, 0);
}
END_TEST

START_TEST(wrong_sizes) {
    unsigned char room[8192] = {0};
    v2 known;
    for (size_t size = 0; size < sizeof room; size++) {
        memcpy(room, &size, sizeof size);
        rg_result expected = size >= sizeof(v1) && size <= 4096 ? RG_OK : RG_INVALID_ARGUMENT;
        ck_assert_int_eq(rgi_struct_read(&known, sizeof known, sizeof(v1), room, "v"), expected);
    }
    ck_assert_int_eq(rgi_struct_read(&known, sizeof known, sizeof(v1), NULL, "v"), RG_OK);
    ck_assert_uint_eq(known.a, 0);
    ck_assert_int_eq(rgi_struct_write(&known, sizeof known, sizeof(v1), NULL, "v"), RG_INVALID_ARGUMENT);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("struct_size");
    TCase *tests = tcase_create("struct_size");
    tcase_add_test(tests, older_callers);
    tcase_add_test(tests, newer_callers);
    tcase_add_test(tests, wrong_sizes);
    suite_add_tcase(suite, tests);
    return suite;
}
