/* SPDX-License-Identifier: MIT */
#include "exact.h"
#include "unit.h"

/* With a mantissa of 64 bits, a sum of numbers of like size is exact in long double, and fma gives a product's error.
 */
START_TEST(sums_and_products_lose_nothing) {
    for (int i = 0; i < 100000; i++) {
        double a = unit_random_scale(-3, 3), b = unit_random_scale(-3, 3), error;
        double p = rgi_two_product(a, b, &error);
        ck_assert(p == a * b);
        ck_assert(error == fma(a, b, -p));
        double s = rgi_two_sum(a, b, &error);
        ck_assert(s == a + b);
        /* The error of a sum is a double, and the larger part of the sum is cancelled exactly. */
        double large = fabs(a) > fabs(b) ? a : b, small = large == a ? b : a;
        ck_assert(error == small - (s - large));
    }
}
END_TEST

/* a - b + t * d for numbers whose exact result is known: integers and a small rest, at growing distances. */
START_TEST(rebase_keeps_the_rest) {
    for (int e = 0; e < 300; e++) {
        double far = ldexp(1, e);
        ck_assert(rgi_rebase(-far * 3, 0.375, far, 3) == -0.375);
        ck_assert(rgi_rebase(far * 5, -0.125, -far, 5) == 0.125);
    }
    /* t * d = 2^60 - 1 exactly, which no double holds. */
    ck_assert(rgi_rebase(-0x1p60, -1.5, 0x1p30 + 1, 0x1p30 - 1) == 0.5);
}
END_TEST

Suite *unit_suite(void) {
    Suite *suite = suite_create("exact");
    TCase *tests = tcase_create("exact");
    tcase_add_test(tests, sums_and_products_lose_nothing);
    tcase_add_test(tests, rebase_keeps_the_rest);
    suite_add_tcase(suite, tests);
    return suite;
}
