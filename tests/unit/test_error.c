/* SPDX-License-Identifier: MIT */
#include "error.h"
#include "unit.h"

#include <pthread.h>
#include <string.h>

START_TEST(names) {
    for (rg_result r = RG_OK; r <= RG_INVALID_DATA; r++) {
        ck_assert(strncmp(rg_result_name(r), "RG_", 3) == 0);
        for (rg_result s = RG_OK; s < r; s++) ck_assert_str_ne(rg_result_name(r), rg_result_name(s));
    }
    ck_assert_str_eq(rg_result_name(-1), "unknown");
    ck_assert_str_eq(rg_result_name(RG_INVALID_DATA + 1), "unknown");
    ck_assert_uint_eq(rg_version(), 1000 * RG_VERSION_MINOR + RG_VERSION_PATCH + 1000000 * RG_VERSION_MAJOR);
}
END_TEST

static void *other_thread(void *seen) {
    memcpy(seen, rg_error_message(), 1);
    rgi_fail(RG_LIMIT_EXCEEDED, "of the other thread");
    return NULL;
}

START_TEST(message_belongs_to_its_thread) {
    pthread_t thread;
    char first = 'x';
    ck_assert_int_eq(rgi_fail(RG_INVALID_VALUE, "radius is %g", -1.0), RG_INVALID_VALUE);
    ck_assert_int_eq(pthread_create(&thread, NULL, other_thread, &first), 0);
    pthread_join(thread, NULL);
    ck_assert_int_eq(first, '\0');
    ck_assert_str_eq(rg_error_message(), "radius is -1");
}
END_TEST

START_TEST(long_messages_are_cut) {
    char text[1000];
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    rgi_fail(RG_INVALID_VALUE, "%s", text);
    size_t length = strlen(rg_error_message());
    ck_assert(length > 200 && length < sizeof text);
    rgi_fail_prefix("object %d: ", 7);
    ck_assert_uint_eq(strlen(rg_error_message()), length);
    ck_assert(strncmp(rg_error_message(), "object 7: aaa", 13) == 0);
}
END_TEST

START_TEST(what_a_call_only_tries_leaves_no_message) {
    rgi_fail(RG_INVALID_VALUE, "first");
    rgi_fail_quietly(true);
    ck_assert_int_eq(rgi_fail(RG_OUT_OF_MEMORY, "second"), RG_OUT_OF_MEMORY);
    rgi_fail_quietly(false);
    ck_assert_str_eq(rg_error_message(), "first");
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("error");
    TCase *tests = tcase_create("error");
    tcase_add_test(tests, names);
    tcase_add_test(tests, message_belongs_to_its_thread);
    tcase_add_test(tests, long_messages_are_cut);
    tcase_add_test(tests, what_a_call_only_tries_leaves_no_message);
    suite_add_tcase(suite, tests);
    return suite;
}
