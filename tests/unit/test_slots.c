/* SPDX-License-Identifier: MIT */
#include "slots.h"
#include "unit.h"

#include <string.h>

typedef struct record {
    uint32_t link;
    uint32_t value;
} record;

static rgi_memory memory;

static record *at(const rgi_slots *slots, uint32_t i) {
    return rgi_slots_at(slots, i);
}

START_TEST(taken_anew_in_reverse) {
    rgi_slots slots;
    rgi_memory_init(&memory, NULL);
    rgi_slots_init(&slots, &memory, sizeof(record), "records");
    ck_assert_int_eq(rgi_slots_reserve(&slots, 5000), RG_OK);
    for (uint32_t i = 0; i < 5000; i++) {
        ck_assert_uint_eq(rgi_slots_take(&slots), i);
        ck_assert_uint_eq(at(&slots, i)->value, 0);
        at(&slots, i)->value = i;
    }
    record *address = at(&slots, 4321);
    rgi_slots_give(&slots, 7);
    rgi_slots_give(&slots, 4321);
    ck_assert_uint_eq(slots.free_count, 2);
    ck_assert_int_eq(rgi_slots_reserve(&slots, 100000), RG_OK);
    ck_assert_uint_eq(rgi_slots_take(&slots), 4321);
    ck_assert_uint_eq(rgi_slots_take(&slots), 7);
    ck_assert_uint_eq(rgi_slots_take(&slots), 5000);
    /* Addresses hold, and what is not the link stays when a record was free. */
    ck_assert_ptr_eq(at(&slots, 4321), address);
    ck_assert_uint_eq(address->value, 4321);
    rgi_slots_free(&slots);
    ck_assert_uint_eq(memory.bytes, 0);
}
END_TEST

START_TEST(reserving_counts_the_free) {
    rgi_slots slots;
    rgi_memory_init(&memory, NULL);
    rgi_slots_init(&slots, &memory, sizeof(record), "records");
    ck_assert_int_eq(rgi_slots_reserve(&slots, RGI_CHUNK), RG_OK);
    uint64_t bytes = memory.bytes;
    for (int i = 0; i < RGI_CHUNK; i++) rgi_slots_take(&slots);
    for (uint32_t i = 0; i < RGI_CHUNK; i++) rgi_slots_give(&slots, i);
    ck_assert_int_eq(rgi_slots_reserve(&slots, RGI_CHUNK), RG_OK);
    ck_assert_uint_eq(memory.bytes, bytes);
    ck_assert_int_eq(rgi_slots_reserve(&slots, 1ull << 32), RG_LIMIT_EXCEEDED);
    ck_assert_uint_eq(memory.bytes, bytes);
    rgi_slots_free(&slots);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("slots");
    TCase *tests = tcase_create("slots");
    tcase_add_test(tests, taken_anew_in_reverse);
    tcase_add_test(tests, reserving_counts_the_free);
    suite_add_tcase(suite, tests);
    return suite;
}
