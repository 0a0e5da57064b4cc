/* SPDX-License-Identifier: MIT */
#include "unit.h"
#include "views.h"

START_TEST(any_layout_any_type) {
    double aos[4][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
    float soa[3][4] = {{0, 3, 6, 9}, {1, 4, 7, 10}, {2, 5, 8, 11}};
    rg_input3 views[] = {rg_input3_packed(aos, sizeof aos[0], RG_F64),
                         {soa[0], soa[1], soa[2], sizeof(float), RG_F32},
                         rg_input3_packed(aos[3], -(ptrdiff_t)sizeof aos[0], RG_F64),
                         rg_input3_packed(aos[2], 0, RG_F64)};
    for (uint64_t i = 0; i < 4; i++) {
        const uint64_t record[] = {i, i, 3 - i, 2};
        for (int v = 0; v < 4; v++) {
            double out[3];
            rgi_load3(&views[v], i, out);
            for (int a = 0; a < 3; a++) ck_assert(out[a] == (double)(3 * record[v] + (uint64_t)a));
        }
    }
}
END_TEST

START_TEST(unaligned) {
    char bytes[64];
    rg_output out = {bytes + 1, 9, RG_F64};
    rg_input in = {bytes + 1, 9, RG_F64};
    for (uint64_t i = 0; i < 6; i++) rgi_store(&out, i, 0.1 * (double)i);
    for (uint64_t i = 0; i < 6; i++) ck_assert(rgi_load(&in, i, -1) == 0.1 * (double)i);
}
END_TEST

START_TEST(integers) {
    uint16_t u16[2] = {1, 65535};
    uint32_t u32[2] = {1, UINT32_MAX};
    uint64_t u64[2] = {1, UINT64_MAX};
    ck_assert_uint_eq(rgi_load_integer(&(rg_input){u16, 2, RG_U16}, 1, 0), 65535);
    ck_assert_uint_eq(rgi_load_integer(&(rg_input){u32, 4, RG_U32}, 1, 0), UINT32_MAX);
    ck_assert_uint_eq(rgi_load_integer(&(rg_input){u64, 8, RG_U64}, 1, 0), UINT64_MAX);
    ck_assert_uint_eq(rgi_load_integer(&(rg_input){NULL, 0, 0}, 1, 9), 9);
}
END_TEST

START_TEST(checks) {
    double x;
    ck_assert_int_eq(rgi_check_view(NULL, 99, RGI_FLOATS, 0, "v"), RG_OK);
    ck_assert_int_eq(rgi_check_view(NULL, RG_F64, RGI_FLOATS, 1, "v"), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rgi_check_view(&x, RG_F32, RGI_FLOATS, 1, "v"), RG_OK);
    for (rg_type t = -3; t < 40; t++) {
        rg_result expected = t == RG_U16 || t == RG_U32 || t == RG_U64 ? RG_OK : RG_INVALID_ARGUMENT;
        ck_assert_int_eq(rgi_check_view(&x, t, RGI_INDICES, 1, "v"), expected);
    }
    ck_assert_int_eq(rgi_check_view3(&x, NULL, &x, RG_F64, RGI_FLOATS, 0, "v"), RG_INVALID_ARGUMENT);
    ck_assert_int_eq(rgi_check_view3(&x, &x, NULL, RG_F64, RGI_FLOATS, 0, "v"), RG_INVALID_ARGUMENT);
    /* A type that does not exist leaves the helper without y and z, and the call that gets it refuses it. */
    ck_assert_ptr_eq(rg_input3_packed(&x, 8, 77).y, NULL);
    ck_assert_ptr_eq(rg_output3_packed(NULL, 8, RG_F64).x, NULL);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("views");
    TCase *tests = tcase_create("views");
    tcase_add_test(tests, any_layout_any_type);
    tcase_add_test(tests, unaligned);
    tcase_add_test(tests, integers);
    tcase_add_test(tests, checks);
    suite_add_tcase(suite, tests);
    return suite;
}
