/* SPDX-License-Identifier: MIT */
#include "memory.h"
#include "unit.h"

typedef struct counts {
    int allocated, released;
    size_t size;
} counts;

static void *count_allocate(void *user, size_t size, size_t alignment) {
    counts *c = user;
    void *block = NULL;
    c->allocated++;
    c->size = size;
    return posix_memalign(&block, alignment, size) == 0 ? block : NULL;
}

static void count_release(void *user, void *memory, size_t size, size_t alignment) {
    counts *c = user;
    c->released++;
    ck_assert_uint_eq(size, c->size);
    ck_assert_uint_eq(alignment, 64);
    free(memory);
}

START_TEST(half_an_allocator_is_refused) {
    rgi_memory memory;
    counts c = {0, 0, 0};
    rg_allocator half = {&c, count_allocate, NULL};
    ck_assert_int_eq(rgi_memory_init(&memory, &half), RG_INVALID_ARGUMENT);
    rg_allocator other = {&c, NULL, count_release};
    ck_assert_int_eq(rgi_memory_init(&memory, &other), RG_INVALID_ARGUMENT);
}
END_TEST

START_TEST(bytes_are_counted) {
    rgi_memory memory;
    counts c = {0, 0, 0};
    rg_allocator allocator = {&c, count_allocate, count_release};
    double *block = NULL;
    ck_assert_int_eq(rgi_memory_init(&memory, &allocator), RG_OK);
    ck_assert_int_eq(rgi_allocate(&memory, 100, sizeof *block, "a test", &block), RG_OK);
    ck_assert_uint_eq((uintptr_t)block % 64, 0);
    ck_assert_uint_eq(memory.bytes, 800);
    rgi_release(&memory, block, 100, sizeof *block);
    rgi_release(&memory, NULL, 100, sizeof *block);
    ck_assert_uint_eq(memory.bytes, 0);
    ck_assert_int_eq(c.allocated, 1);
    ck_assert_int_eq(c.released, 1);
}
END_TEST

START_TEST(a_product_that_overflows_is_no_memory) {
    rgi_memory memory;
    void *block = &memory;
    ck_assert_int_eq(rgi_memory_init(&memory, NULL), RG_OK);
    ck_assert_int_eq(rgi_allocate(&memory, UINT64_MAX / 4, 8, "a test", &block), RG_OUT_OF_MEMORY);
    ck_assert_ptr_eq(block, &memory);
    ck_assert_uint_eq(memory.bytes, 0);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("memory");
    TCase *tests = tcase_create("memory");
    tcase_add_test(tests, half_an_allocator_is_refused);
    tcase_add_test(tests, bytes_are_counted);
    tcase_add_test(tests, a_product_that_overflows_is_no_memory);
    suite_add_tcase(suite, tests);
    return suite;
}
