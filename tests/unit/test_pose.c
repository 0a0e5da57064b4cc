/* SPDX-License-Identifier: MIT */
#include "pose.h"
#include "unit.h"

#include <string.h>

START_TEST(inverse_times_matrix) {
    int checked = 0;
    for (int i = 0; i < 20000; i++) {
        float m[9];
        rgi_linear linear;
        for (int k = 0; k < 9; k++) m[k] = (float)unit_random_scale(-3, 3);
        if (rgi_linear_init(&linear, m, 1) != RG_OK) continue;
        checked++;
        double lengths = 1, determinant = 0;
        for (int k = 0; k < 3; k++) {
            int n = (k + 1) % 3, o = (k + 2) % 3;
            lengths *= sqrt((double)m[3 * k] * m[3 * k] + (double)m[3 * k + 1] * m[3 * k + 1] +
                            (double)m[3 * k + 2] * m[3 * k + 2]);
            determinant += m[k] * ((double)m[3 + n] * m[6 + o] - (double)m[3 + o] * m[6 + n]);
        }
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++) {
                double sum = 0, scale = 0;
                for (int k = 0; k < 3; k++) {
                    sum += m[3 * r + k] * linear.inverse[3 * k + c];
                    scale += fabs(m[3 * r + k] * linear.inverse[3 * k + c]);
                }
                /* Cofactors have one rounding; the determinant's, relative to itself, grows with what cancels in it.
                 */
                ck_assert_double_le(fabs(sum - (r == c)), 0x1p-49 * scale * lengths / fabs(determinant));
            }
        }
    }
    ck_assert_int_gt(checked, 19000);
}
END_TEST

START_TEST(what_is_singular) {
    rgi_linear linear;
    const float rank2[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9}, zero_row[9] = {1, 0, 0, 0, 0, 0, 0, 0, 1};
    const float uneven[9] = {1, 0, 0, 0, 1e-3f, 0, 0, 0, 1e3f}, extreme[9] = {1e-18f, 0, 0, 0, 1e18f, 0, 0, 0, -1};
    const float sheared[9] = {1, 1e5f, 0, 0, 1, 0, 0, 0, 1}, mirror[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    ck_assert_int_eq(rgi_linear_init(&linear, rank2, 1), RG_INVALID_VALUE);
    ck_assert_int_eq(rgi_linear_init(&linear, zero_row, 1), RG_INVALID_VALUE);
    ck_assert_int_eq(rgi_linear_init(&linear, uneven, 1), RG_OK);
    ck_assert_int_eq(rgi_linear_init(&linear, extreme, 1), RG_OK);
    ck_assert_int_eq(rgi_linear_init(&linear, sheared, 1), RG_OK);
    ck_assert_int_eq(rgi_linear_init(&linear, mirror, 1), RG_OK);
    for (int i = 0; i < 9; i++) {
        const float bad[] = {NAN, INFINITY, -INFINITY};
        for (int k = 0; k < 3; k++) {
            float m[9];
            memcpy(m, rgi_identity, sizeof m);
            m[i] = bad[k];
            ck_assert_int_eq(rgi_linear_init(&linear, m, 1), RG_INVALID_VALUE);
        }
    }
}
END_TEST

START_TEST(positions) {
    const double bad[] = {NAN, INFINITY, -INFINITY, 1.1e100, -1e300};
    for (int a = 0; a < 3; a++) {
        for (int k = 0; k < 5; k++) {
            double p[3] = {0, 1e100, -1e100};
            ck_assert_int_eq(rgi_check_position(p), RG_OK);
            p[a] = bad[k];
            ck_assert_int_eq(rgi_check_position(p), RG_INVALID_VALUE);
        }
    }
    rg_pose pose = rg_pose_at(1, 2, 3);
    ck_assert(pose.position[0] == 1 && pose.position[1] == 2 && pose.position[2] == 3);
    ck_assert(rgi_is_identity(pose.linear));
    pose.linear[5] = 1e-30f;
    ck_assert(!rgi_is_identity(pose.linear));
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("pose");
    TCase *tests = tcase_create("pose");
    tcase_add_test(tests, inverse_times_matrix);
    tcase_add_test(tests, what_is_singular);
    tcase_add_test(tests, positions);
    suite_add_tcase(suite, tests);
    return suite;
}
